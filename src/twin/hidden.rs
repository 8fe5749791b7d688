//! Twin of the passes [`hide`, `farthest` and `reveal`](crate::passes).

/// Bit of a patch's taus: it is not drawn now.
pub const TAU_HIDDEN: u32 = 0x8000;

/// Whether a patch with these taus is drawn now.
pub fn is_drawn(tau: u32) -> bool {
    tau != 0 && tau & TAU_HIDDEN == 0
}
