//! Smooth pictures: several samples a pixel, the borders of trimmed faces mixed, or those of all that is seen.

pub(crate) mod average;
pub(crate) mod border_follow;
pub(crate) mod border_mean;
pub(crate) mod border_mesh;
pub(crate) mod border_mix;
pub(crate) mod border_solid;
mod capacities;
pub(crate) mod coverage;
pub(crate) mod samples;
pub(crate) mod smooth_borders;
pub(crate) mod smooth_trims;

pub(crate) use capacities::Capacities;
