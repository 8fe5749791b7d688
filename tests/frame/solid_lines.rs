//! Lines of Boolean solids: where exact rays beside each other see two surfaces there is a line, and nowhere else.

use crate::shapes::solids::{at, ball, below, block, cone, moved, post, ring, solid, turned};
use crate::support::{assert_silent, orthographic, perspective, watched_with};
use crate::watched::renderer;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model};
use selvedge::picture::{
    EdgeChoice, EdgeSettings, FrameSettings, Outputs, Picture, SceneSettings, SolidWay, TangentEdges,
};
use selvedge_check::drawing::{DrawingSettings, LineImage, LineJudgement, judge_lines};
use selvedge_check::{Hit, Tracer};

pub const SIZE: (u32, u32) = (120, 90);
/// Number of a line of a Boolean solid in the image of edges.
pub const SOLID: u32 = u32::MAX - 1;
/// Half a line's width, pixels.
pub const HALF: f64 = 0.625;
/// Rays along a pixel's side.
const RAYS: usize = 5;
/// A tenth of a pixel for the line, a tenth for the place of a change between two rays.
pub const OFF: f64 = 0.2;
/// Where three surfaces meet between four centres, lines go to the mean of their places: up to half a pixel off, in the
/// pixels around.
pub const OFF_AT_JUNCTIONS: f64 = 0.6;
pub const JUNCTION: f64 = 2.5;
/// Pixels of a picture without a line: where a fold runs out, in what is smooth between two centres.
const ENDS: usize = 1;
/// A pixel has the line's number where the line covers a tenth of it.
const MARKED: f64 = HALF + 0.5 - 0.1;

pub fn lines() -> EdgeSettings {
    let usual = EdgeSettings::default();
    let at = |px: f64| px * EdgeSettings::HEIGHT / f64::from(SIZE.1);
    EdgeSettings { width: at(2.0 * HALF), thin_width: at(0.5), section_width: at(4.0 * HALF), ..usual }
}

pub fn draw(model: &Model, settings: SceneSettings, camera: &Camera) -> Picture {
    let mut renderer = renderer();
    let picture = draw_next(&mut renderer, (model, settings), camera);
    assert_silent(renderer);
    picture
}

/// The picture of a scene that replaces the renderer's, and shares its pipelines.
pub fn draw_next(
    renderer: &mut HeadlessRenderer,
    (model, settings): (&Model, SceneSettings),
    camera: &Camera,
) -> Picture {
    let outputs = Outputs { edge: true, ..Outputs::ALL };
    renderer.expect(outputs);
    renderer.upload_with(model, settings).unwrap();
    renderer.render(camera, &FrameSettings::default(), outputs).unwrap()
}

/// With the first budget, of 4000 bytes and each a tenth less than the last, for which lists are made band by band.
pub fn draw_in_bands(model: &Model, settings: SceneSettings, camera: &Camera) -> Picture {
    let outputs = Outputs { edge: true, ..Outputs::ALL };
    let mut renderer = renderer();
    renderer.expect(outputs);
    let mut budget = 4_000;
    loop {
        renderer.upload_with(model, SceneSettings { solid_budget: Some(budget), ..settings }).unwrap();
        // one row of tiles does not fit into too small a budget
        let picture = renderer.render(camera, &FrameSettings::default(), outputs).unwrap();
        if picture.stats.bands > 1 {
            assert_silent(renderer);
            return picture;
        }
        budget = budget * 9 / 10;
    }
}

/// From the nearest of these points.
pub fn away(p: DVec2, all: &[DVec2]) -> f64 {
    all.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min)
}

pub fn with(edges: EdgeSettings) -> SceneSettings {
    SceneSettings { edges: Some(edges), ..SceneSettings::default() }
}

/// Between two rays a fifth of a pixel apart: a jump of the depth, or an angle. Smooth surfaces here turn by less than 6
/// degrees over that, and edges by 15 and more.
fn changes(a: Option<&Hit>, b: Option<&Hit>, camera: &Camera, ways: [DVec2; 2], folds: bool) -> bool {
    let (Some(a), Some(b)) = (a, b) else { return folds && a.is_some() != b.is_some() };
    if a.normal.dot(b.normal) < 10f64.to_radians().cos() {
        return true;
    }
    // where the plane at one point is met by the ray of the other
    let beyond = |from: &Hit, to: &Hit, pixel: DVec2| {
        let (origin, direction) = camera.ray(pixel);
        let t = (from.point - origin).dot(from.normal) / direction.dot(from.normal);
        (origin + direction * t).distance(to.point)
    };
    let px = if camera.is_perspective() { a.depth.min(b.depth) } else { 1.0 } / camera.focal_px().x;
    folds && beyond(a, b, ways[1]).min(beyond(b, a, ways[0])) > px
}

