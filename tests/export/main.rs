//! Made solids out as STEP and in again: the same faces, on the same surfaces, closed at shared edges.

use glam::{DAffine3, DVec2, DVec3};
use selvedge::construct::{Chain, extruded_solid, lathed_solid};
use selvedge::export;
use selvedge::import;
use selvedge::model::{Instance, Model, Part};
use selvedge::spline::{BSpline, Control};
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
