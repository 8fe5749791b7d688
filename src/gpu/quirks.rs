//! Where a driver departs from what Vulkan promises: each with its measurement and way around.

use ash::vk;

/// What passes must respect on this driver, beyond the device's limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quirks {
    /// Most vertices that the tessellator may make in one draw; `u32::MAX` when any number may.
    ///
    /// llvmpipe (Mesa 22.3.6 and 25.0.7) loses tessellated vertices beyond 65,536 in a draw without
    /// a word, and such a draw takes 10 to 45 s.
    ///
    /// Once a vertex of a draw lies far outside of the picture, it takes all of the draw through its clipper, which visits
    /// every vertex of the draw again each time that its output is full: the time grows with the square of their number
    /// (Mesa 22.3.6, `draw_reset_vertex_ids`). Pass `visibility` of m6_countersunk_screw, ten times closer in a
    /// picture of 1920 x 1080, takes 330 ms with draws of 60,000 vertices, 144 of 20,000, 118 of 12,000, 107 of 8,000 and
    /// 95 of 5,000; of axom_boxed_sphere 260, 120, 117, 100 and 100. Where nothing is clipped the number does not matter.
    pub max_tessellated_vertices_per_draw: u32,
    /// Whether the size of a texel buffer is part of what the driver compiles a shader for.
    ///
    /// llvmpipe's key of a compiled shader (Mesa 22.3.6 to 25, `lp_sampler_static_texture_state`) asks of each texture
    /// whether its width is a power of two and whether it has one level alone. Of a texel buffer the first is the
    /// buffer's size, the second bits 8 to 15 of the view's size: so a buffer that grows makes every shader that reads
    /// it compile again, and a disk cache misses it. The gap filler takes 4 s a time.
    sized_texel_buffers: bool,
}

impl Quirks {
    /// The quirks of a driver.
    pub fn of(driver: vk::DriverId) -> Self {
        let llvmpipe = driver == vk::DriverId::MESA_LLVMPIPE;
        let max_tessellated_vertices_per_draw = if llvmpipe { 8_000 } else { u32::MAX };
        Self { max_tessellated_vertices_per_draw, sized_texel_buffers: llvmpipe }
    }

    /// Size of a texel buffer that holds `bytes`, a multiple of 16: at most 272 bytes more, so that all sizes are alike
    /// to the driver.
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
