//! Twin of the pass [`bound`](crate::passes): which patches can be seen, and how finely each must be
//! divided.

use super::cone::looks_away;
use super::factor::factors;
use super::view::{covers_a_centre, far_of, pixels_per_unit, see};
use super::{MOST_SEGMENTS, Scene};
use crate::abi::{Counters, Frame, Side};

/// `tau_u | tau_v << 16` of each item; 0 for one that cannot be seen. Counts factors above
/// [`MOST_SEGMENTS`] in `counters.clamps`.
pub fn bound(frame: &Frame, scene: &Scene<'_>, counters: &mut Counters) -> Vec<u32> {
    (0..frame.item_count as usize)
        .map(|item| {
            let (placed, face, patch) = scene.item(item);
            let view = &scene.views[placed.instance as usize];
            if patch.side() == Side::Outside {
                return 0;
            }
            let (margin, far) = (frame.ring_px + 1.0, far_of(&face, frame));
            let Some(seen) = see(view, frame, patch.box_min, patch.box_max, margin, far) else { return 0 };
            // nothing is drawn farther from the box: cut patches have rings
            let ring = if patch.side() == Side::Inside { 0.0 } else { frame.ring_px };
            if !covers_a_centre(&seen, frame.deviation_px + frame.spread_px + ring) {
                return 0;
            }
            let cone = scene.cones.get(face.first_patch as usize + item - placed.first_item as usize);
            if cone.is_some_and(|cone| looks_away(view, frame, &patch, *cone)) {
                return 0;
            }
            let pixels = pixels_per_unit(frame, &scene.instances[placed.instance as usize], &seen);
            let tau = match frame.fixed_factor {
                0 => factors(patch.bend, 8.0 * frame.deviation_px / pixels),
                fixed => [fixed as f32; 2],
            };
            let most = MOST_SEGMENTS as f32;
            counters.clamps += u32::from(tau[0].max(tau[1]) > most);
            tau[0].min(most) as u32 | (tau[1].min(most) as u32) << 16
        })
        .collect()
}
