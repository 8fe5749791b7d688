//! The frame as prose: the passes in order, and every barrier between them.
//!
//! ```text
//!                 view, instances
//!                      │
//!    ┌─────────────────┴──────────────────┐
//!    ▼                                    ▼  scenes trimmed by table only
//!  bound    tau per patch               density    height of each v-strip in pixels
//!  split    segments per side           lines      scan lines per strip ──(scan)──▶ rows
//!    │(scan) sub-patches, vertices      segments   chords per curve     ──(scan)──▶
//!  emit     list and draws              sizes      dispatches
//!    │                                  cross      count ──(scan)──▶ insert
//!    │                                  sort       flips of each row
//!    └─────────────────┬──────────────────┘
//!                      ▼
//!                    mesh        triangles of meshes: which one per pixel
//!                      ▼
//!                solid_events    where rays enter Boolean solids; solid_rects to solid_fold came before
//!                      ▼
//!                 visibility     tessellate, trim: item and (u, v) per pixel
//!                      │         patches that lie behind others left out, and asked for: occlusion/
//!                      ▼
//!                    heal        pixels that look through a gap between trimmed faces
//!                      ▼
//!               seen_squares     tiles that see a patch or a mesh
//!                  resolve       exact point and normal per pixel, light ──▶ the host's targets
//!                      ▼
//!                 coverage       scenes with smooth trims: pixels at borders, mixed of what resolve drew
//!               solid_layers     scenes with something to see through: its faces, over what resolve drew
//!
//!  from mesh on once for each of a pixel's samples, where there are several: samples.rs
//!  nothing above seen_squares, or mesh where there are several samples, where the frame before had this view: kept.rs
//!  lists of solid_events and solid_layers band by band, where they are too large: bands.rs
//!  resolve and solid_layers ask the sun's tiles, in scenes with a sun: sun.rs
//! ```

use crate::abi::Counters;
use crate::bindings::Primitives;
use crate::frame::antialiasing::coverage::Coverage;
use crate::frame::buffers::{Buffers, TableBuffers};
use crate::frame::common::reset;
use crate::frame::common::scan;
use crate::frame::shading::resolve;
use crate::frame::shading::seen_squares::SeenSquares;
use crate::frame::tessellation::emit;
use crate::frame::tessellation::split;
use crate::frame::visibility::mesh;
use crate::frame::visibility::patches;
use crate::frame::visibility::patches::{DEPTH_FORMAT, Kinds, VISIBILITY_FORMAT};
use crate::gpu::{
    Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, ReadBack, Texels, Timestamps, barrier,
};
use crate::picture::TakenWay;
use crate::scene::{Scene, SceneData, SolidData};
use antialiasing::samples::{SamplePasses, Scopes};
use antialiasing::smooth_trims;
use occlusion::HiddenPasses;
use solids::SolidPasses;
use std::ops::Range;
use tessellation::divide::DividePass;
use transparency::{Drawing, LayerPasses};
use trim::{TrimParts, TrimPasses};

pub(crate) mod antialiasing;
#[cfg(feature = "baselines")]
pub(crate) mod baselines;
pub(crate) mod buffers;
pub(crate) mod capacities;
pub(crate) mod common;
pub(crate) mod gaps;
pub(crate) mod occlusion;
mod reuse;
pub(crate) mod shading;
mod shadows;
pub(crate) mod solids;
pub(crate) mod tessellation;
pub(crate) mod transparency;
pub(crate) mod trim;
pub(crate) mod visibility;

pub(crate) use antialiasing::samples::ViewBuffers;
pub(crate) use occlusion::Hiding;
pub(crate) use solids::{Centres, Near};

