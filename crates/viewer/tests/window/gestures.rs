//! Gestures and keys that move the view, read from the command line that the window copies.

use super::{Screen, opened, opened_with};
use glam::{DVec2, DVec3};
use selvedge::model::Camera;
use selvedge_viewer::navigation::gesture::LINE_PX;
use selvedge_viewer::navigation::standard::StandardView;

/// Pixels by which a point that a gesture holds may be off: the camera is written with all its digits.
const HELD_PX: f64 = 0.01;

#[test]
fn a_gesture_holds_the_point_under_the_cursor() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "bracket.step");
    let (at, _) = scene.cylinder();
    let at = at.floor();
    let point = scene.hit(at).expect("it is seen").point;
    let off = |camera: &Camera, place: DVec2| scene.in_window(camera, point).distance(place);
    program.point(display, at);

    // the wheel zooms to it
    program.after(|| drop(display.xdotool("click --repeat 3 --delay 60 4")));
    let zoomed = scene.camera_of(&program.command(display));
    assert!(zoomed.eye.distance(point) < 0.8 * scene.camera.eye.distance(point));
    assert!(off(&zoomed, at) < HELD_PX, "{}", off(&zoomed, at));

    // the middle button moves it
    let by = DVec2::new(42.0, 24.0);
    program.drag(display, 2, at, by);
    let moved = scene.camera_of(&program.command(display));
    assert!(off(&moved, at + by) < HELD_PX, "{}", off(&moved, at + by));
    assert!(moved.eye.distance(zoomed.eye) > 1e-3 * scene.world.bounds.diagonal());

    // the right one turns about it
    program.drag(display, 3, at + by, DVec2::new(60.0, 18.0));
    let turned = scene.camera_of(&program.command(display));
    assert!(off(&turned, at + by) < HELD_PX, "{}", off(&turned, at + by));
    let direction = |camera: &Camera| (camera.target - camera.eye).normalize();
    assert!(direction(&turned).dot(direction(&moved)) < 0.99);
    program.close(display);
}

/// As a tap does, and a hand that is quicker than a frame.
#[test]
fn a_click_counts_where_the_cursor_has_just_come_from_a_panel() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "bracket.step");
    let (at, face) = scene.cylinder();
    let panel = DVec2::new(0.5 * scene.corner.x, at.y);
    program.after(|| display.move_to(panel));
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains(&format!("cylinder #{}", face.id)), "{selected}");
    program.rest();
    program.close(display);
}

#[test]
fn two_fingers_move_the_view_sideways() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened_with(display, "bracket.step", |folder| {
        std::fs::write(folder.join("settings.json"), r#"{"preset": "trackpad"}"#).expect("written");
    });
    let (at, _) = scene.cylinder();
    let at = at.floor();
    let point = scene.hit(at).expect("it is seen").point;
    program.point(display, at);
    // winit 0.30 reports a line for the press of such a button, and one for its release
    for (click, place) in [("click 6", at + 2.0 * LINE_PX * DVec2::X), ("click 7", at)] {
        display.xdotool(click);
        (0..2).for_each(|_| _ = program.wait("scrolled by "));
        program.rest();
        let camera = scene.camera_of(&program.command(display));
        let off = scene.in_window(&camera, point).distance(place);
        assert!(off < HELD_PX, "{click}: {off} pixels from where two fingers lead");
    }
    program.close(display);
}

#[test]
fn keys_and_the_cube_lead_to_views_and_back() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "bracket.step");
    let (bounds, centre) = (scene.world.bounds, scene.world.bounds.centre());
    let views = [
        ("1", StandardView::Front),
        ("3", StandardView::Right),
        ("7", StandardView::Top),
        ("ctrl+1", StandardView::Back),
        ("ctrl+3", StandardView::Left),
        ("ctrl+7", StandardView::Bottom),
        ("9", StandardView::Iso),
    ];
    for (key, view) in views {
        program.after(|| display.key(key));
        let camera = scene.camera_of(&program.command(display));
        let from = (camera.eye - camera.target).normalize();
        assert!(from.distance(view.from().normalize()) < 1e-9, "{key}: {from}");
    }
    program.after(|| display.key("5"));
    assert!(program.command(display).contains("--ortho="));
    program.after(|| display.key("BackSpace"));
    assert!(program.command(display).contains("--fov="));

    program.after(|| display.key("Home"));
    let all = scene.camera_of(&program.command(display));
    assert!(bounds.corners().iter().all(|p| all.project(*p).is_some_and(|(pixel, _)| is_inside(&all, pixel))));
    program.after(|| display.key("minus"));
    let farther = scene.camera_of(&program.command(display));
    assert!(farther.eye.distance(centre) > 1.1 * all.eye.distance(centre));
    program.after(|| display.key("shift+Right"));
    let shifted = scene.camera_of(&program.command(display));
    let step = scene.in_window(&shifted, farther.target) - scene.in_window(&farther, farther.target);
    assert!(step.x > 10.0 && step.y.abs() < 1e-6, "{step}");
    program.after(|| display.key("Left"));
    let turned = scene.camera_of(&program.command(display));
    let up = |camera: &Camera| camera.axes().1;
    assert!((turned.eye - turned.target).normalize().distance((shifted.eye - shifted.target).normalize()) > 0.1);
    assert!(up(&turned).dot(DVec3::Z) > 0.0);

    // the middle of the cube shows one of its sides, edges or corners
    let cube = scene.corner + DVec2::new(f64::from(scene.camera.size.0) - 56.0, 56.0);
    display.move_to(cube);
    program.rest();
    display.click(cube);
    program.wait("LookFrom");
    program.rest();
    display.key("question");
    program.wait("Help");
    display.key("Escape");
    program.wait("Clear");
    program.close(display);
}

fn is_inside(camera: &Camera, pixel: DVec2) -> bool {
    let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
    pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(size).all()
}
