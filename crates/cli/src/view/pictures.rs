//! The line that the window copies draws the window's view: its pictures, pixel by pixel.

use crate::args::{Cli, Command};
use crate::{Outcome, device, render};
use clap::Parser;
use glam::DVec3;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::Colour;
use selvedge::picture::{FrameSettings, Outputs, Picture, Style};
use selvedge_viewer::describe::command;
use selvedge_viewer::navigation::OrbitStyle;
use selvedge_viewer::session::{Loaded, SceneState, Section, Session, World};
use selvedge_viewer::settings::{Lines, Settings};
use selvedge_viewer::view::View;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Behind the model, no colour of eight bits.
const BACKGROUND: Colour = [0.030, 0.032, 0.037, 1.0];
const SIZE: (u32, u32) = (320, 240);
/// Colours are written with their digits in sRGB and read to single precision: the last of eight bits may be another.
const MOST_OFF: u8 = 1;

/// The words of a line, as a shell has them.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut is_quoted, mut chars) = (vec![String::new()], false, line.chars());
    while let Some(c) = chars.next() {
        let word = words.last_mut().expect("one at least");
        match c {
            '\'' => is_quoted = !is_quoted,
            '\\' if !is_quoted => word.extend(chars.next()),
            ' ' if !is_quoted => words.push(String::new()),
            _ => word.push(c),
        }
    }
    words
}

/// The data of a NumPy file, four bytes an element.
fn array(path: &Path) -> Vec<u32> {
    let file = std::fs::read(path).expect("an array");
    let data = 10 + usize::from(u16::from_le_bytes([file[8], file[9]]));
    file[data..].as_chunks::<4>().0.iter().map(|bytes| u32::from_ne_bytes(*bytes)).collect()
}

fn colours(path: &Path) -> Vec<[u8; 4]> {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("a picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("pixels");
    pixels.as_chunks::<4>().0.to_vec()
}

/// What the window draws of a session.
fn window(session: &Session, view: &View, settings: &Settings, style: Style) -> Picture {
    let outputs = Outputs { depth: true, face: true, ..Outputs::default() };
    let mut renderer = HeadlessRenderer::new(&device::options(None, false)).expect("a device");
    renderer.expect(outputs);
    let shown = session.scene.now().show(&session.world);
    assert!(shown.failed.is_none());
    let scene = settings.scene(style, session.world.bounds.diagonal());
    renderer.upload_shared(Arc::new(shown.model), scene, &|_| ()).expect("uploaded");
    let frame = FrameSettings { style, background: Some(BACKGROUND), ..FrameSettings::default() };
    let picture = renderer.render(view.camera(), &frame, outputs).expect("a picture");
    assert!(renderer.shutdown().is_empty());
    picture
}

/// Draws the copied line by the program's own function, and compares it.
fn compare(
    settings: &Settings,
    style: Style,
    look: impl FnOnce(&mut View),
    change: impl FnOnce(&mut SceneState, &World),
) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
    let import = selvedge_io::import::open(&path).expect("a sample");
    let mut session = Session::default();
    session.open(World::new(&[Arc::new(Loaded { path, import, partial: false })]));
    let world = Arc::clone(&session.world);
    session.scene.change(|state| change(state, &world));
    let mut view = View::default();
    view.resize(SIZE);
    view.set_bounds(world.bounds);
    view.reset(Instant::now());
    look(&mut view);

    let folder = tempfile::tempdir().expect("a folder");
    let to = |name: &str| folder.path().join(name);
    let line = command::line(&session, view.camera(), settings, (style, BACKGROUND));
    assert!(command::left_out(&session).is_empty());
    let mut words = words(&line);
    let output = words.iter_mut().find(|word| word.starts_with("--output=")).expect("an output");
    *output = format!("--output={}", to("view.png").display());
    for image in ["depth", "face"] {
        words.push(format!("--aov={image}={}", to(image).with_extension("npy").display()));
    }
    let Command::Render(args) = Cli::try_parse_from(&words).expect("it parses").command else { panic!("{line}") };
    assert_eq!(render::run(&args).expect("it is drawn"), Outcome::Good);

    let picture = window(&session, &view, settings, style);
    let bits: Vec<u32> = picture.depth.iter().map(|depth| depth.to_bits()).collect();
    let seen = picture.face.iter().filter(|face| **face != 0).count();
    assert!(seen > picture.face.len() / 50, "{seen} pixels show the model");
    assert!(array(&to("face.npy")) == picture.face, "faces: {line}");
    assert!(array(&to("depth.npy")) == bits, "depths: {line}");
    let off = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    let drawn = colours(&to("view.png"));
    assert_eq!(drawn.len(), picture.colour.len());
    let most = drawn.iter().zip(&picture.colour).map(off).max();
    assert!(most <= Some(MOST_OFF), "colours are {most:?} of 255 off: {line}");
}

#[test]
fn hidden_parts_and_a_turned_view_are_drawn_by_the_copied_line() {
    let look = |view: &mut View| {
        view.turn(glam::DVec2::new(37.0, -21.0), OrbitStyle::default(), Instant::now());
        view.zoom(2.0, Instant::now());
    };
    compare(&Settings::default(), Style::Shaded, look, |state, _| state.hidden.extend([0, 3, 4, 5, 11]));
}

/// Without the light that travels with the camera: shadows, and corners that are darker.
#[test]
fn colours_and_glass_are_drawn_by_the_copied_line() {
    let settings = Settings { ambient: true, shadows: true, lines: Lines::None, ..Settings::default() };
    compare(
        &settings,
        Style::Shaded,
        |_| (),
        |state, _| {
            state.colours.extend([(0, [1.0, 0.0, 0.0, 1.0]), (2, [0.1, 0.2, 0.3, 1.0])]);
            state.clear.extend([1, 2]);
        },
    );
}

#[test]
fn sections_of_isolated_parts_in_a_parallel_view_are_drawn_by_the_copied_line() {
    let settings = Settings { lines: Lines::Sharp, hidden_lines: true, smooth: false, ..Settings::default() };
    compare(
        &settings,
        Style::Technical,
        |view| view.toggle_projection(Instant::now()),
        |state, world| {
            let count = world.model.instances.len();
            state.isolate(&(0..count).step_by(2).collect::<Vec<_>>(), world);
            let slanted = Section::across(DVec3::new(0.6, 0.0, 0.8), world.bounds);
            state.sections = vec![Section::across(DVec3::X, world.bounds).flipped(), slanted];
            // one that does not cut is in no line
            state.sections.push(Section { on: false, ..Section::across(DVec3::Y, world.bounds) });
        },
    );
}
