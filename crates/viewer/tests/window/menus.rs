//! What menus, lists and dialogs do: finding, checking, styles, sections, saving.

use super::hand::{PICTURE, numbers, read_png};
use super::living::is_in_place;
use super::panels::Panels;
use super::{LEAST_TINT, Screen, opened, opened_with};
use glam::{DVec2, DVec3};
use selvedge::model::Bounds;
use selvedge_io::{import, native};
use selvedge_viewer::commands::Command;
use selvedge_viewer::describe::extent;
use selvedge_viewer::navigation::standard::StandardView;

const WINDOW: (u32, u32) = (900, 560);
/// Pixels of a view that are judged at least: those of a whole one are twenty thousand.
const LEAST_JUDGED: f64 = 1000.0;
/// How far boxes of one model may be apart, relative to its size: each side of each may be off by a hundred-thousandth.
const BOXES: f64 = 4e-5;

#[test]
fn a_part_is_found_by_name_and_the_view_without_it_is_right() {
    let Some(screen) = Screen::open(WINDOW) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "assembly.step");
    let mut panels = Panels::new(&scene, WINDOW);
    // the part of a row under the cursor is tinted
    let (at, _) = scene.place(|hit, _| hit.instance == 0);
    program.after(|| display.move_to(scene.corner + 4.0));
    let plain = display.screen().warmth(at);
    let first = scene.world.instance_name(0);
    let row = panels.find(&first, 0);
    program.after(|| display.move_to(row));
    let pointed = display.screen().warmth(at);
    assert!(pointed > plain + LEAST_TINT, "{pointed} where it was {plain}");

    // a click selects the whole part
    for choice in ["Anything", "Parts"] {
        panels.click(display, &mut program, choice, 0);
    }
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.ends_with(&format!("selected {first}")), "{selected} instead of {first}");
    program.rest();

    let last = scene.world.model.instances.len() - 1;
    let name = scene.world.instance_name(last);
    let before = (0..last).filter(|i| scene.world.instance_name(*i) == name).count();
    // the field beside its label
    let field = panels.find("Find", 0) + DVec2::new(60.0, 0.0);
    display.move_to(field);
    program.settle();
    display.click(field);
    program.settle();
    display.xdotool(&format!("type --delay 30 {name}"));
    // the cursor of a text does not blink
    program.rest();
    panels.ui.search.clone_from(&name);
    // the field itself shows the name, too
    panels.click(display, &mut program, &name, before + 1);
    program.rest();
    assert_eq!(panels.session.selected_instances(), [last], "the row of another part");
    program.after(|| display.key("f"));
    let target = scene.camera_of(&program.command(display)).target;
    let centre = extent(&panels.session).into_iter().fold(Bounds::EMPTY, Bounds::with).centre();
    let off = target.distance(centre) / scene.world.bounds.diagonal();
    assert!(off < 1e-9, "{target} instead of {centre}");

    assert!(is_in_place(&program.after(|| display.key("h"))));
    program.after(|| display.key("Home"));
    display.key("k");
    let checked = numbers(&program.wait("checked "), "checked ");
    assert!(checked[0] >= LEAST_JUDGED && checked[1] == 0.0, "{checked:?}: pixels, and wrong ones");
    program.rest();
    program.close(display);
}

#[test]
fn menus_choose_styles_and_cut_three_times() {
    let Some(screen) = Screen::open(WINDOW) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "bracket.step");
    let mut panels = Panels::new(&scene, WINDOW);
    let mut pictures = vec![program.picture(display)];
    // the second one needs an upload
    for style in ["technical", "mean-curvature"] {
        panels.click(display, &mut program, "Style", 0);
        panels.click(display, &mut program, style, 0);
        program.rest();
        let picture = program.picture(display);
        assert!(!pictures.contains(&picture), "{style} is not seen");
        pictures.push(picture);
    }

    for across in ["Across x", "Across y", "Across z"] {
        panels.click(display, &mut program, "Section", 0);
        panels.click(display, &mut program, across, 0);
        // the menu opens where the next picture has it
        program.rest();
    }
    let line = program.command(display);
    assert!(line.contains("--style=mean-curvature"), "{line}");
    let planes = |line: &str| -> Vec<[f64; 4]> {
        let words = line.split(' ').filter(|word| word.starts_with("--section="));
        words.map(|word| numbers(word, "--section=").try_into().expect("a plane")).collect()
    };
    let middle = scene.world.bounds.centre();
    let expected = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| [axis.x, axis.y, axis.z, axis.dot(middle)]);
    assert_eq!(planes(&line), expected);
    panels.click(display, &mut program, "Section", 0);
    panels.click(display, &mut program, "Flip", 1);
    program.rest();
    let flipped = expected[1].map(|x| -x);
    assert_eq!(planes(&program.command(display)), [expected[0], flipped, expected[2]]);
    program.close(display);
}

