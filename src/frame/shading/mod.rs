//! Shading: tiles of each kind of surface, exact points, normals and light, drawn into the host's targets or into
//! images of linear colour; ambient occlusion over those images.

pub(crate) mod ambient;
pub(crate) mod contact;
pub(crate) mod linear;
pub(crate) mod linear_show;
pub(crate) mod numbers;
pub(crate) mod resolve;
pub(crate) mod seen_squares;

use super::common::room::Room;
use super::{Frame, solids};
use crate::abi::TILE;
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, barrier};
use crate::picture::Samples;
use crate::scene::SceneData;
use ash::vk;
use resolve::AOV_FORMATS;
use seen_squares::SeenSquares;
use std::sync::Arc;

/// The passes.
pub(crate) struct Passes {
    /// For the host's targets; `None` if the only target is a colour made of samples.
    resolve: Option<resolve::Resolve>,
    /// In scenes with patches or meshes.
    squares: Option<Arc<SeenSquares>>,
    /// If the host has images of numbers.
    numbers: Option<numbers::Numbers>,
    formats: resolve::Formats,
}

impl Passes {
    pub(super) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Self, GpuError> {
        Ok(Self {
            resolve: targets(device, data, formats)?,
            squares: data.has_surfaces().then(|| SeenSquares::new(device)).transpose()?.map(Arc::new),
            formats,
            numbers: formats.has_numbers().then(|| numbers::Numbers::new(device)).transpose()?,
        })
    }
}

/// The kinds of surfaces in the scene.
pub(super) fn kinds(data: &SceneData) -> resolve::Kinds {
    resolve::Kinds {
        patches: data.has_patches,
        rational: data.has_rational,
        pieces: data.has_pieces,
        fine: data.has_fine,
        meshes: data.has_meshes(),
        solids: data.solids.kinds().map(|surfaces| resolve::SolidKinds {
            surfaces,
            tiles: solids::has_tiles(data),
            boundary_operands: !data.solids.operand_leaves.is_empty(),
        }),
        operands: data.has_operands,
        sun: data.sun.is_some(),
        curvature: data.curvature,
    }
}

