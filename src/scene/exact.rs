//! The exact way's arrays: those of every face behind each other.

use super::edit::{EditTarget, Write};
use super::face::Domain;
use crate::abi;
use crate::model::TrimLoop;
use crate::trim::ExactTrim;
use bytemuck::Pod;

/// One face's loops; where trims are smoothed, with what pass `coverage` needs.
pub(super) fn exact_trim(loops: &[TrimLoop], domain: &Domain, smooth: bool) -> ExactTrim {
    let make = if smooth { ExactTrim::with_flats } else { ExactTrim::new };
    make(loops, domain.origin, domain.size)
}

/// See [`ExactTrim`]; numbers count from the beginning of the scene's arrays.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExactData {
    /// One a face of the scene; without bands where nothing is trimmed.
    pub faces: Vec<abi::ExactFace>,
    pub bands: Vec<abi::ExactBand>,
    pub cells: Vec<abi::ExactCell>,
    pub entries: Vec<u32>,
    pub arcs: Vec<abi::ExactArc>,
    pub points: Vec<f32>,
}

/// Where a face's arrays are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ExactPlace {
    face: u32,
    /// First band, cell, entry, arc, float of a point.
    first: [usize; 5],
    /// Elements that each has room for.
    room: [usize; 5],
}

impl ExactData {
    /// Adds the next face. One that may be edited gets room for more arcs than it has: see [`ExactPlace::writes`].
    pub(crate) fn push(&mut self, trim: &ExactTrim, editable: bool) -> ExactPlace {
        let mut place = ExactPlace { face: self.faces.len() as u32, first: self.lengths(), room: [0; 5] };
        let own = Self::of(trim, &place);
        self.faces.extend(&own.faces);
        self.bands.extend(&own.bands);
        self.cells.extend(&own.cells);
        self.entries.extend(&own.entries);
        self.arcs.extend(&own.arcs);
        self.points.extend(&own.points);
        place.room = own.lengths();
        if editable {
            place.room = place.room.map(|length| 2 * length + SPARE);
            let [bands, cells, entries, arcs, points] = std::array::from_fn(|i| place.first[i] + place.room[i]);
            self.bands.resize(bands, Default::default());
            self.cells.resize(cells, Default::default());
            self.entries.resize(entries, 0);
            self.arcs.resize(arcs, Default::default());
            self.points.resize(points, 0.0);
        }
        place
    }

    /// The arrays of one face.
    pub(super) fn of(trim: &ExactTrim, place: &ExactPlace) -> Self {
        let [band, cell, entry, arc, point] = place.first.map(|first| first as u32);
        let mut own = Self {
            faces: vec![abi::ExactFace { first_band: band, band_count: trim.bands.len() as u32 }],
            bands: trim.bands.iter().map(|b| abi::ExactBand { top: b.top, end: cell + b.end }).collect(),
            cells: Vec::with_capacity(trim.cells.len()),
            entries: trim.entries.iter().map(|e| e + (arc << 2)).collect(),
            arcs: Vec::with_capacity(trim.arcs.len()),
            points: Vec::new(),
        };
        own.cells.extend(trim.cells.iter().map(|c| abi::ExactCell {
            right: c.right,
            winding: c.winding,
            first: entry + c.first,
            count: c.count,
        }));
        for arc in &trim.arcs {
            let degree = (arc.points.len().max(2) - 1) as u32;
            own.arcs.push(abi::ExactArc {
                low: arc.low,
                high: arc.high,
                hull: arc.hull,
                first: point + own.points.len() as u32,
                shape: degree | if arc.up { abi::ARC_UP } else { 0 },
            });
            own.points.extend(arc.points.iter().flatten());
        }
        own
    }

    fn lengths(&self) -> [usize; 5] {
        let (bands, cells, entries) = (self.bands.len(), self.cells.len(), self.entries.len());
        [bands, cells, entries, self.arcs.len(), self.points.len()]
    }

    /// The arrays' bytes, in the order of [`EditTarget::Exact`].
    pub(super) fn bytes_mut(&mut self, array: usize) -> &mut [u8] {
        match array {
            0 => bytemuck::cast_slice_mut(&mut self.faces),
            1 => bytemuck::cast_slice_mut(&mut self.bands),
            2 => bytemuck::cast_slice_mut(&mut self.cells),
            3 => bytemuck::cast_slice_mut(&mut self.entries),
            4 => bytemuck::cast_slice_mut(&mut self.arcs),
            _ => bytemuck::cast_slice_mut(&mut self.points),
        }
    }
}

/// Elements that an array may grow by beside twice its length: a loop that has been turned may be cut into
/// twice as many arcs.
const SPARE: usize = 4096;

impl ExactPlace {
    /// What has to be told to put `new` in the place of `old`: the elements that differ. `None` where there is no
    /// room.
    pub(super) fn writes(&self, old: &ExactData, new: &ExactData) -> Option<Vec<Write>> {
        if new.lengths().iter().zip(self.room).any(|(length, room)| *length > room) {
            return None;
        }
        let writes = [
            changed(0, self.face as usize, &old.faces, &new.faces),
            changed(1, self.first[0], &old.bands, &new.bands),
            changed(2, self.first[1], &old.cells, &new.cells),
            changed(3, self.first[2], &old.entries, &new.entries),
            changed(4, self.first[3], &old.arcs, &new.arcs),
            changed(5, self.first[4], &old.points, &new.points),
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
