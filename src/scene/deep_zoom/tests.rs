use super::*;
use crate::fixtures::Random;
use crate::model::{Projection, SurfaceKind};
use crate::spline::{Bezier, Control, Surface};
use glam::DAffine3;

/// A loop of three cubic curves with random control points.
fn random_loop(r: &mut Random) -> TrimLoop {
    let mut point = || DVec3::from_point(DVec2::new(r.range(-1.0, 2.0), r.range(-1.0, 2.0)), r.range(0.5, 2.0));
    let mut points: Vec<DVec3> = (0..9).map(|_| point()).collect();
    points.push(points[0]);
    let curves = points.windows(4).step_by(3).map(|w| Bezier { points: w.to_vec() }).collect();
    TrimLoop::new(curves, DVec2::ZERO).unwrap()
}

/// Within windows from the size of the loop down to a millionth, most at a point of the loop.
/// Every instance is shown.
fn all_of(model: &Model) -> Vec<Shown> {
    vec![Shown::default(); model.instances.len()]
}

#[test]
fn a_clipped_loop_winds_alike_in_the_window() {
    let mut r = Random::new(3);
    let (mut crossed, mut odd) = (0, 0);
    for round in 0..300 {
        let whole = random_loop(&mut r);
        let size = 10f64.powf(-r.range(0.0, 6.0));
        let curve = whole.curves().nth(round % 3).unwrap();
        let at = curve.point(r.range(0.0, 1.0)) + DVec2::new(r.range(-0.7, 0.7), r.range(-0.7, 0.7)) * size;
        let (lo, hi) = (at - size / 2.0, at + size / 2.0);
        let index = LoopIndex::new(std::slice::from_ref(&whole));
        let clipped = loops::clipped(&whole, lo, hi);
        crossed += u32::from(index.classify(lo, hi) == RectSide::Boundary);
        if let Some(l) = &clipped {
            let (a, b) = l.bounds();
            assert!(a.cmpge(lo - 1.01 * size).all() && b.cmple(hi + 1.01 * size).all(), "{a} {b} about {lo} {hi}");
        }
        let near = clipped.map(|l| LoopIndex::new(&[l]));
        for _ in 0..50 {
            let p = DVec2::new(r.range(lo.x, hi.x), r.range(lo.y, hi.y));
            let expected = index.winding(p);
            assert_eq!(near.as_ref().map_or(0, |i| i.winding(p)), expected, "round {round}, {p} in {lo} {hi}");
            odd += u32::from(expected != 0);
        }
    }
    assert!(crossed > 150 && odd > 3000, "{crossed} windows are crossed, {odd} points are inside");
}

/// A quadratic-by-cubic surface of four by two patches, with a hole.
fn wavy() -> Model {
    let points = (0..5).flat_map(|j| (0..6).map(move |i| (f64::from(i), f64::from(j))));
    let points = points.map(|(x, y)| DVec4::new(x, y, (x * 1.7).sin() + (y * 2.3).cos(), 1.0)).collect();
    let knots = |n: usize, inner: &[f64]| [&vec![0.0; n + 1], inner, &vec![1.0; n + 1]].concat();
    let surface = Surface::new((2, 3), knots(2, &[0.3, 0.5, 0.8]), knots(3, &[0.4]), points).unwrap();
    let square = |a: f64, b: f64| {
        let corners = [(a, a), (b, a), (b, b), (a, b), (a, a)].map(|(x, y)| DVec2::new(x, y));
        TrimLoop::new(corners.windows(2).map(|w| Bezier::line(w[0], w[1])).collect(), DVec2::ZERO).unwrap()
    };
    let loops = vec![square(0.0, 1.0), square(0.6, 0.7).reversed()];
    let face = Face { id: 7, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None };
    let instance = Instance {
        part: 0,
        transform: DAffine3::from_translation(DVec3::new(1e6, -2e6, 3e5)),
        colour: None,
        name: String::new(),
    };
    Model {
        parts: vec![Part { faces: vec![face], closed: true, ..Part::default() }],
        instances: vec![instance],
        ..Model::default()
    }
}

