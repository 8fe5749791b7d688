//! Solids whose faces end where their surfaces end, with loops along their sides, as in CAD files.

use super::meshes::block_mesh;
use super::{circle, face, one, placed, plane, rectangle, revolved, sphere_surface};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::model::{Face, Instance, Model, Part, SurfaceKind, TrimLoop};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A closed drum of this radius, face 1, from z = 0 up to the height, faces 2 and 3.
pub fn drum(radius: f64, height: f64) -> Model {
    let mantle = revolved(1, vec![0.0, 0.0, height, height], &[(radius, 0.0, 1.0), (radius, height, 1.0)], DVec3::ZERO);
    let seam = rectangle(DVec2::ZERO, DVec2::new(TAU, height));
    let end = |id, z: f64| Face {
        loops: vec![circle(DVec2::ZERO, radius)],
        same_sense: z > 0.0,
        ..face(id, SurfaceKind::Plane, plane(DVec3::Z * z, DVec3::X, DVec3::Y, radius))
    };
    let mantle = Face { loops: vec![seam], ..face(1, SurfaceKind::Cylinder, mantle) };
    one("drum", true, vec![mantle, end(2, height), end(3, 0.0)])
}

/// A closed ball of radius 1 whose one face has a loop along its seam and its poles.
pub fn seamed_ball() -> Model {
    let seam = rectangle(DVec2::new(0.0, -FRAC_PI_2), DVec2::new(TAU, FRAC_PI_2));
    let ball = face(1, SurfaceKind::Sphere, sphere_surface(1.0, DVec3::ZERO));
    one("seamed ball", true, vec![Face { loops: vec![seam], ..ball }])
}

/// Two drums of radius 1, one behind the other, whose sides overlap by this much at x = 0 as seen along y. They are
/// turned so that no patch ends at a silhouette.
pub fn drums_in_line(overlap: f64) -> Model {
    let mut model = drum(1.0, 4.0);
    let turned = DAffine3::from_rotation_z(0.5);
    let beside = |x: f64, y: f64| DAffine3::from_translation(DVec3::new(x, y, 0.0)) * turned;
    let x = 1.0 - overlap * 0.5;
    model.instances = vec![placed(beside(-x, 0.0), None), placed(beside(x, 4.0), None)];
    model
}

/// Two solid blocks, faces 1 to 6 and 11 to 16, that share a wall, with their tops in one plane.
pub fn abutting() -> Model {
    let mut model = one("left", true, block(0, DVec3::new(-3.0, -2.0, 0.0), DVec3::new(0.0, 2.0, 1.0)));
    let faces = block(10, DVec3::new(0.0, -1.5, -0.5), DVec3::new(2.5, 2.5, 1.0));
    model.parts.push(Part { name: "right".to_owned(), faces, closed: true, ..Part::default() });
    model.instances.push(Instance { part: 1, ..placed(DAffine3::IDENTITY, None) });
    model
}

/// Faces `id + 1` to `id + 6` of a block.
fn block(id: u32, low: DVec3, high: DVec3) -> Vec<Face> {
    let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let side = |k: usize| {
        let (axis, sign) = (k / 2, if k.is_multiple_of(2) { 1.0 } else { -1.0 });
        let (x, y) = (DVec3::AXES[(axis + 1) % 3] * half, DVec3::AXES[(axis + 2) % 3] * half);
        let surface = plane(centre + DVec3::AXES[axis] * half * sign, x, y, 1.0);
        let whole: TrimLoop = rectangle(DVec2::NEG_ONE, DVec2::ONE);
        let id = id + 1 + k as u32;
        Face { loops: vec![whole], same_sense: sign > 0.0, ..face(id, SurfaceKind::Plane, surface) }
    };
    (0..6).map(side).collect()
}

/// A drum over a floor of facets; before it, seen from above, thin bars of facets. Where a bar hides the neighbour of a
/// pixel at the drum's border, there is no evidence that the drum ends.
pub fn barred() -> Model {
    let mut model = drum(1.5, 4.0);
    let bar = |k: u32| {
        let x = -2.0 + 0.37 * f64::from(k);
        block_mesh(DVec3::new(x, -3.0, 4.5), DVec3::new(x + 0.12, 3.0, 4.6), 40 + k)
    };
    let floor = block_mesh(DVec3::new(-4.0, -4.0, -1.5), DVec3::new(4.0, 4.0, -1.0), 30);
    let meshes = (0..11).map(bar).chain([floor]).collect();
    model.parts.push(Part { name: "facets".to_owned(), meshes, ..Part::default() });
    model.instances.push(Instance { part: 1, ..placed(DAffine3::IDENTITY, None) });
    model
}
