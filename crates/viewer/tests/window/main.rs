//! A real window, driven by keys and mouse: Xvfb shows it, xdotool moves the mouse, a Vulkan device draws.
//!
//! The test starts itself again as the program with the window, and reads its log. It computes the places of faces and
//! edges on the screen from the same camera in `f64`. The validation layer is on, and must stay silent.

mod clipboard;
mod drops;
mod gestures;
mod hand;
mod living;
mod losses;
mod menus;
mod panels;
mod points;
mod previews;
mod scene;
mod soak;
mod speed;

use hand::{Display, Program, numbers};
use previews::Slow;
use scene::Scene;
use selvedge_viewer::session::Finder;
use selvedge_viewer::{Faults, ViewOptions, run};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Names the file that the window opens: set for the process with the window.
const FILE: &str = "SELVEDGE_WINDOW_FILE";
/// Names its width and height.
const SIZE: &str = "SELVEDGE_WINDOW_SIZE";
/// Set for a process that reads the files of an assembly slowly.
const SLOW: &str = "SELVEDGE_WINDOW_SLOW";
const NAME: &str = "a_window_is_used_as_a_person_does";
/// Least change of a tinted pixel from blue to red or back, of 255: a third of it is the tint.
const LEAST_TINT: i32 = 20;
/// Longest wait for anything; a machine that draws by its CPU and is busy takes seconds for the first picture.
const PATIENCE: Duration = Duration::from_secs(120);

#[test]
fn a_window_is_used_as_a_person_does() {
    if let Some(file) = std::env::var_os(FILE) {
        return window(PathBuf::from(file));
    }
    if let Some(screen) = Screen::open((900, 560)) {
        script(&screen.display);
    }
}

/// A display for one test at a time: each window draws by all processors. The lock holds within a process; where each
/// test has a process of its own, the test group of .config/nextest.toml does.
struct Screen {
    display: Display,
    _alone: MutexGuard<'static, ()>,
}

impl Screen {
    /// `None` where `SELVEDGE_WITHOUT` leaves the window out.
    fn open(size: (u32, u32)) -> Option<Self> {
        static ALONE: Mutex<()> = Mutex::new(());
        if std::env::var("SELVEDGE_WITHOUT").is_ok_and(|left_out| left_out.split(',').any(|name| name == "window")) {
            return None;
        }
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let needs =
            "the window test needs Xvfb and xdotool: apt install xvfb xdotool; SELVEDGE_WITHOUT=window leaves it out";
        Some(Self { display: Display::open(size).expect(needs), _alone: alone })
    }
}

/// The process with the window.
fn window(file: PathBuf) {
    tracing_subscriber::fmt()
        .with_max_level(tracing::Level::DEBUG)
        .with_writer(std::io::stderr)
        .with_ansi(false)
        .init();
    let size = std::env::var(SIZE).expect("a size");
    let (width, height) = size.split_once(' ').expect("two numbers");
    let slow = std::env::var_os(SLOW).and(file.parent()).map(|folder| Slow(folder.to_owned()));
    let loss = file.with_file_name(losses::LOSS);
    let closed = run(ViewOptions {
        faults: Some(Faults(Arc::new(move || losses::take(&loss)))),
        finder: slow.map(|slow| Finder(Arc::new(slow))),
        settings: file.parent().map(|folder| folder.join("settings.json")),
        desktop: file.parent().map(Path::to_owned),
        files: vec![file],
        // it would be measured, too
        validation: std::env::var_os(speed::FILES).is_none(),
        size: width.parse().ok().zip(height.parse().ok()),
        device: None,
    });
    let messages = closed.expect("the window closes well").messages;
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name)
}

/// A copy of a sample in a folder of its own, opened.
fn opened(display: &Display, name: &str) -> (tempfile::TempDir, Program, Scene) {
    opened_with(display, name, |_| {})
}

/// The same, where something else is put into the folder before.
fn opened_with(display: &Display, name: &str, put: impl FnOnce(&Path)) -> (tempfile::TempDir, Program, Scene) {
    opened_in(display, name, &[], put)
}

/// The same, with variables in the environment of the process.
fn opened_in(
    display: &Display,
    name: &str,
    variables: &[(&str, &str)],
    put: impl FnOnce(&Path),
) -> (tempfile::TempDir, Program, Scene) {
    let folder = tempfile::tempdir().expect("a folder");
    put(folder.path());
    let file = folder.path().join(name);
    std::fs::copy(sample(name), &file).expect("copied");
    let program = Program::start(display, &file, variables);
    let scene = Scene::new(&file, &program.last("view of "));
    (folder, program, scene)
}

