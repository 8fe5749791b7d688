//! Edges of the spline parts and meshes that bound Boolean solids, and the outlines of sections through them.
//!
//! ```text
//!   operand ─Part::edges─▶ edges ──────────────┐ pieces on the kept side of the solid's sections
//!           ─Part::cut, by its sections─▶ outlines, bold ─▶ EdgeLine, EdgePiece, PieceInstance, as those of placed parts
//! ```
//!
//! Where other primitives cut the solid, a line is drawn only where a pixel beside it sees a face of its own: none in a
//! solid that is seen through.

use super::data::SceneData;
use super::edges::{EdgeData, UndrawnEdges};
use super::solids::Operand;
use crate::abi;
use crate::math::bernstein::{sign_changes, value};
use crate::model::{Edges, Mesh, Model, Part, Primitive, Shape, Solid};
use crate::picture::{EdgeChoice, LineStyle};
use crate::spline::Bezier;
use glam::DVec4;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// Points of which the scalar product with `(normal, -offset)` is negative stay.
type Kept = DVec4;

/// How an operand is cut.
struct Cuts {
    /// By sections, own coordinates.
    sections: Vec<Kept>,
    /// And by nothing else.
    alone: bool,
}

/// Edges of operands: of each shape once.
#[derive(Default)]
struct Known(HashMap<*const (), Edges>);

impl Known {
    fn of(&mut self, shape: &Shape, model: &Model) -> Result<Option<&Edges>, UndrawnEdges> {
        let (key, bare);
        let part: &Part = match shape {
            Shape::Part(part) => {
                key = Arc::as_ptr(part).cast();
                part
            }
            Shape::Mesh(mesh) => {
                key = Arc::as_ptr(mesh).cast();
                bare = Part { meshes: vec![Mesh::clone(mesh)], ..Part::default() };
                &bare
            }
            _ => return Ok(None),
        };
        if let Entry::Vacant(none) = self.0.entry(key) {
            let named = model.parts.iter().position(|p| p.name == part.name);
            none.insert(part.edges().map_err(|source| UndrawnEdges { part: named.unwrap_or_default(), source })?);
        }
        Ok(self.0.get(&key))
    }
}

impl SceneData {
    /// Adds the edges of operands to those of the placed parts.
    pub(crate) fn find_edges_of_operands(&mut self, model: &Model) -> Result<(), UndrawnEdges> {
        let Some(data) = self.edges.as_mut().filter(|data| data.settings.which != EdgeChoice::None) else {
            return Ok(());
        };
        let mut known = Known::default();
        // A leaf that rays are followed through and that is alone in its list is a placed part or mesh. Its edges are
        // among those of the placed parts already.
        let is_of_solid = |operand: &&Operand| {
            let leaf = self.solids.operand_leaves[operand.number as usize];
            leaf < self.solids.followed || self.solids.is_in_clear_solid(leaf)
        };
        for operand in self.solids.operands.iter().filter(is_of_solid) {
            let Some(edges) = known.of(&operand.primitive.shape, model)? else { continue };
            let meshes = &self.solids.operand_meshes[operand.meshes.clone()];
            let first_triangles: Vec<u32> = meshes.iter().map(|mesh| mesh.first_triangle).collect();
            data.push_operand(operand, edges, &first_triangles, &cuts_of(model, &operand.primitive));
        }
        Ok(())
    }
}

