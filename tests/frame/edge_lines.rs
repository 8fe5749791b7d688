//! Lines along edges: where exact rays see an edge there is a line, and nowhere else; and no other image changes.

use crate::shapes;
use crate::support::{assert_silent, orthographic, perspective, watched_with};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge::construct::{Chain, extrude, extruded_solid};
use selvedge::edges::flatten::{Flattening, LinePoint};
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, EdgeKind, Face, Instance, Model, Projection, SurfaceKind};
use selvedge::picture::{
    BadEdges, EdgeChoice, EdgeSettings, FrameSettings, Outputs, Picture, Samples, SceneSettings, TangentEdges, TrimWay,
};
use selvedge::renderer::RenderError;
use selvedge::spline::{BSpline, Surface};
use selvedge_check::drawing::{DrawingSettings, LineImage, judge_lines};
use selvedge_check::{EdgeTracer, Tracer, Visibility};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

pub const SIZE: (u32, u32) = (160, 120);
const ALL: Outputs = Outputs { edge: true, part: true, instance: true, ..Outputs::ALL };
/// Number of an outline in the image of edges.
const OUTLINE: u32 = u32::MAX;

/// Lines as wide as at a height of 1080.
pub fn lines() -> EdgeSettings {
    let usual = EdgeSettings::default();
    let width = usual.width * EdgeSettings::HEIGHT / f64::from(SIZE.1);
    EdgeSettings { width, thin_width: width, tangent: TangentEdges::Full, ..usual }
}

/// A line's width, pixels.
pub const WIDTH: f64 = 1.25;
/// Half of it.
const HALF: f64 = 0.5 * WIDTH;

pub fn with(edges: EdgeSettings) -> SceneSettings {
    SceneSettings { edges: Some(edges), ..SceneSettings::default() }
}

pub fn draw(model: &Model, settings: SceneSettings, camera: &Camera) -> Picture {
    let mut renderer = crate::watched::renderer();
    let picture = draw_next(&mut renderer, (model, settings), camera);
    assert_silent(renderer);
    picture
}

/// The picture of a scene that replaces the renderer's, and shares its pipelines: the driver takes longer to make those
/// of lines than to draw.
pub fn draw_next(
    renderer: &mut HeadlessRenderer,
    (model, settings): (&Model, SceneSettings),
    camera: &Camera,
) -> Picture {
    renderer.expect(ALL);
    renderer.upload_with(model, settings).unwrap();
    renderer.render(camera, &FrameSettings::default(), ALL).unwrap()
}

pub fn centres(picture: &Picture) -> impl Iterator<Item = (DVec2, u32)> + '_ {
    let width = picture.size.0 as usize;
    let centre = move |at: usize| DVec2::new((at % width) as f64 + 0.5, (at / width) as f64 + 0.5);
    picture.edge.iter().enumerate().filter(|(_, edge)| **edge != 0).map(move |(at, edge)| (centre(at), *edge))
}

/// Visible points without a line within half its width and half a pixel; line pixels farther than that and a fifth from
/// any point that may be seen. Of the fifth, a tenth of a pixel is for what chords may be off, and a tenth for the
/// points' own distance.
fn faults(model: &Model, camera: &Camera, picture: &Picture) -> (usize, usize, usize) {
    let tracer = Tracer::new(model);
    let edges = EdgeTracer::new(model, &tracer).unwrap();
    let all = edges.points(camera, 0.2);
    let drawn = |p: &&selvedge_check::EdgePoint| {
        edges.parts()[model.instances[p.instance].part].edges[p.edge].kind != EdgeKind::Seam
    };
    let points: Vec<_> = all.iter().filter(drawn).collect();
    let marked: Vec<DVec2> = centres(picture).map(|(at, _)| at).collect();
    let (w, h) = (f64::from(camera.size.0), f64::from(camera.size.1));
    let inside = |p: DVec2| p.x > 1.0 && p.y > 1.0 && p.x < w - 1.0 && p.y < h - 1.0;
    let seen = points.iter().filter(|p| p.visibility == Visibility::Visible && inside(p.pixel));
    let bare = seen.clone().filter(|p| !marked.iter().any(|at| at.distance(p.pixel) <= HALF + 0.5)).count();
    let open: Vec<DVec2> = points.iter().filter(|p| p.visibility != Visibility::Hidden).map(|p| p.pixel).collect();
    let near = |at: DVec2, px: f64| open.iter().any(|p| p.distance(at) <= px);
    let stray = marked.iter().filter(|at| !near(**at, HALF + 0.5 + 0.2)).count();
    (seen.count(), bare, stray)
}

