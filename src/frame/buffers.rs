//! The transient buffers and images of a frame, sized by scene, picture and view.
//!
//! ```text
//!   by the scene     taus, factors, counts and starts per item; per strip, face and curve if trimmed; what is known of
//!                    patches behind others, where there are enough
//!   by the picture   visibility, that of what is no patch where faces are trimmed, depth; per tile and block
//!                    of tiles if there are Boolean solids, per pixel if operands are meshes or spline parts: of a
//!                    band of rows at a time, where all of them take too much; the sum of a pixel's samples where it has several;
//!                    what is behind layers where rays are followed through solids; linear colour where trims are smooth
//!   by the view      sub-patches, draws, rows, intercepts, doubts, leaves in tiles: a pass that runs out says so in
//!                    Counters.failed, and the next frame gets what it would have needed
//! ```

use crate::abi::{
    BLOCK, BORDER_BANDS, BORDER_COLUMNS, Counters, Doubt, Factors, Fragment, LEAF_RUN, Rect, SQUARE, StripRows,
    SubPatch, TILE, TileLeaf,
};
use crate::frame::antialiasing::average::SUM_FORMAT;
#[cfg(feature = "baselines")]
use crate::frame::capacities::is_texture;
use crate::frame::capacities::{Capacities, Counts};
use crate::frame::common::scan;
use crate::frame::shading::resolve::BEHIND_FORMAT;
use crate::frame::solids::blister::{LAYER_DEPTH_FORMAT, LAYER_FORMAT};
use crate::frame::solids::solid_events::OPERAND_UV_FORMAT;
use crate::frame::visibility::patches::{DEPTH_FORMAT, VISIBILITY_FORMAT};
use crate::gpu::{Buffer, BufferInfo, Device, GpuError, Home, Image, ImageInfo, Pool, Texel, Texels};
use crate::picture::{PoolBytes, Samples, TakenWay};
use ash::vk;

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
    /// What they were when all that a still camera keeps was there; from frame to frame.
    pub kept_counters: Buffer,
    /// In scenes where patches may lie behind others.
    pub hidden: Option<HiddenBuffers>,
    pub trim: Option<TrimBuffers>,
    pub solids: Option<SolidBuffers>,
    /// Of tiles that see a patch or a mesh; in scenes with either.
    pub seen_squares: Option<Buffer>,
    pub visibility: Image,
    /// What is no patch, where pass `heal` needs it apart.
    pub others: Option<Image>,
    pub depth: Image,
    /// The sum of the samples' colours, where there are more than one.
    pub sum: Option<Image>,
    /// What is seen behind layers.
    pub behind: Option<Image>,
    /// What pass `coverage` mixes.
    pub resolved: Option<Image>,
}

/// What is known of patches that lie behind others.
pub(crate) struct HiddenBuffers {
    /// A word an item; from frame to frame.
    pub hidden: Buffer,
    /// A float a square of pixels, then a tile, then a block of tiles.
    pub farthest: Buffer,
}

/// What trimmed patches need, whatever the way to trim.
pub(crate) struct TrimBuffers {
    /// How near the nearest ring comes, a word a pixel.
    pub rings: Texels,
    pub doubts: Buffer,
    pub heal_dispatch: Buffer,
    /// `None` where another way trims.
    pub table: Option<TableBuffers>,
    #[cfg(feature = "baselines")]
    pub texture: Option<TextureBuffers>,
}

/// Trim textures and what leads to them.
#[cfg(feature = "baselines")]
pub(crate) struct TextureBuffers {
    pub strip_heights: Buffer,
    pub face_speeds: Buffer,
    pub words: Buffer,
    pub starts: Buffer,
    pub places: Texels,
    /// As large as the capacity of intercepts.
    pub texels: Texels,
}

#[cfg(feature = "baselines")]
impl TextureBuffers {
    /// Zero when the frame begins.
    pub(crate) fn cleared(&self) -> [&Buffer; 3] {
        [&self.strip_heights, &self.face_speeds, &self.texels]
    }
}

