//! Which faces of what is seen through have lines: pass `solid_layers` makes an image of them, and pass `edge_change` looks
//! for changes in it.

use ash::vk;

/// The faces of what is seen through whose lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Faces {
    Nearest,
    /// In front of what is opaque.
    Farthest,
}

/// Format of the image of such faces: `glsl/include/layer_words.glsl`.
pub(crate) const FACES_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
