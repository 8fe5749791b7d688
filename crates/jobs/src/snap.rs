//! Points of a model to snap to, for callers without a picture.

use crate::error::{JobError, guarded};
use glam::DVec2;
use selvedge::model::{Camera, Edges, Model};
use selvedge_check::{EdgeTracer, SnapKind, Tracer};
use serde::Serialize;
use std::sync::Arc;

/// The names of the kinds of points, preferred kinds first.
pub const SNAP_KINDS: [(&str, SnapKind); 3] =
    [("vertex", SnapKind::Vertex), ("centre", SnapKind::Centre), ("edge", SnapKind::Edge)];

/// A model whose edges have been found, so that each call only searches them.
#[derive(Debug)]
pub struct Snapper {
    model: Arc<Model>,
    tracer: Tracer,
    parts: Vec<Edges>,
}

/// A point of the model near a place in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Snapped {
    /// vertex, centre or edge.
    pub kind: &'static str,
    /// Model coordinates.
    pub point: [f64; 3],
    /// Position in the picture; the first pixel's centre is (0.5, 0.5).
    pub pixel: [f64; 2],
    /// Distance from the given place, pixels.
    pub distance_px: f64,
    /// Distance from the eye along the view axis, model units.
    pub depth: f64,
    /// Index of the placed body.
    pub instance: usize,
    /// Number of the edge, as in the image of edges; for a vertex, the number of an edge that ends there.
    pub edge: usize,
}

impl Snapper {
    /// Finds the edges of the model's parts.
    ///
    /// # Errors
    /// [`JobError::Boundary`], [`JobError::Panicked`].
    pub fn new(model: Arc<Model>) -> Result<Self, JobError> {
        guarded(|| {
            let tracer = Tracer::new(&model);
            let edges = model
                .parts
                .iter()
                .enumerate()
                .map(|(part, p)| p.edges().map_err(|source| JobError::Boundary { part, source }));
            let parts = edges.collect::<Result<_, _>>()?;
            Ok(Self { model, tracer, parts })
        })
    }

    /// The preferred visible point of these kinds within `radius_px` of `pixel`, by [`EdgeTracer::snap`].
    ///
    /// # Errors
    /// [`JobError::Camera`]; [`JobError::Snap`] if the place is not finite or the radius is not a number above
    /// 0.
    pub fn snap(
        &self,
        camera: &Camera,
        pixel: [f64; 2],
        radius_px: f64,
        kinds: &[SnapKind],
    ) -> Result<Option<Snapped>, JobError> {
        camera.check()?;
        if !(radius_px > 0.0 && radius_px.is_finite() && pixel.iter().all(|x| x.is_finite())) {
            return Err(JobError::Snap);
        }
        let edges = EdgeTracer::with(&self.model, &self.tracer, &self.parts);
        let Some(found) = edges.snap(camera, DVec2::from(pixel), radius_px, kinds) else { return Ok(None) };
        let before: usize = self.parts[..found.part].iter().map(|e| e.edges.len() + e.of_meshes.len()).sum();
        let kind = SNAP_KINDS.iter().find(|(_, kind)| *kind == found.kind).map_or("", |(name, _)| *name);
        Ok(Some(Snapped {
            kind,
            point: found.point.into(),
            pixel: found.pixel.into(),
            distance_px: found.distance_px,
            depth: found.depth,
            instance: found.instance,
            edge: before + found.edge + 1,
        }))
    }
}
