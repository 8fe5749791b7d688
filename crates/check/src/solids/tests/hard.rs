//! Cases that break renderers of solids: coincident faces, tangents, gaps, odd transforms.

use super::shapes::*;
use crate::csg::{Builder, Op};
use crate::model::{Face, Mesh, Part, SurfaceKind};
use crate::model::{Primitive, Quadric, Shape, Solid, SurfaceTable};
use crate::solids::{SolidTracer, Trace};
use crate::spline::{Control, Surface};
use glam::{DAffine3, DVec3, DVec4};
use std::sync::Arc;

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn plate() -> Primitive {
    block([-2.0, -2.0, 0.0], [2.0, 2.0, 1.0])
}

#[test]
fn flush_through_hole() {
    let through = |x: f64| stops(&trace("A-B", vec![plate(), cylinder(1.0, 0.0, 1.0)], [x, 0.1, -3.0], UP));
    assert_eq!(through(0.5), []);
    assert_eq!(through(1.5), [(3.0, true), (4.0, false)]);
}

#[test]
fn blind_pocket() {
    let t = trace("A-B", vec![plate(), cylinder(1.0, 0.5, 0.5)], [0.0, 0.1, -3.0], UP);
    assert_eq!(stops(&t), [(3.0, true), (3.5, false)]);
    assert_eq!((t.boundaries[1].id, t.boundaries[1].normal), (2, DVec3::Z));
}

#[test]
fn coincident_cylinders() {
    let two = || vec![cylinder(1.0, 0.0, 1.0), cylinder(1.0, -1.0, 3.0)];
    for (o, d) in lines(1, 500, 1.5) {
        assert_eq!(tracer("A-B", two()).trace(o, d).boundaries, []);
        let union = tracer("A+B", two()).trace(o, d).boundaries;
        let outer = tracer("B", two()).trace(o, d).boundaries;
        assert_eq!(union.len(), outer.len());
        // in another frame: the last digits differ
        assert!(union.iter().zip(&outer).all(|(a, b)| (a.t - b.t).abs() < 1e-14 && a.entering == b.entering));
    }
}

/// One cylinder in two forms, turned about its axis and stretched.
#[test]
fn the_same_cylinder_turned() {
    let turned = DAffine3::from_rotation_z(0.3) * DAffine3::from_scale(DVec3::new(2.0, 2.0, 3.0));
    let tilt = DAffine3::from_rotation_x(0.7);
    let one = placed(Shape::Cylinder { radius: 1.0, height: 3.0 }, tilt);
    let other = placed(Shape::Cylinder { radius: 0.5, height: 1.0 }, tilt * turned);
    for (o, d) in lines(2, 500, 2.0) {
        assert_eq!(tracer("A-B", vec![one.clone(), other.clone()]).trace(o, d).boundaries, []);
        assert_eq!(tracer("A^B", vec![one.clone(), other.clone()]).trace(o, d).boundaries, []);
    }
}

#[test]
fn touching_solids_share_nothing() {
    let cube = |x: f64, y: f64, z: f64| block([x, y, z], [x + 1.0, y + 1.0, z + 1.0]);
    for other in [cube(1.0, 0.0, 0.0), cube(1.0, 1.0, 0.0), cube(1.0, 1.0, 1.0)] {
        let t = tracer("AB", vec![cube(0.0, 0.0, 0.0), other]);
        for (o, d) in lines(3, 300, 2.0) {
            assert_eq!(t.trace(o, d).boundaries, []);
        }
        // along the shared edge, and through the shared vertex
        for (o, d) in [([1.0, 1.0, -2.0], UP), ([-1.0, -1.0, -1.0], [1.0; 3])] {
            assert_eq!(t.trace(o.into(), d.into()).boundaries, []);
        }
    }
    let union = trace("A+B", vec![cube(0.0, 0.0, 0.0), cube(1.0, 0.0, 0.0)], [-1.0, 0.3, 0.4], [1.0, 0.0, 0.0]);
    assert_eq!(stops(&union), [(1.0, true), (3.0, false)]);
}

