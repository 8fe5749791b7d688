//! Parts that are hidden and shown, cut, and trims that are dragged.

use super::hand::{Display, Program, numbers};
use super::{Screen, opened, sample};
use glam::DVec2;
use selvedge::model::{Face, SurfaceKind};
use selvedge_check::Hit;
use selvedge_io::import;
use selvedge_viewer::measure::cut;
use selvedge_viewer::pick::nearest_loop;
use selvedge_viewer::session::{Picked, Session};
use std::sync::Arc;

/// The scene changed in place: nothing was uploaded, and no upload is on its way.
pub fn is_in_place(said: &[String]) -> bool {
    let has = |what: &str| said.iter().any(|line| line.contains(what));
    has("changed in place") && !has("uploaded") && !has("an upload is needed")
}

/// Sends a key that needs an upload, and waits for its picture.
fn upload(program: &mut Program, display: &Display, key: &str) {
    display.key(key);
    program.wait("uploaded");
    program.wait("picture of");
    program.rest();
}

#[test]
fn parts_are_hidden_and_shown_without_an_upload() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (_folder, mut program, scene) = opened(display, "assembly.step");
    let (at, before, behind) = scene.behind();
    let first = program.picture(display);
    let shows = |program: &mut Program, face: u32, instance: usize| {
        display.click(at);
        let selected = program.wait("selected ");
        let wanted = format!("#{face} of {}", scene.world.instance_name(instance));
        assert!(selected.contains(&wanted), "{selected} instead of {wanted}");
        program.rest();
    };
    shows(&mut program, before.face, before.instance);
    assert!(is_in_place(&program.after(|| display.key("h"))));
    assert!(program.picture(display) != first, "the part is hidden");
    shows(&mut program, behind.face, behind.instance);
    assert!(is_in_place(&program.after(|| display.key("a"))));
    assert!(program.picture(display) == first, "as it was, pixel by pixel");
    assert!(is_in_place(&program.after(|| display.key("ctrl+z"))));
    assert!(is_in_place(&program.after(|| display.key("ctrl+shift+z"))));
    shows(&mut program, before.face, before.instance);
    assert!(is_in_place(&program.after(|| display.key("i"))));
    assert!(is_in_place(&program.after(|| display.key("a"))));

    // rays are followed through glass: that is another scene, also for what is hidden in it
    shows(&mut program, before.face, before.instance);
    upload(&mut program, display, "x");
    assert!(program.picture(display) != first, "the part is of glass");
    upload(&mut program, display, "ctrl+z");
    assert!(program.picture(display) == first, "as it was, pixel by pixel");
    program.close(display);
}

#[test]
fn a_section_at_a_face_follows_its_handle() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened(display, "assembly.step");
    let (bounds, forward) = (scene.world.bounds, scene.camera.axes().2);
    // its arrow is long enough to be gripped
    let is_slanted = |normal: glam::DVec3| normal.dot(forward).abs() < 0.8;
    let (at, hit) = scene.place(|hit, face| face.kind == SurfaceKind::Plane && is_slanted(hit.normal));
    let mut session = Session { world: Arc::clone(&scene.world), ..Session::default() };
    session.select(Some(Picked::Face { instance: hit.instance, face: hit.face_index, uv: hit.uv }), false);
    let section = cut::at_selection(&session).expect("a plane");
    display.click(at);
    program.wait("selected ");
    program.rest();
    upload(&mut program, display, "c");
    let offset = |line: &str| numbers(line, "--section=")[3];
    let line = program.command(display);
    assert!((offset(&line) - section.offset).abs() < 1e-9 * bounds.diagonal(), "{line}");

    display.screen().keep("section.png");

    // into the material
    let middle = bounds.centre();
    let foot = |offset: f64| middle + section.normal * (offset - section.normal.dot(middle));
    let place = |offset: f64| scene.in_window(&scene.camera, foot(offset));
    let along = (place(section.offset + 0.08 * bounds.diagonal()) - place(section.offset)).normalize();
    let (from, by) = (place(section.offset).round(), -30.0 * along);
    let said = program.drag(display, 1, from, by);
    assert!(said.iter().any(|line| line.contains("uploaded")), "{}", said.join("\n"));
    let dragged = offset(&program.command(display));
    assert!(dragged < section.offset);
    // the cursor has whole pixels, a step is linear in perspective, and the plane may snap to a face four pixels away
    let off = (place(dragged) - (from + by)).dot(along);
    assert!(off.abs() < 8.0, "{off} pixels from the hand");
    upload(&mut program, display, "ctrl+z");
    let undone = offset(&program.command(display));
    assert!((undone - section.offset).abs() < 1e-9 * bounds.diagonal());

    // the file is written and read again: the view, the section and what is hidden stay, and so does what is undone
    upload(&mut program, display, "h");
    program.after(|| display.key("minus"));
    let view = |program: &mut Program| program.command(display).split("copied: ").nth(1).map(str::to_owned);
    let (picture, from) = (program.picture(display), view(&mut program));
    std::fs::copy(sample("assembly.step"), folder.path().join("assembly.step")).expect("copied");
    program.wait("has changed");
    program.wait("uploaded");
    program.rest();
    assert_eq!(view(&mut program), from);
    assert!(program.picture(display) == picture, "as it was, pixel by pixel");
    upload(&mut program, display, "ctrl+z");
    assert!(program.picture(display) != picture, "the part is shown again");
    program.close(display);
}

