//! Closed solids from planar profiles: sides by extrusion or lathe, plane caps trimmed by the profile itself.
//!
//! ```text
//!      ╭──────────╮  cap: a plane whose (u, v) are the profile's coordinates, so its trim loops are the
//!     ╱  ╭──╮    ╱│       profile's curves, exactly
//!    ╰───╰──╯───╯ │  side: one face a curve of the profile
//!    │ │    │  │ ╱
//!    ╰──────────╯    hole: a loop inside a loop, any depth
//! ```
//!
//! Loops may run either way: a loop inside an even number of others is turned counter-clockwise, the rest clockwise, so
//! normals point out of the solid.

use super::{ConstructError, extrude, lathe};
use crate::math::orientation::orientation;
use crate::model::{Part, SurfaceKind, TrimLoop};
use crate::spline::{BSpline, Control, Surface};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::TAU;

/// A closed chain of planar curves.
pub type Chain = Vec<BSpline<DVec3>>;

/// Share of the size by which the curves of a chain may miss each other.
const SNAP: f64 = 1e-9;
/// Chords in each Bézier piece, for nesting and crossings.
const CHORDS: u32 = 16;

/// The solid between `profile`, in the plane `z = 0`, and its copy moved by `vector`. Exact.
///
/// Crossings of the profile with itself are searched between chords, 16 in each of its Bézier pieces.
///
/// # Errors
/// No curve; a chain that is open, encloses nothing, or crosses itself or another; a vector in the plane.
pub fn extruded_solid(profile: &[Chain], vector: DVec3) -> Result<Part, ConstructError> {
    if !vector.is_finite() {
        return Err(ConstructError::NotFinite { what: "the direction of an extrusion" });
    }
    if vector.z == 0.0 {
        return Err(ConstructError::ZeroLength { what: "the extrusion across the plane of its profile" });
    }
    let profile = Profile::new(profile)?;
    let up = vector.z > 0.0;
    let mut solid = Part { closed: true, ..Part::default() };
    for c in profile.chains.iter().flatten() {
        let space = c.points().iter().map(|p| DVec4::new(p.x, p.y, 0.0, p.z)).collect();
        let space = BSpline::new(c.degree(), c.knots().to_vec(), space)?;
        solid.add(SurfaceKind::Extrusion, extrude(&space, vector)?, Vec::new(), up);
    }
    for (origin, outward) in [(DVec3::ZERO, !up), (vector, up)] {
        solid.add(SurfaceKind::Plane, profile.plane(origin, DVec3::X, DVec3::Y)?, profile.loops.clone(), outward);
    }
    Ok(solid)
}

/// The solid that `profile`, in coordinates `(radius, height)`, sweeps out in a turn by `angle` about `z`. Exact.
///
/// Curves of the profile on the axis close it and make no face. Crossings as [`extruded_solid`].
///
/// # Errors
/// No curve; a chain that is open, encloses nothing, or crosses itself or another; a profile on both sides of the axis; an angle
/// outside `(0, 2π]`.
pub fn lathed_solid(profile: &[Chain], angle: f64) -> Result<Part, ConstructError> {
    let profile = Profile::new(profile)?;
    let radii = profile.outlines.iter().flatten().map(|p| p.x);
    let (least, most) = radii.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    if least < -SNAP * profile.size && most > SNAP * profile.size {
        return Err(ConstructError::CrossesAxis { parameter: 0.0 });
    }
    // if the half plane opposite is turned, every normal is reversed
    let right = most > -least;
    let mut solid = Part { closed: true, ..Part::default() };
    for c in profile.chains.iter().flatten() {
        match lathe(c, angle) {
            Err(ConstructError::OnAxis) => {}
            surface => solid.add(SurfaceKind::Revolution, surface?, Vec::new(), right),
        }
    }
    if angle < TAU * (1.0 - 1e-14) {
        for (angle, outward) in [(0.0, right), (angle, !right)] {
            // the plane's normal, x × z, points against the turn
            let out = DVec2::from_angle(angle).extend(0.0);
            solid.add(SurfaceKind::Plane, profile.plane(DVec3::ZERO, out, DVec3::Z)?, profile.loops.clone(), outward);
        }
    }
    Ok(solid)
}

/// Closed chains of curves in `(u, v)` as trim loops, in the given order: the face is the part inside an odd number of
/// them.
///
/// # Errors
/// No curve; a chain that is open, encloses nothing, or crosses itself or another.
pub fn trim_loops(chains: &[Chain]) -> Result<Vec<TrimLoop>, ConstructError> {
    Ok(Profile::new(chains)?.loops)
}

