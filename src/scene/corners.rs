//! Whether patches of one segment a side have lists of their own, and are drawn by their corners without tessellation
//! stages (`glsl/visibility/visibility_corners.vert`).

use super::SceneData;

/// Scenes with fewer patch instances do without: the pipelines would cost more than they save. Of 262,144 plain patches
/// the list saves a twentieth of a frame on lavapipe, of 1,048,576 more than half.
const FEWEST: usize = 1 << 17;
/// The same of scenes with trimmed patches.
const FEWEST_TRIMMED: usize = 1 << 13;

impl SceneData {
    /// None, that of plain patches, or that of trimmed ones, too. Operands of Boolean solids are drawn out of the list of
    /// plain patches (`frame/solids/operand_patch.rs`), so a scene with patches of operands has no other.
    pub(crate) fn corner_lists(&self) -> u32 {
        let (plain, trimmed) = (self.has_plain, self.trim_way().is_some());
        let wanted = self.patch_instances.len() >= if trimmed { FEWEST_TRIMMED } else { FEWEST };
        #[cfg(feature = "baselines")]
        let wanted = self.corners.unwrap_or(wanted);
        match wanted && !self.has_operands {
            true if trimmed => 2,
            true => u32::from(plain),
            false => 0,
        }
    }
}
