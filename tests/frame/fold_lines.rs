//! Outlines where a face is narrow beside a smooth edge or a seam: no pixel's centre leads to the fold, and it counts
//! only where the face's trims leave it.

use crate::edge_lines::{
    WIDTH, centres, draw, draw_next, faults_of_outline, lines, of_wider_cylinder, rounded_block, with,
};
use crate::shapes;
use crate::support::{assert_silent, orthographic};
use crate::watched::renderer;
use glam::{DVec2, DVec3, DVec4};
use selvedge::model::{Camera, Model, Projection, SurfaceKind};
use selvedge::picture::{EdgeChoice, EdgeSettings, SceneSettings, TrimWay};
use selvedge::spline::Surface;
use selvedge_check::Tracer;
use selvedge_check::drawing::{DrawingSettings, LineImage, judge_lines};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

const SIZE: (u32, u32) = (160, 120);

/// [`rounded_block`] whose fillet is left so far from the top, in degrees of its arc.
fn cut_fillet(radius: f64, degrees: f64) -> Model {
    let mut model = rounded_block(radius);
    let part = &mut model.parts[0];
    part.closed = false;
    let fillet = &mut part.faces[2];
    of_wider_cylinder(fillet, radius);
    let angle = |u: f64| {
        let place = fillet.surface.point(u, 0.0).truncate() - DVec2::splat(2.0 - radius);
        place.y.atan2(place.x)
    };
    // angles grow with u
    let at = |degrees: f64| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let u = 0.5 * (low + high);
            if angle(u) < degrees.to_radians() { low = u } else { high = u }
        }
        low
    };
    let (from, to) = (at(90.0 - degrees), at(90.0));
    fillet.loops = vec![shapes::rectangle(DVec2::new(from, 0.0), DVec2::new(to, 1.0))];
    model
}

/// The fillet would fold a third of a pixel beyond its smooth edge, 1.5 px away on the surface; another trim ends it
/// before. The whole one has the outline.
#[test]
fn a_fold_beyond_another_trim_is_no_line() {
    let radius = 0.12;
    let steep = 25f64.to_radians();
    let mut renderer = renderer();
    for (model, is_line) in [(rounded_block(radius), true), (cut_fillet(radius, 8.0), false)] {
        let from = DVec3::new(-steep.cos(), steep.sin(), 0.3);
        let projection = orthographic(&model, SIZE).projection;
        let camera = Camera { projection, ..Camera::around(model.control_bounds(), from, DVec3::Y, 0.6, SIZE) };
        let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
        let settings = SceneSettings { trim: TrimWay::Exact, ..with(settings) };
        let picture = draw_next(&mut renderer, (&model, settings), &camera);
        let count = centres(&picture).count();
        assert_eq!(count > 30, is_line, "{count} pixels");
        assert!(is_line || count == 0, "{count} pixels");
    }
    assert_silent(renderer);
}

/// The outline's wrong pixels, of a cylinder so near that windows are cut out of it. Half a pixel of the cylinder is seen
/// beyond the place at this angle. No pixel's centre lies in that half.
fn faults_close_beyond(angle: f64) -> (usize, usize) {
    let model = shapes::cylinder();
    let (radius, height) = shapes::CYLINDER;
    // the outline at 80.2 px, the place at 79.7 px
    let (round_px, beyond_px) = (2e5_f64, 0.5);
    let beyond = angle + (1.0 - beyond_px / round_px).acos();
    let px = radius / round_px;
    let at = |away: f64, z: f64| (DVec2::from_angle(beyond) * away).extend(z);
    let target = at(radius - 0.2 * px, 0.4 * height);
    let view_height = f64::from(SIZE.1) * px;
    let camera = Camera {
        eye: target + DVec2::from_angle(beyond - FRAC_PI_2).extend(0.0) * 10.0,
        target,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: view_height },
        depth_range: (1.0, 20.0),
        size: SIZE,
    };
    let along = (0..=400).map(|k| target.z + (f64::from(k) / 400.0 - 0.5) * 1.2 * view_height);
    let outline: Vec<DVec2> = along.map(|z| camera.project(at(radius, z)).unwrap().0).collect();
    assert!((outline[0].x - 80.2).abs() < 1e-6, "{}", outline[0]);
    let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
    let picture = draw(&model, with(settings), &camera);
    assert!(centres(&picture).count() > 60);
    faults_of_outline(&picture, &outline)
}

/// The seam leads to the outline.
#[test]
fn an_outline_close_beyond_a_seam_is_a_line_in_a_deep_zoom() {
    assert_eq!(faults_close_beyond(0.0), (0, 0));
}

/// A window ends in the middle of a patch, and no pixel's centre sees the one in which the fold is.
#[test]
fn an_outline_close_beyond_a_window_is_a_line_in_a_deep_zoom() {
    assert_eq!(faults_close_beyond(FRAC_PI_4), (0, 0));
}

/// The picture of this sheet is Whitney's cusp, (x³ - y x, y). Two folds meet in the middle of the picture. The sheet
/// hides one of them. Beyond the cusp the sheet is seen nearly edge-on, and folds nowhere.
#[test]
fn an_outline_ends_at_its_cusp() {
    let (x, x3, y) = ([-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0], [-1.0, 1.0, -1.0, 1.0], [-1.0, 1.0]);
    let points = (0..2).flat_map(|j| (0..4).map(move |i| (i, j)));
    let points = points.map(|(i, j)| DVec4::new(x3[i] - y[j] * x[i], y[j], x[i], 1.0)).collect();
    let knots = |n: usize| [vec![0.0; n + 1], vec![1.0; n + 1]].concat();
    let surface = Surface::new((3, 1), knots(3), knots(1), points).unwrap();
    let model = shapes::one("cusp", false, vec![shapes::face(1, SurfaceKind::BSpline, surface)]);
    let (mut renderer, tracer) = (renderer(), Tracer::new(&model));
    for (shift, turn) in [(DVec2::ZERO, 0.0), (DVec2::new(0.003, 0.008), 0.3), (DVec2::new(-0.007, 0.002), 1.9)] {
        let target = shift.extend(0.0);
        let camera = Camera {
            eye: target + DVec3::Z * 10.0,
            target,
            up: DVec2::from_angle(turn).extend(0.0),
            projection: Projection::Orthographic { height: 1.8 },
            depth_range: (1.0, 20.0),
            size: SIZE,
        };
        let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
        let picture = draw_next(&mut renderer, (&model, with(settings)), &camera);
        let asked = DrawingSettings { sharp: false, smooth: false, ..DrawingSettings::default() };
        let image = LineImage { lines: &picture.edge, width: WIDTH, section_width: WIDTH };
        let found = judge_lines(&model, &tracer, &camera, &asked, image).unwrap();
        assert!(found.visible > 60, "{found:?}");
        assert_eq!((found.missing, found.stray), (0, 0), "turned by {turn}: {found:?}");
    }
    assert_silent(renderer);
}
