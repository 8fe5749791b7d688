//! Pass `resolve`: the exact surface at each pixel's centre, its normal, and light.
//!
//! ```text
//!   patch instance, (u, v) of the triangle ──Newton──▶ (u, v) whose exact point projects to the pixel's centre
//!   triangle of a mesh ──plane──▶   │
//!   side of a Boolean solid ─────▶  │        a pipeline for each kind of surface discards other pixels; with a
//!   nothing ──clear─────────────▶   │        sun, it tests whether the sun's light reaches the point; each draws
//!                                   │        only the tiles that may show its surfaces
//!                                   ├──▶ colour, depth into the host's targets
//!                                   └──▶ depth, face, (u, v), normal images, if the host has them
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the targets.

use crate::abi;
pub(crate) use crate::abi::constants::shade::UNSEEN;
use crate::bindings::{Placed, Primitives, SUN_BINDINGS};
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Image, Pipeline, Resource,
    TexelBuffer,
};
use crate::shaders::{self, Shader, constant};
use ash::vk;

/// Formats of the images of depth, face, (u, v) and normal.
pub(crate) const AOV_FORMATS: [vk::Format; 4] =
    [vk::Format::R32_SFLOAT, vk::Format::R32_UINT, vk::Format::R32G32_SFLOAT, vk::Format::R32G32B32A32_SFLOAT];

/// Format of the images behind layers and of the images that pass `coverage` mixes: linear colour and depth.
pub(crate) const BEHIND_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// The pass: one pipeline for each kind of surface in the scene.
pub(crate) struct Resolve {
    /// Draws the background of samples without a surface. A sum of samples cleared to the background would add it to
    /// every sample.
    background: Option<Pipeline>,
    patches: Option<Pipeline>,
    meshes: Option<Pipeline>,
    solids: Option<Pipeline>,
    operands: Option<Pipeline>,
}

/// The kinds of surfaces that the pass draws.
#[derive(Clone, Copy)]
pub(crate) struct Kinds {
    /// Patches other than those of operands.
    pub patches: bool,
    pub rational: bool,
    /// Some face has several patches that do not follow one equation.
    pub pieces: bool,
    /// Some patch has a fine net.
    pub fine: bool,
    pub meshes: bool,
    /// Boolean solids.
    pub solids: Option<SolidKinds>,
    /// Patches bound operands of Boolean solids.
    pub operands: bool,
    /// The key light is a sun.
    pub sun: bool,
    /// Styles may show curvature.
    pub curvature: bool,
}

/// The fragment shaders of a scene, one for each kind of surface.
struct Shaders {
    patches: &'static Shader,
    meshes: &'static Shader,
    solids: &'static Shader,
    operands: &'static Shader,
    /// The light's name, in the pipelines' names.
    light: &'static str,
}

const STUDIO: Shaders = Shaders {
    patches: &shaders::RESOLVE_FRAG,
    meshes: &shaders::RESOLVE_MESH_FRAG,
    solids: &shaders::RESOLVE_SOLID_FRAG,
    operands: &shaders::RESOLVE_OPERAND_FRAG,
    light: "",
};

const SUN: Shaders = Shaders {
    patches: &shaders::RESOLVE_SUN_FRAG,
    meshes: &shaders::RESOLVE_MESH_SUN_FRAG,
    solids: &shaders::RESOLVE_SOLID_SUN_FRAG,
    operands: &shaders::RESOLVE_OPERAND_SUN_FRAG,
    light: ", sun",
};

/// The kinds of surfaces of Boolean solids.
#[derive(Clone, Copy)]
pub(crate) struct SolidKinds {
    /// The most general kind of their surfaces: `abi::SURFACE_*`.
    pub surfaces: u32,
    /// There are lists of the tiles that may show them.
    pub tiles: bool,
    /// Some operand has no equations.
    pub boundary_operands: bool,
}

/// Formats of the host's targets.
#[derive(Clone, Copy)]
pub(crate) struct Formats {
    pub colour: vk::Format,
    pub depth: Option<vk::Format>,
    /// Whether there are images of depth, face, (u, v) and normal.
    pub aovs: [bool; 4],
    /// Whether there are images of edges, parts and instances.
    pub numbers: [bool; 3],
}

impl Formats {
    pub(crate) fn has_aovs(&self) -> bool {
        self.aovs.contains(&true)
    }

    pub(crate) fn has_numbers(&self) -> bool {
        self.numbers.contains(&true)
    }
}

