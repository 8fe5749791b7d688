//! Pass `visibility`: hardware tessellation of the sub-patches, and the trim test per pixel.
//!
//! ```text
//!   sub-patch ──tesc──▶ levels ──tese──▶ exact surface at the vertices ──▶ triangles
//!   patch of one segment a side ──vert──▶ its four corners ──────────────▶ two triangles   scenes of many patches
//!        plain    frag  ──────────────────────────────▶ patch instance, (u, v)   depth
//!        trimmed  frag  trim test of one way          ▶ patch instance, (u, v)   depth, depths of skirts
//! ```
//!
//! Each list is drawn by several renderings of [`DRAWS_OF_A_RENDERING`] draws, one after another: drivers that sort
//! triangles into tiles keep all triangles of a rendering, and the pictures of a large scene would take gigabytes.
//!
//! Reads: everything that `Bindings` names except the images. Writes: the visibility image and depth (reversed: 1 at
//! the near plane), which begin cleared or with meshes and solids; `border_depths`, cleared before.

use crate::abi::Counters;
use crate::abi::constants::scene::{CORNER_LIST, PLAIN_LIST, TRIMMED_CORNER_LIST, TRIMMED_LIST};
use crate::bindings::{Placed, Primitives};
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Image, Pipeline, Resource,
    TexelBuffer,
};
use crate::shaders::{self, TrimTest, constant};
use ash::vk;
use std::mem::offset_of;

/// Format of the visibility image: patch instance + 1, and (u, v) of its patch as two 16-bit numbers.
pub(crate) const VISIBILITY_FORMAT: vk::Format = vk::Format::R32G32_UINT;
/// Format of the pass's own depth image.
pub(crate) const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// Most draws of a rendering. Devices whose draws may have any number of vertices need one a list.
const DRAWS_OF_A_RENDERING: u32 = 256;

/// The pass: one pipeline for each kind of patch in the scene.
pub(crate) struct Visibility {
    plain: Option<Pipeline>,
    trimmed: Option<Pipeline>,
    /// The same of patches of one segment a side, if they have lists of their own.
    plain_corners: Option<Pipeline>,
    trimmed_corners: Option<Pipeline>,
}

/// The kinds of patches in the scene.
#[derive(Clone, Copy)]
pub(crate) struct Kinds<'a> {
    pub rational: bool,
    pub plain: bool,
    /// Lists of patches of one segment a side: of plain ones, and of trimmed ones.
    pub corner_lists: u32,
    /// Faces share sides.
    pub linked: bool,
    /// The trim test; `None` if no face is trimmed.
    pub trimmed: Option<&'a TrimTest>,
    /// Some strip of the trim table has several bins.
    pub bins: bool,
    /// Some patches belong to operands of Boolean solids and are not drawn here.
    pub operands: bool,
    /// The most general kind of surface of the volume that trims the scene; `None` without one.
    pub volume: Option<u32>,
}

impl Kinds<'_> {
    /// The pipeline of trimmed patches, or of plain ones. With `corners`, it draws them by their corners.
    fn pipeline(self, device: &Device, trimmed: Option<&TrimTest>, corners: bool) -> Result<Pipeline, GpuError> {
        let within = self.volume.is_some();
        let (fragment, kind) = match trimmed {
            None if within => (&shaders::VISIBILITY_VOLUME_FRAG, "plain"),
            None => (&shaders::VISIBILITY_FRAG, "plain"),
            Some(t) => (t.within.filter(|_| within).map_or(t.visibility, |w| w.visibility), t.way),
        };
        // corners are control points, the same for all faces that meet there
        let linked = self.linked && trimmed.is_none() && !corners;
        let surface = match (linked, within) {
            (false, _) => &shaders::VISIBILITY_TESE,
            (true, false) => &shaders::VISIBILITY_LINKED_TESE,
            (true, true) => &shaders::VISIBILITY_LINKED_VOLUME_TESE,
        };
        let (vertex, tessellation, by_corners) = match corners {
            false => (&shaders::VISIBILITY_VERT, Some([&shaders::VISIBILITY_TESC, surface]), ""),
            true => (&shaders::VISIBILITY_CORNERS_VERT, None, ", by corners"),
        };
        let within = if within { ", within a volume" } else { "" };
        let shared = if linked { ", linked" } else { "" };
        let weights = if self.rational { "rational" } else { "polynomial" };
        let name = format!("visibility ({kind}, {weights}{shared}{by_corners}{within})");
        let draw = Draw {
            tessellation,
            constants: &[
                (constant::SCENE_HAS_RATIONAL, u32::from(self.rational)),
                (constant::TRIMMED, u32::from(trimmed.is_some())),
                (constant::TRIMS_HAVE_BINS, u32::from(self.bins)),
                (constant::SCENE_HAS_OPERANDS, u32::from(self.operands)),
                (constant::SOLIDS_HAVE, self.volume.unwrap_or_default()),
            ],
            colour: &[ColourTarget { format: VISIBILITY_FORMAT, blend: Blend::Replace }],
            depth: Some(DepthTest { format: DEPTH_FORMAT, compare: vk::CompareOp::GREATER, write: true }),
            ..Draw::new(&name, vertex, fragment)
        };
        draw.pipeline(device)
    }
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub factors: &'a Buffer,
    pub sub_patches: &'a Buffer,
    pub instances: &'a TexelBuffer,
    /// The nearest depth of a border; in scenes with trims only.
    pub border_depths: Option<&'a Image>,
    /// The trim test's resources, in its order.
    pub trim: &'a [Resource<'a>],
    /// The volume that trims the scene; `None` without one.
    pub volume: Option<Primitives<'a>>,
    /// Sides that faces share; `None` without any.
    pub links: Option<&'a Buffer>,
    pub draws: &'a Buffer,
    pub counters: &'a Buffer,
}

