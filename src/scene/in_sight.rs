//! Finds the placed parts that a view may see. The passes over patches run only for the patch instances of those parts.
//!
//! ```text
//!   part ─▶ box of its patches ──placement, camera──▶ outside the picture, before the near plane, behind the far
//!                                                     plane, or no pixel's centre within reach?  ─▶ out of sight
//!   in sight: runs of consecutive patch instances (abi::PatchRun), and the views of those parts
//! ```
//!
//! The box of a part contains the boxes of its patches, and its margins are wider than those of pass `bound`. So that
//! pass would cull every patch of a part that is out of sight, and the picture is the same bit for bit.
//!
//! Cost: a product of matrices and some sums for each placed part, in double precision; on all cores if there are many
//! parts.

use super::data::SceneData;
use super::view::view;
use crate::abi::{self, FaceInstance, PatchRun};
use crate::model::Camera;
use glam::{DAffine3, DMat4, DVec3, DVec4};
use rayon::prelude::*;
use std::collections::HashMap;

mod drawn;

/// Placed parts of one task.
const CHUNK: usize = 2048;
/// Pixels by which the picture is wider on each side than in pass `bound`, for the rounding there in single precision.
const SPARE_PX: f64 = 1.0;
/// Pixels by which boxes reach farther: twice as many as pass `bound` adds for the rounding of a vertex.
const ROUNDING_PX: f64 = 0.03125;
/// Error of a depth in single precision, relative to the sum of the magnitudes of its terms.
const SINGLE_ROUNDING: f64 = 1e-5;

/// A box in part coordinates.
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    centre: DVec3,
    half: DVec3,
}

/// The box of the patches of a placed part, and its patch instances.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlacedBox {
    patches: Extent,
    /// The box around all that may be drawn of the part; `None` if it is not known, or has no bound.
    drawn: Option<Extent>,
    /// First patch instance, and number of patch instances; 0 of a part without patches.
    first: u32,
    count: u32,
    /// The part is an operand, which the far plane does not cut off.
    is_operand: bool,
}

/// The margins of pass `bound`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// Pixels around the picture.
    pub beside_px: f64,
    /// Pixels around the box of a patch in which the patch may be drawn.
    pub beyond_px: f64,
}

/// The placed parts and patch instances that a view may see.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct InSight {
    /// Numbers of the placed parts with patches, ascending.
    pub parts: Vec<u32>,
    /// Their patch instances.
    pub runs: Vec<PatchRun>,
    /// How many patch instances all runs have.
    pub patch_instances: u32,
}

/// The faces of a placed part.
struct PlacedFaces<'a> {
    first: FaceInstance,
    /// The same for copies of a part: its first face, and how many it has.
    part: (u32, usize),
    patches: &'a [abi::Patch],
}

/// The faces of each placed part that has some, from the last part to the first.
fn placed_faces(data: &SceneData) -> impl Iterator<Item = PlacedFaces<'_>> {
    data.face_instances.chunk_by(|a, b| a.instance == b.instance).rev().map(move |faces| {
        let (first, last) = (faces[0], faces[faces.len() - 1]);
        let from = data.faces[first.face as usize].first_patch as usize;
        let to = data.faces.get(last.face as usize + 1).map_or(data.patches.len(), |next| next.first_patch as usize);
        PlacedFaces { first, part: (first.face, faces.len()), patches: &data.patches[from..to] }
    })
}

/// The boxes of all placed parts of a scene.
pub(super) fn boxes(data: &SceneData) -> Vec<PlacedBox> {
    let mut boxes = vec![PlacedBox::default(); data.instances.len()];
    let mut known: HashMap<(u32, usize), (DVec3, DVec3)> = HashMap::new();
    let patch_instances = data.patch_instances.len() as u32;
    let mut end = patch_instances;
    for PlacedFaces { first, part, patches } in placed_faces(data) {
        let (low, high) = *known.entry(part).or_insert_with(|| {
            let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            patches.iter().fold(nothing, |(low, high), patch| {
                let [least, most] = [patch.box_min, patch.box_max].map(|p| DVec3::from(p.map(f64::from)));
                (low.min(least), high.max(most))
            })
        });
        boxes[first.instance as usize] = PlacedBox {
            patches: Extent::between(low, high),
            drawn: None,
            first: first.first_patch_instance,
            count: end - first.first_patch_instance,
            is_operand: data.faces[first.face as usize].flags & abi::FACE_OPERAND != 0,
        };
        end = first.first_patch_instance;
    }
    boxes
}

