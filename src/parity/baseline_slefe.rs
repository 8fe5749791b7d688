//! Parity of the pass `baseline_slefe` with `Way::Ipass`, in double precision: the same factor, or its neighbour if the
//! value before rounding up is a whole number within single precision.

use super::harness::{Gpu, Mismatch, SceneBuffers, same};
use super::shapes::{model_and_cameras, model_with_sieve};
use super::{Case, placed, untrimmed};
use crate::abi::Counters;
use crate::baselines::factors::ipass;
use crate::baselines::slefe::{MOST_DEGREE, MOST_SEGMENTS, USUAL_SEGMENTS, words};
use crate::fixtures::Trial;
use crate::frame::baselines::slefe::{BaselineSlefe, Bindings};
use crate::model::{Camera, Model};
use crate::spline::{Control, Surface};
use crate::twin::MOST_SEGMENTS as MOST_FACTOR;
use glam::{DAffine3, DVec3, DVec4};

/// Single precision, relative to the factor.
const ROUNDING: f64 = 1e-4;

/// The factor of each patch instance of a model; 0 if it is not visible, infinite if there is no factor.
fn asked(model: &Model, camera: &Camera, tolerance_px: f64, segments: usize) -> Vec<f64> {
    let trials = Trial::of_model(model, camera, tolerance_px);
    trials.iter().map(|trial| if trial.tau == [0; 2] { 0.0 } else { ipass(trial, segments) }).collect()
}

fn is_near(tau: u32, asked: f64) -> bool {
    let most = f64::from(MOST_FACTOR);
    let whole = |share: f64| if asked > 1.0 { (asked * share).ceil().clamp(1.0, most) } else { asked };
    let range = whole(1.0 - ROUNDING)..=whole(1.0 + ROUNDING);
    tau & 0xffff == tau >> 16 && range.contains(&f64::from(tau >> 16))
}

fn compare(gpu: &Gpu, given: &Case, asked: &[f64], segments: usize) -> Result<Counters, Mismatch> {
    let count = given.data.patch_instances.len();
    let s = SceneBuffers::new(gpu, given);
    let taus = gpu.upload("taus", &vec![u32::MAX; count]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = BaselineSlefe::new(gpu.device(), false).unwrap();
    let bounded = s.bounded(&taus, &counters, None);
    let bindings = Bindings { bounded, slefes: &gpu.upload("slefes", &words(segments)) };
    gpu.run(|cmd| pass.record(cmd, &bindings, count as u32));
    let found = gpu.read(&taus, count);
    if let Some(index) = (0..count).find(|&i| !is_near(found[i], asked[i])) {
        let values = format!("GPU {} and {}, asked {}", found[index] & 0xffff, found[index] >> 16, asked[index]);
        return Err(Mismatch { buffer: "taus", index, values });
    }
    let clamps = asked.iter().filter(|&&a| a > f64::from(MOST_FACTOR)).count() as u32;
    let expected = Counters { clamps, ..Default::default() };
    same("counters", &gpu.read(&counters, 1), &[expected])?;
    Ok(expected)
}

/// A patch of each degree in the table, and of one more.
fn of_all_degrees() -> Model {
    let wavy = |n: usize, k: usize| {
        let point = |i: usize, j: usize| {
            let (x, y) = (i as f64 / n as f64 + 1.5 * n as f64, j as f64 / k as f64);
            DVec4::from_point(DVec3::new(x, y, 0.3 * (2.0 * i as f64).sin() * (3.0 * j as f64).cos()), 1.0)
        };
        let points = (0..=k).flat_map(|j| (0..=n).map(move |i| point(i, j))).collect();
        let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
        Surface::new((n, k), knots(n), knots(k), points).unwrap()
    };
    let most = MOST_DEGREE + 1;
    placed((1..=most).map(|n| untrimmed(wavy(n, most + 1 - n))).collect(), DAffine3::IDENTITY)
}

#[test]
fn parity() {
    let gpus = Gpu::all();
    let (model, cameras) = model_and_cameras();
    let (sieve, degrees) = (model_with_sieve(), of_all_degrees());
    let whole = Camera::around(degrees.bounds(), DVec3::new(1.0, -2.0, 1.5), DVec3::Z, 0.6, (480, 360));
    let of_shapes = cameras.iter().flat_map(|camera| [(&model, camera, 0.5), (&sieve, camera, 0.5)]);
    let loose_and_tight = [(&model, &cameras[0], 4.0), (&model, &cameras[0], 1e-6), (&degrees, &whole, 0.5)];
    for (model, camera, tolerance_px) in of_shapes.chain(loose_and_tight) {
        let case = Case::new(model, camera, tolerance_px);
        for segments in [1, USUAL_SEGMENTS, MOST_SEGMENTS] {
            let asked = asked(model, camera, tolerance_px, segments);
            for gpu in &gpus {
                let clamps = compare(gpu, &case, &asked, segments).unwrap().clamps;
                // patches at the near plane, patches with large factors, patches of degree 10
                let clamped = camera.eye == cameras[1].eye || tolerance_px < 1e-3 || std::ptr::eq(model, &degrees);
                assert_eq!(clamps > 0, clamped, "{clamps} clamps of {asked:?}");
            }
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let (model, cameras) = model_and_cameras();
    let asked = asked(&model, &cameras[0], 0.5, USUAL_SEGMENTS);
    let mut bent = Case::new(&model, &cameras[0], 0.5);
    let patch_instance = 3; // of the ball, whose patches come first
    let middle = bent.data.patches[patch_instance].first as usize + 4;
    bent.data.points[middle][2] += 1.0;
    let mismatch = compare(&gpu, &bent, &asked, USUAL_SEGMENTS).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("taus", patch_instance));
    gpu.finish();
}
