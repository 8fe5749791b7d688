//! Lines of Boolean solids: their edges are known to no file, but the pixels' centres show between which of them one
//! runs.
//!
//! ```text
//!   what centres see, surfaces' equations ──edge_change──▶ places between centres ──edge_join──▶ each pixel's best line
//! ```

use super::{change, join};
use crate::abi::constants::edges::{LINES_FOLDS, LINES_SHARP, LINES_SMOOTH, LINES_SMOOTH_FULL};
use crate::frame::common::room::{DRAWN_AND_READ, Room};
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Image, Load, barrier};
use crate::picture::{EdgeChoice, EdgeSettings, TangentEdges};
use crate::scene::SceneData;

/// The passes.
pub(crate) struct Passes {
    /// `LINES_*`.
    drawn: u32,
    change: change::Change,
    join: join::Join,
}

/// Which lines are drawn: `LINES_*`.
fn drawn(settings: &EdgeSettings) -> u32 {
    let edges = match (settings.which, settings.tangent) {
        (EdgeChoice::None, _) => 0,
        (EdgeChoice::Sharp, _) | (EdgeChoice::All, TangentEdges::None) => LINES_SHARP,
        (EdgeChoice::All, TangentEdges::Thin) => LINES_SHARP | LINES_SMOOTH,
        (EdgeChoice::All, TangentEdges::Full) => LINES_SHARP | LINES_SMOOTH_FULL,
    };
    edges | if settings.silhouettes { LINES_FOLDS } else { 0 }
}

impl Passes {
    /// `None` where there is no Boolean solid.
    pub(super) fn new(device: &Device, data: &SceneData, settings: &EdgeSettings) -> Result<Option<Self>, GpuError> {
        let Some(surfaces) = data.solids.kinds() else { return Ok(None) };
        let (change, join) = (change::Change::new(device, data, surfaces)?, join::Join::new(device)?);
        Ok(Some(Self { drawn: drawn(settings), change, join }))
    }
}

/// Places between centres, two words a pixel.
pub(super) fn changes(room: &Room<'_>) -> Result<Image, GpuError> {
    room.image("changes of solids", change::CHANGE_FORMAT, DRAWN_AND_READ)
}

impl Passes {
    /// Lines into `best`. If the lists of primitives are those of one band, they are made again.
    pub(super) fn draw(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (changes, best): (&Image, &Image),
        half_px: [f32; 3],
    ) {
        let Some(solids) = frame.solids() else { return };
        let (s, v) = (frame.scene, &frame.stages.visibility);
        let parts = solids.resolve(frame);
        let bindings = change::Bindings {
            frame: frame.constants,
            primitives: parts.primitives,
            tiles: solids.stage.tiles().map(|t| (&t.tile_starts, &t.tile_leaves)),
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            scene: s,
            views: frame.views,
            boundary_operands: parts.boundary_operands.map(|m| change::BoundaryOperands {
                meshes: m.meshes,
                triangles: m.triangles,
                positions: m.positions,
                planes: m.planes,
            }),
            // of the same format
            operand_uv: parts.operand_uv.unwrap_or(best),
        };
        let (written, read) = (Access::COLOUR_WRITE, Access::FRAGMENT_READ);
        barrier::images(cmd, &[(changes, read.discarded(), written)]);
        let mut counted_again = false;
        for band in frame.bands() {
            if !band.is_whole {
                if !std::mem::replace(&mut counted_again, true) {
                    // they were read back
                    let counters = &frame.stages.common.counters;
                    barrier::buffers(cmd, &[(counters, Access::TRANSFER_READ, Access::COMPUTE_WRITE)]);
                    frame.count_bands_again(cmd);
                }
                solids.lists(frame, cmd, &band);
            }
            cmd.after(WRITE_TO_READ.0, read);
            let into = Attachment { image: changes, load: Load::Discard };
            self.change.record(cmd, &bindings, (into, band.rows.clone()), self.drawn);
        }
        barrier::images(cmd, &[(changes, written, read)]);
        self.join.record(cmd, frame.constants, (changes, best), half_px);
    }
}