#[test]
fn overlapping_tops_belong_to_the_first() {
    let tops = || vec![block([0.0; 3], [2.0, 2.0, 1.0]), block([1.0, 0.0, 0.5], [3.0, 2.0, 1.0])];
    let down = [0.0, 0.0, -1.0];
    for (x, owner) in [(0.5, 1), (1.5, 1), (2.5, 2)] {
        assert_eq!(trace("A+B", tops(), [x, 1.0, 5.0], down).first(0.0).unwrap().id, owner);
        assert_eq!(trace("B+A", tops(), [x, 1.0, 5.0], down).first(0.0).unwrap().id, if x > 1.0 { 2 } else { 1 });
    }
    // the floor of a pocket that is also another's top: the added one owns it
    let floor = vec![plate(), block([-1.0, -1.0, 0.5], [1.0; 3]), block([-1.0, -1.0, 0.0], [1.0, 1.0, 0.5])];
    assert_eq!(trace("A-B+C", floor, [0.0, 0.0, 5.0], down).first(0.0).unwrap().id, 3);
}

#[test]
fn solids_with_themselves() {
    let ball = || vec![sphere(1.0, 0.2)];
    for (o, d) in lines(4, 200, 1.5) {
        let whole = stops(&tracer("A", ball()).trace(o, d));
        for (text, expected) in [("A-A", &vec![]), ("AA", &whole), ("A+A", &whole), ("A!A", &vec![])] {
            assert_eq!(&stops(&tracer(text, ball()).trace(o, d)), expected, "{text}");
        }
        let all = tracer("A+!A", ball()).trace(o, d);
        assert!(all.inside_before && all.boundaries.is_empty());
    }
}

/// A rotated cube and its neighbour, with six digits kept as a text file would: one face, no slit.
#[test]
fn six_digits_keep_coplanar_faces_together() {
    let six = |x: f64| format!("{x:.5e}").parse::<f64>().unwrap();
    let rounded = |m: DAffine3| DAffine3::from_cols_array(&m.to_cols_array().map(six));
    let turn = DAffine3::from_quat(glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1));
    let pair = |gap: f64| {
        let part = |x: f64| {
            placed(Shape::Block { min: DVec3::ZERO, max: DVec3::splat(40.0) }, rounded(turn * at(x, 60.0, 110.0)))
        };
        SolidTracer::new(&solid("A+B", vec![part(0.0), part(40.0 + gap)]), SurfaceTable::ROUNDED).unwrap()
    };
    let across = |t: &SolidTracer, y: f64| {
        let o = turn.transform_point3(DVec3::new(-10.0, 60.0 + y, 130.0));
        t.trace(o, turn.matrix3.x_axis).boundaries.len()
    };
    for y in [1.0, 13.0, 39.0] {
        assert_eq!(across(&pair(0.0), y), 2);
        assert_eq!(across(&pair(0.01), y), 4, "a gap of 1e-4 of the model is open");
    }
}

#[test]
fn real_gaps_stay_open() {
    for gap in [1e-3, 1e-4, 1e-5] {
        let boxes = vec![block([0.0; 3], [1.0, 1.0, 1.0]), block([0.0, 0.0, 1.0 + gap], [1.0, 1.0, 2.0])];
        let whole = boxes.iter().map(Primitive::bounds).fold(crate::model::Bounds::EMPTY, |a, b| a.union(b));
        let scaled: Vec<_> = boxes
            .into_iter()
            .map(|b| Primitive { transform: DAffine3::from_scale(DVec3::splat(1.0 / whole.diagonal())), ..b })
            .collect();
        // the gap is `gap` of a model of diagonal 2.45; the tolerance for rounded files closes 4e-6 of it
        let t = SolidTracer::new(&solid("A+B", scaled), SurfaceTable::ROUNDED).unwrap();
        let expected = if gap / whole.diagonal() > SurfaceTable::ROUNDED { 4 } else { 2 };
        assert_eq!(t.trace(DVec3::new(0.1, 0.1, -1.0), DVec3::Z).boundaries.len(), expected);
        assert!(expected == 4 || gap < 1e-5 * whole.diagonal());
    }
}

