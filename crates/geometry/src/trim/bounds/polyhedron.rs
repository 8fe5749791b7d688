//! Corners of what half-spaces have in common.
//!
//! ```text
//!      ╲        ╱       Each plane holds a polygon of the surface: a square larger than the box around the whole,
//!     ──╲──────╱──      clipped by the other planes. The corners of all polygons are those of the whole.
//!        ╲    ╱
//!         ╲──╱          Planes of near normals are a group. A group that cuts nothing of a polygon is passed over.
//! ```
//!
//! *Groups.* A binary tree halves the planes along the widest extent of their normals. The normals of a group lie in a
//! box and in a cone. No point is higher above a plane of the group than either says, less the least offset. Groups
//! whose normals are nearest the polygon's own come first: neighbours make it small, and then most others pass it over.
//!
//! *Certainty.* A point counts as beyond a plane where it is higher than some roundings of the largest coordinate, so
//! that rounding takes no polygon away. Corners are right to as much over the sine of the smallest angle of a corner.
//!
//! *Cost.* Near linear: some 340 heights a plane for a ball of a thousand facets, 25 more for each doubling. A polygon
//! of `k` sides costs `k²`. Where each plane meets each group, the cost is the square of their number. [`MOST_HEIGHTS`]
//! ends the search then.
//!
//! Source: I. E. Sutherland, G. W. Hodgman, *Reentrant Polygon Clipping*, 1974, for the clipping.

use crate::model::Bounds;
use glam::DVec3;
use std::ops::Range;

/// Heights of points above planes, for each plane, beyond which no corners are found.
const MOST_HEIGHTS: usize = 8192;
/// Planes of a group that is not halved.
const LEAF: usize = 8;
/// Height above a plane that counts as none, in roundings of the largest coordinate.
const ROUNDINGS: f64 = 16.0;
/// What reaches farther from the origin counts as unbounded, in distances of the farthest plane.
const FARTHEST: f64 = 1e4;

/// `normal · x <= offset`, the normal of length 1.
pub(super) type Plane = (DVec3, f64);

/// The planes of a box along the axes.
pub(super) fn sides(of: Bounds) -> [Plane; 6] {
    let [x, y, z] = DVec3::AXES;
    [(x, of.max.x), (-x, -of.min.x), (y, of.max.y), (-y, -of.min.y), (z, of.max.z), (-z, -of.min.z)]
}

/// The corners of what half-spaces have in common, each at least three times; `None` where it may be unbounded or
/// empty, or costs too much.
pub(super) fn alone(planes: &[Plane]) -> Option<Vec<DVec3>> {
    let far = FARTHEST * planes.iter().map(|(_, offset)| offset.abs()).fold(0.0, f64::max);
    if !(far > 0.0 && far.is_finite()) {
        return None;
    }
    // what touches the box may go on beyond it
    let inside = |within: Bounds| {
        let corners = between(&[planes, &sides(within)].concat(), within)?;
        let found = corners.iter().copied().fold(Bounds::EMPTY, Bounds::with);
        let margin = 1e-3 * (within.max - within.min);
        let is_inside = found.min.cmpgt(within.min + margin) & found.max.cmplt(within.max - margin);
        (!found.is_empty() && is_inside.all()).then_some((corners, found))
    };
    let (_, found) = inside(Bounds { min: DVec3::splat(-far), max: DVec3::splat(far) })?;
    // once more in a box of its size, which rounds less
    let wide = DVec3::splat(found.diagonal().max(1e-9 * far));
    inside(Bounds { min: found.min - wide, max: found.max + wide }).map(|(corners, _)| corners)
}

/// The corners of the polygons between planes whose common part is in a box; `None` where that costs too much.
pub(super) fn between(planes: &[Plane], within: Bounds) -> Option<Vec<DVec3>> {
    let mut heights = 0;
    counted(planes, within, &mut heights)
}

