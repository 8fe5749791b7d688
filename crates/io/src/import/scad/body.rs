//! Leaves: solids, 2-D shapes and their extrusion.
//!
//! ```text
//!   cube sphere cylinder polyhedron ──▶ Assembly
//!   square circle polygon ──Lift of the extrusion around──▶ Assembly
//!   text import surface ──facets──▶ Assembly
//! ```

use super::args::Args;
use super::flat::{self, Lift, Plate};
use super::frame::Made;
use super::twist::Twist;
use super::{Context, Facets, Fault, Reader, convex};
use crate::csg::Op;
use crate::import::solid::{Placed, Plane};
use crate::model::{Primitive, Shape};
use glam::{DAffine3, DVec2, DVec3};

/// Leaves in space.
pub(super) const SOLIDS: [&str; 4] = ["cube", "sphere", "cylinder", "polyhedron"];
/// Leaves in the plane.
const FLAT: [&str; 3] = ["square", "circle", "polygon"];
/// Leaves that are made of facets.
const OF_FACETS: [&str; 3] = ["text", "import", "surface"];
/// `$fn` below this is a shape and not a resolution.
const LOW: f64 = 13.0;
/// More segments than this are as good as round.
const MOST_SEGMENTS: f64 = 360.0;

/// Planes: their meet, or their union when the angle is above 180 degrees.
pub(super) type Wedge = (Op, Vec<Plane>);

