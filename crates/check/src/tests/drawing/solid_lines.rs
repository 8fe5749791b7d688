//! The judge of lines of Boolean solids, on pictures made by closed forms: right ones, and each with one fault.

use super::judged::{WIDTH, image, judged, to_segments};
use super::*;
use crate::csg::parse;
use crate::model::{Primitive, Shape, Solid};
use selvedge_geometry::construct::shapes;
use std::sync::Arc;

/// Towards the eye: the sides at high x, low y and high z are seen.
const ISO: DVec3 = DVec3::new(2.0, -2.0, 2.0);
const HALF: DVec3 = DVec3::splat(0.5);

fn at(place: DVec3, shape: Shape) -> Primitive {
    Primitive { shape, transform: DAffine3::from_translation(place), colour: [1.0; 4], id: 1 }
}

fn block(min: DVec3, max: DVec3) -> Primitive {
    at(DVec3::ZERO, Shape::Block { min, max })
}

/// An expression of primitives A, B, and so on.
fn solid(text: &str, mut primitives: Vec<Primitive>) -> Model {
    (1..).zip(&mut primitives).for_each(|(id, p)| p.id = id);
    let e = parse(text).unwrap();
    let named = e.names.iter().map(|name| primitives[usize::from(name.as_bytes()[0] - b'A')].clone()).collect();
    Model { solids: vec![Solid::new(named, e.tree).unwrap()], ..Model::default() }
}

/// 75 pixels a unit.
fn isometric() -> Camera {
    Camera { size: (200, 150), ..parallel(ISO, 2.0) }
}

/// The visible edges of a block from there: those of its top, and the others.
fn edges_of_block(camera: &Camera, low: DVec3, high: DVec3) -> [Vec<[DVec2; 2]>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    for axis in 0..3 {
        for (first, second) in [(false, false), (false, true), (true, false), (true, true)] {
            let sides = [((axis + 1) % 3, first), ((axis + 2) % 3, second)];
            let mut ends = [low, high];
            for (k, is_high) in sides {
                ends.iter_mut().for_each(|end| end[k] = if is_high { high[k] } else { low[k] });
            }
            if sides.iter().any(|&(k, is_high)| is_high == (ISO[k] > 0.0)) {
                let is_top = sides.iter().any(|&(k, is_high)| k == 2 && is_high);
                out[usize::from(!is_top)].push(ends.map(|p| pixel(camera, p)));
            }
        }
    }
    out
}

/// Ways between neighbouring centres that a segment crosses, but for one at each end.
fn crossed(segments: &[[DVec2; 2]]) -> f64 {
    segments.iter().map(|[a, b]| (*b - *a).abs().element_sum()).sum()
}

fn faults(model: &Model, camera: &Camera, lines: &[u32]) -> (u64, u64) {
    let found = judged(model, camera, &DrawingSettings::default(), lines);
    (found.missing, found.stray)
}

#[test]
fn a_right_picture_has_no_fault() {
    let (model, camera) = (solid("A", vec![block(-HALF, HALF)]), isometric());
    let edges = edges_of_block(&camera, -HALF, HALF).concat();
    assert_eq!(edges.len(), 9);
    let right = image(&camera, |p| to_segments(&edges, p));
    for silhouettes in [true, false] {
        let settings = DrawingSettings { silhouettes, ..DrawingSettings::default() };
        let found = judged(&model, &camera, &settings, &right);
        assert_eq!((found.missing, found.stray, found.unsure), (0, 0, 0), "{found:?}");
        let ways = crossed(&edges);
        assert!((found.visible as f64 - ways).abs() < 30.0 && found.points == found.visible, "{ways}: {found:?}");
    }
}