/// The images that the pass draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    /// The host's targets.
    Targets,
    /// The sum of a pixel's samples, in the colour's format. The host's depth is tested and not written.
    Sum,
    /// The host's targets except for the colour, which is made of samples.
    AllButColour,
    /// The image behind layers, in the colour's place.
    Behind {
        /// Whether the host's depth is written.
        writes_depth: bool,
    },
    /// The image that pass `coverage` or `border_mix` mixes, in the colour's place and in the same format as behind
    /// layers.
    Unmixed,
}

/// Buffers and images of the pipeline for patches, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub instances: &'a TexelBuffer,
    pub visibility: &'a Image,
    /// The image of meshes and solids; the visibility image again if the scene has no trims, or only patches.
    pub meshes_and_solids: &'a Image,
    /// The picture's number of tiles, and the squares of tiles that show a patch or a mesh; `None` in scenes without
    /// them.
    pub squares: Option<(u32, &'a Buffer)>,
}

/// Buffers and images of the pipeline for meshes, in binding order; `squares` of [`Bindings`] follow.
pub(crate) struct MeshBindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub mesh_instances: &'a Buffer,
    pub meshes: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    pub normals: &'a Buffer,
    pub visibility: &'a Image,
    /// The visibility image again if the scene has no trims.
    pub meshes_and_solids: &'a Image,
}

/// Buffers and images of the pipeline for Boolean solids, in binding order.
pub(crate) struct SolidBindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    pub visibility: &'a Image,
    /// The visibility image again if the scene has no trims.
    pub meshes_and_solids: &'a Image,
    /// The picture's number of tiles, and the squares of tiles that may show a solid; `None` without such lists.
    pub tiles: Option<(u32, &'a Buffer)>,
    /// (u, v) of spline faces of operands.
    pub operand_uv: Option<&'a Image>,
    /// `None` if every operand has equations.
    pub boundary_operands: Option<OperandBindings<'a>>,
}

/// Buffers of operands' meshes, in binding order.
pub(crate) struct OperandBindings<'a> {
    pub instances: &'a Buffer,
    pub meshes: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    /// The surface of each triangle that shares its plane.
    pub planes: &'a Buffer,
    pub views: &'a Buffer,
}

impl Resolve {
    pub(crate) fn new(device: &Device, into: Destination, formats: Formats, kinds: Kinds) -> Result<Self, GpuError> {
        let (format, blend, of_samples) = match into {
            Destination::Targets => (formats.colour, Blend::Replace, ""),
            Destination::Sum => (formats.colour, Blend::Add, ", samples"),
            Destination::AllButColour => (formats.colour, Blend::Leave, ", beside samples"),
            Destination::Behind { writes_depth: true } => (BEHIND_FORMAT, Blend::Replace, ", behind layers"),
            Destination::Behind { writes_depth: false } => (BEHIND_FORMAT, Blend::Replace, ", behind layers, samples"),
            Destination::Unmixed => (BEHIND_FORMAT, Blend::Replace, ", unmixed"),
        };
        let mut colour = vec![ColourTarget { format, blend }];
        if formats.has_aovs() {
            colour.extend(AOV_FORMATS.map(|format| ColourTarget { format, blend: Blend::Replace }));
        }
        let of = if kinds.sun { SUN } else { STUDIO };
        let over = |vertex, name: &str, fragment, constants: &[(u32, u32)]| {
            let name = format!("resolve ({name}{of_samples}{})", of.light);
            let draw = Draw {
                constants,
                colour: &colour,
                depth: formats.depth.map(|format| DepthTest {
                    format,
                    compare: vk::CompareOp::GREATER_OR_EQUAL,
                    write: !matches!(into, Destination::Sum | Destination::Behind { writes_depth: false }),
                }),
                ..Draw::new(&name, vertex, fragment)
            };
            draw.pipeline(device)
        };
        let behind = matches!(into, Destination::Behind { .. } | Destination::Unmixed);
        let of_all = [
            (constant::HAS_AOVS, u32::from(formats.has_aovs())),
            (constant::BEHIND, u32::from(behind)),
            (constant::SHOWS_CURVATURE, u32::from(kinds.curvature)),
            (constant::SOLIDS_HAVE, kinds.solids.map_or(abi::SURFACE_PLANE, |s| s.surfaces)),
        ];
        let of_patches = [
            (constant::SCENE_HAS_RATIONAL, u32::from(kinds.rational)),
            (constant::SCENE_HAS_PIECES, u32::from(kinds.pieces)),
            (constant::SCENE_HAS_FINE, u32::from(kinds.fine)),
        ];
        let meshes_and_solids =
            [(constant::SCENE_HAS_MESHES_OR_SOLIDS, u32::from(kinds.meshes || kinds.solids.is_some()))];
        let boundary_operands =
            [(constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, u32::from(kinds.solids.is_some_and(|s| s.boundary_operands)))];
        let lit = |is_there: bool, vertex, name, fragment, constants: &[&[(u32, u32)]]| {
            is_there.then(|| over(vertex, name, fragment, &[&of_all[..], &constants.concat()].concat())).transpose()
        };
        let weights = if kinds.rational { "rational" } else { "polynomial" };
        let has_tiles = kinds.solids.is_some_and(|s| s.tiles);
        let of_solid = if has_tiles { &shaders::RESOLVE_SOLID_VERT } else { &shaders::RESOLVE_VERT };
        let patches =
            lit(kinds.patches, &shaders::RESOLVE_SEEN_VERT, weights, of.patches, &[&of_patches, &meshes_and_solids])?;
        let meshes = lit(kinds.meshes, &shaders::RESOLVE_SEEN_MESH_VERT, "mesh", of.meshes, &[])?;
        let solids = lit(kinds.solids.is_some(), of_solid, "solid", of.solids, &[&boundary_operands])?;
        let operands = lit(kinds.operands, &shaders::RESOLVE_VERT, "operand", of.operands, &[&of_patches])?;
        let unseen = || over(&shaders::RESOLVE_VERT, "background", &shaders::RESOLVE_BACKGROUND_FRAG, &[]);
        let background = (into == Destination::Sum).then(unseen).transpose()?;
        Ok(Self { background, patches, meshes, solids, operands })
    }

