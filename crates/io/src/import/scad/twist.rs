//! Extrusions that turn, or scale differently in x and y: made of facets, as in OpenSCAD.
//!
//! ```text
//!   slice j + 1   p2 ───── q2      every corner of the outline is turned and scaled for the height of each slice;
//!                 │ ╲      │       between two slices an edge becomes two triangles, parted by the shorter
//!   slice j       p1 ───── q1      diagonal, or by the one along the turn where both are as long
//! ```
//!
//! The number of slices is `slices`, or follows from `$fn`, `$fa` and `$fs` by the length of the helix along which the
//! outermost corner runs (of a spiral where the upper end has another size).

use super::Fault;
use super::args::Args;
#[cfg(feature = "scad-facets")]
use super::facets::{Region, Sweep, Triangles};
use super::polygon::Piece;
use crate::model::Mesh;
use glam::{DVec2, DVec3};

/// Along z from `base`, the upper end turned clockwise and scaled about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Twist {
    pub base: f64,
    pub height: f64,
    pub scale: DVec2,
    pub degrees: f64,
    slices: Slices,
}

/// How finely it is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slices {
    As(f64),
    By { fragments: f64, angle: f64, length: f64 },
}

/// Triangles of all such extrusions of a file.
pub(super) const MOST_TRIANGLES: f64 = 4e6;
/// Relative difference of two diagonals that are as long: rounding must not choose between them.
const AS_LONG: f64 = 1e-5;

impl Twist {
    /// From the arguments of the extrusion.
    pub fn new(args: &Args<'_>, base: f64, height: f64, scale: DVec2) -> Result<Self, Fault> {
        let degrees = args.number("twist", 0.0)?;
        if !degrees.is_finite() {
            return Err(args.fault("a twist that is not finite is not read"));
        }
        if (scale.x == 0.0) != (scale.y == 0.0) {
            return Err(args.fault("an upper end that is a line is not read"));
        }
        let slices = match args.number("slices", 0.0)? {
            n if n >= 1.0 => Slices::As(n.floor()),
            _ => Slices::By {
                fragments: args.fragments(),
                angle: args.number("$fa", 12.0)?.max(0.01),
                length: args.number("$fs", 2.0)?.max(0.01),
            },
        };
        Ok(Self { base, height, scale, degrees, slices })
    }

    /// The same, cut for these outlines; takes their triangles from those that are left.
    pub fn cut_for(self, args: &Args<'_>, outlines: &[Vec<DVec2>], left: &mut f64) -> Result<Self, Fault> {
        let corners: usize = outlines.iter().map(Vec::len).sum();
        let count = self.count(outlines.iter().flatten());
        // a pocket shares two corners with the hull around it: three times as many at most
        *left -= 6.0 * (count + 1.0) * corners as f64;
        if *left >= 0.0 {
            return Ok(Self { slices: Slices::As(count), ..self });
        }
        Err(args.fault(format!("{count} slices of {corners} corners are too many, with those before")))
    }

