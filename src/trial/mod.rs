//! Scenes without a GPU, for tests and measurements: a [`Case`] as the passes' twins get it, and a [`Trial`] of how far
//! the triangulation of one patch is from the patch.

mod case;
mod patch;

pub(crate) use crate::math::random::Random;
pub(crate) use case::Case;
pub(crate) use patch::{Deviation, Emit, Kind, Trial};
