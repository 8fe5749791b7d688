//! Boundary representation: solids, shells, faces, loops, edges, vertices.
//!
//! ```text
//!   186 solid ─▶ 514 shell ─▶ 510 face ─▶ surface
//!     voids ──────▲             └───────▶ 508 loop ─▶ 504 edge list, item ─▶ curve
//!                                           │           └──────▶ 502 vertex list, item
//!                                           └─▶ 502 vertex list, item (a pole)
//! ```
//!
//! A swept solid (162, 164) has shells without an entity: see `swept`.
//!
//! Both faces of an edge refer to the same edge; the curves in `(u, v)` that loops may list are not used.
//! A loop keeps its face on the left, seen against the normal of the surface. The flags along the way
//! from the solid to the face say whether that normal leaves the material.

use super::curve::Segment;
use super::entity::{Entity, Fault};
use super::geometry::{FACE_LOST, Geometry, finite};
use super::surface::SURFACES;
use crate::brep::{Boundary, CurveGeometry, Edge, FaceGeometry};
use crate::import::guard::Endless;
use crate::model::{Colour, EdgeSource};
use glam::{DAffine3, DVec3};
use std::collections::HashMap;

/// The faces of a solid or a shell, and the edges that they share.
#[derive(Debug, Default)]
pub(super) struct Shells {
    pub edges: Vec<Edge>,
    pub faces: Vec<(FaceGeometry, Option<Colour>)>,
    /// Curves in parameters that loops list.
    pub pcurves: usize,
    /// Faces that could not be read, and why.
    pub lost: Vec<(u32, String)>,
    by_item: HashMap<(u32, usize), usize>,
}

/// Where a shell stands, and what its faces inherit.
#[derive(Clone, Copy)]
struct Context<'m> {
    map: &'m DAffine3,
    sense: bool,
    colour: Option<Colour>,
}

impl Shells {
    /// Where each edge stands in the file: its list, and its place there.
    pub fn sources(&self) -> Vec<Option<EdgeSource>> {
        let mut all = vec![None; self.edges.len()];
        for (&(entity, item), &index) in &self.by_item {
            all[index] = Some(EdgeSource { entity, item: u32::try_from(item).ok() });
        }
        all
    }
}

impl<'a> Geometry<'a> {
    /// 186, 162, 164, or a 514 or 510 by itself.
    pub fn shells(&self, id: u32, outer: &DAffine3) -> Result<Shells, Fault> {
        let mut shells = Shells::default();
        self.nested(id, |entity| {
            // a reflection turns normals inside out
            let sense = outer.matrix3.determinant() > 0.0;
            let context = Context { map: outer, sense, colour: None };
            match entity.kind() {
                510 => {
                    let face = self.face(entity, context, &mut shells);
                    return self.keep(id, face, &mut shells);
                }
                514 => return self.shell(entity, context, &mut shells),
                _ => {}
            }
            shells = self.faces_of(entity, outer)?;
            Ok(())
        })?;
        Ok(shells)
    }

    /// 186, 162 or 164, already on the trail.
    pub fn faces_of(&self, entity: Entity<'a>, outer: &DAffine3) -> Result<Shells, Fault> {
        let mut shells = Shells::default();
        let map = self.placed(entity, outer)?;
        if matches!(entity.kind(), 162 | 164) {
            return self.swept(entity, &map);
        }
        let entity = entity.of_kind(186, "186, a solid")?;
        let sense = map.matrix3.determinant() > 0.0;
        let colour = self.colour(entity);
        let voids = entity.count(3, 2)?;
        let all = [(1, 2)].into_iter().chain((0..voids).map(|i| (4 + 2 * i, 5 + 2 * i)));
        for (shell, flag) in all {
            let context = Context { map: &map, sense: sense == (entity.integer(flag)? != 0), colour };
            self.nested(entity.pointer(shell)?, |shell| self.shell(shell, context, &mut shells))?;
        }
        Ok(shells)
    }

    fn shell(&self, entity: Entity<'a>, context: Context<'_>, shells: &mut Shells) -> Result<(), Fault> {
        let entity = entity.of_kind(514, "514, a shell")?;
        let map = self.placed(entity, context.map)?;
        let colour = self.colour(entity).or(context.colour);
        for i in 0..entity.count(1, 2)? {
            let face = entity.pointer(2 + 2 * i)?;
            let sense = context.sense == (entity.integer(3 + 2 * i)? != 0);
            let mapped = self.nested(face, |face| self.face(face, Context { map: &map, sense, colour }, shells));
            self.keep(face, mapped, shells)?;
        }
        Ok(())
    }

