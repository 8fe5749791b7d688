//! Where a group of faces of a placed part may be drawn: a rectangle of pixels and a depth, for occlusion culling.
//!
//! ```text
//!        eye                       a trimmed patch has skirts: vertices on the surface continued beyond its borders,
//!         │     skirt              by at most MAX_PUSH of its width. The part of the surface from a border to there is
//!         ▼    ╱                   a Bézier patch, too, and lies in the hull of its control points, if all weights are
//!     ┌───────╱───┐                above 0
//!     │ ╭────╯    │ box of patches and skirts ─▶ its corners' pixels, and a little more; its nearest depth
//!     └───────────┘
//! ```
//!
//! Every vertex of a triangle lies on the surface, on such a continuation, or on the side of a neighbour of the same
//! group to which its own side is linked (`link.glsl`). So every triangle lies in the box, its pixels within those of
//! the corners, and its depths behind the nearest.
//!
//! **Rounding.** The continued surface is evaluated in single precision, where the terms of a sum are larger than the
//! sum: [`rounding_beyond`] widens the box. A vertex's X, Y, depth and W are each off by at most [`SINGLE_ROUNDING`] of
//! the magnitudes of their terms, `dX` and `dW`. With the computed W, the pixel `X / W` is off by
//! `|dX - (X / W) dW| / W`. Errors of the rasteriser are covered by a pixel on each side and by `DEPTH_ROUNDING`, as
//! for patches (`twin::occlusion`).
//!
//! Source of the continuation: G. Farin, *Curves and Surfaces for CAGD*, 2002, section 5.4 (extrapolation by
//! subdivision).

use super::{CHUNK, Extent, FaceGroup, GroupInSight, SINGLE_ROUNDING, SceneData, bounds_of};
use crate::abi::constants::behind::DEPTH_ROUNDING;
use crate::abi::constants::push::MAX_PUSH;
use crate::abi::{self, BORDER_U0, BORDER_U1, BORDER_V0, BORDER_V1, PartInSight, Side};
use crate::model::{Bounds, Camera};
use crate::spline::Patch;
use glam::{DAffine3, DMat4, DVec3, DVec4};
use rayon::prelude::*;

/// Scenes of fewer placed parts have no occlusion culling of whole parts: it costs more than it saves.
const FEWEST_PARTS: usize = 128;
/// The same of scenes with fewer patches a placed part.
const FEWEST_PATCHES_OF_A_PART: usize = 4;

impl SceneData {
    /// Parts that are hidden as a whole are culled before their patches.
    pub(crate) fn hides_parts(&self) -> bool {
        self.hides_parts_with([0; 2])
    }

    /// The same with so many more placed parts and patch instances.
    pub(in crate::scene) fn hides_parts_with(&self, [parts, patch_instances]: [usize; 2]) -> bool {
        let all = self.instances.len() + parts;
        let enough = self.patch_instances.len() + patch_instances >= FEWEST_PATCHES_OF_A_PART * all;
        self.hides_with(patch_instances) && all >= FEWEST_PARTS && enough
    }

    /// Finds the boxes around all that is drawn of each group of faces. Needs the arrays that the GPU gets.
    pub(in crate::scene) fn find_drawn_boxes(&mut self) {
        let of = |group: &FaceGroup| {
            let first = group.first_patch as usize;
            self.drawn_box(&self.patches[first..first + group.count as usize])
        };
        let drawn: Vec<Option<Extent>> = self.boxes.groups.par_iter().map(of).collect();
        self.boxes.groups.iter_mut().zip(drawn).for_each(|(group, drawn)| group.drawn = drawn);
    }

    /// The box around all that may be drawn of these patches.
    fn drawn_box(&self, patches: &[abi::Patch]) -> Option<Extent> {
        let of_patches = patches.par_iter().map(|patch| self.drawn_bounds(patch));
        let bounds = of_patches.try_reduce(|| Bounds::EMPTY, |a, b| Some(a.union(b)))?;
        (!bounds.is_empty()).then(|| Extent::of(bounds))
    }

    /// The same of one patch: empty if it is never drawn.
    fn drawn_bounds(&self, patch: &abi::Patch) -> Option<Bounds> {
        // an edit may change on which side of the loops a patch lies
        let is_editable = self.edit.is_some();
        if patch.side() == Side::Outside && !is_editable {
            return Some(Bounds::EMPTY);
        }
        let own = bounds_of(patch);
        let borders = if is_editable || patch.side() == Side::Boundary { patch.borders() } else { 0 };
        if borders == 0 {
            return Some(own);
        }
        let (degree_u, degree_v) = patch.degrees();
        let points = &self.points[patch.first as usize..][..(degree_u + 1) * (degree_v + 1)];
        let points = points.iter().map(|p| DVec4::from(p.map(f64::from))).collect();
        let patch = Patch { degree_u, degree_v, points };
        let rounding = rounding_beyond(&patch, borders);
        skirts(&patch, borders).iter().try_fold(own, |all, skirt| {
            let least = skirt.points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min) - rounding.w;
            if least <= 0.0 {
                return None;
            }
            let (min, max) = skirt.bounds();
            let off = (rounding.truncate() + min.abs().max(max.abs()) * rounding.w) / least;
            Some(all.union(Bounds { min: min - off, max: max + off }))
        })
    }

    /// These groups of placed parts, in their order, and where a camera may draw them. Without a camera, none is
    /// hidden.
    pub(crate) fn parts_in_sight(&self, camera: Option<&Camera>, groups: &[GroupInSight]) -> Vec<PartInSight> {
        let view = camera.map(|camera| (camera.pixel_matrix(), camera));
        let of = |&at: &GroupInSight| {
            let (placed, group) = self.boxes.at(at);
            let placement = self.placements[at.part as usize];
            let drawn = view.and_then(|(pixels, camera)| group.in_picture(pixels, placement, camera));
            let (depth, [low, high]) = drawn.unwrap_or((NEVER_HIDDEN, [0; 2]));
            PartInSight {
                group: placed.groups_before + at.group,
                first_patch_instance: placed.first + group.before,
                patch_instances: group.count,
                depth,
                low,
                high,
            }
        };
        if groups.len() < CHUNK { groups.iter().map(of).collect() } else { groups.par_iter().map(of).collect() }
    }
}

