//! Pass `solid_layers`: follows each pixel's ray through distinct solids.
//!
//! ```text
//!   behind (the colours of pass `resolve`) ──┐
//!   leaves of the tile, item by item ────────┴──▶ layers, front to back ──▶ colour, over the colours behind
//!                                                                        ├─▶ images of the first layer
//!                                                                        ├─▶ length within solids
//!                                                                        └─▶ the nth face, or the last, for lines
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the targets, and the counters `clamps`, `contacts` and `overlaps`.
//! Per pixel it stores only `behind` and the fragments of operands without equations.

use crate::bindings::{Primitives, SUN_BINDINGS, SUN_OWN};
use crate::frame::common::draw::Draw;
use crate::frame::common::layer_faces::{FACES_FORMAT, Faces};
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Image, Pipeline, Resource,
    TexelBuffer,
};
use crate::shaders::{self, constant};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

/// Format of the image of thickness.
pub(crate) const THICKNESS_FORMAT: vk::Format = vk::Format::R32_SFLOAT;

/// The output for which rays are followed; each has its own pipeline.
#[derive(Clone, Copy, Debug)]
pub(crate) enum For {
    /// The colour, blended over the target.
    Colour(vk::Format),
    /// The colour, added to the sum of a pixel's samples.
    Sample(vk::Format),
    /// The images `aovs` of the first layer, and the host's depth. The colour target is bound and stays.
    First { colour: vk::Format, aovs: &'static [vk::Format] },
    /// The length within solids, the only target.
    Thickness,
    /// The face of the number that [`SolidLayers::record_faces`] takes, for lines; the only target.
    NthFace,
    /// The farthest face in front of what is opaque, for lines; the only target.
    FarthestFace,
}

/// The kinds of surfaces in the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kinds {
    /// The most general kind of surface: `abi::SURFACE_*`.
    pub surfaces: u32,
    /// Some operand has no equations.
    pub boundary_operands: bool,
    /// Some operand is a spline part; some patches have unequal weights.
    pub patches: bool,
    pub rational: bool,
    /// Some face has several patches that do not follow one equation.
    pub pieces: bool,
    /// Some operand's patch has a fine net.
    pub fine: bool,
    /// Linear colour and opacity of contacts and overlaps, if they are highlighted.
    pub marks: Option<[[f32; 4]; 2]>,
    /// The key light is a sun.
    pub sun: bool,
}

