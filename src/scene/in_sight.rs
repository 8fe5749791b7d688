//! Finds the placed parts that a view may see, and their faces. The passes over patches run only for the patch
//! instances of those faces.
//!
//! ```text
//!   part ─▶ box of its patches ──placement, camera──▶ outside the picture, before the near plane, behind the far
//!    │                                                plane, or no pixel's centre within reach?  ─▶ out of sight
//!    │          partly in sight
//!    ╰─▶ groups of faces ─▶ box of each group ──────▶ the same                                   ─▶ out of sight
//!   in sight: runs of consecutive patch instances (abi::PatchRun), and the views of those parts
//! ```
//!
//! The box of a part or of a group contains the boxes of its patches, and its margins are wider than those of pass
//! `bound`. So that pass would cull every patch that is out of sight, and the picture is the same bit for bit.
//!
//! Pass `split` reads the segments of the patches that share a side with a listed patch. Patches of one face share
//! sides, so a group has whole faces. Untrimmed faces of a part may share sides, too ([`link`](super::link)); such a
//! part is one group.
//!
//! Cost: a product of matrices for each placed part, and some sums for it and for each group of a part that is partly
//! in sight, in double precision; on all cores if there are many parts.

use super::data::SceneData;
use super::view::view;
use crate::abi::{self, PatchRun};
use crate::model::{Bounds, Camera};
use glam::{DMat4, DVec3, DVec4};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

mod drawn;

/// Placed parts, or groups of faces, of one task.
const CHUNK: usize = 2048;
/// A group of faces ends with the face by which it has so many patches. A larger group has more patches out of sight,
/// for which passes have threads. A smaller one costs the CPU more for each of its patches.
const PATCHES_OF_A_GROUP: u32 = 256;
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

/// Consecutive faces of a part. Copies of the part share it.
#[derive(Clone, Copy, Debug, Default)]
struct FaceGroup {
    patches: Extent,
    /// The box around all that may be drawn of the group; `None` if it is not known, or has no bound.
    drawn: Option<Extent>,
    first_patch: u32,
    /// Patches of the part before the group, and of the group.
    before: u32,
    count: u32,
}

/// The box of the patches of a placed part, its patch instances, and its groups of faces.
#[derive(Clone, Copy, Debug, Default)]
struct PlacedBox {
    patches: Extent,
    /// First patch instance, and number of patch instances; 0 of a part without patches.
    first: u32,
    count: u32,
    /// First group in [`PartBoxes::groups`], and number of groups.
    first_group: u32,
    group_count: u32,
    /// Groups of all placed parts before this one.
    groups_before: u32,
    /// The part is an operand, which the far plane does not cut off.
    is_operand: bool,
}

/// The boxes of all placed parts of a scene, and of their groups of faces.
#[derive(Clone, Debug, Default)]
pub(super) struct PartBoxes {
    placed: Vec<PlacedBox>,
    groups: Vec<FaceGroup>,
    /// Groups of all placed parts, copies counted each.
    placed_groups: u32,
}

/// The margins of pass `bound`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    /// Pixels around the picture.
    pub beside_px: f64,
    /// Pixels around the box of a patch in which the patch may be drawn.
    pub beyond_px: f64,
}

/// A group of faces of a placed part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct GroupInSight {
    /// Number of the placed part.
    part: u32,
    /// Number of the group among those of the part.
    group: u32,
}

/// The placed parts and patch instances that a view may see.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct InSight {
    /// Numbers of the placed parts with patches, ascending.
    pub parts: Vec<u32>,
    /// Their groups of faces, in the order of the patch instances.
    pub groups: Vec<GroupInSight>,
    /// The patch instances of these groups.
    pub runs: Vec<PatchRun>,
    /// How many patch instances all runs have.
    pub patch_instances: u32,
}

fn bounds_of(patch: &abi::Patch) -> Bounds {
    let [min, max] = [patch.box_min, patch.box_max].map(|p| DVec3::from(p.map(f64::from)));
    Bounds { min, max }
}

/// The groups of these faces of one part, each with the bounds of its patches.
fn grouped(data: &SceneData, faces: &[abi::Face]) -> Vec<(FaceGroup, Bounds)> {
    let patches_of = |faces: &[abi::Face]| {
        let first = faces[0].first_patch;
        first..first + faces.iter().map(|face| face.count_u * face.count_v).sum::<u32>()
    };
    let all = patches_of(faces);
    let mut sides = 4 * all.start as usize..4 * all.end as usize;
    let is_linked = sides.any(|side| data.links.get(side).is_some_and(abi::Link::is_shared));
    let mut groups = Vec::new();
    let mut left = faces;
    while !left.is_empty() {
        let mut count = 0;
        let ends = left.iter().position(|face| {
            count += face.count_u * face.count_v;
            count >= PATCHES_OF_A_GROUP && !is_linked
        });
        let (group, others) = left.split_at(ends.map_or(left.len(), |last| last + 1));
        let Range { start, end } = patches_of(group);
        let patches = data.patches[start as usize..end as usize].iter().map(bounds_of);
        let bounds = patches.fold(Bounds::EMPTY, Bounds::union);
        let patches = Extent::of(bounds);
        let group =
            FaceGroup { patches, drawn: None, first_patch: start, before: start - all.start, count: end - start };
        groups.push((group, bounds));
        left = others;
    }
    groups
}

