//! Lists and images of Boolean solids that several passes share, and their sizes.

use super::tiles::counted;
use super::{Solids, Way};
use crate::abi::Fragment;
use crate::frame::common::room::{DRAWN_AND_READ, Room};
use crate::frame::solids::blister::{LAYER_DEPTH_FORMAT, LAYER_FORMAT};
use crate::gpu::{Buffer, GpuError, Image, Texel, TexelBuffer};
use crate::picture::PoolBytes;
use ash::vk;

/// The layers that way `blister` peels.
pub(crate) struct LayerImages {
    /// Used in turn.
    pub layers: [Image; 2],
    pub found: Image,
    pub depth: Image,
    pub stencil: Image,
}

impl LayerImages {
    pub(super) fn new(room: &Room<'_>) -> Result<Self, GpuError> {
        let layer = |name: &str| room.image(name, LAYER_FORMAT, DRAWN_AND_READ);
        let tested = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        Ok(Self {
            layers: [layer("blister layer 0")?, layer("blister layer 1")?],
            found: layer("blister faces found")?,
            depth: room.image("blister depth", LAYER_DEPTH_FORMAT, tested)?,
            stencil: room.image("blister stencil", room.device.stencil_format(), tested)?,
        })
    }
}

/// The crossings of each pixel's ray, in a band, with operands without equations.
pub(crate) struct FragmentBuffers {
    pub counts: Buffer,
    pub starts: Buffer,
    pub all: TexelBuffer,
}

impl FragmentBuffers {
    pub(super) fn new(room: &Room<'_>) -> Result<Self, GpuError> {
        let pixels = room.band_pixels();
        Ok(Self {
            counts: room.words("operand fragment counts", pixels)?,
            starts: room.words("operand fragment starts", pixels + 1)?,
            all: room.texels::<Fragment>("operand fragments", room.capacities.solids.fragments, Texel::U32x4)?,
        })
    }
}

/// Length of the longest list whose prefix sum is computed.
pub(crate) fn scanned(room: &Room<'_>) -> u32 {
    let counts = room.counts;
    let in_tiles = counts.leaves > 0 && !(counts.blister && counts.boundary_operands > 0);
    let [runs, tiles] = if in_tiles { counted(room) } else { [0, 0] };
    let pixels = if counts.has_fragments() { room.band_pixels() } else { 0 };
    runs.max(tiles).max(pixels)
}

impl Solids {
    /// Bytes of the buffers and images that only Boolean solids need.
    pub(crate) fn bytes(&self) -> Vec<PoolBytes> {
        let sum = |name: &str, bytes: &[u64]| PoolBytes { name: name.to_owned(), bytes: bytes.iter().sum() };
        let blocks = self
            .tiles()
            .map(|t| sum("blocks", &[&t.block_counts, &t.block_starts, &t.block_leaves].map(Buffer::bytes)));
        let tiles = self.tiles().map(|t| {
            let all = [&t.tile_counts, &t.tile_starts, &t.tile_leaves, &t.tile_entries, &t.tile_squares];
            sum("tiles", &all.map(Buffer::bytes))
        });
        let crossings = self.fragments().map(|f| sum("crossings", &[&f.counts, &f.starts, &f.all].map(Buffer::bytes)));
        let layers = match &self.way {
            Way::Blister(_, l, _) => {
                let [a, b] = &l.layers;
                Some(sum("layers", &[a, b, &l.found, &l.depth, &l.stencil].map(Image::bytes)))
            }
            Way::Events(..) | Way::Cst(..) => None,
        };
        let resume_points =
            self.resume_points.as_ref().map(|resume_points| sum("resume points", &[resume_points.bytes()]));
        blocks.into_iter().chain(tiles).chain(crossings).chain(layers).chain(resume_points).collect()
    }
}
