//! The judge of lines, on pictures made by closed forms: right ones, and each with one fault.

use super::super::shapes::{face, rectangle};
use super::*;
use crate::drawing::{LineImage, LineJudgement, judge_lines};
use crate::model::{Primitive, Shape, Solid};
use selvedge_geometry::construct::shapes;

pub(super) const WIDTH: f64 = 1.25;

/// Pixels whose centres are within half a width of something.
pub(super) fn image(camera: &Camera, off: impl Fn(DVec2) -> f64) -> Vec<u32> {
    let (w, h) = camera.size;
    let centre = |k: u32| DVec2::new(f64::from(k % w) + 0.5, f64::from(k / w) + 0.5);
    (0..w * h).map(|k| u32::from(off(centre(k)) <= 0.5 * WIDTH)).collect()
}

pub(super) fn to_segments(segments: &[[DVec2; 2]], p: DVec2) -> f64 {
    let off = |[a, b]: &[DVec2; 2]| {
        let share = ((p - *a).dot(*b - *a) / a.distance_squared(*b)).clamp(0.0, 1.0);
        p.distance(a.lerp(*b, share))
    };
    segments.iter().map(off).fold(f64::INFINITY, f64::min)
}

pub(super) fn judged(model: &Model, camera: &Camera, settings: &DrawingSettings, lines: &[u32]) -> LineJudgement {
    let tracer = Tracer::new(model);
    let image = LineImage { lines, width: WIDTH, section_width: 2.0 * WIDTH };
    judge_lines(model, &tracer, camera, settings, image).unwrap()
}

/// The nine visible edges of a cube seen isometrically, and the three hidden ones.
fn cube() -> (Model, Camera, [Vec<[DVec2; 2]>; 2]) {
    let model = alone(shapes::block(-DVec3::ONE * 0.5, DVec3::ONE * 0.5).unwrap().part);
    let camera = Camera { size: (200, 150), ..parallel(DVec3::new(2.0, -2.0, 2.0), 2.0) };
    let edges = super::bodies::cube_edges(&camera);
    (model, camera, edges)
}

#[test]
fn a_right_picture_has_no_fault() {
    let (model, camera, [visible, _]) = cube();
    let right = image(&camera, |p| to_segments(&visible, p));
    let found = judged(&model, &camera, &DrawingSettings::default(), &right);
    assert_eq!((found.missing, found.stray, found.unsure), (0, 0, 0), "{found:?}");
    // all nine, two points a pixel
    let length: f64 = visible.iter().map(|[a, b]| a.distance(*b)).sum();
    assert!((found.visible as f64 - 2.0 * length).abs() < 20.0 && found.points > found.visible, "{found:?}");
    assert!(found.line_pixels as f64 > length);
}

#[test]
fn each_fault_is_seen() {
    let (model, camera, [visible, hidden]) = cube();
    let settings = DrawingSettings::default();
    let told = |lines: &[u32]| {
        let found = judged(&model, &camera, &settings, lines);
        assert_eq!(found.missing_at.len() as u64, found.missing.min(16));
        (found.missing, found.stray)
    };
    // moved by two pixels
    let moved = image(&camera, |p| to_segments(&visible, p - DVec2::new(2.0, 0.0)));
    let (missing, stray) = told(&moved);
    assert!(missing > 100 && stray > 100, "{missing} {stray}");
    // one left out: its points, but for those near others
    let (missing, stray) = told(&image(&camera, |p| to_segments(&visible[1..], p)));
    let length = visible[0][0].distance(visible[0][1]);
    assert!(stray == 0 && (missing as f64 - 2.0 * length).abs() < 12.0, "{missing} {stray}");
    // three pixels left out of one
    let middle = visible[0][0].lerp(visible[0][1], 0.5);
    let (missing, stray) =
        told(&image(&camera, |p| if p.distance(middle) < 2.5 { f64::INFINITY } else { to_segments(&visible, p) }));
    assert!(stray == 0 && (1..12).contains(&missing), "{missing} {stray}");
    // a line where none is, and a hidden one
    let other = [DVec2::new(10.0, 20.0), DVec2::new(40.0, 30.0)];
    for wrong in [other, hidden[0]] {
        let (missing, stray) = told(&image(&camera, |p| to_segments(&visible, p).min(to_segments(&[wrong], p))));
        assert!(missing == 0 && stray as f64 > 0.8 * wrong[0].distance(wrong[1]), "{missing} {stray}");
    }
    // a single pixel
    let mut lines = image(&camera, |p| to_segments(&visible, p));
    lines[200 * 75 + 12] = 7;
    assert_eq!(told(&lines), (0, 1));
    // none at all
    let (missing, stray) = told(&vec![0; 200 * 150]);
    assert!(missing > 500 && stray == 0);
}

