//! How fast a window of 1280 x 800 is, on files that the environment names: the first frame and the first picture,
//! frames of a moving view, the whole picture after it, a click, the item under the cursor, and what an idle window
//! uses. Other work on the machine falsifies it, so a usual run leaves it out. Validation is off meanwhile.

use super::Screen;
use super::hand::{Display, Program, numbers};
use glam::{DAffine3, DVec2, DVec4};
use selvedge::model::{Face, Instance, Model, Part, SurfaceKind};
use selvedge::spline::Surface;
use selvedge_io::native;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

/// Names the files, separated as in PATH.
pub const FILES: &str = "SELVEDGE_WINDOW_SPEED";
/// Length of the drag, and the time between two moves of it.
const DRAG: Duration = Duration::from_secs(4);
const MOVE: Duration = Duration::from_millis(8);
/// The first second chooses the resolution.
const CHOICE: Duration = Duration::from_secs(1);
const LEAST_RATE: f64 = 20.0;
const MOST_STILL: Duration = Duration::from_millis(400);
/// From the call of the window to its first frame, and from a click to the frame that shows it, milliseconds.
const MOST_OPENING: f64 = 300.0;
const MOST_CLICK: f64 = 30.0;
/// The same to the first picture of one of the files.
const MOST_FIRST: (&str, f64) = ("nist_pmi_2", 1000.0);
/// Moves of the cursor over a model at rest, and the radius of their circle, pixels. Their middle time is compared.
const HOVERS: u32 = 25;
const HOVER_RADIUS: f64 = 60.0;
/// Faces along the sides of two plates, and most that the time of the larger number may be of that of the smaller one.
const PLATES: [(u32, u32); 2] = [(5, 2), (400, 250)];
const MOST_HOVER: f64 = 1.5;
/// A window at rest is watched for so long, and uses less than this of a processor meanwhile, 1/100 s.
const IDLE: Duration = Duration::from_secs(10);
const MOST_IDLE: u64 = 10;
/// The log is silent for so long only after the last picture.
const SILENCE: Duration = Duration::from_secs(5);
/// A finger that clicks is down for so long.
const DOWN: Duration = Duration::from_millis(80);
/// Radius of the drag, pixels.
const RADIUS: f64 = 120.0;

/// Moves the mouse on a circle, for longer than a drag. It is one process: one for each move would take the processors
/// from the window.
fn circle(display: &Display, from: DVec2) -> Child {
    let steps = 2 * (DRAG.as_millis() / MOVE.as_millis()) as u32;
    let words = (0..steps).flat_map(|step| {
        let turn = TAU * f64::from(step) * MOVE.as_secs_f64();
        let at = (from + DVec2::new(turn.cos() - 1.0, turn.sin()) * RADIUS).round();
        let pause = MOVE.as_secs_f64().to_string();
        ["mousemove".to_owned(), at.x.to_string(), at.y.to_string(), "sleep".to_owned(), pause]
    });
    Command::new("xdotool").args(words).env("DISPLAY", display.name()).spawn().expect("it runs")
}

