//! A small situation for each rule, in the order of docs/design/gaps.md.

use super::*;

const SEEN: [u32; 2] = [99, 0];
const NOTHING: [u32; 2] = [0, 0];

fn frame() -> Frame {
    Frame { gap_radius_px: 0.25, deviation_px: 0.125, focal: 512.0, ..Frame::default() }
}

fn present(face: u32, depth: f32) -> Candidate {
    Candidate { kind: Kind::Present, face, inside: true, depth, miss: 0.0, word: [face, 0], ..Candidate::default() }
}

fn near(face: u32, depth: f32) -> Candidate {
    Candidate { kind: Kind::Near, inside: false, ..present(face, depth) }
}

/// A border lies before face 9, which the pixel shows.
fn before(own: Candidate) -> Situation {
    Situation { border: true, seen: SEEN, own, ..Situation::default() }
}

/// A back face, 9, at depth 1, perhaps near its border.
fn back() -> Situation {
    let own = Candidate { away: true, ..near(9, 1.0) };
    Situation { seen: SEEN, own, ..Situation::default() }
}

/// The same back face far from its border.
fn interior() -> Situation {
    Situation { own: Candidate { away: true, ..present(9, 1.0) }, ..back() }
}

fn nothing() -> Situation {
    Situation { border: true, empty: true, ..Situation::default() }
}

#[track_caller]
fn shows(s: &Situation, candidates: &[Candidate], word: [u32; 2]) {
    assert_eq!(decide(&frame(), s, candidates), word);
}

#[test]
fn the_nearest_that_is_present_wins() {
    shows(&nothing(), &[present(1, 0.9), present(2, 0.8), present(3, 0.9)], [2, 0]);
    shows(&before(present(9, 0.85)), &[present(1, 0.9)], [9, 0]);
    shows(&before(present(9, 0.95)), &[present(1, 0.9)], [1, 0]);
}

#[test]
fn far_away_only_a_front_counts() {
    let beyond = |c: Candidate| Candidate { from: From::Beyond, ..c };
    let away = Candidate { away: true, ..present(2, 0.8) };
    shows(&interior(), &[beyond(near(1, 0.7)), beyond(away), beyond(present(3, 0.9))], [3, 0]);
    shows(&interior(), &[beyond(near(1, 0.7))], SEEN);
}

/// Across a fold, the back face's own front counts if it lies before the back; it does not touch the back.
#[test]
fn the_front_across_a_fold_counts() {
    let fold = |depth: f32| Candidate { from: From::Fold, ..present(9, depth) };
    shows(&back(), &[fold(0.999)], [9, 0]);
    shows(&interior(), &[fold(1.0001)], SEEN);
}

#[test]
fn an_interior_back_gives_way_to_a_border_before_what_is_present() {
    shows(&interior(), &[present(1, 0.9), near(2, 0.8)], [2, 0]);
    shows(&interior(), &[present(1, 0.8), near(2, 0.9)], [1, 0]);
}

#[test]
fn an_interior_back_gives_way_to_a_front_that_touches_it() {
    shows(&interior(), &[present(1, 1.0003)], [1, 0]);
    shows(&interior(), &[present(1, 1.01)], SEEN); // hidden
}

#[test]
fn an_interior_back_gives_way_to_the_closest_surface() {
    let beside = |face: u32, depth: f32, miss: f32| Candidate { kind: Kind::Absent, miss, ..present(face, depth) };
    shows(&interior(), &[beside(1, 0.9, 0.3), beside(2, 0.9, 0.2)], [2, 0]);
    shows(&interior(), &[beside(1, 0.9, 0.3), beside(2, 1.1, 0.2)], [1, 0]); // one before it is better
    shows(&interior(), &[beside(1, 0.9, 0.4)], SEEN);
    shows(&interior(), &[beside(1, 0.9, 0.01)], SEEN); // it passes the centre, beyond the end of the face
}

#[test]
fn two_borders_before_what_is_present_are_an_edge() {
    shows(&nothing(), &[near(1, 0.9), near(2, 0.8), present(3, 1.0)], [2, 0]);
    shows(&nothing(), &[near(1, 0.9), near(2, 0.8), present(3, 0.7)], [3, 0]);
    shows(&nothing(), &[near(2, 0.9), near(2, 0.8), present(3, 1.0)], [3, 0]); // of one face
}

/// Faces 1 and 2 lie in each other, and rounding puts either first.
#[test]
fn of_two_parts_that_touch_the_front_of_the_lower_instance_shows() {
    let of = |instance: u32, c: Candidate| Candidate { instance, ..c };
    let farther = 0.9 * (1.0 + SAME_DEPTH);
    for (a, b) in [(0.9, farther), (farther, 0.9)] {
        let (low, high) = (of(0, present(1, a)), of(1, present(2, b)));
        shows(&nothing(), &[low, high], [1, 0]);
        shows(&nothing(), &[high, low], [1, 0]);
        shows(&nothing(), &[high, Candidate { away: true, ..low }], [2, 0]);
        shows(&before(of(1, present(9, a))), &[of(0, present(1, b))], [1, 0]);
        shows(&before(of(0, present(9, a))), &[of(1, present(1, b))], [9, 0]);
    }
    // of one part, and farther apart, the nearer
    shows(&nothing(), &[of(1, present(1, farther)), of(1, present(2, 0.9))], [2, 0]);
    shows(&nothing(), &[of(0, present(1, 0.901)), of(1, present(2, 0.9))], [2, 0]);
}