/// A camera that looks at the point at (u, v) from `distance`.
fn camera(model: &Model, uv: DVec2, distance: f64) -> Camera {
    let target = model.instances[0].transform.transform_point3(model.parts[0].faces[0].surface.jet(uv.x, uv.y).point);
    Camera {
        eye: target + DVec3::new(0.3, -0.5, 1.0).normalize() * distance,
        target,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.6 },
        depth_range: (distance * 0.1, 100.0),
        size: (800, 600),
    }
}

#[test]
fn an_ordinary_view_keeps_the_model() {
    let model = wavy();
    assert_eq!(
        DeepZoom::new(&model).of(&model, &all_of(&model), &camera(&model, DVec2::splat(0.5), 10.0)),
        DeepZoomUpload::Same
    );
}

/// At (u, v) in the picture lies a small enough window whose surface is the face's, and the windows are few.
#[test]
fn windows_cover_what_is_seen() {
    let model = wavy();
    let face = &model.parts[0].faces[0];
    let mut deep_zoom = DeepZoom::new(&model);
    let mut r = Random::new(9);
    for distance in [1e-2, 1e-4, 1e-6] {
        for uv in [DVec2::new(0.45, 0.2), DVec2::new(0.5, 0.4), DVec2::new(0.6, 0.65), DVec2::new(0.0, 1.0)] {
            let camera = camera(&model, uv, distance);
            let DeepZoomUpload::Cut(cut) = deep_zoom.of(&model, &all_of(&model), &camera) else {
                panic!("too close for single precision")
            };
            let near = &cut.model;
            let faces: Vec<&Face> = near.parts.iter().flat_map(|p| &p.faces).collect();
            assert!(!faces.is_empty() && faces.len() < 40, "{} windows from {distance}", faces.len());
            assert!(near.parts.iter().all(|p| p.closed) && faces.iter().all(|f| f.id == 7 && f.same_sense));
            let mut seen = 0;
            for _ in 0..400 {
                let off = DVec2::new(r.range(-1.0, 1.0), r.range(-1.0, 1.0)) * distance;
                let p = (uv + off * 0.1).clamp(DVec2::ZERO, DVec2::ONE);
                let point = face.surface.jet(p.x, p.y).point;
                let placed = model.instances[0].transform.transform_point3(point);
                let Some((pixel, _)) = camera.project(placed) else { continue };
                if pixel.clamp(DVec2::ZERO, DVec2::new(800.0, 600.0)) != pixel {
                    continue;
                }
                seen += 1;
                let inside = |f: &&&Face| {
                    let ((u0, u1), (v0, v1)) = f.surface.domain();
                    (u0..=u1).contains(&p.x) && (v0..=v1).contains(&p.y)
                };
                let windows: Vec<_> = faces.iter().filter(inside).collect();
                let kept = LoopIndex::new(&face.loops).contains(p);
                let drawn = windows.iter().any(|f| LoopIndex::new(&f.loops).contains(p));
                assert_eq!(drawn, kept, "{p} from {distance}");
                for f in windows {
                    // some roundings of coordinates up to 5, at parameters that differ by 1e-9 of the domain
                    assert!(f.surface.jet(p.x, p.y).point.distance(point) < 1e-13);
                }
            }
            assert!(seen > 50, "only {seen} points are in the picture");
        }
    }
}

