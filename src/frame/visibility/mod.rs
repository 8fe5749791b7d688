//! The frame's part for what is drawn: triangles of meshes, then patches before them.

pub(crate) mod mesh;
pub(crate) mod patches;

use super::Frame;
use crate::gpu::{Access, Attachment, Commands, Load, Resource, barrier};
use patches::Visibility;

use crate::scene::MeshBuffers;

impl Frame<'_> {
    /// Meshes first: what hides them may be in doubt.
    pub(super) fn mesh(&self, cmd: &Commands<'_>, pass: &mesh::Mesh, m: &MeshBuffers) {
        let b = self.buffers;
        let bindings = mesh::Bindings {
            frame: self.constants,
            views: self.views,
            mesh_instances: &m.instances,
            triangles: &m.triangles,
            positions: &m.positions,
            volume: self.volume(),
        };
        let seen = b.others.as_ref().unwrap_or(&b.visibility);
        pass.record(cmd, &bindings, (seen, &b.depth), &m.draws, m.outward);
        barrier::images(
            cmd,
            &[(seen, Access::COLOUR_WRITE, Access::COLOUR_WRITE), (&b.depth, Access::DEPTH_WRITE, Access::DEPTH_WRITE)],
        );
    }

    /// `again`: over what it drew before.
    pub(super) fn visibility(&self, cmd: &Commands<'_>, test: &[Resource<'_>], again: bool) {
        self.patches(cmd, &self.passes.visibility, test, again);
    }

    /// By a pass like `visibility`.
    pub(super) fn patches(&self, cmd: &Commands<'_>, pass: &Visibility, test: &[Resource<'_>], again: bool) {
        let (s, b) = (self.scene, self.buffers);
        barrier::buffers(cmd, &[(&b.counters, Access::COMPUTE_WRITE, Access::INDIRECT_READ)]);
        if let Some(t) = &b.trim {
            let before = if again { Access::FRAGMENT_WRITE } else { Access::TRANSFER_WRITE };
            barrier::buffers(cmd, &[(&t.rings, before, Access::FRAGMENT_WRITE)]);
        }
        let bindings = patches::Bindings {
            frame: self.constants,
            placed: s.placed(self.views),
            factors: &b.factors,
            sub_patches: &b.sub_patches,
            instances: &s.instances,
            rings: b.trim.as_ref().map(|t| &*t.rings),
            trim: test,
            volume: self.volume(),
            links: s.links.as_ref(),
            draws: &b.draws,
            counters: &b.counters,
        };
        let drawn = again || s.meshes.is_some() || s.solids.is_some();
        let colour = if again || drawn && b.others.is_none() { Load::Keep } else { Load::ColourU32([0; 4]) };
        let visibility = Attachment { image: &b.visibility, load: colour };
        let depth = Attachment { image: &b.depth, load: if drawn { Load::Keep } else { Load::Depth(0.0) } };
        pass.record(cmd, &bindings, (visibility, depth), b.capacities.draws);
    }
}
