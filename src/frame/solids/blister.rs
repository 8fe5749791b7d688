//! Pass `blister`: the faces of Boolean solids, layer by layer, classified by labels in a stencil image.
//!
//! ```text
//!   layer k    peel       the nearest face behind layer k - 1, of every primitive that may bound a solid there
//!              wait       stencil: label 0 in pixels that are not locked
//!              test       for each switch of the Blist, in order: where label = name
//!                           within?  parity 1            (its triangles, or its span)
//!                           label = without where parity is 0, label = within and parity 0 where it is 1
//!              lock       where label = inside: the layer's face is found; later layers skip the pixel
//!
//!   stencil    7 parity │ 6 locked │ 5-0 label
//! ```
//!
//! A stencil operation cannot compare with one value and store another, so a label changes by inverting the bits that
//! differ. Reads: everything that `Bindings` names, and the images. Writes: the images, `counters`. Source: J. Hable,
//! J. Rossignac, *Blister: GPU-based rendering of Boolean combinations of free-form triangulated shapes*, SIGGRAPH
//! 2005. Departures: equal depths are equal to the bit, so rounding never puts a face on the wrong side of its own
//! primitive; if several primitives share a face, its owner is found as in the other ways.

use crate::bindings::Primitives;
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Image, Pipeline, Resource,
    StencilTest, TexelBuffer,
};
use crate::shaders::{self, Shader, constant};
use ash::vk;
use std::ops::Range;

/// Format of layers and of found faces: a word of `visible.glsl`, and the depth.
pub(crate) const LAYER_FORMAT: vk::Format = vk::Format::R32G32_UINT;
/// Format of the depth test among the faces of a layer.
pub(crate) const LAYER_DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

const PARITY: u32 = 0x80;
const LOCKED: u32 = 0x40;
const LABEL: u32 = 0x3f;

/// The faces that are peeled; bits as in `blister.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Peel {
    /// Faces where rays enter leaves that add, or exit leaves that subtract.
    pub entries: bool,
    /// Faces where rays exit leaves that add, or enter leaves that subtract.
    pub exits: bool,
    /// Faces found earlier do not lock their pixels; the search starts from them.
    pub unlocks: bool,
}

impl Peel {
    fn bits(self) -> [u8; 4] {
        (u32::from(self.entries) | u32::from(self.exits) << 1 | u32::from(self.unlocks) << 2).to_ne_bytes()
    }
}

/// The pass.
pub(crate) struct Blister {
    peel: Pipeline,
    within: Pipeline,
    meshes: Option<Meshes>,
    wait: Pipeline,
    turn: Pipeline,
    lock: Pipeline,
    show: Show,
}

/// The pipelines for meshes.
struct Meshes {
    peel: Pipeline,
    within: Pipeline,
}

/// The pipeline that draws the result among all other surfaces.
enum Show {
    /// As it was found.
    Found(Pipeline),
    /// With the owner found by the walk of pass `solid_events`.
    Owned(Pipeline),
}

/// Its buffers.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    pub rects: &'a Buffer,
    /// The leaf that each instance draws.
    pub order: &'a Buffer,
    pub counters: &'a Buffer,
    /// `None` without meshes.
    pub meshes: Option<MeshBindings<'a>>,
    /// Starts, leaves and entries of tiles; `None` with meshes, whose faces keep their found owner.
    pub tiles: Option<(&'a TexelBuffer, &'a TexelBuffer, &'a TexelBuffer)>,
}

/// Buffers of meshes.
#[derive(Clone, Copy)]
pub(crate) struct MeshBindings<'a> {
    pub views: &'a Buffer,
    pub meshes: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    /// The surface of each triangle that shares its plane.
    pub planes: &'a Buffer,
}

/// A layer, and the layer before it.
#[derive(Clone, Copy)]
pub(crate) struct Layer<'a> {
    pub before: &'a Image,
    pub image: &'a Image,
    pub found: &'a Image,
}

