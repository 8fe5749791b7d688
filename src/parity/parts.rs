//! Parity of the passes `part_counts`, `part_runs` and `cull_parts`: exact.

use super::Random;
use super::chain::UNTOUCHED;
use super::harness::{Gpu, Mismatch, same};
use crate::abi::{
    Counters, Frame, LIST_ALL, LIST_APPEARING, LIST_FIRST, ListDispatches, PartInSight, PartList, PatchRun,
};
use crate::frame::occlusion::cull_parts::{self, CullParts};
use crate::frame::occlusion::part_counts::{self, PartCounts};
use crate::frame::occlusion::part_runs::{self, PartRuns};
use crate::twin;
use crate::twin::in_sight::patch_instance_at;
use crate::twin::occlusion::Farthest;

const SIZE: [u32; 2] = [413, 301];
const UNTOUCHED_RUN: PatchRun = PatchRun { place: UNTOUCHED, patch_instance: UNTOUCHED };

/// Some of many placed parts are in sight; the patch instances of most follow each other.
#[derive(Clone)]
struct Parts {
    in_sight: Vec<PartInSight>,
    before: Vec<u32>,
    now: Vec<u32>,
}

fn parts(random: &mut Random, placed: u32) -> Parts {
    let mut first_patch_instance = 0;
    let mut in_sight = Vec::new();
    for group in 0..placed {
        let patch_instances = random.integer(1, 9);
        if random.integer(0, 9) > 0 {
            let first = SIZE.map(|size| random.integer(0, size - 1));
            let last: [u32; 2] = std::array::from_fn(|axis| random.integer(first[axis], SIZE[axis] - 1));
            let [low, high] = [first, last].map(|[x, y]| x | y << 16);
            let depth = random.range(0.0, 1.0) as f32;
            in_sight.push(PartInSight { group, first_patch_instance, patch_instances, depth, low, high });
        }
        first_patch_instance += patch_instances;
    }
    let mut hidden = || (0..placed).map(|_| u32::from(random.integer(0, 2) == 0)).collect::<Vec<_>>();
    let (before, now) = (hidden(), hidden());
    Parts { in_sight, before, now }
}

/// The GPU gets `given`, the twins `expected`.
fn compare(gpu: &Gpu, list: u32, given: &Parts, expected: &Parts) -> Result<(), Mismatch> {
    let n = expected.in_sight.len();
    let push = PartList { parts: n as u32, list };
    let old = Counters { hidden_parts: 1 << 20, listed_patches: 5, plain: 7, ..Counters::default() };
    let corner_lists = if list == LIST_APPEARING { 2 } else { 0 };
    let old_frame = Frame { most_groups: 3, near: 0.5, corner_lists, ..Frame::default() };
    let (frame, counters) = (gpu.upload("frame", &[old_frame]), gpu.upload("counters", &[old]));
    // one more of each, which no pass touches: there may be no part in sight
    let parts_in_sight = gpu.upload("parts in sight", &[given.in_sight.as_slice(), &[PartInSight::default()]].concat());
    let (before, now) = (gpu.upload("hidden before", &given.before), gpu.upload("hidden now", &given.now));
    let counts = gpu.upload("counts", &vec![UNTOUCHED; 2 * n + 1]);
    let pass = PartCounts::new(gpu.device()).unwrap();
    let bindings = part_counts::Bindings {
        parts_in_sight: &parts_in_sight,
        hidden_before: &before,
        hidden_now: &now,
        counts: &counts,
        counters: &counters,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, push));
    let (mut twin_before, mut twin_counters, mut twin_frame) = (expected.before.clone(), old, old_frame);
    let twin_counts =
        twin::parts::part_counts(list, &expected.in_sight, &mut twin_before, &expected.now, &mut twin_counters);
    let whole = [twin_counts.as_slice(), &[UNTOUCHED]].concat();
    same("counts", &gpu.read(&counts, 2 * n + 1), &whole)?;
    same("hidden before", &gpu.read(&before, twin_before.len()), &twin_before)?;

    let (mut twin_starts, total) = twin::scan::scan(&twin_counts);
    twin_starts.push(total);
    let starts = gpu.upload("starts", &twin_starts);
    let counts = gpu.upload("counts", &whole);
    let runs = gpu.upload("runs", &vec![UNTOUCHED_RUN; n + 1]);
    let dispatches = gpu.upload("dispatches", &[ListDispatches::default()]);
    let pass = PartRuns::new(gpu.device()).unwrap();
    let bindings = part_runs::Bindings {
        frame: &frame,
        parts_in_sight: &parts_in_sight,
        counts: &counts,
        starts: &starts,
        runs: &runs,
        dispatches: &dispatches,
        counters: &counters,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, push));
    let (mut twin_runs, twin_dispatches) = twin::parts::part_runs(
        list,
        &expected.in_sight,
        (&twin_counts, &twin_starts),
        &mut twin_frame,
        &mut twin_counters,
    );
    twin_runs.resize(n + 1, UNTOUCHED_RUN);
    same("runs", &gpu.read(&runs, n + 1), &twin_runs)?;
    same("dispatches", &gpu.read(&dispatches, 1), &[twin_dispatches])?;
    same("frame", &gpu.read(&frame, 1), &[twin_frame])?;
    same("counters", &gpu.read(&counters, 1), &[twin_counters])
}

