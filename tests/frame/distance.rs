//! A small part far from the origin is drawn as well as at the origin.

use crate::shapes;
use crate::support::{assert_silent, perspective, render, watched};
use glam::DVec3;
use selvedge::model::Camera;

/// Size of the part's features.
const FEATURE: f64 = 1e-3;

/// The part's control points are relative to its centre, and the view is composed in double precision. At 1e6 the
/// model's own rounding remains, 1e6 * 2^-53 = 1.1e-10 or 1e-7 of the feature, and a few times that from composing the
/// view: 1e-4 pixels. So only a pixel whose centre lies on a border may change its face. Depth, 4e-3 from the eye,
/// agrees to single precision.
#[test]
fn a_part_at_a_million_looks_as_at_the_origin() {
    let size = (320, 240);
    let [near, far] = [DVec3::ZERO, DVec3::splat(1e6)].map(|offset| {
        let model = shapes::far_away(offset);
        let camera = perspective(&shapes::far_away(DVec3::ZERO), size);
        let camera = Camera { eye: camera.eye + offset, target: camera.target + offset, ..camera };
        let mut renderer = watched(&model);
        let picture = render(&mut renderer, &camera);
        assert_silent(renderer);
        picture
    });
    let both: Vec<usize> = (0..near.face.len()).filter(|&i| near.face[i] == far.face[i]).collect();
    let changed = near.face.len() - both.len();
    assert!(changed <= 2, "{changed} pixels show another face");
    for face in [1, 2] {
        assert!(near.face.iter().filter(|&&f| f == face).count() > 2000, "face {face} is hardly in the picture");
    }
    let depth = both.iter().filter(|&&i| near.face[i] != 0).map(|&i| f64::from((near.depth[i] - far.depth[i]).abs()));
    let worst = depth.fold(0.0, f64::max);
    assert!(worst < 1e-3 * FEATURE, "depth differs by {worst:e}");
}