/// A line may be half a pixel off, beyond the ends of an edge, too: around a square, wherever it lies among the pixels.
#[test]
fn a_line_may_reach_half_a_pixel_beyond_its_width() {
    let camera = Camera { size: (200, 150), ..parallel(DVec3::Z * 3.0, 3.0) };
    for step in 0..8 {
        let by = f64::from(step) / 50.0 * DVec3::new(0.13, 0.07, 0.0);
        let low = DVec3::new(-1.0, -1.0, 0.0) + by;
        let square = rectangle(low, DVec3::X * 2.0, DVec3::Y * 2.0);
        let model = alone(Part { faces: vec![face(1, square, vec![])], ..Part::default() });
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let corners = corners.map(|(x, y)| pixel(&camera, low + DVec3::new(x, y, 0.0)));
        let sides: Vec<[DVec2; 2]> = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect();
        let wide = |more: f64| {
            let lines = image(&camera, |p| to_segments(&sides, p) - more);
            judged(&model, &camera, &DrawingSettings::default(), &lines)
        };
        let found = wide(0.5 - 1e-6);
        assert_eq!((found.missing, found.stray), (0, 0), "{step}: {found:?}");
        // half a pixel more, all along the sides
        assert!(wide(1.0).stray > 100, "{step}");
    }
}

/// Of an edge just above the picture, half a line is in it.
#[test]
fn a_line_may_reach_into_the_picture() {
    let camera = Camera { size: (200, 150), ..parallel(DVec3::Z * 3.0, 3.0) };
    for (above, stray) in [(0.6, false), (2.0, true)] {
        let top = 1.5 + above / 50.0;
        let square = rectangle(DVec3::new(-1.0, -1.0, 0.0), DVec3::X * 2.0, DVec3::Y * (1.0 + top));
        let model = alone(Part { faces: vec![face(1, square, vec![])], ..Part::default() });
        let ends = [-0.9, 0.9].map(|x| pixel(&camera, DVec3::new(x, top, 0.0)));
        let lines = image(&camera, |p| to_segments(&[ends], p) + 0.5 * WIDTH - above - 0.6);
        let found = judged(&model, &camera, &DrawingSettings::default(), &lines);
        assert!(found.line_pixels > 80 && (found.stray > 0) == stray, "{found:?}");
    }
}

