//! Round trips bit for bit, and files that no writer makes.

use super::*;
use crate::import::step;
use crate::model::{EdgeRef, EdgeSource, Face, Instance, Mesh, Part, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Surface};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use proptest::prelude::*;

/// The same model, and the same bytes when it is written again: equality of floats alone would take
/// minus zero for zero.
#[track_caller]
fn round_trip(model: &Model) {
    let bytes = write(model);
    let back = read(&bytes).expect("what was written can be read");
    assert_eq!(&back, model);
    assert_eq!(write(&back), bytes);
}

/// A bilinear patch of four corners with weights, and a triangular loop on it.
fn face(numbers: &[f64; 12], weight: f64) -> Face {
    let corner = |i: usize| DVec4::new(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2], weight);
    let knots = vec![-0.0, 0.0, 1.0, 1.0];
    let surface = Surface::new((1, 1), knots.clone(), knots, (0..4).map(corner).collect()).unwrap();
    let at = |i: usize| DVec2::new([0.1, 0.9, 0.3][i % 3], [0.2, 0.4, 0.7][i % 3]);
    let rational = |i: usize| Bezier {
        points: [at(i), (at(i) + at(i + 1)) / 3.0, at(i + 1)].map(|p| (p * weight).extend(weight)).into(),
    };
    let trim = TrimLoop::new((0..3).map(rational).collect(), DVec2::splat(1e-9)).unwrap();
    let edges = [Some((1, true)), None, Some((0, false))].map(|e| e.map(|(edge, forward)| EdgeRef { edge, forward }));
    let trim = trim.with_edges(edges.to_vec()).unwrap();
    let loops = vec![trim.clone().reversed(), trim];
    Face { id: 7, kind: SurfaceKind::Plane, surface, loops, same_sense: false, colour: Some([0.25, -0.0, 1.0, 0.5]) }
}

fn model(numbers: &[f64; 12], weight: f64, name: &str) -> Model {
    let corner = |i: usize| DVec3::from_slice(&numbers[3 * i..]);
    let positions: Vec<DVec3> = (0..4).map(corner).collect();
    let normals = vec![[corner(0), corner(1), corner(2)]; 2];
    let mesh = Mesh::new(u32::MAX, positions, vec![[0, 1, 2], [2, 1, 3]], normals).unwrap();
    let solid = Part {
        name: name.to_owned(),
        faces: vec![face(numbers, weight)],
        meshes: vec![mesh],
        closed: true,
        stated_edges: vec![Some(EdgeSource { entity: 400, item: Some(3) }), None],
    };
    let transform = DAffine3::from_translation(corner(3));
    let instance = Instance { part: 1, transform, colour: None, name: String::new() };
    Model {
        name: name.to_owned(),
        parts: vec![Part::default(), solid],
        instances: vec![instance],
        unit: "inch".into(),
        ..Model::default()
    }
}

/// Every sort of finite number, the extremes among them.
fn number() -> impl Strategy<Value = f64> {
    let extreme = [-0.0, 0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::MIN, 1.0 + f64::EPSILON];
    prop_oneof![
        prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        prop::sample::select(extreme.to_vec())
    ]
}

proptest! {
    #[test]
    fn every_model_comes_back(numbers in prop::array::uniform12(number()), weight in 1e-3f64..1e3, name in ".*") {
        round_trip(&model(&numbers, weight, &name));
    }

    /// Any damage under a checksum that fits: a model that keeps the invariants, or an error.
    #[test]
    fn no_damage_panics(
        changes in prop::collection::vec((any::<usize>(), any::<u8>()), 1..4),
        cut in prop::option::of(any::<usize>()),
    ) {
        let mut bytes = write(&model(&[0.5; 12], 1.0, "part"));
        for (at, byte) in changes {
            let at = HEADER + at % (bytes.len() - HEADER);
            bytes[at] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(HEADER + cut % (bytes.len() - HEADER));
        }
        seal(&mut bytes);
        if let Ok(model) = read(&bytes) {
            round_trip(&model);
        }
    }

    #[test]
    fn no_bytes_panic(body in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut bytes = vec![0; HEADER];
        bytes.extend(body);
        seal(&mut bytes);
        let _ = read(&bytes);
    }
}

#[test]
fn an_imported_model_comes_back() {
    let text = include_bytes!("../import/step/tests/good.step");
    let import = step(text, "good.step").unwrap();
    assert_eq!(import.model.face_count(), 3);
    round_trip(&import.model);
    round_trip(&Model::default());
}

/// The bytes of one model, once and for all. When this fails the form has changed: raise `VERSION`,
/// then put the new figure here.
#[test]
fn the_form_is_that_of_the_version() {
    let numbers = std::array::from_fn(|i| i as f64 - 0.5);
    let bytes = write(&model(&numbers, 2.0, "part"));
    assert_eq!((VERSION, bytes.len(), checksum(&bytes[HEADER..])), (4, 1263, 3_103_249_073));
}

