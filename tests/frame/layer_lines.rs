//! Lines of solids that are seen through: of all faces that a ray meets, from the nearest one to the farthest.

use crate::edge_lines::centres;
use crate::layers::{BLUE, glass, model, one, painted};
use crate::shapes;
use crate::shapes::solids::{ball, block, post, solid};
use crate::solid_lines::{
    HALF, JUNCTION, OFF, OFF_AT_JUNCTIONS, SIZE, SOLID, away, draw, draw_in_bands, draw_next, judged_by_program, lines,
    with,
};
use crate::support::{assert_silent, orthographic, perspective, render, watched_with};
use crate::watched::renderer;
use glam::{DVec2, DVec3};
use selvedge::model::{Camera, Model};
use selvedge::picture::{EdgeChoice, EdgeSettings, SceneSettings};
use selvedge_check::Tracer;
use selvedge_check::drawing::{DrawingSettings, LineImage, judge_lines};

const LOW: [f64; 3] = [-1.0; 3];
const HIGH: [f64; 3] = [1.0; 3];
/// A block within that: of parallel edges of both, no two are nearer than 3 px in the picture.
const WITHIN: ([f64; 3], [f64; 3]) = ([-0.6, -0.6, -0.3], [0.6, 0.6, 0.3]);

fn glass_block() -> Model {
    model(vec![glass(BLUE, LOW, HIGH)])
}

fn hollow_block() -> Model {
    solid("A-B", [(LOW, HIGH), WITHIN].map(|(low, high)| painted(BLUE, block(low, high))).to_vec())
}

/// The same as a part of six faces.
fn glass_part() -> Model {
    let mut part = shapes::cube();
    part.instances[0].colour = Some(BLUE);
    part
}

fn cameras(model: &Model) -> [(&'static str, Camera); 2] {
    [("from afar", perspective(model, SIZE)), ("parallel", orthographic(model, SIZE))]
}

/// Points of a block's twelve edges, less than a tenth of a pixel apart.
fn edges_of_block(camera: &Camera, low: [f64; 3], high: [f64; 3]) -> Vec<DVec2> {
    let corner = |k: usize| DVec3::from([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }));
    let edges =
        (0..8usize).flat_map(|k| (0..3).filter(move |axis| k >> axis & 1 == 0).map(move |axis| (k, k | 1 << axis)));
    let points = |(a, b): (usize, usize)| {
        let (a, b) = (corner(a), corner(b));
        (0..=1000).map(move |k| a.lerp(b, f64::from(k) / 1000.0))
    };
    edges.flat_map(points).map(|p| camera.project(p).unwrap().0).collect()
}

/// Where edges cross in the picture.
fn crossings(edges: &[[DVec2; 2]]) -> Vec<DVec2> {
    let pairs = edges.iter().enumerate().flat_map(|(k, a)| edges[..k].iter().map(move |b| (*a, *b)));
    let cross = |([a, b], [c, d]): ([DVec2; 2], [DVec2; 2])| {
        let (along, other) = (b - a, d - c);
        let area = along.perp_dot(other);
        let shares = [(c - a).perp_dot(other) / area, (c - a).perp_dot(along) / area];
        // parallel ones have no such numbers
        shares.iter().all(|share| (0.0..=1.0).contains(share)).then(|| a + along * shares[0])
    };
    pairs.filter_map(cross).collect()
}

