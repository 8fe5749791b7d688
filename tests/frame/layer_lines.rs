//! Lines of solids that are seen through: of their nearest faces, and of the farthest ones.

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

const LOW: [f64; 3] = [-1.0; 3];
const HIGH: [f64; 3] = [1.0; 3];

fn glass_block() -> Model {
    model(vec![glass(BLUE, LOW, HIGH)])
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

/// Points of the block's twelve edges, less than a tenth of a pixel apart.
fn edges_of_block(camera: &Camera) -> Vec<DVec2> {
    let corner = |k: usize| DVec3::from([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { LOW[axis] } else { HIGH[axis] }));
    let edges =
        (0..8usize).flat_map(|k| (0..3).filter(move |axis| k >> axis & 1 == 0).map(move |axis| (k, k | 1 << axis)));
    let points = |(a, b): (usize, usize)| {
        let (a, b) = (corner(a), corner(b));
        (0..=1000).map(move |k| a.lerp(b, f64::from(k) / 1000.0))
    };
    edges.flat_map(points).map(|p| camera.project(p).unwrap().0).collect()
}

/// All twelve edges of a block of glass have lines, those at its back, too: of a Boolean solid, and of a part, whose
/// edges have their own numbers.
#[test]
fn all_edges_of_a_glass_block_have_lines() {
    let (block, part) = (glass_block(), glass_part());
    let [from_afar, parallel] = cameras(&block);
    let mut renderer = renderer();
    for (model, (view, camera), is_part) in
        [(&block, from_afar, false), (&block, parallel, false), (&part, parallel, true)]
    {
        let settings = EdgeSettings { which: EdgeChoice::Sharp, ..lines() };
        let picture = draw_next(&mut renderer, (model, with(settings)), &camera);
        let edges = edges_of_block(&camera);
        let corners: Vec<DVec2> = edges.chunks(1001).flat_map(|edge| [edge[0], edge[1000]]).collect();
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
    use selvedge_check::Tracer;
    use selvedge_check::drawing::{DrawingSettings, LineImage, judge_lines};
    let (clear, opaque) = (glass_block(), solid("A", vec![block(LOW, HIGH)]));
    let camera = orthographic(&clear, SIZE);
    let picture = draw(&opaque, with(EdgeSettings { which: EdgeChoice::Sharp, ..lines() }), &camera);
    let image = LineImage { lines: &picture.edge, width: 2.0 * HALF, section_width: 4.0 * HALF };
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let found = judge_lines(&clear, &Tracer::new(&clear), &camera, &settings, image).unwrap();
    assert!(found.missing > 30 && found.stray == 0, "{found:?}");
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
}
