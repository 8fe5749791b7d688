//! The passes, one file each: a figure, the bindings in order, what is read and written, `new` and
//! `record`. A pass never allocates, submits or waits while recording, and never knows another pass;
//! the barriers between passes stand in `frame.rs`.

pub(crate) mod average;
pub(crate) mod blister;
pub(crate) mod bound;
pub(crate) mod carry;
pub(crate) mod coverage;
pub(crate) mod cross;
pub(crate) mod density;
pub(crate) mod emit;
pub(crate) mod farthest;
pub(crate) mod heal;
pub(crate) mod hide;
pub(crate) mod lines;
pub(crate) mod mesh;
pub(crate) mod operand_mesh;
pub(crate) mod operand_patch;
pub(crate) mod operand_sort;
pub(crate) mod reset;
pub(crate) mod resolve;
pub(crate) mod reveal;
#[cfg(feature = "rivals")]
pub(crate) mod rival_slefe;
#[cfg(feature = "rivals")]
pub(crate) mod rival_texture;
pub mod scan;
pub(crate) mod seen_squares;
pub(crate) mod segments;
pub(crate) mod sizes;
pub(crate) mod solid_blocks;
pub(crate) mod solid_cst;
pub(crate) mod solid_events;
pub(crate) mod solid_fold;
pub(crate) mod solid_layers;
pub(crate) mod solid_rects;
pub(crate) mod solid_squares;
pub(crate) mod solid_tiles;
pub(crate) mod sort;
pub(crate) mod split;
pub(crate) mod visibility;
