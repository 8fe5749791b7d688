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
}

impl Quirks {
    /// The quirks of a driver.
    pub fn of(driver: vk::DriverId) -> Self {
        let max_tessellated_vertices_per_draw = match driver {
            vk::DriverId::MESA_LLVMPIPE => 8_000,
            _ => u32::MAX,
        };
        Self { max_tessellated_vertices_per_draw }
    }
}
