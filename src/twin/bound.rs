//! Twin of the pass `bound`: finds the patches that may be visible, and bounds how finely each must be divided.

use super::cone::looks_away;
use super::factor::{factors, is_undivided};
use super::view::{Seen, covers_a_centre, far_of, pixels_per_unit, see, to_pixel};
use super::{MOST_SEGMENTS, Scene};
pub use crate::abi::constants::bound::DEPTH_SHARE;
use crate::abi::{Counters, Frame, Patch, Side, View};
use glam::Vec3;

/// `tau_u | tau_v << 16` of each patch instance; 0 for a patch instance that is not visible. Counts factors above
/// [`MOST_SEGMENTS`] in `counters.clamps`.
pub fn bound(frame: &Frame, scene: &Scene<'_>, counters: &mut Counters) -> Vec<u32> {
    (0..frame.listed_patch_instances as usize)
        .map(|patch_instance| {
            let (placed, face, patch) = scene.patch_instance(patch_instance);
            let view = &scene.views[placed.instance as usize];
            if patch.side() == Side::Outside {
                return 0;
            }
            let (margin, far) = (frame.gap_radius_px + 1.0, far_of(&face, frame));
            let Some(seen) = see(view, frame, patch.box_min, patch.box_max, margin, far) else { return 0 };
            // nothing is drawn farther from the box; trimmed patches have skirts
            let skirt = if patch.side() == Side::Inside { 0.0 } else { frame.gap_radius_px };
            if !covers_a_centre(&seen, frame.deviation_px + frame.spread_px + skirt) {
                return 0;
            }
            let cone =
                scene.cones.get(face.first_patch as usize + patch_instance - placed.first_patch_instance as usize);
            if cone.is_some_and(|cone| looks_away(view, frame, &patch, *cone)) {
                return 0;
            }
            let tau = match frame.fixed_factor {
                0 if patch.bend == [0.0; 3] => [1.0; 2],
                0 => factors_of(frame, scene, &patch, placed.instance as usize, seen),
                fixed => [fixed as f32; 2],
            };
            let most = MOST_SEGMENTS as f32;
            counters.clamps += u32::from(tau[0].max(tau[1]) > most);
            tau[0].min(most) as u32 | (tau[1].min(most) as u32) << 16
        })
        .collect()
}

fn factors_of(frame: &Frame, scene: &Scene<'_>, patch: &Patch, instance: usize, seen: Seen) -> [f32; 2] {
    // the control points are within the box and need no more segments
    let of_box = patch.bend.map(|b| b * pixels_per_unit(frame, &scene.instances[instance], &seen));
    match is_undivided(of_box, 8.0 * frame.deviation_px) {
        true => [1.0; 2],
        false => factors_by_net(frame, scene, patch, instance, seen),
    }
}

fn factors_by_net(frame: &Frame, scene: &Scene<'_>, patch: &Patch, instance: usize, seen: Seen) -> [f32; 2] {
    let view = &scene.views[instance];
    let (n, k) = patch.degrees();
    let points = &scene.points[patch.first as usize..][..(n + 1) * (k + 1)];
    let closer = draw_closer(frame, points, view, seen);
    let budget = 8.0 * frame.deviation_px;
    let seen = closer.unwrap_or(seen);
    let bend = patch.bend.map(|b| b * pixels_per_unit(frame, &scene.instances[instance], &seen));
    let tau = factors(bend, budget);
    if closer.is_none() || patch.is_rational() || tau == [1.0; 2] {
        return tau;
    }
    let within = |p: [f32; 2]| [0, 1].map(|a| p[a].clamp(0.0, frame.size[a]));
    let across = bend_seen(points, (n, k), view, [within(seen.low), within(seen.high)]);
    let both: [f32; 3] = std::array::from_fn(|d| (across[d] / seen.w).max(bend[d] / DEPTH_SHARE));
    let fewer = factors(both, budget);
    if fewer[0] * fewer[1] < tau[0] * tau[1] { fewer } else { tau }
}

