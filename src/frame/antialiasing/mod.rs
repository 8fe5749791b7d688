//! Smooth pictures: several samples a pixel, or the borders of trimmed faces mixed.

pub(crate) mod average;
pub(crate) mod coverage;
pub(crate) mod samples;
pub(crate) mod smooth_trims;