/// The trim table and what leads to it.
pub(crate) struct TableBuffers {
    pub strip_heights: Buffer,
    pub face_speeds: Buffer,
    pub strip_counts: Buffer,
    pub strip_starts: Texels,
    pub segment_counts: Buffer,
    pub segment_starts: Texels,
    pub dispatches: Buffer,
    pub strips: Texels,
    /// While rows are filled how many intercepts each has, a word a row; then of each row its first flip, and its
    /// number of flips twice, 1 more where it begins inside.
    pub rows: Texels,
    pub row_starts: Texels,
    pub row_total: Buffer,
    pub intercepts: Texels,
    /// Of scenes with spline operands: only those ask.
    pub border_cells: Texels,
    /// `None` where each strip has one bay.
    pub bays: Option<BayBuffers>,
    /// What was counted when the table was made.
    pub counters: Buffer,
}

/// What strips with several bays need.
pub(crate) struct BayBuffers {
    pub seen: Buffer,
    pub row_windings: Buffer,
}

impl TableBuffers {
    /// Zero when the frame begins.
    pub(crate) fn cleared(&self) -> impl Iterator<Item = &Buffer> {
        let of_bays = self.bays.iter().flat_map(|bays| [&bays.seen, &bays.row_windings]);
        let all: [&Buffer; 4] = [&self.strip_heights, &self.face_speeds, &self.rows, &self.border_cells];
        all.into_iter().chain(of_bays)
    }
}

/// Which leaves of Boolean solids each part of the picture sees.
pub(crate) struct SolidBuffers {
    pub rects: Buffer,
    /// Rows of tiles in a band.
    pub band_rows: u32,
    /// `None` where [`SolidWay::Blister`](crate::picture::SolidWay::Blister) draws meshes, too.
    pub tiles: Option<TileBuffers>,
    pub fragments: Option<FragmentBuffers>,
    /// (u, v) of spline faces that bound operands.
    pub operand_uv: Option<Image>,
    pub layers: Option<LayerImages>,
    /// Where rays go on from, a word a pixel of a band; where one leg did not suffice.
    pub halts: Option<Buffer>,
}

/// Which leaves each tile of a band sees, and their Blist.
pub(crate) struct TileBuffers {
    /// Of leaves, of all blocks.
    pub runs: u32,
    /// In the picture.
    pub tiles: u32,
    pub block_counts: Buffer,
    pub block_starts: Buffer,
    pub block_leaves: Buffer,
    pub tile_counts: Buffer,
    pub tile_starts: Texels,
    pub tile_leaves: Texels,
    /// These two of all tiles of the picture.
    pub tile_entries: Texels,
    pub tile_squares: Buffer,
}

/// Faces peeled off by way `blister`.
pub(crate) struct LayerImages {
    /// In turn.
    pub layers: [Image; 2],
    pub found: Image,
    pub depth: Image,
    pub stencil: Image,
}