/// Face 1 is the end of a pipe, 3 its wall; the end lies in face 2 of another part.
#[test]
fn the_end_of_a_part_within_another_part_s_face_is_not_before_it() {
    let of = |instance: u32, c: Candidate| Candidate { instance, ..c };
    let farther = 0.9 * (1.0 + SAME_DEPTH);
    let pipe = [of(1, near(1, 0.9)), of(1, near(3, 0.95))];
    let with = |face: Candidate| [pipe[0], pipe[1], face];
    shows(&nothing(), &with(of(0, present(2, farther))), [2, 0]);
    shows(&nothing(), &with(of(1, present(2, farther))), [1, 0]); // of the same part
    shows(&nothing(), &with(of(0, present(2, 0.901))), [1, 0]); // behind it
    shows(&interior(), &with(of(0, present(2, farther))), [2, 0]);
}

#[test]
fn an_isolated_pixel_has_no_edge() {
    let isolated = Situation { isolated: true, ..nothing() };
    shows(&isolated, &[near(1, 0.9), near(2, 0.8), present(3, 1.0)], [3, 0]);
    shows(&isolated, &[near(1, 0.9), near(2, 0.8)], NOTHING);
}

/// Both lie to the left, where face 1 is nearer: it hides face 2 up to their silhouette, and continues behind it.
#[test]
fn a_face_hidden_up_to_a_common_silhouette_is_not_shown_beyond_it() {
    let outline = Outline { into: [-0.5, 0.0], ends: true };
    let covering = Candidate { slope: [0.1, 0.0], outline, ..near(1, 1.0) };
    let hidden = Candidate { slope: [-0.1, 0.0], outline, ..near(2, 0.99) };
    shows(&nothing(), &[hidden, covering, present(3, 2.0)], [1, 0]);
    let goes_on = Candidate { outline: Outline { ends: false, ..outline }, ..hidden };
    shows(&nothing(), &[goes_on, covering, present(3, 2.0)], [2, 0]);
    // the own face, drawn beyond the silhouette
    let own = Candidate { face: 9, ..hidden };
    shows(&before(own), &[covering], [1, 0]);
    shows(&before(Candidate { inside: true, face: 9, ..goes_on }), &[covering], [2, 0]);
}

#[test]
fn a_face_that_ends_where_two_meet_is_a_third_that_they_hide() {
    let own = Candidate { inside: true, slope: [0.1, 0.0], ..near(9, 1.0) };
    shows(&before(own), &[present(1, 1.01), present(2, 1.01)], [1, 0]);
    shows(&before(own), &[present(1, 1.1), present(2, 1.1)], [9, 0]); // they do not meet it
    shows(&before(own), &[near(1, 1.01), present(1, 1.01)], [9, 0]); // one face
}

#[test]
fn a_grown_front_stays_before_what_is_present() {
    shows(&before(near(9, 1.0)), &[present(1, 1.1)], [9, 0]);
    shows(&before(near(9, 1.0)), &[present(1, 1.1), near(2, 0.9)], [1, 0]); // something lies before it
    let leaning = Candidate { slope: [1.0, 0.0], ..near(9, 1.0) };
    shows(&before(leaning), &[present(1, 1.1)], [1, 0]); // meets it
}

#[test]
fn a_mesh_or_solid_is_known_at_the_very_pixel() {
    // where no patch is seen
    let with = |s: Situation, depth: f32| Situation { other: Some(depth), ..s };
    shows(&with(nothing(), 0.9), &[present(1, 1.0)], NOTHING);
    shows(&with(nothing(), 1.1), &[present(1, 1.0)], [1, 0]);
    // behind a back face near whose end patches end
    shows(&with(back(), 2.0), &[present(1, 2.1)], NOTHING);
    let ends = Situation { other_beside: true, ..back() };
    shows(&with(ends, 2.0), &[near(1, 1.1)], NOTHING);
    shows(&with(back(), 2.0), &[near(1, 1.1)], [1, 0]);
    shows(&with(back(), 2.0), &[], NOTHING);
}

#[test]
fn where_nothing_is_present_the_background_shows() {
    shows(&nothing(), &[near(1, 0.9)], NOTHING);
    shows(&Situation { in_solid: true, ..nothing() }, &[near(1, 0.9)], [1, 0]); // the ray leaves a solid
    let ends = Situation { empty_beside: true, ..back() };
    shows(&ends, &[near(1, 0.9)], NOTHING);
    shows(&ends, &[present(1, 2.0)], [1, 0]);
}

#[test]
fn else_the_nearest_border_shows() {
    shows(&back(), &[near(1, 0.9), near(1, 0.8)], [1, 0]);
    shows(&back(), &[], SEEN);
}

#[test]
fn the_border_of_one_face_outlines_what_a_volume_cuts_open() {
    let own = Candidate { away: true, ..present(9, 1.0) };
    let cut = Situation { cut_open: true, ..before(own) };
    shows(&cut, &[near(1, 0.9)], [1, 0]);
    shows(&cut, &[near(1, 1.1)], [9, 0]);
    shows(&before(own), &[near(1, 0.9)], [9, 0]);
}
