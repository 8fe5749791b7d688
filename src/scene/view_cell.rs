//! One trim table for all views of a part of the model from near by.
//!
//! ```text
//!    ╲ wider ╲        view      ╱ wider ╱        eye   in a cell of a lattice, as wide as a share of the picture
//!     ╲   ╲                    ╱   ╱                   where the nearest thing is that it shows
//!      ╲     ╲      nearest   ╱   ╱              axis  in a cell of the directions, as wide as a share of the angle
//!       ╲      ╲ ─────────── ╱   ╱
//!        ╲       ╲    d    ╱    ╱                The table is that of a camera in the middles of both, which sees
//!     ┌───╲───────┬╲──────╱╮   ╱                 what any eye and axis of these cells see, as fine or finer.
//!     │    ╲      │  ·eye  │  ╱
//!     │     ╲_____·________│_╱                   P is D >= d away from the eye, θ off its axis; from the middle, r away
//!     │        middle      │                     and δ turned, D₀ and θ₀:
//!     └───────────┴────────┘
//!          |θ - θ₀| <= ε = asin (r / d) + δ,   D₀ <= D (1 + r / d),   cos θ₀ / cos θ <= cos ε + sin ε tan θ
//!
//!     so the middle sees less than  (1 + r / d) (cos ε + sin ε tan θ)²  times coarser:  focal / (D cos² θ) pixels a unit
//! ```
//!
//! Its picture has so many times more pixels, and is wider by ε. A parallel view is the same everywhere along its axis: its
//! lattice has the point next to the middle of all that is trimmed, and a turn by δ moves what is `R` away by `R δ`.
//!
//! Cells follow from the view alone, and steps of a fourth of an octave keep their size while the view hardly changes. Axes and
//! planes of coordinates are in the middle of cells: a view straight from the front does not come and go by roundings.

use super::whole_view::Ball;
use super::{focal_and_slant, half_slopes};
use crate::model::{Bounds, Camera, Projection};
use glam::{DVec2, DVec3, Vec2Swizzles};
use std::f64::consts::FRAC_1_SQRT_2;

/// Of half of the picture's shorter side: how wide the cells of eyes and of axes are.
const SHARE: f64 = 0.125;
/// The same of the direction that is up: few viewers turn it, and a cell costs all others rows.
const UP_SHARE: f64 = 0.25 * SHARE;
/// Steps of an octave.
const STEPS: f64 = 4.0;
/// A picture is not made wider than this angle on each side of its axis.
const WIDEST: f64 = 1.3;
/// Cells along an axis, to either side: beyond, coordinates resolve them no more.
const MOST_CELLS: f64 = 1e12;
/// Least sine of the angle between the axis and what is up.
const LEAST_UPRIGHT: f64 = 0.05;
/// Most that an eye and an axis of a cell move what is seen, in widths of the cell of axes.
const MOST_MOVED: f64 = 4.0;
/// Half of a table's picture in sides of the view's: 0.5 where the axis is in the middle, 1 where it is in a corner.
const MOST_BESIDE: f64 = 1.0;
/// Of all sums below.
const ROUNDING: f64 = 1e-9;

/// The camera whose table serves this view, widened by so many pixels, and those from near by; `None`: it wants one of its own.
/// What is trimmed lies in the ball, and in the boxes.
pub(super) fn view_cell(camera: &Camera, margin_px: f64, ball: &Ball, boxes: &[Bounds]) -> Option<Camera> {
    let (focal, _) = focal_and_slant(camera);
    // a table's picture is symmetric about the axis: if the axis is off the middle, both sides get the wider one's
    // width
    let half = half_slopes(camera, margin_px);
    let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
    let own = (size + 2.0 * margin_px) / camera.focal_px();
    if (half / own).max_element() > MOST_BESIDE {
        return None;
    }
    if camera.is_perspective() { perspective(camera, half, focal, boxes) } else { parallel(camera, half, focal, ball) }
}

