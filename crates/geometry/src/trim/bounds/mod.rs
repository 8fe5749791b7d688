//! The extent of models: boxes of trimmed faces, not of control points.
//!
//! ```text
//!        control points                 highest along a direction is       1. a point of a trim curve, or of the
//!     ●─ ─ ─ ─ ─ ─ ─ ─ ●                                                      border of the domain,
//!        ╭──────╮            ┬ box      2. a point where patches meet,
//!     ┊ ╱  face  ╲     ┊     │          3. or a point inside a patch where
//!      ╱──────────╲          ┴             the surface is level.
//!     ●            ●
//! ```
//!
//! *Method.* Each of the six sides is a search for the highest point along a direction. Its candidates are in a heap,
//! the highest bound first: placed parts, their faces, trim curves and runs of them, patches and their sides.
//! Bounds come from boxes, then from control values. A piece of a trim curve over one patch is a rational curve in
//! space ([`compose`]), and is halved until the bound is met. A patch is halved likewise, and dropped where the loops
//! leave nothing of it or where it is nowhere level. Trimmed planes, cylinders, cones and other ruled faces are highest
//! on their trim curves. Points that certainly belong to the model raise a mark: ends of curves, and corners inside the
//! loops. The search is over when no bound is above the mark by more than the tolerance, so parts and faces away from
//! the border of the model are never examined.
//!
//! *Work.* A face is first as high as its control points, then as those of the knot spans that its loops reach. Its
//! trim curves are halved in runs ([`curves`]): a run is as high as the part of the patch under its box, which costs a
//! fraction of a curve in space. Only the highest curves are cut and composed with their patches, once for all
//! directions. Patches are cut out of the surface where a search reaches them. The face beside a piece is tested last,
//! when no other candidate is higher.
//!
//! *Accuracy.* Each side touches a point of the model, and no point is beyond it by more than [`ANALYTIC`] of the box's
//! diagonal, or [`OTHER`] of it for faces without an equation, plus some roundings of the largest coordinate. The faces
//! are the model's: an importer's tolerance is not undone. Where a search would take more than some 65,000 steps, the
//! side is that of the remaining bounds, and too far out. Loops that cancel each other bound nothing; a face that the
//! loops leave empty has no box.
//!
//! *Placed parts.* A direction of the model is turned into a direction of the part, so turned parts have boxes as tight
//! as others. Of copies with the same rotation only the highest is searched; of all others, those that no bound
//! excludes. A copy costs one box. A turned copy that may reach farthest costs a box for each of its faces, and their
//! search.
//!
//! *Solids.* See [`solid`]. A volume that [trims](Model::trim_by) the model cuts the box of the faces, where it has a
//! box: such sides contain the model, and may be too far out.
//!
//! Source: branch and bound on hulls as in T. W. Sederberg, *Computer Aided Geometric Design*, course notes, 2012,
//! chapter 10 (Bézier clipping), with the test for level points instead of clipping.

mod carried;
mod compose;
mod convex;
mod curves;
mod framing;
mod height;
mod polyhedron;
mod search;
mod solid;
#[cfg(test)]
mod tests;

use crate::model::{Bounds, Face, Instance, Model, Part, Solid, meet};
use glam::{DAffine3, DVec3};
use search::{Body, Search, Tolerance};
use std::ops::Range;

/// How far points may be beyond a box, in shares of its diagonal: of planes, cylinders, cones, spheres and tori.
pub const ANALYTIC: f64 = 1e-9;
/// The same for other surfaces.
pub const OTHER: f64 = 1e-6;

/// How far a search may be off in the first guess at the size, in shares of the guess.
const COARSE: f64 = 1e-2;
/// If the box is smaller than this share of the guess, the guess is too large.
const GOOD_GUESS: f64 = 0.1;
/// Guesses, at most; after them the size is below the rounding of the first.
const MOST_GUESSES: usize = 16;

impl Face {
    /// Box of the trimmed face; empty where its loops leave nothing.
    ///
    /// Each side touches a point of the face. No point is beyond it by more than [`ANALYTIC`] of the box's diagonal, or
    /// [`OTHER`] of it where the surface has no equation of its own, plus some roundings of the largest coordinate.
    pub fn bounds(&self) -> Bounds {
        of(&[Body::new(std::slice::from_ref(self), &[])], &[(0, DAffine3::IDENTITY)])
    }
}

impl Part {
    /// Box of the trimmed faces and of the meshes' triangles, part coordinates; see [`Face::bounds`].
    pub fn bounds(&self) -> Bounds {
        self.bounds_placed(DAffine3::IDENTITY)
    }

    /// Box of the part under a placement: as tight as its own, however it is turned.
    pub fn bounds_placed(&self, transform: DAffine3) -> Bounds {
        of(&[Body::new(&self.faces, &self.meshes)], &[(0, transform)])
    }
}

