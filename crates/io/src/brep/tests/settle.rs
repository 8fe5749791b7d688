//! Edges that miss their vertices, and faces whose neighbours contradict them.

use super::*;

/// A box of 10 mm without its sides x = 0 and z = 0 but for the two that share the edge `0`, from (0,0,0) to (0,10,0).
fn two_sides(curve: CurveGeometry) -> (Vec<Edge>, [FaceGeometry; 2]) {
    let v = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mut edges = Vec::new();
    let shared = edge(&mut edges, curve, v(0.0, 0.0, 0.0), v(0.0, 10.0, 0.0));
    let mut side = |a: DVec3, b: DVec3, frame: Frame| {
        let up = segment(&mut edges, v(0.0, 10.0, 0.0), b);
        let back = segment(&mut edges, b, a);
        let down = segment(&mut edges, a, v(0.0, 0.0, 0.0));
        let list = vec![(shared, true), (up, true), (back, true), (down, true)];
        face(SurfaceGeometry::Plane { frame }, vec![Boundary::Edges(list)])
    };
    let bottom = side(v(10.0, 0.0, 0.0), v(10.0, 10.0, 0.0), Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X).unwrap());
    let wall = side(v(0.0, 0.0, 10.0), v(0.0, 10.0, 10.0), Frame::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap());
    (edges, [bottom, wall])
}

fn settled(edges: &mut [Edge], faces: &mut [FaceGeometry]) -> Vec<(u32, String)> {
    let mut all: Vec<&mut FaceGeometry> = faces.iter_mut().collect();
    settle(edges, &mut all, false, TOLERANCE)
}

#[test]
fn vertices_win_over_a_line_beside_them() {
    let line = |origin: DVec3, direction: DVec3| CurveGeometry::Line { origin, direction };
    for (off, way) in [(DVec3::splat(3.0), DVec3::Y), (DVec3::new(0.0, 0.0, -1e-3), -DVec3::Y)] {
        let (mut edges, mut faces) = two_sides(line(off, way));
        let notes = settled(&mut edges, &mut faces);
        assert_eq!(notes.len(), 1, "{notes:?}");
        assert!(notes[0].0 == 101 && notes[0].1.ends_with("they and its faces say where it runs"), "{notes:?}");
        for f in &faces {
            let built = build_face(f, &edges, TOLERANCE).unwrap();
            assert_area(&built, 100.0, 1e-12);
            assert!(built.gap == 0.0 && built.notes.is_empty(), "{:?}", built.notes);
        }
    }
    // the same of a part of a line, as trimmed curves state it
    let basis = Box::new(line(DVec3::splat(3.0), DVec3::Y));
    let (mut edges, mut faces) = two_sides(CurveGeometry::Trimmed { basis, start: 0.0, end: 10.0, forward: true });
    assert_eq!(settled(&mut edges, &mut faces).len(), 1);
    assert_area(&build_face(&faces[0], &edges, TOLERANCE).unwrap(), 100.0, 1e-12);
}

#[test]
fn an_edge_that_cannot_be_repaired_stays_and_is_reported() {
    let line = |origin: DVec3, direction: DVec3| CurveGeometry::Line { origin, direction };
    // another direction: the edge cannot be repaired
    let (mut edges, mut faces) = two_sides(line(DVec3::splat(3.0), DVec3::new(1.0, 1.0, 0.0)));
    let before = edges.clone();
    let notes = settled(&mut edges, &mut faces);
    assert!(
        edges == before && notes.len() == 1 && notes[0].1.starts_with("its curve misses its vertices by"),
        "{notes:?}"
    );
    // vertices that lie off the faces are no better than the line
    let (mut edges, mut faces) = two_sides(line(DVec3::ZERO, DVec3::Y));
    (edges[0].start, edges[0].end) = (DVec3::new(2.0, 0.0, 1.0), DVec3::new(2.0, 10.0, 1.0));
    let before = edges.clone();
    let notes = settled(&mut edges, &mut faces);
    assert!(edges == before && notes.len() == 1, "{notes:?}");
    // a line through its vertices is not looked at
    let (mut edges, mut faces) = two_sides(line(DVec3::Y * 3.0, DVec3::Y));
    let before = edges.clone();
    assert!(settled(&mut edges, &mut faces).is_empty() && edges == before);
}