    /// Keeps a face, or records why it is lost; fails only when the budget of work is spent.
    fn keep(
        &self,
        id: u32,
        face: Result<(FaceGeometry, Option<Colour>), Fault>,
        shells: &mut Shells,
    ) -> Result<(), Fault> {
        match face {
            Ok(face) => shells.faces.push(face),
            Err(fault @ Fault::Endless(Endless::Exhausted(_))) => return Err(fault),
            Err(fault) => {
                self.note(FACE_LOST, id, fault.to_string());
                shells.lost.push((id, fault.to_string()));
            }
        }
        Ok(())
    }

    fn face(
        &self,
        entity: Entity<'a>,
        context: Context<'_>,
        shells: &mut Shells,
    ) -> Result<(FaceGeometry, Option<Colour>), Fault> {
        let entity = entity.of_kind(510, "510, a face")?;
        let map = self.placed(entity, context.map)?;
        let surface = Entity::find(self.file, entity.pointer(1)?)?;
        if !SURFACES.contains(&surface.kind()) {
            return Err(surface.unsupported());
        }
        let mut bounds = Vec::new();
        for i in 4..4 + entity.count(2, 1)? {
            bounds.push(self.nested(entity.pointer(i)?, |l| self.face_loop(l, &map, shells))?);
        }
        let edges = |b: &Boundary| match b {
            Boundary::Edges(uses) => uses.iter().map(|u| shells.edges[u.0].start).collect(),
            Boundary::Vertex(_) | Boundary::Natural => Vec::new(),
        };
        let vertices: Vec<DVec3> = bounds.iter().flat_map(edges).collect();
        let carrier = self.surface_near(surface.id(), &map, &vertices)?;
        for boundary in bounds.iter_mut().filter(|_| carrier.flipped) {
            if let Boundary::Edges(uses) = boundary {
                uses.reverse();
                uses.iter_mut().for_each(|u| u.1 = !u.1);
            }
        }
        let same_sense = context.sense != carrier.flipped;
        let (id, surface) = (entity.id(), carrier.surface);
        let face = FaceGeometry { id, surface, bounds, same_sense, ambiguous: false };
        Ok((face, self.colour(entity).or(context.colour)))
    }

    fn face_loop(&self, entity: Entity<'a>, map: &DAffine3, shells: &mut Shells) -> Result<Boundary, Fault> {
        let entity = entity.of_kind(508, "508, a loop")?;
        let map = self.placed(entity, map)?;
        let (mut uses, mut vertex) = (Vec::new(), None);
        let mut at = 2;
        for _ in 0..entity.count(1, 5)? {
            let (list, item) = (entity.pointer(at + 1)?, entity.count(at + 2, 0)?);
            match entity.integer(at)? {
                0 => uses.push((self.edge(list, item, &map, shells)?, entity.integer(at + 3)? != 0)),
                _ => vertex = Some(self.vertex(list, item, &map)?),
            }
            let curves = entity.count(at + 4, 2)?;
            shells.pcurves += curves;
            at += 5 + 2 * curves;
        }
        match vertex {
            Some(vertex) if uses.is_empty() => Ok(Boundary::Vertex(vertex)),
            _ if uses.is_empty() => Err(Fault::Value { id: entity.id(), what: "the loop has no edge" }),
            _ => Ok(Boundary::Edges(uses)),
        }
    }

    /// Item `item` of the edge list `#list`, counted from 1.
    fn edge(&self, list: u32, item: usize, map: &DAffine3, shells: &mut Shells) -> Result<usize, Fault> {
        if let Some(&index) = shells.by_item.get(&(list, item)) {
            return Ok(index);
        }
        let entity = Entity::find(self.file, list)?.of_kind(504, "504, an edge list")?;
        let count = entity.count(1, 5)?;
        if item == 0 || item > count {
            return Err(Fault::Value { id: list, what: "the list has no edge of that number" });
        }
        let map = self.placed(entity, map)?;
        let at = 2 + 5 * (item - 1);
        let vertex = |i: usize| self.vertex(entity.pointer(i)?, entity.count(i + 1, 0)?, &map);
        let (start, end) = (vertex(at + 1)?, vertex(at + 3)?);
        let id = entity.pointer(at)?;
        let segments = self.segments(id, &map)?;
        let curve = match &segments[..] {
            [only] => only.curve.clone(),
            several => CurveGeometry::Composite(several.iter().map(Segment::trimmed).collect()),
        };
        let index = shells.edges.len();
        shells.edges.push(Edge { id, curve, start, end, same_sense: true });
        shells.by_item.insert((list, item), index);
        Ok(index)
    }

    /// Item `item` of the vertex list `#list`, counted from 1.
    fn vertex(&self, list: u32, item: usize, map: &DAffine3) -> Result<DVec3, Fault> {
        let entity = Entity::find(self.file, list)?.of_kind(502, "502, a vertex list")?;
        let count = entity.count(1, 3)?;
        if item == 0 || item > count {
            return Err(Fault::Value { id: list, what: "the list has no vertex of that number" });
        }
        let map = self.placed(entity, map)?;
        finite(list, map.transform_point3(entity.triple(2 + 3 * (item - 1))?))
    }
}
