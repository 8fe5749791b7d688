//! The hard cases of trimming through whole frames, by every way to trim, at several zooms.
//!
//! Each case is a plane, the unit square of its (u, v), and the cameras look straight at it: for a pixel's centre, the
//! exact loops give the answer. A pixel may differ only if a loop passes within the tolerance of its centre.

use crate::shapes;
use crate::support::{assert_silent, watched_with};
use crate::trims;
use crate::watched::renderer;
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Face, LoopAt, Model, Projection, SurfaceKind};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings, TrimWay};
use selvedge::spline::Surface;
use selvedge::trim::LoopIndex;

/// Pixels along each side.
const SIZE: u32 = 96;
/// Pictures of the whole square, and of smaller and smaller parts around the focus.
const ZOOMS: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// The unit square, moved to `x`.
fn square(x: f64, id: u32, case: &trims::TrimCase) -> Face {
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| DVec4::new(x + u, v, 0.0, 1.0));
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    let surface = Surface::new((1, 1), knots(), knots(), corners.to_vec()).expect("a plane");
    let loops = case.loops.clone();
    Face { id, kind: SurfaceKind::Plane, surface, loops, same_sense: true, colour: None }
}

/// One part for each case, so that each is near its own origin.
fn model(cases: &[trims::TrimCase]) -> Model {
    let mut all = Model::default();
    for (i, case) in cases.iter().enumerate() {
        let one = shapes::one(case.name, false, vec![square(2.0 * i as f64, i as u32 + 1, case)]);
        all.parts.extend(one.parts);
        all.instances.push(selvedge::model::Instance { part: i, ..shapes::placed(DAffine3::IDENTITY, None) });
    }
    all
}

/// Looks down at `focus` of case `i`; the picture is `1 / zoom` wide.
fn camera(i: usize, focus: DVec2, zoom: f64) -> Camera {
    let centre = if zoom == 1.0 { DVec2::splat(0.5) } else { focus };
    let target = DVec3::new(2.0 * i as f64 + centre.x, centre.y, 0.0);
    Camera {
        eye: target + DVec3::Z * 2.0,
        target,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 1.0 / zoom },
        depth_range: (1.0, 3.0),
        size: (SIZE, SIZE),
    }
}

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera) -> Picture {
    let outputs = Outputs { face: true, ..Outputs::default() };
    renderer.render(camera, &FrameSettings::default(), outputs).unwrap()
}

/// The number of wrong pixels whose centre is farther than the tolerance from every loop, and of judged pixels.
fn judge(picture: &Picture, case: &trims::TrimCase, id: u32, (focus, zoom): (DVec2, f64)) -> (Vec<DVec2>, usize) {
    let index = LoopIndex::new(&case.loops);
    let centre = if zoom == 1.0 { DVec2::splat(0.5) } else { focus };
    let pixel = 1.0 / (zoom * f64::from(SIZE));
    let tolerance = FrameSettings::default().tolerance_px * pixel;
    let (mut wrong, mut judged) = (Vec::new(), 0);
    for y in 0..SIZE {
        for x in 0..SIZE {
            let off = DVec2::new(f64::from(x) + 0.5, f64::from(SIZE - y) - 0.5) - 0.5 * f64::from(SIZE);
            let p = centre + off * pixel;
            // the surface's border is a border in the picture, too
            let beside = p.min(DVec2::ONE - p).min_element();
            if index.distance(p, 1.0) <= tolerance || beside.abs() <= tolerance {
                continue;
            }
            let inside = beside > 0.0 && index.contains(p);
            let seen = picture.face[(y * SIZE + x) as usize];
            if seen != if inside { id } else { 0 } {
                wrong.push(p);
            }
            judged += 1;
        }
    }
    (wrong, judged)
}

