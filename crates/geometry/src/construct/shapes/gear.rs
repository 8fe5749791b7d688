//! Gears and their blanks.
//!
//! ```text
//!   blank, cut in half              bore with keyway        tooth of a spur gear
//!        ┌──┐  ┌──┐                    ┌─┐                     ╭──╮   tip circle     r + m
//!   ┌────┘  │  │  └────┐              ╱   ╲                   ╱    ╲  flanks: involutes of the base circle
//!   │       │  │       │             (     )                 │      │ radial below the base circle
//!   └───────┘──└───────┘              ╲ _ ╱               ╶──┘      └──╴  root circle r - 1.25 m
//! ```
//!
//! Source: ISO 53, *Cylindrical gears — standard basic rack tooth profile*, profile A, without its root fillet;
//! J. Shigley, *Mechanical Engineering Design*, chapter 13.

use super::super::{Chain, ConstructError, extrude, extruded_solid};
use super::round::{circle, level};
use super::{Body, below, positive};
use crate::model::{Part, SurfaceKind, TrimLoop};
use crate::spline::arc::{arc, assemble, pieces};
use crate::spline::{BSpline, Bezier, Span, Surface};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Most teeth.
const MOST_TEETH: u32 = 1024;
/// Halvings of a flank's parameters.
const HALVINGS: u32 = 40;
/// Factor for the error between the samples; a flank's error has one hump a piece.
const MARGIN: f64 = 1.1;

/// A rectangular slot along a bore, at its side of positive x; model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyway {
    /// Across the slot.
    pub width: f64,
    /// From the bore's circle, where the slot's middle meets it, outwards.
    pub depth: f64,
}

/// A stepped disc with a bore, and perhaps a keyway: the blank of a gear. Lengths are model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearBlank {
    /// Radius of the disc.
    pub radius: f64,
    /// Height of the disc, from `z = 0`.
    pub width: f64,
    /// Radius of the hub.
    pub hub_radius: f64,
    /// Height of the hub, from `z = 0` to above the disc.
    pub hub_width: f64,
    /// Radius of the bore.
    pub bore: f64,
    /// Slot of the bore.
    pub keyway: Option<Keyway>,
}

impl GearBlank {
    /// The solid, exact. Faces: rim, ledge, hub, bottom, top, then the walls of bore and keyway.
    ///
    /// # Errors
    /// A length that is not positive; bore, hub and disc not in growing order; a hub no longer than the disc; a
    /// keyway wider than the bore or that reaches the hub's side.
    pub fn build(&self) -> Result<Body, ConstructError> {
        positive("the radius of a gear blank", self.radius)?;
        positive("the width of a gear blank", self.width)?;
        below("the hub radius of a gear blank", self.hub_radius, self.radius, "below the disc's radius")?;
        below("the bore of a gear blank", self.bore, self.hub_radius, "below the hub's radius")?;
        positive("the hub width of a gear blank", self.hub_width)?;
        if self.hub_width <= self.width {
            let (what, value) = ("the hub width of a gear blank", self.hub_width);
            return Err(ConstructError::Range { what, value, must: "above the disc's width" });
        }
        let bore = self.bore_walls()?;
        let hole = TrimLoop::new(bore.iter().flat_map(|c| c.beziers()).map(|s| s.piece).collect(), DVec2::ZERO)?;
        let hole = hole.reversed();
        let mut part = Part { closed: true, ..Part::default() };
        let wall = |r: f64, from: f64, to: f64| -> Result<Surface, ConstructError> {
            let rim = round(r, 0.0, TAU, from)?;
            extrude(&rim, DVec3::Z * (to - from))
        };
        let (r, h) = (self.radius, self.hub_radius);
        part.add(SurfaceKind::Cylinder, wall(r, 0.0, self.width)?, Vec::new(), true);
        part.add(SurfaceKind::Plane, level(r, self.width)?, vec![circle(r)?, circle(h)?.reversed()], true);
        part.add(SurfaceKind::Cylinder, wall(h, self.width, self.hub_width)?, Vec::new(), true);
        part.add(SurfaceKind::Plane, level(r, 0.0)?, vec![circle(r)?, hole.clone()], false);
        part.add(SurfaceKind::Plane, level(h, self.hub_width)?, vec![circle(h)?, hole], true);
        for c in &bore {
            let kind = if c.degree() == 1 { SurfaceKind::Plane } else { SurfaceKind::Cylinder };
            part.add(kind, extrude(&lifted(c)?, DVec3::Z * self.hub_width)?, Vec::new(), false);
        }
        Ok(Body::exact(part, None))
    }

