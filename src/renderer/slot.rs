//! A frame slot: the buffers that the CPU writes and reads for one frame in flight.

use super::centres::SlotCentres;
use super::constants::{constants, reach};
use super::history::History;
use super::pick::SlotPick;
use super::{FrameInput, Loaded, Retired, TargetFormats};
use crate::abi;
use crate::abi::Counters;
use crate::frame::ViewBuffers;
use crate::frame::capacities::Capacities;
use crate::frame::counts::Counts;
use crate::gpu::{
    Buffer, BufferInfo, Device, GpuError, MemoryLocation, Pool, ReadBack, Texel, TexelBuffer, Timestamps,
};
use crate::model::Camera;
use crate::picture::PoolBytes;
use crate::scene::{InSight, TableView, seen_by};
use ash::vk;
use glam::{DMat4, DVec3};

/// Timed scopes in a frame.
const SCOPES: u32 = 18;

/// What one frame in flight owns.
pub(super) struct Slot {
    pub(super) constants: Buffer,
    pub(super) views: Option<TexelBuffer>,
    /// [`PatchRun`](abi::PatchRun)s of the patch instances in sight.
    pub(super) in_sight: Option<Buffer>,
    /// How many patch instances are in sight.
    pub(super) patch_instances_in_sight: u32,
    /// [`PartInSight`](abi::PartInSight)s, in a scene with occlusion culling of whole parts; and their number.
    pub(super) parts_in_sight: Option<Buffer>,
    pub(super) part_count: u32,
    /// Constants and views for each of a pixel's samples, where there are several.
    pub(super) samples: Vec<ViewBuffers>,
    /// What the trim table is made of, where that is another view.
    pub(super) table: Option<ViewBuffers>,
    pub(super) centres: SlotCentres,
    pub(super) pick: Option<SlotPick>,
    pub(super) counters: ReadBack,
    /// What `counters` has room for, and how many the frame reports.
    pub(super) counter_room: usize,
    pub(super) counted: usize,
    pub(super) times: Timestamps,
    /// Freed when the slot comes round again.
    pub(super) retired: Vec<Retired>,
    pub(super) recorded: bool,
    /// The frame reused the visibility of the one before.
    pub(super) reused: bool,
    /// Copied for edits at the beginning of the frame.
    pub(super) edit_bytes: u64,
    /// The frame copied arrays of the scene and drew nothing of it: the bytes that waited still. `None`: it was drawn.
    pub(super) copies: Option<u64>,
    /// What the frame had room for; `None` when its model has been replaced since.
    pub(super) capacities: Option<Capacities>,
    /// Of the picture.
    pub(super) size: (u32, u32),
    /// What the frame's scene had, which may have been replaced since.
    pub(super) counts: Counts,
    pub(super) shadow_deviation: f64,
    /// What the frame reports of the lists of Boolean solids.
    pub(super) bands: u32,
    pub(super) solid_bytes: Vec<PoolBytes>,
}