/// Points of an outline, a pixel or more within the picture, without a line pixel within half its width and half a
/// pixel; and line pixels that are farther than that from the outline.
pub fn faults_of_outline(picture: &Picture, outline: &[DVec2]) -> (usize, usize) {
    let marked: Vec<DVec2> = centres(picture).map(|(at, _)| at).collect();
    let last = DVec2::new(f64::from(picture.size.0), f64::from(picture.size.1)) - 1.0;
    let inside = |p: &&DVec2| p.cmpge(DVec2::ONE).all() && p.cmple(last).all();
    let near = |all: &[DVec2], at: DVec2| all.iter().any(|p| p.distance(at) <= HALF + 0.5);
    let bare = outline.iter().filter(inside).filter(|p| !near(&marked, **p)).count();
    (bare, marked.iter().filter(|at| !near(outline, **at)).count())
}

/// Shapes with edges of every kind, some of them placed twice, from afar and in a parallel view.
#[test]
fn lines_are_where_exact_rays_see_edges() {
    // the judge has no points of meshes' edges
    let of_faces = |model: &Model| !model.instances.is_empty() && model.parts.iter().all(|p| p.meshes.is_empty());
    let mut renderer = crate::watched::renderer();
    for shape in shapes::all().into_iter().filter(|shape| of_faces(&shape.model)) {
        for camera in [perspective(&shape.model, SIZE), orthographic(&shape.model, SIZE)] {
            let picture = draw_next(&mut renderer, (&shape.model, with(lines())), &camera);
            let (seen, bare, stray) = faults(&shape.model, &camera, &picture);
            println!("{}: {seen} visible points, {bare} bare, {stray} stray", shape.name);
            assert_eq!((bare, stray), (0, 0), "{}", shape.name);
        }
    }
    assert_silent(renderer);
}

/// A box a thousandth below a larger one, from 3 degrees above: its edges lie behind a face that falls away steeply from
/// the eye, by far less than that face's depth changes from pixel to pixel.
#[test]
fn an_edge_close_behind_a_grazing_face_is_hidden() {
    let cube = shapes::cube();
    let mut model = cube.clone();
    model.parts.push(cube.parts[0].clone());
    let slab = DAffine3::from_scale(DVec3::new(3.0, 3.0, 0.05));
    let corners = cube.parts[0].edges().unwrap().vertices;
    let half = corners.iter().fold(0.0f64, |most, corner| most.max(corner.z));
    let below = DVec3::new(0.0, 0.0, -half * 0.05 - half * 0.02 - 0.001);
    let thin = DAffine3::from_translation(below) * DAffine3::from_scale(DVec3::new(1.5, 1.5, 0.02));
    model.instances = vec![shapes::placed(slab, None), shapes::placed(thin, None)];
    model.instances[1].part = 1;
    let steep = 3f64.to_radians();
    let from = DVec3::new(0.6, -0.8, 0.0) * steep.cos() + DVec3::Z * steep.sin();
    let camera = Camera::around(model.control_bounds(), from, DVec3::Z, 0.4, SIZE);
    let picture = draw(&model, with(lines()), &camera);
    let count = model.parts[0].edges().unwrap().edges.len() as u32;
    let (slabs, boxes): (Vec<_>, Vec<_>) = centres(&picture).partition(|(_, edge)| *edge <= count);
    assert!(slabs.len() > 100, "{}", slabs.len());
    let (_, bare, stray) = faults(&model, &camera, &picture);
    assert_eq!((bare, stray), (0, 0), "{} line pixels of the box behind", boxes.len());
}

