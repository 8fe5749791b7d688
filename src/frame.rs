//! The frame in order. Each stage has a folder with its passes, its buffers and its record, which contains all barriers
//! between its passes.
//!
//! ```text
//!                 view, instances
//!                      │
//!    ┌─────────────────┴──────────────────┐
//!    ▼                                    ▼  scenes trimmed by table only
//!  bound    tau per patch               density    height of each v-strip in pixels
//!  split    segments per side           lines      scan lines per strip ──(scan)──▶ rows
//!    │(scan) sub-patches, vertices      segments   chords per curve     ──(scan)──▶
//!  emit     list and draws              dispatch_arguments
//!    │                                  cross      count ──(scan)──▶ write
//!    │                                  sort       flips of each row
//!    └─────────────────┬──────────────────┘
//!                      ▼
//!                    mesh        triangles of meshes: which one per pixel
//!                      ▼
//!                solid_events    where rays enter Boolean solids; solid_rects to solid_fold came before
//!                      ▼
//!                 visibility     tessellate, trim: patch and (u, v) per pixel; hidden patches are not drawn: occlusion/
//!                      │
//!                      ▼
//!                    gaps        pixels that look through a gap between trimmed faces
//!                      ▼
//!               seen_squares     tiles that see a patch or a mesh
//!                  resolve       exact point and normal per pixel, light ──▶ the host's targets
//!                      ▼
//!                 coverage       scenes with smooth trims: pixels at borders, mixed of what resolve drew
//!               solid_layers     scenes with transparent solids: their faces, over what resolve drew
//!                line_list       scenes with lines: where to look at what
//!                edge_line       each pixel's best line along an edge, over what was drawn
//!
//!  with several samples a pixel, everything from mesh on runs for each sample: antialiasing/samples.rs
//!  if the view has not changed, passes above seen_squares (with several samples: above mesh) are skipped: reuse.rs
//!  if the lists of solid_events and solid_layers are too large, they are made band by band: solids/bands.rs
//!  in scenes with a sun, resolve and solid_layers read the sun's tiles: shadows/
//! ```

use crate::abi::Counters;
use crate::bindings::Primitives;
use crate::gpu::{
    Access, Attachment, Buffer, Commands, Image, Load, ReadBack, Resource, TexelBuffer, Timestamps, barrier,
};
use crate::picture::Effects;
use crate::scene::Scene;
use antialiasing::samples::Scopes;
use capacities::Capacities;
use common::PatchList;
use common::kernel::Threads;
use counts::Counts;
use shading::resolve;
use std::ops::Range;
use transparency::Drawing;

pub(crate) mod antialiasing;
#[cfg(feature = "baselines")]
pub(crate) mod baselines;
pub(crate) mod capacities;
pub(crate) mod common;
pub(crate) mod counts;
pub(crate) mod edges;
pub(crate) mod gaps;
pub(crate) mod occlusion;
pub(crate) mod pick;
mod reuse;
pub(crate) mod shading;
mod shadows;
pub(crate) mod solids;
mod stages;
pub(crate) mod tessellation;
pub(crate) mod transparency;
pub(crate) mod trim;
pub(crate) mod viewport;
pub(crate) mod visibility;

pub(crate) use antialiasing::samples::ViewBuffers;
pub(crate) use occlusion::OcclusionState;
pub(crate) use solids::{Centres, Near};
pub(crate) use stages::{Passes, Stages};

/// The inputs and targets of one frame.
#[derive(Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub stages: &'a Stages,
    pub scene: &'a Scene,
    pub counts: Counts,
    pub capacities: Capacities,
    /// This slot's constants and transforms, written by the host.
    pub constants: &'a Buffer,
    pub views: &'a TexelBuffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the patch instances in sight.
    pub in_sight: &'a Buffer,
    /// Number of patch instances in sight.
    pub patch_instances_in_sight: u32,
    /// [`PartInSight`](crate::abi::PartInSight)s and their number, in a scene with occlusion culling of whole parts.
    pub parts_in_sight: Option<(&'a Buffer, u32)>,
    /// Constants and transforms for each of a pixel's samples; empty with one sample.
    pub samples: &'a [ViewBuffers],
    /// With several samples: the last drawing is of the pixels' centres. Lines and images other than colour need it.
    pub draws_centres: bool,
    /// The view for which the trim table is made; `None` if it is this view.
    pub table_view: Option<&'a ViewBuffers>,
    pub centres: Option<Centres<'a>>,
    pub near: Near,
    pub occlusion: OcclusionState,
    /// The previous frame's visibility images are still valid; with several samples, its patches and trim table.
    pub reuses_view: bool,
    /// The previous frame's trim table is still valid.
    pub reuses_table: bool,
    /// Pass `gate` runs: if a list overflowed before the first drawing, that drawing has no patches.
    pub counts_first: bool,
    /// Columns and rows of the pixels whose rays may cross operands without equations.
    pub operand_pixels: &'a [Range<u32>; 2],
    /// Places of the surfaces of the volume that trims the scene, relative to this frame's eye.
    pub volume_places: Option<&'a TexelBuffer>,
    /// The sun's constants, in a scene with a sun.
    pub sun: Option<&'a Buffer>,
    /// Middles of the placed parts that cast shadows; `None` without any.
    pub sun_parts: Option<&'a TexelBuffer>,
    pub counters: &'a ReadBack,
    pub colour: &'a [Attachment<'a>],
    /// Effects of the scene that are not drawn.
    pub without: Effects,
    /// The background as the colour target stores it; unused if the target's colours stay.
    pub background: [f32; 4],
    pub depth: Option<Attachment<'a>>,
    /// Length of the pixel's ray within solids; cleared to 0 before drawing.
    pub thickness: Option<Attachment<'a>>,
    /// Images of the numbers of edges, parts and instances.
    pub numbers: Option<[Attachment<'a>; 3]>,
}

