//! Smooth pictures: several samples a pixel, the borders of trimmed faces mixed, or those of all that is seen.

pub(crate) mod average;
pub(crate) mod border_mean;
pub(crate) mod border_mesh;
pub(crate) mod border_mix;
pub(crate) mod border_solid;
pub(crate) mod coverage;
pub(crate) mod samples;
pub(crate) mod smooth_borders;
pub(crate) mod smooth_trims;