/// The outline of a ball is a circle in space, and the lines lie on it: at the exact fold, all around. `model` has the
/// ball of [`shapes::sphere`] at the origin, and nothing else that folds.
fn assert_the_balls_outline(renderer: &mut HeadlessRenderer, model: &Model, camera: &Camera) {
    let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
    let picture = draw_next(renderer, (model, with(settings)), camera);
    let ball = shapes::sphere().control_bounds();
    let radius = 0.5 * (ball.max.z - ball.min.z);
    let away = camera.eye.length();
    let (axis, middle) = (camera.eye / away, camera.eye * (radius * radius / (away * away)));
    let round = radius * (1.0 - radius * radius / (away * away)).sqrt();
    let right = axis.any_orthonormal_vector();
    let up = axis.cross(right);
    let outline: Vec<DVec2> = (0..4000)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * TAU / 4000.0).sin_cos();
            camera.project(middle + (right * cos + up * sin) * round).unwrap().0
        })
        .collect();
    assert!(centres(&picture).all(|(_, edge)| edge == OUTLINE));
    assert_eq!(faults_of_outline(&picture, &outline), (0, 0), "of {} pixels", centres(&picture).count());
}

#[test]
fn a_balls_outline_is_where_it_folds() {
    let model = shapes::sphere();
    let camera = perspective(&model, SIZE);
    // from the side, where both poles are on the outline
    let from = DVec3::new(0.8, -0.6, 0.0);
    let aside = Camera { eye: from * camera.eye.length(), target: DVec3::ZERO, ..camera };
    let mut renderer = crate::watched::renderer();
    [camera, aside].iter().for_each(|camera| assert_the_balls_outline(&mut renderer, &model, camera));
    assert_silent(renderer);
}

/// A ring that is trimmed along its seams, in a view that shows neither them nor a patch that they cross: the trim
/// table has no rows there.
#[test]
fn an_outline_away_from_all_trim_curves_is_a_line() {
    let mut model = shapes::torus();
    model.parts[0].faces[0].loops = vec![shapes::rectangle(DVec2::ZERO, DVec2::splat(TAU))];
    let round = shapes::TORUS_RADII.0 - shapes::TORUS_RADII.1;
    let at = |angle: f64| DVec2::from_angle(angle).extend(0.0) * round;
    // three eighths of a turn from the seam across the ring, and half a turn from the one along it
    let target = at(0.375 * TAU);
    let camera = Camera {
        eye: target + DVec3::Z * 10.0,
        target,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 1.5 },
        depth_range: (1.0, 20.0),
        size: SIZE,
    };
    let outline: Vec<DVec2> = (0..8000).map(|k| camera.project(at(f64::from(k) * TAU / 8000.0)).unwrap().0).collect();
    let mut renderer = crate::watched::renderer();
    for trim in [TrimWay::Table, TrimWay::Exact] {
        let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
        let picture = draw_next(&mut renderer, (&model, SceneSettings { trim, ..with(settings) }), &camera);
        assert_eq!(faults_of_outline(&picture, &outline), (0, 0), "{trim:?}");
        assert!(centres(&picture).count() > 100, "{trim:?}");
    }
    assert_silent(renderer);
}