impl PartBoxes {
    /// Of a scene with all of its arrays.
    pub(super) fn of(data: &SceneData) -> Self {
        let mut boxes = Self { placed: vec![PlacedBox::default(); data.instances.len()], ..Self::default() };
        // the box of each part, its first group, and the number of its groups
        let mut known: HashMap<(u32, usize), (Extent, u32, u32)> = HashMap::new();
        for placed in data.face_instances.chunk_by(|a, b| a.instance == b.instance) {
            let first = placed[0];
            let faces = &data.faces[first.face as usize..][..placed.len()];
            let (patches, first_group, group_count) = *known.entry((first.face, faces.len())).or_insert_with(|| {
                let first_group = boxes.groups.len() as u32;
                let (groups, bounds): (Vec<FaceGroup>, Vec<Bounds>) = grouped(data, faces).into_iter().unzip();
                let count = groups.len() as u32;
                boxes.groups.extend(groups);
                (Extent::of(bounds.into_iter().fold(Bounds::EMPTY, Bounds::union)), first_group, count)
            });
            boxes.placed[first.instance as usize] = PlacedBox {
                patches,
                first: first.first_patch_instance,
                count: faces.iter().map(|face| face.count_u * face.count_v).sum(),
                first_group,
                group_count,
                groups_before: boxes.placed_groups,
                is_operand: faces[0].flags & abi::FACE_OPERAND != 0,
            };
            boxes.placed_groups += group_count;
        }
        boxes
    }

    /// Puts the boxes of a model behind those of a scene that has so many patches and patch instances.
    pub(super) fn join(&mut self, new: Self, (patches, patch_instances): (u32, u32)) {
        let (groups, placed_groups) = (self.groups.len() as u32, self.placed_groups);
        let behind = |of_part: PlacedBox| PlacedBox {
            first: of_part.first + patch_instances,
            first_group: of_part.first_group + groups,
            groups_before: of_part.groups_before + placed_groups,
            ..of_part
        };
        // a part without patches has no numbers
        self.placed.extend(new.placed.into_iter().map(|part| if part.count > 0 { behind(part) } else { part }));
        let behind = |group: FaceGroup| FaceGroup { first_patch: group.first_patch + patches, ..group };
        self.groups.extend(new.groups.into_iter().map(behind));
        self.placed_groups += new.placed_groups;
    }

    fn groups_of(&self, placed: &PlacedBox) -> &[FaceGroup] {
        &self.groups[placed.first_group as usize..][..placed.group_count as usize]
    }

    fn at(&self, GroupInSight { part, group }: GroupInSight) -> (&PlacedBox, &FaceGroup) {
        let placed = &self.placed[part as usize];
        (placed, &self.groups_of(placed)[group as usize])
    }
}

/// A linear function over a box: its value at the centre, its largest difference from that, and the sum of the
/// magnitudes of its terms.
#[derive(Clone, Copy)]
struct Values {
    middle: f64,
    reach: f64,
    terms: f64,
}

impl Extent {
    fn of(Bounds { min, max }: Bounds) -> Self {
        Self { centre: 0.5 * (min + max), half: 0.5 * (max - min) }
    }

    fn range(&self, row: DVec4) -> Values {
        let (linear, size) = (row.truncate(), row.truncate().abs());
        let reach = size.dot(self.half);
        let terms = size.dot(self.centre.abs()) + reach + row.w.abs();
        Values { middle: linear.dot(self.centre) + row.w, reach, terms }
    }
}

/// How much of a box a view may see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sight {
    /// Pass `bound` culls every patch of the box.
    Out,
    Partly,
    /// The box is within the picture, and between the near and the far plane.
    Whole,
}

/// Pixels and depths of the points of a placed part: linear functions of its coordinates.
struct PlacedView<'a> {
    rows: [DVec4; 4],
    camera: &'a Camera,
    reach: Reach,
    /// The far plane does not cut the part off.
    is_operand: bool,
}