const WRITE_TO_READ: (Access, Access) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);

impl<'a> Frame<'a> {
    /// The trim test's resources, in its order; empty if no patch is trimmed.
    fn trim_test(&self) -> Vec<Resource<'a>> {
        self.stages.trim.as_ref().map_or_else(Vec::new, |trim| trim.test(self))
    }

    /// The stage of lines, unless the frame leaves them out.
    fn edges(&self) -> Option<&'a edges::EdgeStage> {
        self.stages.edges.as_ref().filter(|_| !self.without.lines)
    }

    /// The listed patch instances.
    fn patch_list(&self) -> PatchList<'a> {
        let parts = self.stages.occlusion.as_ref().and_then(|occlusion| occlusion.patch_list());
        parts.unwrap_or(PatchList { runs: self.in_sight, threads: Threads::Host(self.patch_instances_in_sight) })
    }

    /// The placed parts in sight and their number.
    ///
    /// # Panics
    /// In a scene without occlusion culling of whole parts.
    fn parts_in_sight(&self) -> (&'a Buffer, u32) {
        self.parts_in_sight.expect("the slot has written them")
    }

    /// The volume that trims the scene; `None` without one.
    fn volume(&self) -> Option<Primitives<'a>> {
        let volume = self.scene.volume.as_ref()?;
        Some(volume.primitives(self.volume_places?))
    }
}

