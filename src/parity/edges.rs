//! Parity of the passes `edge_count` and `edge_emit`: exact; and both against the same division in double precision.

use super::harness::{Gpu, Mismatch, counts, same};
use crate::abi::{self, Chord, Counters};
use crate::edges::flatten::Flattening;
use crate::frame::edges::divide::{Bindings, Divide, Params};
use crate::gpu::Texel;
use crate::model::{Camera, Edges, Instance, Mesh, Model, Part, Projection};
use crate::picture::{EdgeSettings, TangentEdges};
use crate::scene::{SceneData, seen_by, view};
use crate::twin::edges::{Given, divide};
use glam::{DAffine3, DVec2, DVec3};
use std::path::Path;

const MARGIN_PX: f32 = 3.0;
const ROOM: u32 = 1 << 16;

/// A model's edges and a camera.
struct View {
    data: SceneData,
    views: Vec<abi::View>,
    frame: abi::Frame,
    camera: Camera,
}

impl View {
    fn new(model: &Model, camera: Camera) -> Self {
        // of meshes: sides that are outlines
        let silhouettes = model.parts.iter().any(|part| !part.meshes.is_empty());
        let settings = EdgeSettings { tangent: TangentEdges::Full, silhouettes, ..EdgeSettings::default() };
        let mut data = SceneData::new(model, crate::picture::SceneSettings::default()).unwrap();
        data.find_edges(model, settings, &|_| ()).unwrap();
        let pixels = camera.pixel_matrix();
        let views = data.placements.iter().map(|&placement| view(pixels, placement)).collect();
        Self { data, views, frame: seen_by(&camera, abi::Frame::default()), camera }
    }

    fn given(&self) -> Given<'_> {
        let edges = self.data.edges.as_ref().unwrap();
        Given {
            views: &self.views,
            piece_instances: &edges.piece_instances,
            pieces: &edges.pieces,
            points: &edges.points,
            lines: &edges.lines,
            margin_px: MARGIN_PX,
        }
    }
}

fn bracket() -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/bracket.step");
    selvedge_io::import::open(&path).unwrap().model
}

/// Three views: the whole model, a part of it that extends behind the eye, and a close parallel view.
fn views() -> Vec<View> {
    let model = bracket();
    let whole = Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, (320, 240));
    let inside = Camera { eye: whole.eye + 0.93 * (whole.target - whole.eye), depth_range: (0.1, 1e4), ..whole };
    let parallel = Camera { projection: Projection::Orthographic { height: 3.0 }, ..whole };
    [whole, inside, parallel].map(|camera| View::new(&model, camera)).into()
}

/// A torus of triangles, whose folds hide behind each other.
fn of_triangles() -> View {
    const ROUND: u32 = 40;
    let turn = |k: u32| (std::f64::consts::TAU * f64::from(k) / f64::from(ROUND)).sin_cos();
    let vertex = |i: u32, j: u32| {
        let ((su, cu), (sv, cv)) = (turn(i), turn(j));
        DVec3::new((3.0 + cv) * cu, (3.0 + cv) * su, sv)
    };
    let vertices = (0..ROUND).flat_map(|j| (0..ROUND).map(move |i| (i, j))).map(|(i, j)| vertex(i, j));
    let at = |i: u32, j: u32| j % ROUND * ROUND + i % ROUND;
    let cells = (0..ROUND).flat_map(|j| (0..ROUND).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let mesh = Mesh::new(1, vertices.collect(), triangles.collect(), Vec::new()).unwrap();
    let model = Model {
        parts: vec![Part { meshes: vec![mesh], closed: true, ..Part::default() }],
        instances: vec![Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() }],
        ..Model::default()
    };
    View::new(&model, Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 0.4), DVec3::Z, 0.6, (320, 240)))
}