/// The text of a file without spaces.
fn text_of(file: &Path) -> String {
    std::fs::read_to_string(file).expect("a sample").replace(['\n', '\r', ' '], "")
}

/// The entity of a number, in such a text.
fn entity(text: &str, number: u32) -> &str {
    let start = text.find(&format!("#{number}=")).expect("the entity");
    text[start..].split(';').next().expect("its end")
}

/// The radius that the file states for the cylinder of a face.
fn stated_radius(file: &Path, face: u32) -> f64 {
    let text = text_of(file);
    let of_face = entity(&text, face);
    let surface = of_face.rsplit('#').next().and_then(|rest| rest.split(',').next()).expect("a surface");
    let cylinder = entity(&text, surface.parse().expect("a number"));
    assert!(cylinder.contains("CYLINDRICAL_SURFACE"), "{cylinder}");
    cylinder.rsplit(',').next().and_then(|r| r.trim_end_matches(')').parse().ok()).expect("a radius")
}

fn script(display: &Display) {
    let (folder, mut program, scene) = opened(display, "bracket.step");
    let file = folder.path().join("bracket.step");
    let id = program.id.clone();

    // the face under the cursor is tinted orange, beside the cursor's arrow
    let (at, face) = scene.cylinder();
    let (beside, away) = (at - glam::DVec2::new(4.0, 0.0), scene.corner + 4.0);
    program.after(|| display.move_to(away));
    let plain = display.screen().warmth(beside);
    program.after(|| display.move_to(at));
    let hovered = display.screen().warmth(beside);
    assert!(hovered > plain + LEAST_TINT, "{hovered} where it was {plain}");

    // a cylinder: recognised, and measured as the file states it
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", face.id)), "{selected}");
    let radius = numbers(&program.wait("radius: "), "radius: ")[0];
    let stated = stated_radius(&file, face.id);
    // twelve digits: the accuracy of rational arcs of f64 points
    assert!((radius / stated - 1.0).abs() < 1e-12, "{radius} instead of {stated}");

    // what is selected is tinted blue
    display.move_to(away);
    program.rest();
    let screen = display.screen();
    screen.keep("window.png");
    assert!(screen.warmth(beside) < plain - LEAST_TINT, "{} where it was {plain}", screen.warmth(beside));

    // an edge, and a corner
    display.click(scene.edge());
    let selected = program.wait("selected ");
    assert!(selected.contains("edge ") || selected.contains("vertex "), "{selected}");
    program.rest();
    display.click(scene.vertex());
    let selected = program.wait("selected ");
    assert!(selected.contains("vertex "), "{}", program.all.join("\n"));

    // turned by the right button; all pixels come in the end
    let (width, height) = (scene.camera.size.0, scene.camera.size.1);
    let said = program.drag(display, 3, at, glam::DVec2::new(84.0, 30.0));
    let whole = format!("picture of {width} x {height}");
    assert!(said.iter().any(|line| line.contains(&whole)), "{}", said.join("\n"));

    // a picture in a file, of the view that is shown
    let pixels = program.picture(display);
    let model = pixels.iter().filter(|p| **p != pixels[0]).count();
    assert!(model > 1280 * 720 / 20, "{model} pixels show the model");

    // nothing is drawn and no processor is used while nothing happens
    program.rest();
    let (before, ticks) = (program.all.len(), program.ticks());
    assert!(program.line(Duration::from_secs(10)).is_none(), "{:?}", &program.all[before..]);
    // one in a hundred
    let used = program.ticks() - ticks;
    assert!(used < 10, "{used}/100 s of ten seconds");

    // another size, then hidden and shown again
    display.xdotool(&format!("windowsize {id} 700 480"));
    program.wait("picture of ");
    program.rest();
    let shown = display.screen();
    display.xdotool(&format!("windowunmap --sync {id}"));
    let hidden = display.screen().same(&shown);
    display.xdotool(&format!("windowmap {id}"));
    program.rest();
    // the window has two thirds of the screen; focus and cursor may be elsewhere now
    let again = display.screen().same(&shown);
    assert!(hidden < 0.5 && again > 0.9, "{hidden} of the screen without the window, {again} with it");

    // a file that changes is read again
    std::fs::copy(sample("bracket.step"), &file).expect("copied");
    program.wait("has changed");
    program.wait("read ");
    program.wait("picture of ");
    program.close(display);
}