impl Slot {
    pub(super) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self {
            constants: upload_buffer(device, "frame constants", size_of::<abi::Frame>() as u64)?,
            views: None,
            in_sight: None,
            patch_instances_in_sight: 0,
            parts_in_sight: None,
            part_count: 0,
            samples: Vec::new(),
            table: None,
            centres: SlotCentres::default(),
            pick: None,
            counters: read_counters(device, 1)?,
            counter_room: 1,
            counted: 1,
            times: Timestamps::new(device, SCOPES)?,
            retired: Vec::new(),
            recorded: false,
            reused: false,
            edit_bytes: 0,
            copies: None,
            capacities: None,
            size: (0, 0),
            counts: Counts::default(),
            shadow_deviation: 0.0,
            bands: 0,
            solid_bytes: Vec::new(),
        })
    }

    pub(super) fn read_counters(&self) -> Counters {
        let all = self.counters.values::<Counters>(self.counted);
        all.into_iter().fold(Counters::default(), Counters::most)
    }

    /// Writes this frame's constants and transforms.
    pub(super) fn write(
        &mut self,
        device: &Device,
        loaded: &Loaded,
        input: &FrameInput<'_>,
        formats: &TargetFormats,
        history: &History,
    ) -> Result<(), GpuError> {
        let reach = reach(loaded.counts, input.settings.tolerance_px);
        let in_sight = loaded.data.in_sight(input.camera, reach);
        let bytes = view_bytes(loaded);
        if self.views.as_ref().is_none_or(|b| b.bytes() < bytes) {
            let made = upload_views(device, "views", bytes)?;
            self.retired.extend(self.views.replace(made).map(Retired::TexelBuffer));
        }
        if let Some(buffer) = &mut self.views {
            write_views(buffer, loaded, input.camera.pixel_matrix(), &in_sight);
        }
        self.write_in_sight(device, &in_sight)?;
        self.write_parts(device, loaded, (input.camera, &in_sight), history)?;
        let shadows = !input.settings.without.shadows;
        self.centres.write(device, &loaded.data, input.camera, shadows, &mut self.retired)?;
        let centre = constants(device, loaded, input, formats, (history.table.as_ref(), &in_sight));
        self.constants.write(0, &[centre]);
        self.write_samples(device, loaded, (input.camera, &in_sight), centre)?;
        self.write_table(device, loaded, (input.camera, history), centre)?;
        // one drawing a sample, and one at the centre for the images that are no mean of samples
        let lines = loaded.counts.lines && !input.settings.without.lines;
        let beside = formats.outputs.has_points()
            || formats.outputs.has_numbers()
            || formats.depth.is_some()
            || loaded.counts.thickness
            || lines
            || self.samples.is_empty();
        self.counted = self.samples.len() + usize::from(beside);
        if self.counter_room < self.counted {
            self.counters = read_counters(device, self.counted)?;
            self.counter_room = self.counted;
        }
        Ok(())
    }

    /// Writes the runs of the patch instances in sight.
    fn write_in_sight(&mut self, device: &Device, in_sight: &InSight) -> Result<(), GpuError> {
        let bytes = size_of_val(in_sight.runs.as_slice()) as u64;
        if self.in_sight.as_ref().is_none_or(|b| b.bytes() < bytes) {
            let made = upload_buffer(device, "patch instances in sight", bytes.next_power_of_two())?;
            self.retired.extend(self.in_sight.replace(made).map(Retired::Buffer));
        }
        if let Some(buffer) = &mut self.in_sight {
            buffer.write(0, &in_sight.runs);
        }
        self.patch_instances_in_sight = in_sight.patch_instances;
        Ok(())
    }

    /// Writes the placed parts in sight, as groups of faces, for occlusion culling of whole groups. A frame that reuses
    /// its view does not read them, and only a frame that tests for occlusion reads where they may be drawn.
    fn write_parts(
        &mut self,
        device: &Device,
        loaded: &Loaded,
        (camera, in_sight): (&Camera, &InSight),
        history: &History,
    ) -> Result<(), GpuError> {
        if !loaded.counts.hides_parts {
            self.retired.extend(self.parts_in_sight.take().map(Retired::Buffer));
            return Ok(());
        }
        if history.reuses_view {
            return Ok(());
        }
        let tested = history.occlusion.tests().then_some(camera);
        let parts = loaded.data.parts_in_sight(tested, &in_sight.groups);
        let bytes = size_of_val(parts.as_slice()) as u64;
        if self.parts_in_sight.as_ref().is_none_or(|b| b.bytes() < bytes) {
            let made = upload_buffer(device, "parts in sight", bytes.next_power_of_two())?;
            self.retired.extend(self.parts_in_sight.replace(made).map(Retired::Buffer));
        }
        if let Some(buffer) = &mut self.parts_in_sight {
            buffer.write(0, &parts);
        }
        self.part_count = parts.len() as u32;
        Ok(())
    }

    /// Writes the views of a pixel's samples.
    fn write_samples(
        &mut self,
        device: &Device,
        loaded: &Loaded,
        (camera, in_sight): (&Camera, &InSight),
        centre: abi::Frame,
    ) -> Result<(), GpuError> {
        let offsets = loaded.counts.samples.offsets();
        let bytes = view_bytes(loaded);
        if self.samples.len() != offsets.len() || self.samples.iter().any(|s| s.views.bytes() < bytes) {
            self.retired.extend(std::mem::take(&mut self.samples).into_iter().flat_map(gone));
            for _ in offsets {
                self.samples.push(view_buffers(device, ["sample constants", "sample views"], bytes)?);
            }
        }
        for (sample, &offset) in self.samples.iter_mut().zip(offsets) {
            write_views(&mut sample.views, loaded, beside(camera.pixel_matrix(), offset), in_sight);
            let offset = offset.map(|x| x as f32);
            sample.constants.write(0, &[abi::Frame { offset, encode_srgb: abi::ENCODE_SUMMED, ..centre }]);
        }
        Ok(())
    }

    /// Writes the view that the trim table is made of, where it is made in this frame and of another view.
    fn write_table(
        &mut self,
        device: &Device,
        loaded: &Loaded,
        (camera, history): (&Camera, &History),
        centre: abi::Frame,
    ) -> Result<(), GpuError> {
        let wider = match &history.table {
            Some(TableView::Of(wider)) if wider != camera => wider,
            _ => {
                self.retired.extend(self.table.take().into_iter().flat_map(gone));
                return Ok(());
            }
        };
        if history.reuses_table {
            return Ok(());
        }
        let pixels = wider.pixel_matrix();
        let views = loaded.data.views(pixels);
        let bytes = size_of_val(views.as_slice()) as u64;
        if self.table.as_ref().is_none_or(|table| table.views.bytes() < bytes) {
            let made = view_buffers(device, ["trim table constants", "trim table views"], bytes)?;
            self.retired.extend(self.table.replace(made).into_iter().flat_map(gone));
        }
        if let Some(table) = &mut self.table {
            table.views.write(0, &views);
            table.constants.write(0, &[seen_by(wider, centre)]);
        }
        Ok(())
    }
}

