//! The public face for hosts: a renderer on their device, recording into their command buffers.
//!
//! ```text
//!   Requirements ─▶ host makes its device ─▶ Renderer::new ─▶ upload(&Model)
//!                                                  │
//!       each frame, per frame slot:   record(cmd, &FrameInput)  ─▶  host submits, waits its fence
//!                                                  │
//!                                      report(slot) ─▶ complete? times, counts, bytes
//! ```
//!
//! The renderer never submits, waits, or destroys what is the host's. Only the GPU can count how large some buffers
//! must be (the trim table, the list of sub-patches), so they may be too small for a new view. Then the report of that
//! frame says `complete: false`, and the next `record` into its slot makes them larger. A scene of more bytes than
//! staging memory holds is copied by several frames, which report the same. A view from very near is drawn from what is
//! cut out of the model for it: [`Renderer::prepare`]. Instances change, and models come and go, between frames:
//! [`Renderer::add`].

mod centres;
mod constants;
mod copies;
mod edit;
mod error;
mod failure;
mod history;
mod instances;
mod load;
mod models;
mod pick;
mod report;
mod slot;
mod source;
mod targets;
mod validate;
mod viewport;

use crate::abi;
use crate::budget::Budget;
use crate::frame::capacities::{Capacities, Ranges};
use crate::frame::counts::Counts;
pub use crate::frame::counts::TooMany;
use crate::frame::shading::{numbers, resolve};
use crate::frame::solids::Solids;
use crate::frame::transparency::solid_layers;
use crate::frame::viewport as rectangle;
use crate::frame::{Frame, Near, Passes, Stages, target};
use crate::gpu::{
    Attachment, Buffer, Commands, Device, GpuError, HostDevice, Load, MemoryReport, Staging, TexelBuffer, Uploads,
};
use crate::model::{Camera, Model};
use crate::picture::{Effects, FrameSettings, PoolBytes};
use crate::scene::{Array, Cut, Joinable, Picking, Scene, SceneData, Write};
pub use crate::scene::{EditError, Hit, InstanceError, UndrawnEdges, UndrawnSolid, trim_way};
use ash::vk;
pub use error::RenderError;
use history::History;
pub use models::{ModelId, RemoveError};
use pick::SlotPick;
pub use report::FrameReport;
use slot::Slot;
use source::Source;
use std::collections::BTreeMap;
use std::sync::Arc;
pub use targets::{Aovs, TargetFormats, Targets};
use viewport::Viewport;

/// One frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameInput<'a> {
    /// View and size.
    pub camera: &'a Camera,
    /// Tolerance, background, style, effects left out.
    pub settings: FrameSettings,
    /// Frame slot, below the number given to [`Renderer::new`]; the frame before in it has finished on the GPU.
    pub slot: usize,
    /// Where the picture goes.
    pub targets: Targets<'a>,
}

/// A renderer on a host's device: one scene, drawn by any number of views. `README.md`, "In an engine", has an example.
///
/// Any thread may hold it; one at a time records. It must be dropped before the device.
pub struct Renderer {
    device: Device,
    formats: TargetFormats,
    source: Option<Source>,
    /// Of the source: as it is, or what was cut out of it.
    loaded: Option<Loaded>,
    slots: Vec<Slot>,
    /// Slots that frames were recorded into, the last one at the end.
    order: Vec<usize>,
    /// The next frame reads back what this pixel shows.
    pick: Option<(u32, u32)>,
    /// Every frame checks that its lists had room before it draws patches. If `false`, only the first frame does, and
    /// each frame after buffers were made.
    pub(crate) counts_first: bool,
    /// A frame never reached the GPU, so its copies are missing there: the next frame loads the source anew.
    stale: bool,
    /// The images for frames whose targets are larger than their picture.
    viewport: Option<Viewport>,
}

/// A model and what its frames need. Fields drop in order: nothing outlives the device.
struct Loaded {
    data: SceneData,
    counts: Counts,
    capacities: Capacities,
    passes: Passes,
    picking: Arc<Picking>,
    scene: Option<Scene>,
    /// Arrays of the scene that the GPU does not have yet.
    waiting: Uploads<'static>,
    stages: Option<Stages>,
    /// Edits of loops that the next frame copies.
    edits: Vec<Write>,
    /// The same of placed parts, by their offsets.
    changes: BTreeMap<u64, Write>,
    /// Some placed part is elsewhere since the frame before.
    moved: bool,
    /// What the frame before left; `None`: its buffers are gone.
    history: Option<History>,
    /// What its stages' buffers have room for, models that were added included.
    room: Counts,
    /// How models join it; `None` where they do not.
    joinable: Option<Joinable>,
    /// Faces and triangles of removed models, which are still in its arrays.
    gone: u64,
    /// It was cut out of the model for a view.
    is_cut: bool,
    /// It may be trimmed exactly, where a view needs too much of the table.
    may_be_exact: bool,
    /// What it was cut by, where it may be.
    cut: Option<Box<Cut>>,
}

