//! The stored form of a model, and the checks between a file and a [`Model`].
//!
//! ```text
//!   bytes ──serde──▶ ModelData ──parts named by instances, numbers of faces, colours──▶ Model
//!                       ├─ PartData ─▶ Part
//!                       └─ FaceData ─▶ Face      each type checks its own on the way up:
//!                       └─ Mesh, Surface, TrimLoop      see their `try_from`
//! ```
//!
//! Code that builds a model in memory has these invariants by construction; a file may violate each of them.

use super::{Colour, EdgeSource, Face, Instance, Mesh, Model, Part, Solid, SurfaceKind, TrimLoop};
use crate::spline::Surface;
use serde::Deserialize;

/// Why stored parts and instances are not a model.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// An instance of nothing.
    #[error("instance {instance} is of part {part}, and there are {parts}")]
    Part { instance: usize, part: usize, parts: usize },
    /// A placement that is not made of numbers.
    #[error("the transform of instance {instance} is not finite")]
    Transform { instance: usize },
    /// A face or mesh with the number of the background.
    #[error("a face or mesh has number 0")]
    Number,
    /// A colour outside `[0, 1]`.
    #[error("a colour is not between 0 and 1")]
    Colour,
    /// A trim curve of an edge that the part does not have.
    #[error("a trim curve is of edge {edge}, and the part has {edges}")]
    Edge { edge: u32, edges: usize },
    /// [`Model::coincident`] is not a number.
    #[error("faces coincide within what is not a number")]
    Coincident,
}

/// A [`Model`] as stored.
#[derive(Deserialize)]
pub(super) struct ModelData {
    name: String,
    parts: Vec<Part>,
    instances: Vec<Instance>,
    solids: Vec<Solid>,
    trim: Option<Solid>,
    unit: String,
    coincident: Option<f64>,
}

/// A [`Part`] as stored.
#[derive(Deserialize)]
pub(super) struct PartData {
    name: String,
    faces: Vec<Face>,
    meshes: Vec<Mesh>,
    closed: bool,
    stated_edges: Vec<Option<EdgeSource>>,
}

impl TryFrom<PartData> for Part {
    type Error = ModelError;

    fn try_from(data: PartData) -> Result<Self, ModelError> {
        let PartData { name, faces, meshes, closed, stated_edges } = data;
        let edges = stated_edges.len();
        let mut named = faces.iter().flat_map(|f| &f.loops).flat_map(|l| l.edges()).flatten();
        match named.find(|e| e.edge as usize >= edges) {
            Some(e) => Err(ModelError::Edge { edge: e.edge, edges }),
            None => Ok(Self { name, faces, meshes, closed, stated_edges }),
        }
    }
}

/// A [`Face`] as stored.
#[derive(Deserialize)]
pub(super) struct FaceData {
    id: u32,
    kind: SurfaceKind,
    surface: Surface,
    loops: Vec<TrimLoop>,
    same_sense: bool,
    colour: Option<Colour>,
}

impl TryFrom<FaceData> for Face {
    type Error = ModelError;

    fn try_from(data: FaceData) -> Result<Self, ModelError> {
        check_colour(data.colour)?;
        let FaceData { id, kind, surface, loops, same_sense, colour } = data;
        if id == 0 { Err(ModelError::Number) } else { Ok(Self { id, kind, surface, loops, same_sense, colour }) }
    }
}

impl TryFrom<ModelData> for Model {
    type Error = ModelError;

    fn try_from(data: ModelData) -> Result<Self, ModelError> {
        let ModelData { name, parts, instances, solids, trim, unit, coincident } = data;
        for mesh in parts.iter().flat_map(|part| &part.meshes) {
            check_colour(mesh.colour)?;
            if mesh.id == 0 {
                return Err(ModelError::Number);
            }
        }
        solids.iter().chain(&trim).flat_map(|s| s.primitives()).try_for_each(|p| check_colour(Some(p.colour)))?;
        for (instance, placed) in instances.iter().enumerate() {
            check_colour(placed.colour)?;
            if placed.part >= parts.len() {
                return Err(ModelError::Part { instance, part: placed.part, parts: parts.len() });
            }
            if !placed.transform.is_finite() {
                return Err(ModelError::Transform { instance });
            }
        }
        if coincident.is_some_and(f64::is_nan) {
            return Err(ModelError::Coincident);
        }
        Ok(Self { name, parts, instances, solids, trim, unit, coincident })
    }
}

fn check_colour(colour: Option<Colour>) -> Result<(), ModelError> {
    let sane = colour.iter().flatten().all(|c| (0.0..=1.0).contains(c));
    if sane { Ok(()) } else { Err(ModelError::Colour) }
}
