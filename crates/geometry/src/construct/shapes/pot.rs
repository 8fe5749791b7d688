//! A teapot of our own: four closed free-form solids, about 22 units wide and 12 high.
//!
//! ```text
//!            _o_             lid: turned
//!     __   ╭─────╮   //      pot: turned, hollow, open at the top
//!    (  ╲╭╯       ╲╭╯/       handle: lofted through ellipses, ends inside the pot's wall
//!     ╲__│         │╱        spout: a loft within a loft, from the pot's wall to the lip
//!         ╲_______╱
//! ```
//!
//! The solids overlap where they join; their union is the pot. All control points are this file's.

use super::super::curve::ellipse;
use super::super::{ConstructError, capped_solid, loft};
use super::Body;
use super::round::{Edge, turned};
use crate::model::SurfaceKind;
use crate::spline::{BSpline, Control, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The solids of a teapot.
#[derive(Clone, Debug, PartialEq)]
pub struct Teapot {
    /// A vessel with a wall.
    pub pot: Body,
    /// Rests a little above the rim.
    pub lid: Body,
    /// At negative x.
    pub handle: Body,
    /// At positive x, hollow.
    pub spout: Body,
}

/// Control points `(radius, height)` of the vessel's outside, from its foot to the rim.
const OUTSIDE: [(f64, f64); 7] = [(4.0, 0.0), (6.2, 0.1), (8.2, 2.6), (7.6, 5.6), (5.2, 8.4), (3.3, 9.0), (3.2, 9.6)];
/// Over the rim.
const RIM: [(f64, f64); 3] = [(3.2, 9.6), (3.05, 9.8), (2.9, 9.6)];
/// From the rim down inside to the axis.
const INSIDE: [(f64, f64); 7] = [(2.9, 9.6), (2.9, 8.8), (4.7, 8.0), (7.1, 5.5), (7.6, 2.8), (5.8, 0.5), (0.0, 0.5)];
/// From the lid's edge to the top of its knob.
const LID: [(f64, f64); 8] =
    [(3.4, 9.72), (3.4, 10.1), (1.6, 10.5), (0.5, 10.6), (0.3, 10.9), (1.0, 11.3), (0.9, 11.9), (0.0, 11.9)];

/// An elliptic section of a loft.
struct Section {
    /// Of the centre, in the plane y = 0.
    x: f64,
    z: f64,
    /// The way along, in degrees from x towards z.
    way: f64,
    /// Half widths across: in the plane y = 0, and along y.
    tall: f64,
    wide: f64,
}

const fn section(x: f64, z: f64, way: f64, tall: f64, wide: f64) -> Section {
    Section { x, z, way, tall, wide }
}

/// From the lower end to the upper one.
const HANDLE: [Section; 7] = [
    section(-7.3, 2.7, 180.0, 0.45, 0.5),
    section(-8.4, 2.72, 172.0, 0.42, 0.55),
    section(-9.7, 3.4, 125.0, 0.4, 0.62),
    section(-10.4, 5.3, 92.0, 0.4, 0.65),
    section(-9.7, 7.2, 45.0, 0.4, 0.62),
    section(-7.9, 7.75, -2.0, 0.42, 0.55),
    section(-5.72, 7.2, -20.0, 0.38, 0.45),
];

/// From the pot to the lip; the inside is as much narrower as `WALL` says.
const SPOUT: [Section; 5] = [
    section(7.35, 3.7, 4.0, 1.15, 1.05),
    section(8.5, 4.1, 28.0, 1.0, 0.92),
    section(9.5, 5.4, 58.0, 0.85, 0.8),
    section(10.2, 7.2, 66.0, 0.68, 0.68),
    section(11.1, 8.7, 52.0, 0.6, 0.66),
];
/// Half widths of the spout's inside, in shares of the outside's.
const WALL: f64 = 0.75;

/// The teapot.
///
/// # Errors
/// None for these control points; the constructions it calls have some.
pub fn teapot() -> Result<Teapot, ConstructError> {
    let vessel = [Edge::line((0.0, 0.0), OUTSIDE[0])?, free(&OUTSIDE, 3)?, free(&RIM, 2)?, free(&INSIDE, 3)?];
    let lid = [
        Edge::line((0.0, 9.3), (2.75, 9.3))?,
        Edge::line((2.75, 9.3), (2.75, 9.72))?,
        Edge::line((2.75, 9.72), LID[0])?,
        free(&LID, 3)?,
    ];
    Ok(Teapot {
        pot: Body::exact(turned(&vessel)?, None),
        lid: Body::exact(turned(&lid)?, None),
        handle: Body::exact(capped_solid(&[wall(&HANDLE, 1.0)?])?, None),
        spout: Body::exact(capped_solid(&[wall(&SPOUT, 1.0)?, wall(&SPOUT, WALL)?])?, None),
    })
}

/// A profile's clamped uniform B-spline.
fn free(points: &[(f64, f64)], degree: usize) -> Result<Edge, ConstructError> {
    let spans = points.len() - degree;
    let knots = [0].repeat(degree).into_iter().chain(0..=spans).chain([spans].repeat(degree));
    let points = points.iter().map(|p| DVec3::from_point(DVec2::from(*p), 1.0)).collect();
    let curve = BSpline::new(degree, knots.map(|k| k as f64).collect(), points)?;
    Ok(Edge { kind: SurfaceKind::Revolution, curve })
}

/// The loft through sections, `share` of them wide.
fn wall(sections: &[Section], share: f64) -> Result<Surface, ConstructError> {
    let curve = |s: &Section| {
        let (sin, cos) = s.way.to_radians().sin_cos();
        // the way along is (cos, 0, sin); across it, and across y, is this
        let up = DVec3::new(-sin, 0.0, cos);
        ellipse(DVec3::new(s.x, 0.0, s.z), up * (s.tall * share), DVec3::Y * (s.wide * share), 0.0, TAU)
    };
    loft(&sections.iter().map(curve).collect::<Result<Vec<_>, _>>()?, false)
}
