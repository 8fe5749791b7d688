//! Losses of the surface and of the device, a suspended program, no memory for a picture, and a display of another
//! scale: the window goes on, and looks the same.

use super::hand::{Program, numbers};
use super::living::is_in_place;
use super::scene::Scene;
use super::{LEAST_TINT, SIZE, Screen, opened, opened_in};
use glam::{DVec2, DVec3};
use selvedge::ash::vk;
use selvedge::model::SurfaceKind;
use selvedge_viewer::Fault;
use std::path::Path;
use std::time::Duration;

/// The file beside the open one that names a loss.
pub const LOSS: &str = "loss";
/// Losses by their names, and what the log says when the window goes on.
const LOSSES: [(&str, vk::Result, &str); 2] = [
    ("surface", vk::Result::ERROR_SURFACE_LOST_KHR, "the surface is lost, and made again"),
    ("device", vk::Result::ERROR_DEVICE_LOST, "the device is open again"),
];
/// Names no memory for any picture while there is such a file.
const NO_MEMORY: &str = "memory";
/// Names a system that suspends the program, and for how long.
const SUSPENDED: (&str, Duration) = ("suspended", Duration::from_secs(4));
/// How far a picked point may be from that of an exact ray, relative to the model's size: some roundings of `f64`.
const PICKED: f64 = 1e-9;
/// Width of the tree, points.
const TREE: f64 = 220.0;
/// Least brightness of a light background, of 255; a dark one has a quarter of it.
const LIGHT: i32 = 200;

/// The loss that a file names, which is then gone; lack of memory stays.
pub fn take(file: &Path) -> Option<Fault> {
    let name = std::fs::read_to_string(file).ok()?;
    if name == NO_MEMORY {
        return Some(Fault::Vulkan(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
    }
    std::fs::remove_file(file).ok()?;
    if name == SUSPENDED.0 {
        return Some(Fault::Suspended(SUSPENDED.1));
    }
    LOSSES.iter().find(|(known, ..)| *known == name).map(|(_, result, _)| Fault::Vulkan(*result))
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

/// Each time the system takes the surface while a frame is in flight. Nothing is drawn until it gives one again; then
/// the window shows what it did, with the device, the scene, the view and the selection of before.
#[test]
fn a_suspended_window_draws_nothing_and_then_goes_on() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened(display, "assembly.step");
    let (at, _) = scene.place(|_, face| face.kind == SurfaceKind::Plane);
    display.click(at);
    program.wait("selected ");
    program.rest();
    let away = scene.corner + 4.0;
    program.after(|| display.move_to(away));
    let command = |program: &mut Program| program.command(display).split("copied: ").nth(1).map(str::to_owned);
    let (picture, view) = (program.picture(display), command(&mut program));
    let warmth = display.screen().warmth(at);
    for nth in 0..2 {
        lose(folder.path(), SUSPENDED.0);
        display.move_to(away + 10.0);
        program.wait(": suspended");
        let before = program.all.len();
        // the hand goes on meanwhile
        for step in 0..4 {
            display.move_to(away + 10.0 * f64::from(step));
        }
        display.move_to(away);
        program.wait(": resumed");
        let meanwhile = &program.all[before..];
        let draws = |line: &&String| ["pointer at ", "picture of "].iter().any(|what| line.contains(what));
        assert!(!meanwhile.iter().any(|line| draws(&line)), "the {nth}. time:\n{}", meanwhile.join("\n"));
        program.wait("pointer at ");
        program.rest();
        assert!(!program.all[before..].iter().any(|line| line.contains("uploaded")), "{}", program.all.join("\n"));
        let now = display.screen().warmth(at);
        assert!(now.abs_diff(warmth) <= 2, "what is selected is tinted still: {now} instead of {warmth}");
        assert_eq!(command(&mut program), view, "the {nth}. time");
        assert!(program.picture(display) == picture, "the {nth}. time");
    }
    assert!(is_in_place(&program.after(|| display.key("h"))), "what is selected is hidden");
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

/// A display of half as many pixels again for an inch, as when a window comes to another monitor: the window has as many
/// points as before, with as large a text to the eye, and the hand still meets what it points at.
#[test]
fn a_display_of_another_scale_changes_the_text_and_the_picture_s_pixels() {
    let Some(screen) = Screen::open((1400, 900)) else { return };
    let display = &screen.display;
    let unset = [("WINIT_X11_SCALE_FACTOR", ""), (SIZE, "900 560")];
    let (folder, mut program, before) = opened_in(display, "bracket.step", &unset, |_| {});
    assert!((before.corner.x - TREE).abs() < 2.0, "the picture begins at {}", before.corner);
    let (at, face) = before.cylinder();
    display.click(at);
    program.wait("selected ");
    program.rest();
    let eye = before.camera_of(&program.command(display)).eye;

    display.set_scale(&program.id, 1.5);
    let told = program.wait("the display's scale is ");
    assert!(told.ends_with("is 1.5"), "{told}");
    program.rest();
    let mut after = Scene::new(&folder.path().join("bracket.step"), &program.last("view of "));
    // the sides of panels are whole pixels; the rows of the toolbar may break elsewhere
    let sides = |scene: &Scene| DVec2::new(scene.corner.x, scene.corner.x + f64::from(scene.camera.size.0));
    let off = (sides(&after) - 1.5 * sides(&before)).abs().max_element();
    assert!(off < 4.0, "left and right: {} after {}", sides(&after), sides(&before));
    let whole = format!("picture of {} x {} ", after.camera.size.0, after.camera.size.1);
    assert!(program.last("picture of ").contains(&whole), "{}", program.last("picture of "));
    after.camera = after.camera_of(&program.command(display));
    assert_eq!(after.camera.eye, eye, "the view is the same");

    // still selected: tinted blue, until Escape
    let (place, _) = after.place(|hit, _| hit.face == face.id);
    program.after(|| display.move_to(after.corner + 4.0));
    let selected = display.screen().warmth(place);
    program.after(|| display.key("Escape"));
    let plain = display.screen().warmth(place);
    assert!(selected < plain - LEAST_TINT, "{selected} where it is {plain}");
    display.click(place);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", face.id)), "{selected}");
    program.rest();
    program.close(display);
}