/// An edge behind two blocks with a slot of 0.2 px between them. The judge may find no point of the edge in the slot, and a
/// line there is right. Without the slot, the line is wrong.
#[test]
fn an_edge_seen_through_a_slot_may_have_a_line() {
    let camera = Camera { size: (200, 150), ..parallel(DVec3::Z * 3.0, 3.0) };
    let square = rectangle(DVec3::new(-1.0, -1.0, -1.0), DVec3::X * 2.0, DVec3::Y * 1.01);
    let block = |middle: f64, size: f64| {
        let transform = DAffine3::from_translation(DVec3::X * middle);
        let half = 0.5 * DVec3::new(size, 3.0, 0.1);
        let shape = Shape::Block { min: -half, max: half };
        Solid::of(Primitive { shape, transform, colour: [1.0; 4], id: 9 }).unwrap()
    };
    let unit = 1.0 / 50.0; // of a pixel
    for step in 0..5 {
        let at = 0.1 * f64::from(step) * unit;
        for (slot, stray) in [(0.2 * unit, false), (0.0, true)] {
            let solids = [-1.0, 1.0].map(|side| block(at + side * (1.0 + 0.5 * slot), 2.0)).to_vec();
            let part = Part { faces: vec![face(1, square.clone(), vec![])], ..Part::default() };
            let model = Model { solids, ..alone(part) };
            let place = pixel(&camera, DVec3::new(at, 0.01, -1.0));
            let found = judged(&model, &camera, &DrawingSettings::default(), &image(&camera, |p| p.distance(place)));
            assert!(found.line_pixels > 0 && (found.stray > 0) == stray, "{step}: {found:?}");
        }
    }
}

/// With hidden lines in the settings, pixels of hidden edges are no faults.
#[test]
fn hidden_lines_are_excused_where_asked_for() {
    let (model, camera, [visible, hidden]) = cube();
    let all = [&visible[..], &hidden[..]].concat();
    let both = image(&camera, |p| to_segments(&all, p));
    let settings = DrawingSettings { hidden: true, ..DrawingSettings::default() };
    let found = judged(&model, &camera, &settings, &both);
    assert_eq!((found.missing, found.stray), (0, 0));
    let found = judged(&model, &camera, &settings, &image(&camera, |p| to_segments(&visible, p)));
    assert_eq!((found.missing, found.stray), (0, 0));
}

/// The outline of a ball in a parallel view is a circle of its radius.
#[test]
fn silhouettes_are_judged_too() {
    let model = alone(shapes::sphere(1.0).unwrap().part);
    let camera = Camera { size: (200, 150), ..parallel(DVec3::new(2.0, 1.0, 1.5), 3.0) };
    let off = |p: DVec2| (p.distance(DVec2::new(100.0, 75.0)) - 50.0).abs();
    let settings = DrawingSettings::default();
    let found = judged(&model, &camera, &settings, &image(&camera, off));
    assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
    assert!((found.visible as f64 - 200.0 * std::f64::consts::PI).abs() < 10.0);
    let half =
        judged(&model, &camera, &settings, &image(&camera, |p| if p.x > 100.0 { f64::INFINITY } else { off(p) }));
    assert!(half.stray == 0 && half.missing > 300, "{half:?}");
    let none = DrawingSettings { silhouettes: false, ..settings };
    let found = judged(&model, &camera, &none, &image(&camera, off));
    assert!(found.visible == 0 && found.stray > 300, "{found:?}");
}

/// A label as deep as the wall that it lies on: its lines may be there or not.
#[test]
fn what_is_unsure_is_counted_apart() {
    let wall = rectangle(-DVec3::ONE, DVec3::X * 2.0, DVec3::Y * 2.0);
    let label = rectangle(DVec3::new(-0.4, -0.4, -1.0 - 1e-12), DVec3::X * 0.8, DVec3::Y * 0.8);
    let part = |id, surface| (Part { faces: vec![face(id, surface, vec![])], ..Part::default() }, DAffine3::IDENTITY);
    let model = placed(vec![part(1, wall), part(2, label)]);
    let camera = Camera { size: (200, 150), ..parallel(DVec3::Z * 3.0, 3.0) };
    let at = |x: f64, y: f64| pixel(&camera, DVec3::new(x, y, -1.0));
    let square = |s: f64| -> Vec<[DVec2; 2]> {
        let corners = [at(-s, -s), at(s, -s), at(s, s), at(-s, s)];
        (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect()
    };
    for lines in [square(1.0), [square(1.0), square(0.4)].concat()] {
        let found = judged(&model, &camera, &DrawingSettings::default(), &image(&camera, |p| to_segments(&lines, p)));
        assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
        assert!(found.unsure > 200, "{found:?}");
    }
}
