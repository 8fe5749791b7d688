//! Edits trim loops between frames.
//!
//! ```text
//!   edit_loop(at, new loop) ──▶ its curves and control points       trimmed by table
//!                           ──▶ the face's arcs that differ         trimmed exactly
//!                           ──▶ words of patches and cells          of patches that meet the old or the new box and
//!                                                                   lie differently to the loops now
//!                    └──────▶ Writes ──record──▶ copies at the beginning of the next frame
//! ```
//!
//! An editable scene has arrays for all that an edit may change: curves along scan lines, control points of patches
//! outside the loops, and cells of patches that no loop meets. Pass `density` skips such cells by the sign of their
//! speed. Each face's cells and lists of arcs have spare room, since their number changes with a loop's shape. So every
//! edit overwrites in place, and the picture is that of a new scene of the edited model. The cost of an edit depends on
//! its face alone. Winding numbers add up, so each loop has an index of its own, and an edit makes only the edited
//! loop's index again.

use super::SceneData;
use super::exact::{ExactData, ExactPlace, exact_trim};
use super::face::{Domain, loop_curves};
use crate::abi::{self, Side};
use crate::model::{FaceError, LoopAt, TrimLoop};
use crate::trim::{LoopIndex, RectSide};
use bytemuck::Pod;
use glam::DVec2;

/// Why a loop was not replaced. The scene has not changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The model was uploaded without [`SceneSettings::editable`](crate::picture::SceneSettings::editable).
    #[error("the model was not uploaded as editable")]
    NotEditable,
    /// The part is not placed, or has no such face or loop.
    #[error("the scene has no loop {} of face {} of part {}", .0.trim_loop, .0.face, .0.part)]
    NoSuchLoop(LoopAt),
    /// No loop met the face's surface when the model was uploaded, so it is drawn without a trim test.
    #[error("face {} of part {} is not trimmed", .0.face, .0.part)]
    NotTrimmed(LoopAt),
    /// The new loop has other curves: their number and degrees stay.
    #[error("the new loop has other curves than the old one: their number and degrees must stay")]
    OtherCurves,
    /// The face is trimmed exactly, and its loops turn back more than twice as often as when the model was uploaded:
    /// their arcs do not fit. Upload the edited model.
    #[error("no room for the arcs of face {} of part {}: upload the edited model", .0.face, .0.part)]
    NoRoom(LoopAt),
    /// There is no such control point, or the loop would not be valid.
    #[error(transparent)]
    Loop(#[from] FaceError),
}

/// The host's data for edits of a scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct EditScene {
    /// First face of each part.
    pub first_faces: Vec<usize>,
    /// `None` for a face that is not trimmed.
    pub faces: Vec<Option<EditFace>>,
}

/// A face whose loops may change.
#[derive(Clone, Debug)]
pub(crate) struct EditFace {
    pub domain: Domain,
    /// Trims are smoothed: pass `coverage` measures the face's borders.
    pub smooth: bool,
    pub loops: Vec<EditLoop>,
    pub patches: Vec<EditPatch>,
    pub first_patch: u32,
    pub first_cell: u32,
    /// The face's patch, and the speed along `v`, of each cell.
    pub cells: Vec<(u32, f32)>,
    /// The place of its arcs and their present values; `None` if it is trimmed by table.
    pub exact: Option<(ExactPlace, ExactData)>,
}

/// A loop, and the place of its curves in the scene's arrays.
#[derive(Clone, Debug)]
pub(crate) struct EditLoop {
    pub shape: TrimLoop,
    /// Made at the face's first edit.
    index: Option<LoopIndex>,
    pub first_curve: u32,
    pub first_point: u32,
}

/// A patch's rectangle and its shape word.
#[derive(Clone, Debug)]
pub(crate) struct EditPatch {
    pub lo: DVec2,
    pub hi: DVec2,
    pub shape: u32,
}

/// An array of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum EditTarget {
    Patches,
    Outside,
    Cones,
    Points,
    Links,
    Faces,
    FaceInstances,
    /// The instances of placed parts.
    Instances,
    Items,
    /// The part and the instance of the model of each of them.
    Sources,
    Cells,
    CellInstances,
    Curves,
    CurvePoints,
    CurveInstances,
    WideStrips,
    /// An array of [`ExactScene`](super::ExactScene): faces, cells, arcs.
    Exact(usize),
    /// Of [`MeshBuffers`](super::MeshBuffers): meshes, instances, positions, triangles, normals.
    Mesh(usize),
}

/// Bytes to overwrite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Write {
    pub to: EditTarget,
    pub offset: u64,
    pub bytes: Vec<u8>,
}

impl EditLoop {
    pub(super) fn new(shape: &TrimLoop, first_curve: u32, first_point: u32) -> Self {
        Self { shape: shape.clone(), index: None, first_curve, first_point }
    }

    /// The writes of the loop's curves and control points, for the table.
    fn curve_writes(&self, new: &TrimLoop, domain: &Domain) -> Vec<Write> {
        let (mut curves, points) = loop_curves(new, domain);
        curves.iter_mut().for_each(|c| c.first += self.first_point);
        vec![
            write(EditTarget::Curves, self.first_curve, &curves),
            write(EditTarget::CurvePoints, self.first_point, &points),
        ]
    }

    fn index(&self) -> &LoopIndex {
        self.index.as_ref().expect("made before any is asked")
    }
}