#[test]
fn each_fault_is_seen() {
    let (model, camera) = (solid("A", vec![block(-HALF, HALF)]), isometric());
    let edges = edges_of_block(&camera, -HALF, HALF).concat();
    let told = |lines: &[u32]| faults(&model, &camera, lines);
    // moved by two pixels
    let (missing, stray) = told(&image(&camera, |p| to_segments(&edges, p - DVec2::new(2.0, 0.0))));
    assert!(missing > 100 && stray > 100, "{missing} {stray}");
    // one left out: its places, but for those near others
    let (missing, stray) = told(&image(&camera, |p| to_segments(&edges[1..], p)));
    let ways = crossed(&edges[..1]);
    assert!(stray == 0 && (missing as f64) > 0.8 * ways && (missing as f64) < ways + 3.0, "{missing} {stray}");
    // some pixels left out of one
    let middle = edges[0][0].lerp(edges[0][1], 0.5);
    let (missing, stray) =
        told(&image(&camera, |p| if p.distance(middle) < 2.5 { f64::INFINITY } else { to_segments(&edges, p) }));
    assert!(stray == 0 && (1..12).contains(&missing), "{missing} {stray}");
    // a line within a side
    let within = [pixel(&camera, DVec3::new(-0.3, 0.3, 0.5)), pixel(&camera, DVec3::new(0.3, 0.3, 0.5))];
    let (missing, stray) = told(&image(&camera, |p| to_segments(&edges, p).min(to_segments(&[within], p))));
    assert!(missing == 0 && stray as f64 > 0.8 * within[0].distance(within[1]), "{missing} {stray}");
    // a single pixel
    let mut lines = image(&camera, |p| to_segments(&edges, p));
    lines[200 * 75 + 12] = 7;
    assert_eq!(told(&lines), (0, 1));
    // lines of the width of a section's outline, where there is no section
    let (missing, stray) = told(&image(&camera, |p| to_segments(&edges, p) - WIDTH));
    assert!(missing == 0 && stray > 100, "{missing} {stray}");
    // none at all
    let (missing, stray) = told(&vec![0; 200 * 150]);
    assert!(missing > 500 && stray == 0, "{missing} {stray}");
}

/// The rim of a bowl: before its far half the block ends, at its near half it hides the bowl.
#[test]
fn what_is_cut_has_a_line() {
    let radius = 0.3;
    let ball = at(DVec3::Z * 0.5, Shape::Sphere { radius });
    let (model, camera) = (solid("A-B", vec![block(-HALF, HALF), ball]), isometric());
    let edges = edges_of_block(&camera, -HALF, HALF).concat();
    let rim: Vec<[DVec2; 2]> = (0..720)
        .map(|k| {
            [k, k + 1].map(|k| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 720.0).sin_cos();
                pixel(&camera, DVec3::new(radius * cos, radius * sin, 0.5))
            })
        })
        .collect();
    let off = |p: DVec2| to_segments(&edges, p).min(to_segments(&rim, p));
    assert_eq!(faults(&model, &camera, &image(&camera, off)), (0, 0));
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&edges, p)));
    assert!(missing > 100 && stray == 0, "{missing} {stray}");
}

/// The outline of a ball is a fold: a line where silhouettes are wanted, else none.
#[test]
fn folds_are_silhouettes() {
    let model = solid("A", vec![at(DVec3::ZERO, Shape::Sphere { radius: 1.0 })]);
    let camera = Camera { size: (200, 150), ..parallel(DVec3::new(2.0, 1.0, 1.5), 3.0) };
    let off = |p: DVec2| (p.distance(DVec2::new(100.0, 75.0)) - 50.0).abs();
    let settings = DrawingSettings::default();
    let found = judged(&model, &camera, &settings, &image(&camera, off));
    assert_eq!((found.missing, found.stray, found.unsure), (0, 0, 0), "{found:?}");
    assert!((found.visible as f64 - 400.0).abs() < 20.0, "{found:?}");
    let half = image(&camera, |p| if p.x > 100.0 { f64::INFINITY } else { off(p) });
    let found = judged(&model, &camera, &settings, &half);
    assert!(found.stray == 0 && found.missing > 150, "{found:?}");
    let none = DrawingSettings { silhouettes: false, ..settings };
    let found = judged(&model, &camera, &none, &image(&camera, off));
    assert!(found.visible == 0 && found.stray > 300, "{found:?}");
}

