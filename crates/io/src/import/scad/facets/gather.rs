//! One node and its children, in facets.

use super::region::Join;
use super::solid::Triangles;
use super::{Body, Budget, Region, Shape, Sweep};
use crate::csg::Op;
use crate::import::scad::Fault;
use crate::import::scad::args::{Args, Value};
use crate::import::scad::flat::{Lift, in_plane};
use crate::import::scad::frame::Made;
use crate::model::Bounds;
use glam::{DAffine2, DAffine3, DVec2, DVec3};
use std::f64::consts::TAU;

/// The operation on the children.
#[derive(Clone, Debug)]
enum Job {
    Boolean(Op),
    Hull,
    Minkowski,
    Fill,
    Resize {
        size: [f64; 3],
        auto: [bool; 3],
    },
    Offset {
        distance: f64,
        join: Join,
    },
    Projection {
        cut: bool,
    },
    Linear {
        lift: Lift,
    },
    /// By facets: all around, or by an angle.
    Turned {
        angle: f64,
        /// Where it starts, radians.
        start: f64,
        segments: Segments,
    },
    Moved(DAffine3),
}

/// `$fn`, `$fa`, `$fs`: segments of a circle of any radius.
#[derive(Clone, Copy, Debug)]
struct Segments {
    fragments: f64,
    angle: f64,
    length: f64,
}

impl Segments {
    fn of(args: &Args<'_>) -> Result<Self, Fault> {
        let (angle, length) = (args.number("$fa", 12.0)?, args.number("$fs", 2.0)?);
        Ok(Self { fragments: args.fragments(), angle: angle.max(0.01), length: length.max(0.01) })
    }

    fn count(self, radius: f64) -> f64 {
        if self.fragments > 0.0 {
            return self.fragments.max(3.0).ceil();
        }
        (360.0 / self.angle).min(TAU * radius / self.length).max(5.0).ceil()
    }
}

/// Segments beyond which nothing is made.
const MOST_SEGMENTS: f64 = 10_000.0;

/// A node whose children are being read.
#[derive(Debug)]
pub(in crate::import::scad) struct Gather {
    job: Job,
    children: Vec<Shape>,
    /// Children so far, of any kind.
    count: usize,
    /// A child is empty, where that makes the whole empty.
    void: bool,
    /// The first child, or every one, could not be made.
    lost: bool,
    /// Children of the wrong dimension.
    strangers: usize,
}

impl Gather {
    /// Nodes that are evaluated here wherever they stand.
    pub fn needs(node: &str) -> bool {
        ["hull", "minkowski", "fill", "resize", "offset", "projection"].contains(&node)
    }

    /// A node with children.
    pub fn new(args: &Args<'_>, op: Op, matrix: Option<DAffine3>, lift: Option<Lift>) -> Result<Self, Fault> {
        let job = match args.node {
            "hull" => Job::Hull,
            "minkowski" => Job::Minkowski,
            "fill" => Job::Fill,
            "resize" => Self::resize(args)?,
            "offset" => Self::offset(args)?,
            "projection" => Job::Projection { cut: args.flag("cut") },
            "rotate_extrude" => {
                let angle = args.number("angle", 360.0)?;
                let start = args.start(angle)?;
                let angle = if angle.is_finite() { angle.clamp(-360.0, 360.0) } else { 360.0 };
                Job::Turned { angle, start, segments: Segments::of(args)? }
            }
            _ => match (lift, matrix) {
                (Some(lift), _) => Job::Linear { lift },
                (None, Some(matrix)) => Job::Moved(matrix),
                (None, None) => Job::Boolean(op),
            },
        };
        Ok(Self { job, children: Vec::new(), count: 0, void: false, lost: false, strangers: 0 })
    }

    fn resize(args: &Args<'_>) -> Result<Job, Fault> {
        let size = args.vector::<3>("newsize", 0.0)?;
        let auto = match args.get("auto") {
            Some(Value::List(list)) => {
                let flag = |i: usize| match list.get(i) {
                    Some(Value::Flag(on)) => *on,
                    Some(Value::Number(x)) => *x != 0.0,
                    _ => false,
                };
                [flag(0), flag(1), flag(2)]
            }
            Some(Value::Flag(on)) => [*on; 3],
            _ => [false; 3],
        };
        if size.iter().any(|s| !s.is_finite() || *s < 0.0) {
            return Err(args.fault("sizes that are negative, or not finite"));
        }
        Ok(Job::Resize { size, auto })
    }

