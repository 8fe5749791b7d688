//! The frame's last pass: where each kind of thing is seen, and what it gives pass `resolve`.

pub(crate) mod resolve;
pub(crate) mod seen_squares;

use super::transparency::LayerPasses;
use super::{Frame, WRITE_TO_READ, solids};
use crate::abi::TILE;
use crate::frame::transparency::solid_layers::UNSEEN;
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Load, barrier};

use crate::picture::Samples;
use crate::scene::SceneData;

/// What the scene asks of the pass.
pub(super) fn kinds(data: &SceneData) -> resolve::Kinds {
    resolve::Kinds {
        patches: data.has_patches,
        rational: data.has_rational,
        pieces: data.has_pieces,
        fine: data.has_fine,
        meshes: data.has_meshes(),
        solids: data.solids.kinds().map(|surfaces| resolve::SolidKinds {
            surfaces,
            tiles: solids::has_tiles(data),
            shells: !data.solids.shell_leaves.is_empty(),
        }),
        operands: data.has_operands,
        sun: data.sun.is_some(),
    }
}

/// The pass into the host's targets; `None` where samples make all of them.
pub(super) fn targets(
    device: &Device,
    data: &SceneData,
    formats: resolve::Formats,
) -> Result<Option<resolve::Resolve>, GpuError> {
    let into = match data.samples {
        Samples::One if data.smooths_trims() => resolve::Destination::Unmixed,
        Samples::One if data.is_layered => resolve::Destination::Behind { writes_depth: true },
        Samples::Four | Samples::Eight
            if data.is_layered && (formats.aovs || formats.depth.is_some() || data.thickness) =>
        {
            resolve::Destination::Behind { writes_depth: true }
        }
        Samples::One => resolve::Destination::Targets,
        Samples::Four | Samples::Eight if formats.aovs || formats.depth.is_some() || data.thickness => {
            resolve::Destination::AllButColour
        }
        Samples::Four | Samples::Eight => return Ok(None),
    };
    resolve::Resolve::new(device, into, formats, kinds(data)).map(Some)
}

/// Depth, face, (u, v) and normal where nothing is seen.
const NOWHERE: [Load; 4] = [
    Load::ColourF32([f32::INFINITY; 4]),
    Load::ColourU32([0; 4]),
    Load::ColourF32([f32::NAN; 4]),
    Load::ColourF32([0.0; 4]),
];

impl<'a> Frame<'a> {
    /// What pass `resolve` draws into, cleared to what is where nothing is seen, unless the host keeps its picture.
    fn resolved_into(&self) -> Vec<Attachment<'a>> {
        let nowhere = [Load::ColourF32(self.background)].into_iter().chain(NOWHERE);
        let cleared = |(attachment, nowhere): (&Attachment<'a>, Load)| match attachment.load {
            Load::Discard => Attachment { load: nowhere, ..*attachment },
            _ => *attachment,
        };
        let mut into: Vec<_> = self.colour.iter().zip(nowhere).map(cleared).collect();
        let layered = self.passes.layers.as_ref().is_some_and(LayerPasses::is_layered);
        let behind = self.buffers.behind.as_ref().filter(|_| layered);
        if let Some(image) = behind.or(self.buffers.resolved.as_ref()) {
            into[0] = Attachment { image, load: Load::ColourF32([0.0, 0.0, 0.0, UNSEEN]) };
        }
        into
    }
}

impl Frame<'_> {
    /// Where pass `resolve` looks for patches and meshes.
    pub(super) fn seen_squares(&self, cmd: &Commands<'_>) {
        let b = self.buffers;
        let (Some(pass), Some(squares)) = (&self.passes.squares, &b.seen_squares) else { return };
        let (frame, visibility) = (self.constants, &b.visibility);
        let others = b.others.as_ref().unwrap_or(visibility);
        pass.record(cmd, &seen_squares::Bindings { frame, visibility, others, squares });
        barrier::buffers(cmd, &[(squares, WRITE_TO_READ.0, Access::VERTEX_READ)]);
    }

    pub(super) fn resolve(&self, cmd: &Commands<'_>, pass: &resolve::Resolve) {
        let (s, b) = (self.scene, self.buffers);
        let bindings = resolve::Bindings {
            frame: self.constants,
            placed: s.placed(self.views),
            instances: &s.instances,
            visibility: &b.visibility,
            others: b.others.as_ref().unwrap_or(&b.visibility),
            squares: b.seen_squares.as_ref().map(|squares| {
                let (width, height) = b.visibility.size();
                (width.div_ceil(TILE) * height.div_ceil(TILE), squares)
            }),
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
        let kinds = (meshes.as_ref(), solids.as_ref());
        self.under_sun(cmd, |sun| pass.record(cmd, &bindings, kinds, sun, &self.resolved_into(), self.depth));
    }
}
