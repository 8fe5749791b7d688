//! Random events: no crash, no message of the validation layer, no growth of memory.

use super::{Screen, opened};
use std::time::Duration;

/// Events of a usual run; the environment's `SELVEDGE_WINDOW_EVENTS` has another number, such as 10000.
const EVENTS: usize = 400;
/// Growth from the middle to the end that is no leak: shares of what there is, and KiB, of a driver that keeps the
/// programs of pipelines that it has compiled.
const GROWTH: f64 = 0.25;
const MOST_KIB: f64 = 65536.0;
const KEYS: [&str; 24] = [
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
    let event = |random: &mut Random| match random.below(12) {
        0..=3 => format!("{} click {}", place(random), 1 + random.below(5)),
        4..=6 => {
            let button = 1 + random.below(3);
            format!("{} mousedown {button} {} {} mouseup {button}", place(random), place(random), place(random))
        }
        7..=10 => format!("key {}", KEYS[random.below(KEYS.len())]),
        _ => format!("windowsize {id} 900 {}", 360 + random.below(200)),
    };
    let mut middle = None;
    for nth in 0..count {
        display.xdotool(&event(&mut random));
        while program.line(Duration::from_millis(2)).is_some() {}
        assert!(program.runs(), "{}", program.all.join("\n"));
        if nth == count / 2 {
            program.rest();
            middle = Some(program.memory());
        }
    }
    program.rest();
    let (middle, end) = (middle.expect("measured") as f64, program.memory() as f64);
    assert!(end < middle * (1.0 + GROWTH) + MOST_KIB, "{middle} KiB in the middle, {end} KiB at the end");
    display.key("Escape");
    program.close(display);
}
