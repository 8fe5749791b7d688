//! Smooth borders of all that is seen.
//!
//! ```text
//!   resolve ──▶ linear colour and depth ──border_mix──▶ linear colour ──linear_show──▶ the host's colour
//!           ──▶ the host's depth; depth, face, (u, v) and normal: those of the pixels' centres, as without the pass
//!
//!   band after band of rows:   find and mix 0 │ find and mix 1, write 0 │ find and mix 2, write 1 │ … │ write the last
//!
//!   mix:   border_mix ──▶ points that the terms do not reach ──border_follow──▶ border_followed, or the next:
//!          border_mesh, border_solid ──▶ border_mean                         (scenes with meshes or Boolean solids)
//! ```
//!
//! A list has room for every pixel of its band. A band reads the rows beside it as no pass has mixed them yet, so means
//! are written a band later: there are two lists then. The list of points that follow surfaces grows with what frames
//! want; where it is too short, the frame is drawn again.

use super::border_follow::{self, BorderFollow};
use super::border_mean::{self, BorderMean};
use super::border_mesh::{self, BorderMesh};
use super::border_mix::{self, BorderMix, POINTS};
use super::border_solid::{self, BorderSolid};
use crate::abi::{BorderGrids, BorderPixel, BorderPoint, FollowedGrids, FollowedPixel, FollowedPoint};
use crate::frame::Frame;
use crate::frame::common::border_list::{FollowedBindings, ListBindings};
use crate::frame::common::room::Room;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Image, Resource, barrier};
use crate::scene::{SceneData, SolidData};
use crate::shaders::TrimTest;
use std::ops::Range;
use std::sync::Arc;

/// Pixels of a band, whose list takes 64 MB; with points a pixel takes eight times as much.
const BAND_PIXELS: u64 = 1 << 22;
const BAND_PIXELS_WITH_POINTS: u64 = 1 << 18;
/// Rows of the least band: a pixel looks for slivers in as many less one.
const LEAST_ROWS: u32 = 16;

/// The passes.
pub(crate) struct Passes {
    mix: BorderMix,
    /// Where some face's surface may be followed.
    follow: Option<BorderFollow>,
    mesh: Option<BorderMesh>,
    solid: Option<BorderSolid>,
    /// In scenes where points are tested for something else than patches.
    mean: Option<BorderMean>,
}

impl Passes {
    /// `None` where no borders are smoothed.
    pub(crate) fn new(device: &Device, data: &SceneData, test: Option<&TrimTest>) -> Result<Option<Self>, GpuError> {
        if !data.smooths_borders() {
            return Ok(None);
        }
        let (meshes, surfaces) = (data.has_meshes(), data.solids.kinds());
        let boundary_operands = !data.solids.operand_leaves.is_empty();
        let volume = data.volume.as_ref().and_then(SolidData::kinds);
        let kinds = border_mix::Kinds {
            test,
            patches: data.has_patches,
            rational: data.has_rational,
            fine: data.has_fine,
            meshes_and_solids: meshes || surfaces.is_some(),
            followed: data.follows_borders(),
            boundary_operands,
            layered: data.is_layered,
            volume,
        };
        let Some(mix) = BorderMix::new(device, &kinds)? else { return Ok(None) };
        let follow = if kinds.followed {
            let (rational, fine) = (kinds.rational, kinds.fine);
            let meshes_and_solids = kinds.meshes_and_solids;
            BorderFollow::new(device, border_follow::Kinds { test, rational, fine, meshes_and_solids, volume })?
        } else {
            None
        };
        let mesh = || BorderMesh::new(device, !data.has_patches, volume);
        let solid = |surfaces| {
            let kinds = border_solid::Kinds {
                surfaces,
                followed: data.solids.is_followed(),
                first: !data.has_patches && !meshes,
            };
            BorderSolid::new(device, kinds)
        };
        Ok(Some(Self {
            mix,
            follow,
            mesh: meshes.then(mesh).transpose()?,
            solid: surfaces.filter(|_| data.has_smooth_solids()).map(solid).transpose()?,
            mean: kinds.meshes_and_solids.then(|| BorderMean::new(device, boundary_operands)).transpose()?,
        }))
    }
}

/// The stage.
pub(crate) struct SmoothBorders {
    passes: Arc<Passes>,
    /// One, or two by turns.
    lists: Vec<List>,
    points: Option<Buffer>,
    followed: Option<Followed>,
    /// Of a band.
    rows: u32,
}

/// Pixels at borders of a band.
struct List {
    pixels: Buffer,
    grids: Buffer,
}

impl List {
    fn bindings(&self) -> ListBindings<'_> {
        ListBindings { pixels: &self.pixels, grids: &self.grids }
    }
}

/// Points of a band that follow surfaces.
struct Followed {
    points: Buffer,
    capacity: u32,
    /// In scenes without meshes and Boolean solids.
    pixels: Option<Buffer>,
    grids: Buffer,
}