impl PlacedView<'_> {
    fn sight(&self, extent: &Extent) -> Sight {
        let (camera, [x, y, depth, w]) = (self.camera, self.rows);
        let (margin, beyond) = (self.reach.beside_px + SPARE_PX, self.reach.beyond_px + ROUNDING_PX);
        let range = |row: DVec4| extent.range(row);
        let of_depth = range(depth);
        let rounding = SINGLE_ROUNDING * of_depth.terms;
        let (near, far) = camera.depth_range;
        let (nearest, farthest) = (of_depth.middle - of_depth.reach, of_depth.middle + of_depth.reach);
        if farthest < near - rounding || nearest > far + rounding && !self.is_operand {
            return Sight::Out;
        }
        let along = |row: DVec4, size: u32| {
            let (low, high) = (range(row + margin * w), range(row - (f64::from(size) + margin) * w));
            if low.middle + low.reach < 0.0 || high.middle - high.reach > 0.0 {
                Sight::Out
            } else if low.middle - low.reach >= 0.0 && high.middle + high.reach <= 0.0 {
                Sight::Whole
            } else {
                Sight::Partly
            }
        };
        let sides = [along(x, camera.size.0), along(y, camera.size.1)];
        if sides.contains(&Sight::Out) {
            return Sight::Out;
        }
        let of_w = range(w);
        let least = of_w.middle - of_w.reach;
        // in a parallel view W is 1
        if least <= 0.0 || nearest < near {
            return Sight::Partly;
        }
        let covers_a_centre = |row: DVec4| {
            let pixel = range(row).middle / of_w.middle;
            let around = range(row - pixel * w).reach / least + beyond;
            (pixel - around - 0.5).ceil() <= (pixel + around - 0.5).floor()
        };
        if !(covers_a_centre(x) && covers_a_centre(y)) {
            return Sight::Out;
        }
        if sides == [Sight::Whole; 2] && farthest <= far { Sight::Whole } else { Sight::Partly }
    }
}

impl SceneData {
    /// Groups of faces of all placed parts.
    pub(crate) fn placed_groups(&self) -> u32 {
        self.boxes.placed_groups
    }

    /// The placed parts and patch instances that a camera may see.
    pub(crate) fn in_sight(&self, camera: &Camera, reach: Reach) -> InSight {
        let pixels = camera.pixel_matrix();
        let placed = self.boxes.placed.len();
        let of_chunk = |first: usize| {
            let mut seen = Vec::new();
            let all = first..(first + CHUNK).min(placed);
            all.for_each(|n| self.push_in_sight(n, (pixels, camera, reach), &mut seen));
            seen
        };
        let firsts: Vec<usize> = (0..placed).step_by(CHUNK).collect();
        let chunks: Vec<Vec<GroupInSight>> = match firsts.len() {
            0 | 1 => firsts.into_iter().map(of_chunk).collect(),
            _ => firsts.into_par_iter().map(of_chunk).collect(),
        };
        let groups = chunks.concat();
        let mut parts: Vec<u32> = groups.iter().map(|group| group.part).collect();
        parts.dedup();
        let mut runs: Vec<PatchRun> = Vec::new();
        let mut patch_instances = 0;
        for (placed, group) in groups.iter().map(|&at| self.boxes.at(at)) {
            let first = placed.first + group.before;
            let follows = runs.last().is_some_and(|run| run.patch_instance + (patch_instances - run.place) == first);
            if !follows {
                runs.push(PatchRun { place: patch_instances, patch_instance: first });
            }
            patch_instances += group.count;
        }
        InSight { parts, groups, runs, patch_instances }
    }

    /// Puts the groups of a placed part that a camera may see behind `seen`.
    fn push_in_sight(&self, n: usize, (pixels, camera, reach): (DMat4, &Camera, Reach), seen: &mut Vec<GroupInSight>) {
        let placed = &self.boxes.placed[n];
        if placed.count == 0 || self.hidden.get(n).is_some_and(|hidden| *hidden) {
            return;
        }
        let rows = (pixels * DMat4::from(self.placements[n])).transpose();
        let rows = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
        let view = PlacedView { rows, camera, reach, is_operand: placed.is_operand };
        let groups = self.boxes.groups_of(placed);
        let is_seen = |k: &usize| view.sight(&groups[*k].patches) != Sight::Out;
        let in_sight = |k: usize| GroupInSight { part: n as u32, group: k as u32 };
        let all = 0..groups.len();
        match view.sight(&placed.patches) {
            Sight::Out => {}
            // the box of a part of one group is that of the group
            Sight::Partly if all.len() > 1 => seen.extend(all.filter(is_seen).map(in_sight)),
            Sight::Partly | Sight::Whole => seen.extend(all.map(in_sight)),
        }
    }

    /// Views of the placed parts in sight, in their order.
    pub(crate) fn views_of(&self, pixels: DMat4, parts: &[u32]) -> Vec<abi::View> {
        let of = |&n: &u32| view(pixels, self.placements[n as usize]);
        if parts.len() < CHUNK { parts.iter().map(of).collect() } else { parts.par_iter().map(of).collect() }
    }
}

#[cfg(test)]
mod tests;
