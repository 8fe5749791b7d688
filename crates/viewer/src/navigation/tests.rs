//! The fixed points and directions of moves.

use super::*;

const BOX: Bounds = Bounds { min: DVec3::new(-40.0, -10.0, 0.0), max: DVec3::new(60.0, 30.0, 20.0) };

fn cameras() -> [Camera; 2] {
    let perspective = Camera::around(BOX, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, FOV, (1280, 800));
    [perspective, settle(&other_projection(&perspective), BOX)]
}

fn pixel(camera: &Camera, p: DVec3) -> DVec2 {
    camera.project(p).expect("in front of the eye").0
}

/// Rounding of a picture of 1280 pixels: 2⁻⁵² of it, times the number of operations.
const STILL_PX: f64 = 1e-8;

#[test]
fn orbit_leaves_its_pivot_where_it_is() {
    let pivot = DVec3::new(35.0, 12.0, 17.0);
    for camera in cameras() {
        for style in [OrbitStyle::Turntable, OrbitStyle::Free] {
            let moved = orbit(&camera, pivot, DVec2::new(170.0, -90.0), style);
            assert!(pixel(&moved, pivot).distance(pixel(&camera, pivot)) < STILL_PX);
            let turned = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                let other = pivot + axis * 10.0;
                pixel(&moved, other).distance(pixel(&camera, other))
            });
            assert!(turned.iter().any(|pixels| *pixels > 20.0), "nothing turned");
        }
    }
}

#[test]
fn a_roll_turns_the_picture_counterclockwise_about_its_pivot() {
    let pivot = DVec3::new(35.0, 12.0, 17.0);
    for camera in cameras() {
        let (right, _, _) = camera.axes();
        let beside = |camera: &Camera| pixel(camera, pivot + right * 10.0) - pixel(camera, pivot);
        let rolled = roll(&camera, pivot, std::f64::consts::FRAC_PI_2);
        assert!(pixel(&rolled, pivot).distance(pixel(&camera, pivot)) < STILL_PX);
        let (before, after) = (beside(&camera), beside(&rolled));
        assert!(before.x > 10.0 && after.distance(DVec2::new(0.0, -before.x)) < STILL_PX, "{before} {after}");
    }
}

#[test]
fn a_turntable_stays_upright_and_stops_at_the_pole() {
    let mut camera = cameras()[0];
    for _ in 0..40 {
        camera = orbit(&camera, BOX.centre(), DVec2::new(33.0, 60.0), OrbitStyle::Turntable);
        let (right, up, _) = camera.axes();
        assert!(right.z.abs() < 1e-12 && up.z > -1e-12, "{right} {up}");
    }
    let (_, _, forward) = camera.axes();
    assert!((forward.z + 1.0).abs() < 1e-12, "the pole is reached: {forward}");
    let back = orbit(&camera, BOX.centre(), DVec2::new(0.0, -80.0), OrbitStyle::Turntable);
    assert!(back.axes().2.z > -0.999);
}

#[test]
fn zoom_leaves_its_anchor_where_it_is_over_a_million_times() {
    let anchor = DVec3::new(59.9, 29.0, 19.5);
    for start in cameras() {
        let (mut camera, before) = (start, pixel(&start, anchor));
        for _ in 0..60 {
            camera = settle(&zoom(&camera, anchor, 0.79), BOX);
            assert!(pixel(&camera, anchor).distance(before) < 1e-5, "{camera:?}");
            assert_eq!(camera.check(), Ok(()));
            let z = depth(&camera, anchor);
            assert!(z > camera.depth_range.0 && z < camera.depth_range.1, "the anchor is cut away: {camera:?}");
        }
        let scale = |c: &Camera| {
            let step = c.axes().0 * 1e-9;
            pixel(c, anchor + step * 1e3).distance(pixel(c, anchor)) * 1e-3
        };
        let times = scale(&camera) / scale(&start);
        assert!((times / 0.79_f64.powi(-60) - 1.0).abs() < 1e-3, "{times}");
    }
}

#[test]
fn what_is_panned_sticks_to_the_cursor() {
    let anchor = DVec3::new(-3.0, 4.0, 20.0);
    for camera in cameras() {
        let to = DVec2::new(123.0, 700.0);
        assert!(pixel(&pan(&camera, anchor, to), anchor).distance(to) < STILL_PX);
    }
}

#[test]
fn what_fits_lies_in_the_picture_and_fills_it() {
    for camera in cameras() {
        let fitted = settle(&fit(&camera, &BOX.corners()), BOX);
        let pixels = BOX.corners().map(|p| pixel(&fitted, p));
        let (low, high) = pixels.iter().fold((DVec2::MAX, DVec2::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
        assert!(low.min_element() >= 0.0 && high.x <= 1280.0 && high.y <= 800.0, "{low} {high}");
        assert!(high.x - low.x > 0.5 * 1280.0 || high.y - low.y > 0.5 * 800.0, "{low} {high}");
        assert!(BOX.corners().iter().all(|p| {
            let z = depth(&fitted, *p);
            z >= fitted.depth_range.0 && z <= fitted.depth_range.1
        }));
    }
}

#[test]
fn projections_agree_at_the_target_and_lead_back() {
    let [perspective, _] = cameras();
    let parallel = settle(&other_projection(&perspective), BOX);
    let step = perspective.axes().0 * 3.0;
    let size = |c: &Camera| pixel(c, perspective.target + step).distance(pixel(c, perspective.target));
    // a point beside the target lies at its depth
    assert!((size(&parallel) / size(&perspective) - 1.0).abs() < 1e-12);
    let back = other_projection(&parallel);
    assert!((size(&back) / size(&perspective) - 1.0).abs() < 1e-12);
}

#[test]
fn a_move_that_would_show_nothing_is_not_made() {
    for camera in cameras() {
        assert_eq!(zoom(&camera, camera.target, 0.0), camera);
        assert_eq!(zoom(&camera, camera.target, f64::NAN), camera);
    }
}