impl Loaded {
    fn bands(&self) -> u32 {
        let stages = self.stages.as_ref().filter(|_| self.counts.events);
        stages.map_or(0, |s| s.size().1.div_ceil(abi::TILE).div_ceil(self.capacities.solids.band_rows))
    }

    fn solid_bytes(&self) -> Vec<PoolBytes> {
        self.stages.as_ref().and_then(Stages::solids).map_or_else(Vec::new, Solids::bytes)
    }
}

#[allow(dead_code)] // held for their drop
enum Retired {
    Stages(Box<Stages>),
    Viewport(Box<Viewport>),
    Loaded(Box<Loaded>),
    Staging(Staging),
    Buffer(Buffer),
    TexelBuffer(TexelBuffer),
    Array(Array),
}

impl Renderer {
    /// Formats of the images of depth, face, (u, v) and normal. The fourth component of a normal is 1, but 0 for
    /// background and where [`sun`](crate::picture::SceneSettings::sun) does not reach.
    pub const AOV_FORMATS: [vk::Format; 4] = resolve::AOV_FORMATS;
    /// Format of the images of edges, parts and instances.
    pub const NUMBER_FORMAT: vk::Format = numbers::NUMBER_FORMAT;
    /// Format of the image of thickness.
    pub const THICKNESS_FORMAT: vk::Format = solid_layers::THICKNESS_FORMAT;

    /// Takes the host's device on loan; `frame_slots` frames, at least one, may be in flight. [`upload`](Self::upload)
    /// a model next.
    ///
    /// # Errors
    /// [`GpuError`].
    ///
    /// # Safety
    /// As [`Device::new`]. The renderer is dropped when the GPU has finished its frames, before the
    /// device and the allocator.
    pub unsafe fn new(host: HostDevice, formats: TargetFormats, frame_slots: usize) -> Result<Self, GpuError> {
        // SAFETY: the caller's promise.
        let device = unsafe { Device::new(host) };
        Self::on(&device, formats, frame_slots)
    }

    /// As [`new`](Self::new), on a device that is already on loan.
    pub(crate) fn on(device: &Device, formats: TargetFormats, frame_slots: usize) -> Result<Self, GpuError> {
        let slots = (0..frame_slots.max(1)).map(|_| Slot::new(device)).collect::<Result<_, _>>()?;
        Ok(Self {
            device: device.clone(),
            formats,
            source: None,
            loaded: None,
            slots,
            order: Vec::new(),
            pick: None,
            counts_first: false,
            stale: false,
            viewport: None,
        })
    }

    /// So many frames may be in flight from now on. Frames of slots that go have finished on the GPU, as have all
    /// before them.
    #[cfg(feature = "headless")]
    pub(crate) fn set_slots(&mut self, frame_slots: usize) -> Result<(), GpuError> {
        self.slots.truncate(frame_slots);
        self.order.retain(|slot| *slot < frame_slots);
        while self.slots.len() < frame_slots {
            self.slots.push(Slot::new(&self.device)?);
        }
        Ok(())
    }

    /// Records one frame: compute, draws, and the picture into the targets.
    ///
    /// # Errors
    /// [`RenderError`]. The renderer is as before the call, unless the device is lost. After [`RenderError::Gpu`] reset
    /// the command buffer: it may hold copies from buffers that no longer exist. After other errors it is as before the
    /// call.
    ///
    /// # Panics
    /// When no model was uploaded, the slot does not exist, the targets are not those of [`TargetFormats`], or these have
    /// a thickness and the scene is uploaded without
    /// [`SceneSettings::thickness`](crate::picture::SceneSettings::thickness).
    ///
    /// # Safety
    /// * `cmd` is recording outside a render pass, on the host's queue family, and is submitted once.
    /// * The frame recorded before into the same slot has finished on the GPU.
    /// * Frames are submitted in the order in which they are recorded, to one queue.
    pub unsafe fn record(&mut self, cmd: vk::CommandBuffer, input: &FrameInput<'_>) -> Result<(), RenderError> {
        input.camera.check()?;
        let tolerance = input.settings.tolerance_px;
        if !(tolerance >= FrameSettings::LEAST_TOLERANCE_PX && tolerance.is_finite()) {
            return Err(RenderError::Tolerance(tolerance));
        }
        validate::check_curvature(input.settings, self.loaded.as_ref().is_none_or(|l| l.counts.curvature))?;
        input.targets.check(&self.formats, input.camera.size)?;
        let wanted = self.loaded.as_ref().is_none_or(|l| l.counts.thickness);
        assert!(wanted || !self.formats.outputs.thickness, "the model is uploaded with SceneSettings::thickness");
        // SAFETY: the caller's promise.
        let recorded = unsafe { self.record_checked(cmd, input) };
        self.noting(recorded)
    }

