//! Parity of passes `bound`, `split` and `emit` where some placed parts are out of sight. The twins compute all patch
//! instances. For patch instances in sight the passes write the same, and for the others nothing. Exact.

use super::Case;
use super::chain::{Chain, UNTOUCHED, UNTOUCHED_SUB_PATCH};
use super::harness::{Gpu, Mismatch, SceneBuffers, halves, same};
use super::shapes::model_and_cameras;
use crate::abi::{Counters, Factors, Frame, PatchRun};
use crate::frame::tessellation::{bound, emit, split};
use crate::twin;
use crate::twin::in_sight::patch_instance_at;
use std::ops::Range;

/// The patch instances of each placed part.
fn parts(case: &Case) -> Vec<Range<u32>> {
    let of = &case.data.face_instances;
    let firsts: Vec<u32> =
        of.chunk_by(|a, b| a.instance == b.instance).map(|faces| faces[0].first_patch_instance).collect();
    let ends = firsts[1..].iter().copied().chain([case.data.patch_instances.len() as u32]);
    firsts.iter().copied().zip(ends).map(|(first, end)| first..end).collect()
}

/// The case with two placed parts of every three in sight.
fn two_thirds(mut case: Case) -> Case {
    let (mut runs, mut place): (Vec<PatchRun>, u32) = (Vec::new(), 0);
    for (nth, patch_instances) in parts(&case).into_iter().enumerate().filter(|(nth, _)| nth % 3 != 0) {
        if nth % 3 == 1 {
            runs.push(PatchRun { place, patch_instance: patch_instances.start });
        }
        place += patch_instances.end - patch_instances.start;
    }
    case.frame = Frame { listed_patch_instances: place, run_count: runs.len() as u32, ..case.frame };
    case.runs = runs;
    case
}

/// The values of the patch instances in sight, in the order of their places.
fn gathered<T: Copy>(case: &Case, all: &[T]) -> Vec<T> {
    (0..case.frame.listed_patch_instances).map(|place| all[patch_instance_at(&case.runs, place) as usize]).collect()
}

/// The values of all patch instances, with `untouched` for those out of sight.
fn masked<T: Copy>(case: &Case, all: &[T], untouched: T) -> Vec<T> {
    let mut left = vec![untouched; all.len()];
    (0..case.frame.listed_patch_instances)
        .map(|place| patch_instance_at(&case.runs, place) as usize)
        .for_each(|i| left[i] = all[i]);
    left
}

