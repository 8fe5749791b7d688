//! Every example runs and does what it states. Needs a Vulkan driver.

#![allow(dead_code)] // their `main`

use selvedge::glam::{DAffine3, DVec3};
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs};
use std::path::{Path, PathBuf};

#[path = "../examples/arrays.rs"]
mod arrays;
#[path = "../examples/boolean_solid.rs"]
mod boolean_solid;
#[path = "../examples/edit_trim.rs"]
mod edit_trim;
#[path = "../examples/host_engine/main.rs"]
mod host_engine;
#[path = "../examples/render_to_png.rs"]
mod render_to_png;
#[path = "../examples/two_views.rs"]
mod two_views;

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)
}

#[test]
fn a_png_has_the_picture() {
    let png = std::env::temp_dir().join(format!("selvedge-example-{}.png", std::process::id()));
    render_to_png::run(&sample("bracket.step"), &png, (64, 48)).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&png).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    std::fs::remove_file(&png).unwrap();
    let drawn = pixels.chunks(4).filter(|c| c[..3] != [255; 3]).count();
    assert_eq!(pixels.len(), 64 * 48 * 4);
    assert!(drawn > 400, "{drawn} pixels are not white");
    let missing = render_to_png::run(&sample("none.step"), &png, (64, 48)).unwrap_err();
    assert!(missing.to_string().contains("none.step"), "{missing}");
}

#[test]
fn arrays_tell_of_faces() {
    let faces = arrays::run(&sample("bracket.step"), (64, 48)).unwrap();
    assert!(faces.len() > 3, "{} faces are seen", faces.len());
    assert!(faces.values().all(|seen| seen.pixels > 0 && seen.nearest <= seen.farthest && seen.farthest.is_finite()));
}

#[test]
fn a_solid_shows_all_of_its_primitives() {
    let picture = boolean_solid::run((64, 48)).unwrap();
    for id in 1..=3 {
        assert!(picture.face.contains(&id), "primitive {id}");
    }
}

#[test]
fn an_edit_moves_a_hole() {
    let edit = edit_trim::run(&sample("bracket.step"), (160, 120)).unwrap();
    assert!(edit.pixels > 0 && edit.bytes > 0 && edit.bytes < 1 << 16, "{} pixels, {} bytes", edit.pixels, edit.bytes);
}

#[test]
fn both_views_follow_a_step() {
    let views = two_views::run(&sample("assembly.step"), 2).unwrap();
    let [first, second] = &views[..] else { panic!("two steps") };
    assert!(first[0].depth != second[0].depth && first[1].depth != second[1].depth);
    assert_eq!((first[0].size, first[1].size), ((320, 240), (200, 200)));
}

/// The last of ten frames is nine steps up. Where the model is not, the engine's own blue is: linear 0.1, 0.2, 0.6.
#[test]
fn an_engine_draws_frames_in_flight() {
    let (file, size) = (sample("assembly.step"), (64, 48));
    let host_engine::Run { whole, pixels, .. } = host_engine::run(&file, 10, size).unwrap();
    assert!(whole >= 8, "{whole} of 10 frames were whole"); // the first two may lack room

    let mut model = selvedge_io::import::open(&file).unwrap().model;
    let camera = Camera::framing(&model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let mut headless = HeadlessRenderer::new(&HeadlessOptions::default()).unwrap();
    let blue = [0.1f64, 0.2, 0.6].map(|c| (255.0 * (1.055 * c.powf(1.0 / 2.4) - 0.055)).round() as u8);
    // pixels that are not those of a model before the engine's blue, and pixels of the model
    let mut compare = |model: &Model| {
        headless.upload(model).unwrap();
        let outputs = Outputs { face: true, ..Outputs::default() };
        let wanted = headless.render(&camera, &FrameSettings::default(), outputs).unwrap();
        let colours = wanted.colour.iter().zip(&wanted.face);
        let colours = colours.map(|(c, face)| if *face == 0 { blue } else { [c[0], c[1], c[2]] });
        // a device may round the code of a colour up or down
        let differs = |(seen, wanted): (&[u8; 4], [u8; 3])| (0..3).any(|k| seen[k].abs_diff(wanted[k]) > 1);
        let different = pixels.iter().zip(colours).filter(|(seen, wanted)| differs((*seen, *wanted))).count();
        (different, wanted.face.iter().filter(|face| **face != 0).count())
    };
    let (before, _) = compare(&model);
    model.instances[0].transform = DAffine3::from_translation(DVec3::Z * 9.0) * model.instances[0].transform;
    let (different, of_model) = compare(&model);
    assert_eq!(pixels.len(), 64 * 48);
    assert!((400..2700).contains(&of_model), "{of_model} pixels of the model, and engine's blue");
    // the engine may be on another device, whose outlines round otherwise
    assert!(different <= 15, "{different} pixels are not those of the moved model");
    assert!(before > 60, "{before} pixels show the step");
}

/// A file of an example is read at one go.
#[test]
fn examples_are_short() {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    files.retain(|path| path.extension().is_some_and(|end| ["rs", "py", "c", "h"].iter().any(|known| end == *known)));
    assert!(files.len() > 12, "only {} files were found", files.len());
    for path in files {
        let lines = std::fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines < 120, "{}: {lines} lines", path.display());
    }
}
