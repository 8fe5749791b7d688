//! The frame as prose: the passes in order, and every barrier between them.
//!
//! ```text
//!                 view, instances
//!                      │
//!    ┌─────────────────┴──────────────────┐
//!    ▼                                    ▼  trimmed scenes only
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
//!                      ▼
//!                    heal        pixels that look through a gap between trimmed faces
//!                      ▼
//!                  resolve       exact point and normal per pixel, light ──▶ the host's targets
//! ```

use crate::abi::Counters;
use crate::buffers::{Buffers, TrimBuffers};
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, ReadBack, Timestamps, barrier};
use crate::passes::visibility::{DEPTH_FORMAT, Kinds, VISIBILITY_FORMAT};
use crate::passes::{
    bound, cross, density, emit, heal, lines, mesh, reset, resolve, scan, segments, sizes, sort, split, visibility,
};
use crate::scene::{MeshBuffers, Scene, SceneData, Trims};
use solids::SolidPasses;
use std::mem::offset_of;

mod solids;

pub(crate) use solids::Centres;

/// The passes that a scene needs.
pub(crate) struct Passes {
    reset: reset::Reset,
    bound: bound::Bound,
    split: split::Split,
    scan: scan::Scan,
    emit: emit::Emit,
    trim: Option<TrimPasses>,
    solids: Option<SolidPasses>,
    visibility: visibility::Visibility,
    mesh: Option<mesh::Mesh>,
    resolve: resolve::Resolve,
}

/// The passes of the trim table.
struct TrimPasses {
    density: density::Density,
    lines: lines::Lines,
    segments: segments::Segments,
    sizes: sizes::Sizes,
    cross: cross::Cross,
    sort: sort::Sort,
    heal: heal::Heal,
}

impl Passes {
    pub(crate) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Self, GpuError> {
        let kinds = Kinds { rational: data.has_rational, plain: data.has_plain, trimmed: data.has_trimmed };
        let trim = |_| {
            Ok(TrimPasses {
                density: density::Density::new(device)?,
                lines: lines::Lines::new(device)?,
                segments: segments::Segments::new(device)?,
                sizes: sizes::Sizes::new(device)?,
                cross: cross::Cross::new(device)?,
                sort: sort::Sort::new(device)?,
                heal: heal::Heal::new(device, data.has_rational, data.has_meshes() || data.solids.kinds().is_some())?,
            })
        };
        Ok(Self {
            reset: reset::Reset::new(device)?,
            bound: bound::Bound::new(device)?,
            split: split::Split::new(device)?,
            scan: scan::Scan::new(device)?,
            emit: emit::Emit::new(device)?,
            trim: data.has_trimmed.then_some(()).map(trim).transpose()?,
            solids: SolidPasses::new(device, &data.solids)?,
            visibility: visibility::Visibility::new(device, kinds)?,
            mesh: data.has_meshes().then(|| mesh::Mesh::new(device, VISIBILITY_FORMAT, DEPTH_FORMAT)).transpose()?,
            resolve: resolve::Resolve::new(
                device,
                formats,
                resolve::Kinds { rational: data.has_rational, meshes: data.has_meshes(), solids: data.solids.kinds() },
            )?,
        })
    }
}

/// Everything that one frame touches.
pub(crate) struct Frame<'a> {
    pub passes: &'a Passes,
    pub scene: &'a Scene,
    pub buffers: &'a Buffers,
    /// This slot's constants and transforms, written by the host.
    pub constants: &'a Buffer,
    pub views: &'a Buffer,
    pub centres: Option<Centres<'a>>,
    pub counters: &'a ReadBack,
    pub colour: &'a [Attachment<'a>],
    pub depth: Option<Attachment<'a>>,
}

const WRITE_TO_READ: (Access, Access) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
const WRITE_TO_WRITE: (Access, Access) = (Access::COMPUTE_WRITE, Access::COMPUTE_WRITE);

/// A copy's source, among buffer accesses, which have no layout of their own.
const COPIED: Access = Access { layout: Access::COMPUTE_READ.layout, ..Access::TRANSFER_READ };