fn every_case(way: TrimWay, zooms: &[f64]) {
    let cases = trims::all();
    let mut renderer = watched_with(&model(&cases), SceneSettings { trim: way, ..Default::default() });
    for (i, case) in cases.iter().enumerate() {
        // the judge agrees with the values stated by hand
        let index = LoopIndex::new(&case.loops);
        for &(u, v, winding) in case.rows.iter().filter(|r| index.distance(DVec2::new(r.0, r.1), 1.0) > 1e-6) {
            assert_eq!(index.winding(DVec2::new(u, v)), winding, "{} at ({u}, {v})", case.name);
        }
        for &zoom in zooms {
            let focus = DVec2::from(case.focus);
            let picture = draw(&mut renderer, &camera(i, focus, zoom));
            assert_eq!(picture.stats.clamps, 0, "{}", case.name);
            let (wrong, judged) = judge(&picture, case, i as u32 + 1, (focus, zoom));
            let what = format!("{way:?}, {}, zoom {zoom}: {} of {judged}", case.name, wrong.len());
            assert!(wrong.is_empty(), "{what} pixels wrong, the first at {:?}", wrong[0]);
        }
    }
    assert_silent(renderer);
}

/// Not a thousand times closer. There a strip would need more than its 65,536 rows, which the frame counts as a clamp;
/// the comb would need more intercepts than a storage buffer of 128 MiB holds, which is an error.
#[test]
fn by_table() {
    every_case(TrimWay::Table, &ZOOMS[..3]);
}

#[test]
fn by_exact_arcs() {
    every_case(TrimWay::Exact, &ZOOMS);
}

/// The judge reports a case that is drawn as another.
#[test]
fn a_wrong_case_is_seen() {
    let cases = trims::all();
    let find = |name: &str| cases.iter().position(|case| case.name == name).unwrap();
    let (eight, star) = (find("5 figure of eight"), find("5 pentagram"));
    let mut renderer = watched_with(&model(&cases), SceneSettings::default());
    let focus = DVec2::from(cases[star].focus);
    let picture = draw(&mut renderer, &camera(star, focus, 1.0));
    assert!(!judge(&picture, &cases[eight], star as u32 + 1, (focus, 1.0)).0.is_empty());
    assert_silent(renderer);
}

/// 13: a first frame, a jump of a hundred times closer, and a face that returns to the picture are drawn as after a new
/// upload.
#[test]
fn no_frame_depends_on_the_one_before() {
    let cases = trims::all();
    let i = cases.iter().position(|case| case.name == "7 holes").unwrap();
    let model = model(&cases[i..=i]);
    for &trim in TrimWay::ALL {
        let settings = SceneSettings { trim, ..Default::default() };
        let (mut old, mut fresh) = (watched_with(&model, settings), renderer());
        let focus = DVec2::from(cases[i].focus);
        let away =
            Camera { eye: DVec3::new(50.0, 0.0, 2.0), target: DVec3::new(50.0, 0.0, 0.0), ..camera(0, focus, 1.0) };
        for view in [camera(0, focus, 1.0), camera(0, focus, 100.0), away, camera(0, focus, 3.0)] {
            let picture = draw(&mut old, &view);
            fresh.upload_with(&model, settings).unwrap();
            let same = draw(&mut fresh, &view);
            assert!(picture.face == same.face && picture.colour == same.colour, "{trim:?}");
        }
        assert_silent(old);
        assert_silent(fresh);
    }
}

/// 14: a loop edited in every frame gives, bit for bit, the picture of a new upload of the edited model; patches come
/// under the loop and leave it.
#[test]
fn an_edited_loop_is_drawn_as_if_uploaded_afresh() {
    // bytes of one loop of twelve numbers, and of an exactly trimmed face of two loops
    edited_as_if_uploaded_afresh(TrimWay::Table, 4096);
    edited_as_if_uploaded_afresh(TrimWay::Exact, 16_384);
}

