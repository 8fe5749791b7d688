//! Whether plain patches of one segment a side have a list of their own, and are drawn by their corners without
//! tessellation stages (`glsl/visibility/visibility_corners.vert`).

use super::SceneData;

/// Scenes with fewer patch instances do without the list: its pipeline would cost more than it saves. Of 262,144 patches
/// it saves a twentieth of a frame on lavapipe, of 1,048,576 more than half.
const FEWEST: usize = 1 << 17;

impl SceneData {
    /// The scene has the list. Operands of Boolean solids are drawn out of the list of plain patches
    /// (`frame/solids/operand_patch.rs`), so a scene with patches of operands has no other.
    pub(crate) fn draws_corners(&self) -> bool {
        let wanted = self.patch_instances.len() >= FEWEST;
        #[cfg(feature = "baselines")]
        let wanted = self.corners.unwrap_or(wanted);
        wanted && self.has_plain && !self.has_operands
    }
}
