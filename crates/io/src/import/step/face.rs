//! Faces and their loops, with every orientation flag applied.
//!
//! ```text
//!   ADVANCED_FACE('',(bounds),surface,same_sense)       normal of face = ± normal of surface
//!   FACE_BOUND('',loop,orientation)                     loop run forwards or backwards
//!   ORIENTED_EDGE('',*,*,edge,orientation)              edge run from start to end or back
//!   SEAM_EDGE('',*,*,edge,orientation,pcurve)           the same, on the seam of a surface
//!   EDGE_CURVE('',start,end,curve,same_sense)           edge runs along the curve or against it
//!   SUBEDGE('',start,end,edge)                          a part of another edge
//! ```
//!
//! STEP runs a loop with the face on its left, seen against the normal of the *face*. A [`Boundary`] is seen against
//! the normal of the *surface*: when `same_sense` is false every loop is turned round. The orientation of a shell
//! changes the face's normal only, never its loops, which belong to the face as the file states it.
//!
//! Both faces of an edge refer to the same [`Edge`]: p-curves in the file are not used.
//!
//! Source: ISO 10303-42, 5.4 (face, face_surface, loop).

use super::entity::{Entity, Fault, Fields};
use super::geometry::{Geometry, frame};
use super::locate;
use super::part21::Value;
use crate::brep::{Boundary, CurveGeometry, Edge, FaceGeometry, SurfaceGeometry};
use crate::model::EdgeSource;
use glam::DVec3;
use std::collections::HashMap;

/// The edges of one body, shared by its faces.
#[derive(Debug, Default)]
pub(super) struct EdgeTable {
    /// The edges.
    pub edges: Vec<Edge>,
    by_id: HashMap<u32, usize>,
    /// Sides of polygons, by the numbers of their points, the smaller one first.
    by_points: HashMap<(u32, u32), usize>,
}