/// A cylinder of which half a pixel beyond its seam is seen, between the centres of pixels: the seam is a trim curve,
/// and the outline runs beyond it.
#[test]
fn an_outline_close_beyond_a_seam_is_a_line() {
    let model = shapes::cylinder();
    let (radius, height) = shapes::CYLINDER;
    // the axis is in the middle of the picture: the outlines at 80 ± 31.2 px, the seam at 110.7 px
    let (round_px, beyond_px) = (31.2_f64, 0.5);
    let beyond = (1.0 - beyond_px / round_px).acos();
    let from = DVec2::from_angle(beyond - FRAC_PI_2).extend(0.0);
    let projection = Projection::Orthographic { height: f64::from(SIZE.1) * radius / round_px };
    let camera = Camera { projection, ..Camera::around(model.control_bounds(), from, DVec3::Z, 0.6, SIZE) };
    let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
    let picture = draw(&model, with(settings), &camera);
    let sides = [beyond, beyond - PI].map(|angle| (DVec2::from_angle(angle) * radius).extend(0.0));
    let along = |k: u32| DVec3::Z * (height * f64::from(k) / 400.0);
    let outline = sides.into_iter().flat_map(|side| (0..=400).map(move |k| side + along(k)));
    let outline: Vec<DVec2> = outline.map(|p| camera.project(p).unwrap().0).collect();
    assert!((outline[0].x - 111.2).abs() < 1e-6, "{}", outline[0]);
    assert_eq!(faults_of_outline(&picture, &outline), (0, 0));
}

/// Behind the ball each pixel sees another patch of a floor, so there are many places beside a pixel of the outline.
#[test]
fn an_outline_before_many_patches_is_whole() {
    const SPANS: usize = 96;
    let mut model = shapes::sphere();
    let ball = model.control_bounds();
    let knots: Vec<f64> = [0].into_iter().chain(0..=SPANS).chain([SPANS]).map(|k| k as f64).collect();
    let reach = 12.0 * ball.max.z;
    let at = |k: usize| (2.0 * k as f64 / SPANS as f64 - 1.0) * reach;
    let points = (0..=SPANS).flat_map(|j| (0..=SPANS).map(move |i| (i, j)));
    let points = points.map(|(i, j)| DVec4::new(at(i), at(j), 1.3 * ball.min.z, 1.0)).collect();
    let floor = Surface::new((1, 1), knots.clone(), knots, points).unwrap();
    let face = Face { id: 77, kind: SurfaceKind::Plane, surface: floor, ..model.parts[0].faces[0].clone() };
    let floor = shapes::one("floor", false, vec![face]);
    model.parts.extend(floor.parts);
    model.instances.push(Instance { part: 1, ..floor.instances[0].clone() });
    let from = DVec3::new(0.8, -0.6, 0.08);
    let mut camera = Camera { eye: from * 6.0 * ball.max.z, target: DVec3::ZERO, ..perspective(&model, SIZE) };
    camera.fit_depth(model.control_bounds());
    let mut renderer = crate::watched::renderer();
    assert_the_balls_outline(&mut renderer, &model, &camera);
    assert_silent(renderer);
}

/// A block of which one edge is rounded.
pub fn rounded_block(radius: f64) -> Model {
    let point = |x: f64, y: f64, w: f64| DVec3::new(x * w, y * w, w);
    let line = |a, b| BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![a, b]).unwrap();
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0 - radius), (2.0 - radius, 2.0), (0.0, 2.0)];
    let [a, b, c, d, e] = corners.map(|(x, y)| point(x, y, 1.0));
    let arc = vec![c, point(2.0, 2.0, 0.5_f64.sqrt()), d];
    let arc = BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], arc).unwrap();
    let profile: Chain = vec![line(a, b), line(b, c), arc, line(d, e), line(e, a)];
    let part = extruded_solid(&[profile], DVec3::Z * 3.0).unwrap();
    Model { parts: vec![part], instances: vec![shapes::placed(DAffine3::IDENTITY, None)], ..Model::default() }
}

