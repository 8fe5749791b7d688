//! From a support to the rational B-spline that is drawn: exact, and tight around a box.
//!
//! ```text
//!   turned surfaces                                extruded surfaces
//!   row j of the net: arcs of the profile's        two rows: the profile's control
//!   control point j about the axis                 points moved by v0 and v1
//!
//!     P_j ──── P_j^mid (w cos h) ──── P_j'           P + v1 d ────────── ·
//!        angle a      on the tangents   angle b      P + v0 d ────────── ·
//! ```
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 1997, sections 8.4 and 8.5.

use super::curve::Curve;
use super::law::Axis;
use super::support::{Form, Support};
use crate::spline::arc::{assemble, revolve};
use crate::spline::{Control, SplineError, Surface};
use glam::{DVec3, DVec4};

/// A carrier and how native parameters map to its domain.
#[derive(Clone, Debug)]
pub(super) struct Carrier {
    /// The surface.
    pub surface: Surface,
    /// Its two directions.
    pub axes: [Axis; 2],
}

/// Why there is no carrier.
#[derive(Clone, Debug)]
pub(super) enum CarrierError {
    /// A closed spline cannot be repeated across its seam.
    Seam,
    /// The control net is invalid.
    Spline(SplineError),
}

impl From<SplineError> for CarrierError {
    fn from(e: SplineError) -> Self {
        Self::Spline(e)
    }
}

impl Support {
    /// The surface over the native box `range` (splines: over all of their domain, see
    /// [`SplineForm::carrier`](super::spline::SplineForm::carrier)).
    ///
    /// Accuracy: rounding, below `1e-14` of the distance to the frame's origin. Over a full turn the
    /// first and last columns of the net are the same numbers.
    pub fn carrier(&self, range: [(f64, f64); 2]) -> Result<Carrier, CarrierError> {
        let laws = self.laws();
        let axes = [0, 1].map(|i| Axis::new(laws[i], range[i].0, range[i].1));
        let [(u0, u1), (v0, v1)] = range;
        let f = &self.frame;
        let line = |at: DVec3, direction: DVec3| Curve::Line { origin: f.origin + at, direction };
        let circle = |at: DVec3, r: f64| Curve::Ellipse { centre: f.origin + at, x: f.x * r, y: f.z * r };
        let surface = match &self.form {
            Form::Plane => {
                let corner = |u: f64, v: f64| DVec4::from_point(f.origin + f.x * u + f.y * v, 1.0);
                let points = vec![corner(u0, v0), corner(u1, v0), corner(u0, v1), corner(u1, v1)];
                Surface::new((1, 1), vec![u0, u0, u1, u1], vec![v0, v0, v1, v1], points)?
            }
            Form::Cylinder { radius } => self.revolve(&line(f.x * *radius, f.z), &axes[0], range[1])?,
            Form::Cone { radius, slope } => {
                self.revolve(&line(f.x * *radius, f.x * *slope + f.z), &axes[0], range[1])?
            }
            Form::Sphere { radius } => self.revolve(&circle(DVec3::ZERO, *radius), &axes[0], range[1])?,
            Form::Torus { major, minor } => self.revolve(&circle(f.x * *major, *minor), &axes[0], range[1])?,
            Form::Revolution { profile } => self.revolve(profile, &axes[0], range[1])?,
            Form::Extrusion { profile, direction } => {
                let (degree, knots, row) = assemble(&profile.beziers(u0, u1));
                let moved = |v: f64| row.iter().map(move |p| *p + (*direction * (v * p.w)).extend(0.0));
                let points = moved(v0).chain(moved(v1)).collect();
                Surface::new((degree, 1), knots, vec![v0, v0, v1, v1], points)?
            }
            Form::Spline(s) => {
                let surface = s.carrier(range).map_err(|e| e.map_or(CarrierError::Seam, CarrierError::Spline))?;
                let (u, v) = surface.domain();
                let axes = [Axis::new(laws[0], u.0, u.1), Axis::new(laws[1], v.0, v.1)];
                return Ok(Carrier { surface, axes });
            }
        };
        Ok(Carrier { surface, axes })
    }

    /// `profile` over `v` turned about the frame's axis over the pieces of `turns`.
    fn revolve(&self, profile: &Curve, turns: &Axis, (v0, v1): (f64, f64)) -> Result<Surface, SplineError> {
        let (degree, knots_v, profile) = assemble(&profile.beziers(v0, v1));
        revolve((degree, knots_v, &profile), (self.frame.origin, self.frame.z), &turns.knots)
    }
}