impl Geometry<'_> {
    /// ADVANCED_FACE, FACE_SURFACE, ORIENTED_FACE, or a FACE of polygons.
    pub fn face(&self, id: u32, table: &mut EdgeTable) -> Result<FaceGeometry, Fault> {
        self.ledger.nested(id, || {
            let entity = self.entity(id)?;
            if let Ok(fields) = entity.fields("ORIENTED_FACE", 2) {
                let face = self.face(fields.reference(0)?, table)?;
                return Ok(FaceGeometry { same_sense: face.same_sense == fields.flag(1), ..face });
            }
            let (bounds, surface) = match entity.fields("FACE", 1) {
                Ok(face) => (face, entity.fields("FACE_SURFACE", 0).ok().map(|f| (f, 0))),
                Err(_) => {
                    let fields = entity.fields("ADVANCED_FACE", 1).or_else(|_| entity.fields("FACE_SURFACE", 1))?;
                    (fields, Some((fields, 1)))
                }
            };
            let mut loops = Vec::new();
            for bound in bounds.references(0)? {
                loops.push(self.bound(bound?, table)?);
            }
            let vertices: Vec<DVec3> = loops.iter().flat_map(|l| table.vertices(l)).collect();
            let carrier =
                |(f, at): (Fields<'_>, usize)| Ok((self.surface_near(f.reference(at)?, &vertices)?, f.flag(at + 1)));
            let carrier = surface.map(carrier).transpose()?;
            let (surface, same_sense) = match carrier {
                Some((carrier, same_sense)) => (carrier.surface, same_sense != carrier.flipped),
                None => (self.polygon_plane(id, &loops, table)?, true),
            };
            if !same_sense {
                loops.iter_mut().for_each(reverse);
            }
            Ok(FaceGeometry { id, surface, bounds: loops, same_sense, ambiguous: false })
        })
    }

    /// CURVE_BOUNDED_SURFACE: a surface and closed curves on it, without topology.
    pub fn bounded_surface(&self, entity: Entity<'_>, table: &mut EdgeTable) -> Result<FaceGeometry, Fault> {
        let id = entity.id();
        let fields = entity.fields("CURVE_BOUNDED_SURFACE", 1)?;
        let mut bounds = Vec::new();
        for boundary in fields.references(1)? {
            let mut uses = Vec::new();
            for segment in self.segments(self.entity(boundary?)?)? {
                let index = match table.by_id.get(&segment.id) {
                    Some(&index) => index,
                    None => {
                        let fault = Fault::Value { id: segment.id, what: "a boundary curve without ends" };
                        let (start, end) = locate::ends(&segment.curve).ok_or(fault)?;
                        let edge = Edge { id: segment.id, curve: segment.curve, start, end, same_sense: true };
                        table.add(edge)
                    }
                };
                uses.push((index, segment.forward));
            }
            bounds.push(Boundary::Edges(uses));
        }
        let vertices: Vec<DVec3> = bounds.iter().flat_map(|b| table.vertices(b)).collect();
        let carrier = self.surface_near(fields.reference(0)?, &vertices)?;
        if carrier.flipped {
            bounds.iter_mut().for_each(reverse);
        }
        // .T.: its own border is the outer one, the curves are holes
        let implicit = fields.value(2).and_then(Value::flag) == Some(true);
        if implicit {
            bounds.push(Boundary::Natural);
        }
        // on spheres, writers let the curves run either way, though the face ought to be on their left
        let ambiguous = !implicit && matches!(carrier.surface, SurfaceGeometry::Sphere { .. });
        let same_sense = !carrier.flipped;
        Ok(FaceGeometry { id, surface: carrier.surface, bounds, same_sense, ambiguous })
    }

    fn bound(&self, id: u32, table: &mut EdgeTable) -> Result<Boundary, Fault> {
        let entity = self.entity(id)?;
        let fields = entity.fields("FACE_BOUND", 1).or_else(|_| entity.fields("FACE_OUTER_BOUND", 1))?;
        let mut boundary = self.boundary(fields.reference(0)?, table)?;
        if !fields.flag(1) {
            reverse(&mut boundary);
        }
        Ok(boundary)
    }

    fn boundary(&self, id: u32, table: &mut EdgeTable) -> Result<Boundary, Fault> {
        let entity = self.entity(id)?;
        if let Ok(fields) = entity.fields("VERTEX_LOOP", 1) {
            return Ok(Boundary::Vertex(self.vertex(fields.reference(0)?)?));
        }
        if let Ok(fields) = entity.fields("POLY_LOOP", 1) {
            let points: Vec<u32> = fields.references(0)?.collect::<Result<_, _>>()?;
            return self.polygon(id, &points, table);
        }
        let fields = entity.fields("PATH", 1).or_else(|_| entity.fields("EDGE_LOOP", 1))?;
        let mut uses = Vec::new();
        for oriented in fields.references(0)? {
            let oriented = self.entity(oriented?)?;
            self.ledger.spend(oriented.id(), 1)?;
            let kinds = ["ORIENTED_EDGE", "SEAM_EDGE"];
            // a complex instance of a seam keeps both in the part ORIENTED_EDGE
            let (edge, forward) = match kinds.iter().find_map(|k| oriented.fields(k, 3).ok()).ok_or(()) {
                Ok(fields) => (fields.reference(0)?, fields.flag(1)),
                // some writers list the edge itself
                Err(_) => (oriented.id(), true),
            };
            uses.push((self.edge(edge, table)?, forward));
        }
        if uses.is_empty() {
            return Err(Fault::Value { id, what: "the loop has no edge" });
        }
        Ok(Boundary::Edges(uses))
    }

    fn edge(&self, id: u32, table: &mut EdgeTable) -> Result<usize, Fault> {
        if let Some(&index) = table.by_id.get(&id) {
            return Ok(index);
        }
        let entity = self.entity(id)?;
        if let Ok(fields) = entity.fields("SUBEDGE", 3) {
            return self.part_of_edge(entity, fields.reference(0)?, table);
        }
        let fields = entity.fields("EDGE_CURVE", 1)?;
        let (ends, first) = match entity.fields("EDGE", 1) {
            Ok(ends) => (ends, 0),
            Err(_) => (fields, 2),
        };
        let (start, end) = (self.vertex(ends.reference(0)?)?, self.vertex(ends.reference(1)?)?);
        let curve = self.curve(fields.reference(first)?)?;
        Ok(table.add(Edge { id, curve, start, end, same_sense: fields.flag(first + 1) }))
    }

    /// SUBEDGE('',start,end,edge): the part of another edge between two points of it.
    fn part_of_edge(&self, entity: Entity<'_>, parent: u32, table: &mut EdgeTable) -> Result<usize, Fault> {
        let (id, ends) = (entity.id(), entity.fields("EDGE", 1).or_else(|_| entity.fields("SUBEDGE", 1))?);
        let (start, end) = (self.vertex(ends.reference(0)?)?, self.vertex(ends.reference(1)?)?);
        let parent = self.ledger.nested(id, || self.edge(parent, table))?;
        let Edge { curve, same_sense, .. } = table.edges[parent].clone();
        Ok(table.add(Edge { id, curve, start, end, same_sense }))
    }

    fn vertex(&self, id: u32) -> Result<DVec3, Fault> {
        self.point(self.entity(id)?.fields("VERTEX_POINT", 1)?.reference(0)?)
    }

    /// A closed polygon; sides are shared with the polygons that name the same two points.
    fn polygon(&self, id: u32, points: &[u32], table: &mut EdgeTable) -> Result<Boundary, Fault> {
        let mut points = points.to_vec();
        points.dedup();
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            return Err(Fault::Value { id, what: "a polygon needs three points" });
        }
        self.ledger.spend(id, points.len())?;
        let mut uses = Vec::new();
        for (i, &a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            let key = (a.min(b), a.max(b));
            let index = match table.by_points.get(&key) {
                Some(&index) => index,
                None => {
                    let (start, end) = (self.point(key.0)?, self.point(key.1)?);
                    let curve = CurveGeometry::Line { origin: start, direction: end - start };
                    table.edges.push(Edge { id, curve, start, end, same_sense: true });
                    table.by_points.insert(key, table.edges.len() - 1);
                    table.edges.len() - 1
                }
            };
            uses.push((index, a == key.0));
        }
        Ok(Boundary::Edges(uses))
    }

    /// The plane of a face that has polygons but no surface: Newell's normal of the largest one.
    fn polygon_plane(&self, id: u32, loops: &[Boundary], table: &EdgeTable) -> Result<SurfaceGeometry, Fault> {
        let normal = |boundary: &Boundary| -> (DVec3, DVec3) {
            let Boundary::Edges(uses) = boundary else { return (DVec3::ZERO, DVec3::ZERO) };
            let corner = |&(e, forward): &(usize, bool)| {
                let edge = &table.edges[e];
                if forward { edge.start } else { edge.end }
            };
            let origin = uses.first().map_or(DVec3::ZERO, corner);
            let sides = uses.iter().zip(uses.iter().cycle().skip(1));
            (origin, sides.map(|(a, b)| (corner(a) - origin).cross(corner(b) - origin)).sum())
        };
        let largest = loops.iter().map(normal).max_by(|a, b| a.1.length().total_cmp(&b.1.length()));
        let flat = Fault::Value { id, what: "a face without surface whose loops span no plane" };
        let (origin, normal) = largest.ok_or(flat.clone())?;
        Ok(SurfaceGeometry::Plane { frame: frame(origin, normal.try_normalize().ok_or(flat)?, None) })
    }
}

impl EdgeTable {
    /// The number of each edge in the file; sides of polygons and of swept areas have none.
    pub fn sources(&self) -> Vec<Option<EdgeSource>> {
        let mut all = vec![None; self.edges.len()];
        self.by_id.iter().for_each(|(&entity, &index)| all[index] = Some(EdgeSource { entity, item: None }));
        all
    }

    /// The ends of a bound's edges.
    fn vertices(&self, bound: &Boundary) -> Vec<DVec3> {
        let Boundary::Edges(uses) = bound else { return Vec::new() };
        uses.iter().flat_map(|(e, _)| [self.edges[*e].start, self.edges[*e].end]).collect()
    }

    fn add(&mut self, edge: Edge) -> usize {
        let index = self.edges.len();
        self.by_id.insert(edge.id, index);
        self.edges.push(edge);
        index
    }
}

fn reverse(boundary: &mut Boundary) {
    if let Boundary::Edges(uses) = boundary {
        uses.reverse();
        uses.iter_mut().for_each(|u| u.1 = !u.1);
    }
}
