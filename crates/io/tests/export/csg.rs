//! Boolean solids out as STEP and in again: the same sets of points.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use selvedge_check::solids::SolidTracer;
use selvedge_geometry::construct::shapes;
use selvedge_geometry::csg::{Builder, Node, Op, parse};
use selvedge_geometry::model::{Colour, Mesh, Model, Primitive, Quadric, Shape, Solid, SurfaceTable};
use selvedge_io::export::{self, ExportWarning};
use selvedge_io::import;
use std::path::Path;
use std::sync::Arc;

/// Share of the size: points nearer to a boundary than this may fall on either side. The errors of a rigid placement
/// (1e-12), of the angle of a cone and of the transform of a stretched part are far smaller.
const NEAR: f64 = 1e-9;

fn write(solids: Vec<Solid>) -> (String, Vec<ExportWarning>) {
    let mut text = Vec::new();
    let made = Model { name: "solids".into(), solids, ..Model::default() };
    let warnings = export::step(&made, &mut text).unwrap();
    (String::from_utf8(text).unwrap(), warnings)
}

fn read(text: &str) -> Model {
    let read = import::step(text.as_bytes(), "solids.step").unwrap();
    // transparency is kept, with a warning
    let told = read.warnings.iter().filter(|w| !w.message.starts_with("transparent colour"));
    assert_eq!(told.count(), 0, "{:?}", read.warnings);
    read.model
}

fn primitive(shape: Shape, transform: DAffine3, id: u32) -> Primitive {
    Primitive { shape, transform, colour: [0.2, 0.3, 0.4, 1.0], id }
}

fn solid(text: &str, primitives: Vec<Primitive>) -> Solid {
    Solid::new(primitives, parse(text).unwrap().tree).unwrap()
}

/// Numbers in `0..1` from a seed (an additive recurrence): three a point.
fn points(count: u32) -> impl Iterator<Item = DVec3> {
    let step = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_4, 0.549_700_477_901_970_6);
    (1..=count).map(move |k| (step * f64::from(k)).fract())
}

/// Share of the volume that lines through a solid measure: the sum of their lengths inside. A line that grazes a ball
/// which is off by 1e-12 of the size is longer by the root of that at most, and few lines do.
const VOLUME: f64 = 1e-9;

/// Classifies points by lines through them, and compares, also the lines' lengths inside; returns the points inside and those
/// too near to a boundary.
fn compare(a: &Solid, b: &Solid, count: u32) -> (u32, u32) {
    let [first, second] = [a, b].map(|s| SolidTracer::new(s, SurfaceTable::ROUNDED).unwrap());
    let size = first.bounds().diagonal();
    let own = a.bounds();
    let bounds = if own.min.is_finite() && own.max.is_finite() { own } else { first.bounds() };
    let (mut inside, mut near) = (0, 0);
    let mut lengths = [0.0; 2];
    for share in points(count) {
        let p = bounds.min + (bounds.max - bounds.min) * (share * 1.1 - 0.05);
        // one direction a point, along no axis
        let d = (share - 0.5 + DVec3::new(0.01, 0.02, 0.03)).normalize();
        let [x, y] = [&first, &second].map(|t| t.trace(p, d));
        [&x, &y].iter().zip(&mut lengths).for_each(|(t, sum)| *sum += t.thickness(-size, size));
        if x.boundaries.iter().chain(&y.boundaries).any(|b| b.t.abs() <= NEAR * size) {
            near += 1;
            continue;
        }
        assert_eq!(x.inside(0.0), y.inside(0.0), "at {p}");
        inside += u32::from(x.inside(0.0));
    }
    let [x, y] = lengths;
    assert!((x - y).abs() <= VOLUME * x, "{x} inside, and {y}");
    (inside, near)
}

/// Out and in again; the share of points inside.
fn round_trip(solid: &Solid) -> (Solid, String, f64) {
    let (text, _) = write(vec![solid.clone()]);
    let model = read(&text);
    let [back] = &model.solids[..] else { panic!("{} solids", model.solids.len()) };
    let (inside, near) = compare(solid, back, 10_000);
    assert!(near < 10, "{near} points at a boundary");
    (back.clone(), text, f64::from(inside) / 10_000.0)
}

fn count(text: &str, entity: &str) -> usize {
    text.matches(&format!("={entity}(")).count()
}

fn cage() -> Mesh {
    let positions = (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64)).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    Mesh::new(7, positions, triangles, Vec::new()).unwrap()
}

fn turned(angle: f64, at: DVec3) -> DAffine3 {
    DAffine3::from_rotation_translation(DQuat::from_axis_angle(DVec3::new(2.0, 3.0, 6.0) / 7.0, angle), at)
}