    /// Draws each kind of surface over the tiles that may show it, into `colour` and `depth`, which are cleared or
    /// loaded. `sun` has the resources for [`Kinds::sun`].
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (meshes, solids): (Option<&MeshBindings<'_>>, Option<&SolidBindings<'_>>),
        sun: Option<&[Resource<'_>; SUN_BINDINGS]>,
        colour: &[Attachment<'_>],
        depth: Option<Attachment<'_>>,
    ) {
        let size = b.visibility.size();
        let bind = |pipeline: &Pipeline, resources: Vec<Resource<'_>>| {
            let sun = sun.into_iter().flatten().copied();
            cmd.bind(pipeline, &resources.into_iter().chain(sun).collect::<Vec<_>>(), &[]);
        };
        cmd.rendering(size, colour, depth, || {
            let patches = || [b.frame.into()].into_iter().chain(b.placed.resources());
            let rest = [b.instances.into(), b.visibility.into()];
            if let Some(pipeline) = &self.background {
                cmd.bind(pipeline, &[b.frame.into(), b.visibility.into(), b.meshes_and_solids.into()], &[]);
                cmd.draw(3, 0, 1);
            }
            if let (Some(pipeline), Some((count, squares))) = (&self.patches, b.squares) {
                bind(pipeline, patches().chain(rest).chain([squares.into()]).collect());
                cmd.draw_instances(0..6, 0..count);
            }
            if let (Some(pipeline), Some(m), Some((count, squares))) = (&self.meshes, meshes, b.squares) {
                let placed = [m.frame, m.views, m.instances, m.mesh_instances, m.meshes].map(Into::into);
                let shape = [m.triangles, m.positions, m.normals].map(Into::into);
                let images = [m.visibility.into(), m.meshes_and_solids.into(), squares.into()];
                bind(pipeline, placed.into_iter().chain(shape).chain(images).collect());
                cmd.draw_instances(0..6, 0..count);
            }
            if let (Some(pipeline), Some(s)) = (&self.solids, solids) {
                // the shader declares these bindings in every scene, and reads them only with boundary operands
                let boundary_operands = s
                    .boundary_operands
                    .as_ref()
                    .map_or([s.frame; 6], |m| [m.instances, m.meshes, m.triangles, m.positions, m.planes, m.views]);
                let images = [s.visibility.into(), s.meshes_and_solids.into()];
                let squares = s.tiles.map(|(_, squares)| squares.into());
                let primitives = [s.frame.into()].into_iter().chain(s.primitives.resources());
                bind(
                    pipeline,
                    primitives.chain(images).chain(squares).chain(boundary_operands.map(Into::into)).collect(),
                );
                match s.tiles {
                    Some((count, _)) => cmd.draw_instances(0..6, 0..count),
                    None => cmd.draw(3, 0, 1),
                }
                if let (Some(pipeline), Some(uv)) = (&self.operands, s.operand_uv) {
                    let images = [s.meshes_and_solids.into(), uv.into()];
                    bind(pipeline, patches().chain(rest).chain(images).collect());
                    cmd.draw(3, 0, 1);
                }
            }
        });
    }
}
