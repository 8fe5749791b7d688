//! How finely each patch is divided, and the sub-patches and draws that follow.

pub(crate) mod bound;
pub(crate) mod divide;
pub(crate) mod emit;
pub(crate) mod split;
