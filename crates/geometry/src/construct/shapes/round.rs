//! Blocks and solids of revolution.
//!
//! ```text
//!   z ▲  profile, the solid on its left          an edge along r: a plane, trimmed by whole circles
//!     │──◀──┐                                    any other: a lathe's face, poles where it meets the axis
//!     │     ▲
//!     │──▶──┘─▶ r
//! ```

use super::super::curve::ellipse;
use super::super::{ConstructError, lathe};
use super::{Body, below, positive};
use crate::model::{Part, Shape, SurfaceKind, TrimLoop};
use crate::spline::{BSpline, Bezier, Control, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// One edge of a profile `(radius, height)`, run with the solid on the left.
pub(super) struct Edge {
    pub kind: SurfaceKind,
    pub curve: BSpline<DVec3>,
}

impl Edge {
    /// A straight edge: a plane, cylinder or cone.
    pub fn line(from: (f64, f64), to: (f64, f64)) -> Result<Self, ConstructError> {
        let kind = match () {
            () if from.1 == to.1 => SurfaceKind::Plane,
            () if from.0 == to.0 => SurfaceKind::Cylinder,
            () => SurfaceKind::Cone,
        };
        let curve = BSpline::from_bezier(Bezier::line(DVec2::from(from), DVec2::from(to)), 0.0, 1.0)?;
        Ok(Self { kind, curve })
    }

    /// An arc about `centre`, counter-clockwise.
    fn arc(kind: SurfaceKind, centre: f64, radius: f64, from: f64, to: f64) -> Result<Self, ConstructError> {
        let arc = ellipse(DVec3::X * centre, DVec3::X * radius, DVec3::Y * radius, from, to)?;
        let points = arc.points().iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
        Ok(Self { kind, curve: BSpline::new(2, arc.knots().to_vec(), points)? })
    }
}

/// The solid of revolution inside `edges`.
pub(super) fn turned(edges: &[Edge]) -> Result<Part, ConstructError> {
    let mut part = Part { closed: true, ..Part::default() };
    for edge in edges {
        if edge.kind == SurfaceKind::Plane {
            let ends = [edge.curve.points()[0].point(), edge.curve.points()[1].point()];
            let radii = [ends[0].x.max(ends[1].x), ends[0].x.min(ends[1].x)];
            let circles =
                [circle(radii[0])?].into_iter().chain((radii[1] > 0.0).then(|| circle(radii[1])).transpose()?);
            let loops = circles.enumerate().map(|(k, c)| if k == 0 { c } else { c.reversed() }).collect();
            // a profile that runs outwards has the solid above
            part.add(SurfaceKind::Plane, level(radii[0], ends[0].y)?, loops, ends[1].x < ends[0].x);
        } else {
            part.add(edge.kind, lathe(&edge.curve, TAU)?, Vec::new(), true);
        }
    }
    Ok(part)
}

/// The circle about the origin as a trim loop, counter-clockwise; bit for bit the rims of a lathe.
pub(super) fn circle(radius: f64) -> Result<TrimLoop, ConstructError> {
    let c = ellipse(DVec3::ZERO, DVec3::X * radius, DVec3::Y * radius, 0.0, TAU)?;
    let flat =
        |b: &Bezier<glam::DVec4>| Bezier { points: b.points.iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect() };
    Ok(TrimLoop::new(c.beziers().iter().map(|s| flat(&s.piece)).collect(), DVec2::ZERO)?)
}

/// The plane `(u, v, z)` over the square of half side `radius`.
pub(super) fn level(radius: f64, z: f64) -> Result<Surface, ConstructError> {
    let r = radius;
    let net = [(-r, -r), (r, -r), (-r, r), (r, r)].map(|(x, y)| DVec3::new(x, y, z).extend(1.0));
    Ok(Surface::new((1, 1), vec![-r, -r, r, r], vec![-r, -r, r, r], net.to_vec())?)
}

/// The box between two corners: six planes, `u` and `v` their lengths. Order of faces: -x +x -y +y -z +z.
///
/// # Errors
/// A corner that is not finite, a side that is not positive.
pub fn block(min: DVec3, max: DVec3) -> Result<Body, ConstructError> {
    if !(min.is_finite() && max.is_finite()) {
        return Err(ConstructError::NotFinite { what: "a corner of a block" });
    }
    let side = max - min;
    positive("the side of a block along x", side.x)?;
    positive("the side of a block along y", side.y)?;
    positive("the side of a block along z", side.z)?;
    let mut part = Part { closed: true, ..Part::default() };
    for axis in 0..3 {
        let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
        for high in [false, true] {
            let corner = |at_p: bool, at_q: bool| {
                let pick = |k: usize| {
                    let at = if k == axis {
                        high
                    } else if k == p {
                        at_p
                    } else {
                        at_q
                    };
                    if at { max[k] } else { min[k] }
                };
                DVec3::new(pick(0), pick(1), pick(2)).extend(1.0)
            };
            let net = vec![corner(false, false), corner(true, false), corner(false, true), corner(true, true)];
            let knots = |length: f64| vec![0.0, 0.0, length, length];
            part.add(SurfaceKind::Plane, Surface::new((1, 1), knots(side[p]), knots(side[q]), net)?, Vec::new(), high);
        }
    }
    Ok(Body::exact(part, Some(Shape::Block { min, max })))
}

/// The ball about the origin: one face with two poles.
///
/// # Errors
/// A radius that is not positive.
pub fn sphere(radius: f64) -> Result<Body, ConstructError> {
    positive("the radius of a sphere", radius)?;
    let part = turned(&[Edge::arc(SurfaceKind::Sphere, 0.0, radius, -FRAC_PI_2, FRAC_PI_2)?])?;
    Ok(Body::exact(part, Some(Shape::Sphere { radius })))
}

/// The cylinder about z between `z = 0` and `height`. Faces: bottom, side, top.
///
/// # Errors
/// A radius or height that is not positive.
pub fn cylinder(radius: f64, height: f64) -> Result<Body, ConstructError> {
    positive("the radius of a cylinder", radius)?;
    positive("the height of a cylinder", height)?;
    let part = turned(&ring(0.0, radius, height)?)?;
    Ok(Body::exact(part, Some(Shape::Cylinder { radius, height })))
}

/// The profile of a rectangle from radius `a` to `b`.
fn ring(a: f64, b: f64, h: f64) -> Result<Vec<Edge>, ConstructError> {
    let mut edges = vec![Edge::line((a, 0.0), (b, 0.0))?, Edge::line((b, 0.0), (b, h))?, Edge::line((b, h), (a, h))?];
    if a > 0.0 {
        edges.push(Edge::line((a, h), (a, 0.0))?);
    }
    Ok(edges)
}

/// The cone about z with radius `bottom` at `z = 0` and `top` at `height`: one may be 0, the tip. Faces: bottom, side,
/// top, as far as they are there.
///
/// # Errors
/// A radius that is negative, or both 0; a height that is not positive.
pub fn cone(bottom: f64, top: f64, height: f64) -> Result<Body, ConstructError> {
    positive("the height of a cone", height)?;
    for (what, radius) in [("the bottom radius of a cone", bottom), ("the top radius of a cone", top)] {
        if radius != 0.0 {
            positive(what, radius)?;
        }
    }
    if bottom == 0.0 && top == 0.0 {
        return Err(ConstructError::Range { what: "the larger radius of a cone", value: 0.0, must: "positive" });
    }
    let mut edges = Vec::new();
    if bottom > 0.0 {
        edges.push(Edge::line((0.0, 0.0), (bottom, 0.0))?);
    }
    edges.push(Edge::line((bottom, 0.0), (top, height))?);
    if top > 0.0 {
        edges.push(Edge::line((top, height), (0.0, height))?);
    }
    Ok(Body::exact(turned(&edges)?, Some(Shape::Cone { bottom, top, height })))
}

/// The ring of radius `minor` around the circle of radius `major` about z: one face that closes both ways.
///
/// # Errors
/// A radius that is not positive; `minor` not below `major`: the faces would meet on the axis.
pub fn torus(major: f64, minor: f64) -> Result<Body, ConstructError> {
    positive("the major radius of a torus", major)?;
    below("the minor radius of a torus", minor, major, "below the major radius")?;
    let part = turned(&[Edge::arc(SurfaceKind::Torus, major, minor, 0.0, TAU)?])?;
    Ok(Body::exact(part, Some(Shape::Torus { major, minor })))
}

/// The straight pipe about z between two radii, from `z = 0` to `height`. Faces: bottom, outside, top, inside.
///
/// # Errors
/// A radius or height that is not positive; `inner` not below `outer`.
pub fn tube(outer: f64, inner: f64, height: f64) -> Result<Body, ConstructError> {
    positive("the outer radius of a tube", outer)?;
    below("the inner radius of a tube", inner, outer, "below the outer radius")?;
    positive("the height of a tube", height)?;
    Ok(Body::exact(turned(&ring(inner, outer, height)?)?, None))
}
