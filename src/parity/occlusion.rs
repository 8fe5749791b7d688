//! Parity of the passes `cull_early` and `depth_pyramid`: exact. Parity of `cull_late`: with the twin's result in
//! double precision, with slack of either sign.

use super::harness::{Gpu, Mismatch, SceneBuffers, same};
use super::shapes::model_and_cameras;
use super::squares::drawn;
use super::{Case, Random};
use crate::abi::{Counters, square_side};
use crate::frame::occlusion::cull_early;
use crate::frame::occlusion::cull_late;
use crate::frame::occlusion::depth_pyramid;
use crate::model::Camera;
use crate::twin;
use crate::twin::occlusion::{Farthest, TAU_HIDDEN, is_drawn, lies_behind};
use glam::{DAffine3, DVec3};

/// In pixels, and a thousandth of it for depths: some roundings of single precision in pictures of this size.
const SLACK: f64 = 0.02;

/// The model of the other parities six times, one behind the other, and its cameras.
fn crowd() -> Vec<Case> {
    let (mut model, cameras) = model_and_cameras();
    let instances = model.instances.clone();
    for k in 1..6 {
        let behind = DAffine3::from_translation(DVec3::new(-9.0, 18.0, -13.5) * f64::from(k));
        let placed = instances.iter().map(|i| crate::model::Instance { transform: behind * i.transform, ..i.clone() });
        model.instances.extend(placed);
    }
    let far = |camera: Camera| Camera { depth_range: (camera.depth_range.0, 1000.0), ..camera };
    cameras.into_iter().map(|camera| Case::new(&model, &far(camera), 0.5)).collect()
}

fn taus(case: &Case) -> Vec<u32> {
    twin::bound::bound(&case.frame, &case.scene(), &mut Counters::default())
}

/// `all`: all patches count as hidden, whatever `given` says.
fn compare_cull_early(gpu: &Gpu, case: &Case, all: bool, given: &[u32], expected: &[u32]) -> Result<(), Mismatch> {
    let n = case.data.patch_instances.len();
    let s = SceneBuffers::new(gpu, case);
    let mut twin_taus = taus(case);
    let (hidden, taus) = (gpu.upload("hidden", given), gpu.upload("taus", &twin_taus));
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = cull_early::CullEarly::new(gpu.device(), all).unwrap();
    let bindings =
        cull_early::Bindings { frame: &s.frame, hidden: &hidden, taus: &taus, counters: &counters, runs: &s.runs };
    gpu.run(|cmd| pass.record(cmd, &bindings, n as u32));
    let marked = twin::occlusion::cull_early(expected, &mut twin_taus);
    same("taus", &gpu.read(&taus, n), &twin_taus)?;
    same("counters", &gpu.read(&counters, 1), &[Counters { hidden: marked, ..Counters::default() }])
}

#[test]
fn parity_of_hide_is_exact_and_sees_a_difference() {
    let gpu = Gpu::new();
    let case = &crowd()[0];
    let mut random = Random::new(9);
    let hidden: Vec<u32> = case.data.patch_instances.iter().map(|_| u32::from(random.integer(0, 3) > 0)).collect();
    compare_cull_early(&gpu, case, false, &hidden, &hidden).unwrap();
    compare_cull_early(&gpu, case, true, &hidden, &vec![1; hidden.len()]).unwrap();
    let mut other = hidden.clone();
    let seen = taus(case).iter().position(|tau| *tau != 0).unwrap();
    other[seen] ^= 1;
    let mismatch = compare_cull_early(&gpu, case, false, &other, &hidden).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("taus", seen));
    gpu.finish();
}

/// The pass over drawn triangles; `change` modifies the twin's input.
fn compare_farthest(gpu: &Gpu, case: &Case, change: impl FnOnce(&mut [f32])) -> Result<Farthest, Mismatch> {
    let size = (case.frame.size[0] as u32, case.frame.size[1] as u32);
    let side = square_side(size.into());
    assert!(!(size.0.is_multiple_of(side) && size.1.is_multiple_of(side)), "some squares are cut off: {size:?}");
    let mut picture = drawn(gpu, case, &mut Random::new(3), 40, size);
    change(&mut picture.depths);
    let twin = Farthest::new(size.into(), &picture.depths);
    let out = gpu.upload("farthest", &vec![9.0f32; twin.depths.len()]);
    let frame = gpu.upload("frame", &[case.frame]);
    let pass = depth_pyramid::DepthPyramid::new(gpu.device()).unwrap();
    gpu.run(|cmd| {
        pass.record(cmd, &depth_pyramid::Bindings { frame: &frame, depth: &picture.depth, farthest: &out });
    });
    same("farthest", &gpu.read(&out, twin.depths.len()), &twin.depths)?;
    Ok(twin)
}

/// A picture that ends within its last squares, tiles and blocks.
fn cut_off(case: &Case, size: [u32; 2]) -> Case {
    let mut case = case.clone();
    case.frame.size = size.map(|pixels| pixels as f32);
    case
}

