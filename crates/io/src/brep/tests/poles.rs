//! Edges through the poles of a sphere, and loops that do not say which side of them is the face.

use super::*;

const RADIUS: f64 = 5.0;

/// The circle in which a plane at `distance` from the centre along the unit normal cuts the sphere, from the local
/// angles `marks`, counter-clockwise about the normal.
fn cut(list: &mut Vec<Edge>, f: Frame, normal: DVec3, distance: f64, marks: &[f64]) -> Vec<(usize, bool)> {
    let radius = (RADIUS * RADIUS - distance * distance).sqrt();
    // x leads towards the upper pole
    let frame = Frame::new(f.origin + normal * distance, normal, f.z).unwrap();
    let at = |a: f64| frame.world(DVec3::new(radius * a.cos(), radius * a.sin(), 0.0));
    let next = |i: usize| marks[(i + 1) % marks.len()];
    (0..marks.len()).map(|i| (edge(list, circle(frame, radius), at(marks[i]), at(next(i))), true)).collect()
}

/// Area of the cap beyond a plane.
fn cap(distance: f64) -> f64 {
    TAU * RADIUS * (RADIUS - distance)
}

/// A small circle that passes through the upper pole, or just beside it, as border, as the border of the rest, and as a
/// hole of what lies above a rim. Its vertices are the pole, the point farthest from it (then a sample falls on the pole),
/// or neither.
#[test]
fn an_edge_through_a_pole_bounds_what_it_should() {
    let tilt = 0.3;
    let f = odd_frame();
    let normal = f.z * f64::cos(tilt) + f.x * f64::sin(tilt);
    for off in [0.0, 1e-6, -1e-6, 1e-5, -1e-3, 1e-3] {
        let distance = RADIUS * f64::cos(tilt + off / RADIUS);
        let (within, above) = (cap(distance), cap(-4.0));
        for marks in [&[0.0][..], &[PI], &[0.7, 2.9]] {
            let build = |backwards: bool, rim: bool| {
                let mut edges = Vec::new();
                let mut bound = cut(&mut edges, f, normal, distance, marks);
                if backwards {
                    bound.reverse();
                    bound.iter_mut().for_each(|e| e.1 = false);
                }
                let mut bounds = vec![Boundary::Edges(bound)];
                if rim {
                    bounds.push(Boundary::Edges(cut(&mut edges, f, f.z, -4.0, &[0.4])));
                }
                let surface = SurfaceGeometry::Sphere { frame: f, radius: RADIUS };
                build_face(&face(surface, bounds), &edges, TOLERANCE)
            };
            let cases = [(false, false, within), (true, false, cap(-RADIUS) - within), (true, true, above - within)];
            for (backwards, rim, expected) in cases {
                let named = format!("{off:e} {marks:?} {backwards} {rim}");
                let built = build(backwards, rim).unwrap_or_else(|e| panic!("{named}: {e}"));
                let area = surface_area(&built.face);
                assert!((area - expected).abs() < 1e-5 * expected, "{named}: {area}, not {expected}");
                // an edge that passes a pole within the tolerance is drawn through it
                assert!(built.deviation < off.abs() + 1e-5, "{named}: {}", built.deviation);
            }
        }
    }
}
