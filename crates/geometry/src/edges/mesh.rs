//! Creases and borders of triangles, and the sides between, which are outlines in some views.
//!
//! ```text
//!      ╱│╲        sides that two triangles share, if these turn by more than the limit    crease
//!     ╱ │ ╲       sides of one triangle                                                   border
//! ```
//!
//! Corners at the same place, bit for bit, are one, across all meshes of a part. So formats without shared vertices,
//! and files with a mesh a face, have the same creases. A triangle without area has no angle: its sides are neither. A
//! side of three triangles or more is a crease.

use crate::model::{EdgeKind, Mesh, MeshEdge, SmoothSide};
use glam::DVec3;
use std::collections::HashMap;

/// The creases and borders of all meshes, in the order of their first triangle.
pub(super) fn edges(meshes: &[Mesh], crease: f64) -> Vec<MeshEdge> {
    let mut found = sides(meshes);
    found.retain_mut(|edge| {
        let kind = kind(meshes, edge, crease);
        edge.kind = kind.unwrap_or(edge.kind);
        kind.is_some()
    });
    found
}

/// The sides of two triangles that are neither, in the order of their first triangle.
pub(super) fn smooth_sides(meshes: &[Mesh], crease: f64) -> Vec<SmoothSide> {
    let smooth = |side: &MeshEdge| {
        let &[a, b] = &side.triangles[..] else { return None };
        let third = |(mesh, triangle): (usize, usize)| {
            let [a, b, c] = meshes[mesh].corners(triangle);
            let has_area = (b - a).cross(c - a).length() > 0.0;
            [a, b, c].into_iter().find(|corner| !side.ends.contains(corner)).filter(|_| has_area)
        };
        let beside = [third(a)?, third(b)?];
        kind(meshes, side, crease).is_none().then_some(SmoothSide { ends: side.ends, beside })
    };
    sides(meshes).iter().filter_map(smooth).collect()
}

/// All sides with their triangles, as borders.
fn sides(meshes: &[Mesh]) -> Vec<MeshEdge> {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
    let mut number = |p: DVec3| {
        let next = numbers.len() as u32;
        // minus zero is zero
        *numbers.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert(next)
    };
    let mut sides: HashMap<(u32, u32), usize> = HashMap::new();
    let mut found: Vec<MeshEdge> = Vec::new();
    for (mesh, m) in meshes.iter().enumerate() {
        for triangle in 0..m.triangles().len() {
            let corners = m.corners(triangle);
            let at = corners.map(&mut number);
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                if at[i] == at[j] {
                    continue;
                }
                let next = found.len();
                let side = *sides.entry((at[i].min(at[j]), at[i].max(at[j]))).or_insert(next);
                if side == next {
                    let ends = [corners[i], corners[j]];
                    found.push(MeshEdge { ends, triangles: Vec::new(), kind: EdgeKind::Border });
                }
                found[side].triangles.push((mesh, triangle));
            }
        }
    }
    found
}

/// `None` for a side that is neither.
fn kind(meshes: &[Mesh], edge: &MeshEdge, crease: f64) -> Option<EdgeKind> {
    let along = edge.ends[1] - edge.ends[0];
    // the direction into each triangle, across the side
    let inward = |&(mesh, triangle): &(usize, usize)| {
        let [a, b, c] = meshes[mesh].corners(triangle);
        let from = (a + b + c) / 3.0 - edge.ends[0];
        let area = (b - a).cross(c - a).length();
        let across = from - along * (from.dot(along) / along.length_squared());
        across.try_normalize().filter(|_| area > 0.0)
    };
    let inwards: Option<Vec<DVec3>> = edge.triangles.iter().map(inward).collect();
    match inwards?[..] {
        [_] => Some(EdgeKind::Border),
        [a, b] if a.angle_between(-b) <= crease => None,
        _ => Some(EdgeKind::Sharp),
    }
}
