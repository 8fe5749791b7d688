//! Depth, normal and (u, v) images against closed forms.
//!
//! ```text
//!   eye ──── ray through the pixel's centre ────●──▶     ● by sphere tracing: steps of the exact
//!                                             ╱          distance, so that none passes the surface
//! ```
//!
//! Pixels whose ray passes within a pixel of a silhouette or a border are not compared: their surface may lie half a
//! pixel to the side. Source of the tracing: J. C. Hart, *Sphere tracing*, The Visual Computer 12, 1996.

use crate::shapes::{self, circle_at};
use crate::support::{assert_silent, orthographic, perspective, render, watched};
use glam::{DVec2, DVec3};
use selvedge::model::{Camera, Model};
use selvedge::picture::Picture;

const SIZE: (u32, u32) = (240, 180);
/// Size for polynomial patches, whose tracing takes longer.
const FIELD_SIZE: (u32, u32) = (128, 96);
/// Pixels seen at a smaller angle are judged by the reference renderer, not here: errors of depth grow with the
/// tangent.
const LEAST_COSINE: f64 = 0.1;
/// Pass `resolve` stops when the exact point projects this close to the pixel's centre; single precision adds about as
/// much again at this size.
const AIM_PX: f64 = 2e-3;

/// A surface in closed form.
struct Closed {
    /// Distance to the surface, or less; negative only inside a sphere or a torus.
    distance: fn(DVec3) -> f64,
    /// Unit outward normal near the surface.
    normal: fn(DVec3) -> DVec3,
    /// Point at (u, v).
    point: fn(DVec2) -> DVec3,
    /// Largest curvature, 1 over the smallest radius, or a larger number.
    curvature: f64,
    /// Whether the face contains the point of the surface, with this margin all around.
    inside: fn(DVec3, f64) -> bool,
}

const SPHERE: Closed = Closed {
    distance: |p| p.length() - shapes::SPHERE_RADIUS,
    normal: |p| p.normalize(),
    curvature: 1.0 / shapes::SPHERE_RADIUS,
    point: |uv| {
        let ((x, y), (r, z)) = (circle_at(uv.x), circle_at(uv.y));
        shapes::SPHERE_RADIUS * DVec3::new(x * r, y * r, z)
    },
    inside: |_, _| true,
};

const TORUS: Closed = Closed {
    distance: |p| (p - spine(p)).length() - shapes::TORUS_RADII.1,
    normal: |p| (p - spine(p)).normalize(),
    curvature: 1.0 / shapes::TORUS_RADII.1,
    point: |uv| {
        let ((x, y), (a, b)) = (circle_at(uv.x), circle_at(uv.y));
        let (major, minor) = shapes::TORUS_RADII;
        DVec3::new(x * (major + minor * a), y * (major + minor * a), minor * b)
    },
    inside: |_, _| true,
};

/// The nearest point of the torus' central circle.
fn spine(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.y, 0.0).normalize() * shapes::TORUS_RADII.0
}

const PLATE: Closed = Closed {
    distance: |p| p.z,
    normal: |_| DVec3::Z,
    curvature: 0.0,
    point: |uv| uv.extend(0.0),
    inside: |p, margin| {
        let (centre, radius) = shapes::PLATE_HOLE;
        p.truncate().abs().max_element() < shapes::PLATE_HALF - margin
            && p.truncate().distance(centre) > radius + margin
    },
};

const WAVE: Closed = Closed {
    // control points at most 3 apart in z, a step of 3 / 3 in x and in y
    distance: |p| above(p, (3, 3), shapes::wave_height, DVec2::new(3.0, 3.0)),
    normal: |p| upward(p, (3, 3), shapes::wave_height),
    // second differences of at most 6, times 3 * 2 / 3^2, in two directions
    curvature: 8.0,
    point: |uv| on_field(uv, (3, 3), shapes::wave_height),
    inside: on_square,
};

const RIPPLE: Closed = Closed {
    // 3.25 apart, a step of 3 / 6 in x and of 3 / 5 in y
    distance: |p| above(p, (6, 5), shapes::ripple_height, DVec2::new(6.5, 5.5)),
    normal: |p| upward(p, (6, 5), shapes::ripple_height),
    // second differences of at most 3, times 6 * 5 / 3^2, in two directions
    curvature: 20.0,
    point: |uv| on_field(uv, (6, 5), shapes::ripple_height),
    inside: on_square,
};

