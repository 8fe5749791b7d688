//! The exact reference renderer, against which every error is measured. Slow, `f64`, no GPU; triangles only where
//! the model itself has them.
//!
//! ```text
//!   pixel ──Camera::ray──▶ line ──Bvh over instances, then leaves──▶ candidates
//!         ──Solver──▶ all (u, v) where the line meets the surface ──LoopIndex──▶ those inside the loops
//!         ──Facets──▶ triangles of meshes, by exact signs
//!         ──LayerTracer──▶ where the union of the opaque Boolean solids is entered, and faces seen through
//! ```
//!
//! Nothing is tessellated and nothing is sampled: a hit is a root of the surface's own rational equations, accurate to
//! about 1e-15 of the distance to the eye. A root is excluded only by a proof (see the `solver` module). The reference
//! leaves out a surface seen exactly edge-on, because it covers no area. A solid is hit where the ray enters it, at the
//! near plane or behind it: a near plane within a solid cuts it open, and the first face entered from there is visible.
//! A ray hits every face of a transparent solid, whether it enters or leaves, unless the opacity is 0. Faces and meshes
//! of a model trimmed by a volume are hit within the volume, and up to [`ON`] outside of it.
//!
//! [`Tracer`] traces rays, [`judge`] compares a drawn [`Picture`]; [`SunTracer`] and [`judge_sun`] do so for the light.
//! [`EdgeTracer`] finds the visible points of edges; [`drawing`] has a view's lines as curves.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

mod bvh;
pub mod drawing;
mod edges;
mod facet;
mod judge;
mod leaf;
pub mod light;
mod net;
mod probe;
mod snap;
pub mod solids;
mod solver;
mod sun;
#[cfg(test)]
mod tests;

pub use edges::{AT, EdgePoint, EdgeTracer, Visibility};
pub use judge::{
    Bin, Class, DepthErrors, EXACT_DEPTH_PX, EXACT_NORMAL_DEG, Errors, Exactness, Folds, GRAZING_COSINE, JudgeOptions,
    Judgement, Mismatch, SMOOTH_PX, TOUCHING, TURN, judge,
};
pub use probe::Probe;
pub use snap::{Snap, SnapKind};
pub use sun::{SunJudgement, SunTracer, judge_sun};

use crate::model::{Bounds, Camera, Images, Items, Model};
use crate::trim::LoopIndex;
use bvh::Bvh;
use facet::Facets;
use glam::{DAffine3, DMat3, DVec2, DVec3};
use leaf::Leaf;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

use selvedge_geometry::{csg, math, model, spline, trim};

/// A point where a ray meets the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the eye along the view axis, model units.
    pub depth: f64,
    /// [`Face::id`](crate::model::Face::id), [`Mesh::id`](crate::model::Mesh::id) or
    /// [`Primitive::id`](crate::model::Primitive::id).
    pub face: u32,
    /// Index into [`Model::parts`]; beyond them for Boolean solids.
    pub part: usize,
    /// Index into [`Part::faces`](crate::model::Part::faces); beyond them, into
    /// [`Part::meshes`](crate::model::Part::meshes). Of Boolean solids the primitive of their
    /// [`union`](crate::model::Solid::union).
    pub face_index: usize,
    /// Index into [`Model::instances`]; beyond them for Boolean solids.
    pub instance: usize,
    /// Parameters in the face's domain; of a triangle, the weights of its second and third corner; no
    /// numbers of a solid.
    pub uv: DVec2,
    /// The point, model coordinates.
    pub point: DVec3,
    /// Unit outward normal, model coordinates; zero where the surface has none. Of a mesh with normals, the
    /// one between them.
    pub normal: DVec3,
    /// It is a triangle or on a solid: normals may jump where the id does not change.
    pub facet: bool,
    /// Of Boolean solids: [`Boundary::surface`](solids::Boundary::surface).
    pub surface: Option<u32>,
}

