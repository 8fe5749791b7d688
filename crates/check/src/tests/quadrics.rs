//! Spheres, cylinders, tori and planes: all hits of a ray against the roots of its equation.

use super::shapes::*;
use crate::model::Camera;
use crate::{Hit, Tracer};
use glam::{DAffine3, DQuat, DVec2, DVec3};

/// Real roots of a polynomial (coefficients from the constant up) inside `[a, b]`: between neighbouring
/// extrema it is monotone, and bisection ends at the nearest `f64`.
fn roots(p: &[f64], a: f64, b: f64) -> Vec<f64> {
    if p.len() < 2 {
        return vec![];
    }
    let value = |x: f64| p.iter().rev().fold(0.0, |s, c| s * x + c);
    let slope: Vec<f64> = p.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect();
    let mut stops = vec![a];
    stops.extend(roots(&slope, a, b));
    stops.push(b);
    let bracket = |w: &[f64]| {
        let (mut lo, mut hi) = (w[0], w[1]);
        let rising = value(hi) > 0.0;
        if (value(lo) > 0.0) == rising {
            return None;
        }
        for _ in 0..200 {
            let m = 0.5 * (lo + hi);
            if (value(m) > 0.0) == rising { hi = m } else { lo = m }
        }
        Some(0.5 * (lo + hi))
    };
    stops.windows(2).filter_map(bracket).collect()
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut c = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            c[i + j] += x * y;
        }
    }
    c
}

/// Ray parameters, measured from the point of the ray nearest to the origin, where `equation` (as
/// polynomial coefficients of that parameter) vanishes; and the depth of that point.
fn expected(camera: &Camera, pixel: DVec2, equation: impl Fn(DVec3, DVec3) -> Vec<f64>) -> Vec<f64> {
    let (o, d) = camera.ray(pixel);
    let start = -o.dot(d);
    let cosine = d.dot(camera.axes().2);
    let near = o + d * start;
    let (_, _, forward) = camera.axes();
    roots(&equation(near, d), -4.0, 4.0).iter().map(|t| (near - camera.eye).dot(forward) + t * cosine).collect()
}

/// Hits and roots agree in number, and in depth within 1e-13 over the cosine at the hit.
fn compare(tracer: &Tracer, camera: &Camera, pixel: DVec2, equation: impl Fn(DVec3, DVec3) -> Vec<f64>) -> Vec<Hit> {
    let hits = tracer.hits(camera, pixel);
    let truth = expected(camera, pixel, equation);
    assert_eq!(hits.len(), truth.len(), "pixel {pixel}: {hits:#?} against {truth:?}");
    for (hit, depth) in hits.iter().zip(&truth) {
        let cosine = hit.normal.dot(camera.ray(pixel).1).abs();
        let bound = 1e-13 / cosine.max(1e-6);
        assert!((hit.depth - depth).abs() <= bound, "pixel {pixel}: {} is off by {:e}", hit.depth, hit.depth - depth);
    }
    assert_eq!(tracer.first(camera, pixel).map(|h| h.depth), hits.first().map(|h| h.depth));
    hits
}

/// A grid over the whole picture, pixel centres and corners.
fn grid(camera: &Camera) -> impl Iterator<Item = DVec2> + use<> {
    let (w, h) = camera.size;
    (0..h * 2).flat_map(move |y| (0..w * 2).map(move |x| DVec2::new(f64::from(x), f64::from(y)) * 0.5))
}

fn sphere_equation(p: DVec3, d: DVec3) -> Vec<f64> {
    vec![p.length_squared() - 1.0, 2.0 * p.dot(d), d.length_squared()]
}

#[test]
fn a_sphere_is_met_twice_or_not_at_all() {
    let tracer = Tracer::new(&single(sphere()));
    // the last two look along the axis through both poles, and along the seam
    for eye in [DVec3::new(2.0, 1.5, 1.1), DVec3::new(0.0, 0.0, 3.0), DVec3::new(3.0, 0.0, 0.0)] {
        for camera in [view(eye), parallel(eye)] {
            let mut total = 0;
            for pixel in grid(&camera) {
                for hit in compare(&tracer, &camera, pixel, sphere_equation) {
                    assert!((hit.normal - hit.point).length() < 2e-5, "{hit:?}");
                    total += 1;
                }
            }
            assert!(total > 5000);
        }
    }
    assert_eq!(tracer.given_up(), 0);
}

