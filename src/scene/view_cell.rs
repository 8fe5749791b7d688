//! View cells: one trim table for all views of a part of the model from nearly the same place and direction.
//!
//! ```text
//!    ╲ wider ╲        view      ╱ wider ╱        eye   in a cell of a lattice, as wide as a share of the picture
//!     ╲   ╲                    ╱   ╱                   at the depth of the nearest visible box
//!      ╲     ╲      nearest   ╱   ╱              axis  in a cell of directions, as wide as a share of the angle
//!       ╲      ╲ ─────────── ╱   ╱
//!        ╲       ╲    d    ╱    ╱                The table is made for a camera in the middle of both cells. It sees
//!     ┌───╲───────┬╲──────╱╮   ╱                 everything that any eye and axis of these cells see, at least as
//!     │    ╲      │  ·eye  │  ╱                  finely.
//!     │     ╲_____·________│_╱                   P is D >= d away from the eye, θ off its axis; from the middle, r away
//!     │        middle      │                     and δ turned, D₀ and θ₀:
//!     └───────────┴────────┘
//!          |θ - θ₀| <= ε = asin (r / d) + δ,   D₀ <= D (1 + r / d),   cos θ₀ / cos θ <= cos ε + sin ε tan θ
//!
//!     so the middle sees less than  (1 + r / d) (cos ε + sin ε tan θ)²  times coarser:  focal / (D cos² θ) pixels a unit
//! ```
//!
//! The middle camera's picture has that factor more pixels, and is wider by ε. A parallel view does not change along
//! its axis. So its lattice holds the point of the axis nearest to the centre of everything trimmed, and a turn by δ
//! moves a point at distance `R` by `R δ`.
//!
//! Cells follow from the view alone. Their sizes are steps of a fourth of an octave, so they stay while the view hardly
//! changes. The axes and planes of coordinates lie in the middle of cells, so rounding does not change the cell of a
//! view straight from the front.

use super::whole_view::Ball;
use super::{focal_and_slant, half_slopes};
use crate::model::{Bounds, Camera, Projection};
use glam::{DVec2, DVec3, Vec2Swizzles};
use std::f64::consts::FRAC_1_SQRT_2;

/// Width of the cells of eyes and of axes, as a share of half the picture's shorter side.
const SHARE: f64 = 0.125;
/// The same for the up direction. Few viewers turn it, and wider cells would cost all views more rows.
const UP_SHARE: f64 = 0.25 * SHARE;
/// Steps in an octave.
const STEPS: f64 = 4.0;
/// Largest angle between the axis and a side of a picture, in radians.
const WIDEST: f64 = 1.3;
/// Most cells along an axis, on either side of 0: `f64` coordinates resolve no more.
const MOST_CELLS: f64 = 1e12;
/// Least sine of the angle between the axis and the up direction.
const LEAST_UPRIGHT: f64 = 0.05;
/// Largest movement of a visible point between the views of a cell, in widths of the cell of axes.
const MOST_MOVED: f64 = 4.0;
/// Largest distance from the axis to a side, as a share of the view's side: 0.5 if the axis is in the middle, 1 in a
/// corner.
const MOST_BESIDE: f64 = 1.0;
/// Relative rounding of all sums below.
const ROUNDING: f64 = 1e-9;

/// The camera whose table serves this view, with a margin of `margin_px`, and all views of the same cell. `None` if the
/// view needs a table of its own. Everything trimmed lies in the ball and in the boxes.
pub(super) fn view_cell(camera: &Camera, margin_px: f64, ball: &Ball, boxes: &[Bounds]) -> Option<Camera> {
    let (focal, _) = focal_and_slant(camera);
    // a table's picture is symmetric about the axis: if the axis is off the middle, both sides get the width of the
    // wider one
    let half = half_slopes(camera, margin_px);
    let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
    let own = (size + 2.0 * margin_px) / camera.focal_px();
    if (half / own).max_element() > MOST_BESIDE {
        return None;
    }
    if camera.is_perspective() { perspective(camera, half, focal, boxes) } else { parallel(camera, half, focal, ball) }
}

/// `half`: half the picture's size at a depth of 1.
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
    // the point straight ahead stays there: no side is farther from the axis than the picture's corner, turned and
    // moved
    let slant = corner / (1.0 + corner * corner).sqrt() + MOST_MOVED * wide;
    let parallax = (aside / nearest).asin() + (ahead * slant / (nearest - aside)).asin();
    let moved = parallax + turn * (1.0 + corner); // a turn also rolls points at a corner
    if moved > MOST_MOVED * wide {
        return None;
    }

    // seen from a corner, a side is nearer than its angle from the axis
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