#[test]
fn tangent_solids() {
    let along = |text: &str, all: Vec<Primitive>| stops(&trace(text, all, [-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]));
    let balls = || vec![sphere(1.0, -1.0), sphere(1.0, 1.0)];
    assert_eq!(along("A+B", balls()), [(1.0, true), (5.0, false)]);
    assert_eq!(along("AB", balls()), []);
    assert_eq!(along("A-B", balls()), [(1.0, true), (3.0, false)]);
    // a torus on its tangent plane: the line in that plane meets nothing
    let torus = placed(Shape::Torus { major: 3.0, minor: 1.0 }, at(0.0, 0.0, 1.0));
    let below = placed(Shape::HalfSpace { normal: DVec3::Z, offset: 0.0 }, DAffine3::IDENTITY);
    assert_eq!(stops(&trace("AB", vec![torus, below], [3.0, 0.0, -5.0], UP)), []);
}

#[test]
fn cone_apex_on_a_face() {
    let cone = placed(Shape::Cone { bottom: 1.0, top: 0.0, height: 1.0 }, at(0.0, 0.0, -1.0));
    let all = || vec![block([-1.0, -1.0, 0.0], [1.0; 3]), cone.clone()];
    assert_eq!(stops(&trace("A+B", all(), [0.0, 0.0, -3.0], UP)), [(2.0, true), (4.0, false)]);
    assert_eq!(stops(&trace("AB", all(), [0.0, 0.0, -3.0], UP)), []);
}

#[test]
fn nested_twenty_deep() {
    let mut b = Builder::new();
    let balls: Vec<Primitive> = (0..20).map(|i| sphere(20.0 - f64::from(i), 0.0)).collect();
    let mut root = b.leaf(19);
    for i in (0..19).rev() {
        let outer = b.leaf(i);
        root = b.pair(Op::Difference, outer, root);
    }
    let onion = Solid::new(balls, b.finish(root).unwrap()).unwrap();
    let t = SolidTracer::new(&onion, SurfaceTable::EXACT).unwrap().trace(DVec3::X * -30.0, DVec3::X);
    assert_eq!(t.boundaries.len(), 40);
    assert!((t.thickness(0.0, 60.0) - 20.0).abs() < 1e-12);
}

#[test]
fn thin_shells() {
    for thin in [1e-2, 1e-4, 1e-6] {
        let shell = tracer("A-B", vec![sphere(1.0, 0.0), sphere(1.0 - thin, 0.0)]);
        let through = shell.trace(DVec3::X * -3.0, DVec3::X);
        assert_eq!(through.boundaries.len(), 4);
        assert!((through.thickness(0.0, 6.0) - 2.0 * thin).abs() < 1e-14);
        // edge-on: halfway into the shell, a chord of 2 √(1 - (1 - thin/2)²)
        let height = 1.0 - 0.5 * thin;
        let grazing = shell.trace(DVec3::new(-3.0, height, 0.0), DVec3::X).thickness(0.0, 6.0);
        assert!((grazing - 2.0 * (1.0 - height * height).sqrt()).abs() < 1e-12);
    }
}

/// A line in a face shared by two blocks belongs to exactly one of them.
#[test]
fn lines_in_a_face() {
    let two = || vec![block([0.0; 3], [1.0; 3]), block([1.0, 0.0, 0.0], [2.0, 1.0, 1.0])];
    let along = |text: &str| stops(&trace(text, two(), [1.0, 0.5, -1.0], UP));
    assert_eq!(along("A+B"), [(1.0, true), (2.0, false)]);
    assert_eq!(along("AB"), []);
    let outer = stops(&trace("A", two(), [0.0, 0.5, -1.0], UP));
    assert!(outer.is_empty() || outer.len() == 2);
}

#[test]
fn camera_inside() {
    let t = trace("A-B", vec![sphere(3.0, 0.0), sphere(1.0, 0.0)], [0.0, 0.0, 0.0], UP);
    assert!(!t.inside(0.0) && t.inside(2.0) && !t.inside(3.5));
    assert!((t.first(0.0).unwrap().t - 1.0).abs() < 1e-15);
    assert!(t.first(1.5).is_none());
    // seen from within the solid the section is capped at the eye, and only the leaving crossing remains
    assert!((t.thickness(2.0, 9.0) - 1.0).abs() < 1e-14);
    // on a face
    assert_eq!(trace("A", vec![block([0.0; 3], [1.0; 3])], [0.5, 0.5, 0.0], UP).first(0.0).unwrap().t, 0.0);
}

