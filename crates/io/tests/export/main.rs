//! Made solids out as STEP and in again: the same faces, on the same surfaces, closed at shared edges.

mod csg;

use glam::{DAffine3, DQuat, DVec2, DVec3};
use selvedge_geometry::construct::shapes::{self, GearBlank, Keyway, SpurGear};
use selvedge_geometry::construct::subdivide::{ControlMesh, Scheme, subdivide};
use selvedge_geometry::construct::{Chain, extruded_solid, lathed_solid};
use selvedge_geometry::model::{Colour, Face, Instance, Model, Part};
use selvedge_geometry::spline::{BSpline, Control};
use selvedge_io::export;
use selvedge_io::import;
use std::f64::consts::TAU;

/// Of the size: the text holds every number in full, so only rounding of planes is left.
const SAME: f64 = 1e-9;

/// A closed polyline.
fn polygon(corners: &[(f64, f64)]) -> Chain {
    let point = |k: usize| DVec3::from_point(DVec2::from(corners[k % corners.len()]), 1.0);
    let side = |k| BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![point(k), point(k + 1)]).unwrap();
    (0..corners.len()).map(side).collect()
}

fn model(part: Part, transforms: &[DAffine3]) -> Model {
    let instance = |t: &DAffine3| Instance { part: 0, transform: *t, colour: None, name: "placed".into() };
    Model {
        name: "made".into(),
        instances: transforms.iter().map(instance).collect(),
        parts: vec![part],
        ..Model::default()
    }
}

fn written(model: &Model) -> String {
    let mut text = Vec::new();
    let warnings = export::step(model, &mut text).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    String::from_utf8(text).unwrap()
}

fn count(text: &str, entity: &str) -> usize {
    text.matches(&format!("={entity}(")).count()
}

/// Every point of the read faces lies on the written face, in its place in the list.
fn compare(part: &Part, text: &str) -> import::Import {
    let read = import::step(text.as_bytes(), "made.step").unwrap();
    assert!(read.report.dropped.is_empty(), "{:?}", read.warnings);
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let [back] = &read.model.parts[..] else { panic!("one part") };
    assert!(back.closed);
    assert_eq!(back.faces.len(), part.faces.len());
    let size = part.bounds().diagonal();
    assert!((back.bounds().diagonal() - size).abs() <= 1e-3 * size);
    for (a, b) in part.faces.iter().zip(&back.faces) {
        assert_eq!(a.same_sense, b.same_sense);
        let (grid, read) = (a.surface.patches(), b.surface.patches());
        let ((u0, u1), (v0, v1)) = a.surface.domain();
        if a.surface.degrees() == (1, 1) {
            // planes come back in lengths of their own
            let (mine, theirs) = (grid.jet(u0, v0), read.patches[0].patch.points[0].point());
            let normal = mine.du.cross(mine.dv).normalize();
            assert!((theirs - mine.point).dot(normal).abs() <= SAME * size);
            continue;
        }
        for k in 0..=100 {
            let (s, t) = (f64::from(k % 11) / 10.0, f64::from(k / 11) / 9.1);
            let (u, v) = (u0 + (u1 - u0) * s, v0 + (v1 - v0) * t);
            assert!(grid.point(u, v).distance(read.point(u, v)) <= SAME * size, "face {} at {u} {v}", a.id);
        }
    }
    read
}

#[test]
fn a_block_with_a_hole_has_each_edge_once() {
    let outer = polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]);
    let inner = polygon(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]);
    let part = extruded_solid(&[outer, inner], DVec3::Z * 2.0).unwrap();
    let text = written(&model(part.clone(), &[DAffine3::IDENTITY]));
    // a prism over 8 corners in two loops
    assert_eq!(count(&text, "EDGE_CURVE"), 24);
    assert_eq!(count(&text, "VERTEX_POINT"), 16);
    assert_eq!(count(&text, "PCURVE"), 48);
    assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 1);
    assert_eq!(count(&text, "NEXT_ASSEMBLY_USAGE_OCCURRENCE"), 0);
    compare(&part, &text);
    assert_eq!(text, written(&model(part, &[DAffine3::IDENTITY])), "the same bytes");
}

