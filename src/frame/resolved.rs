//! The frame's last pass: what each kind of thing gives pass `resolve`.

use super::Frame;
use crate::gpu::Commands;
use crate::passes::resolve;

impl Frame<'_> {
    pub(super) fn resolve(&self, cmd: &Commands<'_>) {
        let (s, b) = (self.scene, self.buffers);
        let bindings = resolve::Bindings {
            frame: self.constants,
            views: self.views,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            points: &s.points,
            instances: &s.instances,
            visibility: &b.visibility,
        };
        let meshes = s.meshes.as_ref().map(|m| resolve::MeshBindings {
            frame: self.constants,
            views: self.views,
            instances: &s.instances,
            mesh_instances: &m.instances,
            meshes: &m.meshes,
            triangles: &m.triangles,
            positions: &m.positions,
            normals: &m.normals,
            visibility: &b.visibility,
            others: b.others.as_ref().unwrap_or(&b.visibility),
        });
        let solids = self.solids().map(|parts| parts.resolve(self));
        self.passes.resolve.record(cmd, &bindings, meshes.as_ref(), solids.as_ref(), self.colour, self.depth);
    }
}