/// A post that goes over into a ball of its radius, from the side.
#[test]
fn smooth_transitions_count_where_they_are_wanted() {
    let post = at(-DVec3::Z, Shape::Cylinder { radius: 0.5, height: 1.0 });
    let model = solid("A+B", vec![post, at(DVec3::ZERO, Shape::Sphere { radius: 0.5 })]);
    let camera = Camera { size: (200, 150), ..parallel(DVec3::X * 3.0, 3.0) };
    let corner = |x: f64, y: f64| DVec2::new(x, y);
    let sides = [
        [corner(75.0, 75.0), corner(75.0, 125.0)],
        [corner(75.0, 125.0), corner(125.0, 125.0)],
        [corner(125.0, 125.0), corner(125.0, 75.0)],
    ];
    let across = [[corner(75.0, 75.0), corner(125.0, 75.0)]];
    let round = |p: DVec2| if p.y > 75.0 { f64::INFINITY } else { (p.distance(corner(100.0, 75.0)) - 25.0).abs() };
    let outline = |p: DVec2| to_segments(&sides, p).min(round(p));
    let with = image(&camera, |p| outline(p).min(to_segments(&across, p)));
    let without = image(&camera, outline);
    let settings = DrawingSettings::default();
    let found = judged(&model, &camera, &settings, &with);
    assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
    let found = judged(&model, &camera, &settings, &without);
    assert!((40..=52).contains(&found.missing) && found.stray == 0, "{found:?}");
    let none = DrawingSettings { smooth: false, ..settings };
    let found = judged(&model, &camera, &none, &without);
    assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
    assert!(judged(&model, &camera, &none, &with).stray > 40);
}

/// Two blocks side by side are one: between them there is no line.
#[test]
fn faces_that_coincide_are_one() {
    let halves = [block(-HALF, HALF.with_x(0.0)), block((-HALF).with_x(0.0), HALF)];
    let (model, camera) = (solid("A+B", halves.to_vec()), isometric());
    let edges = edges_of_block(&camera, -HALF, HALF).concat();
    let right = |p: DVec2| to_segments(&edges, p);
    assert_eq!(faults(&model, &camera, &image(&camera, right)), (0, 0));
    let seam = [DVec3::new(0.0, -0.5, 0.5), DVec3::new(0.0, 0.5, 0.5)].map(|p| pixel(&camera, p));
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| right(p).min(to_segments(&[seam], p))));
    assert!(missing == 0 && stray as f64 > 0.8 * seam[0].distance(seam[1]), "{missing} {stray}");
}

/// The cap of a section has an outline that is twice as wide as other lines.
#[test]
fn outlines_of_sections_are_wide() {
    let (whole, camera) = (solid("A", vec![block(-HALF, HALF)]), isometric());
    let model = whole.section(DVec3::Z, 0.2).unwrap();
    let [top, others] = edges_of_block(&camera, -HALF, HALF.with_z(0.2));
    let wide = |of_top: f64, of_others: f64| {
        let off = |p: DVec2| (to_segments(&top, p) - of_top).min(to_segments(&others, p) - of_others);
        faults(&model, &camera, &image(&camera, off))
    };
    assert_eq!(wide(0.5 * WIDTH, 0.0), (0, 0));
    // somewhat more than another line may have
    assert_eq!(wide(0.5 * WIDTH + 0.2, 0.0), (0, 0));
    let (missing, stray) = wide(0.5 * WIDTH, WIDTH);
    assert!(missing == 0 && stray > 50, "{missing} {stray}");
    let (missing, stray) = wide(1.5 * WIDTH, 0.0);
    assert!(missing == 0 && stray > 50, "{missing} {stray}");
}

/// Without equations, the edges within an operand's picture have to have lines; along its outline it is not known
/// whether there is an edge, or a cut.
#[test]
fn edges_of_operands_have_lines() {
    let part = shapes::block(-HALF, HALF).unwrap().part;
    let (model, camera) = (solid("A", vec![at(DVec3::ZERO, Shape::Part(Arc::new(part)))]), isometric());
    let edges = edges_of_block(&camera, -HALF, HALF).concat();
    let middle = pixel(&camera, DVec3::new(0.5, -0.5, 0.5));
    let (inner, outer): (Vec<_>, Vec<_>) =
        edges.iter().copied().partition(|ends: &[DVec2; 2]| ends.iter().any(|end| end.distance(middle) < 1.0));
    assert_eq!((inner.len(), outer.len()), (3, 6));
    let found = judged(&model, &camera, &DrawingSettings::default(), &image(&camera, |p| to_segments(&edges, p)));
    assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
    assert!((found.visible as f64 - crossed(&inner)).abs() < 15.0, "{found:?}");
    assert!((found.unsure as f64 - crossed(&outer)).abs() < 20.0, "{found:?}");
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&outer, p)));
    assert!(missing as f64 > 0.8 * crossed(&inner) && stray == 0, "{missing} {stray}");
    let within = [pixel(&camera, DVec3::new(-0.3, 0.3, 0.5)), pixel(&camera, DVec3::new(0.3, 0.3, 0.5))];
    let (_, stray) =
        faults(&model, &camera, &image(&camera, |p| to_segments(&edges, p).min(to_segments(&[within], p))));
    assert!(stray as f64 > 0.7 * within[0].distance(within[1]), "{stray}");
}