/// Shrinks `seen`, the projection of the patch's box, to the control points, whose hull contains the patch. `None` if a
/// control point is before the near plane.
fn draw_closer(frame: &Frame, points: &[[f32; 4]], view: &View, seen: Seen) -> Option<Seen> {
    let (mut w, mut steepest) = (3.0e38f32, 0.0f32);
    let (mut low, mut high) = ([3.0e38f32; 2], [-3.0e38f32; 2]);
    for p in points {
        let q = to_pixel(view, *p);
        w = w.min(q[3] / p[3]);
        let pixel = [q[0] / q[3], q[1] / q[3]];
        for (a, pixel) in pixel.into_iter().enumerate() {
            (low[a], high[a]) = (low[a].min(pixel), high[a].max(pixel));
        }
        let slope = std::array::from_fn::<f32, 2, _>(|a| (pixel[a] - frame.principal_px[a]) / frame.focal_px[a]);
        steepest = steepest.max(slope[0] * slope[0] + slope[1] * slope[1]);
    }
    if frame.perspective == 0 {
        return Some(Seen { w: 1.0, slant: 1.0, low, high });
    }
    let slant = (1.0 + steepest).sqrt().min(seen.slant);
    (w >= frame.near).then_some(Seen { w: w.max(seen.w), slant, low, high })
}

/// Like [`Patch::bend`], for the movement of pixels of a polynomial patch of these degrees within `range`, times `W`.
fn bend_seen(points: &[[f32; 4]], (n, k): (usize, usize), view: &View, range: [[f32; 2]; 2]) -> [f32; 3] {
    let at = |i: usize, j: usize| {
        let p = points[j.min(k) * (n + 1) + i.min(n)];
        Vec3::new(p[0], p[1], p[2])
    };
    let moves = |d: Vec3| {
        let q = to_pixel(view, [d.x, d.y, d.z, 0.0]);
        let most = [0, 1].map(|a| range.iter().map(|end| (q[a] - end[a] * q[3]).abs()).fold(0.0, f32::max));
        (most[0] * most[0] + most[1] * most[1]).sqrt()
    };
    let mut most = [0.0f32; 3];
    for (i, j) in (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))) {
        let (p, pu, pv) = (at(i, j), at(i + 1, j), at(i, j + 1));
        let uu = (at(i + 2, j) - pu) - (pu - p);
        let uv = (at(i + 1, j + 1) - pv) - (pu - p);
        let vv = (at(i, j + 2) - pv) - (pv - p);
        for (d, (second, counts)) in [(uu, i + 2 <= n), (uv, true), (vv, j + 2 <= k)].into_iter().enumerate() {
            if counts {
                most[d] = most[d].max(moves(second));
            }
        }
    }
    let times = [n * n.saturating_sub(1), n * k, k * k.saturating_sub(1)].map(|x| x as f32);
    std::array::from_fn(|d| most[d] * times[d])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Camera, Projection};
    use crate::parity::{Case, cages};
    use glam::DVec3;

    /// Where the box shows that one segment suffices, the control points say the same: from near and far, across the
    /// near plane, and in parallel views.
    #[test]
    fn the_box_never_asks_for_fewer_segments_than_the_net() {
        let model = cages::a_box().model;
        let all = Camera::around(model.bounds(), DVec3::new(1.0, -2.0, 1.5), DVec3::Z, 0.6, (480, 360));
        let (mut undivided, mut divided) = (0, 0);
        for k in 0..24 {
            let away = 0.3 * 1.3f64.powi(k);
            let eye = all.target + (all.eye - all.target) * away;
            let mut camera = Camera { eye, ..all };
            camera.fit_depth(model.bounds());
            if k % 3 == 0 {
                camera.projection = Projection::Orthographic { height: 12.0 * away };
            }
            let case = Case::new(&model, &camera, 0.5);
            let (frame, scene) = (&case.frame, &case.scene());
            for patch_instance in 0..scene.patch_instances.len() {
                let (placed, _, patch) = scene.patch_instance(patch_instance);
                let instance = placed.instance as usize;
                let far = frame.far;
                let Some(seen) = see(&scene.views[instance], frame, patch.box_min, patch.box_max, 1.0, far) else {
                    continue;
                };
                let of_box = patch.bend.map(|b| b * pixels_per_unit(frame, &scene.instances[instance], &seen));
                if is_undivided(of_box, 8.0 * frame.deviation_px) {
                    assert_eq!(factors_by_net(frame, scene, &patch, instance, seen), [1.0; 2], "step {k}");
                    undivided += u32::from(patch.bend != [0.0; 3]);
                } else {
                    divided += 1;
                }
            }
        }
        assert!(undivided > 100 && divided > 100, "{undivided} undivided, {divided} divided");
    }
}