/// `half`: of the picture, at a depth of 1.
fn perspective(camera: &Camera, half: DVec2, focal: f64, boxes: &[Bounds]) -> Option<Camera> {
    let nearest = at_most(Sight::new(camera, half).nearest(boxes)?);
    let share = half.min_element().min(1.0);
    let corner = half.length();
    let wide = at_most(SHARE * share);
    let axes = Axes::around(camera, wide, at_most(UP_SHARE * share / corner))?;
    let turn = wide * FRAC_1_SQRT_2;

    let beside = nearest * wide;
    let ahead = nearest * wide * (1.0 / corner).min(0.5 * SHARE / wide);
    let eye = axes.middle(camera.eye, DVec3::new(beside, beside, ahead))?;
    let (aside, ahead) = (FRAC_1_SQRT_2 * beside, 0.5 * ahead);
    // what is straight ahead stays there: no side is farther from the axis than the picture's corner is, turned and moved
    let slant = corner / (1.0 + corner * corner).sqrt() + MOST_MOVED * wide;
    let parallax = (aside / nearest).asin() + (ahead * slant / (nearest - aside)).asin();
    let moved = parallax + turn * (1.0 + corner); // what turns at a corner rolls, too
    if moved > MOST_MOVED * wide {
        return None;
    }

    // a side is nearer to a corner than its angle from the axis tells
    let wider = half.map(|side| {
        let beside = moved.sin() * ((1.0 + corner * corner) / (1.0 + side * side)).sqrt();
        (side.atan() + beside.min(1.0).asin()).min(WIDEST).tan()
    });
    let off = parallax + turn;
    let shift = aside + ahead;
    let finer = (off.cos() + off.sin() * corner).max(1.0 / off.cos()).powi(2) * (1.0 + shift / nearest);
    let height = (2.0 * wider.y * focal * finer).ceil();
    let focal = height / (2.0 * wider.y);

    let near = (nearest - shift) / (1.0 + wider.length_squared()).sqrt();
    let far = at_least(camera.depth_range.1 * (1.0 + corner * corner).sqrt() + shift);
    let table = Camera {
        eye,
        target: eye + axes.forward * nearest,
        up: axes.up,
        projection: Projection::Perspective { fov_y: 2.0 * wider.y.atan() },
        depth_range: (near * (1.0 - ROUNDING), far.max(2.0 * near)),
        size: ((2.0 * wider.x * focal).ceil() as u32, height as u32),
    };
    let sight = Sight::new(camera, half);
    let covers = |side: DVec3| sight.corners.iter().all(|corner| corner.dot(side) >= parallax.sin() + ROUNDING);
    Sight::new(&table, wider).sides.into_iter().all(covers).then_some(table)
}

/// `half`: of the picture, model units.
fn parallel(camera: &Camera, half: DVec2, focal: f64, ball: &Ball) -> Option<Camera> {
    let (right, up, forward) = camera.axes();
    let radius = ball.radius;
    let eye = camera.eye - ball.centre;
    let foot = eye - forward * eye.dot(forward); // of the middle, on the axis
    if foot.length() > 2.0 * radius {
        return None; // far beside all that is trimmed
    }
    let share = half.min_element();
    let cell = at_most(SHARE * share);
    let wide = at_most((SHARE * share / radius).min(SHARE));
    let axes = Axes::around(camera, wide, at_most(UP_SHARE * share / half.length()))?;
    let turn = wide * FRAC_1_SQRT_2;
    let wider = half + 0.5 * cell + turn * (radius + half.yx());

    let place = axes.middle(foot, DVec3::splat(cell))?;
    let place = ball.centre + place - axes.forward * place.dot(axes.forward);
    let before = 4.0 * radius; // all that is trimmed is behind the eye's plane
    let size = (2.0 * wider * focal).ceil();
    let table = Camera {
        eye: place - axes.forward * before,
        target: place,
        up: axes.up,
        projection: Projection::Orthographic { height: size.y / focal },
        depth_range: (ROUNDING * radius, 2.0 * before),
        size: (size.x as u32, size.y as u32),
    };
    let reach = |axis: DVec3| {
        let beside = (ball.centre + foot - place).dot(axis).abs() + radius * forward.dot(axis).abs();
        beside + half.x * right.dot(axis).abs() + half.y * up.dot(axis).abs() + ROUNDING * radius
    };
    (reach(axes.right) <= wider.x && reach(axes.up) <= wider.y).then_some(table)
}

/// Right, up and forward, in the middle of a cell.
struct Axes {
    right: DVec3,
    up: DVec3,
    forward: DVec3,
}

