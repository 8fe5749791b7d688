//! Twin of the passes `part_counts`, `part_runs` and `cull_parts`: lists of the placed parts in sight, and the parts
//! that are hidden as a whole.

use super::grid::grid_of;
use super::occlusion::Farthest;
use crate::abi::constants::part_runs::{SCAN_BLOCK, THREADS};
use crate::abi::{Counters, Frame, LIST_ALL, LIST_APPEARING, LIST_FIRST, ListDispatches, PartInSight, PatchRun};

/// Whether a list has a part that was hidden `before` and is hidden `now`.
pub fn is_listed(list: u32, before: bool, now: bool) -> bool {
    match list {
        LIST_FIRST => !now,
        LIST_APPEARING => before && !now,
        _ => !(before && now),
    }
}

/// The numbers of patch instances of all parts in sight, 0 for those that are not listed; then whether a run begins
/// with each. Sets `hidden_parts` of the counters, and `before` for the first list.
pub fn part_counts(
    list: u32,
    parts: &[PartInSight],
    before: &mut [u32],
    now: &[u32],
    counters: &mut Counters,
) -> Vec<u32> {
    let listed: Vec<bool> = parts
        .iter()
        .map(|part| is_listed(list, before[part.group as usize] != 0, now[part.group as usize] != 0))
        .collect();
    let begins = |n: usize| {
        let follows = n > 0 && {
            let last = &parts[n - 1];
            listed[n - 1] && last.first_patch_instance + last.patch_instances == parts[n].first_patch_instance
        };
        u32::from(listed[n] && !follows)
    };
    if list == LIST_FIRST {
        parts.iter().for_each(|part| before[part.group as usize] = now[part.group as usize]);
        counters.hidden_parts += listed.iter().filter(|listed| !**listed).count() as u32;
    }
    if list == LIST_APPEARING {
        counters.hidden_parts -= listed.iter().filter(|listed| **listed).count() as u32;
    }
    let counts = parts.iter().zip(&listed).map(|(part, &listed)| if listed { part.patch_instances } else { 0 });
    counts.chain((0..parts.len()).map(begins)).collect()
}

/// The runs of the listed patch instances, from the result of [`part_counts`] and its prefix sums, and the dispatches
/// over them. Sets the numbers in the frame's constants, and `listed_patches` of the counters.
pub fn part_runs(
    list: u32,
    parts: &[PartInSight],
    (counts, starts): (&[u32], &[u32]),
    frame: &mut Frame,
    counters: &mut Counters,
) -> (Vec<PatchRun>, ListDispatches) {
    let n = parts.len();
    let (patch_instances, all) = (starts[n], starts[2 * n]);
    frame.listed_patch_instances = patch_instances;
    frame.run_count = all - patch_instances;
    if list != LIST_ALL {
        counters.listed_patches += patch_instances;
    }
    let begins = (0..n).filter(|k| counts[n + k] != 0);
    let run = |k: usize| PatchRun { place: starts[k], patch_instance: parts[k].first_patch_instance };
    let scanned = frame.patch_lists() * patch_instances + 1;
    let groups = |threads: u32, group: u32| grid_of(frame, threads.div_ceil(group));
    let (threads, blocks) = (groups(patch_instances, THREADS), groups(scanned, SCAN_BLOCK));
    (begins.map(run).collect(), ListDispatches { threads, blocks, scanned })
}

/// Whether a part in sight is hidden behind the farthest depths.
pub fn cull_part(part: &PartInSight, farthest: &Farthest) -> bool {
    let pixels = [0, 16].map(|shift| (part.low >> shift & 0xffff)..=(part.high >> shift & 0xffff));
    farthest.all_pixels_nearer(&pixels, part.depth.into())
}
