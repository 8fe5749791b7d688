//! Twin of the pass `reset`: empty draws and zero counters.

use super::emit::Draw;
use crate::abi::{Counters, Frame};

/// Draws of no vertex, list by list, and counters of zero.
pub fn reset(frame: &Frame) -> (Vec<Draw>, Counters) {
    let empty = Draw { vertex_count: 0, instance_count: 1, first_vertex: u32::MAX, first_instance: 0 };
    (vec![empty; (frame.patch_lists() * frame.draw_capacity) as usize], Counters::default())
}
