//! Bodies before each other: lines end where others cross them.

use super::*;
use crate::EdgeTracer;
use crate::Visibility;
use crate::drawing::LineSource;
use selvedge_geometry::construct::shapes;

fn boxes() -> Model {
    let back = shapes::block(DVec3::new(-0.8, 0.5, -0.6), DVec3::new(0.8, 1.0, 0.7)).unwrap().part;
    let front = shapes::block(DVec3::new(-0.3, -1.0, -0.9), DVec3::new(0.35, -0.4, 0.4)).unwrap().part;
    placed(vec![(back, DAffine3::IDENTITY), (front, DAffine3::from_rotation_z(0.3))])
}

/// Where two segments of the picture cross.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let (u, v) = (b - a, d - c);
    let cross = u.perp_dot(v);
    let (s, t) = ((c - a).perp_dot(v) / cross, (c - a).perp_dot(u) / cross);
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a + u * s)
}

/// All ends of lines are corners, or crossings of edges of one box with edges of the other.
#[test]
fn lines_end_at_corners_and_crossings() {
    let model = boxes();
    for camera in [parallel(DVec3::new(1.0, -3.0, 1.2), 4.0), perspective(DVec3::new(1.0, -3.6, 1.4))] {
        let drawing = drawn(&model, &camera);
        let tracer = Tracer::new(&model);
        let edges = EdgeTracer::new(&model, &tracer).unwrap();
        let segments = |instance: usize| -> Vec<[DVec2; 2]> {
            let i = &model.instances[instance];
            let part = &edges.parts()[i.part];
            let of = |v: usize| pixel(&camera, i.transform.transform_point3(part.vertices[v]));
            part.edges.iter().map(|e| e.ends.map(of)).collect()
        };
        let (back, front) = (segments(0), segments(1));
        let corners = back.iter().chain(&front).flatten().copied();
        let junctions = back.iter().flat_map(|a| front.iter().filter_map(|b| crossing(*a, *b)));
        let wanted: Vec<DVec2> = corners.chain(junctions.clone()).collect();
        let mut used = 0;
        for line in &drawing.lines {
            for end in [line.curves[0][0], line.curves[line.curves.len() - 1][3]] {
                let off = wanted.iter().map(|w| w.distance(end)).fold(f64::INFINITY, f64::min);
                assert!(off <= END, "{end} of {:?} is {off} px from any", line.source);
                used += usize::from(junctions.clone().any(|j| j.distance(end) <= END));
            }
        }
        // the outline of the front box crosses that of the other twice at least, and two lines end there
        assert!(used >= 4, "{used} ends at junctions");
    }
}

/// On either side of an end, a twentieth of a pixel from it, exact rays say what the lines say.
#[test]
fn rays_agree_on_both_sides_of_every_end() {
    let model = boxes();
    let camera = perspective(DVec3::new(1.0, -3.6, 1.4));
    let drawing = drawn(&model, &camera);
    let tracer = Tracer::new(&model);
    let edges = EdgeTracer::new(&model, &tracer).unwrap();
    let mut probe = tracer.probe(&camera);
    let mut asked = 0;
    for line in &drawing.lines {
        let LineSource::Edge { instance, edge } = line.source else { panic!("{:?}", line.source) };
        let i = &model.instances[instance];
        let piece = &edges.parts()[i.part].edges[edge].curve[0].piece;
        let [from, to] = [0.0, 1.0].map(|t| i.transform.transform_point3(piece.point(t)));
        let c = &line.curves[0];
        let towards = (c[3] - c[0]).normalize();
        for (end, inwards) in [(c[0], towards), (c[3], -towards)] {
            for (beside, hidden) in [(END, line.hidden), (-END, !line.hidden)] {
                let wanted = end + inwards * beside;
                // the point of the edge in space that the picture has there
                let (mut a, mut b) = (0.0, 1.0);
                let along = pixel(&camera, to) - pixel(&camera, from);
                for _ in 0..60 {
                    let middle = 0.5 * (a + b);
                    let at = pixel(&camera, from.lerp(to, middle));
                    if (at - wanted).dot(along) < 0.0 { a = middle } else { b = middle }
                }
                if !(1e-9..1.0 - 1e-9).contains(&a) {
                    continue; // beyond the edge
                }
                let seen = edges.visibility(instance, edge, from.lerp(to, a), &mut probe);
                let said = if hidden { Visibility::Hidden } else { Visibility::Visible };
                assert_eq!(seen, said, "{beside} px from {end} of {:?}", line.source);
                asked += 1;
            }
        }
    }
    assert!(asked > 40, "{asked}");
}

/// Ends inside of a face that passes through another: found by bisection, no lines cross there.
#[test]
fn an_edge_that_enters_a_face_ends_there() {
    let plate = super::super::shapes::rectangle(DVec3::new(-1.0, -1.0, 0.0), DVec3::X * 2.0, DVec3::Y * 2.0);
    let plate = Part { faces: vec![super::super::shapes::face(1, plate, vec![])], ..Part::default() };
    let pin = shapes::block(DVec3::new(-0.2, -0.2, -0.5), DVec3::new(0.2, 0.2, 0.5)).unwrap().part;
    let model = placed(vec![(plate, DAffine3::IDENTITY), (pin, DAffine3::IDENTITY)]);
    let camera = parallel(DVec3::new(1.0, -2.0, 1.5), 3.0);
    let drawing = drawn(&model, &camera);
    // the three upright edges that the eye sees go down to the plate
    for (x, y) in [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2)] {
        let wanted = [0.5, 0.0].map(|z| pixel(&camera, DVec3::new(x, y, z)));
        let found = strokes(&drawing, LineKind::Sharp, false).iter().any(|s| {
            let [a, b] = ends(s);
            a.distance(wanted[0]).max(b.distance(wanted[1])).min(a.distance(wanted[1]).max(b.distance(wanted[0])))
                <= END
        });
        assert!(found, "{wanted:?}");
    }
}