type Height = fn(usize, usize) -> f64;

/// `n! / k! (n - k)! t^k (1 - t)^(n - k)`, the definition.
fn bernstein(n: usize, k: usize, t: f64) -> f64 {
    let choose = (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    choose * t.powi(k as i32) * (1.0 - t).powi((n - k) as i32)
}

fn on_field(uv: DVec2, (n, m): (usize, usize), height: Height) -> DVec3 {
    let row = |j: usize| (0..=n).map(|i| bernstein(n, i, uv.x) * height(i, j)).sum::<f64>();
    (3.0 * uv).extend((0..=m).map(|j| bernstein(m, j, uv.y) * row(j)).sum())
}

/// A lower bound on the distance to the surface, from the largest slopes in x and y. There is no surface beside the
/// square; points within a thousandth of its sides are skipped.
fn above(p: DVec3, degrees: (usize, usize), height: Height, slopes: DVec2) -> f64 {
    let inside = p.truncate().clamp(DVec2::ZERO, DVec2::splat(3.0));
    let beside = p.truncate().distance(inside);
    if beside > 0.0 {
        return beside + 1e-3;
    }
    (p.z - on_field(inside / 3.0, degrees, height).z).abs() / (1.0 + slopes.length_squared()).sqrt()
}

/// Normal by central differences.
fn upward(p: DVec3, degrees: (usize, usize), height: Height) -> DVec3 {
    let step = 1e-5;
    let at = |dx: f64, dy: f64| on_field((p.truncate() + DVec2::new(dx, dy)) / 3.0, degrees, height);
    (at(step, 0.0) - at(-step, 0.0)).cross(at(0.0, step) - at(0.0, -step)).normalize()
}

fn on_square(p: DVec3, margin: f64) -> bool {
    let uv = p.truncate();
    uv.min_element() > margin && uv.max_element() < 3.0 - margin
}

impl Closed {
    /// First point of the surface along a ray.
    fn first_hit(&self, (origin, direction): (DVec3, DVec3), far: f64) -> Option<DVec3> {
        // a thousandth of the resolution of single precision at that depth
        let close = 1e-10 * far;
        let mut t = 0.0;
        while t < far {
            let p = origin + direction * t;
            let step = (self.distance)(p);
            if step < close {
                return Some(p);
            }
            t += step;
        }
        None
    }
}

/// Largest errors over the judged pixels.
#[derive(Debug, Default)]
struct Worst {
    judged: usize,
    /// Depth error, over the error from aiming `AIM_PX` beside the centre at this slope.
    depth: f64,
    /// Angle between the normals, over the angle from aiming `AIM_PX` beside the centre at this curvature.
    normal: f64,
    normal_deg: f64,
    /// Distance from the pixel's centre to the point at (u, v).
    uv_px: f64,
}

fn judge(shape: &Closed, camera: &Camera, picture: &Picture) -> Worst {
    let mut worst = Worst::default();
    let (_, _, forward) = camera.axes();
    let (width, height) = camera.size;
    let far = camera.depth_range.1 * 2.0;
    for (i, pixel) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).enumerate() {
        let centre = DVec2::new(f64::from(pixel.0) + 0.5, f64::from(pixel.1) + 0.5);
        let ray = |dx: f64, dy: f64| shape.first_hit(camera.ray(centre + DVec2::new(dx, dy)), far);
        // the pixel and its neighbours show one sheet of one face, or nothing
        let around = [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(x, y)| ray(x, y));
        let unit = around[0].map_or(0.0, |p| pixel_size(camera, p));
        let on = |p: &DVec3, margin: f64| (shape.inside)(*p, margin);
        if around.iter().all(|p| p.as_ref().is_none_or(|p| !on(p, -2.0 * pixel_size(camera, *p)))) {
            assert_eq!(picture.face[i], 0, "pixel {pixel:?} shows a face where there is none");
            continue;
        }
        let (_, direction) = camera.ray(centre);
        let cosine = |p: &DVec3| -(shape.normal)(*p).dot(direction);
        let grazing = |p: &DVec3| cosine(p) < LEAST_COSINE;
        let Some(p) = around[0] else { continue };
        // neighbouring pixels of one sheet are not farther apart, unless the sheet bends away
        let reach = 2.0 * unit / cosine(&p).max(LEAST_COSINE);
        let one_sheet = around.iter().all(|q| q.is_some_and(|q| !grazing(&q) && q.distance(p) < reach));
        if !one_sheet || !on(&p, reach) {
            continue;
        }
        assert_eq!(picture.face[i], 1, "pixel {pixel:?} shows no face");
        worst.judged += 1;

        let normal = (shape.normal)(p);
        let cosine = cosine(&p);
        let depth = (p - camera.eye).dot(forward);
        let slope = (1.0 - cosine * cosine).sqrt() / cosine;
        // without slope or curvature, the rounding of single precision remains
        let bound = AIM_PX * unit * slope + 4.0 * f64::from(f32::EPSILON) * depth;
        worst.depth = worst.depth.max((f64::from(picture.depth[i]) - depth).abs() / bound);

        let drawn = DVec3::from(picture.normal[i].map(f64::from));
        assert!((drawn.length() - 1.0).abs() < 1e-6, "pixel {pixel:?} has a normal of length {}", drawn.length());
        let angle = drawn.cross(normal).length().atan2(drawn.dot(normal));
        let bound = AIM_PX * unit / cosine * shape.curvature + 16.0 * f64::from(f32::EPSILON);
        worst.normal = worst.normal.max(angle / bound);
        worst.normal_deg = worst.normal_deg.max(angle.to_degrees());

        let uv = DVec2::from(picture.uv[i].map(f64::from));
        let (back, _) = camera.project((shape.point)(uv)).expect("in front of the eye");
        worst.uv_px = worst.uv_px.max(back.distance(centre));
    }
    worst
}