/// All twelve edges of a block of glass have lines; those at its back are missed if they have none.
#[test]
fn edges_at_the_back_of_glass_have_lines() {
    let clear = Primitive { colour: [1.0, 1.0, 1.0, 0.4], ..block(-HALF, HALF) };
    let (model, camera) = (solid("A", vec![clear]), isometric());
    let front = edges_of_block(&camera, -HALF, HALF).concat();
    // the corner that is farthest from the eye
    let corner = -HALF * ISO.signum();
    let back: Vec<[DVec2; 2]> = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|axis| [corner, corner + axis * ISO.signum()].map(|p| pixel(&camera, p)))
        .to_vec();
    let off = |p: DVec2| to_segments(&front, p).min(to_segments(&back, p));
    let found = judged(&model, &camera, &DrawingSettings::default(), &image(&camera, off));
    assert_eq!((found.missing, found.stray, found.unsure), (0, 0, 0), "{found:?}");
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&front, p)));
    assert!(stray == 0 && missing as f64 > 0.8 * crossed(&back), "{missing} {stray}");
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&back, p)));
    assert!(stray == 0 && missing > 300, "{missing} {stray}");
    // a line within a face, which nothing hides
    let within = [pixel(&camera, DVec3::new(-0.3, 0.3, 0.5)), pixel(&camera, DVec3::new(0.3, 0.3, 0.5))];
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| off(p).min(to_segments(&[within], p))));
    assert!(missing == 0 && stray > 20, "{missing} {stray}");
}

/// All edges of a block.
fn all_edges_of_block(camera: &Camera, low: DVec3, high: DVec3) -> Vec<[DVec2; 2]> {
    let corner = |k: usize| DVec3::from([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }));
    let begins = (0..8).flat_map(|k| (0..3).filter(move |axis| k >> axis & 1 == 0).map(move |axis| (k, k | 1 << axis)));
    begins.map(|(a, b)| [a, b].map(|k| pixel(camera, corner(k)))).collect()
}

/// A hollow block of glass: the edges of the hollow are between the nearest and the farthest faces, and are missed if
/// they have no lines. Beside the hollow's outline the block's back is the second layer and not the fourth, and has no
/// line.
#[test]
fn edges_in_the_middle_of_glass_have_lines() {
    let clear = |half: DVec3| Primitive { colour: [1.0, 1.0, 1.0, 0.4], ..block(-half, half) };
    // in the picture no edge of it lies on another one
    let hollow = DVec3::new(0.15, 0.25, 0.35);
    let (model, camera) = (solid("A-B", vec![clear(HALF), clear(hollow)]), isometric());
    let outer = all_edges_of_block(&camera, -HALF, HALF);
    let inner = all_edges_of_block(&camera, -hollow, hollow);
    let off = |p: DVec2| to_segments(&outer, p).min(to_segments(&inner, p));
    let found = judged(&model, &camera, &DrawingSettings::default(), &image(&camera, off));
    assert_eq!((found.missing, found.stray, found.unsure), (0, 0, 0), "{found:?}");
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&outer, p)));
    assert!(stray == 0 && missing as f64 > 0.7 * crossed(&inner), "{missing} {stray}");
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&inner, p)));
    assert!(stray == 0 && missing as f64 > 0.7 * crossed(&outer), "{missing} {stray}");
    // opaque, the hollow is seen by no ray
    let (model, lines) = (solid("A-B", vec![block(-HALF, HALF), block(-hollow, hollow)]), image(&camera, off));
    let (_, stray) = faults(&model, &camera, &lines);
    assert!(stray > 100, "{stray}");
}