    /// [`Self::record`] of an input that was checked.
    ///
    /// # Safety
    /// See [`Self::record`].
    unsafe fn record_checked(&mut self, cmd: vk::CommandBuffer, input: &FrameInput<'_>) -> Result<(), RenderError> {
        let tolerance = input.settings.tolerance_px;
        self.reload()?;
        self.prepare(input.camera)?;
        self.make_room(input.slot, input.camera, input.settings.without)?;
        self.make_viewport(&input.targets, input.camera.size)?;
        let (device, most) = (self.device.clone(), self.most_staging());
        // SAFETY: the caller's promise.
        let cmd = unsafe { Commands::new(&device, cmd) };
        let Some(loaded) = &mut self.loaded else { panic!("upload a model before recording") };
        let copied = loaded.copy(&cmd, most)?;
        let left = copied.left(most);
        if copied.waits() || loaded.edit_bytes() > left {
            return Ok(self.record_copies(&cmd, input, copied, most)?);
        }
        let slot = &mut self.slots[input.slot];
        let view = (*input.camera, input.settings);
        if loaded.moved {
            loaded.data.settle();
        }
        let table = loaded.data.table_view(input.camera, Budget::of(tolerance).beside());
        let edited = loaded.moved || !loaded.edits.is_empty();
        let history = History::after(loaded.history, view, table, edited, loaded.counts.hides);
        slot.write(&self.device, loaded, input, &self.formats, &history)?;
        let (mut new, staging) = copied.into_parts();
        pick::make_room(self.pick, &mut slot.pick, &self.device)?;
        let scene = loaded.scene.as_mut().or(new.as_mut().map(|(scene, _)| scene));
        let (Some(scene), Some(stages)) = (scene, &loaded.stages) else { unreachable!("made above") };
        let writes = loaded.edits.iter().chain(loaded.changes.values());
        let edits = writes.clone().next().map(|_| Frame::edit(&cmd, scene, writes, left)).transpose()?;
        // nothing fails from here on: larger arrays are in the scene
        let scene = &*scene;
        let (Some(views), Some(in_sight)) = (&slot.views, &slot.in_sight) else { unreachable!("written above") };
        let keep = input.settings.background.is_none();
        let own = self.viewport.as_ref().zip(input.targets.corner);
        let pairs = own.map(|(viewport, corner)| (viewport.pairs(&input.targets), corner));
        let targets = own.map_or(input.targets, |(viewport, _)| viewport.targets(&input.targets));
        let colour = targets.colours(&self.formats, stages, keep);
        let depth = targets.depth.map(|image| {
            let whole = target(image, keep);
            if keep { whole } else { Attachment { load: Load::Depth(0.0), ..whole } }
        });
        let solids = scene.solids.as_ref().and_then(|s| s.blister.as_ref());
        let near = Near {
            depth: input.camera.depth_range.0 as f32,
            may_cut: solids.is_some_and(|(walk, _)| walk.may_be_cut(input.camera)),
        };
        let operand_pixels = loaded.data.solids.operand_pixels(input.camera);
        let frame = Frame {
            stages,
            scene,
            counts: loaded.counts,
            capacities: loaded.capacities,
            constants: &slot.constants,
            views,
            in_sight,
            patch_instances_in_sight: slot.patch_instances_in_sight,
            parts_in_sight: slot.parts_in_sight.as_ref().map(|parts| (parts, slot.part_count)),
            samples: &slot.samples,
            draws_centres: slot.counted > slot.samples.len(),
            table_view: slot.table.as_ref(),
            centres: slot.centres.solids(),
            near,
            occlusion: history.occlusion,
            reuses_view: history.reuses_view,
            reuses_table: history.reuses_table,
            counts_first: self.counts_first || loaded.history.is_none(),
            operand_pixels: &operand_pixels,
            volume_places: slot.centres.volume(),
            sun: slot.centres.sun(),
            sun_parts: slot.centres.sun_parts(),
            counters: &slot.counters,
            colour: &colour,
            without: input.settings.without,
            background: constants::background(input, &self.formats),
            depth,
            thickness: targets.thickness.map(|image| Attachment { image, load: Load::ColourF32([0.0; 4]) }),
            numbers: targets.numbers(&self.formats, stages, keep),
        };
        slot.times.reset(&cmd);
        if let Some((pairs, corner)) = &pairs {
            rectangle::begin(&cmd, pairs, *corner, keep);
        }
        frame.record(&cmd, &mut slot.times);
        if let Some((pairs, corner)) = &pairs {
            rectangle::end(&cmd, pairs, *corner);
        }
        let Some(source) = &self.source else { unreachable!("it was loaded") };
        pick::record(self.pick, &mut slot.pick, (&cmd, &frame), (source, &loaded.picking, input));
        // only now: a frame that was not recorded left nothing
        self.pick = None;
        slot.edit_bytes = edits.as_ref().map_or(0, |(staging, _)| staging.bytes());
        if let Some((staging, replaced)) = edits {
            slot.retired.push(Retired::Staging(staging));
            slot.retired.extend(replaced.into_iter().map(Retired::Array));
        }
        loaded.edits.clear();
        loaded.changes.clear();
        loaded.keep(new, &staging);
        slot.retired.push(Retired::Staging(staging));
        slot.copies = None;
        loaded.history = Some(history);
        loaded.moved = false;
        (slot.recorded, slot.reused) = (true, history.reuses_view);
        slot.capacities = Some(loaded.capacities);
        slot.size = input.camera.size;
        slot.counts = loaded.counts;
        slot.shadow_deviation = loaded.data.sun.as_ref().map_or(0.0, |sun| sun.deviation);
        (slot.bands, slot.solid_bytes) = (loaded.bands(), loaded.solid_bytes());
        self.order.retain(|slot| *slot != input.slot);
        self.order.push(input.slot);
        Ok(())
    }