/// Length that one pixel covers at `p`.
fn pixel_size(camera: &Camera, p: DVec3) -> f64 {
    let (right, _, _) = camera.axes();
    let at = |p: DVec3| camera.project(p).map_or(0.0, |(pixel, _)| pixel.x);
    let step = 1e-6 * camera.depth_range.1;
    step / (at(p + right * step) - at(p))
}

fn check(model: &Model, shape: &Closed, cameras: [Camera; 2]) {
    let mut renderer = watched(model);
    for camera in cameras {
        let picture = render(&mut renderer, &camera);
        let worst = judge(shape, &camera, &picture);
        assert!(worst.judged > 500, "{worst:?}");
        assert!(worst.depth < 1.0, "{worst:?}");
        assert!(worst.normal < 1.0 && worst.normal_deg < 0.1, "{worst:?}");
        assert!(worst.uv_px < AIM_PX, "{worst:?}");
    }
    assert_silent(renderer);
}

/// Both projections.
fn cameras(model: &Model) -> [Camera; 2] {
    [perspective(model, SIZE), orthographic(model, SIZE)]
}

/// Both projections from almost above, where hills hide few others.
fn from_above(model: &Model) -> [Camera; 2] {
    let tilted = DVec3::new(0.3, -0.4, 1.0).normalize();
    [perspective(model, FIELD_SIZE), orthographic(model, FIELD_SIZE)]
        .map(|camera| Camera { eye: camera.target + tilted * camera.eye.distance(camera.target), ..camera })
}

#[test]
fn a_sphere() {
    let model = shapes::sphere();
    check(&model, &SPHERE, cameras(&model));
}

#[test]
fn a_torus() {
    let model = shapes::torus();
    check(&model, &TORUS, cameras(&model));
}

#[test]
fn a_plate_with_a_hole() {
    let model = shapes::plate();
    check(&model, &PLATE, cameras(&model));
}

#[test]
fn a_bicubic_wave() {
    let model = shapes::wave();
    check(&model, &WAVE, from_above(&model));
}

#[test]
fn a_ripple_of_degrees_6_and_5() {
    let model = shapes::ripple();
    check(&model, &RIPPLE, from_above(&model));
}
