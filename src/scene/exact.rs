//! The exact way's arrays: those of every face behind each other.

use crate::abi;
use crate::trim::ExactTrim;

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
    /// Grids.
    pub words: Vec<u32>,
}

impl ExactData {
    /// Adds the next face.
    pub(crate) fn push(&mut self, trim: &ExactTrim) {
        let (cells, entries, arcs) = (self.cells.len() as u32, self.entries.len() as u32, self.arcs.len() as u32);
        self.faces.push(abi::ExactFace {
            first_band: self.bands.len() as u32,
            band_count: trim.bands.len() as u32,
            first_word: self.words.len() as u32,
            across: trim.grid.across,
            origin: trim.grid.origin,
            scale: trim.grid.scale,
        });
        self.words.extend(&trim.grid.words);
        self.bands.extend(trim.bands.iter().map(|b| abi::ExactBand { top: b.top, end: cells + b.end }));
        self.cells.extend(trim.cells.iter().map(|c| abi::ExactCell {
            right: c.right,
            winding: c.winding,
            first: entries + c.first,
            count: c.count,
        }));
        self.entries.extend(trim.entries.iter().map(|entry| entry + (arcs << 2)));
        for arc in &trim.arcs {
            let degree = (arc.points.len().max(2) - 1) as u32;
            self.arcs.push(abi::ExactArc {
                low: arc.low,
                high: arc.high,
                hull: arc.hull,
                first: self.points.len() as u32,
                shape: degree | if arc.up { abi::ARC_UP } else { 0 },
            });
            self.points.extend(arc.points.iter().flatten());
        }
    }
}
