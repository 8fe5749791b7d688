//! Facets as primitives of the Boolean solid around them.

use super::cells::Cell;
use super::solid::{OPEN, Part, Triangles};
use super::{Body, Region, Shape, gather, hull};
use crate::csg::Op;
use crate::import::scad::args::Args;
use crate::import::scad::convex::MOST_PLANES;
use crate::import::scad::flat::{Lift, Plate};
use crate::import::scad::frame::Made;
use crate::import::scad::{Context, Fault, Reader, convex};
use crate::import::solid::{Assembly, Placed, around};
use crate::model::{Mesh, Shape as Solid};
use glam::{DAffine2, DVec2};
use std::sync::Arc;

impl Reader<'_> {
    /// A shape as a node of the solid, lifted where it is flat.
    pub(in crate::import::scad) fn placed(
        &mut self,
        args: &Args<'_>,
        inside: &Context,
        shape: Made<Shape>,
    ) -> Result<Made<u32>, Fault> {
        let shape = match shape {
            Made::Lost => return Ok(Made::Lost),
            Made::Empty => return Ok(Made::Empty),
            Made::Is(shape) => shape,
        };
        let placed = Placed { transform: inside.transform, colour: inside.colour, id: self.count };
        if !self.fits(args, inside, matches!(shape, Shape::Flat(_)), &placed) {
            return Ok(Made::Empty);
        }
        let node = match (shape, inside.lift) {
            (Shape::Flat(region), Some(lift)) => {
                let triangles = &mut self.triangles;
                Plate { to: &mut self.assembly, lift, plane: inside.plane, placed, triangles }.region(args, &region)?
            }
            (Shape::Solid(body), None) => solid(&mut self.assembly, &placed, &body).map_err(|what| args.fault(what))?,
            _ => return Ok(Made::Empty),
        };
        Ok(Made::Is(node))
    }
}

/// Corners beyond which a region that rises is a mesh, and not half-spaces.
const MOST_CORNERS: usize = 64;

impl Plate<'_> {
    /// The inside of outlines that cross or touch themselves, by the odd-even rule.
    pub(in crate::import::scad) fn crossed(
        &mut self,
        args: &Args<'_>,
        outlines: &[Vec<DVec2>],
        _: Fault,
    ) -> Result<u32, Fault> {
        self.region(args, &Region::new(outlines, true))
    }

    /// A region, lifted.
    pub fn region(&mut self, args: &Args<'_>, region: &Region) -> Result<u32, Fault> {
        let region = region.moved(&self.plane);
        if let Lift::Twisted(twist) = self.lift {
            self.lift = Lift::Twisted(twist.cut_for(args, &region.contours(), self.triangles)?);
        }
        let few = region.corners().count() <= MOST_CORNERS;
        let triangles = match self.lift {
            Lift::Sector { angle, segments } => gather::turned(&region, angle, |_| f64::from(segments)),
            Lift::Round { .. } => return self.pieces(args, &region),
            Lift::Linear { .. } if few => match self.pieces(args, &region) {
                Ok(node) => return Ok(node),
                Err(_) => gather::linear(&region, self.lift),
            },
            Lift::Linear { .. } | Lift::Twisted(_) => gather::linear(&region, self.lift),
        };
        let triangles = triangles.map_err(|what| args.fault(what))?;
        if matches!(self.lift, Lift::Linear { .. }) && !triangles.is_closed() {
            // outlines that touch each other: triangles of the covers pass over their corners
            return self.pieces(args, &region);
        }
        mesh(self.to, &self.placed, &triangles).map_err(|what| args.fault(what))
    }

    /// Each outline with its holes by itself.
    fn pieces(&mut self, args: &Args<'_>, region: &Region) -> Result<u32, Fault> {
        let plane = std::mem::replace(&mut self.plane, DAffine2::IDENTITY);
        let all: Result<Vec<u32>, Fault> = region.shapes().map(|shape| self.simple(args, &shape)).collect();
        self.plane = plane;
        Ok(self.to.nodes.fold(Op::Union, all?))
    }
}

/// The union of the parts.
fn solid(to: &mut Assembly, placed: &Placed, body: &Body) -> Result<u32, String> {
    let mut all = Vec::with_capacity(body.parts.len());
    for part in &body.parts {
        all.push(match part {
            Part::Cell(cell) => convex_part(to, placed, cell)?,
            Part::Mesh(triangles) => mesh(to, placed, triangles)?,
        });
    }
    Ok(to.nodes.fold(Op::Union, all))
}

fn convex_part(to: &mut Assembly, placed: &Placed, cell: &Cell) -> Result<u32, String> {
    let planes = cell.planes();
    if planes.len() <= MOST_PLANES {
        return Ok(to.half_spaces(around(cell.corners()), &planes, placed));
    }
    // facets that were cut share no corners: those of the hull do
    let Some((points, triangles)) = hull::solid(&cell.distinct()) else { return Ok(to.nothing()) };
    mesh(to, placed, &Triangles { points, triangles })
}

/// A closed mesh: half-spaces where it is convex and has few faces.
pub(in crate::import::scad) fn mesh(to: &mut Assembly, placed: &Placed, mesh: &Triangles) -> Result<u32, String> {
    if mesh.triangles.is_empty() {
        return Ok(to.nothing());
    }
    if !mesh.is_closed() {
        return Err(OPEN.to_owned());
    }
    if mesh.triangles.len() <= 2 * MOST_PLANES {
        let faces: Vec<Vec<u32>> = mesh.triangles.iter().map(|t| t.to_vec()).collect();
        if let Some(planes) = convex::planes(&mesh.points, &faces).filter(|p| p.len() <= MOST_PLANES) {
            return Ok(to.half_spaces(around(mesh.points.iter().copied()), &planes, placed));
        }
    }
    let mesh = Mesh::new(placed.id, mesh.points.clone(), mesh.triangles.clone(), Vec::new());
    Ok(to.add(Solid::Mesh(Arc::new(mesh.map_err(|e| e.to_string())?)), placed))
}