struct Judged {
    changes: usize,
    marked: usize,
    bare: Vec<DVec2>,
    stray: Vec<DVec2>,
}

/// Pixels near a change without a line, and pixels of lines far from any.
fn judged(model: &Model, camera: &Camera, picture: &Picture, folds: bool) -> Judged {
    let tracer = Tracer::new(model);
    let (w, h) = (SIZE.0 as usize * RAYS, SIZE.1 as usize * RAYS);
    let place = |x: usize, y: usize| (DVec2::new(x as f64, y as f64) + 0.5) / RAYS as f64;
    let row = |y: usize| {
        let mut probe = tracer.probe(camera);
        (0..w).map(|x| probe.first(place(x, y))).collect::<Vec<_>>()
    };
    let hits: Vec<Option<Hit>> = (0..h).into_par_iter().flat_map(row).collect();
    let mut near = vec![f64::INFINITY; picture.edge.len()];
    let mut junction = near.clone();
    let mut count = 0;
    let differs = |(x, y): (usize, usize), (bx, by): (usize, usize)| {
        let ways = [place(x, y), place(bx, by)];
        changes(hits[y * w + x].as_ref(), hits[by * w + bx].as_ref(), camera, ways, folds)
    };
    let beside = |x: usize, y: usize| [(x + 1, y), (x, y + 1)].into_iter().filter(move |(x, y)| *x < w && *y < h);
    for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
        for beside in beside(x, y).filter(|beside| differs((x, y), *beside)) {
            let change = 0.5 * (place(x, y) + place(beside.0, beside.1));
            count += 1;
            for_near(change, |at, pixel| near[at] = near[at].min(pixel.distance(change)));
        }
        if x + 1 < w && y + 1 < h {
            let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1), (x, y)];
            if corners.windows(2).filter(|c| differs(c[0], c[1])).count() > 2 {
                let middle = 0.5 * (place(x, y) + place(x + 1, y + 1));
                for_near(middle, |at, pixel| junction[at] = junction[at].min(pixel.distance(middle)));
            }
        }
    }
    let mut out = Judged { changes: count, marked: 0, bare: Vec::new(), stray: Vec::new() };
    for (at, (&edge, &away)) in picture.edge.iter().zip(&near).enumerate() {
        let (x, y) = (at % SIZE.0 as usize, at / SIZE.0 as usize);
        if x < 2 || y < 2 || x + 2 >= SIZE.0 as usize || y + 2 >= SIZE.1 as usize {
            continue;
        }
        let pixel = DVec2::new(x as f64, y as f64) + 0.5;
        out.marked += usize::from(edge == SOLID);
        if edge == SOLID && away > MARKED + OFF {
            out.stray.push(pixel);
        }
        let off = if junction[at] < JUNCTION { OFF_AT_JUNCTIONS } else { OFF };
        if edge != SOLID && away < MARKED - off {
            out.bare.push(pixel);
        }
    }
    out
}

/// The pixels around a place.
fn for_near(place: DVec2, mut each: impl FnMut(usize, DVec2)) {
    let range = |c: f64, end: u32| ((c - 4.0).max(0.0) as usize)..(((c + 4.0).max(0.0) as usize).min(end as usize));
    for y in range(place.y, SIZE.1) {
        for x in range(place.x, SIZE.0) {
            each(y * SIZE.0 as usize + x, DVec2::new(x as f64, y as f64) + 0.5);
        }
    }
}

/// One expression each, of all kinds of surfaces.
fn solids() -> Vec<(&'static str, Model)> {
    let cube = || block([-1.0; 3], [1.0; 3]);
    vec![
        ("a block", solid("A", vec![cube()])),
        ("a block with a round hole", solid("A-B", vec![cube(), post(0.6, -2.0, 4.0)])),
        ("a block with a dent", solid("A-B", vec![cube(), moved(at(0.6, -0.8, 0.9), ball(0.7, 0.0))])),
        ("a block and a ball", solid("A+B", vec![cube(), moved(at(0.8, -0.9, 0.7), ball(0.8, 0.0))])),
        (
            "two posts across",
            solid("A+B", vec![post(0.6, -1.5, 3.0), moved(turned(0.0, 1.4, 0.3), post(0.4, -1.5, 3.0))]),
        ),
        ("a ring", solid("A", vec![moved(turned(0.5, 0.2, 0.0), ring(1.0, 0.4))])),
        ("a ring through a block", solid("A+B", vec![cube(), moved(at(0.9, -0.9, 0.2), ring(0.8, 0.25))])),
        ("a cone cut across", solid("A*B", vec![cone(1.0, 0.2, 2.0), below(DVec3::new(0.4, -0.5, 1.0), 0.9)])),
        ("a block behind a ball", solid("A+B", vec![moved(at(-1.2, 1.9, -1.0), cube()), ball(0.8, 0.3)])),
    ]
}