/// All edges of blocks of glass have lines, those at their back, too: of a Boolean solid, and of a part, whose edges
/// have their own numbers. The edges of a hollow are between the nearest and the farthest faces.
#[test]
fn all_edges_of_a_glass_block_have_lines() {
    let (whole, part) = (glass_block(), glass_part());
    let hollow = hollow_block();
    let [from_afar, parallel] = cameras(&whole);
    let (outer, both) = (&[(LOW, HIGH)][..], &[(LOW, HIGH), WITHIN][..]);
    let mut renderer = renderer();
    for (model, (view, camera), blocks, is_part) in [
        (&whole, from_afar, outer, false),
        (&whole, parallel, outer, false),
        (&part, parallel, outer, true),
        (&hollow, from_afar, both, false),
        (&hollow, parallel, both, false),
    ] {
        let settings = EdgeSettings { which: EdgeChoice::Sharp, ..lines() };
        let picture = draw_next(&mut renderer, (model, with(settings)), &camera);
        let edges: Vec<DVec2> = blocks.iter().flat_map(|(low, high)| edges_of_block(&camera, *low, *high)).collect();
        let ends: Vec<[DVec2; 2]> = edges.chunks(1001).map(|edge| [edge[0], edge[1000]]).collect();
        // lines of one layer that cross meet at the mean of their places
        let corners: Vec<DVec2> = ends.iter().copied().flatten().chain(crossings(&ends)).collect();
        let own = |edge: u32| if is_part { (1..SOLID).contains(&edge) } else { edge == SOLID };
        let marked: Vec<DVec2> = centres(&picture).filter(|(_, edge)| own(*edge)).map(|(at, _)| at).collect();
        let near_corner = |p: DVec2| away(p, &corners) < JUNCTION;
        let is_bare = |p: &&DVec2| !near_corner(**p) && away(**p, &marked) > HALF + 0.5;
        let is_stray = |p: &&DVec2| {
            let off = if near_corner(**p) { OFF_AT_JUNCTIONS } else { OFF };
            away(**p, &edges) > HALF + 0.5 + off
        };
        let (bare, stray) = (edges.iter().filter(is_bare).count(), marked.iter().filter(is_stray).count());
        assert!(marked.len() > 400, "{view}: {} pixels", marked.len());
        assert_eq!((bare, stray), (0, 0), "{view}: of {} points and {} pixels", edges.len(), marked.len());
    }
    assert_silent(renderer);
}

/// As `selvedge check --edges` judges them.
#[test]
fn the_programs_judge_finds_no_fault() {
    let clear = |p| painted(BLUE, p);
    let shapes = [
        ("a block with a round hole", solid("A-B", vec![clear(block(LOW, HIGH)), clear(post(0.6, -2.0, 4.0))])),
        // the bottom's edge is behind the near wall of the hole
        ("a block with a blind hole", solid("A-B", vec![clear(block(LOW, HIGH)), clear(post(0.6, -0.3, 2.0))])),
        ("a hollow block", solid("A-B", vec![clear(block(LOW, HIGH)), clear(block(WITHIN.0, WITHIN.1))])),
        // the block's bottom runs into the post behind the post's outline, too, where the post hides it
        ("an opaque post through a block", model(vec![glass(BLUE, LOW, HIGH), one(post(0.5, -1.5, 3.0))])),
        ("an opaque ball within a block", model(vec![glass(BLUE, LOW, HIGH), one(ball(0.6, 0.0))])),
        ("two blocks", model(vec![glass(BLUE, LOW, [0.2, 1.0, 1.0]), glass(BLUE, [-0.3; 3], [1.4, 0.5, 0.5])])),
    ];
    let (mut renderer, mut seen, mut faults) = (renderer(), 0, Vec::new());
    for (nth, (name, model)) in shapes.into_iter().enumerate() {
        let (view, camera) = cameras(&model)[nth % 2];
        let found = judged_by_program(&mut renderer, &model, &camera);
        println!("{name}, {view}: {found:?}");
        seen += found.visible;
        if (found.missing, found.stray) != (0, 0) {
            faults.push(format!("{name}, {view}: {found:?}"));
        }
    }
    assert_silent(renderer);
    assert!(seen > 2000 && faults.is_empty(), "{seen} places seen\n{}", faults.join("\n"));
}

/// The judge sees it if lines at the back of glass are not drawn: those of the same block, opaque.
#[test]
fn lines_of_the_front_alone_are_too_few() {
    let (clear, opaque) = (glass_block(), solid("A", vec![block(LOW, HIGH)]));
    let camera = orthographic(&clear, SIZE);
    let picture = draw(&opaque, with(EdgeSettings { which: EdgeChoice::Sharp, ..lines() }), &camera);
    let image = LineImage { lines: &picture.edge, width: 2.0 * HALF, section_width: 4.0 * HALF };
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let found = judge_lines(&clear, &Tracer::new(&clear), &camera, &settings, image).unwrap();
    assert!(found.missing > 30 && found.stray == 0, "{found:?}");
}

