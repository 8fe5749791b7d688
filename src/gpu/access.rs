//! Named accesses: what a command does to a buffer or image, as stages and access mask, and the layouts of images.

use ash::vk;
use std::ops::BitOr;
use vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// One side of a barrier. Accesses combine by `|`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Pipeline stages that touch the resource.
    pub stages: S,
    /// How they touch it.
    pub mask: A,
}

/// One side of a barrier of an image. Every [`Access`] is one in its own layout: shader accesses keep an image in
/// `GENERAL`, attachments and copies use theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageAccess {
    /// The stages and accesses.
    pub access: Access,
    /// Its layout during the access.
    pub layout: L,
}

const SHADER_WRITE: A = A::from_raw(A::SHADER_STORAGE_READ.as_raw() | A::SHADER_STORAGE_WRITE.as_raw());
const SHADER_READ: A = A::from_raw(A::SHADER_STORAGE_READ.as_raw() | A::SHADER_SAMPLED_READ.as_raw());
const GEOMETRY: S = S::from_raw(
    S::VERTEX_SHADER.as_raw() | S::TESSELLATION_CONTROL_SHADER.as_raw() | S::TESSELLATION_EVALUATION_SHADER.as_raw(),
);
const DEPTH: S = S::from_raw(S::EARLY_FRAGMENT_TESTS.as_raw() | S::LATE_FRAGMENT_TESTS.as_raw());

impl Access {
    /// No access: before the first use of a new resource.
    pub const NONE: Self = Self::new(S::NONE, A::NONE);
    /// A compute shader reads a storage buffer, or an image by `imageLoad` or a sampler.
    pub const COMPUTE_READ: Self = Self::new(S::COMPUTE_SHADER, SHADER_READ);
    /// A compute shader writes, or reads and writes, a storage buffer or image; atomics too.
    pub const COMPUTE_WRITE: Self = Self::new(S::COMPUTE_SHADER, SHADER_WRITE);
    /// A shader of any kind reads a uniform buffer.
    pub const UNIFORM_READ: Self = Self::new(
        S::from_raw(S::COMPUTE_SHADER.as_raw() | GEOMETRY.as_raw() | S::FRAGMENT_SHADER.as_raw()),
        A::UNIFORM_READ,
    );
    /// Arguments or the count of an indirect dispatch or draw.
    pub const INDIRECT_READ: Self = Self::new(S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ);
    /// A vertex or tessellation shader reads a storage buffer or samples an image.
    pub const VERTEX_READ: Self = Self::new(GEOMETRY, SHADER_READ);
    /// A fragment shader reads a storage buffer, or an image by `imageLoad` or a sampler.
    pub const FRAGMENT_READ: Self = Self::new(S::FRAGMENT_SHADER, SHADER_READ);
    /// A fragment shader writes, or reads and writes, a storage buffer or image; atomics too.
    pub const FRAGMENT_WRITE: Self = Self::new(S::FRAGMENT_SHADER, SHADER_WRITE);
    /// Colour attachment: cleared, written, blended.
    pub const COLOUR_WRITE: Self = Self::new(
        S::COLOR_ATTACHMENT_OUTPUT,
        A::from_raw(A::COLOR_ATTACHMENT_READ.as_raw() | A::COLOR_ATTACHMENT_WRITE.as_raw()),
    );
    /// Depth (and stencil) attachment: cleared, tested, written.
    pub const DEPTH_WRITE: Self = Self::new(
        DEPTH,
        A::from_raw(A::DEPTH_STENCIL_ATTACHMENT_READ.as_raw() | A::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()),
    );
    /// Source of a copy.
    pub const TRANSFER_READ: Self = Self::new(S::ALL_TRANSFER, A::TRANSFER_READ);
    /// Target of a copy, a fill or a clear.
    pub const TRANSFER_WRITE: Self = Self::new(S::ALL_TRANSFER, A::TRANSFER_WRITE);
    /// The CPU reads mapped memory after the fence.
    pub const HOST_READ: Self = Self::new(S::HOST, A::HOST_READ);

    /// Any other access, for a host's own commands.
    pub const fn new(stages: S, mask: A) -> Self {
        Self { stages, mask }
    }

    /// The same uses, but the image's contents may be lost: before a pass that overwrites all of it.
    pub const fn discarded(self) -> ImageAccess {
        ImageAccess { access: self, layout: L::UNDEFINED }
    }

    /// The layout of an image for this access; `None` if there is no single one.
    fn layout(self) -> Option<L> {
        let own = [
            (A::NONE, L::UNDEFINED),
            (Self::COLOUR_WRITE.mask, L::COLOR_ATTACHMENT_OPTIMAL),
            (Self::DEPTH_WRITE.mask, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
            (Self::TRANSFER_READ.mask, L::TRANSFER_SRC_OPTIMAL),
            (Self::TRANSFER_WRITE.mask, L::TRANSFER_DST_OPTIMAL),
        ];
        let all = own.iter().fold(A::NONE, |all, (mask, _)| all | *mask);
        let found = own.iter().find(|(mask, _)| mask.contains(self.mask)).map(|(_, layout)| *layout);
        found.or((self.mask & all == A::NONE).then_some(L::GENERAL))
    }
}

impl From<Access> for ImageAccess {
    /// # Panics
    /// If its parts need different layouts: an image is in one layout at a time.
    fn from(access: Access) -> Self {
        let layout = access.layout();
        Self { access, layout: layout.unwrap_or_else(|| panic!("{access:?} is not one access of an image")) }
    }
}

impl BitOr for Access {
    type Output = Self;

    /// Both accesses.
    fn bitor(self, other: Self) -> Self {
        Self { stages: self.stages | other.stages, mask: self.mask | other.mask }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_access_of_an_image_has_one_layout() {
        let layout = |access: Access| ImageAccess::from(access).layout;
        assert_eq!(layout(Access::NONE), L::UNDEFINED);
        assert_eq!(layout(Access::COLOUR_WRITE), L::COLOR_ATTACHMENT_OPTIMAL);
        assert_eq!(layout(Access::DEPTH_WRITE), L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        assert_eq!(layout(Access::TRANSFER_READ), L::TRANSFER_SRC_OPTIMAL);
        assert_eq!(layout(Access::TRANSFER_WRITE), L::TRANSFER_DST_OPTIMAL);
        assert_eq!(layout(Access::COMPUTE_WRITE | Access::FRAGMENT_READ), L::GENERAL);
        assert_eq!(Access::COLOUR_WRITE.discarded().layout, L::UNDEFINED);
    }

    #[test]
    #[should_panic(expected = "is not one access of an image")]
    fn two_layouts_are_told() {
        let _ = ImageAccess::from(Access::COMPUTE_READ | Access::TRANSFER_READ);
    }
}