fn compare(gpu: &Gpu, given: &View, expected: &View) -> Result<(), Mismatch> {
    let (edges, n) = (given.data.edges.as_ref().unwrap(), given.given().piece_instances.len());
    let frame = gpu.upload("frame", &[given.frame]);
    let views = gpu.upload("views", &given.views);
    let [piece_instances, pieces] =
        [gpu.upload("piece instances", &edges.piece_instances), gpu.upload("pieces", &edges.pieces)];
    let points = gpu.upload_texels("points", &edges.points, Texel::F32x4);
    let lines = gpu.upload("lines", &edges.lines);
    let (twin, clamps) = divide(&expected.frame, &expected.given());
    let twin_counts: Vec<u32> = twin.iter().map(|chords| chords.len() as u32).collect();
    let (mut starts, total) = crate::twin::scan::scan(&twin_counts);
    starts.push(total);
    let starts = gpu.upload("starts", &starts);
    let chord_counts = gpu.upload("counts", &vec![u32::MAX; n]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let chords = gpu.upload("chords", &vec![Chord::default(); ROOM as usize]);
    let draw = gpu.upload("draw", &[0u32; 5]);
    let bindings = Bindings {
        frame: &frame,
        views: &views,
        piece_instances: &piece_instances,
        pieces: &pieces,
        points: &points,
        counts: &chord_counts,
        starts: &starts,
        counters: &counters,
        lines: &lines,
        chords: &chords,
        draw: &draw,
    };
    let pass = Divide::new(gpu.device()).unwrap();
    let params = Params { instance_count: n as u32, margin_px: MARGIN_PX };
    gpu.run(|cmd| pass.count(cmd, &bindings, params));
    gpu.run(|cmd| pass.emit(cmd, &bindings, params, ROOM));
    counts("edge chord counts", &gpu.read(&chord_counts, n), &twin_counts, gpu.slack())?;
    if gpu.slack().count > 0 {
        return Ok(()); // a different number of chords shifts all later ones
    }
    let flat: Vec<Chord> = twin.into_iter().flatten().collect();
    same("edge chords", &gpu.read(&chords, flat.len()), &flat)?;
    same("edge draw", &gpu.read(&draw, 5), &[6, total, 0, 0, 1])?;
    let told = gpu.read::<Counters>(&counters, 1);
    same("counters", &[told[0].edge_chords, told[0].clamps, told[0].failed], &[total, clamps, 0])
}

#[test]
fn parity() {
    let gpus = Gpu::all();
    for view in views().into_iter().chain([of_triangles()]) {
        gpus.iter().for_each(|gpu| compare(gpu, &view, &view).unwrap());
    }
    gpus.into_iter().for_each(Gpu::finish);
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let (view, mut bent) = (views().remove(0), views().remove(0));
    let edges = bent.data.edges.as_mut().unwrap();
    let piece_instance = edges
        .piece_instances
        .iter()
        .position(|piece_instance| edges.pieces[piece_instance.piece as usize].degree > 1)
        .unwrap();
    let piece = edges.pieces[edges.piece_instances[piece_instance].piece as usize];
    edges.points[piece.first as usize + 1][2] += 50.0;
    assert!(compare(&gpu, &bent, &view).is_err());
    gpu.finish();
}

#[test]
fn outlines_of_meshes_are_few_of_their_sides_and_a_difference_is_seen() {
    let view = of_triangles();
    let (chords, clamps) = divide(&view.frame, &view.given());
    let drawn = chords.iter().filter(|chords| !chords.is_empty()).count();
    // some four rings of 40 sides, whose zigzags double them
    assert!(clamps == 0 && (100..chords.len() / 5).contains(&drawn), "{drawn} of {}", chords.len());
    let mut other = of_triangles();
    let given = other.given();
    let is_drawn = |nth: usize| !chords[nth].is_empty();
    let piece = (0..chords.len()).find(|nth| is_drawn(*nth)).map(|nth| given.piece_instances[nth].piece).unwrap();
    let first = given.pieces[piece as usize].first as usize;
    // the second triangle is turned over to the other side
    let points = &mut other.data.edges.as_mut().unwrap().points[first..];
    points[3] = std::array::from_fn(|axis| points[0][axis] + points[1][axis] - points[2][axis]);
    let gpu = Gpu::new();
    assert!(compare(&gpu, &other, &view).is_err());
    gpu.finish();
}

/// Chords lie within a tenth of a pixel of the exact curve, and are about as many as in double precision.
#[test]
fn chords_are_as_near_as_those_in_double_precision() {
    let model = bracket();
    let edges: Edges = model.parts[0].edges().unwrap();
    let mut all = 0;
    for view in views() {
        let (chords, clamps) = divide(&view.frame, &view.given());
        assert_eq!(clamps, 0);
        let data = view.data.edges.as_ref().unwrap();
        let mut worst: f64 = 0.0;
        let placed = &model.instances[0].transform;
        // pieces in the order of the edges that are drawn
        let drawn = edges.edges.iter().filter(|e| data.settings.style(e.kind).is_some());
        let spans: Vec<_> = drawn.clone().flat_map(|e| &e.curve).collect();
        assert_eq!(spans.len(), chords.len());
        let mut count = 0;
        for (span, chords) in spans.iter().zip(&chords) {
            count += chords.len();
            for c in chords {
                let [a, b] = [c.a, c.b].map(|p| DVec2::new(f64::from(p[0]), f64::from(p[1])));
                for k in 0..=8 {
                    let t = f64::from(c.t[0]) + f64::from(c.t[1] - c.t[0]) * f64::from(k) / 8.0;
                    let point = placed.transform_point3(span.piece.point(t));
                    let Some((pixel, _)) = view.camera.project(point) else { continue };
                    let beside = |size: f64, x: f64| x < -3.0 || x > size + 3.0;
                    if beside(320.0, pixel.x) || beside(240.0, pixel.y) {
                        continue; // the bound holds within the picture
                    }
                    let along = (b - a).normalize_or_zero();
                    let nearest = a + along * (pixel - a).dot(along).clamp(0.0, (b - a).length());
                    worst = worst.max(pixel.distance(nearest));
                }
            }
        }
        let flat = Flattening::new(&view.camera, 0.09, f64::from(MARGIN_PX));
        let lines = drawn.flat_map(|e| flat.edge(e).lines);
        let wanted: usize = lines.map(|line| line.len() - 1).sum();
        println!("{count} chords, {wanted} in double precision, {worst:.4} px off");
        assert!(worst <= 0.1 && count > 0, "{worst} px, {count} chords");
        assert!(count.abs_diff(wanted) * 50 <= wanted, "{count} chords, {wanted} in double precision");
        all += count;
    }
    assert!(all > 2000, "{all} chords");
}