/// The judge sees it if the edges of a hollow have no lines: those of the same block without one.
#[test]
fn lines_of_the_nearest_and_the_farthest_faces_are_too_few() {
    let (hollow, whole) = (hollow_block(), glass_block());
    let camera = orthographic(&hollow, SIZE);
    let picture = draw(&whole, with(EdgeSettings { which: EdgeChoice::Sharp, ..lines() }), &camera);
    let image = LineImage { lines: &picture.edge, width: 2.0 * HALF, section_width: 4.0 * HALF };
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let found = judge_lines(&hollow, &Tracer::new(&hollow), &camera, &settings, image).unwrap();
    assert!(found.missing > 100 && found.stray == 0, "{found:?}");
}

/// The faces of five plates one behind another are ten: the back edges of the last one have lines, for it is the
/// farthest.
#[test]
fn of_many_faces_the_farthest_has_lines() {
    let model = plates();
    let bounds = glass_block().control_bounds();
    let camera = Camera::around(bounds, DVec3::new(0.3, -1.6, 0.25), DVec3::Z, 0.5, SIZE);
    let picture = draw(&model, with(EdgeSettings { which: EdgeChoice::Sharp, ..lines() }), &camera);
    let marked: Vec<DVec2> = centres(&picture).filter(|(_, edge)| *edge == SOLID).map(|(at, _)| at).collect();
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corners = corners.map(|(x, z)| camera.project(DVec3::new(x, 0.8, z)).unwrap().0);
    let side = |k: usize| (5..=95).map(move |n| corners[k].lerp(corners[(k + 1) % 4], f64::from(n) / 100.0));
    let bare = (0..4).flat_map(side).filter(|p| away(*p, &marked) > HALF + 0.5).count();
    assert_eq!(bare, 0);
}

/// Five plates of glass, one behind another.
fn plates() -> Model {
    let plate = |k: u32| {
        let y = f64::from(k) * 0.4 - 1.0;
        painted(BLUE, block([-1.0, y, -1.0], [1.0, y + 0.2, 1.0]))
    };
    solid("A+B+C+D+E", (0..5).map(plate).collect())
}

/// Where the lists are those of one band of rows at a time, lines are the same.
#[test]
fn lines_are_the_same_in_bands() {
    let glass_ = || painted(BLUE, block(LOW, HIGH));
    let both = model(solid("A-B", vec![glass_(), painted(BLUE, post(0.6, -2.0, 4.0))]).solids);
    let camera = perspective(&both, SIZE);
    let settings = EdgeSettings { silhouettes: true, ..lines() };
    let whole = draw(&both, with(settings), &camera);
    let banded = draw_in_bands(&both, with(settings), &camera);
    assert!(whole.edge.iter().filter(|edge| **edge == SOLID).count() > 300);
    assert!(banded.edge == whole.edge && banded.colour == whole.colour);
}

/// Their passes and images exist only where something is seen through and lines are drawn.
#[test]
fn what_makes_them_exists_only_where_it_is_needed() {
    let count = |model: &Model, settings| {
        let mut renderer = watched_with(model, settings);
        render(&mut renderer, &perspective(model, SIZE));
        let objects = renderer.objects();
        assert_silent(renderer);
        objects.iter().filter(|n| n.contains("seen through)") || n.contains("faces seen through")).count()
    };
    assert!(count(&glass_block(), with(lines())) >= 2);
    assert_eq!(count(&glass_block(), SceneSettings::default()), 0);
    assert_eq!(count(&solid("A", vec![block(LOW, HIGH)]), with(lines())), 0);
    // a pass for the farthest faces: where a ray may meet more than eight
    let has_farthest = |model: &Model| {
        let renderer = watched_with(model, with(lines()));
        let objects = renderer.objects();
        assert_silent(renderer);
        objects.iter().any(|name| name.contains("farthest faces"))
    };
    assert!(has_farthest(&plates()));
    assert!(!has_farthest(&glass_block()) && !has_farthest(&hollow_block()));
}
