//! A view without a window: what the mouse and keys do to its camera, and which picture is due.

use super::*;
use crate::navigation::gesture::Button;
use selvedge::picture::Effects;

const BOX: Bounds = Bounds { min: DVec3::ZERO, max: DVec3::new(40.0, 30.0, 20.0) };
const MODE: (Preset, OrbitStyle) = (Preset::Onshape, OrbitStyle::Turntable);

fn view(now: Instant) -> View {
    let mut view = View::default();
    view.resize((800, 600));
    view.set_bounds(BOX);
    view.reset(now);
    view
}

fn held(button: Button) -> Held {
    let mut held = Held::default();
    held.button(button, true);
    held
}

#[test]
fn a_moving_view_has_fewer_pixels_and_a_still_one_all() {
    let start = Instant::now();
    let mut view = view(start);
    let later = start + Duration::from_secs(1);
    assert_eq!((view.due(later).step.scale, view.wake(later)), (1.0, None));
    assert_eq!((view.first().step.scale, view.first().camera.size), (0.5, (400, 300)));
    view.wheel(DVec2::new(300.0, 200.0), 1.0, later);
    assert!(view.due(later).step.scale < 1.0);
    let wake = view.wake(later).expect("the still picture");
    assert_eq!((view.due(wake).step.scale, view.due(wake).camera.size), (1.0, (800, 600)));
    assert_eq!(view.wake(wake), None);
}

#[test]
fn the_first_picture_has_no_effects() {
    let now = Instant::now();
    let all = Effects { borders: true, ambient: true, lines: true, shadows: true };
    let mut view = view(now);
    view.pacing.set_effects(all);
    assert_eq!((view.first().step.without, view.pacing.step().without), (all, Effects::NONE));
}

#[test]
fn a_move_touches_the_first_view_and_a_larger_model_does_not() {
    let now = Instant::now();
    for smooth in [false, true] {
        let mut view = view(now);
        view.set_bounds(Bounds { max: 2.0 * BOX.max, ..BOX });
        assert!(view.is_untouched());
        view.look_from(DVec3::Z, DVec3::Y, smooth, now);
        assert!(!view.is_untouched());
        view.reset(now);
        assert!(view.is_untouched());
    }
}

#[test]
fn a_drag_waits_for_its_point_and_holds_it() {
    let now = Instant::now();
    let mut view = view(now);
    let (start, point) = (DVec2::new(420.0, 310.0), DVec3::new(40.0, 0.0, 20.0));
    let start_pixel = view.camera.project(point).expect("in front").0;
    view.press(start);
    assert_eq!(view.wants_point(), Some(start));
    view.moved(start + 50.0, held(Button::Right), MODE, now);
    assert_eq!(view.camera.project(point).expect("in front").0, start_pixel, "nothing moves yet");
    view.hold(Some(point));
    view.moved(start + 50.0, held(Button::Right), MODE, now);
    let at = view.camera.project(point).expect("in front").0;
    assert!(at.distance(start_pixel) < 1e-6 && view.is_dragging());
    assert!(view.due(now).step.scale < 1.0);
    assert!(!view.release());
    assert_eq!((view.due(now).step.scale, view.wake(now)), (1.0, None));
    assert!(view.previous(false, now));
}

#[test]
fn a_press_in_one_place_is_a_click() {
    let now = Instant::now();
    let mut view = view(now);
    view.press(DVec2::new(10.0, 10.0));
    view.hold(None);
    view.moved(DVec2::new(12.0, 11.0), held(Button::Left), MODE, now);
    assert!(view.release() && !view.release());
    assert!(!view.previous(false, now));
}

#[test]
fn the_wheel_keeps_its_anchor_while_the_cursor_rests() {
    let now = Instant::now();
    let mut view = view(now);
    let point = DVec3::new(40.0, 30.0, 20.0);
    let cursor = view.camera.project(point).expect("in front").0;
    view.hover = Some(Hover { cursor, hit: Hit { picked: None, point: Some(point) } });
    for _ in 0..40 {
        view.wheel(cursor, 1.0, now);
        assert!(view.camera.project(point).expect("in front").0.distance(cursor) < 1e-5);
    }
}

