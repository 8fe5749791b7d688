//! The sun's buffers, for passes that light points.

use super::{Frame, WRITE_TO_READ};
use crate::bindings::{Primitives, SUN_BINDINGS};
use crate::gpu::{Access, Commands, Resource, TexelBuffer};
use crate::scene::SunTiles;

impl<'a> Frame<'a> {
    /// The sun's buffers in binding order; `None` without a sun.
    pub(super) fn sun_bindings(&self) -> Option<[Resource<'a>; SUN_BINDINGS]> {
        let sun = self.sun?;
        // if nothing casts shadows, the shader reads only the first
        let (tiles, leaves) = self.scene.sun.as_ref().map_or((sun, sun), |s| (&s.tiles, &s.leaves));
        let (points, words, quads) = (&self.scene.points, &self.scene.patch_instances, &self.scene.patches);
        let of = |which: fn(&'a SunTiles) -> Option<&'a TexelBuffer>, none: &'a TexelBuffer| {
            self.scene.sun.as_ref().and_then(which).unwrap_or(none)
        };
        let triangles = of(|s| s.triangles.as_ref(), quads);
        let lists = of(|s| s.lists.as_ref(), words);
        let facets = of(|s| s.facets.as_ref(), quads);
        let parts = self.sun_parts.unwrap_or(points);
        let nobody = Primitives { leaves: sun, leaf_surfaces: words, surfaces: points, surface_places: points };
        let (casters, middles) = self
            .solids()
            .map_or((nobody, sun), |solids| (solids.scene.primitives(solids.centres.surfaces), solids.centres.leaves));
        let stored = [sun, tiles, leaves].map(Resource::from);
        let fetched = [triangles, lists, facets, parts].map(Resource::from);
        let last = [middles, &self.stages.common.counters].map(Resource::from);
        let mut all = stored.into_iter().chain(fetched).chain(casters.resources()).chain(last);
        Some(std::array::from_fn(|_| all.next().expect("as many as SUN_BINDINGS")))
    }

    /// Draws with the sun's buffers, and counts the rays to the sun that a driver cut short.
    pub(super) fn under_sun(&self, cmd: &Commands<'_>, draw: impl FnOnce(Option<&[Resource<'_>; SUN_BINDINGS]>)) {
        let bindings = self.sun_bindings();
        let counted = WRITE_TO_READ.0 | Access::INDIRECT_READ;
        if bindings.is_some() {
            cmd.after(counted, Access::FRAGMENT_WRITE);
        }
        draw(bindings.as_ref());
        if bindings.is_some() {
            cmd.after(Access::FRAGMENT_WRITE, counted);
        }
    }
}