/// Every kind of leaf, rigid, scaled, mirrored and sheared, taken from a block that it sticks out of.
#[test]
fn every_leaf_comes_back() {
    let place = turned(0.8, DVec3::new(5.0, 4.0, 3.0));
    let mirrored = place * DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let scaled = place * DAffine3::from_scale(DVec3::splat(1.5));
    let tall = place * DAffine3::from_scale(DVec3::new(1.2, 1.2, 0.7));
    let wide = place * DAffine3::from_scale(DVec3::new(1.0, 1.3, 0.8));
    let sheared = place * DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.4, 1.0, 0.0), DVec3::Z));
    let block = Shape::Block { min: DVec3::new(-2.0, -1.0, 0.0), max: DVec3::new(1.0, 3.0, 4.0) };
    let cylinder = Shape::Cylinder { radius: 2.0, height: 5.0 };
    let (cone, peak) =
        (Shape::Cone { bottom: 3.0, top: 1.0, height: 4.0 }, Shape::Cone { bottom: 0.0, top: 2.0, height: 3.0 });
    let torus = Shape::Torus { major: 3.0, minor: 1.0 };
    let half = Shape::HalfSpace { normal: DVec3::new(1.0, 2.0, -1.0), offset: 1.0 };
    let part = Shape::Part(Arc::new(shapes::tube(2.0, 1.0, 4.0).unwrap().part));
    let mesh = Shape::Mesh(Arc::new(cage()));
    let all = [place, mirrored, scaled, tall, wide, sheared];
    let brep = "MANIFOLD_SOLID_BREP";
    let plain = |kind: &'static str, squeezed: [bool; 6]| squeezed.map(|as_faces| if as_faces { brep } else { kind });
    let stretched = [false, false, false, true, true, true];
    let oval = [false, false, false, false, true, true];
    for (shape, kinds) in [
        (block, plain("BLOCK", [false, false, false, false, false, true])),
        (Shape::Sphere { radius: 2.5 }, plain("SPHERE", stretched)),
        (cylinder, plain("RIGHT_CIRCULAR_CYLINDER", oval)),
        (cone, plain("RIGHT_CIRCULAR_CONE", oval)),
        (peak, plain("RIGHT_CIRCULAR_CONE", oval)),
        (torus, plain("TORUS", stretched)),
        (half, ["HALF_SPACE_SOLID"; 6]),
        (part, [brep; 6]),
        (mesh, ["FACETED_BREP"; 6]),
    ] {
        for (k, (transform, kind)) in all.into_iter().zip(kinds).enumerate() {
            let around = Shape::Block { min: DVec3::ZERO, max: DVec3::splat(9.0) };
            let made =
                solid("A-B", vec![primitive(around, DAffine3::IDENTITY, 1), primitive(shape.clone(), transform, 2)]);
            let (back, text, share) = round_trip(&made);
            let blocks = if kind == "BLOCK" { 2 } else { 1 };
            assert_eq!(count(&text, kind), blocks, "{shape:?} placed by {k}");
            assert_eq!(count(&text, "BLOCK") - usize::from(kind == "BLOCK"), 1);
            assert!(share > 0.1 && share < 0.75, "{shape:?} placed by {k}: {share} inside");
            assert_eq!(back.tree(), made.tree());
        }
    }
}

/// A torus whose faces meet on the axis: the apple.
#[test]
fn apples_come_back() {
    for (major, minor) in [(1.0, 2.0), (2.0, 2.0), (0.0, 2.0)] {
        let ball = primitive(Shape::Sphere { radius: 4.0 }, DAffine3::IDENTITY, 1);
        let apple = primitive(Shape::Torus { major, minor }, turned(0.4, DVec3::X), 2);
        let (_, text, share) = round_trip(&solid("A-B", vec![ball, apple.clone()]));
        assert!(share > 0.1, "{share}");
        assert_eq!(count(&text, "TORUS"), 0);
        let (back, ..) = round_trip(&Solid::of(apple).unwrap());
        assert!(back.primitives().iter().all(|p| matches!(p.shape, Shape::Torus { .. } | Shape::Sphere { .. })));
    }
}

