//! Small exact shapes: surfaces of revolution, rectangles, loops.

use crate::model::{Camera, Face, Instance, Model, Part, Projection, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Control, Surface};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use std::f64::consts::FRAC_1_SQRT_2;

/// The unit circle from (1, 0), counter-clockwise, as 9 homogeneous points: four quarters of degree 2.
const CIRCLE: [(f64, f64, f64); 9] = {
    const W: f64 = FRAC_1_SQRT_2;
    [
        (1.0, 0.0, 1.0),
        (W, W, W),
        (0.0, 1.0, 1.0),
        (-W, W, W),
        (-1.0, 0.0, 1.0),
        (-W, -W, W),
        (0.0, -1.0, 1.0),
        (W, -W, W),
        (1.0, 0.0, 1.0),
    ]
};

/// Knots of `pieces` quarters of degree 2 over `[0, pieces]`.
fn quarters(pieces: usize) -> Vec<f64> {
    let inner = (1..pieces).flat_map(|k| [k as f64; 2]);
    [0.0; 3].into_iter().chain(inner).chain([pieces as f64; 3]).collect()
}

/// `profile` (homogeneous radius, height, weight) turned about z; `u` along the turn.
fn revolved(profile: &[DVec3], degree: usize, knots: Vec<f64>) -> Surface {
    let row = |p: &DVec3| CIRCLE.map(|(x, y, w)| DVec4::new(p.x * x, p.x * y, p.y * w, p.z * w));
    Surface::new((2, degree), quarters(4), knots, profile.iter().flat_map(row).collect()).unwrap()
}

/// A whole unit sphere about the origin: poles at z = ±1, a seam at y = 0, x > 0.
pub fn sphere() -> Surface {
    let half: Vec<DVec3> = [6, 7, 8, 1, 2].map(|k: usize| CIRCLE[k]).map(|(r, z, w)| DVec3::new(r, z, w)).to_vec();
    revolved(&half, 2, quarters(2))
}

/// A torus about z.
pub fn torus(major: f64, minor: f64) -> Surface {
    let tube = CIRCLE.map(|(r, z, w)| DVec3::new(major * w + minor * r, minor * z, w));
    revolved(&tube, 2, quarters(4))
}

/// The unit cylinder about z between heights -1 and 1.
pub fn cylinder() -> Surface {
    revolved(&[DVec3::new(1.0, -1.0, 1.0), DVec3::new(1.0, 1.0, 1.0)], 1, vec![0.0, 0.0, 1.0, 1.0])
}

/// The parallelogram `origin + u a + v b`, `u` and `v` in `[0, 1]`.
pub fn rectangle(origin: DVec3, a: DVec3, b: DVec3) -> Surface {
    let points = [origin, origin + a, origin + b, origin + a + b].map(|p| DVec4::from_point(p, 1.0));
    Surface::new((1, 1), vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], points.to_vec()).unwrap()
}

/// One Bézier patch.
pub fn patch(degrees: (usize, usize), points: Vec<DVec4>) -> Surface {
    let knots = |n: usize| [vec![0.0; n + 1], vec![1.0; n + 1]].concat();
    Surface::new(degrees, knots(degrees.0), knots(degrees.1), points).unwrap()
}

/// A polygon in `(u, v)`.
pub fn polygon(corners: &[DVec2]) -> TrimLoop {
    let n = corners.len();
    let curves = (0..n).map(|i| Bezier::line(corners[i], corners[(i + 1) % n])).collect();
    TrimLoop::new(curves, DVec2::ZERO).unwrap()
}

/// A clockwise circle in `(u, v)`: a hole.
pub fn hole(centre: DVec2, radius: f64) -> TrimLoop {
    let at = |k: usize| {
        let (x, y, w) = CIRCLE[k];
        DVec3::new(x * radius + centre.x * w, y * radius + centre.y * w, w)
    };
    let curves = (0..4).map(|q| Bezier { points: (2 * q..=2 * q + 2).map(at).collect() }).collect();
    TrimLoop::new(curves, DVec2::splat(1e-12)).unwrap().reversed()
}

pub fn face(id: u32, surface: Surface, loops: Vec<TrimLoop>) -> Face {
    Face { id, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None }
}

/// One part of `faces`, placed by each of `transforms`.
pub fn model(faces: Vec<Face>, transforms: &[DAffine3]) -> Model {
    let place = |t: &DAffine3| Instance { part: 0, transform: *t, colour: None, name: String::new() };
    Model {
        parts: vec![Part { faces, ..Part::default() }],
        instances: transforms.iter().map(place).collect(),
        ..Model::default()
    }
}

pub fn single(surface: Surface) -> Model {
    model(vec![face(1, surface, vec![])], &[DAffine3::IDENTITY])
}

/// A 100 by 80 view of the origin from `eye`, perspective, 40° high.
pub fn view(eye: DVec3) -> Camera {
    Camera {
        eye,
        target: DVec3::ZERO,
        up: DVec3::new(0.1, 0.2, 1.0),
        projection: Projection::Perspective { fov_y: 40f64.to_radians() },
        depth_range: (1e-3, 1e3),
        size: (100, 80),
    }
}

/// The same as a parallel view, 3 units high.
pub fn parallel(eye: DVec3) -> Camera {
    Camera { projection: Projection::Orthographic { height: 3.0 }, ..view(eye) }
}

/// A view whose middle ray runs along `direction` and passes through `through`.
pub fn aimed(through: DVec3, direction: DVec3) -> Camera {
    let eye = through - direction.normalize() * 5.0;
    let up = direction.any_orthogonal_vector();
    Camera { target: through, up, ..view(eye) }
}

/// The pixel position on the view axis.
pub const MIDDLE: DVec2 = DVec2::new(50.0, 40.0);

/// Numbers in [-1, 1] that look random: the same on every machine.
pub fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