#[test]
fn two_fingers_move_what_is_under_the_cursor_and_turn_about_it() {
    let now = Instant::now();
    let mut view = view(now);
    let point = DVec3::new(40.0, 0.0, 20.0);
    let cursor = view.camera.project(point).expect("in front").0;
    view.hover = Some(Hover { cursor, hit: Hit { picked: None, point: Some(point) } });
    let place = |view: &View, p: DVec3| view.camera.project(p).expect("in front").0;
    let by = DVec2::new(7.0, -3.0);
    for step in 1..=5 {
        view.scroll(cursor, Scrolled::Pan(by), OrbitStyle::Turntable, now);
        assert!(place(&view, point).distance(cursor + by * f64::from(step)) < 1e-6);
    }
    let under = view.under(cursor);
    assert!(place(&view, under).distance(cursor) < 1e-6);
    let before = view.camera;
    for _ in 0..5 {
        view.scroll(cursor, Scrolled::Orbit(by), OrbitStyle::Turntable, now);
        assert!(place(&view, under).distance(cursor) < 1e-6);
    }
    let direction = |camera: &Camera| (camera.target - camera.eye).normalize();
    assert!(direction(&view.camera).dot(direction(&before)) < 0.999);
    view.scroll(cursor, Scrolled::Zoom(2.0), OrbitStyle::Turntable, now);
    assert!(view.camera.eye.distance(under) < 0.8 * before.eye.distance(under));
    assert!(view.due(now).step.scale < 1.0, "the view moves");
}

#[test]
fn a_pinch_zooms_as_far_as_the_fingers_go() {
    let now = Instant::now();
    let mut view = view(now);
    let cursor = DVec2::new(300.0, 250.0);
    let point = view.under(cursor);
    let before = view.camera.eye.distance(point);
    view.pinch(cursor, 0.25, now);
    assert!((before / view.camera.eye.distance(point) - 1.25).abs() < 1e-9);
    view.pinch(cursor, -0.2, now);
    assert!((before / view.camera.eye.distance(point) - 1.0).abs() < 1e-9);
    let camera = view.camera;
    view.pinch(cursor, f64::NAN, now);
    view.twist(cursor, f64::NAN, OrbitStyle::Free, now);
    view.twist(cursor, 0.5, OrbitStyle::Turntable, now);
    assert_eq!(view.camera, camera);
    view.twist(cursor, 0.5, OrbitStyle::Free, now);
    assert!(view.camera.axes().1.dot(camera.axes().1) < 0.9);
    assert!(view.camera.project(point).expect("in front").0.distance(cursor) < 1e-6);
}

#[test]
fn keys_move_and_zoom_and_lead_back() {
    let now = Instant::now();
    let mut view = view(now);
    let (first, point) = (view.camera, view.camera.target);
    let (start, _) = first.project(point).expect("in front");
    view.shift(DVec2::new(50.0, -20.0), now);
    let (at, depth) = view.camera.project(point).expect("in front");
    assert!(at.distance(start + DVec2::new(50.0, -20.0)) < 1e-6, "{at}");
    view.zoom(3.0, now);
    let (_, closer) = view.camera.project(point).expect("in front");
    assert!(closer < depth);
    assert!(view.previous(false, now) && view.previous(false, now));
    assert_eq!((view.camera.eye, view.camera.target), (first.eye, first.target));
}

#[test]
fn a_transition_ends_at_its_goal_and_leads_back() {
    let start = Instant::now();
    let mut view = view(start);
    let first = view.camera;
    view.look_from(DVec3::Z, DVec3::Y, true, start);
    let goal = view.goal();
    view.advance(start + DURATION / 2);
    assert!(view.camera != goal && view.camera != first && view.wake(start + DURATION / 2).is_some());
    view.advance(start + DURATION);
    assert_eq!(view.camera, goal);
    assert!(view.previous(false, start + DURATION));
    assert_eq!(view.camera.eye, first.eye);
}

#[test]
fn a_key_in_the_middle_of_a_transition_starts_from_its_goal() {
    let start = Instant::now();
    let half = start + DURATION / 2;
    let keys: [fn(&mut View, Instant); 3] = [
        |view, now| view.zoom(2.0, now),
        |view, now| view.shift(DVec2::new(50.0, -20.0), now),
        |view, now| view.turn(DVec2::new(50.0, -20.0), OrbitStyle::Turntable, now),
    ];
    for key in keys {
        let of = |smooth: bool| {
            let mut view = view(start);
            view.look_from(DVec3::Z, DVec3::Y, smooth, start);
            view.advance(half);
            let cursor = DVec2::new(400.0, 300.0);
            view.hover = smooth.then_some(Hover { cursor, hit: Hit { picked: None, point: Some(BOX.max) } });
            key(&mut view, half);
            view.advance(start + DURATION);
            view.camera
        };
        assert_eq!(of(true), of(false));
    }
}