/// A trim curve of an edge that its part does not have.
#[test]
fn an_absent_edge_is_reported() {
    let mut model = model(&[0.5; 12], 1.0, "part");
    model.parts[1].stated_edges.pop();
    let error = read(&write(&model)).unwrap_err();
    assert!(
        error.to_string().ends_with("a trim curve of face 0 of part 1 is of edge 1, and the part has 1"),
        "{error}"
    );
}

/// Every cut, and every single flipped bit.
#[test]
fn damage_is_seen() {
    let bytes = write(&model(&[1.0; 12], 1.0, "part"));
    for end in 0..bytes.len() {
        let error = read(&bytes[..end]).unwrap_err();
        match end {
            ..9 => assert_eq!(error, NativeError::Magic),
            _ => assert!(matches!(error, NativeError::Length { .. }), "{end}: {error}"),
        }
    }
    for bit in 0..8 * bytes.len() {
        let mut bytes = bytes.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert!(read(&bytes).is_err(), "bit {bit}");
    }
    assert_eq!(read(&[bytes.as_slice(), b"x"].concat()).unwrap_err().to_string().split(' ').next(), Some("the"));
}

#[test]
fn another_version_is_named() {
    let mut bytes = write(&Model::default());
    bytes[9] = 1;
    assert_eq!(read(&bytes), Err(NativeError::Version { found: 1 }));
}

/// A sealed file with one run of bytes replaced.
fn with(from: &[u8], to: &[u8]) -> Vec<u8> {
    let mut bytes = write(&model(&[1.5; 12], 1.0, "part"));
    let at = HEADER + bytes[HEADER..].windows(from.len()).position(|w| w == from).expect("stands in the file");
    bytes.splice(at..at + from.len(), to.iter().copied());
    seal(&mut bytes);
    bytes
}

fn real(x: f64) -> Vec<u8> {
    [&[0xcb][..], &x.to_be_bytes()].concat()
}

/// Every class of damage with the message that it must have, word for word; the checksum fits. The form is all
/// or nothing, so there is no model with a face less, and nothing in it refers to itself.
#[test]
fn every_invariant_is_checked() {
    let half = |x: f32| x.to_be_bytes();
    let mut wrong = Vec::new();
    for (class, bytes, message) in [
        ("swapped", with(&[0x93, 2, 1, 3], &[0x93, 2, 1, 4]), "triangle 1 names vertex 4 of 4"),
        ("swapped", with(&[0x94, 1, 0x9c], &[0x94, 2, 0x9c]), "instance 0 is of part 2, and there are 2"),
        ("swapped", with(&[7, 0xa5], &[0, 0xa5]), "face 0 of part 1 has number 0, which is the background's"),
        (
            "swapped",
            with(&[0xce, 255, 255, 255, 255], &[0]),
            "mesh 0 of part 1 has number 0, which is the background's",
        ),
        // counts that the bytes cannot hold
        (
            "huge",
            with(&[0xa4, b'p'], &[0xdb, 255, 255, 255, 255, b'p']),
            "IO error while reading data: unexpected end of file",
        ),
        ("huge", with(&[0x94, 0xcb], &[0xdd, 255, 255, 255, 255, 0xcb]), "wrong msgpack marker FixArray(4)"),
        (
            "huge",
            with(&[1, 1, 0x94], &[0xcf, 255, 255, 255, 255, 255, 255, 255, 255, 1, 0x94]),
            "degree 18446744073709551615 is not between 1 and 15",
        ),
        ("huge", with(&[1, 1, 0x94], &[1, 0, 0x94]), "degree 0 is not between 1 and 15"),
        (
            "NaN",
            with(&real(1.5), &real(f64::NAN)),
            "control point 0 has a coordinate that is not finite or a weight that is not positive",
        ),
        (
            "NaN",
            with(&real(0.9), &real(f64::INFINITY)),
            "trim curve 1 has a control point that is not finite or a weight that is not positive",
        ),
        ("NaN", with(&half(0.25), &half(f32::NAN)), "the colour of face 0 of part 1 is not between 0 and 1"),
        (
            "type",
            with(b"Plane", b"Plaid"),
            "unknown variant `Plaid`, expected one of `Plane`, `Cylinder`, `Cone`, `Sphere`, `Torus`, `Revolution`, `Extrusion`, `Offset`, `BSpline`",
        ),
        ("type", with(&real(1.5), &[0xa1, b'x']), "wrong msgpack marker FixStr(1)"),
        ("type", with(&[0xa4, b'p', b'a', b'r', b't'], &[0xc0]), "invalid type: unit value, expected a string"),
        ("type", with(&[0xa4, b'i', b'n', b'c', b'h'], &[0x2a]), "invalid type: integer `42`, expected a string"),
        ("value", with(&real(-0.0), &real(2.0)), "knot 1 is smaller than the one before it, or not a number"),
        ("value", with(&real(0.9), &real(0.8)), "trim loop is open by 9.999999999999998e-2 in (u, v) after curve 1"),
        ("value", with(&half(0.25), &half(1.25)), "the colour of face 0 of part 1 is not between 0 and 1"),
    ] {
        let error = read(&bytes).unwrap_err();
        if error != NativeError::Model(message.to_owned()) {
            wrong.push(format!("{class}: {message}: {error}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
