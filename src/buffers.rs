//! The transient buffers and images of a frame, sized by scene, picture and view.
//!
//! ```text
//!   by the scene     taus, factors, counts and starts per item; per strip, face and curve if trimmed
//!   by the picture   visibility, that of what is no patch where faces are trimmed, depth; per tile and block
//!                    of tiles if there are Boolean solids; the sum of a pixel's samples where it has several;
//!                    what is behind layers where rays are followed through solids
//!   by the view      sub-patches, draws, rows, intercepts, doubts, leaves in tiles: a pass that runs out says so in
//!                    Counters.failed, and the next frame gets what it would have needed
//! ```

use crate::abi::{BLOCK, Counters, Factors, Fragment, Rect, SubPatch, TILE, TileLeaf};
use crate::gpu::{Buffer, Device, GpuError, Image, ImageInfo, Pool};
use crate::passes::average::SUM_FORMAT;
use crate::passes::resolve::BEHIND_FORMAT;
use crate::passes::scan;
use crate::passes::visibility::{DEPTH_FORMAT, VISIBILITY_FORMAT};
#[cfg(feature = "rivals")]
use crate::picture::Rival;
use crate::picture::{Samples, TrimWay};
use crate::scene::SceneData;
use ash::vk;

/// What the scene has, per placed face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub items: u32,
    pub cells: u32,
    pub strips: u32,
    pub curves: u32,
    pub face_instances: u32,
    /// Leaves of Boolean solids.
    pub leaves: u32,
    /// Operands of theirs without equations.
    pub shells: u32,
    pub triangles: u32,
    /// Of leaves.
    pub sides: u32,
    pub mesh_instances: u32,
    /// How faces are trimmed, where some are.
    pub trim: Option<TrimWay>,
    /// Of each pixel.
    pub samples: Samples,
    /// The first leaf of items that rays are followed through; there are some.
    pub followed_leaf: u32,
    pub is_followed: bool,
    /// Lengths within solids are wanted.
    pub thickness: bool,
    /// Instances drawn opaque because they are not closed.
    pub open: u32,
}

impl Counts {
    pub(crate) fn of(data: &SceneData) -> Self {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Self {
            items: data.items.len() as u32,
            cells: data.cell_items.len() as u32,
            strips: data.strip_count,
            curves: data.curve_items.len() as u32,
            face_instances: data.face_instances.len() as u32,
            leaves: data.solids.leaves.len() as u32,
            shells: data.solids.shell_leaves.len() as u32,
            triangles: count(data.meshes.triangles.len().max(data.meshes.positions.len() / 3)),
            sides: count(data.solids.leaf_surfaces.len()),
            mesh_instances: count(data.meshes.instances.len()),
            trim: data.trim_way(),
            samples: data.samples,
            followed_leaf: data.solids.followed,
            is_followed: data.solids.is_followed(),
            thickness: data.thickness,
            open: count(data.open),
        }
    }

    /// Whether one dispatch covers a picture of this size, where its pixels are counted.
    pub(crate) fn check_size(self, size: (u32, u32)) -> Result<(), TooMany> {
        let count = size.0.saturating_mul(size.1);
        if self.shells > 0 && count > scan::MAX_COUNT {
            return Err(TooMany { what: "pixels with operands of meshes or splines", count, most: scan::MAX_COUNT });
        }
        Ok(())
    }

    /// Whether one dispatch covers each of them, and numbers tell them apart.
    pub(crate) fn check(self) -> Result<(), TooMany> {
        let all = [
            ("patches", self.items, MOST_THREADS),
            ("cells", self.cells, MOST_THREADS),
            ("v-strips", self.strips, MOST_THREADS),
            ("curves", self.curves, MOST_THREADS),
            ("triangles", self.triangles, MOST_TRIANGLES),
            ("primitives", self.leaves, MOST_THREADS),
            ("placed meshes", self.mesh_instances, MOST_SEEN),
            ("sides of primitives", self.sides, MOST_SEEN),
        ];
        match all.into_iter().find(|(_, count, most)| count > most) {
            Some((what, count, most)) => Err(TooMany { what, count, most }),
            None => Ok(()),
        }
    }
}