/// The true picture: the hit at each pixel's centre. Images as in [`Images`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Distance along the view axis, `+inf` for background.
    pub depth: Vec<f32>,
    /// Number of the face, 0 for background.
    pub face: Vec<u32>,
    /// Parameters in the face's domain, NaN for background.
    pub uv: Vec<[f32; 2]>,
    /// Unit outward normal, 0 for background.
    pub normal: Vec<[f32; 3]>,
}

impl Picture {
    /// The images for a judge.
    pub fn images(&self) -> Images<'_> {
        Images { size: self.size, depth: &self.depth, face: &self.face, normal: &self.normal, ..Images::default() }
    }
}

/// A model made ready for rays.
#[derive(Debug)]
pub struct Tracer {
    parts: Vec<PartTree>,
    placed: Vec<Placed>,
    top: Bvh,
    /// The model's Boolean solids and transparent closed parts; the opaque ones are one union.
    solids: Option<solids::LayerTracer>,
    /// The volume that trims faces and meshes.
    trim: Option<solids::SolidTracer>,
    bounds: Bounds,
    given_up: AtomicU64,
}

/// The faces and meshes of one part, in its own coordinates.
#[derive(Debug)]
struct PartTree {
    faces: Vec<TracedFace>,
    leaves: Vec<Leaf>,
    /// Box of each leaf.
    boxes: Vec<Bounds>,
    facets: Facets,
    /// Over leaves, then facets.
    tree: Bvh,
}

#[derive(Debug)]
struct TracedFace {
    id: u32,
    same_sense: bool,
    loops: LoopIndex,
}

#[derive(Debug)]
struct Placed {
    instance: usize,
    part: usize,
    to_model: DAffine3,
    to_part: DAffine3,
    /// Inverse transpose of the linear part: takes normals to model coordinates.
    normals: DMat3,
}

impl Tracer {
    /// Cuts all surfaces into leaves and builds the trees.
    ///
    /// Cost: microseconds a leaf, a leaf for every 20° or so that a surface turns. Instances whose
    /// transform flattens space are left out: they have no inside and no outward side. Boolean solids whose
    /// union is larger than a [`Tree`](crate::csg::Tree) may be are left out and count as given up; a volume
    /// that trims the model, too.
    pub fn new(model: &Model) -> Self {
        let items = model.items(false);
        let drawn = |instance: usize| items.as_ref().ok().is_none_or(|items| items.drawn[instance]);
        let parts: Vec<PartTree> = model.parts.par_iter().map(PartTree::new).collect();
        let place = |(instance, i): (usize, &crate::model::Instance)| {
            let to_part = i.transform.inverse();
            (i.part < parts.len() && to_part.is_finite() && drawn(instance)).then(|| Placed {
                instance,
                part: i.part,
                to_model: i.transform,
                to_part,
                normals: to_part.matrix3.transpose(),
            })
        };
        let placed: Vec<Placed> = model.instances.iter().enumerate().filter_map(place).collect();
        let boxes: Vec<Bounds> = placed
            .iter()
            .map(|p| match parts[p.part].tree.bounds() {
                b if b.is_empty() => b,
                b => b.corners().map(|c| p.to_model.transform_point3(c)).into_iter().fold(Bounds::EMPTY, Bounds::with),
            })
            .collect();
        let bounds = boxes.iter().fold(Bounds::EMPTY, |a, b| a.union(*b));
        let top = Bvh::new(&boxes, PAD * bounds.diagonal());
        let some = items.as_ref().ok().is_none_or(|i| !(i.opaque.is_empty() && i.clear.is_empty()));
        let layers = |items: Items| solids::LayerTracer::new(&items, model.coincidence()).ok();
        let solids = items.ok().filter(|_| some).and_then(layers);
        let trim = model.trim.as_ref().and_then(|v| solids::SolidTracer::new(v, model.coincidence()).ok());
        let lost = u64::from(some && solids.is_none()) + u64::from(model.trim.is_some() && trim.is_none());
        let given_up = AtomicU64::new(lost);
        let bounds = solids.iter().fold(bounds, |all, s| all.union(s.union().bounds()));
        Self { parts, placed, top, solids, trim, bounds, given_up }
    }