/// All operations, with complements anywhere, and unbounded solids.
#[test]
fn every_expression_comes_back() {
    let ball = |x: f64, y: f64, id| {
        primitive(Shape::Sphere { radius: 2.0 }, DAffine3::from_translation(DVec3::new(x, y, 0.3 * x)), id)
    };
    let balls = vec![ball(0.0, 0.0, 1), ball(1.5, 0.0, 2), ball(0.0, 1.5, 3), ball(1.5, 1.5, 4), ball(0.7, 0.7, 5)];
    for (text, endless) in [
        ("A+B", false),
        ("A*B", false),
        ("A-B", false),
        ("A^B", false),
        ("(A^B)^(C^D)", false),
        ("(A+B)-(CD-E)", false),
        ("A*!B*!C+D", false),
        ("!(!A+B)", false),
        ("!A*!B*C", false),
        ("AB+CD+E-(A^D)", false),
        ("!(A+B)", true),
        ("!A+B", true),
        ("!A^B", true),
        ("!A", true),
    ] {
        let made = solid(text, balls.clone());
        let (written, warnings) = write(vec![made.clone()]);
        let told: Vec<_> = warnings.iter().map(|w| w.message.as_str()).collect();
        assert!(told[0].contains("written as CSG_SOLID, which some readers leave out"), "{told:?}");
        assert_eq!((told.len(), told[0].contains("; it may have no end")), (1, endless), "{text}: {told:?}");
        assert_eq!(count(&written, "SPHERE"), made.tree().leaves().collect::<std::collections::BTreeSet<_>>().len());
        let back = read(&written).solids.remove(0);
        let (inside, near) = compare(&made, &back, 10_000);
        assert!(near < 10 && inside > 100, "{text}: {inside} inside, {near} at a boundary");
    }
}

/// Colours: one for all is the solid's, several are their operands'; opacity too. Ids are the file's.
#[test]
fn colours_come_back() {
    let colours: [Colour; 2] = [[0.8, 0.1, 0.25, 0.5], [0.0, 1.0, 0.002, 1.0]];
    for one in [true, false] {
        let ball = |k: usize| Primitive {
            colour: colours[if one { 0 } else { k }],
            ..primitive(Shape::Sphere { radius: 2.0 }, DAffine3::from_translation(DVec3::X * k as f64), 1)
        };
        let made = solid("A-B", vec![ball(0), ball(1)]);
        let (back, text, _) = round_trip(&made);
        assert_eq!(count(&text, "STYLED_ITEM"), if one { 1 } else { 2 });
        for (p, q) in made.primitives().iter().zip(back.primitives()) {
            assert!(
                p.colour.iter().zip(q.colour).all(|(x, y)| (x - y).abs() <= 1e-6),
                "{:?} for {:?}",
                q.colour,
                p.colour
            );
        }
    }
}

/// As deep as a printed part's worst: 10^5 operations in a row, on either side, and symmetric differences shared.
#[test]
fn depth_does_not_matter() {
    let ball =
        |k: u32| primitive(Shape::Sphere { radius: 2.0 }, DAffine3::from_translation(DVec3::X * f64::from(k)), k + 1);
    let balls: Vec<_> = (0..3).map(ball).collect();
    for left in [true, false] {
        let mut b = Builder::new();
        let mut root = b.leaf(0);
        for k in 0..100_000 {
            let leaf = b.leaf(k % 3);
            let op = [Op::Union, Op::Difference, Op::Intersection, Op::SymmetricDifference][(k % 4) as usize];
            root = if left { b.pair(op, root, leaf) } else { b.pair(op, leaf, root) };
        }
        let made = Solid::new(balls.clone(), b.finish(root).unwrap()).unwrap();
        let (text, _) = write(vec![made.clone()]);
        let back = read(&text).solids.remove(0);
        assert_eq!(back.primitives().len(), 3);
        assert_eq!(back.tree().nodes().len(), made.tree().nodes().len());
        for inside in 0..8 {
            let at = |p: u32| inside >> p & 1 == 1;
            // leaves are numbered in the order in which they are met
            let place = |p: u32| at(back.primitives()[p as usize].transform.translation.x as u32);
            assert_eq!(made.tree().contains(at), back.tree().contains(place));
        }
    }
}

