//! The orientation of meshes: rays enter where a triangle faces them, and leave through the others.
//!
//! ```text
//!    file:  a corner for each triangle         here:  one corner for each place
//!           ╱│ │╲                                     ╱│╲
//!          ╱ │ │ ╲      edges are not shared         ╱ │ ╲     each edge is there once in each direction
//! ```

use super::self_intersection::bounds_space_once;
use super::{Primitive, Shape, Solid, SurfaceTable};
use crate::model::Mesh;
use glam::DVec3;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

/// The primitive's triangles as one mesh, own coordinates, which bounds each part of space once. `None` where they are
/// not closed, not oriented outwards, cross themselves or lie back to back, or where there are spline faces.
/// `coincidence` is that of [`Model::coincidence`](crate::model::Model::coincidence).
pub fn oriented_outwards(primitive: &Primitive, coincidence: f64) -> Option<Cow<'_, Mesh>> {
    let mesh = match &primitive.shape {
        Shape::Mesh(mesh) => Cow::Borrowed(&**mesh),
        Shape::Part(part) if part.faces.is_empty() => match part.meshes.as_slice() {
            [mesh] => Cow::Borrowed(mesh),
            meshes => Cow::Owned(together(meshes)),
        },
        _ => return None,
    };
    let mesh = if is_closed(&mesh) { mesh } else { Cow::Owned(welded(&mesh)) };
    let clean = is_closed(&mesh)
        && six_volumes(&mesh) > 0.0
        && !is_back_to_back(primitive, &mesh, coincidence)
        && bounds_space_once(&mesh);
    clean.then_some(mesh)
}

/// Every edge is there once in each direction.
pub(super) fn is_closed(mesh: &Mesh) -> bool {
    let mut edges: Vec<(u32, u32, bool)> = Vec::with_capacity(3 * mesh.triangles().len());
    for &[a, b, c] in mesh.triangles() {
        edges.extend([(a, b), (b, c), (c, a)].map(|(from, to)| (from.min(to), from.max(to), from < to)));
    }
    edges.sort_unstable();
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).all(|same| matches!(same, [(_, _, false), (_, _, true)]))
}

/// Six times the volume, own coordinates: positive where triangles run counter-clockwise from outside.
pub(super) fn six_volumes(mesh: &Mesh) -> f64 {
    let middle = mesh.bounds().centre();
    let corners = (0..mesh.triangles().len()).map(|t| mesh.corners(t).map(|p| p - middle));
    corners.map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

/// Some plane holds triangles of both orientations.
fn is_back_to_back(primitive: &Primitive, mesh: &Mesh, coincidence: f64) -> bool {
    let shape = match &primitive.shape {
        Shape::Mesh(own) if std::ptr::eq(&**own, mesh) => primitive.shape.clone(),
        _ => Shape::Mesh(Arc::new(mesh.clone())),
    };
    let Ok(solid) = Solid::of(Primitive { shape, ..primitive.clone() }) else { return true };
    let table = SurfaceTable::new(&solid, coincidence);
    let mut looks: Vec<[bool; 2]> = vec![[false; 2]; table.surfaces().len()];
    table.faces(0).iter().for_each(|face| looks[face.surface as usize][usize::from(face.flipped)] = true);
    looks.contains(&[true, true])
}

/// The triangles of several meshes, as one mesh.
fn together(meshes: &[Mesh]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let first = positions.len() as u32;
        positions.extend_from_slice(mesh.positions());
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| first + v)));
    }
    flat(positions, triangles)
}

/// The same with one vertex at each place, and without triangles that are a line or a point.
fn welded(mesh: &Mesh) -> Mesh {
    let mut at: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions().len());
    let mut positions: Vec<DVec3> = Vec::new();
    let first_there = mesh.positions().iter().map(|p| {
        // -0 and 0 are one place
        *at.entry((*p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
            positions.push(*p);
            positions.len() as u32 - 1
        })
    });
    let first_there: Vec<u32> = first_there.collect();
    let triangles = mesh.triangles().iter().map(|t| t.map(|v| first_there[v as usize]));
    flat(positions, triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect())
}

fn flat(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(0, positions, triangles, Vec::new()).expect("corners of meshes")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Part;
    use glam::DAffine3;

    const TETRA: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    /// A corner of a cube from `at`, each triangle with corners of its own.
    fn soup(at: DVec3, size: f64) -> Mesh {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| at + p * size);
        let positions = TETRA.iter().flatten().map(|v| corners[*v as usize]).collect();
        flat(positions, (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
    }

    fn triangles(shape: Shape) -> Option<usize> {
        let primitive = Primitive { shape, transform: DAffine3::IDENTITY, colour: [0.5; 4], id: 1 };
        oriented_outwards(&primitive, SurfaceTable::ROUNDED).map(|mesh| mesh.triangles().len())
    }

    fn of_mesh(mesh: Mesh) -> Option<usize> {
        triangles(Shape::Mesh(Arc::new(mesh)))
    }

    fn of_part(meshes: Vec<Mesh>) -> Option<usize> {
        triangles(Shape::Part(Arc::new(Part { meshes, closed: true, ..Part::default() })))
    }

    /// Corners at one place are one, -0 and 0 too; triangles that are a line go.
    #[test]
    fn corners_of_their_own_are_no_edges() {
        let own = soup(DVec3::ZERO, 1.0);
        assert!(!is_closed(&own) && is_closed(&welded(&own)));
        assert_eq!(of_mesh(own.clone()), Some(4));
        let negative = |(k, p): (usize, &DVec3)| if k % 2 == 0 && p.x == 0.0 { p.with_x(-0.0) } else { *p };
        let signed = own.positions().iter().enumerate().map(negative).collect();
        assert_eq!(of_mesh(flat(signed, own.triangles().to_vec())), Some(4));
        let line = [own.triangles(), &[[0, 1, 0]]].concat();
        assert_eq!(of_mesh(flat(own.positions().to_vec(), line)), Some(4));
        assert_eq!(of_mesh(flat(own.positions().to_vec(), own.triangles()[1..].to_vec())), None, "open");
    }

    /// Meshes of a part count as one: side by side, but neither crossing nor nested.
    #[test]
    fn meshes_of_a_part_are_asked_together() {
        let one = || soup(DVec3::ZERO, 1.0);
        assert_eq!(of_part(vec![one()]), Some(4));
        assert_eq!(of_part(vec![one(), soup(DVec3::X * 2.0, 1.0)]), Some(8));
        assert_eq!(of_part(vec![one(), soup(DVec3::X * 0.2, 1.0)]), None);
        assert_eq!(of_part(vec![one(), soup(DVec3::splat(0.1), 0.2)]), None);
        assert_eq!(triangles(Shape::Sphere { radius: 1.0 }), None);
    }
}