#[test]
fn a_turned_solid_has_seams_and_poles() {
    // a truncated cone with a tip: two seams, two circles, one pole
    let part = lathed_solid(&[polygon(&[(0.0, 0.0), (3.0, 0.0), (2.0, 2.0), (0.0, 3.0)])], TAU).unwrap();
    let text = written(&model(part.clone(), &[DAffine3::IDENTITY]));
    assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 1);
    assert_eq!(count(&text, "SEAM_CURVE"), 3);
    assert_eq!(count(&text, "EDGE_CURVE"), 5);
    assert_eq!(count(&text, "VERTEX_POINT"), 4);
    compare(&part, &text);
}

#[test]
fn instances_are_an_assembly() {
    let part = extruded_solid(&[polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])], DVec3::Z).unwrap();
    let turned = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    let places = [DAffine3::from_translation(DVec3::new(5.0, 0.0, 1.0)), turned];
    let text = written(&model(part.clone(), &places));
    assert_eq!(count(&text, "NEXT_ASSEMBLY_USAGE_OCCURRENCE"), 2);
    assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 1);
    let read = compare(&part, &text);
    assert_eq!(read.model.instances.len(), 2);
    for (a, b) in places.iter().zip(&read.model.instances) {
        assert!(a.abs_diff_eq(b.transform, 1e-12));
        assert_eq!(b.name, "placed");
    }
}

#[test]
fn what_is_lost_is_said() {
    let mut part = extruded_solid(&[polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])], DVec3::Z).unwrap();
    part.faces.pop();
    let mut text = Vec::new();
    let warnings = export::step(&model(part, &[DAffine3::IDENTITY]), &mut text).unwrap();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].message.contains("3 of 9 edges"), "{}", warnings[0].message);
    assert_eq!(count(&String::from_utf8(text).unwrap(), "OPEN_SHELL"), 1);
}

/// A ball with a ball-shaped hole: two shells, of which one is the void.
#[test]
fn a_hollow_solid_has_a_void() {
    let mut part = shapes::sphere(3.0).unwrap().part;
    let hole = shapes::torus(1.5, 0.5).unwrap().part;
    part.faces.extend(hole.faces.into_iter().map(|f| Face { id: 2, same_sense: false, ..f }));
    let text = written(&model(part.clone(), &[DAffine3::IDENTITY]));
    assert_eq!((count(&text, "BREP_WITH_VOIDS"), count(&text, "MANIFOLD_SOLID_BREP")), (1, 0));
    assert_eq!((count(&text, "CLOSED_SHELL"), count(&text, "ORIENTED_CLOSED_SHELL")), (2, 1));
    compare(&part, &text);
    // a solid beside it is one of its own
    part.faces.extend(shapes::block(DVec3::splat(10.0), DVec3::splat(11.0)).unwrap().part.faces);
    let text = written(&model(part, &[DAffine3::IDENTITY]));
    assert_eq!((count(&text, "BREP_WITH_VOIDS"), count(&text, "MANIFOLD_SOLID_BREP")), (1, 1));
}

/// STEP's placements are rigid: others are carried out, and normals still point outwards.
#[test]
fn instances_that_scale_or_mirror_are_parts_of_their_own() {
    let blank = GearBlank { radius: 5.0, width: 1.0, hub_radius: 2.0, hub_width: 2.0, bore: 1.0, keyway: None };
    let part = blank.build().unwrap().part;
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let stretched = DAffine3::from_scale_rotation_translation(
        DVec3::new(2.0, 1.0, 0.5),
        DQuat::from_rotation_y(0.3),
        DVec3::new(20.0, 0.0, 0.0),
    );
    let places = [DAffine3::IDENTITY, mirror, stretched];
    let text = written(&model(part.clone(), &places));
    assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 3);
    let read = import::step(text.as_bytes(), "made.step").unwrap();
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    assert_eq!((read.model.parts.len(), read.model.instances.len()), (3, 3));
    for (place, back) in places.iter().zip(&read.model.instances) {
        let found = &read.model.parts[back.part];
        assert!(found.closed && back.transform.abs_diff_eq(DAffine3::IDENTITY, 1e-12));
        for (a, b) in part.faces.iter().zip(&found.faces) {
            // the middle of a wall, and its normal
            let ((u0, u1), (v0, v1)) = a.surface.domain();
            if a.surface.degrees() == (1, 1) {
                continue;
            }
            let (u, v) = (u0 + 0.3 * (u1 - u0), 0.5 * (v0 + v1));
            let (mine, theirs) = (a.surface.jet(u, v), b.surface.jet(u, v));
            let sign = |f: &Face| if f.same_sense { 1.0 } else { -1.0 };
            let matrix = place.matrix3;
            let outwards = matrix.inverse().transpose() * (mine.du.cross(mine.dv) * sign(a));
            assert!(place.transform_point3(mine.point).distance(theirs.point) <= SAME * 20.0);
            assert!(outwards.dot(theirs.du.cross(theirs.dv) * sign(b)) > 0.0, "face {}", a.id);
        }
    }
}