impl Reader<'_> {
    /// A node without children that matter.
    pub(super) fn leaf(&mut self, inside: &Context, args: &Args<'_>) -> Result<Made<u32>, Fault> {
        let placed = Placed { transform: inside.transform, colour: inside.colour, id: self.count };
        if OF_FACETS.contains(&args.node) {
            let shape = self.facet_leaf(args)?;
            return self.placed(args, inside, shape);
        }
        let flat = FLAT.contains(&args.node);
        if !flat && !SOLIDS.contains(&args.node) {
            return Err(args.fault("such a node is not known"));
        }
        if !self.fits(args, inside, flat, &placed) {
            return Ok(Made::Empty);
        }
        Ok(Made::Is(match inside.lift {
            Some(lift) => self.flat(args, lift, inside, placed)?,
            None => self.body(args, placed)?,
        }))
    }

    /// Whether a flat shape, or a solid, may stand here, under matrices that leave it its volume; a warning otherwise.
    pub(super) fn fits(&mut self, args: &Args<'_>, inside: &Context, flat: bool, placed: &Placed) -> bool {
        match (inside.lift, flat) {
            (Some(_), false) => {
                self.warn("solid left out", args, || format!("`{}` inside an extrusion", args.node));
                return false;
            }
            (None, true) => {
                self.warn("2-D shape left out", args, || format!("`{}` outside of an extrusion", args.node));
                return false;
            }
            _ => {}
        }
        let probe =
            Primitive { shape: Shape::Sphere { radius: 1.0 }, transform: placed.transform, colour: [1.0; 4], id: 1 };
        if probe.to_own().is_none() {
            self.warn("empty solid", args, || {
                format!("the matrices around `{}` flatten it, or are not finite", args.node)
            });
            return false;
        }
        true
    }

    /// Dimensions that make a solid; a warning otherwise.
    pub(super) fn usable(&mut self, args: &Args<'_>, sizes: &[f64]) -> bool {
        let wrong = sizes.iter().find(|x| !x.is_finite() || **x < 0.0);
        if let Some(x) = wrong {
            self.warn("empty solid", args, || format!("`{}` has the dimension {x}", args.node));
        }
        wrong.is_none()
    }

    /// Segments, where the shape is not round.
    fn segments(&self, args: &Args<'_>, radius: f64) -> Option<u32> {
        let n = args.segments(radius);
        let low = args.fragments() > 0.0 && args.fragments() < LOW;
        let faceted = low || (self.facets == Facets::AsWritten && n <= MOST_SEGMENTS);
        faceted.then_some(n as u32)
    }

    fn body(&mut self, args: &Args<'_>, mut placed: Placed) -> Result<u32, Fault> {
        let (centre, shift) = (args.flag("center"), |v: DVec3| DAffine3::from_translation(v));
        match args.node {
            "cube" => {
                let size = args.vector::<3>("size", 1.0)?;
                if !self.usable(args, &size) {
                    return Ok(self.assembly.nothing());
                }
                let size = DVec3::from_array(size);
                let min = if centre { -0.5 * size } else { DVec3::ZERO };
                Ok(self.assembly.add(Shape::Block { min, max: min + size }, &placed))
            }
            "sphere" => {
                let radius = args.number("r", 1.0)?;
                if !self.usable(args, &[radius]) {
                    return Ok(self.assembly.nothing());
                }
                Ok(match self.segments(args, radius) {
                    Some(n) => convex::ball(&mut self.assembly, &placed, radius, n),
                    None => self.assembly.add(Shape::Sphere { radius }, &placed),
                })
            }
            "cylinder" => {
                let r = args.number("r", 1.0)?;
                let (radii, height) = ([args.number("r1", r)?, args.number("r2", r)?], args.number("h", 1.0)?);
                if !self.usable(args, &[radii[0], radii[1], height]) {
                    return Ok(self.assembly.nothing());
                }
                if centre {
                    placed.transform *= shift(DVec3::NEG_Z * 0.5 * height);
                }
                let segments = self.segments(args, radii[0].max(radii[1]));
                Ok(flat::round(&mut self.assembly, &placed, radii, height, segments))
            }
            _ => {
                let body = convex::polyhedron(&mut self.assembly, &placed, args)?;
                if convex::is_inverted(args)? {
                    self.warn("inverted faces", args, || {
                        "polyhedron: the faces are inside out: taken for right".into()
                    });
                }
                Ok(body)
            }
        }
    }

    fn flat(&mut self, args: &Args<'_>, lift: Lift, inside: &Context, placed: Placed) -> Result<u32, Fault> {
        let radius = args.number("r", 1.0)?;
        let size = args.vector::<2>("size", 1.0)?;
        if !self.usable(args, &[radius, size[0], size[1]]) || !inside.plane.is_finite() {
            return Ok(self.assembly.nothing());
        }
        let segments = self.segments(args, radius);
        let triangles = &mut self.triangles;
        let plate = &mut Plate { to: &mut self.assembly, lift, plane: inside.plane, placed, triangles };
        match args.node {
            "circle" => plate.circle(args, radius, segments),
            "square" => {
                let size = DVec2::from_array(size);
                let min = if args.flag("center") { -0.5 * size } else { DVec2::ZERO };
                let max = min + size;
                plate.outlines(args, &[vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]])
            }
            _ => {
                let outlines = args.outlines()?;
                plate.outlines(args, &outlines)
            }
        }
    }

    /// The lift that an extrusion gives to shapes, and its wedge if it does not go all around.
    pub(super) fn lift(&mut self, args: &Args<'_>) -> Result<(Lift, Option<Wedge>), Fault> {
        if args.node == "rotate_extrude" {
            let angle = args.number("angle", 360.0)?;
            let segments = self.segments(args, f64::INFINITY);
            let part = angle.is_finite() && angle.abs() < 360.0;
            if !part {
                return Ok((Lift::Round { segments, part }, None));
            }
            if let Some(segments) = segments {
                return Ok((Lift::Sector { angle, segments }, None));
            }
            let (s, c) = angle.abs().to_radians().sin_cos();
            let mirror = if angle < 0.0 { -1.0 } else { 1.0 };
            let planes = vec![(DVec3::NEG_Y * mirror, 0.0), (DVec3::new(-s, c * mirror, 0.0), 0.0)];
            let op = if angle.abs() <= 180.0 { Op::Intersection } else { Op::Union };
            return Ok((Lift::Round { segments, part }, Some((op, planes))));
        }
        let height = args.number("height", 100.0)?;
        let [scale, other] = args.vector::<2>("scale", 1.0)?;
        if ![scale, other].iter().all(|s| (0.0..f64::INFINITY).contains(s)) {
            return Err(args.fault("a scale that is negative, or not finite, is not read"));
        }
        let height = if self.usable(args, &[height]) { height } else { 0.0 };
        let base = if args.flag("center") { -0.5 * height } else { 0.0 };
        if args.number("twist", 0.0)? != 0.0 || scale != other {
            return Ok((Lift::Twisted(Twist::new(args, base, height, DVec2::new(scale, other))?), None));
        }
        Ok((Lift::Linear { base, height, scale }, None))
    }

    /// The wedge as a solid.
    pub(super) fn wedge(&mut self, (op, planes): &Wedge, placed: &Placed) -> u32 {
        let leaf = |&(normal, offset): &Plane| self.assembly.add(Shape::HalfSpace { normal, offset }, placed);
        let leaves: Vec<u32> = planes.iter().map(leaf).collect();
        self.assembly.nodes.fold(*op, leaves)
    }
}