impl Visibility {
    pub(crate) fn new(device: &Device, kinds: Kinds<'_>) -> Result<Self, GpuError> {
        let plain = |corners| kinds.plain.then(|| kinds.pipeline(device, None, corners)).transpose();
        let trimmed = |corners| kinds.trimmed.map(|test| kinds.pipeline(device, Some(test), corners)).transpose();
        Ok(Self {
            plain: plain(false)?,
            trimmed: trimmed(false)?,
            plain_corners: if kinds.corner_lists > 0 { plain(true)? } else { None },
            trimmed_corners: if kinds.corner_lists > 1 { trimmed(true)? } else { None },
        })
    }

    /// Draws all lists; `draw_capacity` draws of each lie in `draws`: plain, trimmed, and both by corners. `between` makes
    /// what a rendering has drawn visible to the next.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (visibility, depth): (Attachment<'_>, Attachment<'_>),
        draw_capacity: u32,
        between: impl Fn(),
    ) {
        let lists = [b.sub_patches.into(), b.instances.into()];
        let volume = || b.volume.iter().flat_map(Primitives::resources);
        let placed = || [b.frame.into()].into_iter().chain(b.placed.resources());
        let by_corners = || placed().chain(lists);
        let tessellated = || placed().chain([b.factors.into()]).chain(lists);
        let links = || b.links.map(Into::into);
        let test = || b.border_depths.map(Into::into).into_iter().chain(b.trim.iter().copied()).chain(volume());
        let mut drawn: Vec<(&Pipeline, Vec<Resource<'_>>, u32, usize)> = Vec::new();
        if let Some(plain) = &self.plain {
            let resources = tessellated().chain(volume()).chain(links()).collect();
            drawn.push((plain, resources, PLAIN_LIST, offset_of!(Counters, plain_draws)));
        }
        if let Some(corners) = &self.plain_corners {
            let resources = by_corners().chain(volume()).collect();
            drawn.push((corners, resources, CORNER_LIST, offset_of!(Counters, corner_draws)));
        }
        if let Some(trimmed) = self.trimmed.as_ref().filter(|_| b.border_depths.is_some()) {
            let resources = tessellated().chain(test()).collect();
            drawn.push((trimmed, resources, TRIMMED_LIST, offset_of!(Counters, trimmed_draws)));
        }
        if let Some(corners) = self.trimmed_corners.as_ref().filter(|_| b.border_depths.is_some()) {
            let resources = by_corners().chain(test()).collect();
            drawn.push((corners, resources, TRIMMED_CORNER_LIST, offset_of!(Counters, trimmed_corner_draws)));
        }
        let firsts = || (0..draw_capacity).step_by(DRAWS_OF_A_RENDERING as usize);
        let pieces: Vec<_> = drawn.iter().flat_map(|of_list| firsts().map(move |first| (first, of_list))).collect();
        // lists of one piece share a rendering; patches of equal depth keep their order
        let mut renderings: Vec<_> = pieces.chunk_by(|_, (first, _)| *first == 0).collect();
        if renderings.is_empty() {
            renderings.push(&[]); // clears the images
        }
        let (mut visibility, mut depth) = (visibility, depth);
        for (nth, rendering) in renderings.into_iter().enumerate() {
            if nth > 0 {
                between();
                (visibility, depth) = (visibility.again(), depth.again());
            }
            cmd.rendering(visibility.image.size(), &[visibility], Some(depth), || {
                for (first, (pipeline, resources, list, count)) in rendering {
                    cmd.bind(pipeline, resources, &[]);
                    let at = u64::from(list * draw_capacity + first) * size_of::<vk::DrawIndirectCommand>() as u64;
                    // draws beyond the count have no vertices, so that of the whole list serves each piece
                    let most = DRAWS_OF_A_RENDERING.min(draw_capacity - first);
                    cmd.draw_indirect_count(b.draws, at, b.counters, *count as u64, most);
                }
            });
        }
    }
}