#[test]
fn parity_of_lists() {
    let gpu = Gpu::new();
    for placed in [1, 2, 700, 3000] {
        let parts = parts(&mut Random::new(placed.into()), placed);
        for list in [LIST_FIRST, LIST_APPEARING, LIST_ALL] {
            compare(&gpu, list, &parts, &parts).unwrap();
        }
    }
    // nothing is in sight
    let nothing = Parts { in_sight: Vec::new(), before: vec![0; 4], now: vec![0; 4] };
    compare(&gpu, LIST_FIRST, &nothing, &nothing).unwrap();
    gpu.finish();
}

#[test]
fn a_difference_of_lists_is_seen() {
    let gpu = Gpu::new();
    let parts = parts(&mut Random::new(5), 300);
    let mut other = parts.clone();
    other.now[parts.in_sight[100].group as usize] ^= 1;
    assert_eq!(compare(&gpu, LIST_FIRST, &other, &parts).unwrap_err().buffer, "counts");
    let mut other = parts.clone();
    let begins = parts.in_sight.iter().position(|part| parts.now[part.group as usize] == 0).unwrap();
    other.in_sight[begins].first_patch_instance += 1 << 20;
    assert!(["counts", "runs"].contains(&compare(&gpu, LIST_FIRST, &other, &parts).unwrap_err().buffer));
    gpu.finish();
}

/// Lists "first" and "appearing" together have the patch instances of list "all", each once, and no others.
#[test]
fn what_appears_completes_what_was_drawn_first() {
    let parts = parts(&mut Random::new(8), 500);
    let listed = |list: u32, now: &[u32]| {
        let (mut before, mut counters) = (parts.before.clone(), Counters { hidden_parts: 1000, ..Counters::default() });
        let counts = twin::parts::part_counts(list, &parts.in_sight, &mut before, now, &mut counters);
        let (mut starts, total) = twin::scan::scan(&counts);
        starts.push(total);
        let mut frame = Frame { most_groups: 1 << 16, ..Frame::default() };
        let of = (counts.as_slice(), starts.as_slice());
        let (runs, _) = twin::parts::part_runs(list, &parts.in_sight, of, &mut frame, &mut counters);
        (0..frame.listed_patch_instances).map(|place| patch_instance_at(&runs, place)).collect::<Vec<_>>()
    };
    // before the test, `now` is the result of the frame before
    let (first, appearing, all) =
        (listed(LIST_FIRST, &parts.before), listed(LIST_APPEARING, &parts.now), listed(LIST_ALL, &parts.now));
    let mut both = [first.clone(), appearing.clone()].concat();
    both.sort_unstable();
    let in_sight: u32 = parts.in_sight.iter().map(|part| part.patch_instances).sum();
    assert!(!first.is_empty() && !appearing.is_empty() && all.len() < in_sight as usize);
    assert_eq!(both, all);
}

/// The pass behind `given` depths, against the twin behind `expected` ones; the number of hidden parts.
fn compare_cull(gpu: &Gpu, parts: &Parts, given: &Farthest, expected: &Farthest) -> Result<usize, Mismatch> {
    let size = SIZE.map(|pixels| pixels as f32);
    let frame = gpu.upload("frame", &[Frame { size, ..Frame::default() }]);
    let parts_in_sight = gpu.upload("parts in sight", &parts.in_sight);
    let (farthest, now) = (gpu.upload("farthest", &given.depths), gpu.upload("hidden now", &parts.now));
    let pass = CullParts::new(gpu.device()).unwrap();
    let bindings =
        cull_parts::Bindings { frame: &frame, parts_in_sight: &parts_in_sight, farthest: &farthest, hidden_now: &now };
    gpu.run(|cmd| pass.record(cmd, &bindings, parts.in_sight.len() as u32));
    let mut twin = parts.now.clone();
    for part in &parts.in_sight {
        twin[part.group as usize] = u32::from(twin::parts::cull_part(part, expected));
    }
    same("hidden now", &gpu.read(&now, twin.len()), &twin)?;
    Ok(parts.in_sight.iter().filter(|part| twin[part.group as usize] != 0).count())
}

/// Depths of a picture that shows a wall with a hole.
fn wall(depth: f32) -> Farthest {
    let is_hole = |i: u32| (i % SIZE[0]).abs_diff(130) < 9 && (i / SIZE[0]).abs_diff(200) < 9;
    let depths: Vec<f32> = (0..SIZE[0] * SIZE[1]).map(|i| if is_hole(i) { 0.0 } else { depth }).collect();
    Farthest::new(SIZE, &depths)
}

#[test]
fn parity_of_cull_parts_and_a_difference_is_seen() {
    let gpu = Gpu::new();
    let parts = parts(&mut Random::new(21), 900);
    let hidden = [0.3, 0.7].map(|depth| compare_cull(&gpu, &parts, &wall(depth), &wall(depth)).unwrap());
    assert!(hidden[0] > 20 && hidden[1] > hidden[0] && hidden[1] < parts.in_sight.len(), "{hidden:?}");
    let mismatch = compare_cull(&gpu, &parts, &wall(0.7), &wall(0.3)).unwrap_err();
    assert_eq!(mismatch.buffer, "hidden now");
    gpu.finish();
}