impl Model {
    /// Box of everything drawn, model coordinates: for placed faces and meshes as tight as [`Face::bounds`]; for
    /// bounded solids, a box of their expressions over tight boxes of their primitives.
    pub fn bounds(&self) -> Bounds {
        self.bounds_of(0..self.instances.len(), 0..self.solids.len())
    }

    /// The same of some of the instances and solids, by their numbers.
    ///
    /// # Panics
    /// Where a number is out of range.
    pub fn bounds_of(&self, instances: Range<usize>, solids: Range<usize>) -> Bounds {
        self.bounds_with(&Placed::new(&self.parts, &self.instances[instances]), solids)
    }

    /// The same with placed parts that are prepared already.
    fn bounds_with(&self, Placed { bodies, placements }: &Placed<'_>, solids: Range<usize>) -> Bounds {
        let faces = of(bodies, placements);
        let faces = self.trim.as_ref().map_or(faces, |volume| meet(faces, solid::bounds(volume)));
        let solids = self.solids[solids].iter().map(solid::bounds);
        solids.filter(is_finite).fold(faces, Bounds::union)
    }

    /// Box of the placed boxes of all parts' [control points](Part::control_bounds) and of the solids, model
    /// coordinates. It contains the model, and may be much larger than it: [`Model::bounds`] is tight.
    pub fn control_bounds(&self) -> Bounds {
        let parts: Vec<Bounds> = self.parts.iter().map(Part::control_bounds).collect();
        let placed =
            |i: &Instance| parts.get(i.part).filter(|bounds| !bounds.is_empty()).map(|bounds| (*bounds, i.transform));
        let instances = self.instances.iter().filter_map(placed);
        let of_instances =
            instances.flat_map(|(bounds, transform)| bounds.corners().map(|c| transform.transform_point3(c)));
        // boxes of primitives cost little, but half-spaces have none
        let of_solid = |solid: &Solid| Some(solid.bounds()).filter(is_finite).unwrap_or_else(|| solid::bounds(solid));
        let solids = self.solids.iter().map(of_solid).filter(is_finite);
        of_instances.chain(solids.flat_map(Bounds::corners)).fold(Bounds::EMPTY, Bounds::with)
    }
}

/// Whether a box is neither empty nor open.
fn is_finite(bounds: &Bounds) -> bool {
    bounds.min.is_finite() && bounds.max.is_finite()
}

/// Parts that are placed, each once, and the number and transform of each instance.
struct Placed<'a> {
    bodies: Vec<Body<'a>>,
    placements: Vec<(usize, DAffine3)>,
}

impl<'a> Placed<'a> {
    /// Instances of parts that exist, whose transforms are finite.
    fn new(parts: &'a [Part], instances: &[Instance]) -> Self {
        let mut numbers = vec![None; parts.len()];
        let (mut bodies, mut placements) = (Vec::new(), Vec::new());
        for instance in instances.iter().filter(|i| i.transform.is_finite()) {
            let Some(part) = parts.get(instance.part) else { continue };
            let body = *numbers[instance.part].get_or_insert_with(|| {
                bodies.push(Body::new(&part.faces, &part.meshes));
                bodies.len() - 1
            });
            placements.push((body, instance.transform));
        }
        Self { bodies, placements }
    }
}

/// Box of bodies by their numbers, as placed.
fn of(bodies: &[Body<'_>], placements: &[(usize, DAffine3)]) -> Bounds {
    let directions = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let mut searches = directions.map(|direction| Search::new(bodies, placements, direction));
    let whole = placements.iter().flat_map(|(body, transform)| {
        let around = bodies[*body].around;
        let corners = if around.is_empty() { Vec::new() } else { around.corners().to_vec() };
        corners.into_iter().map(|c| transform.transform_point3(c))
    });
    let mut size = whole.fold(Bounds::EMPTY, Bounds::with).diagonal();
    // the box of control points may be many times too large
    for _ in 0..MOST_GUESSES {
        let off = COARSE * size;
        searches.iter_mut().for_each(|search| {
            search.refine(Tolerance { analytic: off, other: off });
        });
        let found = between(searches.each_ref().map(Search::low)).diagonal();
        let is_near = found < GOOD_GUESS * size;
        if !is_near {
            size = found;
            break;
        }
        size = found + 4.0 * off;
    }
    let tolerance = Tolerance { analytic: ANALYTIC * size, other: OTHER * size };
    between(searches.each_mut().map(|search| search.refine(tolerance)))
}

/// The box whose sides are so far along the directions.
fn between([x, y, z, below_x, below_y, below_z]: [f64; 6]) -> Bounds {
    // no -0
    let all = Bounds { min: 0.0 - DVec3::new(below_x, below_y, below_z), max: DVec3::new(x, y, z) };
    if all.is_empty() { Bounds::EMPTY } else { all }
}
