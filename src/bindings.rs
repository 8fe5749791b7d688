//! Bindings that several passes share.
//!
//! ```text
//!   constants      of the frame, or the sun, in a uniform block: a driver loads its words once for many invocations;
//!                  from a storage buffer it gathers them for each
//!   placed patches views, faces' places, faces, patches, their instances, points  glsl/include/placed.glsl
//!   bounded        views, instances, faces' places, faces, patches, their instances, taus, counters, cones, points, runs
//!                                                                                  glsl/include/bound.glsl
//!   primitives     leaves, their sides, surfaces, surfaces' places         glsl/include/solids.glsl, volume.glsl
//!   sun            sun, its tiles, …, primitives, leaves' centres, counts  glsl/include/sun.glsl
//! ```

use crate::gpu::{Buffer, Image, Resource, TexelBuffer};
use crate::shaders::constant;

/// Number of the sun's bindings, after all others of a pass: `glsl/include/sun.glsl`. They include the primitives that
/// cast shadows.
pub(crate) const SUN_BINDINGS: usize = 13;
/// The first of these, for a pass that binds the scene's primitives itself.
pub(crate) const SUN_OWN: usize = 7;

/// Placed patches, after the constants.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub views: &'a TexelBuffer,
    pub face_instances: &'a TexelBuffer,
    pub faces: &'a TexelBuffer,
    pub patches: &'a TexelBuffer,
    pub patch_instances: &'a TexelBuffer,
    pub points: &'a TexelBuffer,
}

impl<'a> Placed<'a> {
    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 6] {
        [self.views, self.face_instances, self.faces, self.patches, self.patch_instances, self.points]
            .map(Resource::from)
    }
}

/// Bindings of the passes that compute how finely each patch is divided.
#[derive(Clone, Copy)]
pub(crate) struct Bounded<'a> {
    pub frame: &'a Buffer,
    /// Part to pixel, for each instance.
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a TexelBuffer,
    /// Face instance of each patch instance.
    pub patch_instances: &'a Buffer,
    /// `tau_u | tau_v << 16` for each patch instance; written.
    pub taus: &'a Buffer,
    /// `clamps`; written.
    pub counters: &'a Buffer,
    /// The cone of each patch's normals; `None` if no closed part is without trims.
    pub cones: Option<&'a Buffer>,
    /// Control points.
    pub points: &'a TexelBuffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the listed patch instances.
    pub runs: &'a Buffer,
}

impl<'a> Bounded<'a> {
    /// The shaders' constants.
    pub(crate) fn constants(cones: bool) -> [(u32, u32); 1] {
        [(constant::SCENE_HAS_CONES, u32::from(cones))]
    }

    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 12] {
        let cones = self.cones.unwrap_or(self.frame); // not read in that case
        let placed = [self.views, self.instances, self.face_instances, self.faces, self.patch_instances];
        let [views, instances, face_instances, faces, patch_instances] = placed.map(Resource::from);
        let [frame, taus, counters, cones] = [self.frame, self.taus, self.counters, cones].map(Resource::from);
        let (patches, points, runs) = (self.patches.into(), self.points.into(), self.runs.into());
        [frame, views, instances, face_instances, faces, patches, patch_instances, taus, counters, cones, points, runs]
    }
}

/// Primitives of Boolean solids.
#[derive(Clone, Copy)]
pub(crate) struct Primitives<'a> {
    pub leaves: &'a Buffer,
    pub leaf_surfaces: &'a TexelBuffer,
    pub surfaces: &'a TexelBuffer,
    /// Places of surfaces, in model axes relative to the eye.
    pub surface_places: &'a TexelBuffer,
}

impl<'a> Primitives<'a> {
    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 4] {
        let [sides, surfaces, places] = [self.leaf_surfaces, self.surfaces, self.surface_places].map(Resource::from);
        [self.leaves.into(), sides, surfaces, places]
    }
}

/// Boolean solids, for passes that ask whether a point is seen: `glsl/include/edge_seen.glsl`.
#[derive(Clone, Copy)]
pub(crate) struct SeenSolids<'a> {
    /// (u, v) of spline faces that bound operands.
    pub operand_uv: &'a Image,
    pub leaf_surfaces: &'a TexelBuffer,
    pub surface_places: &'a TexelBuffer,
    /// Of operands that are meshes: meshes, triangles, positions.
    pub meshes: [&'a Buffer; 3],
}

impl<'a> SeenSolids<'a> {
    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 6] {
        let [meshes, triangles, positions] = self.meshes.map(Resource::from);
        let (sides, places) = (self.leaf_surfaces.into(), self.surface_places.into());
        [self.operand_uv.into(), sides, places, meshes, triangles, positions]
    }
}
