//! Where a driver departs from what Vulkan promises: each with its measurement and way around.

use ash::vk;

/// What passes must respect on this driver, beyond the device's limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quirks {
    /// Most vertices that the tessellator may make in one draw; `u32::MAX` when any number may.
    ///
    /// llvmpipe (Mesa 22.3.6 and 25.0.7) loses tessellated vertices beyond 65,536 in a draw without
    /// a word, and such a draw takes 10 to 45 s. Draws of 60,000 vertices and of 1,000 cover every
    /// pixel at the same speed, so the split costs nothing; 60,000 leaves room for rounding.
    pub max_tessellated_vertices_per_draw: u32,
}

impl Quirks {
    /// The quirks of a driver.
    pub fn of(driver: vk::DriverId) -> Self {
        let max_tessellated_vertices_per_draw = match driver {
            vk::DriverId::MESA_LLVMPIPE => 60_000,
            _ => u32::MAX,
        };
        Self { max_tessellated_vertices_per_draw }
    }
}