    /// The model that was uploaded, as edits and changes of instances have made it.
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.source.as_ref().map(|source| &source.model)
    }

    /// What was uploaded.
    #[cfg(feature = "headless")]
    pub(crate) fn source(&self) -> Option<&Source> {
        self.source.as_ref()
    }

    /// Names of the buffers, images and pipelines that exist for the loaded model.
    pub fn objects(&self) -> Vec<String> {
        self.device.objects()
    }

    /// The bytes that the allocator has taken from the device, and the bytes in use.
    pub fn memory_report(&self) -> MemoryReport {
        self.device.memory_report()
    }

    /// Frees what the slot's last frame used, and makes the buffers large enough for the counts that this frame
    /// reported, or that a first one is expected to report, and for the picture's size.
    fn make_room(&mut self, slot: usize, camera: &Camera, without: Effects) -> Result<(), RenderError> {
        let size = camera.size;
        let finished = &mut self.slots[slot];
        let (had, drawn) = (finished.capacities.take(), finished.size);
        let report = had.map(|_| finished.read_counters());
        // the frame that lacked room is recorded again, and with it the copy of its pixel
        if report.is_some_and(|c| c.failed != 0) {
            self.pick = self.pick.or_else(|| finished.pick.as_mut().and_then(SlotPick::take_back));
        }
        finished.retired.clear();
        finished.recorded = false;
        let Some(loaded) = &mut self.loaded else { return Ok(()) };
        let ranges = Ranges::of(&self.device);
        let capacities = match (had, report) {
            // else another slot's frame has made them larger since
            (Some(had), Some(c)) if had == loaded.capacities => match had.grown(&c, loaded.counts, drawn, ranges) {
                Ok(grown) => grown,
                // a picture of another size may have room
                Err(_) if drawn != size => loaded.capacities,
                Err(too_many) if too_many.is_of_table() && loaded.may_be_exact => {
                    self.load_exact()?;
                    return self.make_room(slot, camera, without);
                }
                Err(too_many) => return Err(too_many.into()),
            },
            _ if loaded.scene.is_none() => {
                loaded.capacities.expecting(loaded.data.solids.expected_crossings(camera), loaded.counts)
            }
            _ => loaded.capacities,
        };
        let capacities = capacities.for_picture(loaded.counts, size, ranges)?;
        let suffice = loaded.stages.as_ref().is_some_and(|stages| stages.suffice(loaded.counts, capacities, size));
        let make = || Stages::new(&self.device, &loaded.passes, loaded.room, capacities, size);
        let made = (!suffice).then(make).transpose()?;
        // layers of faces are recorded, not stored: more of them may be seen in the same buffers
        if made.is_some() || loaded.capacities != capacities {
            loaded.history = None;
        }
        // only now: a view that needs more than there is must not spoil the next one
        loaded.capacities = capacities;
        if let Some(old) = made.and_then(|made| loaded.stages.replace(made)) {
            self.retire(Retired::Stages(Box::new(old)));
        }
        if let Some(loaded) = self.loaded.as_mut().filter(|_| !without.lines) {
            let (stages, passes) = (&mut loaded.stages, &loaded.passes);
            stages.as_mut().map_or(Ok(()), |stages| stages.make_lines(&self.device, passes))?;
        }
        Ok(())
    }

    /// Keeps `what` until every frame in flight has finished. They finish in the order in which they
    /// were recorded, so it goes with the slot recorded last; at once when that one has finished.
    fn retire(&mut self, what: Retired) {
        if let Some(slot) = self.order.last().map(|last| &mut self.slots[*last]).filter(|slot| slot.recorded) {
            slot.retired.push(what);
        }
    }
}
