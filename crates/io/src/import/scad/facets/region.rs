//! Parts of the plane bounded by straight sides, and OpenSCAD's operations on them.
//!
//! ```text
//!   offset by d:   each side moves out by d; between two sides that part a corner is filled
//!
//!      round  ╭──     miter  ┌──     chamfer  ╱──      inwards: the outside grows instead
//!             │              │                │
//! ```
//!
//! i_overlay makes unions, intersections and differences, on a grid of 64 bits: corners move by less than 1e-15 of the
//! size.

use super::{Budget, hull};
use crate::import::facets;
use glam::{DAffine2, DVec2};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::overlay::FloatOverlay;
use i_overlay::float::single::SingleFloatOverlay;
use std::f64::consts::TAU;

/// Closed runs of corners.
type Contours = Vec<Vec<[f64; 2]>>;

/// The shape of a corner between two sides that part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::import::scad) enum Join {
    /// An arc, of as many segments on a whole circle.
    Round(f64),
    /// Both sides go on until they meet.
    Miter,
    /// A side across, tangent to the circle.
    Chamfer,
}

/// Outlines that run counter-clockwise, each with the holes in it.
#[derive(Clone, Debug, Default)]
pub(in crate::import::scad) struct Region {
    shapes: Vec<Contours>,
}

impl Region {
    /// The inside of outlines, by the odd-even or the non-zero rule.
    pub fn new(outlines: &[Vec<DVec2>], odd: bool) -> Self {
        let outlines: Contours = outlines.iter().map(|o| o.iter().map(DVec2::to_array).collect()).collect();
        let rule = if odd { FillRule::EvenOdd } else { FillRule::NonZero };
        Self { shapes: FloatOverlay::<[f64; 2], i64>::from_subj(&outlines).overlay(OverlayRule::Subject, rule) }
    }

    /// A convex polygon, counter-clockwise.
    fn convex(corners: Vec<DVec2>) -> Self {
        let shapes = if corners.len() < 3 { Vec::new() } else { vec![vec![array(&corners)]] };
        Self { shapes }
    }

    fn pair(&self, other: &Self, rule: OverlayRule) -> Self {
        Self { shapes: self.shapes.overlay_as::<i64>(&other.shapes, rule, FillRule::NonZero) }
    }

    pub fn union(all: Vec<Self>) -> Self {
        let mut all = all.into_iter().filter(|r| !r.is_empty());
        let Some(first) = all.next() else { return Self::default() };
        let mut shapes = first.shapes;
        let alone = shapes.len();
        shapes.extend(all.flat_map(|r| r.shapes));
        if shapes.len() == alone {
            return Self { shapes };
        }
        Self {
            shapes: FloatOverlay::<[f64; 2], i64>::from_subj(&shapes).overlay(OverlayRule::Subject, FillRule::NonZero),
        }
    }

    pub fn without(&self, other: &Self) -> Self {
        self.pair(other, OverlayRule::Difference)
    }

