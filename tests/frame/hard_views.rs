//! Hard cases of Boolean solids in views whose pixels are all known beforehand, by all ways to draw: the size of gaps,
//! shells and layers follows from counting rows and columns.

use crate::shapes::solids::{self, at, ball, below, block, moved, post, ring, turned};
use crate::solids::{faults, right_at};
use crate::support::{assert_identical, assert_silent, perspective, render, watched};
use glam::{DVec2, DVec3};
use selvedge::csg::{Builder, Op};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Bounds, Camera, Model, Primitive, Projection, Solid, SurfaceTable};
use selvedge::picture::{Picture, Samples, SceneSettings, SolidWay};
use selvedge_check::Tracer;

/// A parallel view along y of height `height`, with `target` in the middle.
fn along_y(target: DVec3, height: f64, size: (u32, u32)) -> Camera {
    let projection = Projection::Orthographic { height };
    Camera { eye: target - DVec3::Y * 3.0, target, up: DVec3::Z, projection, depth_range: (1.0, 10.0), size }
}

/// With every way, each pixel (column, row) shows the expected face, twice.
fn shows(
    renderer: &mut HeadlessRenderer,
    name: &str,
    model: &Model,
    camera: &Camera,
    expected: impl Fn(u32, u32) -> u32,
) {
    for way in SolidWay::ALL {
        renderer.upload_with(model, SceneSettings { solids: *way, ..Default::default() }).unwrap();
        let picture = render(renderer, camera);
        for (i, face) in (0u32..).zip(&picture.face) {
            let (x, y) = (i % camera.size.0, i / camera.size.0);
            assert_eq!(*face, expected(x, y), "{name}, by {}: column {x}, row {y}", way.name());
        }
        assert_eq!(picture.stats.clamps, 0, "{name}, by {}", way.name());
        assert_identical(&picture, &render(renderer, camera), name);
    }
}

/// A gap eight pixels high between two cubes, a thousandth to a hundred-thousandth of the model: eight rows of nothing.
#[test]
fn gaps_stay_open() {
    let mut renderer = watched(&Model::default());
    for share in [1e-3, 1e-4, 1e-5] {
        let gap = share * DVec3::new(1.0, 1.0, 2.0).length();
        let all = vec![block([0.0; 3], [1.0; 3]), block([0.0, 0.0, 1.0 + gap], [1.0, 1.0, 2.0])];
        let camera = along_y(DVec3::new(0.5, 0.0, 1.0 + 0.5 * gap), 4.0 * gap, (12, 32));
        let row = |_, y| [2, 0, 1][usize::from(y >= 12) + usize::from(y >= 20)];
        shows(&mut renderer, &format!("a gap of {share}"), &solids::solid("A+B", all), &camera, row);
    }
    assert_silent(renderer);
}

/// Half a hollow ball, its rim from above: the shell is eight columns wide at any scale. A shell thinner than the
/// distance at which faces count as one is empty: a share of 4e-6 of the model for rounded coordinates, else that of
/// `Model::coincident`.
#[test]
fn shells_are_as_thick_as_they_are() {
    let mut renderer = watched(&Model::default());
    let cases = [(1e-2, None), (1e-3, None), (1e-4, None), (3e-5, None), (1e-5, None), (1e-6, None)];
    let finer = [1e-4, 1e-5, 1e-6].map(|thin| (thin, Some(SurfaceTable::FINEST)));
    for (thin, coincident) in cases.into_iter().chain(finer) {
        let lid = block([-2.0, -2.0, 0.0], [2.0; 3]);
        let all = vec![ball(1.0, 0.0), ball(1.0 - thin, 0.0), lid];
        let size = all.iter().map(Primitive::bounds).fold(Bounds::EMPTY, |a, b| a.union(b)).diagonal();
        let bowl = Model { coincident, ..solids::solid("A-B-C", all) };
        let eye = DVec3::new(1.0 - 0.5 * thin, 0.0, 3.0);
        let projection = Projection::Orthographic { height: 4.0 * thin };
        let target = eye.with_z(0.0);
        let camera = Camera { eye, target, up: DVec3::Y, projection, depth_range: (1.0, 10.0), size: (32, 32) };
        let is_one_face = thin < bowl.coincidence() * size;
        assert_eq!(is_one_face, coincident.is_none() && thin < 2e-5, "{thin} of {size}");
        // the inner wall, the rim, nothing
        let column = |x, _| if is_one_face { 0 } else { [2, 3, 0][usize::from(x >= 12) + usize::from(x >= 20)] };
        shows(&mut renderer, &format!("a shell of {thin}"), &bowl, &camera, column);
    }
    assert_silent(renderer);
}