/// Adjacent windows overlap by a small share of their width; all of them draw the overlap.
#[test]
fn windows_overlap_by_little() {
    let model = wavy();
    let DeepZoomUpload::Cut(cut) =
        DeepZoom::new(&model).of(&model, &all_of(&model), &camera(&model, DVec2::splat(0.5), 1e-4))
    else {
        panic!("too close for single precision")
    };
    let domains = cut.model.parts.iter().flat_map(|p| &p.faces).map(|f| <[_; 2]>::from(f.surface.domain()));
    let meeting: Vec<_> = domains.filter(|d| d.iter().all(|(from, to)| (*from..=*to).contains(&0.5))).collect();
    assert!(meeting.len() > 1, "{meeting:?}");
    for domain in meeting {
        let reach = domain.map(|(from, to)| (0.5 - from).min(to - 0.5) / (to - from));
        let least = reach[0].min(reach[1]);
        // 64 of 4,096 to 8,192 pixels
        assert!(least > 1.0 / 256.0 && least < 1.0 / 32.0, "{least} of {domain:?}");
    }
}

/// A close view that moves by a pixel reuses the cut, unless it leaves its cell of eyes or axes. The cut serves the new
/// view.
#[test]
fn a_view_that_hardly_moves_keeps_what_was_cut() {
    let model = wavy();
    let mut deep_zoom = DeepZoom::new(&model);
    let whole = camera(&model, DVec2::splat(0.5), 10.0);
    let start = camera(&model, DVec2::new(0.45, 0.2), 1e-3);
    assert_eq!(deep_zoom.of(&model, &all_of(&model), &whole), DeepZoomUpload::Same);
    let mut told = [0; 2]; // views that the last cut serves; views with a new cut
    for step in 0..100 {
        let by = DVec3::new(1.0, 0.5, 0.0) * 1e-3 * 0.6 / 600.0 * f64::from(step);
        let moved = Camera { eye: start.eye + by, target: start.target + by, ..start };
        match deep_zoom.of(&model, &all_of(&model), &moved) {
            DeepZoomUpload::Same => told[0] += 1,
            DeepZoomUpload::Whole => panic!("too close for single precision"),
            DeepZoomUpload::Cut(cut) => {
                told[1] += 1;
                assert_eq!(cut.extents.len(), cut.model.parts.len());
                assert_eq!(
                    DeepZoom::new(&model).of(&model, &all_of(&model), &moved),
                    DeepZoomUpload::Cut(cut),
                    "what was drawn before counts"
                );
            }
        }
    }
    assert!(told[0] >= 80 && told[1] >= 1, "{told:?}");
    deep_zoom.forget();
    assert!(matches!(deep_zoom.of(&model, &all_of(&model), &start), DeepZoomUpload::Cut(_)));
    assert_eq!(deep_zoom.of(&model, &all_of(&model), &whole), DeepZoomUpload::Whole);
    assert_eq!(deep_zoom.of(&model, &all_of(&model), &whole), DeepZoomUpload::Same);
}

/// A window ends where the surface does, or says that the surface goes on.
#[test]
fn windows_say_where_the_surface_goes_on() {
    let model = wavy();
    let mut ends = [0; 2]; // of the surface; of windows
    for uv in [DVec2::new(0.45, 0.2), DVec2::new(0.0, 1.0)] {
        let camera = camera(&model, uv, 1e-4);
        let DeepZoomUpload::Cut(cut) = DeepZoom::new(&model).of(&model, &all_of(&model), &camera) else {
            panic!("too close for single precision")
        };
        for (source, part) in cut.sources.iter().zip(&cut.model.parts) {
            assert_eq!(source.goes_on.len(), part.faces.len());
            for (sides, face) in source.goes_on.iter().zip(&part.faces) {
                let ((u0, u1), (v0, v1)) = face.surface.domain();
                let borders = [abi::BORDER_U0, abi::BORDER_U1, abi::BORDER_V0, abi::BORDER_V1];
                for (border, is_inside) in borders.into_iter().zip([u0 > 0.0, u1 < 1.0, v0 > 0.0, v1 < 1.0]) {
                    assert_eq!(sides & border != 0, is_inside);
                    ends[usize::from(is_inside)] += 1;
                }
            }
        }
    }
    assert!(ends[0] > 0 && ends[1] > 4, "{ends:?}");
}