/// A fillet that folds a third of a pixel beyond the edge where it begins, so that most centres beside the fold see the
/// face before it, or nothing.
#[test]
fn a_fold_that_few_centres_see_is_a_line() {
    let model = rounded_block(0.12);
    let fillet = model.parts[0].faces[2].id;
    let steep = 25f64.to_radians();
    let from = DVec3::new(-steep.cos(), steep.sin(), 0.3);
    let far = Camera::around(model.control_bounds(), from, DVec3::Y, 0.6, SIZE);
    let height = model.control_bounds().diagonal();
    let (mut renderer, tracer) = (crate::watched::renderer(), Tracer::new(&model));
    for camera in [far, Camera { projection: Projection::Orthographic { height }, ..far }] {
        let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
        let picture = draw_next(&mut renderer, (&model, with(settings)), &camera);
        let asked = DrawingSettings { sharp: false, smooth: false, ..DrawingSettings::default() };
        let image = LineImage { lines: &picture.edge, width: WIDTH, section_width: WIDTH };
        let found = judge_lines(&model, &tracer, &camera, &asked, image).unwrap();
        let seen = picture.face.iter().filter(|face| **face == fillet).count() as f64;
        // points are half a pixel apart
        let length = found.visible as f64 * selvedge_check::drawing::SPACING;
        println!("{length} px, {seen} centres: {found:?}");
        assert!(length > 30.0 && seen > 0.0 && seen < 0.6 * length, "{length} px, {seen} centres");
        assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
    }
    assert_silent(renderer);
}

/// The fillet of [`rounded_block`] as a part of a cylinder that goes on by thirty degrees at both sides.
pub fn of_wider_cylinder(fillet: &mut Face, radius: f64) {
    let half = 75f64.to_radians();
    let at = |angle: f64, away: f64, w: f64| {
        let place = DVec2::splat(2.0 - radius) + DVec2::from_angle(angle) * away;
        DVec4::new(place.x * w, place.y * w, 0.0, w)
    };
    let middle = FRAC_PI_4;
    let (from, to) = (at(middle - half, radius, 1.0), at(middle + half, radius, 1.0));
    let points = vec![from, at(middle, radius / half.cos(), half.cos()), to];
    let arc = BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points).unwrap();
    fillet.surface = extrude(&arc, DVec3::Z * 3.0).unwrap();
    // where the cylinder touches the block's side x = 2; the arc is the same from its other end
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..60 {
        let u = 0.5 * (low + high);
        if fillet.surface.point(u, 0.0).y < 2.0 - radius { low = u } else { high = u }
    }
    fillet.loops = vec![shapes::rectangle(DVec2::new(low, 0.0), DVec2::new(1.0 - low, 1.0))];
}

/// A fillet, and the same one as a part of a wider cylinder, end before they would fold: they have no outline.
#[test]
fn a_face_that_ends_before_it_folds_has_no_outline() {
    let radius = 0.6;
    let whole = rounded_block(radius);
    let mut trimmed = whole.clone();
    of_wider_cylinder(&mut trimmed.parts[0].faces[2], radius);
    let mut renderer = crate::watched::renderer();
    for (model, trim) in [(&whole, TrimWay::Table), (&trimmed, TrimWay::Table), (&trimmed, TrimWay::Exact)] {
        let id = model.parts[0].faces[2].id;
        // seen from above the top, which the fillet would fold away from by 0.1, 0.3 and 0.5 px
        for steep in [8.0, 12.0, 16.0f64] {
            let from = DVec3::new(steep.to_radians().cos(), steep.to_radians().sin(), 0.2);
            let camera = Camera::around(model.control_bounds(), from, DVec3::Y, 0.6, SIZE);
            let projection = Projection::Orthographic { height: model.control_bounds().diagonal() };
            let settings = EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() };
            let settings = SceneSettings { trim, ..with(settings) };
            let picture = draw_next(&mut renderer, (model, settings), &Camera { projection, ..camera });
            assert!(picture.face.iter().filter(|face| **face == id).count() > 200);
            assert_eq!(centres(&picture).count(), 0, "{steep} degrees, {trim:?}");
        }
    }
    assert_silent(renderer);
}