/// Rays of the middle row lie in the face that two cubes share: they are within exactly one cube, so the union has no
/// slit. The order of the expression decides which: they are not within the cube that states the plane first.
#[test]
fn rays_in_a_face_are_on_one_side_of_it() {
    let mut renderer = watched(&Model::default());
    let cubes = || vec![block([0.0; 3], [1.0; 3]), block([0.0, 0.0, 1.0], [1.0, 1.0, 2.0])];
    let camera = along_y(DVec3::new(0.5, 0.0, 1.0), 4.0, (33, 33));
    // a pixel is 4/33 of a unit: eight on either side of the middle
    let within = |x: u32, y: u32, low: u32, high: u32| x.abs_diff(16) <= 4 && (low..=high).contains(&y);
    let whose = |x, y| u32::from(within(x, y, 17, 24)) + 2 * u32::from(within(x, y, 8, 16));
    shows(&mut renderer, "both", &solids::solid("A+B", cubes()), &camera, whose);
    shows(&mut renderer, "the lower", &solids::solid("A-B", cubes()), &camera, |x, y| whose(x, y) & 1);
    shows(&mut renderer, "the upper", &solids::solid("B-A", cubes()), &camera, |x, y| {
        if y == 16 { 0 } else { whose(x, y) & 2 }
    });
    shows(&mut renderer, "what is shared", &solids::solid("AB", cubes()), &camera, |_, _| 0);
    assert_silent(renderer);
}

/// The place of the cut in the expression for a row of balls.
#[derive(Clone, Copy, Debug)]
enum Cut {
    /// Before the balls.
    First,
    /// After the balls.
    Last,
    /// After the balls, as the union of a bounding part and an empty ball: a point outside the one may be inside the
    /// other, so no gate is shut.
    OfTwo,
}

