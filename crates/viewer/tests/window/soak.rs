//! Random events: no crash, no message of the validation layer, no growth of memory.

use super::hand::{Display, Program};
use super::{Screen, opened_in};
use glam::DVec2;
use selvedge::model::SurfaceKind;
use std::time::Duration;

/// Events of a usual run; the environment's `SELVEDGE_WINDOW_EVENTS` has another number, such as 10000.
const EVENTS: usize = 480;
/// Measures of memory in each third.
const MEASURES: usize = 4;
/// Most that the least memory of the last third may be above that of the second one, KiB. The allocator's memory and a
/// driver's caches vary by some MiB; a leak of 100 KiB an event is as much in a third of the usual run.
const MOST_KIB: u64 = 16384;
/// Each kind of scene has pipelines of its own, and a driver that compiles them for the CPU keeps some tens of MiB for
/// them: a section, a part that is seen through, and both.
const KINDS: [&[&str]; 3] = [&["c"], &["x"], &["c", "x"]];
/// Commands that turn something on and off again, with their keys.
const SWITCHES: [(&str, &str); 3] = [("Trims", "t"), ("Points", "p"), ("Projection", "5")];
/// One arena of malloc for all threads: memory that one of them has freed serves the others.
const ARENAS: (&str, &str) = ("MALLOC_ARENA_MAX", "1");
/// States that are undone before a measure: a session keeps no more.
const MOST_STATES: usize = 200;
const KEYS: [&str; 25] = [
    "1",
    "3",
    "7",
    "9",
    "5",
    "h",
    "i",
    "a",
    "x",
    "m",
    "p",
    "t",
    "c",
    "f",
    "Home",
    "BackSpace",
    "Escape",
    "Left",
    "Up",
    "plus",
    "minus",
    "question",
    "ctrl+z",
    "ctrl+shift+z",
    "shift+Left",
];

/// xorshift64 (Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

/// Shows each kind of scene, with and without trims to drag, until the driver has compiled all of them.
fn warm_up(display: &Display, program: &mut Program, at: DVec2) {
    for _ in 0..2 {
        for keys in KINDS {
            display.click(at);
            program.rest();
            for key in keys {
                display.key(key);
                program.rest();
            }
            display.key(&vec!["ctrl+z"; keys.len()].join(" "));
            program.rest();
        }
        display.key("t");
        program.rest();
    }
}

/// Brings the window and the scene to where they were: nothing is changed, on, open or selected.
fn settle(display: &Display, program: &mut Program, undone: &str) {
    display.xdotool(&format!("windowsize {} 900 560", program.id));
    display.xdotool("key Escape");
    display.xdotool(&format!("key {undone}"));
    program.rest();
    for (command, key) in SWITCHES {
        let is_it = |line: &&String| line.ends_with(&format!(": {command}"));
        if program.all.iter().filter(is_it).count() % 2 == 1 {
            display.key(key);
            program.rest();
        }
    }
    display.key("Home");
    program.rest();
}

#[test]
fn random_events_do_no_harm() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened_in(display, "assembly.step", &[ARENAS], |_| {});
    let count = std::env::var("SELVEDGE_WINDOW_EVENTS").ok().and_then(|n| n.parse().ok()).unwrap_or(EVENTS);
    let (corner, size, id) = (scene.corner, scene.camera.size, program.id.clone());
    let mut random = Random(0x5e17_ed9e);
    let place = |random: &mut Random| {
        let (x, y) = (random.below(size.0 as usize), random.below(size.1 as usize));
        format!("mousemove {} {}", corner.x as usize + x, corner.y as usize + y)
    };
    // one call of xdotool each; the window's width stays, and with it the place of its menus
    let event = |random: &mut Random| match random.below(13) {
        0..=3 => format!("{} click {}", place(random), 1 + random.below(5)),
        4..=6 => {
            let button = 1 + random.below(3);
            format!("{} mousedown {button} {} {} mouseup {button}", place(random), place(random), place(random))
        }
        7..=10 => format!("key {}", KEYS[random.below(KEYS.len())]),
        // the file is read, put together and uploaded again
        11 => "key ctrl+r".to_owned(),
        _ => format!("windowsize {id} 900 {}", 360 + random.below(200)),
    };
    let undone = vec!["ctrl+z"; (count / (3 * MEASURES)).clamp(1, MOST_STATES)].join(" ");
    let (at, _) = scene.place(|_, face| face.kind == SurfaceKind::Plane);
    warm_up(display, &mut program, at);
    let mut least = Vec::new();
    for third in 0..3 {
        let mut measured = Vec::new();
        for _ in 0..MEASURES {
            for _ in 0..(count / (3 * MEASURES)).max(1) {
                display.xdotool(&event(&mut random));
                while program.line(Duration::from_millis(2)).is_some() {}
                assert!(program.runs(), "{}", program.all.join("\n"));
            }
            settle(display, &mut program, &undone);
            measured.push(program.memory());
        }
        eprintln!("third {third}: {measured:?} KiB");
        least.extend(measured.into_iter().min());
    }
    assert!(least[2] < least[1] + MOST_KIB, "{least:?} KiB: the least of each third");
    display.key("Escape");
    program.close(display);
}