#[test]
fn a_trim_follows_the_hand_without_an_upload() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened(display, "bracket.step");
    // beside a hole, whose loop is then the one to drag
    let beside = |hit: &Hit, face: &Face| -> Option<usize> {
        let nearest = |uv: DVec2| nearest_loop(&face.surface, &face.loops, uv);
        let hole = nearest(hit.uv).filter(|nth| *nth > 0)?;
        let (low, high) = face.loops[hole].bounds();
        // also where the cursor is some pixels away
        let around = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|by| hit.uv + 0.1 * by * (high - low));
        around.iter().all(|uv| nearest(*uv) == Some(hole)).then_some(hole)
    };
    let (at, hit) = scene.place(|hit, face| face.kind == SurfaceKind::Plane && beside(hit, face).is_some());
    let hole = beside(&hit, &scene.faces()[hit.face_index]).expect("it was found");
    display.click(at);
    program.wait("selected ");
    program.rest();
    upload(&mut program, display, "t");
    let (face, placed) = (&scene.faces()[hit.face_index], &scene.world.model.instances[hit.instance]);
    let chosen = numbers(&program.last("trim loop "), "trim loop ");
    assert_eq!(chosen, [(hole + 1) as f64, face.loops.len() as f64]);
    let points = face.loops[hole].curves().map(|curve| curve.points[0]);
    let uvs = points.map(|p| p.truncate() / p.z);
    let places = uvs.map(|uv| placed.transform.transform_point3(face.surface.point(uv.x, uv.y)));
    let mut places = places.map(|p| scene.in_window(&scene.camera, p).round());
    let grip = places.find(|place| scene.is_in_view(*place)).expect("a point of a hole is seen");
    let said = program.drag(display, 1, grip, DVec2::new(6.0, 4.0));
    assert!(is_in_place(&said), "{}", said.join("\n"));

    // undone, done again, and saved by the dialog
    let dragged = program.picture(display);
    assert!(is_in_place(&program.after(|| display.key("ctrl+z"))));
    assert!(program.picture(display) != dragged, "the hole is where it was");
    assert!(is_in_place(&program.after(|| display.key("ctrl+shift+z"))));
    assert!(program.picture(display) == dragged, "pixel by pixel");
    display.key("ctrl+e");
    program.settle();
    display.key("Return");
    program.said("edited.selvedge is saved");
    program.rest();
    let saved = import::open(&folder.path().join("edited.selvedge")).expect("it is read").model;
    let all = |faces: &[Face]| faces.iter().flat_map(|face| face.loops.clone()).collect::<Vec<_>>();
    let (before, after) = (all(scene.faces()), all(&saved.parts[0].faces));
    let moved = before.iter().zip(&after).filter(|(a, b)| !a.curves().eq(b.curves())).count();
    assert_eq!((after.len(), moved), (before.len(), 1), "loops, and those of them that are others now");
    program.close(display);
}
