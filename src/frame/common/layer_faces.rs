//! Which faces of what is seen through have lines: pass `solid_layers` makes an image of them, and pass `edge_change` looks
//! for changes in it.

use ash::vk;

/// The faces along each ray that an image has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Faces {
    /// The one of this number from the eye on; the nearest has 1.
    Nth(u32),
    /// The last one in front of what is opaque.
    Farthest,
}

/// Faces from the eye on that have lines, at most: each costs a walk of all rays and a search for changes. Of a ray
/// that meets more, the farthest one has lines, too.
pub(crate) const LINED_FACES: u32 = 8;

/// Format of the image of such faces: `glsl/include/layer_words.glsl`.
pub(crate) const FACES_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
