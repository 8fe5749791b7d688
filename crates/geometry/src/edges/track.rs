//! The place in a face's `(u, v)` next to a point of one of its edges.
//!
//! ```text
//!     curve of the use ●───●───●───●───●   samples: the nearest one begins
//!                            ▲
//!                        ╶───┘ p           Newton's method along the curve leads to the point next to p
//! ```

use super::Sheet;
use crate::model::EdgeUse;
use crate::spline::Bezier;
use glam::{DVec2, DVec3};

/// Steps of each curve between samples.
const SAMPLES: u32 = 24;
/// Steps of Newton's method.
const STEPS: u32 = 4;

/// The curves of an edge's use in its face's `(u, v)`, and points on them.
#[derive(Clone, Debug)]
pub struct Track {
    curves: Vec<Bezier<DVec3>>,
    /// Number of the curve, parameter, point.
    samples: Vec<(usize, f64, DVec3)>,
}

impl Track {
    /// Of a use of an edge by the face of `sheet`; curves within `reach` of one point are left out.
    pub fn new(sheet: &Sheet<'_>, used: &EdgeUse, reach: f64) -> Self {
        let curves = sheet.along(used, reach);
        let share = |k: u32| f64::from(k) / f64::from(SAMPLES);
        let of = |(i, c): (usize, &Bezier<DVec3>)| {
            (0..=SAMPLES).map(|k| (i, share(k), sheet.at(c, share(k)))).collect::<Vec<_>>()
        };
        let samples = curves.iter().enumerate().flat_map(of).collect();
        Self { curves, samples }
    }

    /// `(u, v)` of the track's point next to `p`, part coordinates; `None` where all curves are left out. `sheet` is that
    /// of [`Track::new`].
    pub fn place(&self, sheet: &Sheet<'_>, p: DVec3) -> Option<DVec2> {
        let nearest = self.samples.iter().min_by(|a, b| a.2.distance_squared(p).total_cmp(&b.2.distance_squared(p)))?;
        let (curve, mut t) = (&self.curves[nearest.0], nearest.1);
        for _ in 0..STEPS {
            let (surface, along) = sheet.frame(curve, t);
            let step = (p - surface.point).dot(along) / along.length_squared();
            t = if step.is_finite() { (t + step).clamp(0.0, 1.0) } else { t };
        }
        Some(curve.point(t))
    }
}
