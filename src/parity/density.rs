//! Parity of the pass `density`: exact; where the GPU rounds otherwise, within 24 units in the last place.

use super::Case;
use super::harness::{Gpu, Mismatch, SceneBuffers, floats, same};
use super::placed;
use super::shapes::{cases, model_and_cameras};
use crate::abi;
use crate::model::{Camera, Projection};
use crate::passes::density::{Bindings, Density};
use crate::twin;
use glam::{DAffine3, DVec3, DVec4};

fn compare(gpu: &Gpu, given: &Case, expected: &Case) -> Result<(), Mismatch> {
    let (strips, faces) = (given.data.bay_count as usize, given.data.face_instances.len());
    let s = SceneBuffers::new(gpu, given);
    let strip_heights = gpu.upload("strip heights", &vec![0.0f32; strips]);
    let face_speeds = gpu.upload("face speeds", &vec![0.0f32; 2 * faces]);
    let bays = !given.data.wide_strips.is_empty();
    let seen_bays = gpu.upload("seen bays", &vec![0u32; strips]);
    let pass = Density::new(gpu.device(), false, bays).unwrap();
    let bindings = Bindings {
        frame: &s.frame,
        views: &s.views,
        instances: &s.instances,
        face_instances: &s.face_instances,
        faces: &s.faces,
        cells: &s.cells,
        cell_items: &s.cell_items,
        strip_heights: &strip_heights,
        face_speeds: &face_speeds,
        drawn_faces: None,
        seen_bays: bays.then_some(&seen_bays),
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, given.data.cell_items.len() as u32));
    let twin = twin::density::density(&expected.frame, &expected.scene());
    floats("strip heights", &gpu.read(&strip_heights, strips), &twin.strip_heights, gpu.slack())?;
    if bays {
        same("seen bays", &gpu.read(&seen_bays, strips), &twin.seen_bays)?;
    }
    floats("face speeds", &gpu.read(&face_speeds, 2 * faces), twin.face_speeds.as_flattened(), gpu.slack())
}

#[test]
fn parity() {
    let gpu = Gpu::new();
    for case in cases() {
        compare(&gpu, &case, &case).unwrap();
    }
    gpu.finish();
}

/// Pixels per unit of `v` at points of trim curves, in double precision, are no more than the strip's height says.
#[test]
fn no_strip_is_lower_than_its_curves_are_seen() {
    let mut points = 0;
    for case in cases() {
        let data = &case.data;
        let heights = twin::density::density(&case.frame, &case.scene()).strip_heights;
        let size = case.frame.size.map(f64::from);
        for (item, &placed) in data.curve_items.iter().enumerate() {
            let placed = data.face_instances[placed as usize];
            let face = data.faces[placed.face as usize];
            let curve = data.curves[face.first_curve as usize + item - placed.first_curve as usize];
            let view = &case.views[placed.instance as usize];
            let patches = &data.patches[face.first_patch as usize..][..(face.count_u * face.count_v) as usize];
            let times = |row: [f32; 4], p: DVec4| DVec4::from(row.map(f64::from)).dot(p);
            for k in 0..=20 {
                let at = twin::curve::curve_point(&curve, &data.curve_points, k, 20).map(f64::from);
                let within = |p: &&abi::Patch| {
                    let d = p.domain.map(f64::from);
                    (0..2).all(|k| (d[k]..=d[k] + d[k + 2]).contains(&at[k]))
                };
                let Some(packed) = patches.iter().find(within) else { continue };
                let d = packed.domain.map(f64::from);
                let jet = case.patch(packed).jet((at[0] - d[0]) / d[2], (at[1] - d[1]) / d[3]);
                let (p, along) = (jet.point.extend(1.0), (jet.dv / d[3]).extend(0.0));
                let w = times(view.w, p);
                let pixel = [view.x, view.y].map(|row| times(row, p) / w);
                let is_seen = times(view.depth, p) > f64::from(case.frame.near);
                let strips = f64::from(face.strip_count());
                let is_at_border = (at[1] * strips - (at[1] * strips).round()).abs() < 1e-4; // either strip may have it
                if !is_seen || is_at_border || (0..2).any(|k| !(0.0..size[k]).contains(&pixel[k])) {
                    continue;
                }
                let [x, y] = [0, 1].map(|k| (times([view.x, view.y][k], along) - pixel[k] * times(view.w, along)) / w);
                let strip = (at[1] * strips) as u32;
                let height = f64::from(heights[(placed.first_bay + strip * face.bay_count()) as usize]);
                assert!(x.hypot(y) / strips <= height * (1.0 + 1e-6), "{} of {height} px", x.hypot(y) / strips);
                points += 1;
            }
        }
    }
    assert!(points > 10_000, "{points} points");
}

/// Strips of a plate that is seen along `v`, nearly edge-on, are hardly any pixels high; across `v` they are whole.
#[test]
fn a_strip_that_is_seen_at_an_angle_is_lower() {
    let (model, _) = model_and_cameras();
    let plate = model.parts[0].faces.last().unwrap().clone();
    let model = placed(vec![plate], DAffine3::IDENTITY);
    let height = |from: DVec3| {
        let camera = Camera::framing(model.bounds(), from, DVec3::Z, 0.6, (480, 360));
        let parallel = Camera { projection: Projection::Orthographic { height: 30.0 }, ..camera };
        let case = Case::new(&model, &parallel, 0.5);
        twin::density::density(&case.frame, &case.scene()).strip_heights.iter().copied().fold(0.0, f32::max)
    };
    let (along, across) = (height(DVec3::new(0.0, -1.0, 0.05)), height(DVec3::new(-1.0, 0.0, 0.05)));
    assert!(along < 0.06 * across && along > 0.04 * across, "{along} and {across} px");
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let mut fast = case.clone();
    let last = fast.data.cells.len() - 1; // of the plate: the last strip of either instance
    fast.data.cells[last].speed_v *= 1.001;
    let mismatch = compare(&gpu, &fast, case).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("strip heights", case.data.bay_count as usize / 2 - 1));
    gpu.finish();
}