#[test]
fn odd_transforms() {
    let own = |m: DAffine3| vec![placed(Shape::Sphere { radius: 1.0 }, m)];
    for scale in [1e-4, 1.0, 1e5] {
        let m = at(1e6, -1e6, 1e6) * DAffine3::from_scale(DVec3::splat(scale));
        let t = tracer("A", own(m)).trace(m.translation - DVec3::Z * 2.0 * scale, DVec3::Z);
        let found: Vec<f64> = t.boundaries.iter().map(|b| b.t / scale).collect();
        // rounding of the offset over the scale
        let tolerance = 1e-15 + 4e-10 / scale;
        assert!((found[0] - 1.0).abs() < tolerance && (found[1] - 3.0).abs() < tolerance, "{found:?}");
    }
    let mirrored = DAffine3::from_scale(DVec3::new(-1.0, 2.0, 0.5));
    let t = tracer("A", own(mirrored)).trace(DVec3::Z * -3.0, DVec3::Z);
    assert_eq!(stops(&t), [(2.5, true), (3.5, false)]);
    assert_eq!(t.boundaries[0].normal, DVec3::NEG_Z);
    for flat in
        [DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 1.0), DVec3::new(f64::INFINITY, 1.0, 1.0)]
    {
        let t = tracer("A", own(DAffine3::from_scale(flat))).trace(DVec3::Z * -3.0, DVec3::Z);
        assert_eq!(t, Trace::default(), "{flat}");
    }
    let sheared = DAffine3::from_mat3(glam::DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::X + DVec3::Y));
    assert_eq!(tracer("A", own(sheared)).trace(DVec3::Z * -3.0, DVec3::Z), Trace::default());
}

#[test]
fn unbounded_half_spaces() {
    let below = placed(Shape::HalfSpace { normal: DVec3::Z * 2.0, offset: 2.0 }, DAffine3::IDENTITY);
    let t = trace("A", vec![below.clone()], [0.0; 3], UP);
    assert_eq!((t.inside_before, stops(&t)), (true, vec![(1.0, false)]));
    let q = Quadric { linear: DVec3::Z, constant: -1.0, ..Quadric::default() };
    let same = placed(Shape::Quadric(q), DAffine3::IDENTITY);
    for (o, d) in lines(5, 100, 2.0) {
        assert_eq!(tracer("A^B", vec![below.clone(), same.clone()]).trace(o, d), Trace::default());
    }
}

#[test]
fn a_plate_with_a_thousand_holes() {
    let mut b = Builder::new();
    let mut all = vec![block([0.0; 3], [1001.0, 10.0, 1.0])];
    let mut root = b.leaf(0);
    for i in 1..=1000 {
        all.push(placed(Shape::Cylinder { radius: 0.25, height: 1.0 }, at(f64::from(i), 5.0, 0.0)));
        let hole = b.leaf(i);
        root = b.pair(Op::Difference, root, hole);
    }
    let plate = Solid::new(all, b.finish(root).unwrap()).unwrap();
    let table = SurfaceTable::new(&plate, SurfaceTable::EXACT);
    assert_eq!(table.surfaces().len(), 6 + 1000, "all tops and bottoms are two planes");
    let t = SolidTracer::new(&plate, SurfaceTable::EXACT).unwrap();
    assert_eq!(t.trace(DVec3::new(0.0, 5.0, 0.5) - DVec3::X, DVec3::X).boundaries.len(), 2002);
    assert!((t.trace(DVec3::new(-1.0, 5.0, 0.5), DVec3::X).thickness(0.0, 1e4) - 501.0).abs() < 1e-9);
    assert_eq!(t.trace(DVec3::new(500.0, 5.0, -1.0), DVec3::Z).boundaries.len(), 0);
}

fn inner(mesh: &Primitive) -> Mesh {
    let Shape::Mesh(mesh) = &mesh.shape else { unreachable!() };
    (**mesh).clone()
}

