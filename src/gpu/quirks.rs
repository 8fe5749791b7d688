//! Faults of drivers, each with its cause and workaround.

use ash::vk;

/// Restrictions that passes must respect on this driver, in addition to the device's limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quirks {
    /// Most vertices that the tessellator may make in one draw; `u32::MAX` for no limit.
    ///
    /// llvmpipe (Mesa 22.3.6 and 25.0.7) silently loses tessellated vertices beyond 65,536 in a draw, and such a draw
    /// takes many seconds.
    ///
    /// If a vertex of a draw lies far outside the picture, llvmpipe sends the whole draw through its clipper. The
    /// clipper visits every vertex of the draw each time its output is full, so the time grows with the square of their
    /// number (Mesa 22.3.6, `draw_reset_vertex_ids`). Draws with few vertices avoid this.
    pub max_tessellated_vertices_per_draw: u32,
    /// Whether the driver compiles a shader again for another size of a texel buffer.
    ///
    /// llvmpipe's key of a compiled shader (Mesa 22.3.6 to 25, `lp_sampler_static_texture_state`) contains, for each
    /// texture, whether its width is a power of two and whether it has only one level. For a texel buffer the first is
    /// the buffer's size, the second bits 8 to 15 of the view's size. So a buffer that grows makes every shader that
    /// reads it compile again, which takes seconds, and a disk cache misses it.
    sized_texel_buffers: bool,
}

impl Quirks {
    /// The quirks of a driver.
    pub fn of(driver: vk::DriverId) -> Self {
        let llvmpipe = driver == vk::DriverId::MESA_LLVMPIPE;
        let max_tessellated_vertices_per_draw = if llvmpipe { 8_000 } else { u32::MAX };
        Self { max_tessellated_vertices_per_draw, sized_texel_buffers: llvmpipe }
    }

    /// Size of a texel buffer for `bytes`, a multiple of 16: at most 272 bytes more, so that the driver's key is the
    /// same for all sizes.
    pub fn texel_buffer_bytes(self, bytes: u64) -> u64 {
        if !self.sized_texel_buffers {
            return bytes;
        }
        let levels = if bytes % 0x1_0000 < 0x100 { bytes + 0x100 - bytes % 0x100 } else { bytes };
        if levels.is_power_of_two() { levels + 16 } else { levels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texel_buffers_of_all_sizes_are_alike() {
        let (llvmpipe, other) = (Quirks::of(vk::DriverId::MESA_LLVMPIPE), Quirks::of(vk::DriverId::NVIDIA_PROPRIETARY));
        for bytes in (16..0x4_0000).step_by(16) {
            let made = llvmpipe.texel_buffer_bytes(bytes);
            assert!(!made.is_power_of_two() && made & 0xff00 != 0 && made % 16 == 0, "{bytes}: {made}");
            assert!((bytes..=bytes + 272).contains(&made), "{bytes}: {made}");
            assert_eq!(other.texel_buffer_bytes(bytes), bytes);
        }
    }
}
