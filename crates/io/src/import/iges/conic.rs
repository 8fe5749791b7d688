//! Conic arcs: 104.
//!
//! ```text
//!   A x² + B x y + C y² + D x + E y + F = 0
//!     turned by φ = atan2(B, A - C) / 2     A' x² + C' y² + D' x + E' y + F = 0
//!     moved to the centre (or apex)         x² / a² ± y² / b² = 1, or y² = 4 f x
//! ```
//!
//! An ellipse runs counter-clockwise from its start to its end, the others from one to the other.

use super::curve::Segment;
use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use crate::brep::CurveGeometry;
use glam::{DAffine3, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A conic in axes turned by `angle`: where they start, and what stands there.
struct Canonical {
    angle: f64,
    centre: DVec2,
    shape: Shape,
}

enum Shape {
    Ellipse(f64, f64),
    Hyperbola(f64, f64),
    Parabola(f64),
}

impl<'a> Geometry<'a> {
    pub(super) fn conic(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Segment, Fault> {
        let id = entity.id();
        let k = entity.reals(1, 11)?;
        let (start, end) = (DVec2::new(k[7], k[8]), DVec2::new(k[9], k[10]));
        let none = Fault::Value { id, what: "the coefficients are of no ellipse, hyperbola or parabola" };
        let conic = canonical([k[0], k[1], k[2], k[3], k[4], k[5]], start).ok_or(none)?;
        let turn = DVec2::from_angle(conic.angle);
        // coordinates on the conic's own axes
        let local = |p: DVec2| DVec2::new((p - conic.centre).dot(turn), turn.perp_dot(p - conic.centre));
        let (a, b) = (local(start), local(end));
        let (mut first, mut last) = match conic.shape {
            Shape::Ellipse(x, y) => ((a.y / y).atan2(a.x / x), (b.y / y).atan2(b.x / x)),
            Shape::Hyperbola(_, y) => ((a.y / y).asinh(), (b.y / y).asinh()),
            Shape::Parabola(f) => (a.y / (2.0 * f), b.y / (2.0 * f)),
        };
        let mut up = DVec3::Z;
        if let Shape::Ellipse(x, _) = conic.shape {
            let whole = a.distance(b) <= 1e-10 * x;
            last = first + if whole { TAU } else { (last - first).rem_euclid(TAU) };
        } else if last < first {
            // half a turn about the x axis takes the conic to itself, t to -t
            (first, last, up) = (-first, -last, -up);
        }
        let origin = map.transform_point3(conic.centre.extend(k[6]));
        let placed = self.frame(id, map, origin, (up, Some(turn.extend(0.0))))?;
        let (frame, s) = (placed.frame, placed.scale);
        let curve = match conic.shape {
            Shape::Ellipse(x, y) => CurveGeometry::Ellipse { frame, semi_x: x * s, semi_y: y * s },
            Shape::Hyperbola(x, y) => CurveGeometry::Hyperbola { frame, semi_x: x * s, semi_y: y * s },
            Shape::Parabola(f) => CurveGeometry::Parabola { frame, focal: f * s },
        };
        let sound = first < last && first.is_finite() && last.is_finite();
        sound
            .then_some(Segment { id, curve, start: first, end: last })
            .ok_or(Fault::Value { id, what: "an empty conic" })
    }
}

/// The conic with its x axis through the branch on which `start` lies.
fn canonical(k: [f64; 6], start: DVec2) -> Option<Canonical> {
    let [a, b, c, d, e, f] = k;
    let main = 0.5 * b.atan2(a - c);
    let turned = |angle: f64| {
        let (s, c1) = angle.sin_cos();
        let x2 = a * c1 * c1 + b * c1 * s + c * s * s;
        let y2 = a * s * s - b * c1 * s + c * c1 * c1;
        (x2, y2, d * c1 + e * s, e * c1 - d * s)
    };
    // writers round the coefficient that makes a parabola one
    const ROUNDED: f64 = 1e-9;
    let (x2, y2, ..) = turned(main);
    if x2.abs().min(y2.abs()) <= ROUNDED * x2.abs().max(y2.abs()) {
        let angle = if x2.abs() < y2.abs() { main } else { main + FRAC_PI_2 };
        let (_, y2, x, y) = turned(angle);
        let apex_y = -y / (2.0 * y2);
        let apex_x = (y2 * apex_y * apex_y - f) / x;
        let focal = -x / (4.0 * y2);
        let centre = DVec2::from_angle(angle).rotate(DVec2::new(apex_x, apex_y));
        let angle = if focal < 0.0 { angle + TAU / 2.0 } else { angle };
        let sound = focal.abs() > 0.0 && focal.is_finite() && centre.is_finite();
        return sound.then_some(Canonical { angle, centre, shape: Shape::Parabola(focal.abs()) });
    }
    let of = |angle: f64| {
        let (x2, y2, x, y) = turned(angle);
        let middle = DVec2::new(-x / (2.0 * x2), -y / (2.0 * y2));
        let level = x2 * middle.x * middle.x + y2 * middle.y * middle.y - f;
        (DVec2::from_angle(angle).rotate(middle), level / x2, level / y2)
    };
    let (centre, x, y) = of(main);
    let shape = |angle: f64, shape: Shape| Some(Canonical { angle, centre, shape });
    if !(centre.is_finite() && x.is_finite() && y.is_finite()) {
        return None;
    }
    match (x > 0.0, y > 0.0) {
        (true, true) => shape(main, Shape::Ellipse(x.sqrt(), y.sqrt())),
        (false, false) => None,
        (along_x, _) => {
            let (angle, x, y) = if along_x { (main, x, y) } else { (main + FRAC_PI_2, y, x) };
            let behind = (start - centre).dot(DVec2::from_angle(angle)) < 0.0;
            let angle = if behind { angle + TAU / 2.0 } else { angle };
            (y < 0.0).then_some(())?;
            shape(angle, Shape::Hyperbola(x.sqrt(), (-y).sqrt()))
        }
    }
}