    /// The outline of bore and keyway, counter-clockwise.
    fn bore_walls(&self) -> Result<Chain, ConstructError> {
        let Some(key) = self.keyway else {
            return Ok(vec![flattened(&round(self.bore, 0.0, TAU, 0.0)?)?]);
        };
        positive("the depth of a keyway", key.depth)?;
        below("the width of a keyway", key.width, 2.0 * self.bore, "below the bore's diameter")?;
        let half = 0.5 * key.width;
        let end = self.bore + key.depth;
        if end.hypot(half) >= self.hub_radius {
            let (what, value) = ("the reach of a keyway", end.hypot(half));
            return Err(ConstructError::Range { what, value, must: "below the hub's radius" });
        }
        let angle = (half / self.bore).asin();
        let bore = flattened(&round(self.bore, angle, TAU - angle, 0.0)?)?;
        let ends = [bore.point(bore.domain().0), bore.point(bore.domain().1)];
        let corners = [ends[1], DVec2::new(end, ends[1].y), DVec2::new(end, ends[0].y), ends[0]];
        let sides = corners.windows(2).map(|w| Ok(BSpline::from_bezier(Bezier::line(w[0], w[1]), 0.0, 1.0)?));
        [Ok(bore)].into_iter().chain(sides).collect()
    }
}

/// A spur gear with involute teeth. Lengths are model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpurGear {
    /// Pitch diameter over teeth, `m`.
    pub module: f64,
    /// Number of teeth.
    pub teeth: u32,
    /// Height of the teeth, from `z = 0`.
    pub width: f64,
    /// Radius of the bore; 0 for none.
    pub bore: f64,
    /// Between the line of action and the pitch circle's tangent, radians; 20 degrees are usual.
    pub pressure_angle: f64,
    /// Largest distance of a flank from its involute.
    pub tolerance: f64,
}

impl SpurGear {
    /// With 20 degrees of pressure angle, and flanks within `1e-6` of the module.
    pub fn new(module: f64, teeth: u32, width: f64, bore: f64) -> Self {
        let pressure_angle = 20f64.to_radians();
        Self { module, teeth, width, bore, pressure_angle, tolerance: 1e-6 * module }
    }

    /// The solid; the middle of the first tooth is at positive x. Faces: of each tooth a flank, the tip, the other
    /// flank, the root; the bore; bottom and top. All are exact but the flanks.
    ///
    /// # Errors
    /// * A length that is not positive; fewer than 4 teeth or more than 1024; a tolerance that is not reached.
    /// * Teeth that are pointed below the tip circle or meet above the root circle.
    /// * A bore that reaches the root circle.
    pub fn build(&self) -> Result<Body, ConstructError> {
        positive("the module of a gear", self.module)?;
        positive("the width of a gear", self.width)?;
        positive("the tolerance of a gear's flanks", self.tolerance)?;
        below("the pressure angle of a gear", self.pressure_angle, FRAC_PI_2, "below a right angle")?;
        if self.teeth < 4 {
            return Err(ConstructError::TooFew { what: "teeth of a gear", got: self.teeth as usize, needed: 4 });
        }
        if self.teeth > MOST_TEETH {
            let (got, most) = (self.teeth as usize, MOST_TEETH as usize);
            return Err(ConstructError::TooMany { what: "teeth of a gear", got, most });
        }
        let pitch = 0.5 * self.module * f64::from(self.teeth);
        let (base, tip, root) = (pitch * self.pressure_angle.cos(), pitch + self.module, pitch - 1.25 * self.module);
        // involute of the base circle: at parameter t the radius is base sqrt(1 + t^2), the angle t - atan t
        let at = |radius: f64| ((radius / base).powi(2) - 1.0).max(0.0).sqrt();
        let turn = |t: f64| t - t.atan();
        let (from, to) = (at(root), at(tip));
        let middle = FRAC_PI_2 / f64::from(self.teeth) + turn(self.pressure_angle.tan());
        let (foot, top) = (middle - turn(from), middle - turn(to));
        if top <= 0.0 {
            let (what, must) = ("half the angle of a tooth's tip", "positive: the teeth are pointed");
            return Err(ConstructError::Range { what, value: top, must });
        }
        let gap = PI / f64::from(self.teeth) - foot;
        if gap <= 0.0 {
            let (what, must) = ("half the angle of the gap between teeth", "positive: the teeth meet at their roots");
            return Err(ConstructError::Range { what, value: gap, must });
        }
        let mut deviation = 0.0;
        let flank = self.flank(base, (from, to), (root < base).then_some(root), &mut deviation)?;
        let mut outline: Chain = Vec::new();
        for k in 0..self.teeth {
            let tooth = TAU * f64::from(k) / f64::from(self.teeth);
            let up = placed(&flank, -middle, false)?;
            outline.push(placed(&up, tooth, false)?);
            outline.push(flattened(&round(tip, tooth - top, tooth + top, 0.0)?)?);
            outline.push(placed(&placed(&up, 0.0, true)?.reversed(), tooth, false)?);
            outline.push(flattened(&round(root, tooth + foot, tooth + foot + 2.0 * gap, 0.0)?)?);
        }
        let mut chains = vec![outline];
        if self.bore != 0.0 {
            below("the bore of a gear", self.bore, root, "below the root circle's radius")?;
            chains.push(vec![flattened(&round(self.bore, 0.0, TAU, 0.0)?)?]);
        }
        let mut part = extruded_solid(&chains, DVec3::Z * self.width)?;
        let teeth = 4 * self.teeth as usize;
        for (k, face) in part.faces.iter_mut().enumerate() {
            if face.kind == SurfaceKind::Extrusion && (k >= teeth || k % 2 == 1) {
                face.kind = SurfaceKind::Cylinder;
            }
        }
        Ok(Body { part, shape: None, deviation })
    }