/// The pass for the host's targets; `None` if samples make all of them.
fn targets(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Option<resolve::Resolve>, GpuError> {
    // lines and numbers are those at the pixels' centres
    let beside =
        formats.has_aovs() || formats.depth.is_some() || data.thickness || formats.has_numbers() || data.has_lines();
    let into = match data.samples {
        Samples::One if data.is_mixed() => resolve::Destination::Unmixed,
        Samples::One if data.is_layered => resolve::Destination::Behind { writes_depth: true },
        Samples::One => resolve::Destination::Targets,
        Samples::Four | Samples::Eight if !beside => return Ok(None),
        Samples::Four | Samples::Eight if data.is_layered => resolve::Destination::Behind { writes_depth: true },
        Samples::Four | Samples::Eight => resolve::Destination::AllButColour,
    };
    resolve::Resolve::new(device, into, formats, kinds(data)).map(Some)
}

/// Depth, face, (u, v) and normal of pixels without a surface.
pub(crate) const NOWHERE: [Load; 4] = [
    Load::ColourF32([f32::INFINITY; 4]),
    Load::ColourU32([0; 4]),
    Load::ColourF32([f32::NAN; 4]),
    Load::ColourF32([0.0; 4]),
];

/// The stage.
pub(crate) struct Shading {
    passes: Arc<Passes>,
    squares: Option<Squares>,
    /// Images that passes must draw together with the host's targets but that the host does not have: depth, face, (u,
    /// v), normal, edge, part and instance.
    spare: [Option<Image>; 7],
}

/// The tiles that show a patch or a mesh.
struct Squares {
    pass: Arc<SeenSquares>,
    buffer: Buffer,
}

impl Shading {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let squares = |pass: &Arc<SeenSquares>| {
            let buffer = room.words("seen squares", room.squares(TILE))?;
            Ok::<_, GpuError>(Squares { pass: Arc::clone(pass), buffer })
        };
        let formats = &passes.formats;
        let mut spare = [const { None }; 7];
        let all = AOV_FORMATS.iter().copied().chain([numbers::NUMBER_FORMAT; 3]);
        for ((k, format), is_wanted) in all.enumerate().zip(formats.aovs.into_iter().chain(formats.numbers)) {
            let is_drawn = if k < AOV_FORMATS.len() { formats.has_aovs() } else { formats.has_numbers() };
            if is_drawn && !is_wanted {
                spare[k] = Some(room.image("spare image", format, vk::ImageUsageFlags::COLOR_ATTACHMENT)?);
            }
        }
        let squares = passes.squares.as_ref().map(squares).transpose()?;
        Ok(Self { passes: Arc::clone(passes), squares, spare })
    }

    /// Discards the contents of the spare images, before drawing.
    pub(super) fn begin(&self, cmd: &Commands<'_>) {
        let again = (Access::COLOUR_WRITE.discarded(), Access::COLOUR_WRITE);
        barrier::images(cmd, &self.spare.iter().flatten().map(|image| (image, again.0, again.1)).collect::<Vec<_>>());
    }

    /// The spare image in place of the host's image of this number.
    pub(super) fn spare(&self, number: usize) -> Option<&Image> {
        self.spare[number].as_ref()
    }

    /// The pass for the host's targets; `None` if samples make all of them.
    pub(super) fn resolve(&self) -> Option<&resolve::Resolve> {
        self.passes.resolve.as_ref()
    }

    /// Draws the visible surfaces into the frame's targets with `pass`.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, pass: &resolve::Resolve) {
        self.find_squares(frame, cmd);
        let (s, v) = (frame.scene, &frame.stages.visibility);
        let bindings = resolve::Bindings {
            frame: frame.constants,
            placed: s.placed(frame.views),
            instances: &s.instances,
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            squares: self.squares.as_ref().map(|squares| {
                let (width, height) = v.image.size();
                (width.div_ceil(TILE) * height.div_ceil(TILE), &squares.buffer)
            }),
        };
        let meshes = s.meshes.as_ref().map(|m| resolve::MeshBindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            mesh_instances: &m.instances,
            meshes: &m.meshes,
            triangles: &m.triangles,
            positions: &m.positions,
            normals: &m.normals,
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
        });
        let solids = frame.solids().map(|parts| parts.resolve(frame));
        let kinds = (meshes.as_ref(), solids.as_ref());
        frame.under_sun(cmd, |sun| pass.record(cmd, &bindings, kinds, sun, &frame.resolved_into(), frame.depth));
    }

    /// Writes the part and the instance at each pixel's centre into the host's images.
    pub(super) fn numbers(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, v) = (frame.scene, &frame.stages.visibility);
        let (Some(pass), Some(into), Some(sources)) = (&self.passes.numbers, frame.numbers, &s.sources) else { return };
        let bindings = numbers::Bindings {
            sources,
            face_instances: &s.face_instances,
            patch_instances: &s.patch_instances,
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            mesh_instances: s.meshes.as_ref().map_or(frame.constants, |m| &m.instances),
        };
        pass.record(cmd, &bindings, into);
    }

    /// Finds the tiles that pass `resolve` draws for patches and meshes.
    fn find_squares(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let Some(Squares { pass, buffer }) = &self.squares else { return };
        let v = &frame.stages.visibility;
        let bindings = seen_squares::Bindings {
            frame: frame.constants,
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            squares: buffer,
        };
        pass.record(cmd, &bindings);
        cmd.after(Access::COMPUTE_WRITE, Access::VERTEX_READ);
    }
}

impl<'a> Frame<'a> {
    /// The targets of pass `resolve`, cleared to the values without a surface, or loaded if the host's picture stays.
    fn resolved_into(&self) -> Vec<Attachment<'a>> {
        let nowhere = [Load::ColourF32(self.background)].into_iter().chain(NOWHERE);
        let cleared = |(attachment, nowhere): (&Attachment<'a>, Load)| match attachment.load {
            Load::Discard => Attachment { load: nowhere, ..*attachment },
            _ => *attachment,
        };
        let mut into: Vec<_> = self.colour.iter().zip(nowhere).map(cleared).collect();
        let behind = self.stages.transparency.as_ref().and_then(|layers| layers.behind_layers());
        let unmixed = self.stages.unmixed();
        if let Some(image) = behind.or(unmixed) {
            into[0] = Attachment { image, load: Load::ColourF32([0.0, 0.0, 0.0, resolve::UNSEEN]) };
        }
        into
    }
}
