//! Loops of one curve whose ends nearly meet, through every entity that states a loop.

use super::{Entity, e, import};
use crate::model::TrimLoop;
use std::f64::consts::{PI, TAU};

/// A plane of 10 x 10 mm whose parameters are its coordinates.
const PLANE: &str = "128,1,1,1,1,0,0,1,0,0,0.,0.,10.,10.,0.,0.,10.,10.,1.,1.,1.,1.,0.,0.,0.,10.,0.,0.,0.,10.,0.,10.,10.,0.,0.,10.,0.,10.;";

/// A closed curve about (5, 5) of size 3 whose last point is `gap` beyond or before its first, and the area within.
fn curve(kind: &str, gap: f64) -> (Entity, f64) {
    let at = |a: f64| (5.0 + 3.0 * a.cos(), 5.0 + 3.0 * a.sin());
    match kind {
        "arc" => {
            let (x, y) = at(gap / 3.0);
            (e(&format!("100,0.,5.,5.,8.,5.,{x:.17},{y:.17};")), 9.0 * PI)
        }
        "ellipse" => {
            // half as wide as it is high
            let (x, y) = (5.0 + 1.5 * (gap / 3.0).cos(), 5.0 + 3.0 * (gap / 3.0).sin());
            let text = format!("104,4.,0.,1.,-40.,-10.,116.,0.,6.5,5.,{x:.17},{y:.17};");
            (Entity { form: 1, ..e(&text) }, 4.5 * PI)
        }
        "polyline" => {
            let corners: Vec<String> = (0..=12)
                .map(|i| at(TAU * f64::from(i) / 12.0))
                .enumerate()
                .map(|(i, (x, y))| format!("{x:.17},{:.17}", if i == 12 { y + gap } else { y }))
                .collect();
            (Entity { form: 11, ..e(&format!("106,1,13,0.,{};", corners.join(","))) }, 27.0)
        }
        // uniform knots, whose range leaves the first three and the last out; the last point counts a sixth at the end
        "cubic" => {
            let knots: Vec<String> = (0..19).map(|i| format!("{i}.")).collect();
            let points: Vec<String> = (0..15)
                .map(|i| (i, at(TAU * f64::from(i % 12) / 12.0)))
                .map(|(i, (x, y))| format!("{x:.17},{:.17},0.", if i == 14 { y + 6.0 * gap } else { y }))
                .collect();
            let weights = ["1."; 15].join(",");
            let text = format!("126,14,3,1,1,1,1,{},{weights},{},3.,15.,0.,0.,1.;", knots.join(","), points.join(","));
            // a circle within 3e-4 of its radius
            let radius = 3.0 * (4.0 + 2.0 * (TAU / 12.0).cos()) / 6.0;
            (e(&text), PI * radius * radius)
        }
        // a linear spline over uniform knots, whose range leaves the first and the last out
        _ => {
            let knots: Vec<String> = (-1..=13).map(|i| format!("{i}.")).collect();
            let points: Vec<String> = (0..=12)
                .map(|i| at(TAU * f64::from(i) / 12.0))
                .enumerate()
                .map(|(i, (x, y))| format!("{x:.17},{:.17},0.", if i == 12 { y + gap } else { y }))
                .collect();
            let weights = ["1."; 13].join(",");
            let text = format!("126,12,1,1,1,1,0,{},{weights},{},0.,12.,0.,0.,1.;", knots.join(","), points.join(","));
            (e(&text), 27.0)
        }
    }
}

/// The entities of the loop `#5`, by its own curve `#3`.
fn bounds(way: &str) -> (Vec<Entity>, &'static str) {
    match way {
        "space" => (vec![e("142,0,1,0,3,2;")], "144"),
        "parameters" => (vec![e("142,0,1,3,0,1;")], "144"),
        "both" => (vec![e("142,0,1,3,3,2;")], "144"),
        "composite" => (vec![e("142,0,1,0,7,2;"), e("102,1,3;")], "144"),
        _ => (vec![e("141,0,1,1,1,3,1,0;")], "143"),
    }
}

#[test]
fn a_loop_of_one_curve_is_there_whatever_its_gap() {
    let gaps = [0.0, 1e-15, 1e-14, 1e-12, 1e-10, 1e-9, 5e-9, 1e-8, 1e-7, 3e-7, 1e-6, 1e-5, 1e-4, 3e-3];
    for kind in ["arc", "ellipse", "polyline", "spline", "cubic"] {
        for gap in gaps.into_iter().flat_map(|g| [g, -g]) {
            for way in ["space", "parameters", "both", "composite", "boundary"] {
                for hole in [true, false] {
                    let (curve, within) = curve(kind, gap);
                    let (more, owner) = bounds(way);
                    let mut all = vec![e(PLANE), curve];
                    all.extend(more);
                    let next = 2 * all.len() + 1;
                    if owner == "143" {
                        // its outer loop is a boundary, too
                        all.push(e("106,1,5,0.,0.,0.,10.,0.,10.,10.,0.,10.,0.,0.;"));
                        all.push(e(&format!("141,0,1,1,1,{next},1,0;")));
                        let outer = next + 2;
                        all.push(e(&if hole { format!("143,0,1,2,5,{outer};") } else { "143,0,1,1,5;".into() }));
                    } else {
                        all.push(e(if hole { "144,1,0,1,0,5;" } else { "144,1,1,0,5;" }));
                    }
                    let i = import(&all);
                    let named = format!("{kind} {gap:e} {way}, hole {hole}: {:?}", i.warnings);
                    assert_eq!(
                        (i.model.face_count(), i.report.warnings.contains_key("loop left out")),
                        (1, false),
                        "{named}"
                    );
                    let face = &i.model.parts[0].faces[0];
                    assert_eq!(face.loops.len(), 1 + usize::from(hole), "{named}");
                    let area = 0.5 * face.loops.iter().map(TrimLoop::signed_area).sum::<f64>();
                    let wanted = if hole { 100.0 - within } else { within };
                    // sixteen chords a curve are 0.2 % off a circle
                    assert!((area - wanted).abs() < 3e-3 * within + 3.0 * gap.abs(), "{named}: {area}");
                }
            }
        }
    }
}

#[test]
fn a_hole_that_is_a_point_is_reported() {
    let i = import(&[e(PLANE), e("106,1,2,0.,5.,5.,5.,5.;"), e("142,0,1,0,3,2;"), e("144,1,0,1,0,5;")]);
    // the curve itself is refused, and the face with it
    assert_eq!((i.model.face_count(), i.report.dropped.total()), (0, 1), "{:?}", i.warnings);
    let tiny = "126,1,1,0,0,1,0,0.,0.,1.,1.,1.,1.,5.,5.,0.,5.,5.,0.,0.,1.,0.,0.,1.;";
    let i = import(&[e(PLANE), e(tiny), e("142,0,1,0,3,2;"), e("144,1,0,1,0,5;")]);
    assert_eq!((i.model.face_count(), i.report.warnings["loop left out"]), (1, 1), "{:?}", i.warnings);
    let text = "#7: loop left out: face #7: a loop without length, edge #3, was left out";
    assert!(i.warnings.len() == 1 && i.warnings[0].to_string().ends_with(text), "{:?}", i.warnings);
}
