//! Passes `border_follow` and `border_followed`: points of pixels at borders where a sheet's terms of second order do not
//! reach.
//!
//! ```text
//!   border_mix ──▶ points ──border_follow──▶ what they show ──border_followed──▶ means of their pixels
//!                                                           └───────────────────▶ seen: border_mesh, border_solid,
//!        ╭──╮                                                                     border_mean go on from there
//!    ○───┤  │   Newton's method on the exact surface, from a pixel ○ around that sees the face to the point's ray ·,
//!        │ ·│   from patch to patch
//!        ╰──╯
//! ```
//!
//! Reads: everything that the bindings name. Writes: `follow`: `followed.points`, or `seen`; `mix`: the means of `list`, at
//! pixels of `followed.pixels`.
//!
//! A point is one thread's, which compares its sheets in the order in which pass `border_mix` found them. So the order of
//! the list, in which threads race for places, changes nothing.

use crate::bindings::{Placed, Primitives};
use crate::frame::common::border_list::{FollowedBindings, ListBindings};
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource};
use crate::shaders::{self, BORDERS_PLAIN, TrimTest, constant};

/// What scenes differ in.
#[derive(Clone, Copy)]
pub(crate) struct Kinds<'a> {
    /// How faces are trimmed; `None` where none is.
    pub test: Option<&'a TrimTest>,
    pub rational: bool,
    pub fine: bool,
    /// The scene has things that are no patches.
    pub meshes_and_solids: bool,
    /// Most general kind of surface of the volume that trims the scene.
    pub volume: Option<u32>,
}

/// The passes.
pub(crate) struct BorderFollow {
    follow: Kernel,
    /// Of scenes without meshes and Boolean solids.
    mix: Option<Kernel>,
}

/// Their buffers and images.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub visibility: &'a Image,
    /// Linear colour and depth.
    pub resolved: &'a Image,
    pub list: ListBindings<'a>,
    pub followed: FollowedBindings<'a>,
    /// What all points see, in scenes with meshes or Boolean solids.
    pub seen: Option<&'a Buffer>,
    /// What the trim test reads, in its order.
    pub trim: &'a [Resource<'a>],
    /// The volume that trims the scene; `None` where there is none.
    pub volume: Option<Primitives<'a>>,
}

impl BorderFollow {
    /// `None` where the way to trim smooths no borders.
    pub(crate) fn new(device: &Device, kinds: Kinds<'_>) -> Result<Option<Self>, GpuError> {
        let Some(of_way) = kinds.test.map_or(Some(BORDERS_PLAIN), |test| test.borders) else { return Ok(None) };
        let [alone, within] = of_way.follow;
        let own = [
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, u32::from(kinds.meshes_and_solids)),
            (constant::SCENE_HAS_RATIONAL, u32::from(kinds.rational)),
            (constant::SCENE_HAS_FINE, u32::from(kinds.fine)),
        ];
        let of_volume = kinds.volume.map(|kind| (constant::SOLIDS_HAVE, kind));
        let constants: Vec<_> = own.into_iter().chain(of_volume).collect();
        let way = kinds.test.map_or("no trims", |test| test.way);
        let (volume, shader) = if kinds.volume.is_some() { (", within a volume", within) } else { ("", alone) };
        let mix = || Kernel::new(device, "border followed", &shaders::BORDER_FOLLOWED_COMP, &[]);
        Ok(Some(Self {
            follow: Kernel::new(device, &format!("border follow ({way}{volume})"), shader, &constants)?,
            mix: (!kinds.meshes_and_solids).then(mix).transpose()?,
        }))
    }

    /// One thread a point.
    pub(crate) fn follow(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        // the shader has what points see in every scene, and writes it only where it is kept
        let seen = b.seen.unwrap_or(b.list.pixels);
        let placed = [b.frame.into()].into_iter().chain(b.placed.resources());
        let lists = [b.list.pixels, b.followed.points, b.followed.grids, seen].map(Resource::from);
        let volume = b.volume.iter().flat_map(Primitives::resources);
        let own = [b.visibility.into()].into_iter().chain(lists);
        let resources: Vec<_> = placed.chain(own).chain(b.trim.iter().copied()).chain(volume).collect();
        self.follow.record_indirect(cmd, &resources, b.followed.of_points());
    }

    /// One thread a pixel whose mean waits for its points; nothing in scenes with meshes or Boolean solids.
    pub(crate) fn mix(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let (Some(mix), Some(pixels)) = (&self.mix, b.followed.pixels) else { return };
        let lists = [b.list.pixels, b.followed.points, pixels, b.followed.grids].map(Resource::from);
        let resources: Vec<_> = [b.frame.into(), b.resolved.into()].into_iter().chain(lists).collect();
        mix.record_indirect(cmd, &resources, b.followed.of_pixels());
    }
}