/// The passes that a scene needs.
pub(crate) struct Passes {
    reset: reset::Reset,
    scan: scan::Scan,
    /// Of scenes with patches.
    tessellation: Option<TessellationPasses>,
    /// Of scenes in which patches may lie behind others.
    hidden: Option<HiddenPasses>,
    trim: Option<TrimPasses>,
    solids: Option<SolidPasses>,
    visibility: patches::Visibility,
    /// The same without a trim test, to compare with.
    #[cfg(feature = "baselines")]
    untested: Option<patches::Visibility>,
    mesh: Option<mesh::Mesh>,
    /// Of scenes with patches or meshes.
    squares: Option<SeenSquares>,
    /// Into the host's targets; `None` where they are but a colour, made of samples.
    resolve: Option<resolve::Resolve>,
    samples: Option<SamplePasses>,
    layers: Option<LayerPasses>,
    /// Of scenes whose trims are smoothed.
    coverage: Option<Coverage>,
}

/// Those that say how finely each patch is drawn.
struct TessellationPasses {
    divide: DividePass,
    split: split::Split,
    emit: emit::Emit,
}

impl Passes {
    pub(crate) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Self, GpuError> {
        let trim = TrimPasses::new(device, data)?;
        let test = trim.as_ref().map(TrimPasses::test);
        let volume = data.volume.as_ref().and_then(SolidData::kinds);
        let kinds = Kinds {
            rational: data.has_rational,
            plain: data.has_plain,
            linked: !data.links.is_empty(),
            trimmed: test,
            bays: !data.wide_strips.is_empty(),
            operands: data.has_operands,
            volume,
        };
        let tessellation = |()| {
            Ok(TessellationPasses {
                divide: DividePass::new(device, data)?,
                split: split::Split::new(device, !data.links.is_empty())?,
                emit: emit::Emit::new(device)?,
            })
        };
        let outward = data.meshes.draws.len() - data.meshes.outward;
        let meshes = mesh::Kinds { both: data.meshes.outward > 0, outward: outward > 0, volume };
        let mesh = || mesh::Mesh::new(device, (VISIBILITY_FORMAT, DEPTH_FORMAT), meshes);
        // a driver takes milliseconds for each pipeline, and as many threads as ask it
        let (solids, (faces, pictures)) = rayon::join(
            || SolidPasses::new(device, data, test),
            || {
                rayon::join(
                    || {
                        let tessellation = (!data.items.is_empty()).then_some(()).map(tessellation).transpose()?;
                        let mesh = data.has_meshes().then(mesh).transpose()?;
                        let hidden = HiddenPasses::new(device, data)?;
                        Ok((tessellation, hidden, patches::Visibility::new(device, kinds)?, mesh))
                    },
                    || {
                        let resolve = shading::targets(device, data, formats)?;
                        let samples = SamplePasses::new(device, data, formats)?;
                        let squares = data.has_surfaces().then(|| SeenSquares::new(device)).transpose()?;
                        let scan = scan::Scan::new(device, data.trim_way() == Some(TakenWay::Table))?;
                        Ok((resolve, samples, squares, reset::Reset::new(device, false)?, scan))
                    },
                )
            },
        );
        let ((tessellation, hidden, visibility, mesh), (resolve, samples, squares, reset, scan)) = (faces?, pictures?);
        Ok(Self {
            reset,
            scan,
            tessellation,
            hidden,
            solids: solids?,
            visibility,
            #[cfg(feature = "baselines")]
            untested: baselines::untested(device, data, kinds)?,
            mesh,
            squares,
            resolve,
            samples,
            layers: LayerPasses::new(device, data, formats)?,
            coverage: smooth_trims::new(device, data, formats)?,
            trim,
        })
    }
}