/// The back of a block of glass runs into a plate that is of no solid: there has to be a line.
#[test]
fn the_back_of_glass_meets_a_face() {
    use super::super::shapes::{face, rectangle};
    let plane = rectangle(DVec3::new(0.2, -9.0, -9.0), DVec3::Y * 18.0, DVec3::Z * 18.0);
    let part = Part { faces: vec![face(7, plane, Vec::new())], ..Part::default() };
    // the eye is at high x: the plate hides what is behind it, and the block's low side ends at it
    let clear = Primitive { colour: [1.0, 1.0, 1.0, 0.4], ..block(-HALF, HALF) };
    let (model, camera) = (Model { solids: solid("A", vec![clear]).solids, ..alone(part) }, isometric());
    let edges = all_edges_of_block(&camera, HALF.with_x(0.2) * DVec3::new(1.0, -1.0, -1.0), HALF);
    let corners =
        [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(y, z)| pixel(&camera, DVec3::new(0.2, y, z)));
    let met: Vec<[DVec2; 2]> = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect();
    let right = image(&camera, |p| to_segments(&edges, p));
    assert_eq!(faults(&model, &camera, &right), (0, 0));
    // two of the four are met by faces at the back
    let is_met = |edge: &[DVec2; 2]| met.iter().any(|m| m.iter().all(|p| edge.iter().any(|q| p.distance(*q) < 1e-6)));
    let others: Vec<[DVec2; 2]> = edges.iter().copied().filter(|edge| !is_met(edge)).collect();
    assert_eq!(others.len() + 4, edges.len());
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&others, p)));
    assert!(stray == 0 && missing as f64 > 0.8 * crossed(&met), "{missing} {stray}");
}

/// Something opaque within glass ends no face of it.
#[test]
fn what_is_within_glass_ends_none_of_its_faces() {
    let clear = Primitive { colour: [1.0, 1.0, 1.0, 0.4], ..block(-HALF, HALF) };
    let ball = at(DVec3::ZERO, Shape::Sphere { radius: 0.3 });
    let both = [solid("A", vec![clear]), solid("A", vec![ball])].map(|model| model.solids).concat();
    let (model, camera) = (Model { solids: both, ..Model::default() }, isometric());
    let edges = edges_of_block(&camera, -HALF, HALF).concat();
    let corner = -HALF * ISO.signum();
    let behind = |p: DVec2| p.distance(DVec2::new(100.0, 75.0)) < 75.0 * 0.3;
    let back: Vec<[DVec2; 2]> = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|axis| [corner, corner + axis * ISO.signum()].map(|p| pixel(&camera, p)))
        .to_vec();
    let shown = |p: DVec2| if behind(p) { f64::INFINITY } else { to_segments(&back, p) };
    let lines = image(&camera, |p| to_segments(&edges, p).min(shown(p)));
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let found = judged(&model, &camera, &settings, &lines);
    assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
}

/// Where a block stands in a face there has to be a line; along its sides the face hides and ends nothing.
#[test]
fn meetings_with_faces_have_lines() {
    use super::super::shapes::{face, rectangle};
    let plane = rectangle(DVec3::new(-9.0, -9.0, 0.0), DVec3::X * 18.0, DVec3::Y * 18.0);
    let part = Part { faces: vec![face(7, plane, Vec::new())], ..Part::default() };
    let camera = isometric();
    let model = Model { solids: solid("A", vec![block(-HALF, HALF)]).solids, ..alone(part) };
    let (low, high) = (-HALF.with_z(0.0), HALF);
    let edges = edges_of_block(&camera, low, high).concat();
    let at_floor = |x: f64, y: f64| pixel(&camera, DVec3::new(x, y, 0.0));
    let met = [[at_floor(0.5, 0.5), at_floor(0.5, -0.5)], [at_floor(0.5, -0.5), at_floor(-0.5, -0.5)]];
    assert_eq!(faults(&model, &camera, &image(&camera, |p| to_segments(&edges, p))), (0, 0));
    // all but the two where the block meets the floor
    let is_met = |edge: &[DVec2; 2]| met.iter().any(|m| m.iter().all(|p| edge.iter().any(|q| p.distance(*q) < 1e-6)));
    let others: Vec<[DVec2; 2]> = edges.iter().copied().filter(|edge| !is_met(edge)).collect();
    assert_eq!(others.len() + 2, edges.len());
    let (missing, stray) = faults(&model, &camera, &image(&camera, |p| to_segments(&others, p)));
    assert!(stray == 0 && missing as f64 > 0.8 * crossed(&met), "{missing} {stray}");
}