/// The same, and how many heights were computed.
fn counted(planes: &[Plane], within: Bounds, heights: &mut usize) -> Option<Vec<DVec3>> {
    let (centre, radius) = (within.centre(), 0.5 * within.diagonal());
    let slack = ROUNDINGS * f64::EPSILON * within.min.abs().max(within.max.abs()).max_element();
    let tree = Tree::new(planes, centre, slack);
    let (mut polygon, mut all) = (Polygon::default(), Vec::new());
    for (i, (normal, offset)) in planes.iter().enumerate() {
        let height = offset - normal.dot(centre);
        if height.abs() > radius + slack {
            continue;
        }
        let (u, v) = normal.any_orthonormal_pair();
        // twice as large as the plane's part of the ball around the box
        let (foot, u, v) = (centre + height * *normal, 2.0 * radius * u, 2.0 * radius * v);
        polygon.corners.clear();
        polygon.corners.extend([foot + u + v, foot - u + v, foot - u - v, foot + u - v]);
        tree.cut(&mut polygon, i, heights)?;
        all.extend_from_slice(&polygon.corners);
    }
    Some(all)
}

/// A convex polygon.
#[derive(Default)]
struct Polygon {
    corners: Vec<DVec3>,
    /// Room for the corners after a clip.
    clipped: Vec<DVec3>,
}

impl Polygon {
    /// Takes away what is beyond a plane by more than `slack`.
    fn clip(&mut self, (normal, offset): Plane, slack: f64) {
        let height = |p: DVec3| normal.dot(p) - offset;
        if self.corners.iter().all(|p| height(*p) <= slack) {
            return;
        }
        self.clipped.clear();
        for (k, a) in self.corners.iter().enumerate() {
            let b = self.corners[(k + 1) % self.corners.len()];
            let (from, to) = (height(*a), height(b));
            if from <= slack {
                self.clipped.push(*a);
            }
            if (from <= slack) != (to <= slack) {
                self.clipped.push(*a + (b - *a) * (from / (from - to)).clamp(0.0, 1.0));
            }
        }
        std::mem::swap(&mut self.corners, &mut self.clipped);
    }
}

/// Planes in groups.
struct Tree<'p> {
    planes: &'p [Plane],
    /// Lengths of points, and heights of planes, count from here.
    centre: DVec3,
    slack: f64,
    /// Numbers of the planes, a group's side by side.
    order: Vec<usize>,
    /// A group stands before its first half, and that before the second.
    groups: Vec<Group>,
}

impl<'p> Tree<'p> {
    fn new(planes: &'p [Plane], centre: DVec3, slack: f64) -> Self {
        let mut tree = Self { planes, centre, slack, order: (0..planes.len()).collect(), groups: Vec::new() };
        if !planes.is_empty() {
            tree.add(0..planes.len());
        }
        tree
    }

    /// Adds the group of a part of the order, and its halves.
    fn add(&mut self, range: Range<usize>) {
        let (planes, own) = (self.planes, &mut self.order[range.clone()]);
        let group = Group::new(own.iter().map(|i| planes[*i]), self.centre, range.clone());
        let (number, half) = (self.groups.len(), range.len() / 2);
        if range.len() > LEAF {
            let axis = group.half.max_position();
            own.select_nth_unstable_by(half, |a, b| planes[*a].0[axis].total_cmp(&planes[*b].0[axis]));
        }
        self.groups.push(group);
        if range.len() > LEAF {
            self.add(range.start..range.start + half);
            self.groups[number].second = Some(self.groups.len());
            self.add(range.start + half..range.end);
        }
    }

    /// Clips the polygon of plane `own` by all others; `None` where that costs too much.
    fn cut(&self, polygon: &mut Polygon, own: usize, heights: &mut usize) -> Option<()> {
        let most = MOST_HEIGHTS.saturating_mul(self.planes.len());
        let normal = self.planes[own].0;
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            let group = &self.groups[number];
            *heights += polygon.corners.len();
            if *heights > most {
                return None;
            }
            let limit = group.offset + self.slack;
            if polygon.corners.iter().all(|p| group.reach(*p - self.centre) <= limit) {
                continue;
            }
            if let Some(second) = group.second {
                let first = number + 1;
                let is_first_near = self.groups[first].distance(normal) <= self.groups[second].distance(normal);
                open.extend(if is_first_near { [second, first] } else { [first, second] });
                continue;
            }
            for plane in self.order[group.range.clone()].iter().filter(|plane| **plane != own) {
                *heights += polygon.corners.len();
                polygon.clip(self.planes[*plane], self.slack);
            }
        }
        Some(())
    }
}