impl Axes {
    /// The middle of the cell, `wide` on the faces of a cube, that the camera's axis is in. Up is what a lattice says that the
    /// axes of coordinates are on, cells of `roll`; `None` where that is along the axis.
    fn around(camera: &Camera, wide: f64, roll: f64) -> Option<Self> {
        let (_, _, forward) = camera.axes();
        let main = forward.abs().max_position();
        let on_cube = forward / forward[main].abs();
        let mut axis = (on_cube / wide).round() * wide;
        axis[main] = on_cube[main];
        let axis = axis.normalize();
        let roll = roll.log2().floor().exp2();
        let up = ((camera.up.normalize() / roll).round() * roll).normalize_or_zero();
        let right = axis.cross(up);
        (right.length() >= LEAST_UPRIGHT).then(|| {
            let right = right.normalize();
            Self { right, up: right.cross(axis), forward: axis }
        })
    }

    /// That of the lattice's cell around a point; `None` where coordinates do not resolve it.
    fn middle(&self, p: DVec3, cell: DVec3) -> Option<DVec3> {
        let at = DVec3::new(p.dot(self.right), p.dot(self.up), p.dot(self.forward)) / cell;
        let middle = at.round() * cell;
        (at.abs().max_element() < MOST_CELLS)
            .then(|| self.right * middle.x + self.up * middle.y + self.forward * middle.z)
    }
}

/// The step at or below.
fn at_most(x: f64) -> f64 {
    ((x.log2() * STEPS).floor() / STEPS).exp2()
}

/// The step at or above.
fn at_least(x: f64) -> f64 {
    ((x.log2() * STEPS).ceil() / STEPS).exp2()
}

/// The pyramid that a perspective picture shows, `half` as wide and high at a depth of 1.
struct Sight {
    eye: DVec3,
    forward: DVec3,
    depth_range: (f64, f64),
    /// Towards its corners, of length 1.
    corners: [DVec3; 4],
    /// Inwards from its sides, of length 1.
    sides: [DVec3; 4],
}

impl Sight {
    fn new(camera: &Camera, half: DVec2) -> Self {
        let (right, up, forward) = camera.axes();
        let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        Self {
            eye: camera.eye,
            forward,
            depth_range: camera.depth_range,
            corners: signs.map(|(x, y)| (forward + right * (x * half.x) + up * (y * half.y)).normalize()),
            sides: [(right, half.x), (-right, half.x), (up, half.y), (-up, half.y)]
                .map(|(axis, half)| (forward * half + axis).normalize()),
        }
    }

