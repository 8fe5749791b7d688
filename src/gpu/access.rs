//! Named accesses: what a command does to a buffer or image, as stages, access mask and layout.

use ash::vk;
use std::ops::BitOr;
use vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// One side of a barrier. Buffers ignore the layout.
///
/// Shader accesses keep an image in `GENERAL`; attachments and copies use their own layouts.
/// Accesses of one layout combine by `|`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Pipeline stages that touch the resource.
    pub stages: S,
    /// How they touch it.
    pub mask: A,
    /// Layout that an image is in meanwhile.
    pub layout: L,
}

const SHADER_WRITE: A = A::from_raw(A::SHADER_STORAGE_READ.as_raw() | A::SHADER_STORAGE_WRITE.as_raw());
const SHADER_READ: A = A::from_raw(A::SHADER_STORAGE_READ.as_raw() | A::SHADER_SAMPLED_READ.as_raw());
const GEOMETRY: S = S::from_raw(
    S::VERTEX_SHADER.as_raw() | S::TESSELLATION_CONTROL_SHADER.as_raw() | S::TESSELLATION_EVALUATION_SHADER.as_raw(),
);
const DEPTH: S = S::from_raw(S::EARLY_FRAGMENT_TESTS.as_raw() | S::LATE_FRAGMENT_TESTS.as_raw());

impl Access {
    /// Nothing happened before: the first use of a new resource.
    pub const NONE: Self = Self::new(S::NONE, A::NONE, L::UNDEFINED);
    /// A compute shader reads a storage buffer, or an image by `imageLoad` or a sampler.
    pub const COMPUTE_READ: Self = Self::new(S::COMPUTE_SHADER, SHADER_READ, L::GENERAL);
    /// A compute shader writes, or reads and writes, a storage buffer or image; atomics too.
    pub const COMPUTE_WRITE: Self = Self::new(S::COMPUTE_SHADER, SHADER_WRITE, L::GENERAL);
    /// A shader of any kind reads a uniform buffer.
    pub const UNIFORM_READ: Self = Self::new(
        S::from_raw(S::COMPUTE_SHADER.as_raw() | GEOMETRY.as_raw() | S::FRAGMENT_SHADER.as_raw()),
        A::UNIFORM_READ,
        L::GENERAL,
    );
    /// Arguments or the count of an indirect dispatch or draw.
    pub const INDIRECT_READ: Self = Self::new(S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ, L::GENERAL);
    /// A vertex or tessellation shader reads a storage buffer or samples an image.
    pub const VERTEX_READ: Self = Self::new(GEOMETRY, SHADER_READ, L::GENERAL);
    /// A fragment shader reads a storage buffer, or an image by `imageLoad` or a sampler.
    pub const FRAGMENT_READ: Self = Self::new(S::FRAGMENT_SHADER, SHADER_READ, L::GENERAL);
    /// A fragment shader writes, or reads and writes, a storage buffer or image; atomics too.
    pub const FRAGMENT_WRITE: Self = Self::new(S::FRAGMENT_SHADER, SHADER_WRITE, L::GENERAL);
    /// Colour attachment: cleared, written, blended.
    pub const COLOUR_WRITE: Self = Self::new(
        S::COLOR_ATTACHMENT_OUTPUT,
        A::from_raw(A::COLOR_ATTACHMENT_READ.as_raw() | A::COLOR_ATTACHMENT_WRITE.as_raw()),
        L::COLOR_ATTACHMENT_OPTIMAL,
    );
    /// Depth (and stencil) attachment: cleared, tested, written.
    pub const DEPTH_WRITE: Self = Self::new(
        DEPTH,
        A::from_raw(A::DEPTH_STENCIL_ATTACHMENT_READ.as_raw() | A::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()),
        L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
    );
    /// Source of a copy.
    pub const TRANSFER_READ: Self = Self::new(S::ALL_TRANSFER, A::TRANSFER_READ, L::TRANSFER_SRC_OPTIMAL);
    /// Target of a copy, a fill or a clear.
    pub const TRANSFER_WRITE: Self = Self::new(S::ALL_TRANSFER, A::TRANSFER_WRITE, L::TRANSFER_DST_OPTIMAL);
    /// The CPU reads mapped memory after the fence.
    pub const HOST_READ: Self = Self::new(S::HOST, A::HOST_READ, L::GENERAL);

    /// An access of one's own, for a host's images.
    pub const fn new(stages: S, mask: A, layout: L) -> Self {
        Self { stages, mask, layout }
    }

    /// The same uses, but the contents of the image may be thrown away: what comes before a pass
    /// that overwrites all of it.
    pub const fn discarded(self) -> Self {
        Self { layout: L::UNDEFINED, ..self }
    }
}

impl BitOr for Access {
    type Output = Self;

    /// Both accesses.
    ///
    /// # Panics
    /// When their layouts differ: an image is in one layout at a time.
    fn bitor(self, other: Self) -> Self {
        assert!(self.layout == other.layout, "{:?} and {:?} are not one access", self.layout, other.layout);
        Self { stages: self.stages | other.stages, mask: self.mask | other.mask, layout: self.layout }
    }
}