    fn offset(args: &Args<'_>) -> Result<Job, Fault> {
        let round = args.get("r").is_some();
        let distance = args.number(if round { "r" } else { "delta" }, 0.0)?;
        if !distance.is_finite() {
            return Err(args.fault("a distance that is not finite"));
        }
        let segments = args.segments(distance.abs());
        if round && segments > MOST_SEGMENTS {
            return Err(args.fault(format!("{segments} segments")));
        }
        let join = match (round, args.flag("chamfer")) {
            (true, _) => Join::Round(segments),
            (false, true) => Join::Chamfer,
            (false, false) => Join::Miter,
        };
        Ok(Job::Offset { distance, join })
    }

    /// Takes a finished child.
    pub fn add(&mut self, child: Made<Shape>) {
        let first = self.count == 0;
        self.count += 1;
        let (minuend, all) = match self.job {
            Job::Boolean(Op::Difference) => (first, false),
            Job::Boolean(Op::Intersection) => (false, true),
            _ => (false, false),
        };
        match child {
            Made::Is(shape) if !shape.is_empty() => {
                let flat = match (&self.job, self.children.first()) {
                    (Job::Offset { .. } | Job::Fill | Job::Linear { .. } | Job::Turned { .. }, _) => true,
                    (Job::Projection { .. }, _) => false,
                    (_, first) => matches!(first.unwrap_or(&shape), Shape::Flat(_)),
                };
                if matches!(shape, Shape::Flat(_)) == flat {
                    self.children.push(shape);
                } else {
                    self.strangers += 1;
                    self.void |= minuend || all;
                }
            }
            Made::Is(_) | Made::Empty => self.void |= minuend || all,
            Made::Lost => self.lost |= minuend || self.job.needs_all() || self.children.is_empty(),
        }
    }

    /// Children that are flat among solids, or solid among flat ones.
    pub fn strangers(&self) -> usize {
        self.strangers
    }

    /// The shape of the node.
    pub fn finish(mut self, budget: &mut Budget) -> Result<Made<Shape>, String> {
        self.lost &= self.children.is_empty() || self.job.needs_first();
        if self.lost {
            return Ok(Made::Lost);
        }
        if self.void || self.children.is_empty() {
            return Ok(Made::Empty);
        }
        let (mut regions, mut bodies) = (Vec::new(), Vec::new());
        for child in self.children {
            match child {
                Shape::Flat(region) => regions.push(region),
                Shape::Solid(body) => bodies.push(body),
            }
        }
        let shape =
            if regions.is_empty() { solid(self.job, bodies, budget)? } else { flat(self.job, regions, budget)? };
        Ok(if shape.is_empty() { Made::Empty } else { Made::Is(shape) })
    }

    /// The factors by which a resized shape is scaled; `None` for other nodes.
    pub fn scale(&self) -> Option<DVec3> {
        let Job::Resize { size, auto } = &self.job else { return None };
        let mut bounds = Bounds::EMPTY;
        for child in &self.children {
            match child {
                Shape::Flat(region) => region.corners().for_each(|p| bounds = bounds.with(p.extend(0.0))),
                Shape::Solid(body) => bounds = bounds.union(body.bounds()),
            }
        }
        Some(resized(bounds, *size, *auto))
    }
}

impl Job {
    /// Whether the node is lost with any of its children.
    fn needs_all(&self) -> bool {
        matches!(self, Self::Minkowski)
    }

    fn needs_first(&self) -> bool {
        matches!(self, Self::Minkowski | Self::Boolean(Op::Difference))
    }
}

/// As OpenSCAD scales: by the stated size on each axis, and by the factor of the largest size where an axis is
/// automatic.
fn resized(bounds: Bounds, size: [f64; 3], auto: [bool; 3]) -> DVec3 {
    if bounds.min.cmpgt(bounds.max).any() {
        return DVec3::ONE;
    }
    let old = (bounds.max - bounds.min).to_array();
    let factor = |i: usize| if size[i] > 0.0 && old[i] > 0.0 { size[i] / old[i] } else { 1.0 };
    let largest = (0..3).fold(0, |most, i| if size[i] > size[most] { i } else { most });
    let of = |i: usize| if auto[i] && size[i] == 0.0 { factor(largest) } else { factor(i) };
    DVec3::new(of(0), of(1), of(2))
}