/// Where the ray of each pixel of a band crosses operands without equations.
pub(crate) struct FragmentBuffers {
    pub counts: Buffer,
    pub starts: Buffer,
    pub all: Texels,
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
        // written as structs or words, read as texels
        let texels = |name: &str, bytes: u64, texel: Texel| {
            let usage = Buffer::STORAGE | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
            let info = BufferInfo { name, bytes, usage, pool: Pool::Transient, home: Home::Device };
            Texels::new(device, Buffer::new(device, &info)?, texel)
        };
        let numbers = |name: &str, n: u32, texel: Texel| texels(name, 4 * u64::from(n), texel);
        let indirect = |name: &str, bytes: u64| Buffer::indirect(device, Pool::Transient, name, bytes);
        let image = |name: &str, format, usage| {
            Image::new(device, &ImageInfo { name, size, format, usage, pool: Pool::Transient })
        };
        let drawn_and_read = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE;
        let sampled = if counts.trim.is_some() || counts.hides {
            vk::ImageUsageFlags::SAMPLED
        } else {
            vk::ImageUsageFlags::empty()
        };
        let depth_usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | sampled;
        let n = counts.items;
        let in_tiles = counts.leaves > 0 && !(counts.blister && counts.shells > 0);
        let across = |side: u32| size.0.div_ceil(side) * size.1.div_ceil(side);
        let [all_tiles, blocks] = [across(TILE), across(TILE * BLOCK)].map(|count| count * u32::from(in_tiles));
        let band_rows = capacities.band_rows.min(size.1.div_ceil(TILE));
        let runs = blocks * counts.leaves.div_ceil(LEAF_RUN);
        let tiles = all_tiles.min(size.0.div_ceil(TILE) * band_rows);
        let band_pixels = size.0 * (band_rows * TILE).min(size.1);
        let pixels = if counts.has_fragments() { band_pixels } else { 0 };
        let scanned = [2 * n, counts.bays, counts.curves, counts.face_instances, capacities.rows, tiles, runs, pixels];
        let scanned = scanned.into_iter().max().unwrap_or(0);
        let draw_bytes = 2 * u64::from(capacities.draws) * size_of::<vk::DrawIndirectCommand>() as u64;
        let table = || {
            Ok::<_, GpuError>(TableBuffers {
                strip_heights: words("trim strip heights", counts.bays)?,
                face_speeds: words("trim face speeds", 2 * counts.face_instances)?,
                strip_counts: words("trim strip counts", counts.bays)?,
                strip_starts: numbers("trim strip starts", counts.bays + 1, Texel::Words)?,
                segment_counts: words("trim segment counts", counts.curves)?,
                segment_starts: numbers("trim segment starts", counts.curves + 1, Texel::Words)?,
                dispatches: indirect("trim dispatches", 3 * size_of::<[u32; 3]>() as u64)?,
                strips: texels("trim strips", size_of::<StripRows>() as u64 * u64::from(counts.bays), Texel::U32x4)?,
                rows: texels("trim rows", 8 * u64::from(capacities.rows), Texel::U32x2)?,
                row_starts: numbers("trim row starts", capacities.rows, Texel::Words)?,
                row_total: words("trim row total", 1)?,
                intercepts: numbers("trim intercepts", capacities.intercepts, Texel::U32x2)?,
                border_cells: texels(
                    "trim border cells",
                    u64::from(if counts.operand_patches { counts.bays } else { 1 })
                        * u64::from(BORDER_BANDS * BORDER_COLUMNS / 8),
                    Texel::U32x4,
                )?,
                bays: (counts.wide_strips > 0)
                    .then(|| {
                        Ok(BayBuffers {
                            seen: words("trim seen bays", counts.bays)?,
                            row_windings: words("trim row windings", capacities.rows)?,
                        })
                    })
                    .transpose()?,
                counters: structs("trim table counters", 1, size_of::<Counters>())?,
            })
        };
        #[cfg(feature = "baselines")]
        let texture = || {
            Ok::<_, GpuError>(TextureBuffers {
                strip_heights: words("trim strip heights", counts.bays)?,
                face_speeds: words("trim face speeds", 2 * counts.face_instances)?,
                words: words("trim texture sizes", counts.face_instances)?,
                starts: words("trim texture starts", counts.face_instances + 1)?,
                places: texels(
                    "trim texture places",
                    u64::from(counts.bays) * size_of::<[u32; 4]>() as u64,
                    Texel::U32x4,
                )?,
                texels: numbers("trim texels", capacities.intercepts, Texel::Words)?,
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
            kept_counters: structs("kept counters", 1, size_of::<Counters>())?,
            hidden: counts
                .hides
                .then(|| {
                    Ok::<_, GpuError>(HiddenBuffers {
                        hidden: words("hidden patches", n)?,
                        farthest: words("farthest depths", across(SQUARE) + across(TILE) + across(TILE * BLOCK))?,
                    })
                })
                .transpose()?,
            trim: counts
                .trim
                .map(|way| {
                    Ok(TrimBuffers {
                        rings: numbers("trim rings", size.0 * size.1, Texel::Numbers)?,
                        doubts: structs("trim doubts", capacities.doubts, size_of::<Doubt>())?,
                        heal_dispatch: indirect("heal dispatch", size_of::<[u32; 3]>() as u64)?,
                        table: (way == TakenWay::Table).then(table).transpose()?,
                        #[cfg(feature = "baselines")]
                        texture: is_texture(way).then(texture).transpose()?,
                    })
                })
                .transpose()?,
            solids: (counts.leaves > 0)
                .then(|| {
                    Ok(SolidBuffers {
                        rects: structs("solid rects", counts.leaves, size_of::<Rect>())?,
                        band_rows,
                        tiles: in_tiles
                            .then(|| {
                                let room = capacities.tile_leaves;
                                Ok(TileBuffers {
                                    runs,
                                    tiles: all_tiles,
                                    block_counts: words("solid block counts", runs)?,
                                    block_starts: words("solid block starts", runs + 1)?,
                                    block_leaves: words("solid block leaves", capacities.block_leaves)?,
                                    tile_counts: words("solid tile counts", tiles)?,
                                    tile_starts: numbers("solid tile starts", tiles + 1, Texel::Words)?,
                                    tile_leaves: texels(
                                        "solid tile leaves",
                                        u64::from(room) * size_of::<TileLeaf>() as u64,
                                        Texel::U32x4,
                                    )?,
                                    tile_entries: numbers("solid tile entries", all_tiles, Texel::Words)?,
                                    tile_squares: words("solid tile squares", all_tiles)?,
                                })
                            })
                            .transpose()?,
                        operand_uv: (counts.operand_patches && counts.has_fragments())
                            .then(|| image("operand (u, v)", OPERAND_UV_FORMAT, drawn_and_read))
                            .transpose()?,
                        layers: counts
                            .blister
                            .then(|| {
                                let layer = |name: &str| image(name, LAYER_FORMAT, drawn_and_read);
                                let tested = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
                                Ok(LayerImages {
                                    layers: [layer("blister layer 0")?, layer("blister layer 1")?],
                                    found: layer("blister faces found")?,
                                    depth: image("blister depth", LAYER_DEPTH_FORMAT, tested)?,
                                    stencil: image("blister stencil", device.stencil_format(), tested)?,
                                })
                            })
                            .transpose()?,
                        halts: (capacities.legs > 1).then(|| words("solid halts", band_pixels)).transpose()?,
                        fragments: (pixels > 0)
                            .then(|| {
                                Ok(FragmentBuffers {
                                    counts: words("operand fragment counts", pixels)?,
                                    starts: words("operand fragment starts", pixels + 1)?,
                                    all: texels(
                                        "operand fragments",
                                        u64::from(capacities.fragments) * size_of::<Fragment>() as u64,
                                        Texel::U32x4,
                                    )?,
                                })
                            })
                            .transpose()?,
                    })
                })
                .transpose()?,
            seen_squares: counts.has_surfaces.then(|| words("seen squares", across(TILE))).transpose()?,
            visibility: image("visibility", VISIBILITY_FORMAT, drawn_and_read)?,
            others: (counts.trim.is_some() && (counts.mesh_instances > 0 || counts.leaves > 0))
                .then(|| image("visibility of others", VISIBILITY_FORMAT, drawn_and_read))
                .transpose()?,
            depth: image("visibility depth", DEPTH_FORMAT, depth_usage)?,
            sum: (counts.samples != Samples::One)
                .then(|| image("sum of samples", SUM_FORMAT, drawn_and_read))
                .transpose()?,
            behind: counts.is_followed.then(|| image("behind layers", BEHIND_FORMAT, drawn_and_read)).transpose()?,
            resolved: counts.smooths_trims.then(|| image("resolved", BEHIND_FORMAT, drawn_and_read)).transpose()?,
        })
    }
}