/// A warning names a solid that the form does not have, and the file holds no part of it.
#[test]
fn what_is_left_out_is_named() {
    let ball = || primitive(Shape::Sphere { radius: 2.0 }, DAffine3::IDENTITY, 1);
    let quadric = Quadric { squares: DVec3::new(1.0, 1.0, -1.0), constant: -1.0, ..Quadric::default() };
    let open = {
        let mut part = shapes::tube(2.0, 1.0, 4.0).unwrap().part;
        part.faces.pop();
        Shape::Part(Arc::new(part))
    };
    let both = {
        let mut part = shapes::sphere(1.0).unwrap().part;
        part.meshes.push(cage());
        Shape::Part(Arc::new(part))
    };
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
    let sheared = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.4, 1.0, 0.0), DVec3::Z));
    for (text, other, expected) in [
        ("A-B", primitive(Shape::Quadric(quadric), DAffine3::IDENTITY, 5), "primitive #5 is a quadric"),
        ("A-B", primitive(open, DAffine3::IDENTITY, 6), "primitive #6 is not closed"),
        ("A-B", primitive(both, DAffine3::IDENTITY, 7), "primitive #7 is bounded by faces and meshes together"),
        ("AB", primitive(Shape::Sphere { radius: 1.0 }, flat, 8), "is empty and was left out"),
        ("A+!B", primitive(Shape::Sphere { radius: 1.0 }, flat, 8), "is all space and was left out"),
        ("A-B", primitive(Shape::Torus { major: 1.0, minor: 2.0 }, sheared, 9), "primitive #9 the minor radius"),
    ] {
        let (written, warnings) = write(vec![solid(text, vec![ball(), other])]);
        assert!(warnings.iter().any(|w| w.message.contains(expected)), "{expected}: {warnings:?}");
        let read = import::step(written.as_bytes(), "solids.step").unwrap();
        assert!(read.model.solids.is_empty() && read.model.parts.is_empty(), "{expected}");
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    }
    // an empty operand is none
    let empty = primitive(Shape::Sphere { radius: 1.0 }, flat, 8);
    let (written, warnings) = write(vec![solid("A-B", vec![ball(), empty])]);
    assert!(warnings.is_empty());
    assert_eq!((count(&written, "MANIFOLD_SOLID_BREP"), count(&written, "CSG_SOLID")), (1, 0));
    // a mesh with normals loses those, by name; alone it needs no expression
    let normals = vec![[DVec3::Z; 3]; 12];
    let smooth = Mesh::new(7, cage().positions().to_vec(), cage().triangles().to_vec(), normals).unwrap();
    let (written, warnings) =
        write(vec![solid("A", vec![primitive(Shape::Mesh(Arc::new(smooth)), DAffine3::IDENTITY, 1)])]);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].message.contains("normals of 1 meshes"), "{warnings:?}");
    assert_eq!((count(&written, "FACETED_BREP"), count(&written, "CSG_SOLID")), (1, 0));
}

/// The Boolean scenes of the gallery.
#[test]
fn scenes_come_back() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/gallery");
    for (name, solids) in [("boolean.toml", 2), ("section.toml", 4)] {
        let made = import::open(&folder.join(name)).unwrap().model;
        assert_eq!(made.solids.len(), solids);
        let mut text = Vec::new();
        export::step(&made, &mut text).unwrap();
        let back = read(&String::from_utf8(text).unwrap());
        let expressions = made.solids.iter().filter(|s| !matches!(s.tree().nodes(), [Node::Leaf(_)]));
        for (a, b) in expressions.zip(&back.solids) {
            let (inside, near) = compare(a, b, 10_000);
            assert!(inside > 100 && near < 10, "{name}: {inside} inside, {near} at a boundary");
        }
    }
}

/// The Boolean solids of the folder `csg` beside that of `SELVEDGE_MODELS`.
#[test]
fn files_of_a_folder_come_back() {
    let Some(folder) = std::env::var_os("SELVEDGE_MODELS").map(std::path::PathBuf::from) else {
        eprintln!("skipped: SELVEDGE_MODELS names no folder");
        return;
    };
    let Ok(files) = std::fs::read_dir(folder.join("../csg")) else {
        eprintln!("skipped: no folder csg beside SELVEDGE_MODELS");
        return;
    };
    let mut compared = 0;
    for path in files.map(|f| f.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "csg")) {
        // refused files are tested with the readers
        let Ok(import) = import::open(&path) else { continue };
        let made = import.model;
        let (text, warnings) = write(made.solids.clone());
        assert!(warnings.iter().all(|w| w.message.contains("written as CSG_SOLID")), "{path:?}: {warnings:?}");
        let back = read(&text).solids;
        assert_eq!(made.solids.len(), back.len(), "{path:?}");
        for (a, b) in made.solids.iter().zip(&back) {
            let (inside, near) = compare(a, b, 10_000);
            let (leaves, bytes) = (a.tree().leaves().count(), text.len());
            eprintln!("{path:?}: {leaves} leaves, {bytes} bytes, {inside} of 10000 inside, {near} at a boundary");
            assert!(inside > 10 && near < 10, "{path:?}: {inside} inside, {near} at a boundary");
            compared += 1;
        }
    }
    assert!(compared >= 10, "{compared} solids");
}