#[test]
fn rays_that_graze_a_sphere() {
    let tracer = Tracer::new(&single(sphere()));
    let mut random = noise(7);
    for case in 0..300 {
        let direction = DVec3::new(random(), random(), random()).normalize();
        let across = direction.cross(DVec3::new(random(), random(), random())).normalize();
        let gap = 10f64.powi(-(case % 12) - 1);
        for (sign, count) in [(1.0, 0), (-1.0, 2)] {
            let camera = aimed(across * (1.0 + sign * gap), direction);
            let hits = tracer.hits(&camera, MIDDLE);
            assert_eq!(hits.len(), count, "case {case}, gap {gap:e}: {hits:#?}");
            let half = (1.0 - (1.0 - gap).powi(2)).sqrt();
            for (hit, side) in hits.iter().zip([-1.0, 1.0]) {
                // the eye is placed to 1e-15, which moves the roots by that over the slope
                assert!((hit.depth - 5.0 - side * half).abs() < 5e-15 / half, "gap {gap:e}: {hit:?}");
            }
        }
        // exactly tangent: rounding decides whether it is met, but never more than twice
        assert!(tracer.hits(&aimed(across, direction), MIDDLE).len() <= 2);
    }
    assert_eq!(tracer.given_up(), 0);
}

#[test]
fn a_pole_is_one_hit() {
    let tracer = Tracer::new(&single(sphere()));
    let mut random = noise(3);
    for k in 0..200 {
        let pole = DVec3::Z * if k % 2 == 0 { 1.0 } else { -1.0 };
        // at the pole to the last bit, and at distances from 1e-1 to 1e-15 from it
        let off = if k % 4 < 2 { 0.0 } else { 10f64.powf(-15.0 * f64::from(k) / 200.0) };
        let through = (pole + DVec3::new(random(), random(), 0.0).normalize() * off).normalize();
        let direction = (-pole + 0.7 * DVec3::new(random(), random(), 0.0)).normalize();
        let hits = tracer.hits(&aimed(through, direction), MIDDLE);
        assert_eq!(hits.len(), 2, "distance {off:e}: {hits:#?}");
        assert!((hits[0].depth - 5.0).abs() < 1e-14 && (hits[0].point - through).length() < 1e-14);
        assert!((hits[0].normal - through).length() < 1e-5, "{:?}", hits[0]);
    }
    assert_eq!(tracer.given_up(), 0);
}

#[test]
fn a_cylinder_and_its_own_direction() {
    let tracer = Tracer::new(&single(cylinder()));
    let equation = |p: DVec3, d: DVec3| {
        let (p, d) = (p.truncate(), d.truncate());
        vec![p.length_squared() - 1.0, 2.0 * p.dot(d), d.length_squared()]
    };
    let camera = view(DVec3::new(3.0, 1.0, 0.3));
    let (mut twice, mut once) = (0, 0);
    for pixel in grid(&camera) {
        let (o, d) = camera.ray(pixel);
        let (_, _, forward) = camera.axes();
        let height = |depth: f64| o.z + d.z * depth / d.dot(forward);
        let truth: Vec<f64> =
            expected(&camera, pixel, equation).into_iter().filter(|&t| height(t).abs() < 1.0).collect();
        let hits = tracer.hits(&camera, pixel);
        assert_eq!(hits.len(), truth.len(), "{pixel}");
        for (hit, depth) in hits.iter().zip(&truth) {
            let cosine = hit.normal.dot(d).abs();
            assert!((hit.depth - depth).abs() < 1e-13 / cosine, "{pixel}: {:e}", hit.depth - depth);
        }
        twice += usize::from(hits.len() == 2);
        once += usize::from(hits.len() == 1);
    }
    assert!(twice > 1000 && once > 100);
    // along the axis: rays inside the wall are no hits, and take no time
    for angle in 0..64 {
        let wall = DVec2::from_angle(f64::from(angle) * 0.1).extend(0.0);
        assert!(tracer.hits(&aimed(wall, DVec3::Z), MIDDLE).len() <= 1);
    }
    assert_eq!(tracer.given_up(), 0);
}

