//! Parity of the pass `density`: exact; if the GPU rounds differently, within 24 units in the last place.

use super::Case;
use super::harness::{Gpu, Mismatch, SceneBuffers, floats, same};
use super::shapes::cases;
use crate::frame::trim::density::{Bindings, Density};
use crate::twin;

fn compare(gpu: &Gpu, given: &Case, expected: &Case) -> Result<(), Mismatch> {
    let (strips, faces) = (given.data.bin_count as usize, given.data.face_instances.len());
    let s = SceneBuffers::new(gpu, given);
    let strip_heights = gpu.upload("strip heights", &vec![0.0f32; strips]);
    let face_speeds = gpu.upload("face speeds", &vec![0.0f32; 2 * faces]);
    let bins = !given.data.wide_strips.is_empty();
    let seen_bins = gpu.upload("seen bins", &vec![0u32; strips]);
    let pass = Density::new(gpu.device(), bins).unwrap();
    let bindings = Bindings {
        frame: &s.frame,
        views: &s.views,
        instances: &s.instances,
        face_instances: &s.face_instances,
        faces: &s.faces,
        cells: &s.cells,
        cell_instances: &s.cell_instances,
        strip_heights: &strip_heights,
        face_speeds: &face_speeds,
        seen_bins: bins.then_some(&seen_bins),
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, given.data.cell_instances.len() as u32));
    let twin = twin::density::density(&expected.frame, &expected.scene());
    floats("strip heights", &gpu.read(&strip_heights, strips), &twin.strip_heights, gpu.slack())?;
    if bins {
        same("seen bins", &gpu.read(&seen_bins, strips), &twin.seen_bins)?;
    }
    floats("face speeds", &gpu.read(&face_speeds, 2 * faces), twin.face_speeds.as_flattened(), gpu.slack())
}

#[test]
fn parity() {
    let gpus = Gpu::all();
    for case in cases() {
        let mut whole = case.clone();
        whole.frame.table_density = 12.5;
        for gpu in &gpus {
            compare(gpu, &case, &case).unwrap();
            compare(gpu, &whole, &whole).unwrap();
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

/// The same density everywhere, visible or not, at least that of each of these views.
#[test]
fn a_table_for_many_views_holds_each() {
    let mut more = 0;
    for case in cases() {
        let one = twin::density::density(&case.frame, &case.scene());
        let mut frame = case.frame;
        frame.table_density = one.face_speeds.iter().flatten().fold(0.0, |all: f32, speed| all.max(*speed));
        let many = twin::density::density(&frame, &case.scene());
        for ((one, many), seen) in one.strip_heights.iter().zip(&many.strip_heights).zip(&one.seen_bins) {
            assert!(one <= many);
            more += usize::from(*seen == 0 && *many > 0.0);
        }
        assert!(one.seen_bins.iter().zip(&many.seen_bins).all(|(one, many)| one & !many == 0));
    }
    assert!(more > 0, "every strip is seen in every view");
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let mut fast = case.clone();
    let last = fast.data.cells.len() - 1; // of the plate: the last strip of either instance
    fast.data.cells[last].speed_v *= 1.001;
    let mismatch = compare(&gpu, &fast, case).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("strip heights", case.data.bin_count as usize / 2 - 1));
    gpu.finish();
}