/// The model, or what a view needs of it, is more than the engine counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{count} {what} are too many: at most {most} can be drawn")]
pub struct TooMany {
    /// What there is too much of.
    pub what: &'static str,
    /// How many there are.
    pub count: u32,
    /// How many there may be.
    pub most: u32,
}

/// Workgroups of a dispatch that every device takes.
const MOST_GROUPS: u32 = 65_535;
/// Threads of one dispatch of the passes over what the scene has, 64 to a workgroup.
const MOST_THREADS: u32 = MOST_GROUPS * 64;
/// Triangles whose corners, and vertices whose coordinates, have numbers of 32 bits.
const MOST_TRIANGLES: u32 = u32::MAX / 3;
/// What the bits of the visibility image tell apart.
const MOST_SEEN: u32 = 1 << 29;
/// Rows that pass `sort` takes, 128 to a workgroup.
const MOST_ROWS: u32 = MOST_GROUPS * 128;

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub sub_patches: u32,
    pub draws: u32,
    pub rows: u32,
    pub intercepts: u32,
    pub doubts: u32,
    pub block_leaves: u32,
    pub tile_leaves: u32,
    pub fragments: u32,
}

/// Bits of [`Counters::failed`], as in `scene.glsl`.
const FAILED_DRAWS: u32 = 2;

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        let trimmed = u32::from(counts.trim.is_some());
        let table = u32::from(counts.trim == Some(TrimWay::Table));
        let counted = table.max(u32::from(counts.trim.is_some_and(is_texture)));
        Self {
            sub_patches: counts.items.saturating_add(256),
            draws: 64,
            rows: table * (1 << 16).max(2 * counts.strips).min(MOST_ROWS),
            intercepts: counted * (1 << 18).max(4 * counts.strips),
            doubts: trimmed * (1 << 14),
            block_leaves: counts.leaves.saturating_mul(4),
            tile_leaves: if counts.leaves > 0 { counts.leaves.saturating_mul(16).max(1 << 14) } else { 0 },
            fragments: if counts.shells > 0 { 1 << 18 } else { 0 },
        }
    }

    /// What the frame that reported `c` would have needed, with a quarter to spare where a storage
    /// buffer of `range` bytes has it; the same when it had enough.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        if c.wanted_rows > MOST_ROWS {
            return Err(TooMany { what: "scan lines", count: c.wanted_rows, most: MOST_ROWS });
        }
        let most_fragments = (range / size_of::<Fragment>() as u32).min(MOST_SEEN);
        if c.fragments > most_fragments {
            return Err(TooMany { what: "crossings of operands", count: c.fragments, most: most_fragments });
        }
        let room = |had: u32, wanted: u32, most: u32| {
            let spare = wanted.saturating_add(wanted / 4).min(most);
            if wanted > had { spare.max(wanted) } else { had }
        };
        let more_draws = if c.failed & FAILED_DRAWS != 0 { 4 } else { 1 };
        Ok(Self {
            sub_patches: room(
                self.sub_patches,
                c.plain.saturating_add(c.trimmed),
                range / size_of::<SubPatch>() as u32,
            ),
            draws: self.draws.saturating_mul(more_draws),
            rows: room(self.rows, c.wanted_rows, MOST_ROWS),
            intercepts: room(self.intercepts, c.intercepts, range / size_of::<u32>() as u32),
            doubts: room(self.doubts, c.doubts, range / size_of::<u32>() as u32),
            block_leaves: room(self.block_leaves, c.block_leaves, range / size_of::<u32>() as u32),
            tile_leaves: room(self.tile_leaves, c.tile_leaves, range / size_of::<TileLeaf>() as u32),
            fragments: room(self.fragments, c.fragments, most_fragments),
        })
    }
}

