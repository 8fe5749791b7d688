//! Losses of the surface and of the device, no memory for a picture, and a display of another scale: the window goes on,
//! and looks the same.

use super::hand::{Program, numbers};
use super::living::is_in_place;
use super::{SIZE, Screen, opened, opened_in};
use glam::DVec3;
use selvedge::ash::vk;
use selvedge::model::SurfaceKind;
use std::path::Path;

/// The file beside the open one that names a loss.
pub const LOSS: &str = "loss";
/// Losses by their names, and what the log says when the window goes on.
const LOSSES: [(&str, vk::Result, &str); 2] = [
    ("surface", vk::Result::ERROR_SURFACE_LOST_KHR, "the surface is lost, and made again"),
    ("device", vk::Result::ERROR_DEVICE_LOST, "the device is open again"),
];
/// Names no memory for any picture while there is such a file.
const NO_MEMORY: &str = "memory";
/// How far a picked point may be from that of an exact ray, relative to the model's size: some roundings of `f64`.
const PICKED: f64 = 1e-9;
/// Width of the tree, points.
const TREE: f64 = 220.0;
/// Least brightness of a light background, of 255; a dark one has a quarter of it.
const LIGHT: i32 = 200;

/// The loss that a file names, which is then gone; lack of memory stays.
pub fn take(file: &Path) -> Option<vk::Result> {
    let name = std::fs::read_to_string(file).ok()?;
    if name == NO_MEMORY {
        return Some(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
    }
    std::fs::remove_file(file).ok()?;
    LOSSES.iter().find(|(known, ..)| *known == name).map(|(_, result, _)| *result)
}

/// The next frame has a loss.
fn lose(folder: &Path, name: &str) {
    let beside = folder.join("loss.new");
    std::fs::write(&beside, name).expect("written");
    std::fs::rename(beside, folder.join(LOSS)).expect("renamed");
}

#[test]
fn a_lost_surface_and_a_lost_device_change_nothing_that_is_shown() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened(display, "assembly.step");
    let (at, _) = scene.place(|_, face| face.kind == SurfaceKind::Plane);
    display.click(at);
    program.wait("selected ");
    program.rest();
    program.after(|| display.key("h"));
    program.after(|| display.key("3"));
    let command = |program: &mut Program| program.command(display).split("copied: ").nth(1).map(str::to_owned);
    let (picture, view) = (program.picture(display), command(&mut program));
    // each twice: the second device is lost, too
    for (nth, (name, _, goes_on)) in LOSSES.iter().chain(&LOSSES).enumerate() {
        lose(folder.path(), name);
        let said = program.after(|| display.move_to(scene.corner + 40.0 + 10.0 * nth as f64));
        assert!(said.iter().any(|line| line.contains(goes_on)), "{name}:\n{}", said.join("\n"));
        assert_eq!(command(&mut program), view, "after the loss of the {name}");
        assert!(program.picture(display) == picture, "after the loss of the {name}");
    }
    assert!(is_in_place(&program.after(|| display.key("ctrl+z"))), "hiding is undone still");
    assert!(program.picture(display) != picture);
    program.close(display);
}

/// The window shows the picture before, and that is what the hand points at.
#[test]
fn without_memory_for_a_picture_the_one_before_is_picked_from() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened(display, "bracket.step");
    // not flat: elsewhere a ray from another side would meet the surface in another point
    let (at, hit) = scene.place(|_, face| face.kind == SurfaceKind::Cylinder);
    lose(folder.path(), NO_MEMORY);
    let said = program.after(|| display.key("3"));
    assert!(said.iter().any(|line| line.contains("a view cannot be drawn")), "{}", said.join("\n"));
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", hit.face)), "{selected}");
    let found = DVec3::from_slice(&numbers(&program.wait("point: "), "point: "));
    let off = found.distance(hit.point) / scene.world.bounds.diagonal();
    assert!(off < PICKED, "{found} instead of {}", hit.point);
    program.rest();
    std::fs::remove_file(folder.path().join(LOSS)).expect("there");
    let said = program.after(|| display.key("1"));
    assert!(said.iter().any(|line| line.contains("picture of ")), "{}", said.join("\n"));
    program.close(display);
}

#[test]
fn panels_and_picture_have_the_scale_of_display_and_settings_and_the_desktop_s_colours() {
    let Some(screen) = Screen::open((1400, 900)) else { return };
    let display = &screen.display;
    // GSettings say nothing of colours then
    let unset = ("GSETTINGS_BACKEND", "memory");
    let twice = [("WINIT_X11_SCALE_FACTOR", "2"), (SIZE, "700 450"), unset];
    let (_folder, mut program, scene) = opened_in(display, "bracket.step", &twice, |folder| {
        std::fs::write(folder.join("kdeglobals"), "[General]\nColorScheme=BreezeLight\n").expect("written");
        std::fs::write(folder.join("settings.json"), r#"{"text": 0.75}"#).expect("written");
    });
    // twice for the display, three quarters of that for the settings
    assert!((scene.corner.x - 1.5 * TREE).abs() < 2.0, "the picture begins at {}", scene.corner);
    program.last("the desktop is light");
    assert!(display.screen().brightness(scene.corner + 4.0) > LIGHT);
    let (at, face) = scene.cylinder();
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", face.id)), "{selected}");
    program.rest();
    program.close(display);
}
