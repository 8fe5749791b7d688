//! Convex bodies, whose lines have closed forms.

use super::super::shapes::{face, hole, patch, rectangle};
use super::*;
use selvedge_geometry::construct::shapes;

/// Towards the eye of an isometric view.
const ISO: DVec3 = DVec3::new(2.0, -2.0, 2.0);

fn cube() -> Model {
    alone(shapes::block(-DVec3::ONE * 0.5, DVec3::ONE * 0.5).unwrap().part)
}

/// The twelve edges of the cube by their ends: visible, hidden.
pub fn cube_edges(camera: &Camera) -> [Vec<[DVec2; 2]>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    for axis in 0..3 {
        for (s, t) in [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)] {
            let mut ends = [DVec3::ZERO; 2];
            for (end, x) in ends.iter_mut().zip([-0.5, 0.5]) {
                (end[axis], end[(axis + 1) % 3], end[(axis + 2) % 3]) = (x, s, t);
            }
            let middle = if camera.is_perspective() { (ends[0] + ends[1]) * 0.5 } else { DVec3::ZERO };
            let to_eye = camera.eye - middle;
            let faces = [(axis + 1) % 3, (axis + 2) % 3].map(|k| ends[0][k] * to_eye[k] > 0.0);
            out[usize::from(!(faces[0] || faces[1]))].push(ends.map(|p| pixel(camera, p)));
        }
    }
    out
}

#[test]
fn a_cube_has_nine_visible_edges_and_three_hidden_ones() {
    let view = perspective(ISO);
    let lens = Projection::Pinhole { focal: DVec2::new(900.0, 700.0), principal: DVec2::new(300.0, 350.0) };
    let off_centre = Camera { projection: lens, ..view };
    for camera in [parallel(ISO, 2.0), view, perspective(DVec3::new(1.0, -3.0, 0.9)), off_centre] {
        let [visible, hidden] = cube_edges(&camera);
        assert_eq!((visible.len(), hidden.len()), (9, 3));
        let drawing = drawn(&cube(), &camera);
        assert_eq!(drawing.lines.len(), 12);
        same_segments(&strokes(&drawing, LineKind::Sharp, false), &visible);
        same_segments(&strokes(&drawing, LineKind::Sharp, true), &hidden);
    }
}

/// From the front the far edges lie behind the near ones, and the others are points.
#[test]
fn what_lies_behind_another_line_is_drawn_once() {
    let camera = parallel(-DVec3::Y * 4.0, 2.0);
    let drawing = drawn(&cube(), &camera);
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| DVec3::new(x, -0.5, z));
    let sides: Vec<_> = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]].map(|p| pixel(&camera, p))).collect();
    assert_eq!(drawing.lines.len(), 4, "{:?}", drawing.lines);
    same_segments(&strokes(&drawing, LineKind::Sharp, false), &sides);
}

/// Two straight silhouettes; also where they lie on the seam and on sides of patches.
#[test]
fn a_cylinder_has_two_silhouettes() {
    let model = alone(shapes::cylinder(0.8, 1.0).unwrap().part);
    for azimuth in [0.0f64, 45.0, 90.0, 17.0, 210.0] {
        for (elevation, parallel_view) in [(30.0f64, true), (0.0, true), (20.0, false)] {
            let (sin, cos) = azimuth.to_radians().sin_cos();
            let back = DVec3::new(
                sin * elevation.to_radians().cos(),
                -cos * elevation.to_radians().cos(),
                elevation.to_radians().sin(),
            );
            let camera = if parallel_view { parallel(back * 4.0, 3.0) } else { perspective(back * 4.0) };
            // tangents from the eye to the circle: at the angle acos(radius / distance) from its direction
            let distance = camera.eye.truncate().length();
            let half = if parallel_view { std::f64::consts::FRAC_PI_2 } else { (0.8 / distance).acos() };
            let towards = camera.eye.y.atan2(camera.eye.x);
            let wanted = [-half, half].map(|turn| {
                let (sin, cos) = (towards + turn).sin_cos();
                [0.0, 1.0].map(|z| pixel(&camera, DVec3::new(0.8 * cos, 0.8 * sin, z)))
            });
            let drawing = drawn(&model, &camera);
            same_segments(&strokes(&drawing, LineKind::Silhouette, false), &wanted);
            assert!(strokes(&drawing, LineKind::Silhouette, true).is_empty());
        }
    }
}

/// One closed curve: every ray through it touches the ball.
#[test]
fn a_ball_has_one_closed_silhouette() {
    let model = alone(shapes::sphere(1.0).unwrap().part);
    let eyes = [DVec3::new(2.0, 1.0, 1.5), DVec3::NEG_Y * 4.0, DVec3::Z * 4.0, DVec3::X * 4.0];
    for eye in eyes {
        for camera in [parallel(eye, 3.0), perspective(eye * 1.2)] {
            let drawing = drawn(&model, &camera);
            let outline = strokes(&drawing, LineKind::Silhouette, false);
            assert!(outline.len() == 1 && outline[0].closed, "{eye}: {} strokes", outline.len());
            assert_eq!(drawing.lines.iter().filter(|l| l.kind != LineKind::Silhouette).count(), 0);
            // pixels to model units at the ball, which is as near as the eye's distance less its radius
            let away = if camera.is_perspective() { camera.eye.length() } else { 1.0 };
            let unit = away / camera.focal_px().y;
            let mut around = 0.0;
            let all = points(&outline[0].curves);
            for pair in all.windows(2) {
                let (origin, direction) = camera.ray(pair[0]);
                let off = origin.cross(direction).length() - 1.0;
                assert!(off.abs() <= CURVE * unit, "{eye}: {} px off", off / unit);
                let middle = pixel(&camera, DVec3::ZERO);
                around += (pair[0] - middle).angle_to(pair[1] - middle);
            }
            assert!((around.abs() - std::f64::consts::TAU).abs() < 1e-6, "{around}");
        }
    }
}

