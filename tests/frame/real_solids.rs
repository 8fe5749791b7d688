//! Closed solids of real files, as a whole and closer to where two faces meet: no background within their outline, and
//! no pixel changed where there was no crack.
//!
//! Run by name, with `SELVEDGE_MODELS` set to a folder of STEP and IGES files; files with closed parts only are drawn.
//! Takes many minutes.

use crate::support::render;
use glam::{DVec2, DVec3};
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, Model};
use selvedge::picture::Picture;
use selvedge_check::{JudgeOptions, Tracer, judge};
use std::path::{Path, PathBuf};

const SIZE: (u32, u32) = (320, 180);
const ZOOMS: [f64; 3] = [1.0, 8.0, 64.0];

/// STEP and IGES files of a folder and of its subfolders.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for path in entries.map(|entry| entry.expect("an entry of the folder").path()) {
        if path.is_dir() {
            files(&path, found);
        }
        let end = path.extension().map(|end| end.to_string_lossy().to_lowercase()).unwrap_or_default();
        if ["step", "stp", "iges", "igs"].contains(&end.as_str()) {
            found.push(path);
        }
    }
}

fn is_closed(model: &Model) -> bool {
    let closed = |part: usize| model.parts[part].closed && !model.parts[part].faces.is_empty();
    !model.instances.is_empty() && model.solids.is_empty() && model.instances.iter().all(|i| closed(i.part))
}

/// A view this many times closer to the change of faces nearest to the picture's middle.
fn closer(whole: &Camera, picture: &Picture, times: f64) -> Camera {
    let (w, h) = (SIZE.0 as usize, SIZE.1 as usize);
    let seen = |i: usize| picture.face[i] != 0 && picture.depth[i].is_finite();
    let change = |&i: &usize| seen(i) && seen(i + 1) && picture.face[i] != picture.face[i + 1];
    let off = |i: &usize| (i % w).abs_diff(w / 2).pow(2) + (i / w).abs_diff(h / 2).pow(2);
    let at = (0..w * h - 1).filter(|i| i % w + 1 < w).filter(change).min_by_key(off);
    let Some(at) = at else { return Camera { eye: whole.target + (whole.eye - whole.target) / times, ..*whole } };
    let (origin, direction) = whole.ray(DVec2::new((at % w + 1) as f64, (at / w) as f64 + 0.5));
    let target = origin + direction * (f64::from(picture.depth[at]) / direction.dot(whole.axes().2));
    Camera { eye: target + (whole.eye - whole.target) / times, target, ..*whole }
}

#[test]
#[ignore = "minutes: tools/soak"]
fn closed_solids_of_real_files_have_no_cracks() {
    let folder = std::env::var_os("SELVEDGE_MODELS").map(PathBuf::from).expect("SELVEDGE_MODELS names a folder");
    let mut paths = Vec::new();
    files(&folder, &mut paths);
    paths.sort();
    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default()).expect("this test needs Vulkan");
    let (mut faults, mut solids) = (Vec::new(), 0);
    for path in &paths {
        let name = path.file_name().expect("a file").to_string_lossy();
        let model = match selvedge_io::import::open(path) {
            Ok(import) if is_closed(&import.model) => import.model,
            Ok(_) => {
                eprintln!("{name}: not closed, not judged");
                continue;
            }
            Err(error) => panic!("{name}: {error}"),
        };
        solids += 1;
        let tracer = Tracer::new(&model);
        renderer.upload(&model).expect("room for the model");
        let whole =
            Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 35f64.to_radians(), SIZE);
        let first = render(&mut renderer, &whole);
        for times in ZOOMS {
            let mut camera = if times > 1.0 { closer(&whole, &first, times) } else { whole };
            camera.fit_depth(model.control_bounds());
            let picture = render(&mut renderer, &camera);
            let tie = JudgeOptions::default().tie / times;
            let options = JudgeOptions { tie, listed: usize::MAX, ..JudgeOptions::default() };
            let j = judge(&tracer, &camera, &picture.images(), &options);
            let holes = j.mismatches.iter().filter(|m| m.drawn == 0).count();
            let changed = j.wrong - holes as u64 + j.folds.beyond + j.folds.wrong_depth;
            let inside = picture.face.iter().filter(|&&id| id != 0).count();
            let (shift, clamps) = (j.worst_shift_px.max(j.folds.worst_shift_px), picture.stats.clamps);
            eprintln!("{name:44} {times:3} x  {inside:6} px, {holes} holes, {changed} changed, worst {shift:.3} px");
            if (holes, changed, clamps, j.given_up) != (0, 0, 0, 0) {
                let first = &j.mismatches[..j.mismatches.len().min(3)];
                faults.push(format!("{name} {times} x: {holes} holes, {changed} changed, {clamps} clamps: {first:?}"));
            }
        }
    }
    assert!(solids > 0, "{} holds no closed solid", folder.display());
    let messages = renderer.shutdown();
    assert!(faults.is_empty() && messages.is_empty(), "{}\n{}", faults.join("\n"), messages.join("\n"));
}
