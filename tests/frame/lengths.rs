//! Measurements along rays through solids: lengths, contacts, overlaps; and the resources that they need.

use crate::layers::{
    AROUND, BLUE, EDGE_PX, SIZE, STEEL, centre, gear, glass, in_glass, is_at_edge, model, one, painted, tracer,
};
use crate::shapes::operands::part;
use crate::shapes::solids::{ball, blunt_blocks, stone};
use crate::shapes::sphere;
use crate::support::{assert_silent, orthographic, perspective, render, watched, watched_for, watched_with};
use glam::{DVec2, DVec3};
use selvedge::model::{Model, Solid};
use selvedge::picture::{FrameSettings, Highlight, Outputs, SceneSettings};
use selvedge_check::solids::LayerTracer;

/// Lengths within solids; 0 outside. Closed parts count, too.
#[test]
fn thickness() {
    let mut solid = in_glass();
    solid.solids.push(one(painted(STEEL, ball(0.5, 1.4))));
    let mut with_part = model(vec![glass(BLUE, [-0.5, -0.5, -0.5], [2.0, 0.5, 0.5])]);
    let same_as = model(vec![with_part.solids[0].clone(), one(part(sphere()))]);
    let placed = sphere();
    (with_part.parts, with_part.instances) = (placed.parts, placed.instances);
    let stone = stone();
    let outputs = Outputs { thickness: true, ..Outputs::default() };
    let cases = [
        ("solids", &solid, &solid),
        ("a part", &with_part, &same_as),
        ("half-spaces", &stone, &stone),
        ("nothing", &Model::default(), &Model::default()),
    ];
    let mut renderer = watched(&Model::default());
    for (name, m, truth) in cases {
        let whole = Solid::union(&truth.solids).unwrap();
        let layers = tracer(&model(vec![whole]));
        let framed = if m.solids.is_empty() { &solid } else { m };
        for camera in [perspective(framed, SIZE), orthographic(framed, SIZE)] {
            renderer.upload(m).unwrap();
            let picture = renderer.render(&camera, &FrameSettings::default(), outputs).unwrap();
            assert_eq!(picture.thickness.len(), picture.colour.len());
            let (_, _, forward) = camera.axes();
            let (mut seen, size) = (0, framed.control_bounds().diagonal());
            for (i, drawn) in picture.thickness.iter().enumerate() {
                let at = centre(i, SIZE);
                if !m.solids.is_empty() && is_at_edge(&layers, &camera, at, EDGE_PX) {
                    continue;
                }
                let (_, d) = camera.ray(at);
                let (near, far) = camera.depth_range;
                let cosine = d.dot(forward);
                let length = |at: DVec2| {
                    let (o, d) = camera.ray(at);
                    let trace = || layers.union().trace(o, d).thickness(near / cosine, far / cosine);
                    if m.solids.is_empty() { 0.0 } else { trace() }
                };
                let exact = length(at);
                // a spline's outline may be half a pixel off, and so may the visible part of the surface
                let far = if name == "a part" { 0.5 } else { EDGE_PX };
                let beside = AROUND.map(|d| (length(at + d * far) - exact).abs()).into_iter().fold(0.0, f64::max);
                // some roundings of a depth, which is a few times the model's size; or the true length nearby
                let bound = 2e-6 * size + beside;
                assert!((exact - f64::from(*drawn)).abs() < bound, "{name} at {at}: {drawn}, truly {exact}");
                assert!(exact > 0.0 || drawn.to_bits() == 0, "{name} at {at}: {drawn}");
                seen += usize::from(exact > 0.0);
            }
            assert!(seen > 2000 || m.solids.is_empty(), "{name}: {seen}");
        }
    }
    assert_silent(renderer);
}

/// A ray that is followed through a solid meets a half-space only within what it cuts. If each were in the list of every
/// tile, as one that stands alone is, drivers would end the walks of these.
#[test]
fn thickness_of_many_pieces_that_half_spaces_cut() {
    let n = 7;
    let model = blunt_blocks(n);
    let exact = tracer(&model);
    let mut renderer = watched(&Model::default());
    for camera in [perspective(&model, SIZE), orthographic(&model, SIZE)] {
        renderer.upload(&model).unwrap();
        let outputs = Outputs { thickness: true, ..Outputs::default() };
        let picture = renderer.render(&camera, &FrameSettings::default(), outputs).unwrap();
        assert_eq!(picture.stats.clamps, 0);
        for k in 0..n * n {
            let middle = 3.0 * DVec3::new(f64::from(k % n), f64::from(k / n), 0.0);
            let pixel = camera.project(middle).unwrap().0.floor();
            let (o, d) = camera.ray(pixel + 0.5);
            let length = exact.union().trace(o, d).thickness(0.0, f64::INFINITY);
            let drawn = f64::from(picture.thickness[(pixel.y * f64::from(SIZE.0) + pixel.x) as usize]);
            assert!(length > 1.0 && (drawn - length).abs() < 1e-4, "{k} at {pixel}: {drawn}, truly {length}");
        }
    }
    assert_silent(renderer);
}