/// Planes of near normals.
struct Group {
    /// Its part of the order.
    range: Range<usize>,
    /// Middle and half the size of the box of the normals.
    middle: DVec3,
    half: DVec3,
    /// The axis of a cone of the normals, and cosine and sine of its half angle, which is less than a right one.
    cone: Option<(DVec3, f64, f64)>,
    /// The least height of a plane above the centre.
    offset: f64,
    /// The number of its second half; the first half follows it.
    second: Option<usize>,
}

impl Group {
    fn new(planes: impl Iterator<Item = Plane> + Clone, centre: DVec3, range: Range<usize>) -> Self {
        let normals = planes.clone().map(|(normal, _)| normal);
        let around = normals.clone().fold(Bounds::EMPTY, Bounds::with);
        let cone = normals.clone().sum::<DVec3>().try_normalize().and_then(|axis| {
            let is_narrow = normals.clone().all(|normal| axis.dot(normal) > 0.0);
            // by the sine: a cosine rounds small angles to 0
            let sin = normals.clone().map(|normal| axis.cross(normal).length()).fold(0.0, f64::max).min(1.0);
            is_narrow.then(|| (axis, (1.0 - sin * sin).sqrt(), sin))
        });
        let offset = planes.map(|(normal, offset)| offset - normal.dot(centre)).fold(f64::INFINITY, f64::min);
        let half = 0.5 * (around.max - around.min);
        Self { range, middle: around.centre(), half, cone, offset, second: None }
    }

    /// The largest `normal · p` that a normal of the group may have.
    fn reach(&self, p: DVec3) -> f64 {
        let in_box = self.middle.dot(p) + self.half.dot(p.abs());
        let in_cone = self.cone.map_or(f64::INFINITY, |(axis, cos, sin)| {
            let (along, length) = (axis.dot(p), p.length());
            let is_inside = along >= cos * length;
            if is_inside { length } else { cos * along + sin * (p - along * axis).length() }
        });
        in_box.min(in_cone)
    }

    /// The square of the distance of a normal from the box of the normals.
    fn distance(&self, normal: DVec3) -> f64 {
        ((normal - self.middle).abs() - self.half).max(DVec3::ZERO).length_squared()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Half-spaces that touch the unit ball at points of a Fibonacci lattice, within a box.
    fn ball(count: u32) -> (Vec<Plane>, Bounds) {
        let normal = |i: u32| {
            let z = 1.0 - f64::from(2 * i + 1) / f64::from(count);
            let (sin, cos) = (f64::from(i) * PI * (3.0 - 5f64.sqrt())).sin_cos();
            let r = (1.0 - z * z).sqrt();
            DVec3::new(r * cos, r * sin, z).normalize()
        };
        let within = Bounds { min: DVec3::splat(-1.5), max: DVec3::splat(1.5) };
        ((0..count).map(|i| (normal(i), 1.0)).chain(sides(within)).collect(), within)
    }

    /// Euler: three faces meet in each corner, so `n` faces have `2 n - 4` of them. Each plane that was passed over and
    /// cuts would leave a corner beyond it.
    #[test]
    fn a_ball_of_facets_has_all_its_corners() {
        for count in [20, 300] {
            let (planes, within) = ball(count);
            let corners = between(&planes, within).unwrap();
            assert_eq!(corners.len(), 3 * (2 * count as usize - 4));
            for p in &corners {
                let highest = planes.iter().map(|(n, d)| n.dot(*p) - d).fold(f64::NEG_INFINITY, f64::max);
                assert!(highest.abs() < 1e-12, "{p} is {highest:e} above a plane");
            }
        }
    }

    /// Twice the planes cost little more than twice the heights: four times, if each plane met each.
    #[test]
    fn heights_are_near_linear() {
        let heights = |count: u32| {
            let (planes, within) = ball(count);
            let mut heights = 0;
            counted(&planes, within, &mut heights).unwrap();
            heights
        };
        let (few, many) = (heights(500), heights(4000));
        assert!(few < 350 * 500 && many < 12 * few, "{few} and {many}");
    }

    #[test]
    fn what_costs_too_much_has_no_corners() {
        let (planes, within) = ball(20);
        let mut heights = MOST_HEIGHTS * planes.len();
        assert!(counted(&planes, within, &mut heights).is_none());
    }
}
