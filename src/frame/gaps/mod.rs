//! Gaps between trimmed faces: pixels that may look through one are listed, and get the face that belongs there.
//!
//! ```text
//!   visibility, border_depths ──gap_find──▶ candidates ──gap_fill──▶ who is seen there ──gap_write──▶ visibility
//! ```
//!
//! A picture with more pixels than a storage buffer has room for candidates is divided into bands of rows, each with a
//! list of its own. Every list is made before the first one is decided, and decided before the first one is written, so
//! the picture does not depend on the bands.

mod capacities;
pub(crate) mod gap_fill;

pub(crate) use capacities::Capacities;

use super::common::room::{COUNTED, Room};
use super::{Frame, WRITE_TO_READ};
use crate::abi::{GapBand, GapCandidate};
use crate::frame::capacities::Ranges;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Image, Resource, barrier};
use crate::scene::{SceneData, SolidData};
use crate::shaders::TrimTest;
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// Format of [`Gaps::border_depths`]: the bits of reversed depths.
const BORDER_DEPTH_FORMAT: vk::Format = vk::Format::R32_UINT;

/// The passes of scenes with trims, whose test is `test`.
pub(super) fn passes(device: &Device, data: &SceneData, test: &TrimTest) -> Result<gap_fill::GapFill, GpuError> {
    let meshes_and_solids = data.has_meshes() || data.solids.kinds().is_some();
    let volume = data.volume.as_ref().and_then(SolidData::kinds);
    gap_fill::GapFill::new(device, test, (data.has_rational, meshes_and_solids), volume)
}

/// The stage.
pub(crate) struct Gaps {
    passes: Arc<gap_fill::GapFill>,
    /// The depth of the nearest skirt at each pixel; 0 without one.
    pub border_depths: Image,
    bands: Vec<Band>,
}

/// Rows of the picture, and the list of their gap candidates.
struct Band {
    rows: Range<u32>,
    candidates: Buffer,
    band: Buffer,
}

impl Band {
    fn list(&self) -> gap_fill::ListBindings<'_> {
        gap_fill::ListBindings { candidates: &self.candidates, band: &self.band }
    }
}

impl Gaps {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<gap_fill::GapFill>) -> Result<Self, GpuError> {
        let (height, rows) = (room.size.1, capacities::band_rows(room.size, Ranges::of(room.device).quads));
        let band = |top: u32| {
            Ok(Band {
                rows: top..(top + rows).min(height),
                candidates: room.structs::<GapCandidate>("gap candidates", room.capacities.gaps.candidates)?,
                band: room.indirect::<GapBand>("gap band", 1)?,
            })
        };
        Ok(Self {
            passes: Arc::clone(passes),
            border_depths: room.image("border depths", BORDER_DEPTH_FORMAT, COUNTED)?,
            bands: (0..height).step_by(rows as usize).map(band).collect::<Result<_, GpuError>>()?,
        })
    }

    /// Before each drawing.
    pub(super) fn clear(&self, cmd: &Commands<'_>) {
        self.bands.iter().for_each(|band| cmd.fill(&band.band, 0));
        let (read, cleared, drawn) = (Access::COMPUTE_READ, Access::TRANSFER_WRITE, Access::FRAGMENT_WRITE);
        barrier::images(cmd, &[(&self.border_depths, (read | drawn).discarded(), cleared)]);
        cmd.clear(&self.border_depths, 0);
        barrier::images(cmd, &[(&self.border_depths, cleared, drawn)]);
    }

    /// Pixels that look through a gap between faces get the face that belongs there.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, test: &[Resource<'_>]) {
        let (s, c, v) = (frame.scene, &frame.stages.common, &frame.stages.visibility);
        let (w, r) = WRITE_TO_READ;
        let borders = (&self.border_depths, Access::FRAGMENT_WRITE, r);
        barrier::images(cmd, &[(&v.image, Access::COLOUR_WRITE, w), (&v.depth, Access::DEPTH_WRITE, r), borders]);
        if let Some(meshes_and_solids) = &v.meshes_and_solids {
            barrier::images(
                cmd,
                &[(meshes_and_solids, Access::COLOUR_WRITE, Access::COMPUTE_READ | Access::FRAGMENT_READ)],
            );
        }
        barrier::buffers(cmd, &[(&c.counters, Access::INDIRECT_READ, w)]);
        cmd.after(Access::TRANSFER_WRITE, w);
        let find = gap_fill::FindBindings {
            frame: frame.constants,
            visibility: &v.image,
            counters: &c.counters,
            depth: &v.depth,
            border_depths: &self.border_depths,
        };
        for (nth, band) in self.bands.iter().enumerate() {
            if nth > 0 {
                barrier::images(cmd, &[(&v.image, w, w)]);
                barrier::buffers(cmd, &[(&c.counters, w, w)]);
            }
            self.passes.find(cmd, &find, band.list(), &band.rows);
        }
        barrier::images(cmd, &[(&v.image, w, r)]);
        cmd.after(w, w | r | Access::INDIRECT_READ);
        let fill = gap_fill::Bindings {
            frame: frame.constants,
            placed: s.placed(frame.views),
            visibility: &v.image,
            instances: &s.instances,
            meshes_and_solids: v.meshes_and_solids.as_ref().map(|seen| gap_fill::MeshesAndSolids {
                seen,
                meshes: s.meshes.as_ref().map(|m| gap_fill::Meshes {
                    instances: &m.instances,
                    triangles: &m.triangles,
                    positions: &m.positions,
                }),
            }),
            trim: test,
            volume: frame.volume(),
        };
        self.bands.iter().for_each(|band| self.passes.record(cmd, &fill, band.list()));
        cmd.after(w, r);
        let mut read = r;
        for band in &self.bands {
            barrier::images(cmd, &[(&v.image, std::mem::replace(&mut read, w), w)]);
            self.passes.show(cmd, &fill, band.list());
        }
    }
}
