//! The badge, the warnings behind it, and the verdict of the judge.

use super::*;

#[test]
fn the_badge_says_what_is_not_as_promised() {
    let mut bench = Bench::new();
    assert!(bench.says("exact within 0.5 px"));
    bench.notice = Some("borders are not smooth");
    assert!(bench.says("exact, with a note"));
    bench.stats.get_or_insert_default().clamps = 3;
    assert!(bench.says("3 places not as promised") && !bench.says("exact"));
}

/// Until a frame is drawn, the session alone has its files.
#[test]
fn warnings_of_a_file_are_one_click_away() {
    let mut bench = Bench::new();
    let world = Arc::get_mut(&mut bench.session.world).expect("not drawn yet");
    let file = &mut world.files[0];
    (file.complete, file.warnings) = (false, vec!["face #7 is left out".to_owned()]);
    assert!(bench.says("not all of the file") && !bench.says("exact") && !bench.says("face #7"));
    bench.click("1 warnings");
    assert!(bench.says("face #7 is left out"));
}

#[test]
fn a_file_that_is_being_read_is_not_called_exact() {
    let mut bench = Bench::new();
    Arc::get_mut(&mut bench.session.world).expect("not drawn yet").files[0].partial = true;
    assert!(bench.says("being read") && !bench.says("exact"));
}

#[test]
fn wrong_pixels_are_painted_in_the_judged_view_alone() {
    let mut bench = Bench::new();
    bench.place(bench.session.world.bounds.centre());
    let camera = *bench.view.camera();
    let verdict = |wrong| Verdict { camera, sampled: 20_000, wrong, pixels: vec![[300, 200]] };
    bench.ui.judged(verdict(0));
    bench.frame(Vec::new());
    assert!(bench.dots.is_empty(), "pixels that differ at their centre alone are not wrong");
    bench.ui.judged(verdict(1));
    assert!(bench.ui.messages.last().is_some_and(|told| told.contains("1 are wrong")), "{:?}", bench.ui.messages);
    bench.frame(Vec::new());
    let place = bench.rect.min + egui::Vec2::new(300.5, 200.5);
    // the view has whole pixels, the panel has not
    assert!(bench.dots.len() == 1 && bench.dots[0].distance(place) < 1.0, "{:?} instead of {place}", bench.dots);
    bench.view.zoom(1.0, Instant::now());
    bench.frame(Vec::new());
    assert!(bench.dots.is_empty(), "another view");
}