impl EditScene {
    /// The present shape of a loop.
    pub(crate) fn shape(&self, at: LoopAt) -> Result<&TrimLoop, EditError> {
        let face = self.faces[self.find(at)?].as_ref().ok_or(EditError::NotTrimmed(at))?;
        face.loops.get(at.trim_loop).map(|l| &l.shape).ok_or(EditError::NoSuchLoop(at))
    }

    /// Number of the face in the scene.
    fn find(&self, at: LoopAt) -> Result<usize, EditError> {
        let first = self.first_faces.get(at.part).ok_or(EditError::NoSuchLoop(at))?;
        let end = self.first_faces.get(at.part + 1).copied().unwrap_or(self.faces.len());
        if first + at.face < end { Ok(first + at.face) } else { Err(EditError::NoSuchLoop(at)) }
    }

    /// Replaces a loop; returns the writes to the GPU's arrays.
    pub(crate) fn replace(&mut self, at: LoopAt, new: &TrimLoop) -> Result<Vec<Write>, EditError> {
        let degrees = |l: &TrimLoop| l.curves().map(|c| c.degree()).collect::<Vec<_>>();
        if degrees(self.shape(at)?) != degrees(new) {
            return Err(EditError::OtherCurves);
        }
        let face = self.find(at)?;
        let face = self.faces[face].as_mut().expect("a loop was found in it");
        face.replace(at, new)
    }
}

impl EditFace {
    fn replace(&mut self, at: LoopAt, new: &TrimLoop) -> Result<Vec<Write>, EditError> {
        let edited = at.trim_loop;
        let mut writes = match &self.exact {
            None => self.loops[edited].curve_writes(new, &self.domain),
            Some((place, old)) => {
                let mut loops: Vec<TrimLoop> = self.loops.iter().map(|l| l.shape.clone()).collect();
                loops[edited] = new.clone();
                let exact = ExactData::of(&exact_trim(&loops, &self.domain, self.smooth), place);
                let writes = place.writes(old, &exact).ok_or(EditError::NoRoom(at))?;
                self.exact = Some((*place, exact));
                writes
            }
        };
        let (old_lo, old_hi) = self.loops[edited].shape.bounds();
        let (new_lo, new_hi) = new.bounds();
        let (lo, hi) = (old_lo.min(new_lo), old_hi.max(new_hi));
        let l = &mut self.loops[edited];
        l.shape = new.clone();
        l.index = None;
        for l in &mut self.loops {
            l.index.get_or_insert_with(|| LoopIndex::new(std::slice::from_ref(&l.shape)));
        }
        for i in 0..self.patches.len() {
            // outside both boxes no winding number has changed
            let p = &self.patches[i];
            let reached = p.lo.cmple(hi).all() && p.hi.cmpge(lo).all();
            if reached {
                self.set_side(i, self.side(p), &mut writes);
            }
        }
        writes.retain(|w| !w.bytes.is_empty());
        Ok(writes)
    }

    /// How a patch lies to all loops.
    fn side(&self, p: &EditPatch) -> Side {
        let mut winding = 0;
        for l in &self.loops {
            if l.index().classify(p.lo, p.hi) == RectSide::Boundary {
                return Side::Boundary;
            }
            winding += l.index().winding(p.lo);
        }
        if winding != 0 { Side::Inside } else { Side::Outside }
    }

    fn set_side(&mut self, i: usize, side: Side, writes: &mut Vec<Write>) {
        let shape = abi::Patch::with_side(self.patches[i].shape, side);
        if shape == self.patches[i].shape {
            return;
        }
        self.patches[i].shape = shape;
        let place = |first: u32, stride: usize, field: usize| (u64::from(first) * stride as u64) + field as u64;
        let patch = self.first_patch + i as u32;
        let offset = place(patch, size_of::<abi::Patch>(), std::mem::offset_of!(abi::Patch, shape));
        writes.push(Write { to: EditTarget::Patches, offset, bytes: shape.to_ne_bytes().to_vec() });
        for (k, &(_, speed)) in self.cells.iter().enumerate().filter(|(_, c)| c.0 == i as u32) {
            let cell = self.first_cell + k as u32;
            let offset = place(cell, size_of::<abi::Cell>(), std::mem::offset_of!(abi::Cell, speed_v));
            let speed = if side == Side::Boundary { speed } else { -speed };
            writes.push(Write { to: EditTarget::Cells, offset, bytes: speed.to_ne_bytes().to_vec() });
        }
    }
}

fn write<T: Pod>(to: EditTarget, first: u32, data: &[T]) -> Write {
    Write { to, offset: u64::from(first) * size_of::<T>() as u64, bytes: bytemuck::cast_slice(data).to_vec() }
}

impl SceneData {
    /// Applies edits to arrays that are not on the GPU yet.
    pub(crate) fn apply(&mut self, writes: &[Write]) {
        for w in writes {
            let bytes: &mut [u8] = match w.to {
                EditTarget::Patches => bytemuck::cast_slice_mut(&mut self.patches),
                EditTarget::Cells => bytemuck::cast_slice_mut(&mut self.cells),
                EditTarget::Curves => bytemuck::cast_slice_mut(&mut self.curves),
                EditTarget::CurvePoints => bytemuck::cast_slice_mut(&mut self.curve_points),
                EditTarget::Instances => bytemuck::cast_slice_mut(&mut self.instances),
                EditTarget::Exact(array) => self.exact.bytes_mut(array),
                other => unreachable!("no edit of a loop changes {other:?}"),
            };
            bytes[w.offset as usize..][..w.bytes.len()].copy_from_slice(&w.bytes);
        }
    }
}