impl EdgeData {
    fn push_operand(&mut self, operand: &Operand, edges: &Edges, first_triangles: &[u32], cuts: &Cuts) {
        let Some((placement, first_face)) = operand.placed else { return };
        let near = if cuts.alone { 0 } else { abi::EDGE_NEAR };
        let settings = self.settings;
        let mut push = |style, (own, off): (Vec<u32>, f64), pieces: &[Bezier<DVec4>], flags: u32| {
            if pieces.is_empty() {
                return;
            }
            self.push_line(abi::SOLID_NUMBER, style, own, off, flags);
            for piece in pieces {
                let piece = self.push_piece(&piece.points, operand.origin);
                // of no instance of the model
                self.piece_instances.push(abi::PieceInstance { piece, placement, instance: 0 });
            }
        };
        let face = |face: usize| (first_face + face) as u32;
        for edge in &edges.edges {
            let Some(style) = settings.style(edge.kind) else { continue };
            let pieces: Vec<_> = edge.curve.iter().flat_map(|span| kept(&span.piece, &cuts.sections, None)).collect();
            push(style, (edge.uses.iter().map(|u| face(u.face)).collect(), edge.deviation), &pieces, near);
        }
        // beside faces meshes bound nothing
        for edge in edges.of_meshes.iter().filter(|_| !first_triangles.is_empty()) {
            let Some(style) = settings.style(edge.kind) else { continue };
            let own =
                edge.triangles.iter().map(|(mesh, nth)| abi::OWN_TRIANGLE | (first_triangles[*mesh] + *nth as u32));
            let [from, to] = edge.ends;
            push(style, (own.collect(), 0.0), &kept(&Bezier::line(from, to), &cuts.sections, None), near);
        }
        for (nth, section) in cuts.sections.iter().enumerate() {
            let plane = (section.truncate(), -section.w);
            let outlines = match &operand.primitive.shape {
                Shape::Part(part) => part.cut(plane.0, plane.1),
                Shape::Mesh(mesh) => mesh.cut(plane.0, plane.1),
                _ => Vec::new(),
            };
            for cut in outlines {
                let pieces: Vec<_> =
                    cut.pieces.iter().flat_map(|piece| kept(piece, &cuts.sections, Some(nth))).collect();
                push(LineStyle::Bold, (cut.face.map(face).into_iter().collect(), edges.deviation), &pieces, 0);
            }
        }
    }
}

/// What cuts the primitive in the solids that it is of.
fn cuts_of(model: &Model, operand: &Primitive) -> Cuts {
    let is_it = |p: &Primitive| match (&p.shape, &operand.shape) {
        (Shape::Part(a), Shape::Part(b)) => Arc::ptr_eq(a, b) && p.transform == operand.transform,
        (Shape::Mesh(a), Shape::Mesh(b)) => Arc::ptr_eq(a, b) && p.transform == operand.transform,
        _ => false,
    };
    let solid = model.solids.iter().find(|solid| solid.primitives().iter().any(is_it));
    let others: Vec<&Primitive> =
        solid.map(Solid::primitives).unwrap_or_default().iter().filter(|p| !is_it(p)).collect();
    let sections = others.iter().filter(|p| model.cuts.contains(&p.id)).filter_map(|p| {
        let (normal, offset) = match &p.shape {
            Shape::HalfSpace { normal, offset } => (*normal, *offset),
            Shape::Block { max, .. } => (glam::DVec3::Z, max.z),
            _ => return None,
        };
        // n . (A x) with A from the operand's coordinates to the section's
        let to_own = p.transform.inverse() * operand.transform;
        let own = to_own.matrix3.transpose() * normal;
        let kept = own.extend(normal.dot(to_own.translation) - offset);
        Some(kept / own.length())
    });
    let sections: Vec<Kept> = sections.collect();
    Cuts { alone: sections.len() == others.len(), sections }
}

/// What all sections but one keep of a piece.
fn kept(piece: &Bezier<DVec4>, sections: &[Kept], but: Option<usize>) -> Vec<Bezier<DVec4>> {
    let others = sections.iter().enumerate().filter(|(nth, _)| Some(*nth) != but).map(|(_, section)| section);
    others.fold(vec![piece.clone()], |pieces, section| {
        let parts = pieces.iter().flat_map(|piece| {
            let heights: Vec<f64> = piece.points.iter().map(|p| section.dot(*p)).collect();
            let mut at = vec![0.0];
            at.extend(sign_changes(&heights, &vec![0.0; heights.len()]));
            at.push(1.0);
            let ranges: Vec<(f64, f64)> = at.windows(2).map(|w| (w[0], w[1])).filter(|(a, b)| a < b).collect();
            let stays = move |(a, b): &(f64, f64)| value(&heights, 0.5 * (a + b)) < 0.0;
            ranges.into_iter().filter(stays).map(|(a, b)| piece.segment(a, b)).collect::<Vec<_>>()
        });
        parts.collect()
    })
}
