//! How fast a window of 1280 x 800 is, on files that the environment names: frames of a moving view, the whole picture
//! after it, a click. Other work on the machine falsifies it, so a usual run leaves it out.

use super::hand::{Program, numbers};
use super::{PATIENCE, Screen};
use glam::DVec2;
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Names the files, separated as in PATH.
const FILES: &str = "SELVEDGE_WINDOW_SPEED";
/// Length of the drag, and the time between two moves of it.
const DRAG: Duration = Duration::from_secs(4);
const MOVE: Duration = Duration::from_millis(8);
/// The first second chooses the resolution.
const CHOICE: Duration = Duration::from_secs(1);
const LEAST_RATE: f64 = 20.0;
const MOST_STILL: Duration = Duration::from_millis(400);
/// Radius of the drag, pixels.
const RADIUS: f64 = 120.0;

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
        let place = numbers(&program.last("view of "), "view of ");
        let middle = DVec2::new(place[2] + 0.5 * place[0], place[3] + 0.5 * place[1]);
        display.move_to(middle);
        program.rest();

        display.xdotool("mousedown 3");
        let start = Instant::now();
        let mut counted = 0;
        while start.elapsed() < DRAG {
            let turn = TAU * start.elapsed().as_secs_f64();
            display.move_to((middle + DVec2::new(turn.cos() - 1.0, turn.sin()) * RADIUS).round());
            let until = Instant::now() + MOVE;
            while let Some(line) = program.line(until.saturating_duration_since(Instant::now())) {
                let is_picture = line.contains("picture of ") && line.contains("complete: true");
                counted += usize::from(is_picture && start.elapsed() > CHOICE);
            }
        }
        let rate = counted as f64 / (DRAG - CHOICE).as_secs_f64();
        let size = program.last("picture of ");
        display.xdotool("mouseup 3");
        let still = Instant::now();
        let whole = format!("picture of {} x {} ", place[0], place[1]);
        while !program.wait("picture of ").contains(&whole) || !program.last("picture of ").contains("complete: true") {
            assert!(still.elapsed() < PATIENCE, "it never rests");
        }
        let still = still.elapsed();
        program.rest();

        let click = Instant::now();
        display.click(middle);
        program.wait("frame");
        let click = click.elapsed();
        program.rest();
        let name = file.display();
        let first = program.last("first picture");
        eprintln!("{name}: {rate:.1} frames a second, still after {still:.0?}, a click's frame after {click:.0?}");
        eprintln!("{size}\n{first}");
        if rate < LEAST_RATE || still > MOST_STILL {
            slow.push(format!("{name}: {rate:.1} frames a second, still after {still:.0?}"));
        }
        program.close(display);
    }
    assert!(slow.is_empty(), "{}", slow.join("\n"));
}