impl SolidBuffers {
    /// Bytes of what the way to draw Boolean solids takes beside what every frame has.
    pub(crate) fn bytes(&self) -> Vec<PoolBytes> {
        let sum = |name: &str, bytes: &[u64]| PoolBytes { name: name.to_owned(), bytes: bytes.iter().sum() };
        let blocks = self
            .tiles
            .as_ref()
            .map(|t| sum("blocks", &[&t.block_counts, &t.block_starts, &t.block_leaves].map(Buffer::bytes)));
        let tiles = self.tiles.as_ref().map(|t| {
            let all = [&t.tile_counts, &t.tile_starts, &t.tile_leaves, &t.tile_entries, &t.tile_squares];
            sum("tiles", &all.map(Buffer::bytes))
        });
        let crossings =
            self.fragments.as_ref().map(|f| sum("crossings", &[&f.counts, &f.starts, &f.all].map(Buffer::bytes)));
        let layers = self.layers.as_ref().map(|l| {
            let [a, b] = &l.layers;
            sum("layers", &[a, b, &l.found, &l.depth, &l.stencil].map(Image::bytes))
        });
        let halts = self.halts.as_ref().map(|halts| sum("halts", &[halts.bytes()]));
        blocks.into_iter().chain(tiles).chain(crossings).chain(layers).chain(halts).collect()
    }
}