impl Followed {
    fn new(room: &Room<'_>, has_pixels: bool) -> Result<Self, GpuError> {
        let capacity = room.capacities.antialiasing.followed;
        let pixels = || room.structs::<FollowedPixel>("border followed pixels", capacity);
        Ok(Self {
            points: room.structs::<FollowedPoint>("border followed points", capacity)?,
            capacity,
            pixels: has_pixels.then(pixels).transpose()?,
            grids: room.indirect::<FollowedGrids>("border followed grids", 1)?,
        })
    }

    fn bindings(&self) -> FollowedBindings<'_> {
        let Self { points, capacity, pixels, grids } = self;
        FollowedBindings { points, capacity: *capacity, pixels: pixels.as_ref(), grids }
    }
}

impl SmoothBorders {
    pub(crate) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let (width, height) = room.size;
        let points = size_of::<BorderPoint>() as u64 * u64::from(POINTS);
        let (most, bytes) = if passes.mean.is_some() {
            (BAND_PIXELS_WITH_POINTS, points)
        } else {
            (BAND_PIXELS, size_of::<BorderPixel>() as u64)
        };
        // what a device binds may be less: a list that does not fit even so is an error of its own
        let most = most.min(u64::from(room.device.limits().max_storage_buffer_range) / bytes);
        let rows = (most / u64::from(width)) as u32 / LEAST_ROWS * LEAST_ROWS;
        let rows = rows.max(LEAST_ROWS).min(height);
        let list = |_| {
            Ok(List {
                pixels: room.structs::<BorderPixel>("border pixels", width * rows)?,
                grids: room.indirect::<BorderGrids>("border grids", 1)?,
            })
        };
        let points = || room.structs::<BorderPoint>("border points", width * rows * POINTS);
        Ok(Self {
            passes: Arc::clone(passes),
            lists: (0..if rows < height { 2 } else { 1 }).map(list).collect::<Result<_, GpuError>>()?,
            points: passes.mean.is_some().then(points).transpose()?,
            followed: passes.follow.as_ref().map(|_| Followed::new(room, passes.mean.is_none())).transpose()?,
            rows,
        })
    }

    /// Mixes pixels at borders, in place. `written`: the last write to `resolved` before;
    /// [`Access::COMPUTE_WRITE`] is the last one after.
    pub(crate) fn record(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        resolved: &Image,
        written: Access,
        test: &[Resource<'_>],
    ) {
        let (w, r) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
        // lists of solids, which others have read so far
        cmd.after(w, r);
        barrier::images(cmd, &[(resolved, written, r)]);
        let mut lists = self.lists.iter().cycle();
        let mut before: Option<&List> = None;
        let mut counted_again = false;
        for band in frame.bands() {
            if let Some(solids) = frame.solids().filter(|_| !band.is_whole && self.passes.solid.is_some()) {
                if !std::mem::replace(&mut counted_again, true) {
                    frame.count_bands_again(cmd);
                }
                solids.lists(frame, cmd, &band);
                cmd.after(w, r);
            }
            for top in band.rows.clone().step_by(self.rows as usize) {
                let Some(list) = lists.next() else { return };
                self.mix(frame, cmd, (resolved, list, test), top..(top + self.rows).min(band.rows.end));
                if let Some(before) = before.replace(list).filter(|_| self.lists.len() > 1) {
                    self.write(frame, cmd, resolved, before);
                    barrier::images(cmd, &[(resolved, w, r)]);
                }
            }
        }
        if let Some(last) = before {
            self.write(frame, cmd, resolved, last);
        }
    }

    /// The list of some rows, and its means.
    fn mix(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (resolved, list, test): (&Image, &List, &[Resource<'_>]),
        rows: Range<u32>,
    ) {
        let (w, r) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
        let List { pixels, grids } = list;
        barrier::buffers(cmd, &[(grids, r | Access::INDIRECT_READ, Access::TRANSFER_WRITE)]);
        cmd.fill(grids, 0);
        barrier::buffers(cmd, &[(grids, Access::TRANSFER_WRITE, r | w), (pixels, r, w)]);
        let (s, v) = (frame.scene, &frame.stages.visibility);
        let bindings = border_mix::Bindings {
            frame: frame.constants,
            placed: s.placed(frame.views),
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            resolved,
            list: list.bindings(),
            points: self.points.as_ref(),
            followed: self.followed.as_ref().map(Followed::bindings),
            counters: &frame.stages.common.counters,
            trim: test,
            volume: frame.volume(),
        };
        self.passes.mix.find(cmd, &bindings, rows);
        barrier::buffers(cmd, &[(grids, w, r | Access::INDIRECT_READ), (pixels, w, r | w)]);
        if let Some(points) = &self.points {
            barrier::buffers(cmd, &[(points, r, w)]);
        }
        if let Some(Followed { points, pixels, grids, .. }) = &self.followed {
            barrier::buffers(cmd, &[(grids, r | Access::INDIRECT_READ, Access::TRANSFER_WRITE)]);
            cmd.fill(grids, 0);
            let counted = (bindings.counters, w | Access::INDIRECT_READ, w);
            barrier::buffers(cmd, &[(grids, Access::TRANSFER_WRITE, w), (points, r | w, w), counted]);
            if let Some(pixels) = pixels {
                barrier::buffers(cmd, &[(pixels, r, w)]);
            }
        }
        self.passes.mix.mix(cmd, &bindings);
        if let (Some(pass), Some(followed)) = (&self.passes.follow, &self.followed) {
            self.follow(cmd, (pass, followed), &bindings);
        }
        if let Some(points) = &self.points {
            self.ask_meshes_and_solids(frame, cmd, (resolved, list, points));
        }
        barrier::buffers(cmd, &[(pixels, w, r)]);
    }

    /// What points see of surfaces that are followed to them, and the means of their pixels.
    fn follow(
        &self,
        cmd: &Commands<'_>,
        (pass, followed): (&BorderFollow, &Followed),
        of_mix: &border_mix::Bindings<'_>,
    ) {
        let (w, r) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
        let Followed { points, pixels, grids, .. } = followed;
        // lists of the next band's solids are counted, too
        let counted = (of_mix.counters, w, w);
        // where no other pass asks, the list stands in for what points see
        let list = (of_mix.list.pixels, w, r | w);
        barrier::buffers(cmd, &[(points, w, r | w), (grids, w, r | Access::INDIRECT_READ), list, counted]);
        if let Some(seen) = &self.points {
            barrier::buffers(cmd, &[(seen, w, w)]);
        }
        let bindings = border_follow::Bindings {
            frame: of_mix.frame,
            placed: of_mix.placed,
            visibility: of_mix.visibility,
            resolved: of_mix.resolved,
            list: of_mix.list,
            followed: followed.bindings(),
            seen: of_mix.points,
            trim: of_mix.trim,
            volume: of_mix.volume,
        };
        pass.follow(cmd, &bindings);
        if let Some(pixels) = pixels {
            barrier::buffers(cmd, &[(points, w, r), (pixels, w, r), (of_mix.list.pixels, r | w, r | w)]);
            pass.mix(cmd, &bindings);
        }
    }

    /// What points see of meshes and Boolean solids, and their means.
    fn ask_meshes_and_solids(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (resolved, list, points): (&Image, &List, &Buffer),
    ) {
        let (w, r) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
        let (v, constants) = (&frame.stages.visibility, frame.constants);
        let (list, pixels) = (list.bindings(), &list.pixels);
        let (visibility, meshes_and_solids) = (&v.image, v.of_meshes_and_solids());
        if let (Some(pass), Some(m)) = (&self.passes.mesh, &frame.scene.meshes)
            && let Some(neighbours) = &m.neighbours
        {
            barrier::buffers(cmd, &[(points, w, r | w), (pixels, w, r)]);
            let bindings = border_mesh::Bindings {
                frame: constants,
                views: frame.views,
                mesh_instances: &m.instances,
                triangles: &m.triangles,
                positions: &m.positions,
                neighbours,
                visibility,
                meshes_and_solids,
                resolved,
                list,
                points,
                volume: frame.volume(),
            };
            pass.record(cmd, &bindings);
        }
        if let (Some(pass), Some(parts)) = (&self.passes.solid, frame.solids())
            && let Some(tiles) = parts.stage.tiles()
        {
            barrier::buffers(cmd, &[(points, w, r | w), (pixels, w, r)]);
            let bindings = border_solid::Bindings {
                frame: constants,
                primitives: parts.scene.primitives(parts.centres.surfaces),
                tile_starts: &tiles.tile_starts,
                tile_leaves: &tiles.tile_leaves,
                tile_entries: &tiles.tile_entries,
                visibility,
                meshes_and_solids,
                resolved,
                list,
                points,
            };
            pass.record(cmd, &bindings);
        }
        barrier::buffers(cmd, &[(points, w, r), (pixels, r | w, r | w)]);
        if let Some(mean) = &self.passes.mean {
            let bindings =
                border_mean::Bindings { frame: constants, visibility, meshes_and_solids, resolved, list, points };
            mean.record(cmd, &bindings);
        }
    }

    /// Puts the means of a list in place.
    fn write(&self, frame: &Frame<'_>, cmd: &Commands<'_>, resolved: &Image, list: &List) {
        barrier::images(cmd, &[(resolved, Access::COMPUTE_READ, Access::COMPUTE_WRITE)]);
        self.passes.mix.write(cmd, frame.constants, list.bindings(), resolved);
    }
}
