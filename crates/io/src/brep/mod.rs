//! Boundary representation as CAD files state it, and its exact conversion to [`Face`](crate::model::Face)s.
//!
//! A file says: *this analytic or spline surface, bounded by these edges in space*. The engine draws:
//! *this rational B-spline surface, trimmed by these loops in its (u, v) domain*. This module is the
//! bridge, shared by every file format; no file syntax and no GPU is in it.
//!
//! ```text
//!   SurfaceGeometry ──carrier over the loops' box──▶ Surface          (exact)
//!   Edge (3-D curve, two ends) ──invert on surface──▶ Bézier (u, v)   (closed form, or fitted with
//!                                                                      a bound measured in 3-D)
//!   seams, poles, periods ──────────────────────────▶ TrimLoop        (closed, oriented)
//! ```
//!
//! The way of one face through the files of this folder:
//!
//! | step | files |
//! |---|---|
//! | edges and faces of a body that contradict each other | `settle` |
//! | curves and surfaces made ready | `curve`, `pieces`, `edge`; `support`, `invert`, `spline` |
//! | curves and surfaces derived from other ones | `derived`, `approximate` |
//! | edge → pre-image in the standard's own `(u, v)` | `order`; `trace`, `border`, `lines`, `preimage`, `strand` |
//! | strands → loops without seams, oriented | `loops`; `rims`, `cut`; `nest`, `outline` |
//! | the standard's `(u, v)` → a spline's | `law`, `carrier`, `fit` |
//! | loops stated in a spline's own `(u, v)` | `given` |
//! | lost faces that leave no gap | `sliver` |
//!
//! Before these steps, `sweep` makes the faces of swept solids, and `similarity` copies curves and surfaces.

mod approximate;
mod border;
mod build;
mod carrier;
mod curve;
mod cut;
mod derived;
mod edge;
mod error;
mod fit;
mod frame;
mod given;
mod invert;
mod law;
mod lines;
mod loops;
mod map;
mod nest;
mod order;
mod outline;
mod pieces;
mod preimage;
mod rims;
mod settle;
mod similarity;
mod sliver;
mod spline;
mod strand;
mod support;
mod sweep;
mod trace;

#[cfg(test)]
mod tests;

pub use build::{BuiltFace, build_face, crossing_note};
pub use derived::{curve_on_surface, offset_curve, offset_surface, on_its_side};
pub use error::BuildError;
pub use given::face_in_parameters;
pub use map::SurfaceMap;
pub use settle::settle;
pub use similarity::Similarity;
pub use sweep::{Motion, sweep};

use crate::spline::{BSpline, Surface};
use glam::{DVec3, DVec4};

/// A right-handed orthonormal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its origin.
    pub origin: DVec3,
    /// Unit x axis (STEP: the reference direction made orthogonal to the axis).
    pub x: DVec3,
    /// Unit y axis, `z × x`.
    pub y: DVec3,
    /// Unit z axis.
    pub z: DVec3,
}

/// A surface as files state it. Lengths in millimetres, angles in radians; parametrisations are
/// those of ISO 10303-42.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum SurfaceGeometry {
    /// `origin + u x + v y`
    Plane {
        frame: Frame,
    },
    /// `origin + r (cos u x + sin u y) + v z`
    Cylinder {
        frame: Frame,
        radius: f64,
    },
    /// `origin + (r + v tan a)(cos u x + sin u y) + v z`
    Cone {
        frame: Frame,
        radius: f64,
        half_angle: f64,
    },
    /// `origin + r cos v (cos u x + sin u y) + r sin v z`
    Sphere {
        frame: Frame,
        radius: f64,
    },
    /// `origin + (R + r cos v)(cos u x + sin u y) + r sin v z`
    Torus {
        frame: Frame,
        major: f64,
        minor: f64,
    },
    /// `profile(v)` turned by `u` about the axis through `origin`
    Revolution {
        profile: Box<CurveGeometry>,
        origin: DVec3,
        axis: DVec3,
    },
    /// `profile(u) + v direction`
    Extrusion {
        profile: Box<CurveGeometry>,
        direction: DVec3,
    },
    BSpline(Surface),
    /// This rectangle of the basis' parameters only. A face without loops shows all of it; loops may be holes in it,
    /// its [natural border](Boundary::Natural).
    Window {
        basis: Box<SurfaceGeometry>,
        u: (f64, f64),
        v: (f64, f64),
    },
}

/// A curve in space as files state it.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum CurveGeometry {
    /// `origin + t direction` (direction not normalised)
    Line {
        origin: DVec3,
        direction: DVec3,
    },
    /// `origin + r (cos t x + sin t y)`
    Circle {
        frame: Frame,
        radius: f64,
    },
    /// `origin + a cos t x + b sin t y`
    Ellipse {
        frame: Frame,
        semi_x: f64,
        semi_y: f64,
    },
    /// `origin + a cosh t x + b sinh t y`
    Hyperbola {
        frame: Frame,
        semi_x: f64,
        semi_y: f64,
    },
    /// `origin + f t² x + 2 f t y`
    Parabola {
        frame: Frame,
        focal: f64,
    },
    BSpline(BSpline<DVec4>),
    /// Only the part of `basis` from parameter `start` to `end`; `forward` false runs it backwards.
    Trimmed {
        basis: Box<CurveGeometry>,
        start: f64,
        end: f64,
        forward: bool,
    },
    /// Curves end to end (a polyline is a composite of trimmed lines or a degree-1 B-spline).
    Composite(Vec<CurveGeometry>),
}

/// An edge: the part of a curve between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Number in the source, for messages.
    pub id: u32,
    /// The curve that carries it.
    pub curve: CurveGeometry,
    /// Start point; equal to `end` for a closed edge.
    pub start: DVec3,
    /// End point.
    pub end: DVec3,
    /// The edge runs along increasing parameters of the curve.
    pub same_sense: bool,
}

impl Edge {
    /// Adds straight edges from point to point to `edges`, and returns their places.
    pub fn chain(id: u32, points: &[DVec3], edges: &mut Vec<Self>) -> Vec<usize> {
        let first = edges.len();
        edges.extend(points.windows(2).filter(|pair| pair[0] != pair[1]).map(|pair| {
            let (start, end) = (pair[0], pair[1]);
            let curve = CurveGeometry::Line { origin: start, direction: end - start };
            Self { id, curve, start, end, same_sense: true }
        }));
        (first..edges.len()).collect()
    }
}

/// One loop of a face, in the direction that keeps the face on its left when seen against the
/// outward normal of the *surface* (bound orientation already applied).
#[derive(Clone, Debug, PartialEq)]
pub enum Boundary {
    /// Indices into the edge list; `true` runs the edge from start to end.
    Edges(Vec<(usize, bool)>),
    /// A single point: the pole of a sphere, the tip of a cone.
    Vertex(DVec3),
    /// The border of the surface's own domain, in addition to the other bounds.
    Natural,
}

/// A face as files state it.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceGeometry {
    /// Number in the source.
    pub id: u32,
    /// The surface that carries it.
    pub surface: SurfaceGeometry,
    /// Its loops, in any order; empty: the whole (closed) surface.
    pub bounds: Vec<Boundary>,
    /// The face's outward normal is the surface's.
    pub same_sense: bool,
    /// The neighbours contradict the directions of its loops. On a closed surface, where only directions say which side
    /// of the loops is the face, the smaller side is taken.
    pub ambiguous: bool,
}
