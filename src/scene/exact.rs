//! The arrays of the exact way: those of all faces, one face after another.

use super::edit::{EditTarget, Write};
use super::face::Domain;
use crate::abi;
use crate::model::TrimLoop;
use crate::trim::{Cell, Entry, ExactTrim};
use bytemuck::Pod;

/// One face's loops; if trims are smoothed, with the data of pass `coverage`.
pub(super) fn exact_trim(loops: &[TrimLoop], domain: &Domain, smooth: bool) -> ExactTrim {
    let make = if smooth { ExactTrim::with_flats } else { ExactTrim::new };
    make(loops, domain.origin, domain.size)
}

/// See [`ExactTrim`]. Indices count from the beginning of the scene's arrays.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExactData {
    /// One for each face of the scene; a face without trims has no cells.
    pub faces: Vec<abi::ExactFace>,
    pub cells: Vec<abi::ExactCell>,
    /// Lists of arcs.
    pub arcs: Vec<abi::ExactArc>,
}

/// The place of a face's arrays.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ExactPlace {
    face: u32,
    /// Its first cell and first arc.
    first: [usize; 2],
    /// Most cells and most arcs that fit.
    room: [usize; 2],
}

impl ExactData {
    /// Adds the next face. An editable face gets room for more arcs than it has: see [`ExactPlace::writes`].
    pub(crate) fn push(&mut self, trim: &ExactTrim, editable: bool) -> ExactPlace {
        let mut place = ExactPlace { face: self.faces.len() as u32, first: self.lengths(), room: [0; 2] };
        let own = Self::of(trim, &place);
        self.faces.extend(&own.faces);
        self.cells.extend(&own.cells);
        self.arcs.extend(&own.arcs);
        place.room = own.lengths();
        if editable {
            place.room = place.room.map(|length| 2 * length + SPARE);
            let [cells, arcs] = std::array::from_fn(|i| place.first[i] + place.room[i]);
            self.cells.resize(cells, Default::default());
            self.arcs.resize(arcs, Default::default());
        }
        place
    }

    /// The arrays of one face.
    pub(super) fn of(trim: &ExactTrim, place: &ExactPlace) -> Self {
        let [first_cell, first_arc] = place.first.map(|first| first as u32);
        let pair = |[low, high]: [u32; 2]| low | high << 16;
        let face = abi::ExactFace {
            first_cell,
            first: pair(trim.grid.first.map(|x| u32::from(x as u16))),
            counts: pair(trim.grid.counts.map(u32::from)),
            bits: pair(trim.grid.bits),
        };
        let cell = |cell: &Cell| match *cell {
            Cell::Whole { first, winding } => abi::ExactCell { first: first_arc + first, winding },
            Cell::Split { first, halvings } => {
                abi::ExactCell { first: (first_cell + first) | abi::CELL_SPLIT, winding: halvings as i32 }
            }
        };
        let arc = |entry: &Entry| {
            let last = if entry.last { abi::ARC_LAST } else { 0 };
            let Some(number) = entry.arc else { return abi::ExactArc { shape: last, ..Default::default() } };
            let arc = &trim.arcs[number as usize];
            let up = if arc.up { abi::ARC_UP } else { 0 };
            abi::ExactArc {
                low: arc.low,
                high: arc.high,
                corner: arc.corner,
                fullness: arc.fullness,
                shape: entry.flags | up | last,
            }
        };
        Self {
            faces: vec![face],
            cells: trim.cells.iter().map(cell).collect(),
            arcs: trim.entries.iter().map(arc).collect(),
        }
    }

    fn lengths(&self) -> [usize; 2] {
        [self.cells.len(), self.arcs.len()]
    }

    /// The arrays' bytes, in the order of [`EditTarget::Exact`].
    pub(super) fn bytes_mut(&mut self, array: usize) -> &mut [u8] {
        match array {
            0 => bytemuck::cast_slice_mut(&mut self.faces),
            1 => bytemuck::cast_slice_mut(&mut self.cells),
            _ => bytemuck::cast_slice_mut(&mut self.arcs),
        }
    }
}

/// Elements by which an array may grow beyond twice its length. A loop that an edit turns may split into twice as many
/// arcs.
const SPARE: usize = 4096;

impl ExactPlace {
    /// The writes that replace `old` by `new`: the elements that differ. `None` if `new` does not fit.
    pub(super) fn writes(&self, old: &ExactData, new: &ExactData) -> Option<Vec<Write>> {
        if new.lengths().iter().zip(self.room).any(|(length, room)| *length > room) {
            return None;
        }
        let writes = [
            changed(0, self.face as usize, &old.faces, &new.faces),
            changed(1, self.first[0], &old.cells, &new.cells),
            changed(2, self.first[1], &old.arcs, &new.arcs),
        ];
        Some(writes.into_iter().filter(|write| !write.bytes.is_empty()).collect())
    }
}

/// From the first element that differs to the last.
fn changed<T: Pod + PartialEq>(array: usize, first: usize, old: &[T], new: &[T]) -> Write {
    let same = |(a, b): &(&T, &T)| a == b;
    let begin = old.iter().zip(new).take_while(same).count();
    let behind =
        if old.len() == new.len() { old.iter().rev().zip(new.iter().rev()).take_while(same).count() } else { 0 };
    let end = (new.len() - behind.min(new.len())).max(begin);
    Write {
        to: EditTarget::Exact(array),
        offset: ((first + begin) * size_of::<T>()) as u64,
        bytes: bytemuck::cast_slice(&new[begin..end]).to_vec(),
    }
}