/// A linear function over a box: its value at the centre, its largest difference from that, and the sum of the
/// magnitudes of its terms.
#[derive(Clone, Copy)]
struct Range {
    middle: f64,
    reach: f64,
    terms: f64,
}

impl Extent {
    fn between(low: DVec3, high: DVec3) -> Self {
        Self { centre: 0.5 * (low + high), half: 0.5 * (high - low) }
    }

    fn range(&self, row: DVec4) -> Range {
        let (linear, size) = (row.truncate(), row.truncate().abs());
        let reach = size.dot(self.half);
        let terms = size.dot(self.centre.abs()) + reach + row.w.abs();
        Range { middle: linear.dot(self.centre) + row.w, reach, terms }
    }
}

impl PlacedBox {
    /// The same of a part that comes behind so many patch instances; one without any stays as it is.
    pub(super) fn behind(self, patch_instances: u32) -> Self {
        Self { first: if self.count > 0 { self.first + patch_instances } else { 0 }, ..self }
    }

    /// Whether pass `bound` may draw a patch of the box.
    fn is_in_sight(&self, pixels: DMat4, placement: DAffine3, camera: &Camera, reach: Reach) -> bool {
        let (margin, beyond) = (reach.beside_px + SPARE_PX, reach.beyond_px + ROUNDING_PX);
        let rows = (pixels * DMat4::from(placement)).transpose();
        let [x, y, depth, w] = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
        let range = |row: DVec4| self.patches.range(row);
        let of_depth = range(depth);
        let rounding = SINGLE_ROUNDING * of_depth.terms;
        let (near, far) = camera.depth_range;
        let is_before = of_depth.middle + of_depth.reach < near - rounding;
        let is_behind = of_depth.middle - of_depth.reach > far + rounding;
        if is_before || is_behind && !self.is_operand {
            return false;
        }
        let beside = |row: DVec4, size: u32| {
            let (low, high) = (range(row + margin * w), range(row - (f64::from(size) + margin) * w));
            low.middle + low.reach < 0.0 || high.middle - high.reach > 0.0
        };
        if beside(x, camera.size.0) || beside(y, camera.size.1) {
            return false;
        }
        let of_w = range(w);
        let least = of_w.middle - of_w.reach;
        // in a parallel view W is 1
        if least <= 0.0 || of_depth.middle - of_depth.reach < near {
            return true;
        }
        let covers_a_centre = |row: DVec4| {
            let pixel = range(row).middle / of_w.middle;
            let around = range(row - pixel * w).reach / least + beyond;
            (pixel - around - 0.5).ceil() <= (pixel + around - 0.5).floor()
        };
        covers_a_centre(x) && covers_a_centre(y)
    }
}

impl SceneData {
    /// The placed parts and patch instances that a camera may see.
    pub(crate) fn in_sight(&self, camera: &Camera, reach: Reach) -> InSight {
        let pixels = camera.pixel_matrix();
        let is_in_sight = |n: &usize| {
            let (placed, is_hidden) = (&self.boxes[*n], self.hidden.get(*n).is_some_and(|hidden| *hidden));
            placed.count > 0 && !is_hidden && placed.is_in_sight(pixels, self.placements[*n], camera, reach)
        };
        let of_chunk = |first: usize| {
            let all = first..(first + CHUNK).min(self.boxes.len());
            all.filter(is_in_sight).map(|n| n as u32).collect::<Vec<_>>()
        };
        let firsts: Vec<usize> = (0..self.boxes.len()).step_by(CHUNK).collect();
        let chunks: Vec<Vec<u32>> = match firsts.len() {
            0 | 1 => firsts.into_iter().map(of_chunk).collect(),
            _ => firsts.into_par_iter().map(of_chunk).collect(),
        };
        let parts = chunks.concat();
        let mut runs: Vec<PatchRun> = Vec::new();
        let mut patch_instances = 0;
        for PlacedBox { first, count, .. } in parts.iter().map(|&n| self.boxes[n as usize]) {
            let follows = runs.last().is_some_and(|run| run.patch_instance + (patch_instances - run.place) == first);
            if !follows {
                runs.push(PatchRun { place: patch_instances, patch_instance: first });
            }
            patch_instances += count;
        }
        InSight { parts, runs, patch_instances }
    }

    /// Views of the placed parts in sight, in their order.
    pub(crate) fn views_of(&self, pixels: DMat4, parts: &[u32]) -> Vec<abi::View> {
        let of = |&n: &u32| view(pixels, self.placements[n as usize]);
        if parts.len() < CHUNK { parts.iter().map(of).collect() } else { parts.par_iter().map(of).collect() }
    }
}

#[cfg(test)]
mod tests;