/// A million times closer, at the hole of a plate: the picture shows a hundred-thousandth of the edge.
#[test]
fn lines_hold_at_any_zoom() {
    let model = shapes::plate();
    let edges = model.parts[0].edges().unwrap();
    let curved = edges.edges.iter().find(|e| e.curve[0].piece.degree() > 1).unwrap();
    let target = curved.curve[0].piece.point(0.3);
    let whole = perspective(&model, SIZE);
    let mut renderer = crate::watched::renderer();
    for times in [1e2, 1e4, 1e6] {
        let eye = target + (whole.eye - whole.target) / times;
        let distance = (eye - target).length();
        let camera = Camera { eye, target, depth_range: (0.1 * distance, whole.depth_range.1), ..whole };
        let picture = draw_next(&mut renderer, (&model, with(lines())), &camera);
        let (seen, bare, stray) = faults(&model, &camera, &picture);
        println!("{times:e}: {seen} visible points, {bare} bare, {stray} stray");
        assert!(centres(&picture).count() > 100, "{times:e}");
        assert_eq!(bare, 0, "{times:e}");
        // points of the judge lie some pixels apart here: lines are judged by the curve, divided in double precision
        let flat = Flattening::new(&camera, 0.02, 3.0);
        let lines: Vec<Vec<DVec2>> = edges
            .edges
            .iter()
            .flat_map(|edge| flat.edge(edge).lines)
            .map(|line| line.iter().map(LinePoint::pixel).collect())
            .collect();
        for (at, _) in centres(&picture) {
            let sides = lines.iter().flat_map(|line| line.windows(2));
            let near = sides.map(|side| from_side(at, side[0], side[1])).fold(f64::INFINITY, f64::min);
            assert!(near <= HALF + 0.6, "{times:e}: {at} is {near} px from any edge");
        }
    }
    assert_silent(renderer);
}

/// From a point to the stretch between two others.
fn from_side(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * if share.is_nan() { 0.0 } else { share })
}

/// A tetrahedron of facets is convex: an edge is seen where one of its triangles looks at the eye.
#[test]
fn edges_of_facets_are_lines() {
    let model = shapes::tetra();
    let camera = perspective(&model, SIZE);
    let picture = draw(&model, with(lines()), &camera);
    let (mesh, edges) = (&model.parts[0].meshes[0], model.parts[0].edges().unwrap());
    let looks = |&(_, triangle): &(usize, usize)| {
        let [a, b, c] = mesh.triangles()[triangle].map(|corner| mesh.positions()[corner as usize]);
        (b - a).cross(c - a).dot(camera.eye - a) > 0.0
    };
    let (seen, hidden): (Vec<_>, Vec<_>) = edges.of_meshes.iter().partition(|edge| edge.triangles.iter().any(looks));
    assert_eq!(edges.of_meshes.len(), 6);
    assert!(!hidden.is_empty(), "every edge is seen");
    let sides: Vec<_> = seen.iter().map(|edge| edge.ends.map(|p| camera.project(p).unwrap().0)).collect();
    let marked: Vec<DVec2> = centres(&picture).map(|(at, _)| at).collect();
    let stray = |at: &&DVec2| !sides.iter().any(|[a, b]| from_side(**at, *a, *b) <= HALF + 0.6);
    assert_eq!(marked.iter().filter(stray).count(), 0, "of {}", marked.len());
    let places = sides.iter().flat_map(|[a, b]| (0..=100).map(|k| a.lerp(*b, f64::from(k) / 100.0)));
    let bare = |p: &DVec2| !marked.iter().any(|at| at.distance(*p) <= HALF + 0.5);
    assert_eq!(places.filter(bare).count(), 0, "of {}", marked.len());
}

/// Part and instance of each pixel, beside the face.
#[test]
fn pixels_know_their_part_and_instance() {
    let model = shapes::pair();
    let camera = perspective(&model, SIZE);
    let picture = draw(&model, SceneSettings::default(), &camera);
    assert!(picture.edge.iter().all(|edge| *edge == 0));
    let tracer = Tracer::new(&model);
    let mut probe = tracer.probe(&camera);
    let (mut seen, mut other) = ([0; 2], 0);
    for (at, (&part, &instance)) in picture.part.iter().zip(&picture.instance).enumerate() {
        let pixel = DVec2::new((at % SIZE.0 as usize) as f64 + 0.5, (at / SIZE.0 as usize) as f64 + 0.5);
        assert_eq!(part != 0, picture.face[at] != 0);
        assert_eq!(part != 0, instance != 0);
        let hits = probe.hits(pixel);
        let first = hits.iter().min_by(|a, b| a.depth.total_cmp(&b.depth));
        if let Some(hit) = first.filter(|_| instance != 0) {
            other += usize::from(hit.instance + 1 != instance as usize);
            seen[instance as usize - 1] += 1;
        }
    }
    // at borders a centre may see either
    assert!(seen.iter().all(|n| *n > 200) && other * 100 < seen[0], "{seen:?}, {other} others");
}

