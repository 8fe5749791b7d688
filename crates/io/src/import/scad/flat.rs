//! 2-D shapes, each lifted by itself.
//!
//! ```text
//!   linear_extrude(h) difference() { circle(5); square(2); }    lifting commutes with the Booleans:
//!        = difference() { cylinder; block }                     no polygon is ever clipped
//!
//!   rotate_extrude() polygon:  each convex piece is the meet of round cones (edges that look outwards)
//!                              without other cones (edges that look to the axis)
//! ```
//!
//! `facets` first resolves outlines that cross themselves. A twisted extrusion has no such form: `twist` makes the
//! facets that OpenSCAD makes.

use super::args::Args;
use super::polygon::{self, MOST_POINTS, Piece};
use super::twist::Twist;
use super::{Fault, convex};
use crate::csg::Op;
use crate::import::solid::{Assembly, Placed, Plane};
use crate::model::{Bounds, Shape};
use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Relative difference of lengths that is rounding: numbers carry six digits.
const ROUNDING: f64 = 1e-5;

/// How a plane becomes space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lift {
    /// Along z from `base`; the upper end is scaled about the origin.
    Linear { base: f64, height: f64, scale: f64 },
    /// x becomes the distance from the z axis, y becomes z; in segments where few are stated. `part`: not all around.
    Round { segments: Option<u32>, part: bool },
    /// As `Round`, by an angle in degrees and in segments: facets, as OpenSCAD makes them.
    Sector { angle: f64, segments: u32 },
    /// Along z, turned and scaled: facets, as OpenSCAD makes them.
    Twisted(Twist),
}

/// The matrix as it acts on the plane.
pub(super) fn in_plane(m: &DAffine3) -> DAffine2 {
    let matrix2 = DMat2::from_cols(m.matrix3.x_axis.truncate(), m.matrix3.y_axis.truncate());
    DAffine2 { matrix2, translation: m.translation.truncate() }
}

/// The target of 2-D shapes.
pub(super) struct Plate<'a> {
    pub to: &'a mut Assembly,
    pub lift: Lift,
    /// 2-D coordinates to the coordinates that are lifted.
    pub plane: DAffine2,
    pub placed: Placed,
    /// Triangles that twisted extrusions may still have.
    pub triangles: &'a mut f64,
}