    /// A box around everything that can be hit; of unbounded solids only the bounded primitives count. At least the
    /// model's.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Every hit of the ray through pixel position `pixel` (continuous, `y` down; centres at +0.5),
    /// within the camera's depth range, nearest first.
    ///
    /// Cost: microseconds, and allocations: for many rays keep a [`Probe`].
    pub fn hits(&self, camera: &Camera, pixel: DVec2) -> Vec<Hit> {
        self.probe(camera).hits(pixel).to_vec()
    }

    /// The nearest hit, sooner than [`Tracer::hits`] would find it.
    #[doc(alias = "pick_exact")]
    pub fn first(&self, camera: &Camera, pixel: DVec2) -> Option<Hit> {
        self.probe(camera).first(pixel)
    }

    /// Working memory for many rays of one view; one a thread.
    pub fn probe<'a>(&'a self, camera: &'a Camera) -> Probe<'a> {
        Probe::new(self, camera)
    }

    /// Ray and sub-patch pairs whose search ran out of its budget, so that hits may be missing; 0
    /// unless a surface was degenerate beyond the rules of the module. Complete once the probes are
    /// dropped.
    pub fn given_up(&self) -> u64 {
        self.given_up.load(Ordering::Relaxed)
    }

    /// The true picture. `progress` receives the number of pixels done since the last call.
    pub fn picture(&self, camera: &Camera, progress: &(dyn Fn(u64) + Sync)) -> Picture {
        let (w, h) = camera.size;
        let row = |y: u32| {
            let mut probe = self.probe(camera);
            let hits: Vec<_> =
                (0..w).map(|x| probe.first(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))).collect();
            progress(u64::from(w));
            hits
        };
        let hits: Vec<Option<Hit>> = (0..h).into_par_iter().flat_map_iter(row).collect();
        Picture {
            size: camera.size,
            depth: hits.iter().map(|h| h.map_or(f32::INFINITY, |h| h.depth as f32)).collect(),
            face: hits.iter().map(|h| h.map_or(0, |h| h.face)).collect(),
            uv: hits.iter().map(|h| h.map_or([f32::NAN; 2], |h| h.uv.as_vec2().to_array())).collect(),
            normal: hits.iter().map(|h| h.map_or([0.0; 3], |h| h.normal.as_vec3().to_array())).collect(),
        }
    }
}

/// Points this near to the boundary of a volume that trims the model, along the ray and relative to the model's
/// diagonal, are within it: a face that lies in the boundary is there, whatever the rounding.
pub const ON: f64 = 1e-6;

/// Padding of boxes relative to the diagonal of their model: above the rounding of a slab test, below the size of any
/// feature.
const PAD: f64 = 1e-12;

impl PartTree {
    fn new(part: &crate::model::Part) -> Self {
        let prepare = |(index, f): (usize, &crate::model::Face)| {
            let loops = LoopIndex::new(&f.loops);
            let leaves = leaf::leaves(index as u32, f, &loops);
            (TracedFace { id: f.id, same_sense: f.same_sense, loops }, leaves)
        };
        let prepared: Vec<_> = part.faces.par_iter().enumerate().map(prepare).collect();
        let (faces, leaves): (Vec<_>, Vec<_>) = prepared.into_iter().unzip();
        let (leaves, boxes): (Vec<Leaf>, Vec<Bounds>) = leaves.into_iter().flatten().unzip();
        let (facets, mut all) = Facets::new(&part.meshes);
        all.splice(0..0, boxes.iter().copied());
        let size = all.iter().fold(Bounds::EMPTY, |a, b| a.union(*b)).diagonal();
        let tree = Bvh::new(&all, PAD * size);
        Self { faces, leaves, boxes, facets, tree }
    }
}