    /// How far away at least is what it shows of the boxes; `None` where it shows nothing, or may show what is nearer than its
    /// near plane.
    fn nearest(&self, boxes: &[Bounds]) -> Option<f64> {
        let (near, far) = self.depth_range;
        let mut nearest2 = f64::INFINITY;
        for bounds in boxes.iter().filter(|bounds| !bounds.is_empty()) {
            let half = 0.5 * (bounds.max - bounds.min);
            let to = bounds.centre() - self.eye;
            let distance2 = (to.abs() - half).max(DVec3::ZERO).length_squared();
            let most = |axis: DVec3| to.dot(axis) + half.dot(axis.abs());
            if distance2 < nearest2
                && most(-self.forward) >= -far
                && most(self.forward) >= near
                && self.sides.iter().all(|side| most(*side) >= 0.0)
            {
                nearest2 = distance2;
            }
        }
        let nearest = nearest2.sqrt() * (1.0 - ROUNDING);
        (nearest.is_finite() && nearest >= near).then_some(nearest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::Random;

    const MARGIN_PX: f64 = 1.25;

    /// Small boxes in a ball of a radius of 10 around the origin.
    fn scene(random: &mut Random) -> (Ball, Vec<Bounds>) {
        let boxes: Vec<Bounds> = (0..400)
            .map(|_| {
                let p = DVec3::from_array(std::array::from_fn(|_| random.range(-5.5, 5.5)));
                let half = DVec3::from_array(std::array::from_fn(|_| random.range(0.0, 0.2)));
                Bounds { min: p - half, max: p + half }
            })
            .collect();
        (Ball { centre: DVec3::ZERO, radius: 10.0 }, boxes)
    }

    /// A point that a view, widened, shows at a corner or elsewhere at its border; whether what is trimmed may be there.
    fn at_the_border(random: &mut Random, camera: &Camera, ball: &Ball, boxes: &[Bounds]) -> (DVec3, bool) {
        let (width, height) = (f64::from(camera.size.0), f64::from(camera.size.1));
        let mut side =
            |last: f64| [-MARGIN_PX, last + MARGIN_PX, random.range(-MARGIN_PX, last)][random.integer(0, 2) as usize];
        let pixel = DVec2::new(side(width), side(height));
        let (origin, direction) = camera.ray(pixel);
        if !camera.is_perspective() {
            let p = origin + direction * random.range(0.0, 100.0);
            return (p, p.distance(ball.centre) <= ball.radius);
        }
        let half = half_slopes(camera, MARGIN_PX);
        let nearest = Sight::new(camera, half).nearest(boxes).expect("it has a table for many views");
        (origin + direction * nearest * 10.0f64.powf(random.range(0.0, 1.0)), true)
    }

    /// Of a part of the scene, from within it and from afar, wide and narrow. Half of them look down nearly along what is up:
    /// as their axis turns a little, they roll.
    fn some_view(random: &mut Random, parallel: bool) -> Camera {
        let away = |random: &mut Random, far: f64| DVec3::from_array(std::array::from_fn(|_| random.range(-far, far)));
        let is_steep = random.integer(0, 1) == 0;
        let far = if random.integer(0, 1) == 0 { 7.0 } else { 60.0 };
        let target = away(random, 4.0);
        let up = if random.integer(0, 2) == 0 { DVec3::Z } else { away(random, 1.0).normalize() };
        let above = up * random.range(2.0, 6.0) + away(random, 0.4);
        let eye = if is_steep { target + above } else { away(random, far) };
        let fov_y = if is_steep { 1.3 } else { 10.0f64.powf(random.range(-2.0, 0.0)) * 1.5 };
        let projection = match parallel {
            true => Projection::Orthographic { height: random.range(0.2, 4.0) },
            false if random.integer(0, 1) == 0 => Projection::Perspective { fov_y },
            false => {
                let focal = 180.0 / (0.5 * fov_y).tan();
                let principal = DVec2::new(random.range(0.0, 640.0), random.range(0.0, 360.0));
                Projection::Pinhole { focal: DVec2::new(focal, focal * random.range(0.6, 1.6)), principal }
            }
        };
        Camera { eye, target, up, projection, depth_range: (0.05, 120.0), size: (640, 360) }
    }

    /// Where a point is in a picture, how deep, and the most pixels that a unit covers there.
    fn seen(camera: &Camera, p: DVec3) -> Option<(DVec2, f64, f64)> {
        let (focal, _) = focal_and_slant(camera);
        let (at, depth) = camera.project(p)?;
        let stretch = match camera.projection {
            Projection::Orthographic { .. } => focal,
            _ => focal * p.distance(camera.eye) / (depth * depth),
        };
        Some((at, depth, stretch))
    }

    /// How far beyond the picture a point is, in pixels; 0 within.
    fn beyond(camera: &Camera, at: DVec2) -> f64 {
        let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
        (at - size).max(-at).max_element().max(0.0)
    }

    #[test]
    fn what_a_view_shows_its_table_has_as_fine() {
        let mut random = Random::new(5);
        let mut served = [[0; 2]; 2]; // parallel or not: views without and with a table of their own
        let mut points = 0;
        for n in 0..2000 {
            let parallel = n % 3 == 0;
            let (ball, boxes) = scene(&mut random);
            let camera = some_view(&mut random, parallel);
            if camera.check().is_err() {
                continue;
            }
            let table = view_cell(&camera, MARGIN_PX, &ball, &boxes);
            served[usize::from(parallel)][usize::from(table.is_none())] += 1;
            let Some(table) = table else { continue };
            for _ in 0..50 {
                let (p, is_trimmed) = at_the_border(&mut random, &camera, &ball, &boxes);
                let Some((_, depth, stretch)) = seen(&camera, p).filter(|_| is_trimmed) else { continue };
                let (near, far) = camera.depth_range;
                if depth < near || depth > far {
                    continue;
                }
                let (at, depth, finer) = seen(&table, p).expect("in front of the eye");
                let (near, far) = table.depth_range;
                assert!(beyond(&table, at) == 0.0 && depth >= near && depth <= far, "{p}: {camera:?} {table:?}");
                assert!(finer >= stretch * (1.0 - 1e-9), "{p}: {stretch} {finer} {camera:?} {table:?}");
                points += 1;
            }
        }
        // the others look from within a box, or down: rolled, they show more than their table has
        assert!(served.iter().all(|[shared, own]| *shared > 2 * own), "{served:?}");
        assert!(points > 10_000, "{points}");
    }

    /// A view ten times closer than one that shows all, and others that move by a few pixels a frame.
    fn moved(step: usize, parallel: bool, by: impl Fn(f64) -> (DVec3, DVec3)) -> Camera {
        let (eye, target) = by(step as f64);
        let projection = match parallel {
            true => Projection::Orthographic { height: 2.0 },
            false => Projection::Perspective { fov_y: 0.08 },
        };
        Camera { eye, target, up: DVec3::Z, projection, depth_range: (1.0, 60.0), size: (1920, 1080) }
    }

    #[test]
    fn a_view_that_moves_slowly_keeps_its_table_for_some_frames() {
        let (ball, boxes) = scene(&mut Random::new(8));
        let turned = |step: f64| {
            let angle = 0.3 + 2e-4 * step; // four pixels of what is as far from the target as the eye's way is long
            (DVec3::new(25.0 * angle.cos(), 25.0 * angle.sin(), 9.0), DVec3::new(1.0, 2.0, 0.5))
        };
        let shifted = |step: f64| {
            let by = DVec3::new(-0.002, 0.006, 0.001) * step;
            (DVec3::new(20.0, 6.0, 9.0) + by, DVec3::new(1.0, 2.0, 0.5) + by)
        };
        let nearer = |step: f64| (DVec3::new(20.0, 6.0, 9.0) * 0.999f64.powf(step), DVec3::new(1.0, 2.0, 0.5));
        for parallel in [false, true] {
            let tables = |by: &dyn Fn(f64) -> (DVec3, DVec3)| {
                let made: Vec<_> = (0..200)
                    .map(|step| view_cell(&moved(step, parallel, by), MARGIN_PX, &ball, &boxes).expect("shared"))
                    .collect();
                1 + made.windows(2).filter(|pair| pair[0] != pair[1]).count()
            };
            let made = [tables(&turned), tables(&shifted), tables(&nearer)];
            println!("{parallel} {made:?}");
            assert!(made.iter().all(|made| *made < 40), "{made:?} of 200 frames");
        }
    }

    #[test]
    fn an_eye_at_a_face_and_one_that_looks_up_have_their_own() {
        let face = Bounds { min: DVec3::new(-1.0, -1.0, 0.0), max: DVec3::new(1.0, 1.0, 0.1) };
        let ball = Ball { centre: DVec3::ZERO, radius: 2.0 };
        let camera = |eye: DVec3, target: DVec3, projection| Camera {
            eye,
            target,
            up: DVec3::Z,
            projection,
            depth_range: (0.01, 10.0),
            size: (640, 360),
        };
        let perspective = Projection::Perspective { fov_y: 0.6 };
        let aside = camera(DVec3::new(1.0, 0.0, 1.0), DVec3::ZERO, perspective);
        assert!(view_cell(&aside, MARGIN_PX, &ball, &[face]).is_some());
        let within = camera(DVec3::new(0.5, 0.0, 0.05), DVec3::new(0.0, 0.0, 0.05), perspective);
        assert_eq!(view_cell(&within, MARGIN_PX, &ball, &[face]), None);
        let away = camera(DVec3::new(3.0, 0.0, 0.5), DVec3::new(9.0, 0.0, 0.5), perspective);
        assert_eq!(view_cell(&away, MARGIN_PX, &ball, &[face]), None, "it shows nothing");
        for projection in [perspective, Projection::Orthographic { height: 0.5 }] {
            let above = camera(DVec3::new(0.001, 0.0, 1.0), DVec3::ZERO, projection);
            assert_eq!(view_cell(&above, MARGIN_PX, &ball, &[face]), None, "{projection:?}");
        }
    }
}
