//! The side of a surface that is lit.

use crate::shapes;
use crate::support::{assert_silent, render, watched};
use glam::{DVec2, DVec3};
use selvedge::model::{Camera, Projection};

const SIZE: (u32, u32) = (160, 120);
/// Cosine between ray and normal above which rounding does not change the visible side.
const CLEARLY: f64 = 0.02;

/// A sphere near the eye and beside the view's axis: along its outline on the side of the axis, normals that point to
/// the eye point away from the picture plane. As a shell, lit on the visible side, it is as bright as a solid, lit on
/// its outside.
#[test]
fn the_side_that_the_eye_sees_is_lit() {
    let camera = Camera {
        eye: DVec3::new(0.0, -6.0, 0.0),
        target: DVec3::new(8.5, 0.0, 1.0),
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 1.4 },
        depth_range: (0.5, 20.0),
        size: SIZE,
    };
    let axis = (camera.target - camera.eye).normalize();
    let pictures = [true, false].map(|closed| {
        let mut model = shapes::sphere();
        model.parts[0].closed = closed;
        let mut renderer = watched(&model);
        let picture = render(&mut renderer, &camera);
        assert_silent(renderer);
        picture
    });
    let mut turned = 0;
    for i in (0..pictures[0].face.len()).filter(|&i| pictures[0].face[i] != 0) {
        let pixel = DVec2::new((i as u32 % SIZE.0) as f64 + 0.5, (i as u32 / SIZE.0) as f64 + 0.5);
        let normal = DVec3::from(pictures[0].normal[i].map(f64::from));
        if normal.dot(camera.ray(pixel).1.normalize()) < -CLEARLY {
            turned += usize::from(normal.dot(axis) > CLEARLY);
            assert_eq!(pictures[0].colour[i], pictures[1].colour[i], "at {pixel}");
        }
    }
    assert!(turned > 50, "only {turned} normals look away from the picture and at the eye");
}
