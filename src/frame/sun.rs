//! The frame's part for the sun: what passes that light points read of it.

use super::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Buffer, Commands, barrier};
use crate::shaders::SUN_BUFFERS;

impl<'a> Frame<'a> {
    /// The sun's buffers, in their order; `None` in a scene without one.
    pub(super) fn sun_bindings(&self) -> Option<[&'a Buffer; SUN_BUFFERS]> {
        let sun = self.sun?;
        // where nothing casts shadows the shader reads but the first
        let (tiles, leaves) = self.scene.sun.as_ref().map_or((sun, sun), |s| (&s.tiles, &s.leaves));
        let triangles = self.scene.sun.as_ref().and_then(|s| s.triangles.as_ref());
        let [triangles, listed] = triangles.map_or([sun; 2], |t| t.each_ref());
        let solids = self.scene.solids.as_ref().zip(self.centres);
        let [casters, sides, surfaces, centres, middles] =
            solids.map_or([sun; 5], |(s, c)| [&s.leaves, &s.leaf_surfaces, &s.surfaces, c.surfaces, c.leaves]);
        let counters = &self.buffers.counters;
        Some([sun, tiles, leaves, triangles, listed, casters, sides, surfaces, centres, middles, counters])
    }

    /// Draws with the sun, which counts the rays to it that the driver cut off.
    pub(super) fn under_sun(&self, cmd: &Commands<'_>, draw: impl FnOnce(Option<&[&Buffer; SUN_BUFFERS]>)) {
        let bindings = self.sun_bindings();
        let counted = WRITE_TO_READ.0 | Access::INDIRECT_READ;
        let counters = &self.buffers.counters;
        if bindings.is_some() {
            barrier::buffers(cmd, &[(counters, counted, Access::FRAGMENT_WRITE)]);
        }
        draw(bindings.as_ref());
        if bindings.is_some() {
            barrier::buffers(cmd, &[(counters, Access::FRAGMENT_WRITE, counted)]);
        }
    }
}