fn edited_as_if_uploaded_afresh(trim: TrimWay, most_bytes: u64) {
    let cases = trims::all();
    let i = cases.iter().position(|case| case.name == "10 outer loop not first").unwrap();
    let mut model = model(&cases[i..=i]);
    // 4 x 4 patches: the hole leaves some and meets others
    let knots = || vec![0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0];
    let points = (0..25).map(|k| DVec4::new(f64::from(k % 5) / 4.0, f64::from(k / 5) / 4.0, 0.0, 1.0)).collect();
    model.parts[0].faces[0].surface = Surface::new((1, 1), knots(), knots(), points).unwrap();
    let at = LoopAt { part: 0, face: 0, trim_loop: 0 };
    let view = Camera { size: (64, 64), ..camera(0, DVec2::splat(0.5), 1.0) };
    let fixed = SceneSettings { trim, ..Default::default() };
    let mut edited = watched_with(&model, SceneSettings { editable: true, ..fixed });
    draw(&mut edited, &view);
    let mut fresh = renderer();
    for frame in 0..6 {
        let start = model.parts[0].faces[0].loops[0].clone();
        let next = match frame {
            0 => start.translated(DVec2::new(0.2, 0.0)).unwrap(),
            1 => start.translated(DVec2::new(-0.125, 0.2)).unwrap(),
            // one control point: where two curves meet, and an inner one
            2 => start.with_point(1, 0, DVec2::new(0.4, 0.6)).unwrap(),
            3 => start.with_point(2, 1, DVec2::new(0.25, 0.25)).unwrap(),
            4 => start.translated(DVec2::new(0.0, -0.3)).unwrap(),
            _ => start.translated(DVec2::new(0.01, 0.01)).unwrap(),
        };
        edited.edit_loop(at, &next).unwrap();
        model.parts[0].faces[0].loops[0] = next;
        let a = draw(&mut edited, &view);
        fresh.upload_with(&model, fixed).unwrap();
        let b = draw(&mut fresh, &view);
        assert!(a.colour == b.colour && a.face == b.face, "frame {frame}");
        assert!(a.stats.edit_bytes > 0 && a.stats.edit_bytes < most_bytes, "{trim:?}: {} bytes", a.stats.edit_bytes);
    }
    assert_eq!(draw(&mut edited, &view).stats.edit_bytes, 0, "nothing was edited since");
    assert_silent(edited);
    assert_silent(fresh);
}

/// The cost of an edit depends on its own face: among others with many loops, it sends the same bytes.
#[test]
fn an_edit_costs_what_its_face_costs() {
    let named = |name: &&str| trims::all().into_iter().find(|case| case.name == *name).unwrap();
    let (one, many) = ("10 outer loop not first", "7 holes");
    let at = LoopAt { part: 0, face: 0, trim_loop: 0 };
    let view = Camera { size: (64, 64), ..camera(0, DVec2::splat(0.5), 1.0) };
    for &trim in TrimWay::ALL {
        let settings = SceneSettings { trim, editable: true, ..Default::default() };
        let sent = [&[one][..], &[one, many, many]].map(|names| {
            let cases: Vec<_> = names.iter().map(named).collect();
            let mut edited = watched_with(&model(&cases), settings);
            draw(&mut edited, &view);
            let moved = cases[0].loops[0].translated(DVec2::new(0.01, 0.02)).unwrap();
            edited.edit_loop(at, &moved).unwrap();
            let bytes = draw(&mut edited, &view).stats.edit_bytes;
            assert_silent(edited);
            bytes
        });
        assert!(sent[0] > 0 && sent[0] == sent[1], "{trim:?}: {sent:?}");
    }
}

/// Edits that are not possible are errors, and leave the scene unchanged.
#[test]
fn edits_that_cannot_be() {
    use selvedge::renderer::EditError;
    let cases = trims::all();
    let model = model(&cases[..1]);
    let at = LoopAt { part: 0, face: 0, trim_loop: 0 };
    let shape = &model.parts[0].faces[0].loops[0];
    let mut fixed = watched_with(&model, SceneSettings::default());
    assert_eq!(fixed.edit_loop(at, shape), Err(EditError::NotEditable));
    assert_silent(fixed);
    let mut edited = watched_with(&model, SceneSettings { editable: true, ..Default::default() });
    for wrong in [LoopAt { part: 7, ..at }, LoopAt { face: 1, ..at }, LoopAt { trim_loop: 1, ..at }] {
        assert_eq!(edited.edit_loop(wrong, shape), Err(EditError::NoSuchLoop(wrong)));
    }
    let other = &trims::all()[7].loops[0];
    assert_eq!(edited.edit_loop(at, other), Err(EditError::OtherCurves));
    assert!(shape.with_point(0, 9, DVec2::ZERO).is_err() && shape.with_point(0, 0, DVec2::NAN).is_err());
    assert_silent(edited);
}