impl Blister {
    /// `surfaces`: the most general kind, `abi::SURFACE_*`; `meshes`: whether some operand is a mesh. `visibility` and
    /// `depth` are the formats of the images that show the result.
    pub(crate) fn new(
        device: &Device,
        (surfaces, meshes): (u32, bool),
        visibility: vk::Format,
        depth: vk::Format,
    ) -> Result<Self, GpuError> {
        let constants = [(constant::SOLIDS_HAVE, surfaces), (constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, 0)];
        let layer = [ColourTarget { format: LAYER_FORMAT, blend: Blend::Replace }];
        let seen = [ColourTarget { format: visibility, blend: Blend::Replace }];
        let nearest = DepthTest { format: LAYER_DEPTH_FORMAT, compare: vk::CompareOp::LESS, write: true };
        let among = DepthTest { format: depth, compare: vk::CompareOp::GREATER, write: true };
        let marks = |pass| Some(StencilTest { format: device.stencil_format(), pass });
        let (replaces, inverts) = (marks(vk::StencilOp::REPLACE), marks(vk::StencilOp::INVERT));
        let make = |name: &str, vertex, fragment: Option<&'static Shader>, colour: &[_], depth, stencil| {
            let name = format!("blister {name}");
            let draw = Draw::new(&name, vertex, fragment);
            Draw { constants: &constants, colour, depth, stencil, ..draw }.pipeline(device)
        };
        let (leaf, triangle) = (&shaders::SOLID_CST_VERT, &shaders::OPERAND_MESH_VERT);
        let peel = |name, vertex, fragment| make(name, vertex, Some(fragment), &layer, Some(nearest), None);
        let within = |name, vertex, fragment, stencil| make(name, vertex, Some(fragment), &[], None, stencil);
        let mesh_pipelines = |()| {
            Ok(Meshes {
                peel: peel("peel (meshes)", triangle, &shaders::BLISTER_PEEL_MESH_FRAG)?,
                within: within("within (meshes)", triangle, &shaders::BLISTER_WITHIN_MESH_FRAG, inverts)?,
            })
        };
        let everywhere = |name, fragment, colour: &[_], depth: Option<_>, stencil: Option<_>| {
            make(name, &shaders::RESOLVE_VERT, fragment, colour, depth, stencil)
        };
        let show = |name, fragment| everywhere(name, Some(fragment), &seen, Some(among), None);
        Ok(Self {
            peel: peel("peel", leaf, &shaders::BLISTER_PEEL_FRAG)?,
            within: within("within", leaf, &shaders::BLISTER_WITHIN_FRAG, replaces)?,
            meshes: meshes.then_some(()).map(mesh_pipelines).transpose()?,
            wait: everywhere("wait", Some(&shaders::BLISTER_WAIT_FRAG), &[], None, replaces)?,
            turn: everywhere("turn", None, &[], None, inverts)?,
            lock: everywhere("lock", Some(&shaders::BLISTER_LOCK_FRAG), &layer, None, replaces)?,
            show: match meshes {
                true => Show::Found(show("show", &shaders::BLISTER_SHOW_FRAG)?),
                false => Show::Owned(show("owner", &shaders::BLISTER_OWNER_FRAG)?),
            },
        })
    }

    /// Draws leaves of `order` and meshes, each as corners and the faces to peel, into a cleared layer.
    pub(crate) fn peel(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (layer, image, depth): (Layer<'_>, Attachment<'_>, Attachment<'_>),
        (leaves, peel): (Range<u32>, Peel),
        meshes: &[(u32, Range<u32>, Peel)],
    ) {
        cmd.rendering(image.image.size(), &[image], Some(depth), || {
            if !leaves.is_empty() {
                let mut resources: Vec<Resource<'_>> = b.of_leaves().collect();
                resources.extend([Resource::from(layer.before), layer.found.into()]);
                resources.extend([b.rects, b.order].map(Resource::from));
                cmd.bind(&self.peel, &resources, &peel.bits());
                cmd.draw_instances(0..6, leaves);
            }
            let Some((pipelines, m)) = self.meshes.as_ref().zip(b.meshes) else { return };
            let mut resources = b.of_meshes(m);
            resources.extend([Resource::from(layer.before), layer.found.into()]);
            for (n, (instance, corners, peel)) in meshes.iter().enumerate() {
                if n == 0 {
                    cmd.bind(&pipelines.peel, &resources, &peel.bits());
                } else {
                    cmd.push_constants(&pipelines.peel, &peel.bits());
                }
                cmd.draw_instances(corners.clone(), *instance..*instance + 1);
            }
        });
    }

    /// While rendering to the stencil image: sets label 0 in every pixel that is not locked. `nth` is the layer's
    /// number, from 1.
    pub(crate) fn wait(&self, cmd: &Commands<'_>, b: &Bindings<'_>, layer: &Image, nth: u32) {
        let resources = [b.frame.into(), b.counters.into(), layer.into()];
        cmd.bind(&self.wait, &resources, &nth.to_ne_bytes());
        cmd.stencil(0, LOCKED, PARITY | LABEL);
        cmd.draw(3, 0, 1);
    }

    /// Sets parity 1 in pixels with label `name` whose point is inside the leaf at `place` of the order.
    pub(crate) fn within(&self, cmd: &Commands<'_>, b: &Bindings<'_>, layer: &Image, place: u32, name: u32) {
        let mut resources: Vec<Resource<'_>> = b.of_leaves().collect();
        resources.push(layer.into());
        resources.extend([b.rects, b.order].map(Resource::from));
        cmd.bind(&self.within, &resources, &[]);
        cmd.stencil(PARITY | name, LOCKED | LABEL, PARITY);
        cmd.draw_instances(0..6, place..place + 1);
    }

    /// The same for meshes; each has an instance and its corners.
    pub(crate) fn within_meshes<'m>(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        layer: &Image,
        meshes: impl Iterator<Item = &'m (u32, Range<u32>)>,
        name: u32,
    ) {
        let Some((pipelines, m)) = self.meshes.as_ref().zip(b.meshes) else { return };
        let mut resources = b.of_meshes(m);
        resources.push(layer.into());
        cmd.bind(&pipelines.within, &resources, &[]);
        cmd.stencil(name, LOCKED | LABEL, PARITY);
        for (instance, corners) in meshes {
            cmd.draw_instances(corners.clone(), *instance..*instance + 1);
        }
    }

    /// Replaces label `name` by the next one.
    pub(crate) fn turn(&self, cmd: &Commands<'_>, name: u32, within: u32, without: u32) {
        cmd.bind(&self.turn, &[], &[]);
        // parity 0 first: afterwards, pixels that stay at `name` with parity 0 could not be distinguished from the
        // others
        for (parity, next) in [(0, without), (PARITY, within)] {
            let changes = name ^ next | parity;
            if changes != 0 {
                cmd.stencil(parity | name, PARITY | LOCKED | LABEL, changes);
                cmd.draw(3, 0, 1);
            }
        }
    }

    /// While rendering to `found` and the stencil image: locks the pixels that ended at label `end`.
    pub(crate) fn lock(&self, cmd: &Commands<'_>, layer: &Image, end: u32) {
        cmd.bind(&self.lock, &[layer.into()], &[]);
        // locked pixels also stay at their label, but the layer has no face there
        cmd.stencil(LOCKED | end, LABEL, LOCKED);
        cmd.draw(3, 0, 1);
    }

    /// Draws one triangle over the picture; nearer surfaces stay.
    pub(crate) fn show(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        found: &Image,
        (visibility, depth): (Attachment<'_>, Attachment<'_>),
    ) {
        let (pipeline, resources): (_, Vec<Resource<'_>>) = match (&self.show, b.tiles) {
            (Show::Owned(pipeline), Some((starts, leaves, entries))) => {
                // fragments: none
                let lists: [Resource<'_>; 3] = [starts.into(), leaves.into(), entries.into()];
                let fragments = [b.frame.into(), b.frame.into(), leaves.into()];
                let rest = [b.counters.into(), found.into()];
                (pipeline, b.of_leaves().chain(lists).chain(fragments).chain(rest).collect())
            }
            (Show::Found(pipeline), _) => (pipeline, vec![b.frame.into(), found.into()]),
            (Show::Owned(_), None) => unreachable!("tiles are made where there is no mesh"),
        };
        cmd.rendering(visibility.image.size(), &[visibility], Some(depth), || {
            cmd.bind(pipeline, &resources, &[]);
            cmd.draw(3, 0, 1);
        });
    }
}

impl Bindings<'_> {
    /// The first resources of the shaders for leaves.
    fn of_leaves(&self) -> impl Iterator<Item = Resource<'_>> {
        [self.frame.into()].into_iter().chain(self.primitives.resources())
    }

    /// The resources of the shaders for meshes, except the images.
    fn of_meshes<'b>(&'b self, m: MeshBindings<'b>) -> Vec<Resource<'b>> {
        let mesh = [m.views, m.meshes, m.triangles, m.positions];
        let sides = [self.primitives.surfaces, self.primitives.surface_places];
        let buffers = [self.frame].into_iter().chain(mesh).chain([m.planes]).map(Resource::from);
        buffers.chain(sides.map(Resource::from)).collect()
    }
}