/// Everything transient.
pub(crate) struct Buffers {
    pub counts: Counts,
    pub capacities: Capacities,
    pub taus: Buffer,
    pub factors: Buffer,
    pub sub_patch_counts: Buffer,
    pub sub_patch_starts: Buffer,
    pub vertex_counts: Buffer,
    pub vertex_starts: Buffer,
    pub sums: Buffer,
    pub sub_patches: Buffer,
    pub draws: Buffer,
    pub counters: Buffer,
    pub trim: Option<TrimBuffers>,
    pub solids: Option<SolidBuffers>,
    pub visibility: Image,
    /// What is no patch, where pass `heal` needs it apart.
    pub others: Option<Image>,
    pub depth: Image,
    /// The sum of the samples' colours, where there are more than one.
    pub sum: Option<Image>,
    /// What is seen behind layers.
    pub behind: Option<Image>,
}

/// What trimmed patches need, whatever the way to trim.
pub(crate) struct TrimBuffers {
    /// How near the nearest ring comes, a word a pixel.
    pub rings: Buffer,
    pub doubts: Buffer,
    pub heal_dispatch: Buffer,
    /// `None` where another way trims.
    pub table: Option<TableBuffers>,
    #[cfg(feature = "rivals")]
    pub texture: Option<TextureBuffers>,
}

/// Trim textures and what leads to them.
#[cfg(feature = "rivals")]
pub(crate) struct TextureBuffers {
    pub strip_heights: Buffer,
    pub face_speeds: Buffer,
    pub words: Buffer,
    pub starts: Buffer,
    pub places: Buffer,
    /// As large as the capacity of intercepts.
    pub texels: Buffer,
}

#[cfg(feature = "rivals")]
impl TextureBuffers {
    /// Zero when the frame begins.
    pub(crate) fn cleared(&self) -> [&Buffer; 3] {
        [&self.strip_heights, &self.face_speeds, &self.texels]
    }
}

/// The way draws textures.
fn is_texture(way: TrimWay) -> bool {
    match way {
        TrimWay::Table | TrimWay::Exact => false,
        #[cfg(feature = "rivals")]
        TrimWay::Rival(rival) => matches!(rival, Rival::Texture { .. }),
    }
}

/// The trim table and what leads to it.
pub(crate) struct TableBuffers {
    pub strip_heights: Buffer,
    pub face_speeds: Buffer,
    pub line_counts: Buffer,
    pub line_starts: Buffer,
    pub segment_counts: Buffer,
    pub segment_starts: Buffer,
    pub dispatches: Buffer,
    pub row_counts: Buffer,
    pub row_starts: Buffer,
    pub row_total: Buffer,
    pub intercepts: Buffer,
}

impl TableBuffers {
    /// Zero when the frame begins.
    pub(crate) fn cleared(&self) -> [&Buffer; 3] {
        [&self.strip_heights, &self.face_speeds, &self.row_counts]
    }
}

/// Which leaves of Boolean solids each part of the picture sees.
pub(crate) struct SolidBuffers {
    pub blocks: u32,
    pub tiles: u32,
    pub rects: Buffer,
    pub block_counts: Buffer,
    pub block_starts: Buffer,
    pub block_leaves: Buffer,
    pub tile_counts: Buffer,
    pub tile_starts: Buffer,
    pub tile_leaves: Buffer,
    pub tile_entries: Buffer,
    pub fragments: Option<FragmentBuffers>,
}

/// Where each pixel's ray crosses operands without equations.
pub(crate) struct FragmentBuffers {
    pub counts: Buffer,
    pub starts: Buffer,
    pub all: Buffer,
}

