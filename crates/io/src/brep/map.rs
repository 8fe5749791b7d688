//! Surfaces evaluated as the file states them, before there is a carrier.

use super::SurfaceGeometry;
use super::support::Support;
use crate::spline::Jet;
use glam::{DVec2, DVec3};

/// A surface as a function of its parameters in ISO 10303-42.
#[derive(Clone, Debug)]
pub struct SurfaceMap(Support);

impl SurfaceMap {
    /// `eps`: distance in mm below which two points are the same.
    ///
    /// # Errors
    /// Why its numbers define no surface.
    pub fn new(surface: &SurfaceGeometry, eps: f64) -> Result<Self, &'static str> {
        Support::new(surface, eps).map(Self)
    }

    /// Point in mm and derivatives at `(u, v)`; parameters wrap where the surface closes, and are
    /// clamped where it ends.
    pub fn jet(&self, uv: DVec2) -> Jet {
        self.0.jet(uv)
    }

    /// Distance of `p` from the surface near `uv`, mm: a foot that Newton's method finds from there.
    pub fn distance(&self, p: DVec3, uv: DVec2) -> f64 {
        self.0.nearest(p, Some(uv), f64::INFINITY).1
    }

    /// The whole range of each parameter, where it has one.
    pub fn natural(&self) -> [Option<(f64, f64)>; 2] {
        self.0.natural
    }

    /// After how much a parameter repeats; axis 0 is `u`.
    pub fn natural_period(&self, axis: usize) -> Option<f64> {
        self.0.periods[axis]
    }

    /// Parameters strictly inside `(a, b)` across which the surface may crease; axis 0 is `u`.
    pub fn creases(&self, axis: usize, a: f64, b: f64) -> Vec<f64> {
        self.0.creases(axis, a, b)
    }

    /// The surface has no border: each parameter is periodic, or ends at poles.
    pub fn is_closed(&self) -> bool {
        self.0.is_closed()
    }
}