#[test]
fn a_torus_is_met_up_to_four_times() {
    let (major, minor) = (1.0, 0.4);
    let tracer = Tracer::new(&single(torus(major, minor)));
    // (|x|² + R² - r²)² = 4 R² (x² + y²)
    let equation = |p: DVec3, d: DVec3| {
        let a = [p.length_squared() + major * major - minor * minor, 2.0 * p.dot(d), d.length_squared()];
        let (q, e) = (p.truncate(), d.truncate());
        let b = [q.length_squared(), 2.0 * q.dot(e), e.length_squared()];
        let mut sum = times(&a, &a);
        sum.iter_mut().zip(b).for_each(|(s, b)| *s -= 4.0 * major * major * b);
        sum
    };
    let mut four = 0;
    for eye in [DVec3::new(2.6, 1.0, 0.6), DVec3::new(0.3, 0.2, 2.5), DVec3::new(3.0, 0.0, 0.0)] {
        let camera = view(eye);
        for pixel in grid(&camera) {
            let hits = tracer.hits(&camera, pixel);
            let truth = expected(&camera, pixel, equation);
            // where two roots of a quartic meet it holds them to 1e-8 only, or loses both
            let grazing = |h: &Hit| h.normal.dot(camera.ray(pixel).1).abs() < 1e-4;
            if hits.iter().any(grazing) {
                continue;
            }
            assert_eq!(hits.len(), truth.len(), "eye {eye}, pixel {pixel}: {hits:#?} against {truth:?}");
            for (hit, depth) in hits.iter().zip(&truth) {
                let cosine = hit.normal.dot(camera.ray(pixel).1).abs();
                assert!((hit.depth - depth).abs() < 1e-13 / (cosine * cosine), "{:e}", hit.depth - depth);
                let ring = hit.point.truncate().length() - major;
                assert!((ring.hypot(hit.point.z) - minor).abs() < 4e-15);
            }
            four += usize::from(hits.len() == 4);
        }
    }
    assert!(four > 1000);
    assert_eq!(tracer.given_up(), 0);
}

#[test]
fn a_plane_with_a_round_hole() {
    let plane = rectangle(DVec3::new(-1.0, -1.0, 0.2), DVec3::X * 2.0, DVec3::Y * 2.0);
    let border = polygon(&[DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]);
    let holed = face(7, plane, vec![border, hole(DVec2::new(0.5, 0.5), 0.25)]);
    let tracer = Tracer::new(&model(vec![holed], &[DAffine3::IDENTITY]));
    let camera = view(DVec3::new(0.4, -1.0, 3.0));
    let mut seen = 0;
    for pixel in grid(&camera) {
        let (o, d) = camera.ray(pixel);
        let p = o + d * ((0.2 - o.z) / d.z);
        let (radius, edge) = (p.truncate().length(), p.truncate().abs().max_element());
        let inside = edge < 1.0 && radius > 0.5;
        let hits = tracer.hits(&camera, pixel);
        assert_eq!(hits.len(), usize::from(inside), "at {p}");
        if let Some(hit) = hits.first() {
            assert!((hit.point - p).length() < 1e-14 && hit.normal == DVec3::Z && hit.face == 7);
            assert!((hit.uv - (p.truncate() + 1.0) * 0.5).length() < 1e-14);
            seen += 1;
        }
    }
    assert!(seen > 2000);
}

#[test]
fn instances_are_rays_in_part_space() {
    let turn = DQuat::from_rotation_x(0.7) * DQuat::from_rotation_z(1.3);
    let far = DVec3::new(1e4, -2e4, 3e4);
    let mirrored = DAffine3::from_scale_rotation_translation(DVec3::new(-1.5, 0.5, 0.8), turn, far);
    let mut squashed = face(3, sphere(), vec![]);
    squashed.same_sense = true;
    let tracer = Tracer::new(&model(vec![squashed], &[DAffine3::from_translation(DVec3::X * 9.0), mirrored]));
    let mut camera = view(DVec3::new(1.0, 2.0, 4.0));
    (camera.eye, camera.target) = (camera.eye + far, far);
    let inverse = mirrored.inverse();
    let mut seen = 0;
    for pixel in grid(&camera).step_by(7) {
        let (o, d) = camera.ray(pixel);
        let truth = {
            let (p, d) = (inverse.transform_point3(o), inverse.transform_vector3(d));
            roots(&sphere_equation(p, d), 0.0, 20.0)
        };
        let hits = tracer.hits(&camera, pixel);
        assert_eq!(hits.len(), truth.len());
        for (hit, t) in hits.iter().zip(&truth) {
            // coordinates of 4e4 leave 1e-11 of the parameter
            assert!((o + d * *t - hit.point).length() < 1e-9);
            assert_eq!((hit.instance, hit.part, hit.face_index), (1, 0, 0));
            let outward = hit.normal.dot(hit.point - far);
            assert!(outward > 0.3, "a mirror image keeps its outside: {outward}");
            seen += 1;
        }
    }
    assert!(seen > 500);
}
