//! The first parts of an assembly are shown while the rest is read.

use super::hand::{Display, Program};
use super::panels::Panels;
use super::scene::Scene;
use super::{SLOW, Screen, sample};
use glam::DVec3;
use selvedge_io::import::Files;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Longer than reading takes at the first preview.
const READING: Duration = Duration::from_millis(500);
/// The bolt of the assembly, and the nut, which is read when there is a file `GO`.
const BOLT: &str = "bolt.stp";
const NUT: &str = "nut.stp";
const GO: &str = "go";
/// Least difference of a part from the background, of 255; a grey part is three times as bright as a dark background.
const SEEN: u32 = 20;

/// Reads files of a folder slowly.
pub struct Slow(pub PathBuf);

impl Files for Slow {
    fn find(&self, name: &str, _: &str) -> Option<String> {
        let path = self.0.join(name);
        path.is_file().then(|| path.to_string_lossy().into_owned())
    }

    fn read(&self, found: &str, _: u64) -> std::io::Result<Vec<u8>> {
        std::thread::sleep(READING);
        while found.ends_with(NUT) && !self.0.join(GO).exists() {
            std::thread::sleep(Duration::from_millis(20));
        }
        std::fs::read(found)
    }
}

/// An assembly of two brackets, each in a file of its own.
fn pair() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let to = |name: &str| folder.path().join(name);
    let text = Path::new(env!("CARGO_MANIFEST_DIR")).join("../io/src/import/external/tests/pair.stp");
    for (from, name) in [(text, "pair.stp"), (sample("bracket.step"), BOLT), (sample("bracket.step"), NUT)] {
        std::fs::copy(from, to(name)).expect("copied");
    }
    let file = to("pair.stp");
    (folder, file)
}

/// Where the view looks from, by its line of `selvedge render`. The program may be reading.
fn eye(program: &mut Program, display: &Display, scene: &Scene) -> DVec3 {
    display.key("ctrl+shift+c");
    let line = program.wait("copied: selvedge render");
    program.quiet();
    scene.camera_of(&line).eye
}

/// The rest of the assembly is read.
fn go_on(program: &mut Program, file: &Path) {
    std::fs::write(file.with_file_name(GO), "").expect("written");
    program.wait(&format!("read {}", file.display()));
    program.rest();
}

#[test]
fn the_first_parts_are_shown_before_the_rest_is_read() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, file) = pair();
    let mut program = Program::begin(display, &file, &[(SLOW, "1")]);
    program.quiet();
    let said = program.all.join("\n");
    assert!(said.contains("so far: ") && !said.contains(&format!("read {}", file.display())), "{said}");

    // one of two parts: all of it is in view, and it is picked
    let bolt = Scene::new(&folder.path().join(BOLT), &program.last("view of "));
    let near = |a: DVec3, b: DVec3| a.distance(b) < 1e-9 * bolt.world.bounds.diagonal();
    let first = eye(&mut program, display, &bolt);
    assert!(near(first, bolt.camera.eye), "{first} instead of {}", bolt.camera.eye);
    let (at, face) = bolt.cylinder();
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", face.id)), "{selected}");
    display.key("Escape");
    program.quiet();

    // both are in view
    go_on(&mut program, &file);
    let both = Scene::new(&file, &program.last("view of "));
    assert_eq!((bolt.world.model.instances.len(), both.world.model.instances.len()), (1, 2));
    let second = eye(&mut program, display, &both);
    assert!(near(second, both.camera.eye) && !near(second, first), "{second} instead of {}", both.camera.eye);
    program.close(display);
}

#[test]
fn a_view_that_was_moved_stays_when_the_rest_is_read() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, file) = pair();
    let mut program = Program::begin(display, &file, &[(SLOW, "1")]);
    program.quiet();
    let bolt = Scene::new(&folder.path().join(BOLT), &program.last("view of "));
    let first = eye(&mut program, display, &bolt);
    display.key("minus");
    program.wait("picture of ");
    program.quiet();
    let moved = eye(&mut program, display, &bolt);
    assert!(moved != first);
    go_on(&mut program, &file);
    assert_eq!(eye(&mut program, display, &bolt), moved);
    program.close(display);
}

/// The thread that reads waits for a disk that never answers.
#[test]
fn a_cancelled_file_goes_without_a_wait_for_its_disk() {
    const WINDOW: (u32, u32) = (900, 560);
    let Some(screen) = Screen::open(WINDOW) else { return };
    let display = &screen.display;
    let (folder, file) = pair();
    let mut program = Program::begin(display, &file, &[(SLOW, "1")]);
    program.quiet();
    let bolt = Scene::new(&folder.path().join(BOLT), &program.last("view of "));
    let (at, away) = (bolt.cylinder().0, bolt.corner + 4.0);
    let shown = |display: &Display| {
        let screen = display.screen();
        screen.brightness(at).abs_diff(screen.brightness(away))
    };
    let before = shown(display);
    assert!(before > SEEN, "the first part is {before} brighter than the background");
    let mut panels = Panels::new(&bolt, WINDOW);
    panels.reads = true;
    panels.click(display, &mut program, "Cancel", 0);
    program.said(": Cancel");
    program.rest();
    let after = shown(display);
    assert!(after < SEEN / 4, "a part is seen still: {after}");
    let all = program.all.join("\n");
    assert!(!all.contains(&format!("read {}", file.display())), "{all}");
    program.close(display);
}