#[test]
fn parity_of_farthest_is_exact_and_sees_a_difference() {
    let gpu = Gpu::new();
    let crowd = crowd();
    for (size, side) in [([477, 359], 4), ([243, 177], 2)] {
        assert_eq!(square_side(size), side);
        let case = cut_off(&crowd[0], size);
        let twin = compare_farthest(&gpu, &case, |_| {}).unwrap();
        assert!(twin.depths.contains(&0.0) && twin.depths.iter().any(|d| *d > 0.0));
        let at = (100 * size[0] + 200) as usize;
        compare_farthest(&gpu, &case, |depths| depths[at] = -1.0).unwrap_err();
    }
    gpu.finish();
}

/// The pass, against the twin with and without slack; returns the numbers of hidden patch instances and of visible
/// ones.
fn compare_cull_late(
    gpu: &Gpu,
    case: &Case,
    given: &Farthest,
    expected: &Farthest,
) -> Result<(usize, usize), Mismatch> {
    let n = case.data.patch_instances.len();
    let s = SceneBuffers::new(gpu, case);
    let mut old = taus(case);
    // every third was not drawn before
    old.iter_mut().step_by(3).filter(|tau| **tau != 0).for_each(|tau| *tau |= TAU_HIDDEN);
    let farthest = gpu.upload("farthest", &given.depths);
    let (taus, hidden) = (gpu.upload("taus", &old), gpu.upload("hidden", &vec![7u32; n]));
    let outside = gpu.upload("outside", &case.data.outside);
    let counters = gpu.upload("counters", &[Counters { hidden: 1000, ..Counters::default() }]);
    let pass = cull_late::CullLate::new(gpu.device(), case.data.has_rational).unwrap();
    let bindings = cull_late::Bindings {
        frame: &s.frame,
        views: &s.views,
        instances: &s.instances,
        face_instances: &s.face_instances,
        faces: &s.faces,
        patches: &s.patches,
        points: &s.points,
        patch_instances: &s.patch_instances,
        farthest: &farthest,
        taus: &taus,
        hidden: &hidden,
        outside: &outside,
        counters: &counters,
        runs: &s.runs,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, n as u32));
    let on_gpu: Vec<u32> = gpu.read(&hidden, n);
    let twin = |patch_instance: usize, slack: f64| {
        old[patch_instance] != 0
            && lies_behind(&case.frame, &case.scene(), patch_instance, old[patch_instance], expected, slack)
    };
    let is_wrong = |(patch_instance, &behind): (usize, &u32)| {
        if behind == 1 { !twin(patch_instance, -SLACK) } else { twin(patch_instance, SLACK) }
    };
    if let Some((index, behind)) = on_gpu.iter().enumerate().find(|found| is_wrong(*found)) {
        return Err(Mismatch { buffer: "hidden", index, values: format!("GPU {behind}") });
    }
    let told: Vec<_> =
        old.iter().zip(&on_gpu).map(|(tau, behind)| twin::occlusion::cull_late(*tau, *behind == 1)).collect();
    same("hidden", &on_gpu, &told.iter().map(|t| t.1).collect::<Vec<_>>())?;
    same("taus", &gpu.read(&taus, n), &told.iter().map(|t| t.0).collect::<Vec<_>>())?;
    let left = 1000 - told.iter().filter(|t| t.2).count() as u32;
    same("counters", &gpu.read(&counters, 1), &[Counters { hidden: left, ..Counters::default() }])?;
    let behind = on_gpu.iter().filter(|behind| **behind == 1).count();
    Ok((behind, old.iter().filter(|tau| is_drawn(**tau & !TAU_HIDDEN)).count() - behind))
}

/// Depths of a picture of the case's size that shows a wall with a hole.
fn wall(case: &Case, depth: f32) -> Farthest {
    let size = case.frame.size.map(|x| x as u32);
    let hole = |i: u32| (i % size[0]).abs_diff(size[0] / 2) < 20 && (i / size[0]).abs_diff(size[1] / 2) < 9;
    let depths: Vec<f32> = (0..size[0] * size[1]).map(|i| if hole(i) { 0.0 } else { depth }).collect();
    Farthest::new(size, &depths)
}

#[test]
fn parity_of_reveal() {
    let gpu = Gpu::new();
    let (mut behind, mut before) = (0, 0);
    for case in crowd() {
        // reversed depths of walls between the first of the crowd and the last
        let range = case.frame.far - case.frame.near;
        for share in [0.02, 0.05, 0.08, 0.1, 0.2] {
            let z = case.frame.near + share * range;
            let scale = if case.frame.perspective != 0 { case.frame.near / z } else { 1.0 };
            let wall = wall(&case, (case.frame.far - z) / range * scale);
            let (more_behind, more_before) = compare_cull_late(&gpu, &case, &wall, &wall).unwrap();
            (behind, before) = (behind + more_behind, before + more_before);
        }
    }
    assert!(behind > 100 && before > 100, "{behind} behind, {before} not");
    gpu.finish();
}

#[test]
fn a_difference_of_reveal_is_seen() {
    let gpu = Gpu::new();
    let case = &crowd()[0];
    let (near, nothing) = (wall(case, 1.0), wall(case, 0.0));
    compare_cull_late(&gpu, case, &near, &near).unwrap();
    assert_eq!(compare_cull_late(&gpu, case, &near, &nothing).unwrap_err().buffer, "hidden");
    assert_eq!(compare_cull_late(&gpu, case, &nothing, &near).unwrap_err().buffer, "hidden");
    gpu.finish();
}