/// Oriented chains, and the same as trim loops.
struct Profile {
    chains: Vec<Chain>,
    loops: Vec<TrimLoop>,
    outlines: Vec<Vec<DVec2>>,
    low: DVec2,
    high: DVec2,
    size: f64,
}

impl Profile {
    fn new(chains: &[Chain]) -> Result<Self, ConstructError> {
        if chains.is_empty() || chains.iter().any(Vec::is_empty) {
            return Err(ConstructError::TooFew { what: "curves of a profile", got: 0, needed: 1 });
        }
        let all = chains.iter().flatten().flat_map(BSpline::points).map(|p| p.point());
        let (low, high) = all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        let size = low.distance(high);
        if size == 0.0 {
            return Err(ConstructError::ZeroLength { what: "the profile" });
        }
        let outlines: Vec<Vec<DVec2>> = chains.iter().map(|c| outline(c)).collect();
        crossings("the profile (by its chords)", &outlines)?;
        let mut oriented = Vec::new();
        let mut loops = Vec::new();
        for (i, chain) in chains.iter().enumerate() {
            let curves = chain.iter().flat_map(|c| c.beziers()).map(|s| s.piece).collect();
            let trim = TrimLoop::new(curves, DVec2::splat(SNAP * size))?;
            if trim.signed_area().abs() <= SNAP * SNAP * size * size {
                return Err(ConstructError::NoArea { what: "the profile" });
            }
            let others = outlines.iter().enumerate().filter(|(j, _)| *j != i);
            let depth = others.filter(|(_, o)| holds(o, outlines[i][0])).count();
            if (trim.signed_area() > 0.0) == depth.is_multiple_of(2) {
                oriented.push(chain.clone());
                loops.push(trim);
            } else {
                oriented.push(chain.iter().rev().map(BSpline::reversed).collect());
                loops.push(trim.reversed());
            }
        }
        Ok(Self { chains: oriented, loops, outlines, low, high, size })
    }

    /// The plane `origin + u x + v y` around the profile.
    fn plane(&self, origin: DVec3, x: DVec3, y: DVec3) -> Result<Surface, ConstructError> {
        let (a, b) = (self.low, self.high);
        let corner = |u: f64, v: f64| (origin + x * u + y * v).extend(1.0);
        let net = vec![corner(a.x, a.y), corner(b.x, a.y), corner(a.x, b.y), corner(b.x, b.y)];
        Ok(Surface::new((1, 1), vec![a.x, a.x, b.x, b.x], vec![a.y, a.y, b.y, b.y], net)?)
    }
}

/// Corners of the chords of a chain, the last one without its end.
pub(super) fn outline(chain: &[BSpline<DVec3>]) -> Vec<DVec2> {
    let spans = chain.iter().flat_map(|c| c.beziers()).map(|s| s.piece);
    let chords = spans.flat_map(|b| {
        let count = if b.degree() == 1 { 1 } else { CHORDS };
        (0..count).map(move |k| b.point(f64::from(k) / f64::from(count)))
    });
    let mut points: Vec<DVec2> = chords.collect();
    points.dedup();
    points
}

/// `p` is inside, by the parity of crossings of the ray to the right.
fn holds(outline: &[DVec2], p: DVec2) -> bool {
    let edges = outline.iter().zip(outline.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| {
        let up = b.y > a.y;
        (a.y <= p.y) != (b.y <= p.y) && (orientation(**a, **b, p) > 0.0) == up
    });
    crossed.count() % 2 == 1
}

/// No two chords cross.
///
/// Chords in order of their left ends: only those that overlap in `x` are compared.
pub(super) fn crossings(what: &'static str, outlines: &[Vec<DVec2>]) -> Result<(), ConstructError> {
    let mut chords: Vec<(DVec2, DVec2, usize)> = Vec::new();
    for outline in outlines {
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        for (a, b) in ends {
            chords.push((*a, *b, chords.len()));
        }
    }
    chords.sort_by(|p, q| p.0.x.min(p.1.x).total_cmp(&q.0.x.min(q.1.x)));
    for (i, (a, b, first)) in chords.iter().enumerate() {
        let right = a.x.max(b.x);
        for (c, d, second) in chords[i + 1..].iter().take_while(|(c, d, _)| c.x.min(d.x) <= right) {
            let apart = |p: DVec2, q: DVec2, r: DVec2, s: DVec2| orientation(p, q, r) * orientation(p, q, s) >= 0.0;
            if !apart(*a, *b, *c, *d) && !apart(*c, *d, *a, *b) {
                let (first, second) = (*first.min(second) as f64, *first.max(second) as f64);
                return Err(ConstructError::SelfCrossing { what, first, second });
            }
        }
    }
    Ok(())
}
