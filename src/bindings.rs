//! Bindings that several passes have in common.
//!
//! ```text
//!   constants      of the frame, or the sun, in a uniform block: a driver fetches its words once for many invocations,
//!                  where it gathers those of a storage buffer for each
//!   placed patches views, faces' places, faces, patches, items, points           glsl/include/placed.glsl
//!   bounded        views, instances, faces' places, faces, patches, items, taus, counters, cones, points
//!                                                                                  glsl/include/bound.glsl
//!   PRIMITIVES     leaves, their sides, surfaces, surfaces' places         glsl/include/solids.glsl, volume.glsl
//!   SUN_BINDINGS   sun, its tiles, …, PRIMITIVES, leaves' centres, counts  glsl/include/sun.glsl
//! ```

use crate::gpu::{Binding, Buffer, Resource, Texels};
use std::ops::Range;

/// Of the primitives of Boolean solids, one after another.
pub(crate) const PRIMITIVES: [Binding; 4] = [Binding::Storage, Binding::Texels, Binding::Texels, Binding::Texels];

/// The bindings of the sun, after all others of a pass: `glsl/include/sun.glsl`. Those that cast shadows are among them.
pub(crate) const SUN_BINDINGS: [Binding; 13] = {
    let mut bindings: [Binding; 13] = with_primitives(SUN_OWN);
    // triangles, lists, facets, parts
    let mut i = 3;
    while i < SUN_OWN {
        bindings[i] = Binding::Texels;
        i += 1;
    }
    bindings
};
/// The first of them, which a pass needs that has the scene's primitives for itself.
pub(crate) const SUN_OWN: usize = 7;

/// Patches as they are placed, after the constants.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub views: &'a Texels,
    pub face_instances: &'a Texels,
    pub faces: &'a Texels,
    pub patches: &'a Texels,
    pub items: &'a Texels,
    pub points: &'a Texels,
}

impl<'a> Placed<'a> {
    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 6] {
        [self.views, self.face_instances, self.faces, self.patches, self.items, self.points].map(Resource::from)
    }
}

/// Of passes that say how finely each patch must be divided.
#[derive(Clone, Copy)]
pub(crate) struct Bounded<'a> {
    pub frame: &'a Buffer,
    /// Part to pixel, per instance.
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a Buffer,
    /// Face instance of each item.
    pub items: &'a Buffer,
    /// `tau_u | tau_v << 16` per item; written.
    pub taus: &'a Buffer,
    /// `clamps`; written.
    pub counters: &'a Buffer,
    /// Of each patch's normals, where some closed part has no trims.
    pub cones: Option<&'a Buffer>,
    /// Control points.
    pub points: &'a Texels,
}

impl<'a> Bounded<'a> {
    /// The shaders' constants.
    pub(crate) fn constants(cones: bool) -> [(&'static str, u32); 1] {
        [("SCENE_HAS_CONES", u32::from(cones))]
    }

    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 11] {
        let cones = self.cones.unwrap_or(self.frame); // not read then
        let placed = [self.views, self.instances, self.face_instances, self.faces, self.patches, self.items];
        let [views, instances, face_instances, faces, patches, items] = placed.map(Resource::from);
        let [frame, taus, counters, cones] = [self.frame, self.taus, self.counters, cones].map(Resource::from);
        [frame, views, instances, face_instances, faces, patches, items, taus, counters, cones, self.points.into()]
    }
}

/// What stands at [`PRIMITIVES`].
#[derive(Clone, Copy)]
pub(crate) struct Primitives<'a> {
    pub leaves: &'a Buffer,
    pub leaf_surfaces: &'a Texels,
    pub surfaces: &'a Texels,
    /// Where surfaces are, model axes, seen from the eye.
    pub surface_places: &'a Texels,
}

impl<'a> Primitives<'a> {
    /// In binding order.
    pub(crate) fn resources(&self) -> [Resource<'a>; 4] {
        let [sides, surfaces, places] = [self.leaf_surfaces, self.surfaces, self.surface_places].map(Resource::from);
        [self.leaves.into(), sides, surfaces, places]
    }
}

/// Constants, and storage buffers after them: `count` in all.
pub(crate) fn with_constants(count: usize) -> Vec<Binding> {
    let mut bindings = vec![Binding::Storage; count];
    bindings[0] = Binding::Uniform;
    bindings
}

/// Constants, texels, and storage buffers after them: `count` in all.
pub(crate) fn with_texels(texels: Range<usize>, count: usize) -> Vec<Binding> {
    let mut bindings = with_constants(count);
    bindings[texels].fill(Binding::Texels);
    bindings
}

/// Constants, [`Placed`], and storage buffers after them: `count` in all.
pub(crate) fn with_placed(count: usize) -> Vec<Binding> {
    with_texels(1..7, count)
}

/// Constants, and storage buffers, but for [`PRIMITIVES`] from `first` on.
pub(crate) const fn with_primitives<const COUNT: usize>(first: usize) -> [Binding; COUNT] {
    let mut bindings = [Binding::Storage; COUNT];
    bindings[0] = Binding::Uniform;
    let mut i = 0;
    while i < PRIMITIVES.len() {
        bindings[first + i] = PRIMITIVES[i];
        i += 1;
    }
    bindings
}
