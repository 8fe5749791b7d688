//! Lines of Boolean solids: their edges are known to no file, but the pixels' centres show between which of them one
//! runs.
//!
//! ```text
//!   what centres see, surfaces' equations ──edge_change──▶ places between centres ──edge_join──▶ each pixel's best line
//!   solid_layers ─▶ the nearest faces of what is seen through ──the same──▶
//!                ─▶ the second ones, the third ones, …        ──the same──▶
//!                ─▶ the farthest ones, if there may be more than LINED_FACES  ──the same──▶
//! ```

use super::{change, join};
use crate::abi::constants::edges::{LINES_FOLDS, LINES_SHARP, LINES_SMOOTH, LINES_SMOOTH_FULL};
use crate::frame::common::layer_faces::{FACES_FORMAT, Faces, LINED_FACES};
use crate::frame::common::room::{DRAWN_AND_READ, Room};
use crate::frame::solids::SolidParts;
use crate::frame::solids::bands::Band;
use crate::frame::transparency::solid_layers::{For, SolidLayers};
use crate::frame::transparency::{Transparency, kinds};
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
    /// Where some solid is seen through.
    seen_through: Option<SeenThrough>,
}

/// The passes of what is seen through.
struct SeenThrough {
    nth: SolidLayers,
    /// Faces from the eye on that are looked at.
    count: u32,
    /// Where rays may meet more.
    farthest: Option<SolidLayers>,
    change: change::Change,
}

impl SeenThrough {
    fn new(device: &Device, data: &SceneData, surfaces: u32) -> Result<Self, GpuError> {
        let pass = |purpose| SolidLayers::new(device, purpose, None, kinds(data, surfaces));
        let most = data.solids.most_clear_faces();
        let count = most.map_or(LINED_FACES, |most| most.min(LINED_FACES));
        Ok(Self {
            nth: pass(For::NthFace)?,
            count,
            farthest: (most != Some(count)).then(|| pass(For::FarthestFace)).transpose()?,
            change: change::Change::new(device, data, (surfaces, true))?,
        })
    }

    /// All that are looked at, one after another.
    fn faces(&self) -> impl Iterator<Item = (Faces, &SolidLayers)> {
        let farthest = self.farthest.iter().map(|pass| (Faces::Farthest, pass));
        (1..=self.count).map(|number| (Faces::Nth(number), &self.nth)).chain(farthest)
    }
}

/// The images.
pub(super) struct Images {
    /// Places between centres, two words a pixel.
    changes: Image,
    /// Faces of what is seen through; where there is some.
    layers: Option<Image>,
}

impl Images {
    pub(super) fn new(room: &Room<'_>, passes: &Passes) -> Result<Self, GpuError> {
        let layers = || room.image("faces seen through", FACES_FORMAT, DRAWN_AND_READ);
        Ok(Self {
            changes: room.image("changes of solids", change::CHANGE_FORMAT, DRAWN_AND_READ)?,
            layers: passes.seen_through.as_ref().map(|_| layers()).transpose()?,
        })
    }
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
        let (change, join) = (change::Change::new(device, data, (surfaces, false))?, join::Join::new(device)?);
        let is_clear = data.is_layered && data.solids.has_clear_solids();
        let seen_through = is_clear.then(|| SeenThrough::new(device, data, surfaces)).transpose()?;
        Ok(Some(Self { drawn: drawn(settings), change, join, seen_through }))
    }

    /// Lines into `best`. If the lists of primitives are those of one band, they are made again.
    pub(super) fn draw(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (images, best): (&Images, &Image),
        half_px: [f32; 3],
    ) {
        let Some(solids) = frame.solids() else { return };
        let into = (&images.changes, best);
        self.count_again(frame, cmd);
        self.lines(frame, cmd, (&solids, &self.change), into, None);
        self.join.record(cmd, frame.constants, into, half_px);
        let clear = (&self.seen_through, &images.layers, &frame.stages.transparency);
        let (Some(passes), Some(layers), Some(transparency)) = clear else { return };
        for (faces, pass) in passes.faces() {
            seen_through(frame, cmd, (transparency, pass, &solids), (layers, faces));
            barrier::images(cmd, &[(best, Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE)]);
            self.lines(frame, cmd, (&solids, &passes.change), into, Some((layers, faces)));
            self.join.record(cmd, frame.constants, into, half_px);
        }
    }

    /// Orders what is counted here after the counters were read back: by lists of bands, and by rays through solids.
    fn count_again(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let counters = &frame.stages.common.counters;
        let of_bands = frame.bands().any(|band| !band.is_whole).then_some(Access::COMPUTE_WRITE);
        let of_rays = self.seen_through.as_ref().map(|_| Access::FRAGMENT_WRITE);
        for written in of_bands.into_iter().chain(of_rays) {
            barrier::buffers(cmd, &[(counters, Access::TRANSFER_READ, written)]);
        }
    }

    /// Places between centres into `changes`; `best` is of the format of operands' (u, v).
    fn lines(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (solids, change): (&SolidParts<'_>, &change::Change),
        (changes, best): (&Image, &Image),
        layers: Option<(&Image, Faces)>,
    ) {
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
            operand_uv: parts.operand_uv.unwrap_or(best),
            layers,
        };
        let (written, read) = (Access::COLOUR_WRITE, Access::FRAGMENT_READ);
        barrier::images(cmd, &[(changes, read.discarded(), written)]);
        each_band(frame, cmd, solids, |band| {
            cmd.after(WRITE_TO_READ.0, read);
            let into = Attachment { image: changes, load: Load::Discard };
            change.record(cmd, &bindings, (into, band.rows.clone()), self.drawn);
        });
        barrier::images(cmd, &[(changes, written, read)]);
    }
}

/// Faces of what is seen through, into `layers`.
fn seen_through(
    frame: &Frame<'_>,
    cmd: &Commands<'_>,
    (transparency, pass, solids): (&Transparency, &SolidLayers, &SolidParts<'_>),
    (layers, faces): (&Image, Faces),
) {
    let (written, read) = (Access::COLOUR_WRITE, Access::FRAGMENT_READ);
    barrier::images(cmd, &[(layers, read.discarded(), written)]);
    each_band(frame, cmd, solids, |band| {
        let into = Attachment { image: layers, load: Load::Discard };
        transparency.faces(frame, cmd, (pass, faces, solids), (into, band));
    });
    barrier::images(cmd, &[(layers, written, read)]);
}

/// Bands of rows with their lists: those of the whole picture are there, those of single bands are made again.
fn each_band(frame: &Frame<'_>, cmd: &Commands<'_>, solids: &SolidParts<'_>, draw: impl Fn(&Band)) {
    let mut counted_again = false;
    for band in frame.bands() {
        if !band.is_whole {
            if !std::mem::replace(&mut counted_again, true) {
                frame.count_bands_again(cmd);
            }
            solids.lists(frame, cmd, &band);
        }
        draw(&band);
    }
}
