//! The lists that passes `line_list`, `seed_list` and `fold_list` write, and `edge_line` and `edge_fold` look at.

use super::room::Room;
use crate::abi::LineList;
use crate::abi::constants::line_list::{FOUND_WORDS, LINE_ITEM_WORDS};
use crate::gpu::{Buffer, Commands, GpuError};
use std::mem::offset_of;

/// A list of pixels, and of folds that were found from there.
pub(crate) struct LineItems {
    /// [`LineList`], items, folds.
    pub buffer: Buffer,
    /// Items that there is room for.
    pub capacity: u32,
}

/// Bytes of an item, with those of a fold that it may find.
pub(crate) const fn item_bytes(finds: bool) -> usize {
    size_of::<u32>() * (LINE_ITEM_WORDS + if finds { FOUND_WORDS } else { 0 }) as usize
}

impl LineItems {
    pub(crate) fn new(room: &Room<'_>, name: &str, capacity: u32, finds: bool) -> Result<Self, GpuError> {
        let words = (size_of::<LineList>() + capacity as usize * item_bytes(finds)) / size_of::<u32>();
        Ok(Self { buffer: room.indirect::<u32>(name, words as u32)?, capacity })
    }

    /// Before each drawing.
    pub(crate) fn clear(&self, cmd: &Commands<'_>) {
        cmd.fill_first(&self.buffer, (size_of::<LineList>() / size_of::<u32>()) as u64, 0);
    }

    /// The arguments of a thread an item.
    pub(crate) fn of_items(&self) -> (&Buffer, u64) {
        (&self.buffer, offset_of!(LineList, grid) as u64)
    }

    /// The arguments of a thread a fold.
    pub(crate) fn of_found(&self) -> (&Buffer, u64) {
        (&self.buffer, offset_of!(LineList, found_grid) as u64)
    }
}