    fn count<'a>(&self, corners: impl Iterator<Item = &'a DVec2> + Clone) -> f64 {
        let (fragments, angle, length) = match self.slices {
            Slices::As(count) => return count,
            Slices::By { fragments, angle, length } => (fragments, angle, length),
        };
        let (turn, scale) = (self.degrees.abs(), self.scale);
        let most = |x: &dyn Fn(DVec2) -> f64| corners.clone().map(|p| x(*p)).fold(0.0, f64::max);
        let radius = most(&|p| p.length());
        if turn == 0.0 {
            let moved = most(&|p| (p - p * scale).length());
            return if fragments > 0.0 { fragments } else { moved.hypot(self.height) / length }.ceil().max(1.0);
        }
        let path = if scale.x != scale.y || scale.x == 1.0 {
            radius * turn.to_radians()
        } else {
            spiral(radius, turn.to_radians(), scale.x)
        };
        let fine = if fragments > 0.0 {
            turn / 360.0 * fragments
        } else {
            (turn / angle).min(path.hypot(self.height) / length)
        };
        // never more than a third of a turn
        fine.max(turn / 120.0).ceil().max(1.0)
    }

    /// Place of a corner in one of `slices + 1` rings.
    fn at(&self, ring: u32, slices: f64, p: DVec2) -> DVec3 {
        let share = f64::from(ring) / slices;
        let scale = DVec2::ONE.lerp(self.scale, share);
        (scale * DVec2::from_angle(-(self.degrees * share).to_radians()).rotate(p))
            .extend(self.base + self.height * share)
    }

    /// The solid over a region.
    #[cfg(feature = "scad-facets")]
    pub fn swept(&self, region: &Region) -> Result<Triangles, String> {
        let corners: Vec<DVec2> = region.corners().collect();
        let slices = self.count(corners.iter());
        if slices * corners.len() as f64 > MOST_TRIANGLES {
            return Err(format!("{slices} slices of {} corners are too many", corners.len()));
        }
        let along = |[p1, q1, p2, q2]: [DVec3; 4]| {
            let apart = |a: DVec3, b: DVec3| a.truncate().distance(b.truncate());
            let (up, down) = (apart(p1, q2), apart(q1, p2));
            let alike = (up - down).abs() <= 0.5 * AS_LONG * (up + down);
            if alike { self.degrees > 0.0 } else { up < down }
        };
        let at = |ring: u32, p: DVec2| self.at(ring, slices, p);
        Ok(Sweep { rings: slices as u32 + 1, around: false, at: &at, along: &along }.mesh(region))
    }

    /// The solid over a convex piece of an outline; after [`cut_for`](Self::cut_for). `pocket`: the outline runs along
    /// the piece clockwise, but for the lid.
    pub fn mesh(&self, args: &Args<'_>, id: u32, piece: &Piece, pocket: bool) -> Result<Mesh, Fault> {
        let hull = &piece.hull;
        let (n, slices) = (hull.len() as u32, self.count(hull.iter()));
        let rings = slices as u32;
        let at = |ring: u32, p: DVec2| self.at(ring, slices, p);
        let pointed = self.scale == DVec2::ZERO;
        let mut points: Vec<DVec3> = (0..=rings).flat_map(|ring| hull.iter().map(move |p| at(ring, *p))).collect();
        if pointed {
            points.truncate((n * rings + 1) as usize);
        }
        let number = |ring: u32, corner: u32| n * ring + if pointed && ring == rings { 0 } else { corner % n };
        let mut triangles: Vec<[u32; 3]> = (2..n).map(|k| [0, k, k - 1]).collect();
        for ring in 0..rings {
            for k in 0..n {
                let [p1, q1] = [number(ring, k), number(ring, k + 1)];
                let [p2, q2] = [number(ring + 1, k), number(ring + 1, k + 1)];
                let apart = |a: u32, b: u32| points[a as usize].truncate().distance(points[b as usize].truncate());
                let (up, down) = (apart(p1, q2), apart(q1, p2));
                let alike = (up - down).abs() <= 0.5 * AS_LONG * (up + down);
                let along =
                    if alike { (self.degrees > 0.0) != (pocket && piece.lid != Some(k as usize)) } else { up < down };
                let pair = if along { [[p1, q1, q2], [p1, q2, p2]] } else { [[p1, q1, p2], [q1, q2, p2]] };
                triangles.extend(pair.into_iter().filter(|t| t[1] != t[2]));
            }
        }
        if !pointed {
            triangles.extend((2..n).map(|k| [0, k - 1, k].map(|corner| n * rings + corner)));
        }
        Mesh::new(id, points, triangles, Vec::new()).map_err(|e| args.fault(e))
    }
}

/// Length, in the plane, of the path of a corner that turns by this angle while its radius grows or shrinks by `scale`:
/// an Archimedean spiral, of the factor that OpenSCAD 2021.01 takes (too short where it grows).
fn spiral(radius: f64, turn: f64, scale: f64) -> f64 {
    let end = if scale > 1.0 { turn * scale / (scale - 1.0) } else { turn / (1.0 - scale) };
    let length = |angle: f64| 0.5 * radius / end * (angle * angle.hypot(1.0) + angle.asinh());
    length(end) - length(end - turn)
}