/// `half`: half the picture's size, in model units.
fn parallel(camera: &Camera, half: DVec2, focal: f64, ball: &Ball) -> Option<Camera> {
    let (right, up, forward) = camera.axes();
    let radius = ball.radius;
    let eye = camera.eye - ball.centre;
    let foot = eye - forward * eye.dot(forward); // the axis's point nearest to the centre
    if foot.length() > 2.0 * radius {
        return None; // far beside everything trimmed
    }
    let share = half.min_element();
    let cell = at_most(SHARE * share);
    let wide = at_most((SHARE * share / radius).min(SHARE));
    let axes = Axes::around(camera, wide, at_most(UP_SHARE * share / half.length()))?;
    let turn = wide * FRAC_1_SQRT_2;
    let wider = half + 0.5 * cell + turn * (radius + half.yx());

    let place = axes.middle(foot, DVec3::splat(cell))?;
    let place = ball.centre + place - axes.forward * place.dot(axes.forward);
    let before = 4.0 * radius; // everything trimmed is behind the eye's plane
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

/// Right, up and forward in the middle of a cell.
struct Axes {
    right: DVec3,
    up: DVec3,
    forward: DVec3,
}

impl Axes {
    /// The middle of the cell that contains the camera's axis; cells are `wide` on the faces of a cube. The up
    /// direction is rounded to a lattice of width `roll`, which contains the coordinate axes. `None` if the axis is
    /// nearly parallel to it.
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

    /// The middle of the lattice's cell around a point; `None` if coordinates do not resolve the cell.
    fn middle(&self, p: DVec3, cell: DVec3) -> Option<DVec3> {
        let at = DVec3::new(p.dot(self.right), p.dot(self.up), p.dot(self.forward)) / cell;
        let middle = at.round() * cell;
        (at.abs().max_element() < MOST_CELLS)
            .then(|| self.right * middle.x + self.up * middle.y + self.forward * middle.z)
    }
}

/// The largest step not above `x`.
fn at_most(x: f64) -> f64 {
    ((x.log2() * STEPS).floor() / STEPS).exp2()
}

/// The smallest step not below `x`.
fn at_least(x: f64) -> f64 {
    ((x.log2() * STEPS).ceil() / STEPS).exp2()
}

/// The pyramid of a perspective picture; `half` is half its size at a depth of 1.
struct Sight {
    eye: DVec3,
    forward: DVec3,
    depth_range: (f64, f64),
    /// Unit vectors to its corners.
    corners: [DVec3; 4],
    /// Unit normals of its sides, inwards.
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

    /// A lower bound on the distance of the visible boxes. `None` if no box is visible, or if one may be nearer than
    /// the near plane.
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

    /// A point at the border of a widened view, often at a corner, and whether trimmed faces may be there.
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

    /// A view of a part of the scene, from inside or outside, wide or narrow. Half of the views look down nearly along
    /// the up direction: they roll when their axis turns a little.
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

    /// A point's place in the picture, its depth, and the most pixels that a unit covers there.
    fn seen(camera: &Camera, p: DVec3) -> Option<(DVec2, f64, f64)> {
        let (focal, _) = focal_and_slant(camera);
        let (at, depth) = camera.project(p)?;
        let stretch = match camera.projection {
            Projection::Orthographic { .. } => focal,
            _ => focal * p.distance(camera.eye) / (depth * depth),
        };
        Some((at, depth, stretch))
    }

    /// Distance of a point from the picture, in pixels; 0 within it.
    fn beyond(camera: &Camera, at: DVec2) -> f64 {
        let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
        (at - size).max(-at).max_element().max(0.0)
    }

    #[test]
    fn what_a_view_shows_its_table_has_as_fine() {
        let mut random = Random::new(5);
        let mut served = [[0; 2]; 2]; // views served by a cell, views with their own table
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
        // the other views are inside a box, or look down and roll: they show more than the cell's table has
        assert!(served.iter().all(|[shared, own]| *shared > 2 * own), "{served:?}");
        assert!(points > 10_000, "{points}");
    }

    /// A view ten times closer than one of the whole scene; each step moves it by a few pixels.
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
            let angle = 0.3 + 2e-4 * step; // four pixels of motion at the distance of the eye's path
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
