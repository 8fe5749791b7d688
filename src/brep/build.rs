//! Stand-in for the conversion of faces; replaced when the branches are joined.

use super::{Boundary, Edge, FaceGeometry, SurfaceGeometry};
use crate::model::{Face, SurfaceKind};
use crate::spline::{SplineError, Surface};
use glam::DVec3;

/// A face ready to draw.
#[derive(Clone, Debug)]
pub struct BuiltFace {
    /// The face.
    pub face: Face,
    /// Healed things, worded as warnings.
    pub notes: Vec<String>,
    /// Millimetres, largest 3-D distance of a derived trim curve from its edge.
    pub deviation: f64,
}

/// Why a face cannot be built.
#[derive(Clone, Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum BuildError {
    #[error("the face has no loop and its surface is not closed")]
    NoLoop,
    #[error("a loop has no edge")]
    EmptyLoop,
    #[error(transparent)]
    Spline(#[from] SplineError),
}

/// The untrimmed control box of the face.
pub fn build_face(face: &FaceGeometry, edges: &[Edge], _tolerance: f64) -> Result<BuiltFace, BuildError> {
    use SurfaceGeometry as G;
    let kind = match &face.surface {
        G::Plane { .. } => SurfaceKind::Plane,
        G::Cylinder { .. } => SurfaceKind::Cylinder,
        G::Cone { .. } => SurfaceKind::Cone,
        G::Sphere { .. } => SurfaceKind::Sphere,
        G::Torus { .. } => SurfaceKind::Torus,
        G::Revolution { .. } => SurfaceKind::Revolution,
        G::Extrusion { .. } => SurfaceKind::Extrusion,
        G::BSpline(_) => SurfaceKind::BSpline,
    };
    if face.bounds.is_empty() && !matches!(kind, SurfaceKind::Sphere | SurfaceKind::Torus | SurfaceKind::BSpline) {
        return Err(BuildError::NoLoop);
    }
    let mut points = Vec::new();
    for bound in &face.bounds {
        match bound {
            Boundary::Vertex(p) => points.push(*p),
            Boundary::Edges(uses) if uses.is_empty() => return Err(BuildError::EmptyLoop),
            Boundary::Edges(uses) => points.extend(uses.iter().flat_map(|u| [edges[u.0].start, edges[u.0].end])),
        }
    }
    let surface = match &face.surface {
        G::BSpline(s) => s.clone(),
        _ => {
            let lo = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let hi = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            let (lo, hi) = if points.is_empty() { (DVec3::ZERO, DVec3::ONE) } else { (lo, hi) };
            let net = [lo, DVec3::new(hi.x, lo.y, lo.z), DVec3::new(lo.x, hi.y, hi.z), hi];
            let knots = vec![0.0, 0.0, 1.0, 1.0];
            Surface::new((1, 1), knots.clone(), knots, net.iter().map(|p| p.extend(1.0)).collect())?
        }
    };
    let face = Face { id: face.id, kind, surface, loops: vec![], same_sense: face.same_sense, colour: None };
    Ok(BuiltFace { face, notes: vec![], deviation: 0.0 })
}