#[test]
fn meshes_of_all_kinds() {
    let cube = mesh_block([0.0; 3], [1.0; 3]);
    let exact = block([0.0; 3], [1.0; 3]);
    let good = inner(&cube);
    let with = |triangles: Vec<[u32; 3]>| {
        placed(
            Shape::Mesh(Arc::new(Mesh::new(1, good.positions().to_vec(), triangles, vec![]).unwrap())),
            DAffine3::IDENTITY,
        )
    };
    let inverted = with(good.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect());
    let doubled = with([good.triangles(), good.triangles()].concat());
    let slivers = with([good.triangles(), &[[0, 0, 1], [3, 3, 3], [2, 6, 2]]].concat());
    for mesh in [&cube, &inverted, &doubled, &slivers] {
        // coincident with the exact block on all sides: nothing is left
        let t = tracer("A^B", vec![exact.clone(), (*mesh).clone()]);
        for (o, d) in lines(6, 300, 1.2) {
            let found = t.trace(o, d);
            assert_eq!((found.boundaries.len(), found.leaks), (0, 0));
        }
    }
    // through vertices and along diagonals of faces
    for (o, d) in [([-1.0; 3], [1.0; 3]), ([0.5, 0.5, -1.0], UP), ([-1.0, -1.0, 0.5], [1.0, 1.0, 0.0])] {
        assert_eq!(trace("A", vec![cube.clone()], o, d).boundaries.len(), 2, "{o:?} {d:?}");
    }
    let open = with(good.triangles()[2..].to_vec());
    assert_eq!(trace("A", vec![open], [-1.0, 0.3, 0.4], [1.0, 0.0, 0.0]).leaks, 1);
}

/// A cube of six bilinear faces as a spline part, less a sphere.
#[test]
fn spline_parts() {
    let face = |(id, [o, a, b]): (u32, [[f64; 3]; 3])| {
        let (o, a, b) = (DVec3::from(o), DVec3::from(a), DVec3::from(b));
        let points = [o, o + a, o + b, o + a + b].map(|p| DVec4::from_point(p, 1.0)).to_vec();
        let knots = || vec![0.0, 0.0, 1.0, 1.0];
        let surface = Surface::new((1, 1), knots(), knots(), points).unwrap();
        Face { id, kind: SurfaceKind::Plane, surface, loops: vec![], same_sense: true, colour: None }
    };
    let (x, y, z, o) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], UP, [0.0; 3]);
    let faces = [[o, y, x], [z, x, y], [o, x, z], [y, z, x], [o, z, y], [x, y, z]];
    let faces = (1..).zip(faces).map(face).collect();
    let part = Part { faces, closed: true, ..Part::default() };
    let cube = placed(Shape::Part(Arc::new(part)), DAffine3::from_scale(DVec3::splat(2.0)));
    let exact = block([0.0; 3], [2.0; 3]);
    let ball = placed(Shape::Sphere { radius: 1.0 }, at(1.0, 1.0, 0.0));
    let spline = tracer("A-B", vec![cube, ball.clone()]);
    let reference = tracer("A-B", vec![exact, ball]);
    for (o, d) in lines(8, 300, 2.0) {
        let (a, b) = (spline.trace(o, d), reference.trace(o, d));
        assert_eq!(a.boundaries.len(), b.boundaries.len());
        for (a, b) in a.boundaries.iter().zip(&b.boundaries) {
            assert!((a.t - b.t).abs() < 1e-13 && (a.normal - b.normal).length() < 1e-12);
        }
    }
    let open = Part::default();
    let flat = placed(Shape::Part(Arc::new(open)), DAffine3::IDENTITY);
    assert!(Solid::new(vec![flat], crate::csg::Tree::leaf(0)).is_err());
}

#[test]
fn nothing_is_nothing() {
    let far = vec![sphere(1.0, -5.0), sphere(1.0, 5.0)];
    assert_eq!(trace("AB", far.clone(), [-9.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Trace::default());
    for d in [[0.0; 3], [f64::NAN; 3], [f64::INFINITY, 0.0, 0.0]] {
        assert_eq!(trace("A+B", far.clone(), [0.0; 3], d), Trace::default());
    }
}