fn view_bytes(loaded: &Loaded) -> u64 {
    (loaded.data.placements.len() * size_of::<abi::View>()) as u64
}

/// Writes the views of the placed parts in sight, or of all parts if a pass reads all.
fn write_views(buffer: &mut TexelBuffer, loaded: &Loaded, pixels: DMat4, in_sight: &InSight) {
    if loaded.counts.views_all {
        return buffer.write(0, &loaded.data.views(pixels));
    }
    let views = loaded.data.views_of(pixels, &in_sight.parts);
    let mut next = 0;
    for following in in_sight.parts.chunk_by(|a, b| a + 1 == *b) {
        let first = u64::from(following[0]) * size_of::<abi::View>() as u64;
        buffer.write(first, &views[next..next + following.len()]);
        next += following.len();
    }
}

/// The matrix to pixels whose centres lie `offset` farther right and down: what projects there moves to the centres.
fn beside(pixels: DMat4, [right, down]: [f64; 2]) -> DMat4 {
    DMat4::from_translation(DVec3::new(-right, -down, 0.0)) * pixels
}

fn read_counters(device: &Device, count: usize) -> Result<ReadBack, GpuError> {
    ReadBack::new(device, "counters (read back)", (count * size_of::<Counters>()) as u64)
}

pub(super) fn upload_buffer(device: &Device, name: &str, bytes: u64) -> Result<Buffer, GpuError> {
    use vk::BufferUsageFlags as Usage;
    // constants are uniform, and change from band to band
    let usage = Usage::UNIFORM_BUFFER | Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
    Buffer::new(device, &BufferInfo { name, bytes, usage, pool: Pool::Ring, location: MemoryLocation::Upload })
}

/// Of four floats each.
pub(super) fn upload_texels(device: &Device, name: &str, bytes: u64) -> Result<TexelBuffer, GpuError> {
    texels(device, name, bytes, vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER)
}

/// The same, which some passes read as structs.
fn upload_views(device: &Device, name: &str, bytes: u64) -> Result<TexelBuffer, GpuError> {
    use vk::BufferUsageFlags as Usage;
    texels(device, name, bytes, Usage::UNIFORM_TEXEL_BUFFER | Usage::STORAGE_BUFFER)
}

fn view_buffers(device: &Device, names: [&str; 2], bytes: u64) -> Result<ViewBuffers, GpuError> {
    let constants = upload_buffer(device, names[0], size_of::<abi::Frame>() as u64)?;
    Ok(ViewBuffers { constants, views: upload_views(device, names[1], bytes)? })
}

fn gone(buffers: ViewBuffers) -> [Retired; 2] {
    [Retired::Buffer(buffers.constants), Retired::TexelBuffer(buffers.views)]
}

fn texels(device: &Device, name: &str, bytes: u64, usage: vk::BufferUsageFlags) -> Result<TexelBuffer, GpuError> {
    let buffer =
        Buffer::new(device, &BufferInfo { name, bytes, usage, pool: Pool::Ring, location: MemoryLocation::Upload })?;
    TexelBuffer::new(device, buffer, Texel::F32x4)
}
