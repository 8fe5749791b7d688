//! Parity of the pass `split`: exact, since it uses only integers.

use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, SceneBuffers, same};
use super::shapes::{cases, four_lists};
use super::{Case, Random, cages};
use crate::abi::{Factors, Frame};
use crate::frame::tessellation::split::Split;
use crate::model::Camera;
use crate::twin;
use glam::DVec3;

fn compare(gpu: &Gpu, case: &Case, given: &[u32], expected: &[u32]) -> Result<(), Mismatch> {
    let n = given.len();
    let s = SceneBuffers::new(gpu, case);
    let taus = gpu.upload("taus", given);
    let factors = gpu.upload("factors", &vec![UNTOUCHED; n * size_of::<Factors>() / 4]);
    let counted = case.frame.patch_lists() as usize * n;
    let [sub_patch_counts, vertex_counts] =
        ["sub-patch counts", "vertex counts"].map(|name| gpu.upload(name, &vec![UNTOUCHED; counted]));
    let links = (!case.data.links.is_empty()).then(|| gpu.upload("links", &case.data.links));
    let pass = Split::new(gpu.device(), links.is_some()).unwrap();
    let bindings = s.split(&taus, &factors, [&sub_patch_counts, &vertex_counts], links.as_ref());
    gpu.run(|cmd| pass.record(cmd, &bindings, n as u32));
    let twin = twin::split::split(&case.frame, &case.scene(), expected);
    same("factors", &gpu.read(&factors, n), &twin.factors)?;
    same("sub-patch counts", &gpu.read(&sub_patch_counts, counted), &twin.sub_patch_counts)?;
    same("vertex counts", &gpu.read(&vertex_counts, counted), &twin.vertex_counts)
}

#[test]
fn parity() {
    for gpu in Gpu::all() {
        for case in cases() {
            let taus = Chain::new(&case).taus;
            compare(&gpu, &case, &taus, &taus).unwrap();
        }
        // the same grids with factors of every size, and patches out of sight
        let (case, mut random) = (&cases()[0], Random::new(1));
        for _ in 0..20 {
            let mut tau = || (1 << random.integer(0, 12)).max(random.integer(1, 4096)).min(random.integer(1, 4096));
            let mut taus: Vec<u32> = case.data.patch_instances.iter().map(|_| tau() | tau() << 16).collect();
            taus.iter_mut().step_by(5).for_each(|t| *t = 0);
            compare(&gpu, case, &taus, &taus).unwrap();
        }
        gpu.finish();
    }
}

/// Faces that share sides, whole and in parts.
#[test]
fn parity_of_shared_sides() {
    let gpu = Gpu::new();
    let (model, mut random) = (cages::a_box().model, Random::new(3));
    let camera = Camera::around(model.bounds(), DVec3::new(1.0, -2.0, 1.5), DVec3::Z, 0.6, (480, 360));
    let case = Case::new(&model, &camera, 0.5);
    assert!(case.data.links.iter().any(|link| link.halvings() > 0));
    let taus = Chain::new(&case).taus;
    assert!(taus.iter().any(|t| *t != 0));
    compare(&gpu, &case, &taus, &taus).unwrap();
    for largest in [1, 3, 20, 64, 300, 4096] {
        let mut tau = || random.integer(1, largest);
        let mut taus: Vec<u32> = case.data.patch_instances.iter().map(|_| tau() | tau() << 16).collect();
        taus.iter_mut().step_by(5).for_each(|t| *t = 0);
        compare(&gpu, &case, &taus, &taus).unwrap();
        // a changed patch changes the other patches at its sides
        let mut other = taus.clone();
        let at = case.data.links.iter().position(|link| link.halvings() > 0).unwrap() / 4;
        other[at] = 4096 | 4096 << 16;
        assert_eq!(compare(&gpu, &case, &other, &taus).unwrap_err().buffer, "factors");
    }
    gpu.finish();
}

/// With lists of patches that are drawn by their corners: of plain ones, of trimmed ones.
#[test]
fn parity_of_four_lists() {
    let gpu = Gpu::new();
    let (case, taus) = four_lists();
    compare(&gpu, &case, &taus, &taus).unwrap();
    let (twin, n) = (Chain::of_taus(&case, &taus).split, taus.len());
    let members =
        |list: usize| twin.sub_patch_counts[list * n..(list + 1) * n].iter().filter(|count| **count > 0).count();
    assert!((0..4).all(|list| members(list) > 1), "{:?}", twin.sub_patch_counts);
    for corner_lists in [0, 1] {
        let fewer = Case { frame: Frame { corner_lists, ..case.frame }, ..case.clone() };
        compare(&gpu, &fewer, &taus, &taus).unwrap();
    }
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let taus = Chain::new(case).taus;
    let mut other = taus.clone();
    other[5] = other[5] & 0xffff | 60 << 16;
    let mismatch = compare(&gpu, case, &other, &taus).unwrap_err();
    // patches 4 and 6 of the ball share the sides u = 0 and u = 1 of patch 5
    assert_eq!((mismatch.buffer, mismatch.index), ("factors", 4));
    gpu.finish();
}
