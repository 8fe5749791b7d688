//! A picture on the desktop's clipboard, read there by another program.

use super::hand::{Display, PICTURE};
use super::{Screen, opened};
use std::path::Path;
use std::process::Command;

/// Names the file for what is on the clipboard: set for the process that reads it.
const READ: &str = "SELVEDGE_WINDOW_CLIPBOARD";
const NAME: &str = "clipboard::a_copied_picture_is_the_written_one";

#[test]
fn a_copied_picture_is_the_written_one() {
    if let Some(file) = std::env::var_os(READ) {
        let mut clipboard = arboard::Clipboard::new().expect("a clipboard");
        let image = clipboard.get_image().expect("a picture");
        assert_eq!((image.width, image.height), (PICTURE.0 as usize, PICTURE.1 as usize));
        return std::fs::write(file, image.bytes).expect("written");
    }
    let Some(screen) = Screen::open((900, 560)) else { return };
    let (folder, mut program, _) = opened(&screen.display, "bracket.step");
    let written = program.picture(&screen.display);
    screen.display.key("ctrl+shift+p");
    program.wait(&format!("Copied: a picture of {} x {}.", PICTURE.0, PICTURE.1));
    program.rest();
    let copied = copied(&screen.display, &folder.path().join("clipboard"));
    let other = written.iter().zip(copied.as_chunks::<4>().0).filter(|(a, b)| a != b).count();
    assert_eq!((copied.len(), other), (4 * written.len(), 0), "bytes, and pixels that differ");
    program.close(&screen.display);
}

/// Red, green, blue and opacity of the picture on a display's clipboard, which another process reads into a file.
fn copied(display: &Display, file: &Path) -> Vec<u8> {
    let status = Command::new(std::env::current_exe().expect("this test"))
        .args(["--exact", NAME])
        .env(READ, file)
        .env("DISPLAY", display.name())
        .env_remove("WAYLAND_DISPLAY")
        .status()
        .expect("runs");
    assert!(status.success(), "the clipboard has no such picture");
    std::fs::read(file).expect("its bytes")
}