/// Through the hole of a plate a second plate is seen: its edge ends at the rim of the hole.
#[test]
fn a_plate_with_a_hole_shows_what_is_behind_the_hole() {
    let plate = rectangle(DVec3::new(-1.0, -1.0, 0.0), DVec3::X * 2.0, DVec3::Y * 2.0);
    let border = super::super::shapes::polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from));
    let front = face(1, plate, vec![border, hole(DVec2::splat(0.5), 0.25)]);
    let behind = rectangle(DVec3::new(-0.9, -0.9, -1.0), DVec3::X * 1.1, DVec3::Y * 1.8);
    let part = |f| Part { faces: vec![f], ..Part::default() };
    let model = placed(vec![(part(front), DAffine3::IDENTITY), (part(face(2, behind, vec![])), DAffine3::IDENTITY)]);
    let camera = parallel(DVec3::Z * 3.0, 3.0);
    let drawing = drawn(&model, &camera);
    let seen = strokes(&drawing, LineKind::Border, false);
    let (closed, open): (Vec<_>, Vec<_>) = seen.into_iter().partition(|s| s.closed);
    assert_eq!(closed.len(), 1, "the rim");
    let at = |x: f64, y: f64| pixel(&camera, DVec3::new(x, y, 0.0));
    assert!(points(&closed[0].curves).iter().all(|p| (p.distance(at(0.0, 0.0)) - 100.0).abs() < CURVE));
    // the edge at x = 0.2 of the plate behind is seen from rim to rim
    let half = (0.25f64 - 0.04).sqrt();
    let corners = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    let mut wanted: Vec<[DVec2; 2]> = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect();
    wanted.push([at(0.2, -half), at(0.2, half)]);
    same_segments(&open, &wanted);
    let hidden = strokes(&drawing, LineKind::Border, true);
    let rest = [[at(0.2, -0.9), at(0.2, -half)], [at(0.2, half), at(0.2, 0.9)]];
    let others = [[at(-0.9, -0.9), at(0.2, -0.9)], [at(-0.9, -0.9), at(-0.9, 0.9)], [at(-0.9, 0.9), at(0.2, 0.9)]];
    same_segments(&hidden, &[&rest[..], &others[..]].concat());
}

/// A drawing has the kinds of lines that its settings name, and no others.
#[test]
fn settings_choose_the_kinds() {
    let model = alone(shapes::cylinder(0.8, 1.0).unwrap().part);
    let tracer = Tracer::new(&model);
    let camera = parallel(ISO, 3.0);
    let count = |settings: DrawingSettings| {
        let drawing = Drawing::new(&model, &tracer, &camera, &settings).unwrap();
        let of = |kind: LineKind| drawing.lines.iter().filter(|l| l.kind == kind).count();
        (of(LineKind::Sharp), of(LineKind::Silhouette), drawing.lines.iter().filter(|l| l.hidden).count())
    };
    let all = DrawingSettings { hidden: true, ..DrawingSettings::default() };
    let (sharp, folds, hidden) = count(all);
    assert!(sharp >= 3 && folds == 2 && hidden >= 1, "{sharp} {folds} {hidden}");
    assert_eq!(count(DrawingSettings { hidden: false, ..all }), (sharp - hidden, 2, 0));
    assert_eq!(count(DrawingSettings { silhouettes: false, ..all }), (sharp, 0, hidden));
    assert_eq!(count(DrawingSettings { sharp: false, ..all }), (0, 2, 0));
}

/// A rounded edge from the front: the round meets the top smoothly just where both turn away from the eye. The line is a
/// silhouette; where these are not asked for, the smooth edge that it is.
#[test]
fn a_smooth_edge_may_be_a_silhouette() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, half), (0.0, 1.0, 1.0)];
    let row = |y: f64| arc.map(|(x, z, w)| glam::DVec4::new(x * w, y * w, z * w, w));
    let round = patch((2, 1), [row(0.0), row(1.0)].concat());
    let top = rectangle(DVec3::new(-1.0, 0.0, 1.0), DVec3::X, DVec3::Y);
    let model = alone(Part { faces: vec![face(1, round, vec![]), face(2, top, vec![])], ..Part::default() });
    let camera = parallel(DVec3::X * 4.0, 3.0);
    let wanted = [[0.0, 1.0].map(|y| pixel(&camera, DVec3::new(0.0, y, 1.0)))];
    let drawing = drawn(&model, &camera);
    same_segments(&strokes(&drawing, LineKind::Silhouette, false), &wanted);
    assert!(strokes(&drawing, LineKind::Smooth, false).is_empty());
    let tracer = Tracer::new(&model);
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let drawing = Drawing::new(&model, &tracer, &camera, &settings).unwrap();
    same_segments(&strokes(&drawing, LineKind::Smooth, false), &wanted);
    assert!(strokes(&drawing, LineKind::Silhouette, false).is_empty());
}