/// A row of balls, all but the last of them cut away.
fn row_of_balls(count: u32, cut: Cut) -> Model {
    let mut all: Vec<Primitive> = (0..count).map(|k| ball(0.4, f64::from(k))).collect();
    all.push(below(DVec3::NEG_X, 1.5 - f64::from(count)));
    all.push(ball(0.4, f64::from(count) + 5.0));
    (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
    let mut b = Builder::new();
    let balls: Vec<u32> = (0..count).map(|p| b.leaf(p)).collect();
    let union = b.fold(Op::Union, balls);
    let [far, nowhere] = [b.leaf(count), b.leaf(count + 1)];
    let two = b.pair(Op::Union, far, nowhere);
    let [x, y] = match cut {
        Cut::First => [far, union],
        Cut::Last => [union, far],
        Cut::OfTwo => [union, two],
    };
    let root = b.pair(Op::Intersection, x, y);
    Model { solids: vec![Solid::new(all, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

/// At least 255 faces lie before the visible one. If no gate excludes them, each is an event of its ray, and a driver
/// may end such a ray's loop: it resumes in another segment. Tiles show hundreds of leaves.
#[test]
fn what_lies_behind_255_faces_is_seen() {
    let mut renderer = watched(&Model::default());
    let view = |count: u32| Camera {
        eye: DVec3::X * -2.0,
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 0.02 },
        depth_range: (1.0, 8.0 + f64::from(count)),
        size: (24, 16),
    };
    shows(&mut renderer, "the last of 128 balls", &row_of_balls(128, Cut::First), &view(128), |_, _| 128);
    let all_are = |picture: &Picture, count: u32, what: &str| {
        assert_eq!(picture.stats.clamps, 0, "{what}");
        assert!(picture.face.iter().all(|face| *face == count), "{what}: {:?}", picture.face);
    };
    for (count, cut) in [(128, Cut::Last), (500, Cut::Last), (200, Cut::OfTwo)] {
        renderer.upload(&row_of_balls(count, cut)).unwrap();
        let picture = render(&mut renderer, &view(count));
        let what = format!("{count} balls, cut {cut:?}");
        all_are(&picture, count, &what);
        assert_identical(&picture, &render(&mut renderer, &view(count)), &what);
        let in_segments = picture.stats.solid_bytes.iter().any(|list| list.name == "resume points");
        // such a driver ends loops; with a shut gate no loop is long
        if picture.stats.device.contains("llvmpipe") {
            assert_eq!(in_segments, matches!(cut, Cut::OfTwo), "{what}");
        }
    }
    // band by band, sample by sample, and from within the first ball
    let (model, whole) = (row_of_balls(200, Cut::OfTwo), Camera { size: (16, 40), ..view(200) });
    // bands need several rows of tiles; the others are of one tile, because each of their rays has hundreds of events
    let few = Camera { size: (8, 16), ..whole };
    let inside = Camera { eye: DVec3::X * -0.3, depth_range: (0.1, 250.0), ..few };
    let bands = SceneSettings { solid_budget: Some(8000), ..Default::default() };
    let samples = SceneSettings { samples: Samples::Four, ..Default::default() };
    for (what, settings, camera, least_bands) in
        [("bands", bands, whole, 2), ("samples", samples, few, 1), ("from within", SceneSettings::default(), inside, 1)]
    {
        renderer.upload_with(&model, settings).unwrap();
        let picture = render(&mut renderer, &camera);
        all_are(&picture, 200, what);
        assert!(picture.stats.bands >= least_bands, "{what}: {}", picture.stats.bands);
    }
    // a view of another side needs one segment
    renderer.upload(&model).unwrap();
    render(&mut renderer, &whole);
    let aside =
        Camera { eye: DVec3::new(199.0, -3.0, 0.0), target: DVec3::X * 199.0, depth_range: (1.0, 9.0), ..whole };
    let picture = [(); 2].map(|()| render(&mut renderer, &aside)).into_iter().next_back().unwrap();
    all_are(&picture, 200, "from aside");
    assert!(
        picture.stats.solid_bytes.iter().all(|list| list.name != "resume points"),
        "{:?}",
        picture.stats.solid_bytes
    );
    assert_silent(renderer);
}

/// Balanced trees of sums of products of sums, which need the most labels.
#[test]
fn trees_that_need_many_labels() {
    let tree = |n: u32| {
        let mut b = Builder::new();
        let mut k = 0f64;
        // multiples of the golden ratio: evenly spread and all different
        let mut place = || {
            k += 1.0;
            (k * 0.618_033_988_749_895).fract() * 0.5 - 0.25
        };
        let mut all: Vec<Primitive> = (0..n).map(|_| moved(at(place(), place(), place()), ball(0.6, 0.0))).collect();
        (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
        let mut row: Vec<u32> = (0..n).map(|p| b.leaf(p)).collect();
        let mut op = Op::Union;
        while row.len() > 1 {
            row = row.chunks(2).map(|c| if c.len() == 2 { b.pair(op, c[0], c[1]) } else { c[0] }).collect();
            op = if op == Op::Union { Op::Intersection } else { Op::Union };
        }
        let tree = b.finish(row[0]).unwrap();
        Model { solids: vec![Solid::new(all, tree).unwrap()], ..Model::default() }
    };
    right_at((48, 32), vec![("15 leaves", tree(15)), ("46 leaves", tree(46))], false);
    // 255 leaves in hundreds of layers, each of which tests all of them: not by layers
    let model = tree(255);
    let (tracer, camera) = (Tracer::new(&model), perspective(&model, (48, 32)));
    let mut renderer = watched(&model);
    for solids in [SolidWay::Events, SolidWay::Cst] {
        renderer.upload_with(&model, SceneSettings { solids, ..Default::default() }).unwrap();
        assert_eq!(faults(&mut renderer, &tracer, &camera, false), None, "255 leaves, by {}", solids.name());
    }
    assert_silent(renderer);
}

/// The solid and the eye move together: the picture stays, except for pixels at edges.
#[test]
fn rigid_motions_move_the_picture() {
    let still = solids::solid(
        "A-B+CD",
        vec![
            block([-1.0; 3], [1.0, 1.0, 0.5]),
            post(0.6, -2.0, 4.0),
            ball(1.2, 0.5),
            moved(at(0.5, 0.0, 0.5), ring(0.8, 0.3)),
        ],
    );
    let motion = at(3.0, -7.0, 11.0) * turned(0.4, 1.0, -2.0);
    let moving = |p: &Primitive| moved(motion, p.clone());
    let solid = &still.solids[0];
    let solid = Solid::new(solid.primitives().iter().map(moving).collect(), solid.tree().clone()).unwrap();
    let gone = Model { solids: vec![solid], ..Model::default() };
    let here = perspective(&still, (240, 160));
    let there = Camera {
        eye: motion.transform_point3(here.eye),
        target: motion.transform_point3(here.target),
        up: motion.transform_vector3(here.up),
        ..here
    };
    let mut renderer = watched(&still);
    let first = render(&mut renderer, &here);
    renderer.upload(&gone).unwrap();
    let second = render(&mut renderer, &there);
    assert_eq!(faults(&mut renderer, &Tracer::new(&gone), &there, false), None);
    let differ = first.face.iter().zip(&second.face).filter(|(a, b)| a != b).count();
    assert!(differ <= 1, "{differ} pixels");
    // across the face: sixteen roundings of a depth near 8
    let across = |i: usize| {
        let (_, d) = here.ray(DVec2::new((i % 240) as f64 + 0.5, (i / 240) as f64 + 0.5));
        let cosine = DVec3::from(first.normal[i].map(f64::from)).dot(d.normalize()).abs();
        f64::from((first.depth[i] - second.depth[i]).abs()) * cosine
    };
    let both = (0..first.face.len()).filter(|i| first.face[*i] == second.face[*i] && first.face[*i] != 0);
    let off = both.map(across).fold(0.0, f64::max);
    assert!(off < 8e-6, "{off}");
    assert_silent(renderer);
}
