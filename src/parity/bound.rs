//! Parity of the pass `bound`: exact; if the GPU rounds differently, a factor may differ by one.

use super::chain::UNTOUCHED;
use super::harness::{Gpu, Mismatch, SceneBuffers, halves, same};
use super::shapes::cases;
use super::{Case, cages};
use crate::abi::{Counters, FACE_SAME_SENSE};
use crate::frame::tessellation::bound::Bound;
use crate::model::{Camera, Projection};
use crate::twin;
use glam::{DAffine3, DVec3};

fn compare(gpu: &Gpu, given: &Case, expected: &Case) -> Result<(), Mismatch> {
    let count = given.data.patch_instances.len();
    let s = SceneBuffers::new(gpu, given);
    let taus = gpu.upload("taus", &vec![UNTOUCHED; count]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let cones = (!given.data.cones.is_empty()).then(|| gpu.upload("cones", &given.data.cones));
    let pass = Bound::new(gpu.device(), !given.data.cones.is_empty()).unwrap();
    let bindings = s.bounded(&taus, &counters, cones.as_ref());
    gpu.run(|cmd| pass.record(cmd, &bindings, count as u32));
    let mut clamps = Counters::default();
    let twin = twin::bound::bound(&expected.frame, &expected.scene(), &mut clamps);
    halves("taus", &gpu.read(&taus, count), &twin, gpu.slack())?;
    same("counters", &gpu.read(&counters, 1), &[clamps])
}

#[test]
fn parity() {
    let gpus = Gpu::all();
    for case in cases() {
        // so tight that some factors exceed the largest split
        let mut fine = case.clone();
        fine.frame.deviation_px *= 1e-6;
        let mut counters = Counters::default();
        twin::bound::bound(&fine.frame, &fine.scene(), &mut counters);
        assert!(counters.clamps > 0);
        for gpu in &gpus {
            compare(gpu, &case, &case).unwrap();
            compare(gpu, &fine, &fine).unwrap();
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

/// A closed part without trims, unchanged and mirrored, from all sides; every third view is parallel.
fn seamless() -> Vec<(Camera, Case)> {
    let mut model = cages::a_box().model;
    let mut other = model.instances[0].clone();
    let aside = DAffine3::from_translation(DVec3::new(9.0, 1.0, -2.0));
    other.transform = aside * DAffine3::from_scale(DVec3::new(1.0, -0.5, 2.0));
    model.instances.push(other);
    let case = |k: u32| {
        let (a, b) = (2.4 * f64::from(k), f64::from(k) / 6.0 - 0.9);
        let from = DVec3::new(a.cos(), a.sin(), b);
        let camera = Camera::around(model.bounds(), from, DVec3::Z, 0.6, (480, 360));
        let parallel = Camera { projection: Projection::Orthographic { height: 12.0 }, ..camera };
        let camera = if k.is_multiple_of(3) { parallel } else { camera };
        (camera, Case::new(&model, &camera, 0.5))
    };
    (0..12).map(case).collect()
}

/// Whether every outward normal of a patch instance's patch points away from the viewer: in double precision, at 13 by
/// 13 points.
fn faces_away(case: &Case, camera: &Camera, patch_instance: usize) -> bool {
    let data = &case.data;
    let placed = data.face_instances[data.patch_instances[patch_instance] as usize];
    let face = data.faces[placed.face as usize];
    let packed = &data.patches[face.first_patch as usize + patch_instance - placed.first_patch_instance as usize];
    let patch = case.patch(packed);
    let to_model = data.placements[placed.instance as usize];
    let outward = if face.flags & FACE_SAME_SENSE != 0 { 1.0 } else { -1.0 } * to_model.matrix3.determinant().signum();
    (0..169).all(|c| {
        let jet = patch.jet(f64::from(c % 13) / 12.0, f64::from(c / 13) / 12.0);
        let normal = to_model.transform_vector3(jet.du).cross(to_model.transform_vector3(jet.dv)) * outward;
        let towards = match camera.projection {
            Projection::Orthographic { .. } => camera.axes().2,
            _ => to_model.transform_point3(jet.point) - camera.eye,
        };
        normal.dot(towards) >= 0.0
    })
}

/// Patches turned away are left out, and patches that are left out are turned away as a whole.
#[test]
fn parity_of_what_looks_away() {
    let gpu = Gpu::new();
    let cases = seamless();
    for (camera, case) in &cases {
        compare(&gpu, case, case).unwrap();
        let mut all = case.clone();
        all.data.cones.clear();
        let with = twin::bound::bound(&case.frame, &case.scene(), &mut Counters::default());
        let without = twin::bound::bound(&all.frame, &all.scene(), &mut Counters::default());
        let left_out = || (0..with.len()).filter(|&patch_instance| with[patch_instance] != without[patch_instance]);
        assert!(left_out().all(|patch_instance| with[patch_instance] == 0));
        let share = left_out().count() as f64 / with.len() as f64;
        assert!((0.15..0.5).contains(&share), "{share} of the patches are left out");
        for patch_instance in left_out() {
            assert!(faces_away(case, camera, patch_instance), "patch instance {patch_instance}");
        }
    }
    let case = &cases[1].1;
    let mut other = case.clone();
    other.data.cones.iter_mut().for_each(|cone| (0..3).for_each(|k| cone[k] = -cone[k]));
    assert_eq!(compare(&gpu, &other, case).unwrap_err().buffer, "taus");
    gpu.finish();
}

/// For a polynomial patch the control points themselves are projected, and fewer segments may suffice than for its bend
/// alone.
#[test]
fn parity_of_what_moves_no_pixel() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let of = |case: &Case| twin::bound::bound(&case.frame, &case.scene(), &mut Counters::default());
    let mut rational = case.clone();
    rational.data.patches.iter_mut().for_each(|patch| patch.shape |= 1 << 8);
    let (with, without) = (of(case), of(&rational));
    let fewer = with.iter().zip(&without).position(|(a, b)| a != b).expect("a patch that bends towards the eye");
    let quads = |tau: u32| (tau & 0xffff) * (tau >> 16);
    assert!(quads(with[fewer]) < quads(without[fewer]));
    compare(&gpu, &rational, &rational).unwrap();
    assert_eq!(compare(&gpu, &rational, case).unwrap_err().buffer, "taus");
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let mut bent = case.clone();
    let patch_instance = 3; // of the ball, whose patches come first
    bent.data.patches[patch_instance].bend[0] *= 16.0; // four times the factor, whatever it was
    let mismatch = compare(&gpu, &bent, case).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("taus", patch_instance));
    gpu.finish();
}