/// No reversed depth exceeds it.
const NEVER_HIDDEN: f32 = 1.0;
/// Most pixels along a side of a picture in which parts are hidden: 16 bits number a column or a row.
const MOST_PIXELS: u32 = 1 << 16;

/// The surface from each of these borders on, as far as skirts reach, and beyond the corners between two of them.
fn skirts(patch: &Patch, borders: u32) -> Vec<Patch> {
    let reach = f64::from(MAX_PUSH);
    let has = |border: u32| borders & border != 0;
    let beyond_u =
        [has(BORDER_U0).then(|| patch.split_u(-reach).0), has(BORDER_U1).then(|| patch.split_u(1.0 + reach).1)];
    let along_u: Vec<Patch> = beyond_u.into_iter().flatten().collect();
    let of_row = |row: &Patch| {
        [has(BORDER_V0).then(|| row.split_v(-reach).0), has(BORDER_V1).then(|| row.split_v(1.0 + reach).1)]
    };
    let beyond_v: Vec<Patch> = std::iter::once(patch).chain(&along_u).flat_map(of_row).flatten().collect();
    along_u.into_iter().chain(beyond_v).collect()
}

/// Roundings of an evaluation for each degree: weights, their powers, products and sums, and a place that is rounded.
const ROUNDINGS_OF_A_DEGREE: f64 = 16.0;

/// Bounds the rounding errors of the homogeneous coordinates of the surface beyond these borders, in the evaluation in
/// single precision. At `t = 1 + MAX_PUSH` the magnitudes of the Bernstein polynomials of degree `n` add up to
/// `(|t| + |1 - t|)^n`, while the polynomials themselves add up to 1.
pub(super) fn rounding_beyond(patch: &Patch, borders: u32) -> DVec4 {
    let most = 1.0 + 2.0 * f64::from(MAX_PUSH);
    let growth = |both: u32, degree: usize| if borders & both == 0 { 1.0 } else { most.powi(degree as i32) };
    let growth = growth(BORDER_U0 | BORDER_U1, patch.degree_u) * growth(BORDER_V0 | BORDER_V1, patch.degree_v);
    let roundings = ROUNDINGS_OF_A_DEGREE * (patch.degree_u + patch.degree_v) as f64;
    let magnitudes = patch.points.iter().fold(DVec4::ZERO, |all, p| all.max(p.abs()));
    0.5 * f64::from(f32::EPSILON) * roundings * growth * magnitudes
}

impl FaceGroup {
    /// A reversed depth that nothing drawn of the group exceeds, and the first and last pixel of a rectangle with all
    /// that is drawn, column and row in 16 bits each. `None` if the group reaches the near plane or is beside the
    /// picture, if its box is not known, or if 16 bits do not number the picture's pixels.
    fn in_picture(&self, pixels: DMat4, placement: DAffine3, camera: &Camera) -> Option<(f32, [u32; 2])> {
        let drawn = self.drawn?;
        if camera.size.0.max(camera.size.1) > MOST_PIXELS {
            return None;
        }
        let rows = (pixels * DMat4::from(placement)).transpose();
        let [x, y, depth, w] = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
        let rounding = f64::from(DEPTH_ROUNDING);
        let (near, far) = camera.depth_range;
        let of_depth = drawn.range(depth);
        let nearest = of_depth.middle - of_depth.reach - SINGLE_ROUNDING * of_depth.terms;
        let of_w = drawn.range(w);
        // in a parallel view W is 1
        let least_w = of_w.middle - of_w.reach - SINGLE_ROUNDING * of_w.terms;
        if nearest < near * (1.0 + rounding) || least_w <= 0.0 {
            return None;
        }
        let sign = |k: usize, axis: usize| if k >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let corners: [DVec4; 8] = std::array::from_fn(|k| {
            (drawn.centre + drawn.half * DVec3::new(sign(k, 0), sign(k, 1), sign(k, 2))).extend(1.0)
        });
        let across = |row: DVec4, size: u32| {
            let at = corners.map(|corner| row.dot(corner) / w.dot(corner));
            let low = at.into_iter().fold(f64::INFINITY, f64::min);
            let high = at.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let terms = drawn.range(row).terms + low.abs().max(high.abs()) * of_w.terms;
            let beyond = 1.0 + SINGLE_ROUNDING * terms / least_w;
            let first = (low - beyond).floor().max(0.0);
            let last = (high + beyond).ceil().min(f64::from(size) - 1.0);
            (first <= last).then_some([first as u32, last as u32])
        };
        let ([left, right], [top, bottom]) = (across(x, camera.size.0)?, across(y, camera.size.1)?);
        let scale = if camera.is_perspective() { near / nearest } else { 1.0 };
        let reversed = (far - nearest) / (far - near) * scale * (1.0 + rounding);
        let depth = (reversed.max(0.0) as f32).next_up().min(NEVER_HIDDEN);
        Some((depth, [left | top << 16, right | bottom << 16]))
    }
}
