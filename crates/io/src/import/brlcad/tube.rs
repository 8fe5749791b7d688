//! Walls between ellipses, and pipes of them.
//!
//! ```text
//!     od/2 ┌────────────╮         straight: the wall of lines between two rings, a cylinder or cone
//!     id/2 ├─────────╮   ╲        bend: a ring turned about the bend's centre, a torus
//!          ├────╮ R   ╲   │       ends: planes between the rings of both diameters
//!          └────╯·     │  │
//! ```
//!
//! `R` is that of the pipe's middle; a bend begins `R tan(angle / 2)` before its corner. Where the inner diameter is 0
//! at one end of a stretch, its inner wall ends in a point.

use super::Fault;
use super::object::Record;
use crate::model::{Face, Part, SurfaceKind, TrimLoop};
use crate::spline::arc::{arc, assemble, pieces, revolve};
use crate::spline::{Bezier, Span, Surface};
use glam::{DMat3, DVec2, DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Share of a length that is rounding.
const ROUNDING: f64 = 1e-9;
/// Sine below which a corner is straight.
const STRAIGHT: f64 = 1e-9;

/// A closed curve by its degree, knots and control points.
type Ring = (usize, Vec<f64>, Vec<DVec4>);

/// `centre + cos t x + sin t y`, once round.
fn ring(centre: DVec3, x: DVec3, y: DVec3) -> Ring {
    let quarter = |k: &[f64]| Span { start: k[0], end: k[1], piece: arc(centre, x, y, k[0], k[1]) };
    assemble(&pieces(0.0, TAU, FRAC_PI_2).windows(2).map(quarter).collect::<Vec<_>>())
}

/// Faces so far.
struct Walls {
    part: Part,
}

impl Walls {
    fn new() -> Self {
        Self { part: Part { closed: true, ..Part::default() } }
    }

    fn add(&mut self, kind: SurfaceKind, surface: Surface, loops: Vec<TrimLoop>, same_sense: bool) {
        let id = self.part.faces.len() as u32 + 1;
        self.part.faces.push(Face { id, kind, surface, loops, same_sense, colour: None });
    }

    /// Lines between points of two rings at equal parameters; rings run counter-clockwise about the way to the second.
    fn lines(&mut self, kind: SurfaceKind, from: &Ring, to: &Ring, outward: bool) -> Result<(), String> {
        let net = [&from.2[..], &to.2].concat();
        let surface = Surface::new((from.0, 1), from.1.clone(), vec![0.0, 0.0, 1.0, 1.0], net);
        self.add(kind, surface.map_err(|e| e.to_string())?, Vec::new(), outward);
        Ok(())
    }

    /// The plane within an ellipse, but for what lies within `hole` times that; its normal is `x` across `y`.
    fn cap(&mut self, [centre, x, y]: [DVec3; 3], hole: f64, outward: bool) -> Result<(), String> {
        let at = |u: f64, v: f64| (centre + x * u + y * v).extend(1.0);
        let net = vec![at(-1.0, -1.0), at(1.0, -1.0), at(-1.0, 1.0), at(1.0, 1.0)];
        let knots = || vec![-1.0, -1.0, 1.0, 1.0];
        let circle = |radius: f64| {
            let flat = |p: &DVec4| DVec3::new(p.x, p.y, p.w);
            let quarter = |k: &[f64]| {
                let points = arc(DVec3::ZERO, DVec3::X * radius, DVec3::Y * radius, k[0], k[1]).points;
                Bezier { points: points.iter().map(flat).collect() }
            };
            TrimLoop::new(pieces(0.0, TAU, FRAC_PI_2).windows(2).map(quarter).collect(), DVec2::splat(ROUNDING))
        };
        let mut loops = vec![circle(1.0).map_err(|e| e.to_string())?];
        if hole > 0.0 {
            loops.push(circle(hole).map_err(|e| e.to_string())?.reversed());
        }
        let surface = Surface::new((1, 1), knots(), knots(), net).map_err(|e| e.to_string())?;
        self.add(SurfaceKind::Plane, surface, loops, outward);
        Ok(())
    }
}

/// The solid of the lines from `v + a cos t + b sin t` to `v + h + c cos t + d sin t`, exactly.
pub(super) fn between_ellipses(v: DVec3, h: DVec3, [a, b, c, d]: [DVec3; 4]) -> Result<Part, String> {
    // which way round, for either end may be a line or point
    let turn = h.dot((a + c).cross(b + d));
    if turn == 0.0 {
        return Err("its ends are flat along `H`".to_owned());
    }
    let (b, d) = if turn > 0.0 { (b, d) } else { (-b, -d) };
    let mut walls = Walls::new();
    walls.lines(SurfaceKind::BSpline, &ring(v, a, b), &ring(v + h, c, d), true)?;
    for (at, x, y, outward) in [(v, a, b, false), (v + h, c, d, true)] {
        if x.cross(y).length() > ROUNDING * (a.length() * b.length() + c.length() * d.length()) {
            walls.cap([at, x, y], 0.0, outward)?;
        }
    }
    Ok(walls.part)
}

/// A corner of a pipe.
struct Corner {
    at: DVec3,
    /// Radii of the outer and the inner wall.
    radii: [f64; 2],
    bend: f64,
}

fn corners(object: &Record<'_>) -> Result<Vec<Corner>, Fault> {
    let mut all = Vec::new();
    while object.value(&format!("V{}", all.len())).is_some() {
        let i = all.len();
        let number = |key: &str| object.numbers::<1>(&format!("{key}{i}")).map(|[x]| x);
        let radii = [0.5 * number("O")?, 0.5 * number("I")?];
        let corner = Corner { at: object.vector(&format!("V{i}"))?, radii, bend: number("R")? };
        if !(0.0 <= radii[1] && radii[1] < radii[0]) {
            return Err(object.fault(format!("point {i}: diameters {} within {}", 2.0 * radii[1], 2.0 * radii[0])));
        }
        all.push(corner);
    }
    if all.len() < 2 {
        return Err(object.fault("fewer than two points"));
    }
    Ok(all)
}

/// A section of a pipe, and the angle about an axis to the next where a bend begins.
struct Section {
    at: DVec3,
    x: DVec3,
    y: DVec3,
    radii: [f64; 2],
    bend: Option<(DVec3, DVec3, f64)>,
}

/// The pipe's walls and ends, exactly.
pub(super) fn pipe(object: &Record<'_>) -> Result<Part, Fault> {
    let sections = sections(object, &corners(object)?)?;
    walls(&sections).map_err(|what| object.fault(what))
}

fn sections(object: &Record<'_>, corners: &[Corner]) -> Result<Vec<Section>, Fault> {
    let steps = corners.windows(2).map(|w| w[1].at - w[0].at);
    let ways = steps.clone().map(DVec3::try_normalize).collect::<Option<Vec<_>>>();
    let ways = ways.ok_or_else(|| object.fault("two points of it are one"))?;
    let lengths: Vec<f64> = steps.map(DVec3::length).collect();
    let (mut x, mut y) = ways[0].any_orthonormal_pair();
    let mut all = vec![Section { at: corners[0].at, x, y, radii: corners[0].radii, bend: None }];
    // what the bend before takes of a stretch
    let mut taken = 0.0;
    for (i, corner) in corners.iter().enumerate().skip(1) {
        let (radii, way) = (corner.radii, ways[i - 1]);
        let next = ways.get(i).copied().unwrap_or(way);
        let (across, along) = (way.cross(next), way.dot(next));
        let mut takes = 0.0;
        if across.length() > STRAIGHT {
            let angle = across.length().atan2(along);
            takes = corner.bend * (0.5 * angle).tan();
            if corner.bend < radii[0] {
                let least = radii[0];
                return Err(object.fault(format!("point {i} bends by {}, but is {least} wide", corner.bend)));
            }
            let axis = across.normalize();
            let start = corner.at - way * takes;
            let centre = start + axis.cross(way) * corner.bend;
            all.push(Section { at: start, x, y, radii, bend: Some((centre, axis, angle)) });
            let turn = DMat3::from_axis_angle(axis, angle);
            (x, y) = (turn * x, turn * y);
            all.push(Section { at: corner.at + next * takes, x, y, radii, bend: None });
        } else if along < 0.0 {
            return Err(object.fault(format!("it turns back on itself at point {i}")));
        } else {
            all.push(Section { at: corner.at, x, y, radii, bend: None });
        }
        if taken + takes > lengths[i - 1] * (1.0 + ROUNDING) {
            return Err(object.fault(format!("the way to point {i} is too short for its bends")));
        }
        taken = takes;
    }
    Ok(all)
}

fn walls(sections: &[Section]) -> Result<Part, String> {
    let mut walls = Walls::new();
    let size = sections.iter().map(|s| s.at.distance(sections[0].at)).fold(0.0, f64::max);
    for pair in sections.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        for (k, outward) in [(0, true), (1, false)] {
            let (start, end) = (from.radii[k], to.radii[k]);
            if start.max(end) == 0.0 {
                continue;
            }
            let first = ring(from.at, from.x * start, from.y * start);
            if let Some((centre, axis, angle)) = from.bend {
                let angles = pieces(0.0, angle, FRAC_PI_2);
                let surface = revolve((first.0, first.1, &first.2), (centre, axis), &angles);
                // u runs along the pipe, v around it
                walls.add(SurfaceKind::Torus, surface.map_err(|e| e.to_string())?, Vec::new(), !outward);
            } else if from.at.distance(to.at) > ROUNDING * size {
                let kind = if start == end { SurfaceKind::Cylinder } else { SurfaceKind::Cone };
                walls.lines(kind, &first, &ring(to.at, to.x * end, to.y * end), outward)?;
            }
        }
    }
    for (end, outward) in [(&sections[0], false), (&sections[sections.len() - 1], true)] {
        let [outer, inner] = end.radii;
        walls.cap([end.at, end.x * outer, end.y * outer], inner / outer, outward)?;
    }
    Ok(walls.part)
}