    pub fn common(&self, other: &Self) -> Self {
        self.pair(other, OverlayRule::Intersect)
    }

    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty()
    }

    /// Of each outline with its holes.
    pub fn shapes(&self) -> impl Iterator<Item = Vec<Vec<DVec2>>> + '_ {
        self.shapes.iter().map(|s| s.iter().map(|c| points(c)).collect())
    }

    /// Outlines and holes alike.
    pub fn contours(&self) -> Vec<Vec<DVec2>> {
        self.shapes.iter().flatten().map(|c| points(c)).collect()
    }

    pub fn corners(&self) -> impl Iterator<Item = DVec2> + '_ {
        self.shapes.iter().flatten().flatten().map(|p| DVec2::from_array(*p))
    }

    #[cfg(test)]
    pub fn area(&self) -> f64 {
        let twice = |c: &Vec<DVec2>| (0..c.len()).map(|i| c[i].perp_dot(c[(i + 1) % c.len()])).sum::<f64>();
        0.5 * self.contours().iter().map(twice).sum::<f64>()
    }

    /// The same under a map; nothing under one without an inverse.
    pub fn moved(&self, by: &DAffine2) -> Self {
        let turned = by.matrix2.determinant();
        if turned == 0.0 || !turned.is_finite() {
            return Self::default();
        }
        let contour = |c: &Vec<[f64; 2]>| {
            let mut c: Vec<[f64; 2]> =
                c.iter().map(|p| by.transform_point2(DVec2::from_array(*p)).to_array()).collect();
            if turned < 0.0 {
                c.reverse();
            }
            c
        };
        Self { shapes: self.shapes.iter().map(|s| s.iter().map(contour).collect()).collect() }
    }

    pub fn hull(&self) -> Self {
        Self::convex(hull::flat(self.corners()))
    }

    /// Without holes.
    pub fn filled(&self) -> Self {
        Self::union(self.shapes.iter().map(|s| Self { shapes: vec![s[..1].to_vec()] }).collect())
    }

    /// Convex pieces that cover it: itself, or triangles.
    fn pieces(&self) -> Vec<Vec<DVec2>> {
        let mut all = Vec::new();
        for shape in self.shapes() {
            let corners = &shape[0];
            let turn = |i: usize| {
                let at = |k: usize| corners[(i + k) % corners.len()];
                (at(1) - at(0)).perp_dot(at(2) - at(1))
            };
            if shape.len() == 1 && (0..corners.len()).all(|i| turn(i) >= 0.0) {
                all.push(corners.clone());
                continue;
            }
            let flat: Vec<DVec2> = shape.iter().flatten().copied().collect();
            all.extend(facets::triangulate_flat(&shape).iter().map(|t| t.map(|i| flat[i as usize]).to_vec()));
        }
        all
    }

    /// All sums of a point of this and one of the other.
    pub fn minkowski(&self, other: &Self, budget: &mut Budget) -> Result<Self, String> {
        let (mine, theirs) = (self.pieces(), other.pieces());
        let mut all = Vec::new();
        for a in &mine {
            for b in &theirs {
                budget.spend(a.len() * b.len())?;
                all.push(Self::convex(hull::flat(a.iter().flat_map(|p| b.iter().map(move |q| *p + *q)))));
            }
        }
        Ok(Self::union(all))
    }

    /// Grown by `distance`, or shrunk where it is negative.
    pub fn offset(&self, distance: f64, join: Join) -> Self {
        let by = distance.abs();
        if by == 0.0 {
            return self.clone();
        }
        let mut strips = Vec::new();
        for mut contour in self.contours() {
            if distance < 0.0 {
                contour.reverse();
            }
            contour.dedup();
            let n = contour.len();
            let normal = |i: usize| {
                let along = (contour[(i + 1) % n] - contour[i % n]).normalize_or_zero();
                DVec2::new(along.y, -along.x)
            };
            for i in 0..n {
                let (a, b, out) = (contour[i], contour[(i + 1) % n], normal(i));
                strips.push(Self::convex(vec![a, a + by * out, b + by * out, b]));
                let next = normal(i + 1);
                if out.perp_dot(next) > 0.0 || (out.perp_dot(next) == 0.0 && out.dot(next) < 0.0) {
                    let mut corner = vec![b];
                    corner.extend(fill(out, next, join).into_iter().map(|p| b + by * p));
                    strips.push(Self::convex(corner));
                }
            }
        }
        if distance < 0.0 {
            return self.without(&Self::union(strips));
        }
        strips.push(self.clone());
        Self::union(strips)
    }
}

/// Corners between the ends of two unit normals, as the Clipper library of OpenSCAD chooses them.
fn fill(from: DVec2, to: DVec2, join: Join) -> Vec<DVec2> {
    let angle = from.perp_dot(to).atan2(from.dot(to)).abs();
    let along = |n: DVec2| DVec2::new(-n.y, n.x);
    match join {
        Join::Round(segments) => {
            let step = TAU / segments;
            let steps = (angle / step).round().max(1.0) as u32;
            let mut all: Vec<DVec2> = (0..steps).map(|i| DVec2::from_angle(step * f64::from(i)).rotate(from)).collect();
            all.push(to);
            all
        }
        // a side that turns back has no corner that is far enough
        Join::Miter if 1.0 + from.dot(to) > 1e-6 => vec![from, (from + to) / (1.0 + from.dot(to)), to],
        Join::Miter | Join::Chamfer => {
            let reach = (0.25 * angle).tan();
            vec![from, from + reach * along(from), to - reach * along(to), to]
        }
    }
}

fn array(corners: &[DVec2]) -> Vec<[f64; 2]> {
    corners.iter().map(DVec2::to_array).collect()
}

fn points(corners: &[[f64; 2]]) -> Vec<DVec2> {
    corners.iter().map(|p| DVec2::from_array(*p)).collect()
}