impl Plate<'_> {
    /// `circle(r)`.
    pub fn circle(&mut self, args: &Args<'_>, radius: f64, segments: Option<u32>) -> Result<u32, Fault> {
        let segments = match self.lift {
            Lift::Twisted(_) | Lift::Sector { .. } => Some(self.fragments(args, radius)),
            Lift::Round { segments: Some(_), .. } => Some(self.fragments(args, radius)),
            Lift::Round { segments: None, .. } if !self.is_turned_circle() => Some(self.fragments(args, radius)),
            Lift::Linear { .. } | Lift::Round { .. } => segments,
        };
        if let Some(n) = segments {
            let corner = |i: u32| radius * DVec2::from_angle(TAU * f64::from(i) / f64::from(n));
            let outline: Vec<DVec2> = (0..n).map(corner).collect();
            return self.outlines(args, &[outline]);
        }
        let (m, centre) = (self.plane.matrix2, self.plane.translation);
        let mut placed = self.placed;
        match self.lift {
            Lift::Linear { base, height, scale } => {
                let lean = if height > 0.0 { centre * (scale - 1.0) / height } else { DVec2::ZERO };
                let matrix = DMat3::from_cols(m.x_axis.extend(0.0), m.y_axis.extend(0.0), lean.extend(1.0));
                placed.transform *= DAffine3 { matrix3: matrix, translation: centre.extend(base) };
                let straight = Shape::Cylinder { radius, height };
                let shape =
                    if scale == 1.0 { straight } else { Shape::Cone { bottom: radius, top: radius * scale, height } };
                Ok(self.to.add(shape, &placed))
            }
            Lift::Round { .. } => {
                let (minor, major) = (radius * m.x_axis.length(), centre.x.abs());
                if major < minor * (1.0 - ROUNDING) {
                    return Err(args.fault("a circle across the axis of rotate_extrude is not read"));
                }
                placed.transform *= DAffine3::from_translation(DVec3::Z * centre.y);
                Ok(self.to.add(Shape::Torus { major, minor }, &placed))
            }
            Lift::Sector { .. } | Lift::Twisted(_) => unreachable!("their circles have segments"),
        }
    }

    fn fragments(&self, args: &Args<'_>, radius: f64) -> u32 {
        args.segments(radius).min(MOST_POINTS as f64 + 1.0) as u32
    }

    /// Circles stay circles.
    fn is_turned_circle(&self) -> bool {
        let (x, y) = (self.plane.matrix2.x_axis, self.plane.matrix2.y_axis);
        let size = x.length() * y.length();
        (x.length() - y.length()).abs() <= ROUNDING * x.length() && x.dot(y).abs() <= ROUNDING * size
    }

    /// Outlines: later ones are holes of the first where they lie in it, else the parity decides.
    pub fn outlines(&mut self, args: &Args<'_>, outlines: &[Vec<DVec2>]) -> Result<u32, Fault> {
        self.simple(args, outlines).or_else(|fault| self.crossed(args, outlines, fault))
    }

    /// The same of outlines that neither cross nor touch themselves.
    pub fn simple(&mut self, args: &Args<'_>, outlines: &[Vec<DVec2>]) -> Result<u32, Fault> {
        let moved = |o: &Vec<DVec2>| o.iter().map(|p| self.plane.transform_point2(*p)).collect::<Vec<_>>();
        let outlines: Vec<Vec<DVec2>> = outlines.iter().map(moved).collect();
        let outlines = outlines.iter().map(|o| self.one_side(args, o)).collect::<Result<Vec<_>, _>>()?;
        let inside = |i: usize, j: usize| outlines[j].first().is_some_and(|p| polygon::holds(&outlines[i], *p));
        let others = 1..outlines.len();
        let holes = others.clone().all(|j| inside(0, j) && others.clone().all(|i| i == j || !inside(i, j)));
        let op = if holes { Op::Difference } else { Op::SymmetricDifference };
        if let Lift::Twisted(twist) = self.lift {
            self.lift = Lift::Twisted(twist.cut_for(args, &outlines, self.triangles)?);
        }
        let mut all = Vec::with_capacity(outlines.len());
        for outline in &outlines {
            let piece = polygon::cut(outline).map_err(|what| args.fault(format!("{what} is not read")))?;
            all.push(match piece {
                Some(piece) => self.piece(args, &piece, false)?,
                None => self.to.nothing(),
            });
        }
        Ok(self.to.nodes.fold(op, all))
    }

    /// For turning: the outline on the positive side of the axis.
    fn one_side(&self, args: &Args<'_>, outline: &[DVec2]) -> Result<Vec<DVec2>, Fault> {
        let Lift::Round { part, .. } = self.lift else { return Ok(outline.to_vec()) };
        let (low, high) = outline.iter().fold((0.0_f64, 0.0_f64), |(l, h), p| (l.min(p.x), h.max(p.x)));
        let rounding = ROUNDING * (high - low);
        match (low < -rounding, high > rounding) {
            (true, true) => Err(args.fault("an outline across the axis of rotate_extrude is not read")),
            (true, false) if part => Err(args.fault("an outline at negative x is not turned by a part of a circle")),
            (true, false) => Ok(outline.iter().map(|p| DVec2::new((-p.x).max(0.0), p.y)).collect()),
            _ => Ok(outline.iter().map(|p| DVec2::new(p.x.max(0.0), p.y)).collect()),
        }
    }

    /// A convex piece without its pockets; the depth is bounded by [`polygon::cut`].
    fn piece(&mut self, args: &Args<'_>, piece: &Piece, pocket: bool) -> Result<u32, Fault> {
        let whole = match self.lift {
            Lift::Linear { base, height, scale } => self.prism(piece, base, height, scale),
            Lift::Round { segments, .. } => self.turned(piece, segments),
            Lift::Twisted(Twist { height: 0.0, .. }) => self.to.nothing(),
            Lift::Twisted(twist) => {
                let mesh = twist.mesh(args, self.placed.id, piece, pocket)?;
                self.to.add(Shape::Mesh(Arc::new(mesh)), &self.placed)
            }
            Lift::Sector { .. } => {
                return Err(args.fault("facets need the feature `scad-facets`, which is not built in"));
            }
        };
        piece.pockets.iter().try_fold(whole, |rest, inner| {
            let inner = self.piece(args, inner, !pocket)?;
            Ok(self.to.nodes.pair(Op::Difference, rest, inner))
        })
    }

    fn prism(&mut self, piece: &Piece, base: f64, height: f64, scale: f64) -> u32 {
        let n = piece.hull.len();
        let planes: Vec<Plane> = (0..n)
            .filter(|i| piece.lid != Some(*i))
            .map(|i| {
                let (a, b) = (piece.hull[i], piece.hull[(i + 1) % n]);
                let normal = DVec2::new(b.y - a.y, a.x - b.x);
                let offset = normal.dot(a);
                let lean = if height > 0.0 { offset * (scale - 1.0) / height } else { 0.0 };
                (normal.extend(-lean), offset - lean * base)
            })
            .collect();
        let all = piece.hull.iter().flat_map(|p| [*p, *p * scale]);
        let tight = all.map(|p| p.extend(base)).fold(Bounds::EMPTY, Bounds::with);
        let margin = DVec3::new(1.0, 1.0, 0.0) * 0.1 * tight.diagonal();
        let within = Bounds { min: tight.min - margin, max: tight.max + margin + DVec3::Z * height };
        self.to.half_spaces(within, &planes, &self.placed)
    }

    fn turned(&mut self, piece: &Piece, segments: Option<u32>) -> u32 {
        let n = piece.hull.len();
        let range = piece.hull.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.y), h.max(p.y)));
        let (mut outer, mut inner) = (Vec::new(), Vec::new());
        for i in 0..n {
            let (a, b) = (piece.hull[i], piece.hull[(i + 1) % n]);
            if b.y == a.y {
                continue; // an end of the cones
            }
            let at = |z: f64| {
                // exact at the corners
                if z == a.y {
                    a.x
                } else if z == b.y {
                    b.x
                } else {
                    a.x + (b.x - a.x) * ((z - a.y) / (b.y - a.y))
                }
            };
            let list = if b.y > a.y { &mut outer } else { &mut inner };
            let apex = a.y - a.x * (b.y - a.y) / (b.x - a.x); // not used where the edge is vertical
            let (r0, r1) = (at(range.0), at(range.1));
            let (low, high) = match (r0 < 0.0, r1 < 0.0) {
                (false, false) => ((range.0, r0), (range.1, r1)),
                (true, false) => ((apex, 0.0), (range.1, r1)),
                (false, true) => ((range.0, r0), (apex, 0.0)),
                (true, true) => continue,
            };
            if low.1 > 0.0 || high.1 > 0.0 {
                list.push(self.cone(low, high, segments));
            }
        }
        let whole = self.to.nodes.fold(Op::Intersection, outer);
        inner.into_iter().fold(whole, |rest, hole| self.to.nodes.pair(Op::Difference, rest, hole))
    }

    /// Between two heights with their radii.
    fn cone(&mut self, (z0, bottom): (f64, f64), (z1, top): (f64, f64), segments: Option<u32>) -> u32 {
        let mut placed = self.placed;
        placed.transform *= DAffine3::from_translation(DVec3::Z * z0);
        if segments.is_some_and(|n| n % 2 == 1) {
            // OpenSCAD's first corner lies opposite to the x axis
            placed.transform *= DAffine3::from_rotation_z(PI);
        }
        round(self.to, &placed, [bottom, top], z1 - z0, segments)
    }
}

/// A frustum about z from `z = 0`: round, or of segments.
pub(super) fn round(to: &mut Assembly, placed: &Placed, radii: [f64; 2], height: f64, segments: Option<u32>) -> u32 {
    let [bottom, top] = radii;
    match segments {
        Some(n) => convex::frustum(to, placed, radii, height, n),
        None if bottom == top => to.add(Shape::Cylinder { radius: bottom, height }, placed),
        None => to.add(Shape::Cone { bottom, top, height }, placed),
    }
}