/// A warning about a part has the part's own number, carried out or not.
#[test]
fn warnings_name_the_part() {
    let mut part = shapes::cone(2.0, 1.0, 3.0).unwrap().part;
    part.faces.pop();
    let mut text = Vec::new();
    let warnings = export::step(&model(part, &[DAffine3::from_scale(DVec3::new(1.0, 1.0, -2.0))]), &mut text).unwrap();
    assert_eq!(warnings.iter().map(|w| w.item).collect::<Vec<_>>(), [export::Item::Part(0)]);
}

/// Colours and opacity, of faces and of instances, come back to the 8 bits and more that sRGB keeps.
#[test]
fn colours_and_transparency_come_back() {
    let mut part = shapes::cylinder(1.0, 2.0).unwrap().part;
    part.faces[1].colour = Some([0.8, 0.1, 0.25, 0.5]);
    part.faces[2].colour = Some([0.0, 1.0, 0.002, 1.0]);
    let mut made = model(part, &[DAffine3::IDENTITY, DAffine3::from_translation(DVec3::X * 5.0)]);
    made.instances[1].colour = Some([0.2, 0.3, 0.4, 0.75]);
    let text = written(&made);
    assert_eq!(count(&text, "SURFACE_STYLE_TRANSPARENT"), 2);
    let read = import::step(text.as_bytes(), "made.step").unwrap().model;
    let same = |a: Option<Colour>, b: Colour| {
        let a = a.expect("a colour");
        assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() <= 1e-6), "{a:?} for {b:?}");
    };
    let seen = |instance: usize, face: usize| {
        let i = &read.instances[instance];
        i.colour.or(read.parts[i.part].faces[face].colour)
    };
    same(seen(0, 1), [0.8, 0.1, 0.25, 0.5]);
    same(seen(0, 2), [0.0, 1.0, 0.002, 1.0]);
    assert_eq!(seen(0, 0), None);
    (0..3).for_each(|face| same(seen(1, face), [0.2, 0.3, 0.4, 0.75]));
}

/// Every ready-made shape, and a subdivision surface, closes edge by edge.
#[test]
fn shapes_are_written_as_solids() {
    let pot = shapes::teapot().unwrap();
    let keyway = Some(Keyway { width: 0.6, depth: 0.3 });
    let blank = GearBlank { radius: 5.0, width: 1.0, hub_radius: 2.0, hub_width: 2.0, bore: 1.0, keyway };
    let bodies = [
        shapes::block(DVec3::NEG_ONE, DVec3::ONE).unwrap(),
        shapes::sphere(2.0).unwrap(),
        shapes::cylinder(1.0, 2.0).unwrap(),
        shapes::cone(1.0, 0.0, 2.0).unwrap(),
        shapes::torus(3.0, 1.0).unwrap(),
        shapes::tube(2.0, 1.0, 4.0).unwrap(),
        blank.build().unwrap(),
        SpurGear::new(1.0, 8, 2.0, 1.0).build().unwrap(),
        pot.pot,
        pot.lid,
        pot.handle,
        pot.spout,
    ];
    for body in bodies {
        let text = written(&model(body.part.clone(), &[DAffine3::IDENTITY]));
        assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 1);
        compare(&body.part, &text);
    }
    let positions = (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mesh = ControlMesh { positions, faces: faces.map(|f| f.to_vec()).to_vec(), creases: Vec::new() };
    let made = subdivide(&mesh, Scheme::CatmullClark, 1e-3).unwrap();
    let text = written(&model(made.part.clone(), &[DAffine3::IDENTITY]));
    assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 1);
    compare(&made.part, &text);
}