impl Buffers {
    pub(crate) fn new(
        device: &Device,
        counts: Counts,
        capacities: Capacities,
        size: (u32, u32),
    ) -> Result<Self, GpuError> {
        let words = |name: &str, n: u32| Buffer::storage(device, Pool::Transient, name, 4 * u64::from(n));
        let structs = |name: &str, n: u32, bytes: usize| {
            Buffer::storage(device, Pool::Transient, name, u64::from(n) * bytes as u64)
        };
        let indirect = |name: &str, bytes: u64| Buffer::indirect(device, Pool::Transient, name, bytes);
        let image = |name: &str, format, usage| {
            Image::new(device, &ImageInfo { name, size, format, usage, pool: Pool::Transient })
        };
        let drawn_and_read = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE;
        let sampled = if counts.trim.is_some() { vk::ImageUsageFlags::SAMPLED } else { vk::ImageUsageFlags::empty() };
        let depth_usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | sampled;
        let n = counts.items;
        let across = |side: u32| (size.0.div_ceil(side) * size.1.div_ceil(side)) * u32::from(counts.leaves > 0);
        let (tiles, blocks) = (across(TILE), across(TILE * BLOCK));
        let pixels = if counts.shells > 0 { size.0 * size.1 } else { 0 };
        let scanned = [2 * n, counts.strips, counts.curves, counts.face_instances, capacities.rows, tiles, pixels];
        let scanned = scanned.into_iter().max().unwrap_or(0);
        let draw_bytes = 2 * u64::from(capacities.draws) * size_of::<vk::DrawIndirectCommand>() as u64;
        let table = || {
            Ok::<_, GpuError>(TableBuffers {
                strip_heights: words("trim strip heights", counts.strips)?,
                face_speeds: words("trim face speeds", 2 * counts.face_instances)?,
                line_counts: words("trim line counts", counts.strips)?,
                line_starts: words("trim line starts", counts.strips + 1)?,
                segment_counts: words("trim segment counts", counts.curves)?,
                segment_starts: words("trim segment starts", counts.curves + 1)?,
                dispatches: indirect("trim dispatches", 3 * size_of::<[u32; 3]>() as u64)?,
                row_counts: words("trim row counts", capacities.rows)?,
                row_starts: words("trim row starts", capacities.rows)?,
                row_total: words("trim row total", 1)?,
                intercepts: words("trim intercepts", capacities.intercepts)?,
            })
        };
        #[cfg(feature = "rivals")]
        let texture = || {
            Ok::<_, GpuError>(TextureBuffers {
                strip_heights: words("trim strip heights", counts.strips)?,
                face_speeds: words("trim face speeds", 2 * counts.face_instances)?,
                words: words("trim texture sizes", counts.face_instances)?,
                starts: words("trim texture starts", counts.face_instances + 1)?,
                places: structs("trim texture places", counts.strips, size_of::<[u32; 4]>())?,
                texels: words("trim texels", capacities.intercepts)?,
            })
        };
        Ok(Self {
            counts,
            capacities,
            taus: words("taus", n)?,
            factors: structs("factors", n, size_of::<Factors>())?,
            sub_patch_counts: words("sub-patch counts", 2 * n)?,
            sub_patch_starts: words("sub-patch starts", 2 * n + 1)?,
            vertex_counts: words("vertex counts", 2 * n)?,
            vertex_starts: words("vertex starts", 2 * n + 1)?,
            sums: words("scan sums", scan::block_count(scanned))?,
            sub_patches: structs("sub-patches", capacities.sub_patches, size_of::<SubPatch>())?,
            draws: indirect("draws", draw_bytes)?,
            counters: indirect("counters", size_of::<Counters>() as u64)?,
            trim: counts
                .trim
                .map(|way| {
                    Ok(TrimBuffers {
                        rings: structs("trim rings", size.0 * size.1, size_of::<u32>())?,
                        doubts: words("trim doubts", capacities.doubts)?,
                        heal_dispatch: indirect("heal dispatch", size_of::<[u32; 3]>() as u64)?,
                        table: (way == TrimWay::Table).then(table).transpose()?,
                        #[cfg(feature = "rivals")]
                        texture: is_texture(way).then(texture).transpose()?,
                    })
                })
                .transpose()?,
            solids: (counts.leaves > 0)
                .then(|| {
                    Ok(SolidBuffers {
                        blocks,
                        tiles,
                        rects: structs("solid rects", counts.leaves, size_of::<Rect>())?,
                        block_counts: words("solid block counts", blocks)?,
                        block_starts: words("solid block starts", blocks + 1)?,
                        block_leaves: words("solid block leaves", capacities.block_leaves)?,
                        tile_counts: words("solid tile counts", tiles)?,
                        tile_starts: words("solid tile starts", tiles + 1)?,
                        tile_leaves: structs("solid tile leaves", capacities.tile_leaves, size_of::<TileLeaf>())?,
                        tile_entries: words("solid tile entries", tiles)?,
                        fragments: (pixels > 0)
                            .then(|| {
                                Ok(FragmentBuffers {
                                    counts: words("operand fragment counts", pixels)?,
                                    starts: words("operand fragment starts", pixels + 1)?,
                                    all: structs("operand fragments", capacities.fragments, size_of::<Fragment>())?,
                                })
                            })
                            .transpose()?,
                    })
                })
                .transpose()?,
            visibility: image("visibility", VISIBILITY_FORMAT, drawn_and_read)?,
            others: (counts.trim.is_some() && (counts.mesh_instances > 0 || counts.leaves > 0))
                .then(|| image("visibility of others", VISIBILITY_FORMAT, drawn_and_read))
                .transpose()?,
            depth: image("visibility depth", DEPTH_FORMAT, depth_usage)?,
            sum: (counts.samples != Samples::One)
                .then(|| image("sum of samples", SUM_FORMAT, drawn_and_read))
                .transpose()?,
            behind: counts.is_followed.then(|| image("behind layers", BEHIND_FORMAT, drawn_and_read)).transpose()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every storage buffer of Vulkan's least capable device.
    const RANGE: u32 = 1 << 27;

    fn first() -> Capacities {
        Capacities::first(Counts { items: 1000, strips: 8, trim: Some(TrimWay::Table), ..Default::default() })
    }

    #[test]
    fn what_sufficed_stays() {
        let c = Counters { plain: 900, trimmed: 100, wanted_rows: 65_536, intercepts: 262_144, ..Default::default() };
        assert_eq!(first().grown(&c, RANGE).unwrap(), first());
    }

    #[test]
    fn what_did_not_gets_what_it_wanted_and_a_quarter() {
        let c = Counters { plain: 2000, wanted_rows: 100_000, failed: FAILED_DRAWS | 1 | 4, ..Default::default() };
        let grown = first().grown(&c, RANGE).unwrap();
        assert_eq!((grown.sub_patches, grown.rows), (2500, 125_000));
        assert_eq!((grown.draws, grown.intercepts), (4 * first().draws, first().intercepts));
        // no room for a quarter more in one storage buffer
        let c = Counters { intercepts: RANGE / 4 - 1, failed: 8, ..Default::default() };
        assert_eq!(first().grown(&c, RANGE).unwrap().intercepts, RANGE / 4);
    }

    #[test]
    fn more_than_can_be_counted_is_an_error() {
        let c = Counters { wanted_rows: MOST_ROWS + 1, failed: 4, ..Default::default() };
        assert!(matches!(first().grown(&c, RANGE), Err(TooMany { what: "scan lines", .. })));
        let counts = Counts { items: MOST_THREADS, ..Default::default() };
        assert!(counts.check().is_ok());
        assert!(matches!(Counts { curves: MOST_THREADS + 1, ..counts }.check(), Err(TooMany { .. })));
        let counts = Counts { triangles: MOST_TRIANGLES, mesh_instances: MOST_SEEN, ..counts };
        assert!(counts.check().is_ok());
        let more = Counts { triangles: MOST_TRIANGLES + 1, ..counts };
        assert!(matches!(more.check(), Err(TooMany { what: "triangles", .. })));
        let more = Counts { mesh_instances: MOST_SEEN + 1, ..counts };
        assert!(matches!(more.check(), Err(TooMany { what: "placed meshes", .. })));
    }
}