/// Without lines nothing of theirs exists, and with them only the colour changes, where lines are.
#[test]
fn only_the_colour_changes_and_only_where_lines_are() {
    let model = shapes::cube();
    let camera = perspective(&model, SIZE);
    let names = |settings| {
        let mut renderer: HeadlessRenderer = watched_with(&model, settings);
        let picture = renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap();
        let objects = renderer.objects();
        assert_silent(renderer);
        (picture, objects)
    };
    let of_lines = |names: &[String]| {
        names.iter().filter(|n| n.starts_with("edge") || n.contains("best lines") || n.contains("sources")).count()
    };
    let (plain, without) = names(SceneSettings::default());
    let (drawn, with_lines) = names(with(lines()));
    assert_eq!(of_lines(&without), 0, "{without:?}");
    assert!(of_lines(&with_lines) > 8, "{with_lines:?}");
    let none = EdgeSettings { which: EdgeChoice::None, ..lines() };
    assert_eq!(of_lines(&names(with(none)).1), 0);
    let bits = |picture: &Picture| {
        let depth: Vec<u32> = picture.depth.iter().map(|x| x.to_bits()).collect();
        let normal: Vec<[u32; 3]> = picture.normal.iter().map(|n| n.map(f32::to_bits)).collect();
        (depth, picture.face.clone(), normal)
    };
    assert!(bits(&plain) == bits(&drawn), "images beside the colour");
    let numbered = draw(&model, with(lines()), &camera);
    let changed = plain.colour.iter().zip(&drawn.colour).map(|(a, b)| a != b);
    let (mut inside, mut faint) = (0, 0);
    for (changed, edge) in changed.zip(&numbered.edge) {
        inside += usize::from(changed && *edge != 0);
        faint += usize::from(changed && *edge == 0); // covered by less than a tenth
    }
    assert!(inside > 200 && faint < inside / 4, "{inside}, {faint}");
}

/// Lines of the pixels' centres go over pictures of several samples.
#[test]
fn lines_are_the_same_with_several_samples() {
    let model = shapes::cube();
    let camera = perspective(&model, SIZE);
    let mut renderer = crate::watched::renderer();
    let [one, four] = [Samples::One, Samples::Four]
        .map(|samples| draw_next(&mut renderer, (&model, SceneSettings { samples, ..with(lines()) }), &camera));
    assert!(one.edge == four.edge);
    assert_silent(renderer);
}

#[test]
fn bad_settings_are_refused() {
    let model = shapes::cube();
    let mut renderer = crate::watched::renderer();
    let mut refused = |edges: EdgeSettings| match renderer.upload_with(&model, with(edges)) {
        Err(HeadlessError::Render(RenderError::Edges(bad))) => bad,
        other => panic!("{other:?}"),
    };
    for width in [-0.5, f64::NAN, f64::INFINITY, 65.0] {
        let bad = refused(EdgeSettings { width, ..lines() });
        assert!(matches!(bad, BadEdges::Width(_)), "{bad}");
        assert!(bad.to_string().starts_with("the width of edge lines must be from 0 to 64 pixels, not "), "{bad}");
    }
    let colour = [0.0, f32::NAN, 0.0, 1.0];
    assert!(matches!(refused(EdgeSettings { colour, ..lines() }), BadEdges::Colour(_)));
    assert!("sharpest".parse::<EdgeChoice>().unwrap_err().to_string().contains("all, sharp, none"));
    assert!("thick".parse::<TangentEdges>().unwrap_err().to_string().contains("none, thin, full"));
}
