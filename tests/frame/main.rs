//! The whole frame on a real driver with the validation layers: no messages, repeatable, as exact as promised, and only
//! with the resources that its scene needs.
//!
//! Needs a Vulkan driver and the validation layers; on Debian: `apt install libvulkan1
//! mesa-vulkan-drivers vulkan-validationlayers`. Without them these tests fail and say so.

mod accuracy;
mod ambient;
mod bands;
mod borders;
#[path = "../shapes/cages.rs"]
mod cages;
mod ceilings;
mod clear_lines;
mod closed;
mod cuts;
mod distance;
mod edge_lines;
mod edges;
mod errors;
mod every_shape;
mod fold_lines;
mod gap_bands;
mod hard;
mod hard_solids;
mod hard_trims;
mod hard_views;
mod hidden;
mod hidden_lines;
mod hidden_parts;
mod in_sight;
mod layer_lines;
mod layers;
mod ledges;
mod left_out;
mod lengths;
mod light;
mod living;
mod look;
mod many_draws;
mod mesh_lines;
mod meshes;
mod met_lines;
mod models;
mod narrow;
mod objects;
mod off_centre;
mod operands;
mod picks;
mod pieces;
mod poles;
mod real_solids;
mod regular;
mod reuse;
mod room;
mod samples;
mod sequence;
mod shadows;
#[path = "../shapes/mod.rs"]
mod shapes;
mod slivers;
mod smooth;
mod smooth_borders;
mod smooth_trims;
mod solid_lines;
mod solids;
mod stair;
mod support;
mod tolerance;
mod touching;
#[path = "../shapes/trims.rs"]
mod trims;
mod turned;
#[path = "../watched/mod.rs"]
mod watched;
mod within;
mod zoom;