fn flat(job: Job, mut regions: Vec<Region>, budget: &mut Budget) -> Result<Shape, String> {
    Ok(Shape::Flat(match job {
        Job::Boolean(Op::Difference) => {
            let rest = regions.split_off(1);
            regions.remove(0).without(&Region::union(rest))
        }
        Job::Boolean(Op::Intersection) => {
            let rest = regions.split_off(1);
            rest.iter().fold(regions.remove(0), |all, r| all.common(r))
        }
        Job::Hull => Region::union(regions).hull(),
        Job::Minkowski => {
            let rest = regions.split_off(1);
            rest.iter().try_fold(regions.remove(0), |sum, r| sum.minkowski(r, budget))?
        }
        Job::Moved(matrix) => Region::union(regions).moved(&in_plane(&matrix)),
        Job::Resize { size, auto } => {
            let all = Region::union(regions);
            let bounds = all.corners().fold(Bounds::EMPTY, |b, p| b.with(p.extend(0.0)));
            all.moved(&DAffine2::from_scale(resized(bounds, size, auto).truncate()))
        }
        Job::Fill => Region::union(regions).filled(),
        Job::Offset { distance, join } => Region::union(regions).offset(distance, join),
        Job::Linear { lift } => return Ok(Shape::Solid(Body::mesh(linear(&Region::union(regions), lift)?))),
        Job::Turned { angle, start, segments } => {
            let body = Body::mesh(turned(&Region::union(regions), angle, |r| segments.count(r))?);
            return Ok(Shape::Solid(if start == 0.0 { body } else { body.moved(&DAffine3::from_rotation_z(start)) }));
        }
        Job::Boolean(_) | Job::Projection { .. } => Region::union(regions),
    }))
}

fn solid(job: Job, mut bodies: Vec<Body>, budget: &mut Budget) -> Result<Shape, String> {
    Ok(Shape::Solid(match job {
        Job::Boolean(Op::Difference) => {
            let rest = bodies.split_off(1);
            bodies.remove(0).without(Body::union(rest), budget)?
        }
        Job::Boolean(Op::Intersection) => {
            let rest = bodies.split_off(1);
            rest.into_iter().try_fold(bodies.remove(0), |all, b| all.common(b, budget))?
        }
        Job::Hull => Body::hull(&Body::union(bodies).corners()),
        Job::Minkowski => {
            let rest = bodies.split_off(1);
            rest.into_iter().try_fold(bodies.remove(0), |sum, b| sum.minkowski(b, budget))?
        }
        Job::Moved(matrix) => Body::union(bodies).moved(&matrix),
        Job::Resize { size, auto } => {
            let all = Body::union(bodies);
            all.moved(&DAffine3::from_scale(resized(all.bounds(), size, auto)))
        }
        Job::Projection { cut } => {
            let all = Body::union(bodies);
            return Ok(Shape::Flat(if cut { all.cut(budget)? } else { all.shadow() }));
        }
        _ => Body::union(bodies),
    }))
}

/// A region that rises, by facets.
pub(in crate::import::scad) fn linear(region: &Region, lift: Lift) -> Result<Triangles, String> {
    match lift {
        Lift::Linear { height: 0.0, .. } => Ok(Triangles::default()),
        Lift::Linear { base, height, scale } => {
            let at = |ring: u32, p: DVec2| match ring {
                0 => p.extend(base),
                _ => (p * scale).extend(base + height),
            };
            Ok(Sweep { rings: 2, around: false, at: &at, along: &|_| true }.mesh(region))
        }
        Lift::Twisted(twist) => twist.swept(region),
        Lift::Round { .. } | Lift::Sector { .. } => Err("turned where it should rise".to_owned()),
    }
}

/// A region that turns about the z axis, by as many segments as a circle of its largest radius has, or their share.
pub(in crate::import::scad) fn turned(
    region: &Region,
    angle: f64,
    segments: impl Fn(f64) -> f64,
) -> Result<Triangles, String> {
    let (low, high) = region.corners().fold((0.0_f64, 0.0_f64), |(l, h), p| (l.min(p.x), h.max(p.x)));
    let rounding = 1e-5 * (high - low);
    if low < -rounding && high > rounding {
        return Err("an outline across the axis".to_owned());
    }
    let full = segments(high - low);
    let whole = angle.abs() == 360.0;
    let count = if whole { full } else { (full * angle.abs() / 360.0).floor().max(1.0) };
    if count > MOST_SEGMENTS {
        return Err(format!("{count} segments"));
    }
    // all around, OpenSCAD begins opposite to the x axis
    let start = if whole { 0.5 * TAU } else { 0.0 };
    let at = |ring: u32, p: DVec2| {
        let (s, c) = (start + angle.to_radians() * f64::from(ring) / count).sin_cos();
        // points on the axis stay there, whatever their digits
        let x = if (p.x * (high + low)) < 0.0 { 0.0 } else { p.x };
        DVec3::new(x * c, x * s, p.y)
    };
    let rings = if whole { count } else { count + 1.0 } as u32;
    Ok(Sweep { rings, around: whole, at: &at, along: &|_| true }.mesh(region))
}
