//! Solids of eight corners and six faces, some of which may coincide.
//!
//! ```text
//!      8 ─── 7       flat faces, convex: half-spaces
//!     ╱│    ╱│       faces that are not flat: the bilinear patches between their corners, and a warning, for
//!    5 ─── 6 │       BRL-CAD leaves open what such a solid is
//!    │ 4 ──│ 3
//!    1 ─── 2
//! ```

use super::Fault;
use super::object::Record;
use crate::import::scad::planes;
use crate::import::solid::{Assembly, Placed, around};
use crate::import::{Place, Warnings};
use crate::model::{Bounds, Face, Part, Shape, SurfaceKind};
use crate::spline::Surface;
use glam::DVec3;
use std::sync::Arc;

/// Corners of the six faces, counter-clockwise from outside when 1 to 4 turn left seen from 5 to 8.
const FACES: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2]];
/// Distance from the plane of a face's corners that is rounding of single precision, relative to the size.
const FLAT: f64 = 4e-6;

/// A solid as a node.
pub(super) fn node(
    to: &mut Assembly,
    object: &Record<'_>,
    placed: &Placed,
    warnings: &mut Warnings,
) -> Result<u32, Fault> {
    let corners: Vec<DVec3> = (1..=8).map(|i| object.vector(&format!("V{i}"))).collect::<Result<_, _>>()?;
    let first = |i: usize| corners.iter().position(|p| *p == corners[i]).unwrap_or(i);
    let face = |f: &[usize; 4]| {
        let mut f: Vec<u32> = f.iter().map(|i| first(*i) as u32).collect();
        f.dedup();
        f
    };
    let faces: Vec<Vec<u32>> = FACES.iter().map(face).filter(|f| f.len() >= 3).collect();
    if let Some(planes) = planes(&corners, &faces) {
        return Ok(to.half_spaces(around(corners.iter().copied()), &planes, placed));
    }
    let size = corners.iter().copied().fold(Bounds::EMPTY, Bounds::with).diagonal();
    let off = FACES.iter().map(|f| out_of_plane(f.map(|i| corners[i]))).fold(0.0, f64::max);
    if off <= FLAT * size {
        return Err(object.fault("it is not convex, or has no volume, and is not read"));
    }
    let (part, volume) = bilinear(&corners).map_err(|what| object.fault(what))?;
    if volume <= FLAT * size * size * size {
        return Err(object.fault("its faces turn inwards, or enclose no volume"));
    }
    warnings.push(
        "faces that are not flat",
        || Place::Line(object.line),
        || format!("{} {}: corners lie {off:.3e} mm off, and patches are drawn between them", object.name, object.kind),
    );
    Ok(to.add(Shape::Part(Arc::new(part)), placed))
}

/// Distance between the diagonals of a face: of a flat one they meet.
fn out_of_plane([a, b, c, d]: [DVec3; 4]) -> f64 {
    let across = (c - a).cross(d - b).try_normalize();
    across.map_or(0.0, |n| n.dot(b - a).abs())
}

/// Patches between the corners of each face, and the volume within.
fn bilinear(corners: &[DVec3]) -> Result<(Part, f64), String> {
    let volume: f64 = FACES.iter().map(|f| f.map(|i| corners[i] - corners[0])).map(flux).sum();
    let mut part = Part { closed: true, ..Part::default() };
    for (id, f) in (1..).zip(FACES) {
        let [a, b, c, d] = f.map(|i| corners[i]);
        if (a == b || c == d) && (b == c || d == a) || a == c || b == d {
            continue;
        }
        let net = [a, b, d, c].map(|p| p.extend(1.0)).to_vec();
        let knots = || vec![0.0, 0.0, 1.0, 1.0];
        let surface = Surface::new((1, 1), knots(), knots(), net).map_err(|e| e.to_string())?;
        let kind = SurfaceKind::BSpline;
        part.faces.push(Face { id, kind, surface, loops: Vec::new(), same_sense: volume > 0.0, colour: None });
    }
    Ok((part, volume.abs()))
}

/// A third of the flow of the position through a bilinear patch: the mean of both ways to halve it.
fn flux([a, b, c, d]: [DVec3; 4]) -> f64 {
    let tetra = |p: DVec3, q: DVec3, r: DVec3| p.dot(q.cross(r)) / 6.0;
    0.5 * (tetra(a, b, c) + tetra(a, c, d) + tetra(a, b, d) + tetra(b, c, d))
}