/// Everything that one frame touches.
#[derive(Clone, Copy)]
pub(crate) struct Frame<'a> {
    pub passes: &'a Passes,
    pub scene: &'a Scene,
    pub buffers: &'a Buffers,
    /// This slot's constants and transforms, written by the host.
    pub constants: &'a Buffer,
    pub views: &'a Texels,
    /// The same for each of a pixel's samples, where there are several.
    pub samples: &'a [ViewBuffers],
    /// What the trim table is made of, where that is not this view.
    pub table_view: Option<&'a ViewBuffers>,
    pub centres: Option<Centres<'a>>,
    pub near: Near,
    pub hiding: Hiding,
    /// What is seen, or what samples are drawn from, is that of the frame before.
    pub keeps: bool,
    /// So is the trim table.
    pub keeps_table: bool,
    /// Columns and rows of the pixels that operands without equations may be in.
    pub shell_pixels: &'a [Range<u32>; 2],
    /// That way `blister` peels.
    pub layers: u32,
    /// Of each ray of way `events`; a frame may not ask for more.
    pub legs: u32,
    pub legs_are_most: bool,
    /// Of the surfaces of the volume that trims the scene, seen from this frame's eye.
    pub volume_places: Option<&'a Texels>,
    /// Where the sun is, in a scene that has one.
    pub sun: Option<&'a Buffer>,
    /// Middles of the placed parts that cast shadows; where there are some.
    pub sun_parts: Option<&'a Texels>,
    pub counters: &'a ReadBack,
    pub colour: &'a [Attachment<'a>],
    /// As the colour target holds it, unless that is kept.
    pub background: [f32; 4],
    pub depth: Option<Attachment<'a>>,
    /// Length of the pixel's ray within solids; cleared to 0 when it is drawn into.
    pub thickness: Option<Attachment<'a>>,
}

const WRITE_TO_READ: (Access, Access) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
const WRITE_TO_WRITE: (Access, Access) = (Access::COMPUTE_WRITE, Access::COMPUTE_WRITE);

/// A copy's source, among buffer accesses, which have no layout of their own.
const COPIED: Access = Access { layout: Access::COMPUTE_READ.layout, ..Access::TRANSFER_READ };

