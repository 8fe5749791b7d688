//! Smooth pictures: several samples a pixel, the borders of trimmed faces mixed, or those of all faces.

pub(crate) mod average;
pub(crate) mod border_mix;
pub(crate) mod coverage;
pub(crate) mod samples;
pub(crate) mod smooth_borders;
pub(crate) mod smooth_trims;