/// A solid that is one primitive is written as its faces where it stands, with its colour; every other solid is named
/// in a warning.
#[test]
fn primitives_are_written_and_expressions_named() {
    use selvedge_geometry::csg::{Builder, Tree};
    use selvedge_geometry::model::{Primitive, Quadric, Shape, Solid};
    let leaf = |b: &mut Builder, k| b.leaf(k);
    let one = || -> Tree {
        let mut b = Builder::new();
        let root = leaf(&mut b, 0);
        b.finish(root).unwrap()
    };
    let place = DAffine3::from_translation(DVec3::new(5.0, 6.0, 7.0));
    let primitive = |shape, transform| Primitive { shape, transform, colour: [0.2, 0.3, 0.4, 1.0], id: 9 };
    let solid = |shape, transform| Solid::new(vec![primitive(shape, transform)], one()).unwrap();
    let squeezed = DAffine3::from_scale(DVec3::new(1.0, 1.0, -0.5));
    let both = {
        let mut b = Builder::new();
        let pair = [leaf(&mut b, 0), leaf(&mut b, 1)];
        let root = b.pair(selvedge_geometry::csg::Op::Difference, pair[0], pair[1]);
        let shapes = [1.0, 2.0].map(|radius| primitive(Shape::Sphere { radius }, place));
        Solid::new(shapes.to_vec(), b.finish(root).unwrap()).unwrap()
    };
    let ball = Quadric { squares: DVec3::ONE, constant: -1.0, ..Quadric::default() };
    let solids = vec![
        solid(Shape::Block { min: DVec3::ZERO, max: DVec3::ONE }, place),
        solid(Shape::Cone { bottom: 2.0, top: 1.0, height: 3.0 }, squeezed),
        solid(Shape::Sphere { radius: 1.0 }, DAffine3::IDENTITY),
        solid(Shape::Cylinder { radius: 1.0, height: 2.0 }, place),
        solid(Shape::Torus { major: 3.0, minor: 1.0 }, place),
        both,
        solid(Shape::Quadric(ball), place),
        solid(Shape::Sphere { radius: 0.0 }, place),
        solid(Shape::Sphere { radius: 1.0 }, DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0))),
    ];
    let made = Model { name: "solids".into(), solids, ..Model::default() };
    let mut text = Vec::new();
    let warnings = export::step(&made, &mut text).unwrap();
    let told: Vec<String> = warnings.iter().map(|w| format!("{} {}", w.item, w.message)).collect();
    assert_eq!(
        told,
        [
            "solid 5 is an expression over 2 primitives: written as CSG_SOLID, which some readers leave out",
            "solid 6 was left out: primitive #9 is a quadric, which files of this form do not have",
            "solid 7 is empty and was left out",
            "solid 8 is empty and was left out",
        ]
    );
    let text = String::from_utf8(text).unwrap();
    assert_eq!(count(&text, "MANIFOLD_SOLID_BREP"), 5);
    let read = import::step(text.as_bytes(), "solids.step").unwrap();
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    assert_eq!(read.model.solids.len(), 1);
    let counts: Vec<usize> = read.model.parts.iter().map(|p| p.faces.len()).collect();
    assert_eq!(counts, [6, 3, 1, 3, 1]);
    let boxes: Vec<_> = read.model.instances.iter().map(|i| (i, read.model.parts[i.part].bounds())).collect();
    let middle = |k: usize| boxes[k].0.transform.transform_point3(boxes[k].1.centre());
    assert!(middle(0).distance(DVec3::new(5.5, 6.5, 7.5)) <= SAME * 10.0);
    assert!(middle(1).distance(DVec3::new(0.0, 0.0, -0.75)) <= SAME * 10.0);
    for (i, _) in &boxes {
        let colour = i.colour.or(read.model.parts[i.part].faces[0].colour).expect("a colour");
        assert!(colour.iter().zip([0.2, 0.3, 0.4, 1.0]).all(|(a, b): (&f32, f32)| (a - b).abs() <= 1e-6), "{colour:?}");
    }
}