impl Frame<'_> {
    /// Records the whole frame.
    pub(crate) fn record(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        self.wait(cmd);
        match &self.passes.samples {
            Some(passes) => {
                self.unless_seen(cmd, || self.make(cmd, times));
                self.record_samples(cmd, times, passes);
            }
            None => {
                self.unless_seen(cmd, || {
                    self.make(cmd, times);
                    self.see(cmd, &mut Scopes::of(times));
                });
                self.show(cmd, &mut Scopes::of(times), (self.passes.resolve.as_ref(), Drawing::Whole), 0);
            }
        }
        self.no_thickness(cmd);
    }

    /// What is drawn from: the trim table, and patches divided.
    fn make(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        self.begin(cmd);
        let trim = self.trim();
        if let Some(table) = trim.as_ref().and_then(TrimParts::table) {
            self.unless_made(cmd, table.buffers, || times.scope(cmd, "trim table", || table.record(self, cmd)));
        }
        if let Some(passes) = &self.passes.tessellation {
            times.scope(cmd, "tessellation", || self.tessellation(cmd, passes));
        }
        #[cfg(feature = "baselines")]
        if let Some(texture) = trim.as_ref().and_then(TrimParts::rival).and_then(|parts| parts.texture()) {
            times.scope(cmd, "trim texture", || texture.record(self, cmd));
        }
    }

    /// What each pixel sees, from the patches and the trim table.
    fn see(&self, cmd: &Commands<'_>, times: &mut Scopes<'_>) {
        let trim = self.trim();
        self.clear(cmd);
        self.begin_images(cmd);
        if let (Some(pass), Some(meshes)) = (&self.passes.mesh, &self.scene.meshes) {
            times.drawing(cmd, "mesh", || self.mesh(cmd, pass, meshes));
        }
        if let Some(parts) = self.solids() {
            times.scope(cmd, "solids", || self.solid_faces(cmd, &parts));
        }
        let test = trim.as_ref().map_or(Vec::new(), TrimParts::test);
        #[cfg(feature = "baselines")]
        self.untested(cmd, times);
        times.drawing(cmd, "visibility", || self.visibility(cmd, &test, false));
        if let (Some(parts), Some(tessellation)) = (self.reveals(), &self.passes.tessellation) {
            times.drawing(cmd, "reveal", || parts.reveal(self, cmd, tessellation, &test));
        }
        let mut drawn = Access::COLOUR_WRITE;
        if let Some(parts) = &trim {
            times.scope(cmd, "heal", || self.heal(cmd, parts, &test));
            drawn = Access::COMPUTE_WRITE;
        }
        let read = Access::COMPUTE_READ | Access::FRAGMENT_READ;
        barrier::images(cmd, &[(&self.buffers.visibility, drawn, read)]);
    }

    /// What is seen, resolved into `self.colour` and `self.depth`; the `nth` time in this frame.
    fn show(
        &self,
        cmd: &Commands<'_>,
        times: &mut Scopes<'_>,
        (resolve, drawing): (Option<&resolve::Resolve>, Drawing),
        nth: u64,
    ) {
        let b = self.buffers;
        for image in b.behind.iter().chain(&b.resolved) {
            barrier::images(cmd, &[(image, Access::FRAGMENT_READ.discarded(), Access::COLOUR_WRITE)]);
        }
        if let Some(pass) = resolve {
            times.scope(cmd, "resolve", || {
                self.seen_squares(cmd);
                self.resolve(cmd, pass);
            });
        }
        if let Some(pass) = &self.passes.coverage {
            let test = self.trim().as_ref().map_or(Vec::new(), TrimParts::test);
            times.scope(cmd, "coverage", || self.coverage(cmd, pass, &test));
        }
        if let Some(passes) = &self.passes.layers {
            times.scope(cmd, "layers", || self.layers(cmd, passes, drawing));
        }
        barrier::buffers(cmd, &[(&b.counters, Access::COMPUTE_WRITE | Access::INDIRECT_READ, COPIED)]);
        self.counters.record_nth(cmd, &b.counters, size_of::<Counters>() as u64, nth);
    }

    /// Clears what the passes count that make what is drawn from.
    fn begin(&self, cmd: &Commands<'_>) {
        let b = self.buffers;
        let table = b.trim.iter().flat_map(|t| &t.table).filter(|_| !self.keeps_table);
        for counted in table.flat_map(TableBuffers::cleared) {
            cmd.fill(counted, 0);
        }
        #[cfg(feature = "baselines")]
        for counted in b.trim.iter().flat_map(|t| &t.texture).flat_map(crate::frame::buffers::TextureBuffers::cleared) {
            cmd.fill(counted, 0);
        }
        if let Some(parts) = self.hidden() {
            parts.begin(cmd, self.hiding);
        }
        let r = reset::Bindings { frame: self.constants, draws: &b.draws, counters: &b.counters };
        self.passes.reset.record(cmd, &r, 2 * b.capacities.draws);
        let (w, w2) = WRITE_TO_WRITE;
        barrier::buffers(cmd, &[(&b.draws, w, w2), (&b.counters, w, w2)]);
    }

    /// The transient buffers may still be read by what was drawn before.
    fn wait(&self, cmd: &Commands<'_>) {
        let before = [Access::COMPUTE_WRITE, Access::VERTEX_READ, Access::FRAGMENT_READ, Access::INDIRECT_READ];
        let before = before.into_iter().fold(Access::COMPUTE_READ, |all, one| all | one);
        let transfer = Access { layout: before.layout, ..Access::TRANSFER_READ };
        let clear = Access { layout: before.layout, ..Access::TRANSFER_WRITE };
        barrier::memory(cmd, before | transfer, Access::COMPUTE_WRITE | clear);
    }

    /// Clears what each drawing counts.
    fn clear(&self, cmd: &Commands<'_>) {
        let b = self.buffers;
        if let Some(t) = &b.trim {
            cmd.fill(&t.heal_dispatch, 0);
            cmd.fill(&t.rings, 0);
        }
        if let Some(f) = b.solids.as_ref().and_then(|s| s.fragments.as_ref()) {
            cmd.fill(&f.counts, 0);
        }
    }

    fn tessellation(&self, cmd: &Commands<'_>, p: &TessellationPasses) {
        let (w, r) = WRITE_TO_READ;
        p.divide.record(self, cmd);
        if let Some(parts) = self.hidden() {
            parts.hide(self, cmd);
        }
        barrier::buffers(cmd, &[(&self.buffers.taus, w, r)]);
        self.divide(cmd, p);
    }

    /// Patches into sub-patches, and what draws those that are to be drawn.
    fn divide(&self, cmd: &Commands<'_>, p: &TessellationPasses) {
        let (s, b) = (self.scene, self.buffers);
        let items = b.counts.items;
        let (w, r) = WRITE_TO_READ;
        let split = split::Bindings {
            frame: self.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            taus: &b.taus,
            factors: &b.factors,
            sub_patch_counts: &b.sub_patch_counts,
            vertex_counts: &b.vertex_counts,
            links: s.links.as_ref(),
        };
        p.split.record(cmd, &split, items);
        barrier::buffers(cmd, &[(&b.sub_patch_counts, w, r), (&b.vertex_counts, w, r)]);

        self.scan(cmd, &b.sub_patch_counts, &b.sub_patch_starts, 2 * items);
        self.scan(cmd, &b.vertex_counts, &b.vertex_starts, 2 * items);
        barrier::buffers(
            cmd,
            &[(&b.sub_patch_starts, w, r), (&b.vertex_starts, w, r), (&b.factors, w, r), (&b.counters, w, w)],
        );

        let emit = emit::Bindings {
            frame: self.constants,
            factors: &b.factors,
            sub_patch_starts: &b.sub_patch_starts,
            vertex_starts: &b.vertex_starts,
            sub_patches: &b.sub_patches,
            draws: &b.draws,
            counters: &b.counters,
        };
        p.emit.record(cmd, &emit, items);
        barrier::buffers(
            cmd,
            &[
                (&b.factors, w, Access::VERTEX_READ),
                (&b.sub_patches, w, Access::VERTEX_READ),
                (&b.draws, w, Access::INDIRECT_READ),
                (&b.counters, w, w),
            ],
        );
    }

    /// One prefix sum; the total follows the last start.
    fn scan(&self, cmd: &Commands<'_>, counts: &Buffer, starts: &Buffer, count: u32) {
        let sums = &self.buffers.sums;
        barrier::buffers(cmd, &[(sums, WRITE_TO_WRITE.0, WRITE_TO_WRITE.1)]);
        let bindings = scan::Bindings { values: counts, offsets: starts, sums, total: starts, total_index: count };
        self.passes.scan.record(cmd, scan::Count::Host(count), &bindings);
    }

    /// The images were read by the frame before; their contents go.
    fn begin_images(&self, cmd: &Commands<'_>) {
        let b = self.buffers;
        let read = (Access::COMPUTE_READ | Access::FRAGMENT_READ).discarded();
        let others = b.others.iter().map(|image| (image, read, Access::COLOUR_WRITE));
        let fixed = [
            (&b.visibility, read, Access::COLOUR_WRITE),
            (&b.depth, Access::DEPTH_WRITE.discarded() | Access::COMPUTE_READ.discarded(), Access::DEPTH_WRITE),
        ];
        let operand_uv = b.solids.iter().flat_map(|s| &s.operand_uv);
        let operand_uv = operand_uv.map(|image| (image, read, Access::COLOUR_WRITE));
        barrier::images(cmd, &fixed.into_iter().chain(others).chain(operand_uv).collect::<Vec<_>>());
    }

    /// What tests against the volume that trims the scene read, `None` without one.
    fn volume(&self) -> Option<Primitives<'_>> {
        let volume = self.scene.volume.as_ref().zip(self.volume_places);
        volume.map(|(v, places)| v.primitives(places))
    }
}

/// The host's image as an attachment: every pixel is written when there is a background, else what nothing is drawn into
/// stays.
pub(crate) fn target<'a>(image: &'a Image, keep: bool) -> Attachment<'a> {
    Attachment { image, load: if keep { Load::Keep } else { Load::Discard } }
}
