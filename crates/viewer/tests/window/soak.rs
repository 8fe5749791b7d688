//! Random events: no crash, no message of the validation layer, no growth of memory.

use super::{Screen, opened};
use std::time::Duration;

/// Events of a usual run; the environment's `SELVEDGE_WINDOW_EVENTS` has another number, such as 10000.
const EVENTS: usize = 480;
/// Measures of memory in each third. The first third is the warm-up: pipelines, fonts and lists grow to their usual
/// size.
const MEASURES: usize = 4;
/// Most that the least memory of the last third may be above that of the second one, KiB. The allocator's arenas and a
/// driver's caches vary by some MiB; a leak of 100 KiB an event is as much in a third of the usual run.
const MOST_KIB: u64 = 16384;
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

#[test]
fn random_events_do_no_harm() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "assembly.step");
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
    // the same window and the same scene each time
    let undone = vec!["ctrl+z"; (count / (3 * MEASURES)).clamp(1, MOST_STATES)].join(" ");
    let settled = [format!("windowsize {id} 900 560"), "key Escape".to_owned(), format!("key {undone}")];
    let mut least = Vec::new();
    for third in 0..3 {
        let mut measured = Vec::new();
        for _ in 0..MEASURES {
            for _ in 0..(count / (3 * MEASURES)).max(1) {
                display.xdotool(&event(&mut random));
                while program.line(Duration::from_millis(2)).is_some() {}
                assert!(program.runs(), "{}", program.all.join("\n"));
            }
            settled.iter().for_each(|words| drop(display.xdotool(words)));
            program.rest();
            measured.push(program.memory());
        }
        eprintln!("third {third}: {measured:?} KiB");
        least.extend(measured.into_iter().min());
    }
    assert!(least[2] < least[1] + MOST_KIB, "{least:?} KiB: the least of each third");
    display.key("Escape");
    program.close(display);
}