/// A cylinder of radius 2 and height 3: its wall and its lower cap, with the rim between them stated as `rim`.
fn can(rim: CurveGeometry, marks: &[f64]) -> (Vec<Edge>, [FaceGeometry; 2], Frame) {
    let f = odd_frame();
    let at = |a: f64| f.world(DVec3::new(2.0 * a.cos(), 2.0 * a.sin(), 0.0));
    let mut edges = Vec::new();
    let next = |i: usize| marks[(i + 1) % marks.len()];
    let lower: Vec<(usize, bool)> =
        (0..marks.len()).map(|i| (edge(&mut edges, rim.clone(), at(marks[i]), at(next(i))), true)).collect();
    let upper = full_circle(&mut edges, moved(f, [0.0, 0.0, 3.0]), 2.0);
    let wall = face(
        SurfaceGeometry::Cylinder { frame: f, radius: 2.0 },
        vec![Boundary::Edges(lower.clone()), Boundary::Edges(vec![(upper, false)])],
    );
    let cap = face(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Edges(lower)]);
    (edges, [wall, cap], f)
}

#[test]
fn vertices_win_over_a_circle_beside_them() {
    let f = odd_frame();
    let wrong = [
        circle(f, 2.3),
        circle(moved(f, [0.2, -0.1, 0.0]), 2.0),
        circle(moved(f, [0.0, 0.0, 0.4]), 2.0),
        circle(moved(f, [-0.3, 0.2, -0.2]), 1.8),
    ];
    for rim in wrong {
        for marks in [&[0.4][..], &[0.4, 2.9], &[5.0, 1.0, 3.0]] {
            let (mut edges, mut faces, f) = can(rim.clone(), marks);
            let notes = settled(&mut edges, &mut faces);
            assert_eq!(notes.len(), marks.len(), "{rim:?} {marks:?}: {notes:?}");
            for (face, area) in faces.iter().zip([12.0 * PI, 4.0 * PI]) {
                let built = build_face(face, &edges, TOLERANCE).unwrap();
                assert_area(&built, area, 1e-9);
            }
            for e in &edges[..marks.len()] {
                let CurveGeometry::Circle { frame, radius } = &e.curve else { panic!("a circle") };
                assert!((radius - 2.0).abs() < 1e-9 && frame.origin.distance(f.origin) < 1e-9, "{e:?}");
            }
        }
    }
}

/// An eighth of a ball: its round side and three plane ones. The round one runs its loop as stated, or backwards.
fn octant(backwards: bool, same_sense: bool) -> (Vec<Edge>, Vec<FaceGeometry>) {
    let f = odd_frame();
    let axes = [f.x, f.y, f.z];
    let mut edges = Vec::new();
    let next = |i: usize| (i + 1) % 3;
    let tip = |i: usize| f.origin + axes[i] * 5.0;
    for i in 0..3 {
        // from axis i to the next one about the third
        let frame = Frame { origin: f.origin, x: axes[i], y: axes[next(i)], z: axes[next(next(i))] };
        edge(&mut edges, circle(frame, 5.0), tip(i), tip(next(i)));
    }
    for i in 0..3 {
        segment(&mut edges, f.origin, tip(i));
    }
    let mut round = vec![(0, true), (1, true), (2, true)];
    if backwards {
        round = vec![(2, false), (1, false), (0, false)];
    }
    let mut faces = vec![FaceGeometry {
        same_sense,
        ..face(SurfaceGeometry::Sphere { frame: f, radius: 5.0 }, vec![Boundary::Edges(round)])
    }];
    for i in 0..3 {
        let plane = Frame { origin: f.origin, x: axes[next(i)], y: axes[i], z: -axes[next(next(i))] };
        let bound = vec![(3 + next(i), true), (i, false), (3 + i, false)];
        faces.push(face(SurfaceGeometry::Plane { frame: plane }, vec![Boundary::Edges(bound)]));
    }
    (edges, faces)
}

#[test]
fn a_contradicted_loop_bounds_the_smaller_part() {
    let part = 4.0 * PI * 25.0 / 8.0;
    let build = |backwards: bool, same_sense: bool, with: usize, closed: bool| {
        let (mut edges, mut faces) = octant(backwards, same_sense);
        faces.truncate(with);
        let mut all: Vec<&mut FaceGeometry> = faces.iter_mut().collect();
        assert!(settle(&mut edges, &mut all, closed, TOLERANCE).is_empty());
        build_face(&faces[0], &edges, TOLERANCE).unwrap()
    };
    let told = ["face #7: its loops do not say which side of them it is; the smaller one is taken"];
    // neighbours agree
    let built = build(false, true, 4, true);
    assert_area(&built, part, 1e-9);
    assert!(built.notes.is_empty());
    // neighbours run their edges the same way
    let built = build(true, true, 4, true);
    assert_area(&built, part, 1e-9);
    assert_eq!(built.notes, told);
    // alone, its loop means the other seven eighths
    let built = build(true, true, 1, false);
    assert_area(&built, 7.0 * part, 1e-9);
    assert!(built.notes.is_empty());
    // turned inside out as a whole: its normal points into the solid that it encloses
    let built = build(true, false, 4, true);
    assert_area(&built, part, 1e-9);
    assert_eq!(built.notes, told);
}