/// The pass.
pub(crate) struct SolidLayers {
    pipeline: Pipeline,
    marks: [[f32; 4]; 2],
    sun: bool,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Params {
    marks: [[f32; 4]; 2],
    nth: u32,
}

/// Its buffers and image, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    /// In model axes, relative to the eye.
    pub leaf_centres: &'a Buffer,
    pub tile_starts: &'a Buffer,
    pub tile_leaves: &'a TexelBuffer,
    /// Crossings of rays with operands without equations: starts, counts, all; `None` without such operands.
    pub fragments: Option<(&'a Buffer, &'a Buffer, &'a TexelBuffer)>,
    pub counters: &'a Buffer,
    pub behind: &'a Image,
    pub views: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a TexelBuffer,
    pub patch_instances: &'a Buffer,
    pub points: &'a TexelBuffer,
    pub instances: &'a Buffer,
    /// The resources for [`Kinds::sun`].
    pub sun: Option<[Resource<'a>; SUN_BINDINGS]>,
    /// Meshes of operands: meshes, triangles, positions, planes; `None` without any.
    pub boundary_operands: Option<[&'a Buffer; 4]>,
}

impl SolidLayers {
    /// `depth` is the format of the host's target. Surfaces behind it stay hidden; only [`For::First`] writes it.
    pub(crate) fn new(
        device: &Device,
        purpose: For,
        depth: Option<vk::Format>,
        kinds: Kinds,
    ) -> Result<Self, GpuError> {
        let target = |format, blend| ColourTarget { format, blend };
        let (number, name, colour) = match purpose {
            For::Colour(format) => (0, "colour", vec![target(format, Blend::Over)]),
            For::Sample(format) => (0, "sample", vec![target(format, Blend::Add)]),
            For::First { colour, aovs } => {
                let aovs = aovs.iter().map(|format| target(*format, Blend::Replace));
                (1, "first", std::iter::once(target(colour, Blend::Leave)).chain(aovs).collect())
            }
            For::Thickness => (2, "thickness", vec![target(THICKNESS_FORMAT, Blend::Replace)]),
            For::NthFace => (3, "nth faces", vec![target(FACES_FORMAT, Blend::Replace)]),
            For::FarthestFace => (4, "farthest faces", vec![target(FACES_FORMAT, Blend::Replace)]),
        };
        // lengths within solids and faces for lines are not lit, and nothing hides them by the host's depth
        let is_lit = number < 2;
        let sun = kinds.sun && is_lit;
        let marks = kinds.marks.filter(|_| number == 0);
        let writes = matches!(purpose, For::First { .. });
        let fragment = if sun { &shaders::SOLID_LAYERS_SUN_FRAG } else { &shaders::SOLID_LAYERS_FRAG };
        let name = format!("solid layers ({name})");
        let draw = Draw {
            constants: &[
                (constant::SCENE_HAS_RATIONAL, u32::from(kinds.rational)),
                (constant::SCENE_HAS_PIECES, u32::from(kinds.pieces)),
                (constant::SCENE_HAS_FINE, u32::from(kinds.fine)),
                (constant::HAS_AOVS, u32::from(writes)),
                (constant::SOLIDS_HAVE, kinds.surfaces),
                (constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, u32::from(kinds.boundary_operands)),
                (constant::FOLLOWED_FOR, number),
                (constant::MARKS, u32::from(marks.is_some())),
                (constant::SOLIDS_HAVE_PATCHES, u32::from(kinds.patches)),
            ],
            colour: &colour,
            depth: depth.filter(|_| is_lit).map(|format| DepthTest {
                format,
                compare: vk::CompareOp::GREATER_OR_EQUAL,
                write: writes,
            }),
            ..Draw::new(&name, &shaders::RESOLVE_VERT, fragment)
        };
        let pipeline = draw.pipeline(device)?;
        Ok(Self { pipeline, marks: marks.unwrap_or_default(), sun })
    }

    /// Draws one triangle over these rows of the targets.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        colour: &[Attachment<'_>],
        depth: Option<Attachment<'_>>,
        rows: Range<u32>,
    ) {
        self.draw(cmd, b, (colour, depth), (rows, 0));
    }

    /// The same for lines: these faces of each ray into rows of the only target. The pass is one for them.
    pub(crate) fn record_faces(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (faces, target): (Faces, Attachment<'_>),
        rows: Range<u32>,
    ) {
        let nth = match faces {
            Faces::Nth(number) => number,
            Faces::Farthest => 0, // it is not read
        };
        self.draw(cmd, b, (&[target], None), (rows, nth));
    }

    fn draw(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (colour, depth): (&[Attachment<'_>], Option<Attachment<'_>>),
        (rows, nth): (Range<u32>, u32),
    ) {
        // the shader declares these bindings in every scene, and reads them only with boundary operands
        let (starts, counts, fragments) = b.fragments.unwrap_or((b.frame, b.frame, b.tile_leaves));
        let boundary_operands = b.boundary_operands.unwrap_or([b.frame; 4]);
        let placed: [Resource<'_>; 5] =
            [b.views.into(), b.face_instances.into(), b.faces.into(), b.patches.into(), b.patch_instances.into()];
        let tiles: [Resource<'_>; 3] = [b.leaf_centres.into(), b.tile_starts.into(), b.tile_leaves.into()];
        let fragments: [Resource<'_>; 3] = [starts.into(), counts.into(), fragments.into()];
        let sun = b.sun.filter(|_| self.sun);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.primitives.resources())
            .chain(tiles)
            .chain(fragments)
            .chain([b.counters.into(), b.behind.into()])
            .chain(placed)
            .chain([b.points.into(), b.instances.into()])
            .chain(boundary_operands.into_iter().map(Into::into))
            .chain(sun.into_iter().flat_map(|s| s.into_iter().take(SUN_OWN)))
            .collect();
        cmd.rendering_rows((b.behind.size(), rows), colour, depth, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&Params { marks: self.marks, nth }));
            cmd.draw(3, 0, 1);
        });
    }
}