#[test]
fn lines_are_where_exact_rays_see_two_surfaces() {
    let (mut renderer, mut faults) = (renderer(), Vec::new());
    for (name, model) in solids() {
        for (view, camera) in [("from afar", perspective(&model, SIZE)), ("parallel", orthographic(&model, SIZE))] {
            let settings = EdgeSettings { silhouettes: true, which: EdgeChoice::Sharp, ..lines() };
            let picture = draw_next(&mut renderer, (&model, with(settings)), &camera);
            let j = judged(&model, &camera, &picture, true);
            println!(
                "{name}, {view}: {} changes, {} marked, bare {:?}, stray {:?}",
                j.changes, j.marked, j.bare, j.stray
            );
            assert!(j.changes > 500 && j.marked > 100, "{name}, {view}");
            if j.bare.len() > ENDS || !j.stray.is_empty() {
                faults.push(format!("{name}, {view}: {} bare, {} stray", j.bare.len(), j.stray.len()));
            }
        }
    }
    assert_silent(renderer);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// As `selvedge check --edges` judges them: without outlines, and with smooth transitions as wide as edges.
pub fn judged_by_program(renderer: &mut HeadlessRenderer, model: &Model, camera: &Camera) -> LineJudgement {
    let drawn = EdgeSettings { tangent: TangentEdges::Full, ..lines() };
    let picture = draw_next(renderer, (model, with(drawn)), camera);
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let image = LineImage { lines: &picture.edge, width: 2.0 * HALF, section_width: 4.0 * HALF };
    judge_lines(model, &Tracer::new(model), camera, &settings, image).unwrap()
}

#[test]
fn the_programs_judge_finds_no_fault() {
    let (mut renderer, mut seen, mut faults) = (renderer(), 0, Vec::new());
    for (name, model) in solids() {
        for (view, camera) in [("from afar", perspective(&model, SIZE)), ("parallel", orthographic(&model, SIZE))] {
            let found = judged_by_program(&mut renderer, &model, &camera);
            println!("{name}, {view}: {found:?}");
            seen += found.visible;
            if (found.missing, found.stray, found.unsure) != (0, 0, 0) {
                faults.push(format!("{name}, {view}: {found:?}"));
            }
        }
    }
    assert_silent(renderer);
    assert!(seen > 2000 && faults.is_empty(), "{seen} places seen\n{}", faults.join("\n"));
}

/// A post that goes over into a ball of its radius: the circle between them is a line where smooth ones are wanted.
#[test]
fn smooth_transitions_are_thin_or_left_out() {
    let model = solid("A+B", vec![post(0.7, -1.2, 1.2), ball(0.7, 0.0)]);
    let camera = Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 0.4), DVec3::Z, 0.6, SIZE);
    let mut renderer = renderer();
    let mut count = |edges: EdgeSettings| {
        let picture = draw_next(&mut renderer, (&model, with(edges)), &camera);
        picture.edge.iter().filter(|e| **e == SOLID).count()
    };
    let sharp = count(EdgeSettings { which: EdgeChoice::Sharp, ..lines() });
    let all = count(EdgeSettings { which: EdgeChoice::All, ..lines() });
    let full = count(EdgeSettings { tangent: TangentEdges::Full, ..lines() });
    let none = count(EdgeSettings { tangent: TangentEdges::None, ..lines() });
    assert_eq!(sharp, none);
    // the half of a circle some 40 px across that is seen
    assert!(all > sharp + 30 && full > all, "{sharp}, {all}, {full}");
    assert_silent(renderer);
}