/// Milliseconds from a move of the cursor to the end of the frame that has found what is under it: the middle of many.
fn hover(display: &Display, program: &mut Program, middle: DVec2) -> f64 {
    let mut times: Vec<f64> = (0..HOVERS)
        .map(|step| {
            let turn = TAU * f64::from(step) / f64::from(HOVERS);
            display.move_to((middle + HOVER_RADIUS * DVec2::from_angle(turn)).round());
            let time = numbers(&program.wait("under the cursor is found "), "is found ")[0];
            program.settle();
            time
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Size and corner of the picture in the window, and its middle.
fn view(program: &Program) -> (Vec<f64>, DVec2) {
    let place = numbers(&program.last("view of "), "view of ");
    let middle = DVec2::new(place[2] + 0.5 * place[0], place[3] + 0.5 * place[1]);
    (place, middle)
}

/// A plate of squares, each a face.
fn plate((along, across): (u32, u32)) -> Model {
    let square = |nth: u32| {
        let (x, y) = (f64::from(nth % along), f64::from(nth / along));
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let net = corners.map(|(u, v)| DVec4::new(x + u, y + v, 0.0, 1.0)).to_vec();
        let knots = || vec![0.0, 0.0, 1.0, 1.0];
        let surface = Surface::new((1, 1), knots(), knots(), net).expect("a square");
        let (kind, loops) = (SurfaceKind::Plane, Vec::new());
        Face { id: nth + 1, kind, surface, loops, same_sense: true, colour: None }
    };
    let part = Part { faces: (0..along * across).map(square).collect(), ..Part::default() };
    let placed = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
    Model { parts: vec![part], instances: vec![placed], ..Model::default() }
}

/// Whether a window at rest says nothing, and what it uses of a processor, 1/100 s.
fn idle(program: &mut Program) -> (bool, u64) {
    let ticks = program.ticks();
    let is_silent = program.line(IDLE).is_none();
    (is_silent, program.ticks() - ticks)
}

/// The number of faces that the log says of the file.
fn faces(program: &Program) -> u64 {
    let line = program.last(" faces, ");
    let words = line.split(" faces, ").next().and_then(|before| before.rsplit(' ').next());
    words.and_then(|word| word.parse().ok()).expect("a number")
}

#[test]
fn a_large_file_moves_at_twenty_frames_a_second() {
    let Some(files) = std::env::var_os(FILES) else { return };
    let Some(screen) = Screen::open((1280, 800)) else { return };
    let display = &screen.display;
    let mut slow = Vec::new();
    for file in std::env::split_paths(&files) {
        let folder = tempfile::tempdir().expect("a folder");
        let copy: PathBuf = folder.path().join(file.file_name().expect("a file"));
        std::fs::copy(&file, &copy).expect("copied");
        let mut program = Program::start(display, &copy, &[]);
        let (place, middle) = view(&program);
        display.move_to(middle);
        program.rest();

        display.xdotool("mousedown 3");
        let mut hand = circle(display, middle);
        let start = Instant::now();
        let mut counted = 0;
        while let Some(line) = program.line(DRAG.saturating_sub(start.elapsed())) {
            let is_picture = line.contains("picture of ") && line.contains("complete: true");
            counted += usize::from(is_picture && start.elapsed() > CHOICE);
        }
        assert!(hand.try_wait().expect("a state").is_none(), "the hand has rested before the end");
        // the hand stops, and lets go
        let stopped = Instant::now();
        hand.kill().and_then(|()| hand.wait()).expect("it ends");
        display.xdotool("mouseup 3");
        let rate = counted as f64 / (DRAG - CHOICE).as_secs_f64();
        let size = program.last("picture of ");
        let (mut last, mut still) = (String::new(), Duration::ZERO);
        while let Some(line) = program.line(SILENCE) {
            if line.contains("picture of ") {
                (last, still) = (line, stopped.elapsed());
            }
        }
        // every pixel, and every effect
        let whole = format!("picture of {} x {} ", place[0], place[1]);
        let has_all = |effects: &str| effects.contains("false") && !effects.contains("true");
        let complete = last.split_once("complete: true, without ").is_some_and(|(_, effects)| has_all(effects));
        assert!(last.contains(&whole) && complete, "it never rests: {last}");
        program.rest();

        display.move_to(middle);
        program.rest();
        display.xdotool("mousedown 1");
        std::thread::sleep(DOWN);
        display.xdotool("mouseup 1");
        let click = numbers(&program.wait("is shown "), "is shown ")[0];
        program.rest();
        let hover = hover(display, &mut program, middle);
        program.rest();
        let (is_silent, used) = idle(&mut program);
        let name = file.display().to_string();
        let [opening, first] =
            ["first frame after ", "first picture after "].map(|from| numbers(&program.last(from), from)[0]);
        let told = format!(
            "{name}, {} faces: {rate:.1} frames a second, still after {still:.0?}, a click shown after {click:.1} ms, \
             the item under the cursor found after {hover:.1} ms, first frame after {opening} ms, first picture after \
             {first} ms; in {IDLE:?} at rest {:.2} s of a processor, {}",
            faces(&program),
            used as f64 / 100.0,
            if is_silent { "nothing drawn" } else { "something drawn" },
        );
        eprintln!("{told}\n{size}\n{}", program.last("window on "));
        let is_late = name.contains(MOST_FIRST.0) && first > MOST_FIRST.1;
        let works = !is_silent || used >= MOST_IDLE;
        if rate < LEAST_RATE || still > MOST_STILL || click > MOST_CLICK || opening > MOST_OPENING || is_late || works {
            slow.push(told);
        }
        program.close(display);
    }
    assert!(slow.is_empty(), "{}", slow.join("\n"));
}

#[test]
fn the_item_under_the_cursor_costs_the_same_on_ten_faces_and_on_a_hundred_thousand() {
    if std::env::var_os(FILES).is_none() {
        return;
    }
    let Some(screen) = Screen::open((1280, 800)) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let times = PLATES.map(|sides| {
        let model = plate(sides);
        let file = folder.path().join(format!("{}.selvedge", model.face_count()));
        std::fs::write(&file, native::write(&model)).expect("written");
        let mut program = Program::start(&screen.display, &file, &[]);
        let (_, middle) = view(&program);
        screen.display.move_to(middle);
        program.rest();
        let time = hover(&screen.display, &mut program, middle);
        eprintln!("{} faces: the item under the cursor found after {time:.1} ms", faces(&program));
        program.rest();
        program.close(&screen.display);
        time
    });
    assert!(times[1] < MOST_HOVER * times[0], "{times:?} ms on plates of {PLATES:?} faces");
}