/// The GPU gets `given`; the twins get `case`, which also decides which patch instances are in sight.
fn compare(gpu: &Gpu, given: &Case, case: &Case) -> Result<(), Mismatch> {
    let all = Chain::new(&Case {
        frame: Frame { listed_patch_instances: case.data.patch_instances.len() as u32, ..case.frame },
        ..case.clone()
    });
    let (s, n, total) =
        (SceneBuffers::new(gpu, given), case.frame.listed_patch_instances, case.data.patch_instances.len());

    let taus = gpu.upload("taus", &vec![UNTOUCHED; total]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let cones = (!case.data.cones.is_empty()).then(|| gpu.upload("cones", &case.data.cones));
    let pass = bound::Bound::new(gpu.device(), cones.is_some()).unwrap();
    gpu.run(|cmd| pass.record(cmd, &s.bounded(&taus, &counters, cones.as_ref()), n));
    halves("taus", &gpu.read(&taus, total), &masked(case, &all.taus, UNTOUCHED), gpu.slack())?;

    let taus = gpu.upload("taus", &masked(case, &all.taus, UNTOUCHED));
    let untouched = Factors { inner: UNTOUCHED, edge_u: UNTOUCHED, edge_v: UNTOUCHED, splits: UNTOUCHED };
    let factors = gpu.upload("factors", &vec![untouched; total]);
    let [sub_patch_counts, vertex_counts] =
        ["sub-patch counts", "vertex counts"].map(|name| gpu.upload(name, &vec![UNTOUCHED; 2 * total]));
    let links = (!case.data.links.is_empty()).then(|| gpu.upload("links", &case.data.links));
    let pass = split::Split::new(gpu.device(), links.is_some()).unwrap();
    let bindings = s.split(&taus, &factors, [&sub_patch_counts, &vertex_counts], links.as_ref());
    gpu.run(|cmd| pass.record(cmd, &bindings, n));
    same("factors", &gpu.read(&factors, total), &masked(case, &all.split.factors, untouched))?;
    let counts = |all: &[u32]| [gathered(case, &all[..total]), gathered(case, &all[total..])].concat();
    let (of_sub_patches, of_vertices) = (counts(&all.split.sub_patch_counts), counts(&all.split.vertex_counts));
    same("sub-patch counts", &gpu.read(&sub_patch_counts, 2 * n as usize), &of_sub_patches)?;
    same("vertex counts", &gpu.read(&vertex_counts, 2 * n as usize), &of_vertices)?;

    let starts = |counts: &[u32]| {
        let (mut starts, total) = twin::scan::scan(counts);
        starts.push(total);
        starts
    };
    let (sub_patch_starts, vertex_starts) = (starts(&of_sub_patches), starts(&of_vertices));
    let list = vec![UNTOUCHED_SUB_PATCH; case.frame.sub_patch_capacity as usize];
    let (empty, zero) = twin::reset::reset(&case.frame);
    let (sub_patches, draws) = (gpu.upload("sub-patches", &list), gpu.upload("draws", &empty));
    let counters = gpu.upload("counters", &[zero]);
    let pass = emit::Emit::new(gpu.device()).unwrap();
    let bindings = emit::Bindings {
        frame: &s.frame,
        factors: &factors,
        sub_patch_starts: &gpu.upload("sub-patch starts", &sub_patch_starts),
        vertex_starts: &gpu.upload("vertex starts", &vertex_starts),
        sub_patches: &sub_patches,
        draws: &draws,
        counters: &counters,
        runs: &s.runs,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, n));
    // the twin gets only the patch instances in sight, and numbers them by their places
    let (mut twin_list, mut twin_draws, mut twin_counters) = (list, empty, zero);
    twin::emit::emit(
        &case.frame,
        &gathered(case, &all.split.factors),
        &sub_patch_starts,
        &vertex_starts,
        (&mut twin_list, &mut twin_draws),
        &mut twin_counters,
    );
    let listed = twin_list.iter_mut().filter(|sub_patch| sub_patch.patch_instance != UNTOUCHED);
    listed.for_each(|sub_patch| sub_patch.patch_instance = patch_instance_at(&case.runs, sub_patch.patch_instance));
    same("sub-patches", &gpu.read(&sub_patches, twin_list.len()), &twin_list)?;
    same("draws", &gpu.read(&draws, twin_draws.len()), &twin_draws)?;
    same("counters", &gpu.read(&counters, 1), &[twin_counters])
}

fn cases() -> Vec<Case> {
    let (mut model, cameras) = model_and_cameras();
    let instances = model.instances.clone();
    (0..4).for_each(|_| model.instances.extend(instances.iter().cloned()));
    cameras.iter().map(|camera| two_thirds(Case::new(&model, camera, 0.5))).collect()
}

#[test]
fn parity() {
    let gpu = Gpu::new();
    for case in cases() {
        assert!(case.runs.len() > 1 && (case.frame.listed_patch_instances as usize) < case.data.patch_instances.len());
        compare(&gpu, &case, &case).unwrap();
    }
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let mut other = case.clone();
    other.runs[1].patch_instance += 1;
    assert_eq!(compare(&gpu, &other, case).unwrap_err().buffer, "taus");
    gpu.finish();
}

/// Each place has the patch instance that was counted by hand.
#[test]
fn places_have_the_patch_instances_of_their_runs() {
    let runs = [(0, 3), (2, 9), (3, 20)].map(|(place, patch_instance)| PatchRun { place, patch_instance });
    let patch_instances: Vec<u32> = (0..6).map(|place| patch_instance_at(&runs, place)).collect();
    assert_eq!(patch_instances, [3, 4, 9, 20, 21, 22]);
}