/// The cut of a section is outlined twice as wide as edges are, whether what it cuts has equations or not.
#[test]
fn outlines_of_sections_are_bold_and_exact() {
    let tube = selvedge::construct::shapes::tube(1.0, 0.5, 1.6).unwrap().part;
    let low = tube.control_bounds().min.z;
    let spline = Model {
        parts: vec![tube],
        instances: vec![crate::shapes::placed(at(0.0, 0.0, 0.0), None)],
        ..Model::default()
    };
    let equations = solid("A-B", vec![post(1.0, low, 1.6), post(0.5, low - 1.0, 4.0)]);
    let mut renderer = renderer();
    for (name, model) in [("spline", spline), ("equations", equations)] {
        let cut = model.section(DVec3::Z, low + 1.0).unwrap();
        assert_eq!(cut.cuts.len(), 1);
        for camera in [perspective(&cut, SIZE), orthographic(&cut, SIZE)] {
            let settings = EdgeSettings { which: EdgeChoice::Sharp, ..lines() };
            let picture = draw_next(&mut renderer, (&cut, with(settings)), &camera);
            let circle = |radius: f64| {
                let point = move |k: u32| {
                    let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 2000.0).sin_cos();
                    DVec3::new(radius * cos, radius * sin, low + 1.0)
                };
                (0..2000).map(move |k| camera.project(point(k)).unwrap().0).collect::<Vec<DVec2>>()
            };
            let (outer, inner) = (circle(1.0), circle(0.5));
            let (mut bare, mut thin) = (Vec::new(), 0);
            for (k, edge) in picture.edge.iter().enumerate() {
                let pixel = DVec2::new((k % SIZE.0 as usize) as f64, (k / SIZE.0 as usize) as f64) + 0.5;
                let near = away(pixel, &outer).min(away(pixel, &inner));
                if near < 2.0 * HALF + 0.5 - 0.1 - OFF && *edge != SOLID {
                    bare.push(pixel);
                }
                thin += usize::from(near < 2.0 * HALF + 0.4 && near > MARKED + OFF);
            }
            assert!(bare.is_empty() && thin > 100, "{name}: {thin} pixels beyond an edge's width, bare {bare:?}");
        }
    }
    assert_silent(renderer);
}

/// Sections of a solid with equations, and of a part, whose edges and outlines are those of an operand without. No
/// line is missing or stray. The far side of the part's rim begins at the outline. The near side hides it, and centres
/// beside the outline see nothing. In the parallel view the cut of the solid with equations ends less than 1/256 px from
/// the centre of a pixel.
#[test]
fn the_programs_judge_of_sections() {
    let tube = selvedge::construct::shapes::tube(1.0, 0.5, 1.6).unwrap().part;
    let low = tube.control_bounds().min.z;
    let instances = vec![crate::shapes::placed(at(0.0, 0.0, 0.0), None)];
    let spline = Model { parts: vec![tube], instances, ..Model::default() };
    let equations = solid("A-B", vec![post(1.0, low, 1.6), post(0.5, low - 1.0, 4.0)]);
    let mut renderer = renderer();
    for (name, model) in [("spline", spline), ("equations", equations)] {
        let cut = model.section(DVec3::Z, low + 1.0).unwrap();
        for camera in [perspective(&cut, SIZE), orthographic(&cut, SIZE)] {
            let found = judged_by_program(&mut renderer, &cut, &camera);
            assert!(found.visible > 100, "{name}: {found:?}");
            assert_eq!((found.missing, found.stray), (0, 0), "{name}: {found:?}");
        }
    }
    assert_silent(renderer);
}

/// Without Boolean solids, or without lines, nothing of theirs exists.
#[test]
fn lines_of_solids_exist_only_where_they_are_drawn() {
    let names = |model: &Model, settings| {
        let renderer = watched_with(model, settings);
        let objects = renderer.objects();
        assert_silent(renderer);
        objects
            .iter()
            .filter(|n| n.contains("edge_change") || n.contains("edge_join") || n.contains("changes of"))
            .count()
    };
    let block = solid("A", vec![block([-1.0; 3], [1.0; 3])]);
    assert!(names(&block, with(lines())) >= 2);
    assert_eq!(names(&block, SceneSettings::default()), 0);
    assert_eq!(names(&crate::shapes::cube(), with(lines())), 0);
}

/// The same lines by every way to draw solids, and where the lists are those of one band of rows at a time.
#[test]
fn lines_are_the_same_by_every_way() {
    let model = solid(
        "A-B+C",
        vec![block([-1.0; 3], [1.0; 3]), post(0.6, -2.0, 4.0), moved(at(0.9, -0.9, 0.2), ring(0.8, 0.25))],
    );
    let camera = perspective(&model, SIZE);
    let settings = EdgeSettings { silhouettes: true, ..lines() };
    let mut renderer = renderer();
    let events = draw_next(&mut renderer, (&model, with(settings)), &camera);
    assert!(events.edge.iter().filter(|e| **e == SOLID).count() > 300);
    for solids in [SolidWay::Cst, SolidWay::Blister] {
        let other = draw_next(&mut renderer, (&model, SceneSettings { solids, ..with(settings) }), &camera);
        assert!(other.edge == events.edge && other.colour == events.colour, "{}", solids.name());
    }
    assert_silent(renderer);
    let banded = draw_in_bands(&model, with(settings), &camera);
    assert!(banded.edge == events.edge && banded.colour == events.colour, "bands");
}