    /// The involute that starts at `(base, 0)`, from the root up, over its arc length: cubic pieces, halved until
    /// they are within the tolerance; below the base circle a radius.
    fn flank(
        &self,
        base: f64,
        (from, to): (f64, f64),
        root: Option<f64>,
        deviation: &mut f64,
    ) -> Result<BSpline<DVec3>, ConstructError> {
        // s = t^2 / 2: dp/ds = base (cos t, sin t)
        let point = |s: f64| {
            let t = (2.0 * s).sqrt();
            let (sin, cos) = t.sin_cos();
            // sin t - t cos t without cancellation for small t
            let across =
                if t < 0.03 { t.powi(3) * (1.0 / 3.0 - t * t * (1.0 / 30.0 - t * t / 840.0)) } else { sin - t * cos };
            DVec2::new(cos + t * sin, across) * base
        };
        let slope = |s: f64| DVec2::from_angle((2.0 * s).sqrt()) * base;
        let mut spans: Vec<Span<Bezier<DVec3>>> = Vec::new();
        if let Some(root) = root {
            let piece = Bezier::line(DVec2::X * root, DVec2::X * base);
            spans.push(Span { start: 0.0, end: base - root, piece });
        }
        let offset = root.map_or(0.0, |r| base - r);
        let mut stack = vec![(0.5 * from * from, 0.5 * to * to, HALVINGS)];
        let first = 0.5 * from * from;
        while let Some((a, b, halvings)) = stack.pop() {
            let third = (b - a) / 3.0;
            let points = [point(a), point(a) + slope(a) * third, point(b) - slope(b) * third, point(b)];
            let piece = Bezier { points: points.iter().map(|p| p.extend(1.0)).collect() };
            let off = (1..16).map(|k| f64::from(k) / 16.0);
            let off = off.map(|x| piece.point(x).distance(point(a + (b - a) * x))).fold(0.0, f64::max) * MARGIN;
            if off > self.tolerance {
                if halvings == 0 {
                    return Err(ConstructError::Bound { asked: self.tolerance, reached: off, pieces: spans.len() + 1 });
                }
                let half = 0.5 * (a + b);
                stack.push((half, b, halvings - 1));
                stack.push((a, half, halvings - 1));
                continue;
            }
            *deviation = deviation.max(off);
            let length = |s: f64| offset + base * (s - first);
            spans.push(Span { start: length(a), end: length(b), piece });
        }
        let (degree, knots, points) = assemble(&spans);
        Ok(BSpline::new(degree, knots, points)?)
    }
}

/// An arc about z at a height, over its angle.
fn round(radius: f64, from: f64, to: f64, z: f64) -> Result<BSpline<DVec4>, ConstructError> {
    let span = |k: &[f64]| {
        let piece = arc(DVec3::Z * z, DVec3::X * radius, DVec3::Y * radius, k[0], k[1]);
        Span { start: k[0], end: k[1], piece }
    };
    let mut spans: Vec<_> = pieces(from, to, FRAC_PI_2).windows(2).map(span).collect();
    if to - from == TAU {
        let last = spans.len() - 1;
        spans[last].piece.points[2] = spans[0].piece.points[0];
    }
    let (degree, knots, points) = assemble(&spans);
    Ok(BSpline::new(degree, knots, points)?)
}

/// A curve of the plane z = 0 in its coordinates.
fn flattened(c: &BSpline<DVec4>) -> Result<BSpline<DVec3>, ConstructError> {
    let points = c.points().iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
    Ok(BSpline::new(c.degree(), c.knots().to_vec(), points)?)
}

/// A planar curve in the plane z = 0.
fn lifted(c: &BSpline<DVec3>) -> Result<BSpline<DVec4>, ConstructError> {
    let points = c.points().iter().map(|p| DVec4::new(p.x, p.y, 0.0, p.z)).collect();
    Ok(BSpline::new(c.degree(), c.knots().to_vec(), points)?)
}

/// Mirrored at the x axis or not, then turned about the origin.
fn placed(c: &BSpline<DVec3>, angle: f64, mirror: bool) -> Result<BSpline<DVec3>, ConstructError> {
    let turn = DVec2::from_angle(angle);
    let place = |p: &DVec3| turn.rotate(DVec2::new(p.x, if mirror { -p.y } else { p.y })).extend(p.z);
    Ok(BSpline::new(c.degree(), c.knots().to_vec(), c.points().iter().map(place).collect())?)
}