/// Solids that touch and solids that overlap are marked and counted.
#[test]
fn contacts_and_overlaps() {
    let steel = |x: f64, to: f64| glass(STEEL, [x, -0.98, -0.48], [to, 0.98, 0.48]);
    let cases = [
        ("apart", vec![steel(-1.0, 0.0), steel(0.01, 1.0)]),
        ("touching", vec![steel(-1.0, 0.0), steel(0.0, 1.0)]),
        ("overlapping", vec![steel(-1.0, 0.1), steel(-0.1, 1.0)]),
        ("flush and overlapping", vec![steel(-1.0, 0.5), steel(-1.0, 1.0)]),
        ("of glass", vec![glass(BLUE, [-1.0, -0.98, -0.48], [0.0, 0.98, 0.48]), steel(0.0, 1.0)]),
    ];
    let marks = SceneSettings { highlight: Some(Highlight::default()), ..SceneSettings::default() };
    let mut renderer = watched_with(&Model::default(), marks);
    for (name, solids) in cases {
        let m = model(solids);
        let camera = orthographic(&m, SIZE);
        renderer.upload_with(&m, marks).unwrap();
        let picture = render(&mut renderer, &camera);
        // each by itself
        let all: Vec<LayerTracer> =
            m.solids.iter().map(|s| tracer(&Model { solids: vec![s.clone()], ..Model::default() })).collect();
        let (mut contacts, mut overlaps, mut edges) = (0, 0, 0);
        for i in 0..picture.colour.len() {
            let (o, d) = camera.ray(centre(i, SIZE));
            let (a, b) = (all[0].union().trace(o, d), all[1].union().trace(o, d));
            let near = |x: f64, y: f64| (x - y).abs() < 1e-9;
            contacts += u64::from(a.boundaries.iter().any(|x| b.boundaries.iter().any(|y| near(x.t, y.t))));
            let both = a.thickness(0.0, 1e3) + b.thickness(0.0, 1e3);
            let union = tracer(&Model { solids: vec![Solid::union(&m.solids).unwrap()], ..Model::default() });
            overlaps += u64::from(both - union.union().trace(o, d).thickness(0.0, 1e3) > 1e-9);
            edges += u64::from(all.iter().any(|t| is_at_edge(t, &camera, centre(i, SIZE), EDGE_PX)));
        }
        let stats = &picture.stats;
        assert!(
            stats.contact_pixels.abs_diff(contacts) <= edges,
            "{name}: {} of {contacts} touch",
            stats.contact_pixels
        );
        assert!(stats.overlap_pixels.abs_diff(overlaps) <= edges, "{name}: {} of {overlaps}", stats.overlap_pixels);
        assert!(edges < 120, "{name}: {edges}");
        // solids that overlap have sides in common planes
        assert_eq!(contacts > 300, name != "apart", "{name}: {contacts}");
        assert_eq!(overlaps > 300, name.contains("overlapping"), "{name}: {overlaps}");
        // blue, red or both
        let tinted = picture.colour.iter().filter(|c| c[0].max(c[2]).abs_diff(c[1]) > 60).count();
        assert_eq!(tinted > 300, name != "apart", "{name}: {tinted} marked");
    }
    assert_silent(renderer);
}

/// An opaque scene has none of these resources, and each setting adds its own.
#[test]
fn only_who_is_followed_has_what_that_needs() {
    let opaque = model(vec![gear()]);
    let camera = perspective(&opaque, SIZE);
    let names = |m: &Model, settings: SceneSettings, outputs: Outputs| {
        let mut renderer = watched_for(outputs, m, settings);
        renderer.render(&camera, &FrameSettings::default(), outputs).unwrap();
        let mut names = renderer.objects();
        names.retain(|name| name.contains("layers") || name.contains("thickness"));
        names.sort();
        assert_silent(renderer);
        names
    };
    let (plain, aovs) = (SceneSettings::default(), Outputs::ALL);
    assert!(names(&opaque, plain, aovs).is_empty());
    let colour = names(&in_glass(), plain, Outputs::default());
    assert!(
        colour.iter().any(|n| n == "behind layers") && colour.iter().any(|n| n == "solid layers (colour)"),
        "{colour:?}"
    );
    assert!(!colour.iter().any(|n| n.contains("first") || n.contains("thickness")), "{colour:?}");
    assert!(names(&in_glass(), plain, aovs).iter().any(|n| n == "solid layers (first)"));
    let thick = names(&opaque, plain, Outputs { thickness: true, ..Outputs::default() });
    assert!(thick.iter().any(|n| n == "solid layers (thickness)"), "{thick:?}");
    assert!(!thick.iter().any(|n| n.contains("colour")), "{thick:?}");
}