impl Frame<'_> {
    /// Records the whole frame.
    pub(crate) fn record(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        self.begin(cmd);
        times.scope(cmd, "tessellation", || self.tessellation(cmd));
        if let (Some(passes), Some(trims), Some(buffers)) = (&self.passes.trim, &self.scene.trims, &self.buffers.trim) {
            times.scope(cmd, "trim table", || self.trim_table(cmd, passes, trims, buffers));
        }
        self.begin_images(cmd);
        if let (Some(pass), Some(meshes)) = (&self.passes.mesh, &self.scene.meshes) {
            times.drawing(cmd, "mesh", || self.mesh(cmd, pass, meshes));
        }
        if let Some(parts) = self.solids() {
            times.scope(cmd, "solids", || self.solid_events(cmd, &parts));
        }
        times.drawing(cmd, "visibility", || self.visibility(cmd));
        let mut drawn = Access::COLOUR_WRITE;
        if let (Some(passes), Some(buffers)) = (&self.passes.trim, &self.buffers.trim) {
            times.scope(cmd, "heal", || self.heal(cmd, passes, buffers));
            drawn = Access::COMPUTE_WRITE;
        }
        barrier::images(cmd, &[(&self.buffers.visibility, drawn, Access::FRAGMENT_READ)]);
        times.scope(cmd, "resolve", || self.resolve(cmd));
        let b = self.buffers;
        barrier::buffers(cmd, &[(&b.counters, Access::COMPUTE_WRITE | Access::INDIRECT_READ, COPIED)]);
        self.counters.record(cmd, &b.counters, size_of::<Counters>() as u64);
    }

    /// The transient buffers may still be read by the frame before: wait, then clear what counts.
    fn begin(&self, cmd: &Commands<'_>) {
        let b = self.buffers;
        let before = [Access::COMPUTE_WRITE, Access::VERTEX_READ, Access::FRAGMENT_READ, Access::INDIRECT_READ];
        let before = before.into_iter().fold(Access::COMPUTE_READ, |all, one| all | one);
        let transfer = Access { layout: before.layout, ..Access::TRANSFER_READ };
        let clear = Access { layout: before.layout, ..Access::TRANSFER_WRITE };
        barrier::memory(cmd, before | transfer, Access::COMPUTE_WRITE | clear);
        if let Some(t) = &b.trim {
            cmd.fill(&t.strip_heights, 0);
            cmd.fill(&t.face_speeds, 0);
            cmd.fill(&t.row_counts, 0);
            cmd.fill(&t.rings, 0);
        }
        let r = reset::Bindings { frame: self.constants, draws: &b.draws, counters: &b.counters };
        self.passes.reset.record(cmd, &r, 2 * b.capacities.draws);
        let (w, w2) = WRITE_TO_WRITE;
        barrier::buffers(cmd, &[(&b.draws, w, w2), (&b.counters, w, w2)]);
    }

    fn tessellation(&self, cmd: &Commands<'_>) {
        let (p, s, b) = (self.passes, self.scene, self.buffers);
        let items = b.counts.items;
        let (w, r) = WRITE_TO_READ;
        let bound = bound::Bindings {
            frame: self.constants,
            views: self.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            taus: &b.taus,
            counters: &b.counters,
        };
        p.bound.record(cmd, &bound, items);
        barrier::buffers(cmd, &[(&b.taus, w, r)]);

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

    fn trim_table(&self, cmd: &Commands<'_>, p: &TrimPasses, trims: &Trims, t: &TrimBuffers) {
        let (s, b) = (self.scene, self.buffers);
        let (w, r) = WRITE_TO_READ;
        let cleared = (Access::TRANSFER_WRITE, Access::COMPUTE_WRITE);
        barrier::buffers(
            cmd,
            &[
                (&t.strip_heights, cleared.0, cleared.1),
                (&t.face_speeds, cleared.0, cleared.1),
                (&t.row_counts, cleared.0, cleared.1),
            ],
        );
        let density = density::Bindings {
            frame: self.constants,
            views: self.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            cells: &trims.cells,
            cell_items: &trims.cell_items,
            strip_heights: &t.strip_heights,
            face_speeds: &t.face_speeds,
        };
        p.density.record(cmd, &density, b.counts.cells);
        barrier::buffers(cmd, &[(&t.strip_heights, w, r), (&t.face_speeds, w, r)]);

        let lines = lines::Bindings {
            frame: self.constants,
            strip_heights: &t.strip_heights,
            line_counts: &t.line_counts,
            counters: &b.counters,
        };
        p.lines.record(cmd, &lines, b.counts.strips);
        barrier::buffers(cmd, &[(&t.line_counts, w, r), (&b.counters, w, w)]);
        self.scan(cmd, &t.line_counts, &t.line_starts, b.counts.strips);
        barrier::buffers(cmd, &[(&t.line_starts, w, r)]);

        let segments = segments::Bindings {
            frame: self.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_items: &trims.curve_items,
            face_speeds: &t.face_speeds,
            line_starts: &t.line_starts,
            segment_counts: &t.segment_counts,
        };
        p.segments.record(cmd, &segments, b.counts.curves);
        barrier::buffers(cmd, &[(&t.segment_counts, w, r)]);
        self.scan(cmd, &t.segment_counts, &t.segment_starts, b.counts.curves);
        barrier::buffers(cmd, &[(&t.segment_starts, w, r)]);

        let sizes = sizes::Bindings {
            frame: self.constants,
            line_starts: &t.line_starts,
            segment_starts: &t.segment_starts,
            dispatches: &t.dispatches,
            counters: &b.counters,
        };
        p.sizes.record(cmd, &sizes);
        barrier::buffers(cmd, &[(&t.dispatches, w, Access::INDIRECT_READ), (&b.counters, w, w)]);

        let cross = cross::Bindings {
            frame: self.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_points: &trims.curve_points,
            curve_items: &trims.curve_items,
            line_starts: &t.line_starts,
            segment_starts: &t.segment_starts,
            row_counts: &t.row_counts,
            row_starts: &t.row_starts,
            intercepts: &t.intercepts,
            dispatches: &t.dispatches,
        };
        p.cross.count(cmd, &cross);
        barrier::buffers(cmd, &[(&t.row_counts, w, r), (&t.row_starts, r, w), (&b.sums, w, w)]);
        let word = |offset: usize| (offset / size_of::<u32>()) as u32;
        self.passes.scan.record(
            cmd,
            scan::Count::Gpu {
                counts: &b.counters,
                index: word(offset_of!(Counters, rows)),
                arguments: &t.dispatches,
                offset: 2 * size_of::<[u32; 3]>() as u64,
                capacity: b.capacities.rows,
            },
            &scan::Bindings {
                values: &t.row_counts,
                offsets: &t.row_starts,
                sums: &b.sums,
                total: &t.row_total,
                total_index: 0,
            },
        );
        barrier::buffers(
            cmd,
            &[(&t.row_starts, w, r), (&t.row_total, w, r), (&t.row_counts, r, w), (&b.counters, r, w)],
        );
        p.cross.insert(cmd, &cross);
        barrier::buffers(cmd, &[(&t.intercepts, w, w), (&t.row_counts, w, w)]);

        let sort = sort::Bindings {
            frame: self.constants,
            row_starts: &t.row_starts,
            row_total: &t.row_total,
            row_counts: &t.row_counts,
            intercepts: &t.intercepts,
            counters: &b.counters,
            dispatches: &t.dispatches,
        };
        p.sort.record(cmd, &sort);
        barrier::buffers(
            cmd,
            &[
                (&t.line_starts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.row_starts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.row_counts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.intercepts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
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
            (&b.visibility, Access::FRAGMENT_READ.discarded(), Access::COLOUR_WRITE),
            (&b.depth, Access::DEPTH_WRITE.discarded() | Access::COMPUTE_READ.discarded(), Access::DEPTH_WRITE),
        ];
        barrier::images(cmd, &fixed.into_iter().chain(others).collect::<Vec<_>>());
    }

    /// Meshes first: what hides them may be in doubt.
    fn mesh(&self, cmd: &Commands<'_>, pass: &mesh::Mesh, m: &MeshBuffers) {
        let b = self.buffers;
        let bindings = mesh::Bindings {
            frame: self.constants,
            views: self.views,
            mesh_instances: &m.instances,
            triangles: &m.triangles,
            positions: &m.positions,
        };
        let seen = b.others.as_ref().unwrap_or(&b.visibility);
        pass.record(cmd, &bindings, (seen, &b.depth), m.draws.iter());
        barrier::images(
            cmd,
            &[(seen, Access::COLOUR_WRITE, Access::COLOUR_WRITE), (&b.depth, Access::DEPTH_WRITE, Access::DEPTH_WRITE)],
        );
    }

    fn visibility(&self, cmd: &Commands<'_>) {
        let (s, b) = (self.scene, self.buffers);
        barrier::buffers(cmd, &[(&b.counters, Access::COMPUTE_WRITE, Access::INDIRECT_READ)]);
        if let Some(t) = &b.trim {
            barrier::buffers(cmd, &[(&t.rings, Access::TRANSFER_WRITE, Access::FRAGMENT_WRITE)]);
        }
        let bindings = visibility::Bindings {
            frame: self.constants,
            views: self.views,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            points: &s.points,
            factors: &b.factors,
            sub_patches: &b.sub_patches,
            instances: &s.instances,
            table: b.trim.as_ref().map(|t| visibility::Table {
                line_starts: &t.line_starts,
                row_starts: &t.row_starts,
                row_counts: &t.row_counts,
                flips: &t.intercepts,
                rings: &t.rings,
            }),
            draws: &b.draws,
            counters: &b.counters,
        };
        let drawn = s.meshes.is_some() || s.solids.is_some();
        let colour = if drawn && b.others.is_none() { Load::Keep } else { Load::ColourU32([0; 4]) };
        let visibility = Attachment { image: &b.visibility, load: colour };
        let depth = Attachment { image: &b.depth, load: if drawn { Load::Keep } else { Load::Depth(0.0) } };
        self.passes.visibility.record(cmd, &bindings, (visibility, depth), b.capacities.draws);
    }

    /// Pixels that look through a gap between faces get the face that belongs there.
    fn heal(&self, cmd: &Commands<'_>, p: &TrimPasses, t: &TrimBuffers) {
        let (s, b) = (self.scene, self.buffers);
        let (w, r) = WRITE_TO_READ;
        barrier::images(cmd, &[(&b.visibility, Access::COLOUR_WRITE, w), (&b.depth, Access::DEPTH_WRITE, r)]);
        if let Some(others) = &b.others {
            barrier::images(cmd, &[(others, Access::COLOUR_WRITE, Access::COMPUTE_READ | Access::FRAGMENT_READ)]);
        }
        barrier::buffers(
            cmd,
            &[
                (&t.rings, Access::FRAGMENT_WRITE, r),
                (&b.counters, Access::INDIRECT_READ, w),
                (&t.dispatches, Access::INDIRECT_READ, w),
            ],
        );
        let doubts = heal::DoubtBindings {
            frame: self.constants,
            visibility: &b.visibility,
            doubts: &t.doubts,
            dispatches: &t.dispatches,
            counters: &b.counters,
            depth: &b.depth,
            rings: &t.rings,
        };
        p.heal.find(cmd, &doubts);
        barrier::images(cmd, &[(&b.visibility, w, w)]);
        barrier::buffers(cmd, &[(&t.doubts, w, r), (&b.counters, w, r), (&t.dispatches, w, Access::INDIRECT_READ)]);
        let heal = heal::Bindings {
            frame: self.constants,
            views: self.views,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            points: &s.points,
            line_starts: &t.line_starts,
            row_starts: &t.row_starts,
            row_counts: &t.row_counts,
            flips: &t.intercepts,
            visibility: &b.visibility,
            doubts: &t.doubts,
            counters: &b.counters,
            instances: &s.instances,
            others: s.meshes.as_ref().zip(b.others.as_ref()).map(|(m, seen)| heal::Others {
                seen,
                mesh_instances: &m.instances,
                triangles: &m.triangles,
                positions: &m.positions,
            }),
            dispatches: &t.dispatches,
        };
        p.heal.record(cmd, &heal);
    }

    fn resolve(&self, cmd: &Commands<'_>) {
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

/// The host's image as an attachment of the resolve pass: every pixel is written when there is a
/// background, else what the pass leaves alone stays.
pub(crate) fn target<'a>(image: &'a Image, keep: bool) -> Attachment<'a> {
    Attachment { image, load: if keep { Load::Keep } else { Load::Discard } }
}