impl Frame<'_> {
    /// Records the whole frame.
    pub(crate) fn record(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        self.wait(cmd);
        self.stages.shading.begin(cmd);
        match &self.stages.samples {
            Some(samples) => {
                self.unless_view_reused(cmd, || self.prepare(cmd, times));
                samples.record(self, cmd, times);
            }
            None => {
                self.unless_view_reused(cmd, || {
                    self.prepare(cmd, times);
                    self.visibility(cmd, &mut Scopes::of(times));
                });
                self.shade(cmd, &mut Scopes::of(times), (self.stages.shading.resolve(), Drawing::Whole), 0);
            }
        }
        self.no_thickness(cmd);
        self.beside(cmd, times);
    }

    /// Draws the images of numbers, and lines along edges over the picture.
    fn beside(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        if self.numbers.is_some() {
            times.scope(cmd, "numbers", || self.stages.shading.numbers(self, cmd));
        }
        if let Some(edges) = self.edges() {
            times.scope(cmd, "lines", || edges.draw(self, cmd));
        }
    }

    /// Makes the input of drawing: the trim table and the divided patches.
    fn prepare(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        let stages = self.stages;
        self.begin(cmd);
        if let Some(trim) = &stages.trim {
            trim.record(self, cmd, times);
        }
        if self.counts.patch_instances > 0 {
            times.scope(cmd, "tessellation", || stages.tessellation.record(self, cmd));
        }
        if let Some(edges) = self.edges() {
            times.scope(cmd, "edges", || edges.divide(self, cmd));
        }
        #[cfg(feature = "baselines")]
        if let Some(trim) = &stages.trim {
            trim.record_baseline(self, cmd, times);
        }
        if self.counts_first {
            stages.common.gate(cmd);
        }
    }

    /// Draws the visibility images from the patches and the trim table.
    fn visibility(&self, cmd: &Commands<'_>, times: &mut Scopes<'_>) {
        let stages = self.stages;
        let test = self.trim_test();
        self.clear(cmd);
        if let Some(meshes) = &self.scene.meshes {
            times.drawing(cmd, "mesh", || stages.visibility.meshes(self, cmd, meshes));
        }
        if let Some(solids) = self.solids() {
            times.scope(cmd, "solids", || solids.record(self, cmd));
        }
        #[cfg(feature = "baselines")]
        stages.visibility.untested(self, cmd, times);
        times.drawing(cmd, "visibility", || stages.visibility.patches(self, cmd, &test, false));
        if let Some(occlusion) = stages.occlusion.as_ref().filter(|_| self.occlusion.tests()) {
            times.drawing(cmd, "occlusion", || occlusion.cull_late(self, cmd, &test));
        }
        let mut drawn = Access::COLOUR_WRITE;
        if let Some(gaps) = &stages.gaps {
            times.scope(cmd, "gaps", || gaps.record(self, cmd, &test));
            drawn = Access::COMPUTE_WRITE;
        }
        let read = Access::COMPUTE_READ | Access::FRAGMENT_READ;
        barrier::images(cmd, &[(&stages.visibility.image, drawn, read)]);
    }

    /// Shades the visible surfaces into `self.colour` and `self.depth`; the `nth` time in this frame.
    fn shade(
        &self,
        cmd: &Commands<'_>,
        times: &mut Scopes<'_>,
        (resolve, drawing): (Option<&resolve::Resolve>, Drawing),
        nth: u64,
    ) {
        let stages = self.stages;
        let behind = stages.transparency.iter().map(|layers| &layers.behind);
        for image in behind.chain(stages.unmixed()) {
            barrier::images(cmd, &[(image, Access::FRAGMENT_READ.discarded(), Access::COLOUR_WRITE)]);
        }
        if let Some(pass) = resolve {
            times.scope(cmd, "resolve", || stages.shading.record(self, cmd, pass));
        }
        let behind = stages.transparency.as_ref().and_then(|layers| layers.behind_layers());
        let mut written = Access::COLOUR_WRITE;
        if let Some(resolved) = behind.or(stages.unmixed()) {
            if let Some(contact) = stages.contact.as_ref().filter(|_| !self.without.ambient) {
                times.scope(cmd, "ambient", || contact.record(self, cmd, resolved));
                written = Access::COMPUTE_WRITE;
            }
            if let Some(smooth_borders) = stages.smooth_borders.as_ref().filter(|_| !self.without.borders) {
                let test = self.trim_test();
                times.scope(cmd, "borders", || smooth_borders.record(self, cmd, resolved, written, &test));
                written = Access::COMPUTE_WRITE;
            }
        }
        if let Some(linear) = &stages.linear {
            match &stages.smooth_trims {
                Some(smooth_trims) => {
                    let test = self.trim_test();
                    times.scope(cmd, "coverage", || smooth_trims.record(self, cmd, &linear.resolved, written, &test));
                }
                None => times.scope(cmd, "show", || linear.show(self, cmd, written)),
            }
        }
        if let (Some(layers), Some(solids)) = (&stages.transparency, self.solids()) {
            // without layers, nothing is drawn into the image behind them
            let written = if behind.is_some() { written } else { Access::COLOUR_WRITE };
            times.scope(cmd, "layers", || layers.record(self, cmd, &solids, drawing, written));
        }
        if let Some(edges) = self.edges().filter(|_| !matches!(drawing, Drawing::Sample)) {
            times.scope(cmd, "line lists", || edges.list(self, cmd));
        }
        let counters = &stages.common.counters;
        barrier::buffers(cmd, &[(counters, Access::COMPUTE_WRITE | Access::INDIRECT_READ, Access::TRANSFER_READ)]);
        self.counters.record_nth(cmd, counters, size_of::<Counters>() as u64, nth);
    }

    /// Clears the counters of the passes that prepare drawing.
    fn begin(&self, cmd: &Commands<'_>) {
        let stages = self.stages;
        if let Some(trim) = &stages.trim {
            trim.begin(self, cmd);
        }
        if let Some(occlusion) = &stages.occlusion {
            occlusion.begin(self, cmd);
        }
        stages.common.reset(self, cmd);
    }

    /// Waits for earlier draws that may still read the transient buffers.
    fn wait(&self, cmd: &Commands<'_>) {
        let before = [Access::COMPUTE_WRITE, Access::VERTEX_READ, Access::FRAGMENT_READ, Access::INDIRECT_READ];
        let before = before.into_iter().fold(Access::COMPUTE_READ, |all, one| all | one);
        barrier::memory(cmd, before | Access::TRANSFER_READ, Access::COMPUTE_WRITE | Access::TRANSFER_WRITE);
    }

    /// Clears the counters and images of one drawing.
    fn clear(&self, cmd: &Commands<'_>) {
        if let Some(gaps) = &self.stages.gaps {
            gaps.clear(cmd);
        }
        if let Some(solids) = &self.stages.solids {
            solids.begin(cmd);
        }
        self.stages.visibility.begin(cmd);
    }
}

/// The host's image as an attachment. With a background every pixel is written; without one, pixels outside the
/// surfaces stay.
pub(crate) fn target<'a>(image: &'a Image, keep: bool) -> Attachment<'a> {
    Attachment { image, load: if keep { Load::Keep } else { Load::Discard } }
}