#[test]
fn each_choice_of_lines_and_light_is_seen() {
    let Some(screen) = Screen::open(WINDOW) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "bracket.step");
    let mut panels = Panels::new(&scene, WINDOW);
    let mut last = program.picture(display);
    // silhouettes and smooth borders are on at first
    for choice in
        ["silhouettes", "hidden lines", "smooth borders", "ambient occlusion", "shadows", "sharp edges", "no edges"]
    {
        panels.click(display, &mut program, "Style", 0);
        panels.click(display, &mut program, choice, 0);
        program.rest();
        let picture = program.picture(display);
        assert!(picture != last, "{choice}: nothing of it is seen");
        last = picture;
    }
    program.close(display);
}

#[test]
fn keys_alone_write_a_picture_without_background() {
    let Some(screen) = Screen::open(WINDOW) else { return };
    let display = &screen.display;
    let (folder, mut program, _) = opened(display, "bracket.step");
    display.key("ctrl+s");
    program.settle();
    // from the file to the width, the height and the box; from there to the button
    for key in ["Tab", "Tab", "Tab", "space", "Tab", "Return"] {
        display.key(key);
        program.settle();
    }
    program.said("is written");
    program.rest();
    let (size, pixels) = read_png(&folder.path().join("view.png"));
    assert_eq!(size, PICTURE);
    let of = |opacity: u8| pixels.iter().filter(|pixel| pixel[3] == opacity).count();
    assert!(pixels[0][3] == 0 && of(0) > pixels.len() / 4 && of(255) > pixels.len() / 20, "{} and {}", of(0), of(255));
    program.close(display);
}

#[test]
fn less_motion_is_heard_of_and_both_forms_are_saved() {
    let Some(screen) = Screen::open(WINDOW) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened_with(display, "bracket.step", |folder| {
        std::fs::create_dir(folder.join("gtk-3.0")).expect("made");
        let settings = "[Settings]\ngtk-enable-animations=0\n";
        std::fs::write(folder.join("gtk-3.0/settings.ini"), settings).expect("written");
    });
    program.last("the desktop asks for less motion");
    // the view is there at once: on its way it would be another one when the second key comes
    display.xdotool("key --clearmodifiers 3 ctrl+shift+c");
    let camera = scene.camera_of(&program.wait("copied: selvedge render"));
    let from = (camera.eye - camera.target).normalize();
    assert!(from.distance(StandardView::Right.from().normalize()) < 1e-9, "from {from}");
    program.rest();
    let mut panels = Panels::new(&scene, WINDOW);

    // the model as it is, in both forms
    let model = &scene.world.model;
    for name in ["copy.selvedge", "copy.step"] {
        display.key("ctrl+e");
        program.settle();
        panels.obey(Command::SaveAs);
        panels.write(display, &mut program, "edited.selvedge", name);
        panels.click(display, &mut program, "Save", 0);
        program.said(&format!("{name} is saved"));
        panels.ui.save = None;
        let read = import::open(&folder.path().join(name)).expect("it is read").model;
        assert_eq!(read.face_count(), model.face_count(), "{name}");
        let (mine, its) = (model.bounds(), read.bounds());
        let off = mine.min.distance(its.min).max(mine.max.distance(its.max)) / mine.diagonal();
        assert!(off < BOXES, "{name}: {off}");
        if name.ends_with(".selvedge") {
            assert!(native::write(&read) == native::write(model), "{name} is not the same, bit for bit");
        }
    }

    program.close(display);
}
