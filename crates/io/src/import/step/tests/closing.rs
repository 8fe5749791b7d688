//! Loops of one curve whose ends nearly meet, through every entity that states a loop.

use super::import;
use crate::import::Import;
use crate::model::TrimLoop;
use crate::spline::BSpline;
use glam::{DVec2, DVec4};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const RADIUS: f64 = 3.0;

/// Curves that close by themselves.
const KINDS: [&str; 8] = ["circle", "arc", "arc by points", "ellipse", "clamped", "unclamped", "uniform", "polyline"];

/// What the curve bounds: with a stated outer border, within the surface's own, alone; of a face, likewise.
const OWNERS: [&str; 5] = ["hole", "hole of the surface", "border", "hole of a face", "border of a face"];

/// A square of 10 mm whose parameters are shares of its sides, and a frame in its middle.
const SQUARE: &str = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));\
    #11=CARTESIAN_POINT('',(0.,0.,0.));#12=CARTESIAN_POINT('',(10.,0.,0.));#13=CARTESIAN_POINT('',(0.,10.,0.));\
    #14=CARTESIAN_POINT('',(10.,10.,0.));#15=CARTESIAN_POINT('',(5.,5.,0.));#16=AXIS2_PLACEMENT_3D('',#15,$,$);\
    #20=BEZIER_SURFACE('',1,1,((#11,#13),(#12,#14)),.U.,.F.,.F.,.F.);#31=SHAPE_REPRESENTATION('',(#30),#1);";

/// A closed curve `#100` about the middle, its ends, and the area within, mm².
struct Ring {
    text: String,
    ends: [DVec2; 2],
    area: f64,
}

fn point(id: usize, p: DVec2) -> String {
    format!("#{id}=CARTESIAN_POINT('',({:.17},{:.17},0.));", p.x, p.y)
}

/// The last point is `gap` mm from the first: before or behind it on a conic, towards `aside` on others.
fn ring(kind: &str, gap: f64, aside: f64) -> Ring {
    let at = |a: f64, y: f64| DVec2::new(5.0 + RADIUS * a.cos(), 5.0 + y * RADIUS * a.sin());
    let turn = 0.7 + gap / RADIUS * aside.signum();
    let trimmed = |conic: &str, by: String, y: f64| Ring {
        text: format!("#101={conic};#100=TRIMMED_CURVE('',#101,{by});"),
        ends: [at(0.7, y), at(turn, y)],
        area: PI * RADIUS * RADIUS * y,
    };
    let angles = || format!("(PARAMETER_VALUE(0.7)),(PARAMETER_VALUE({turn:.17})),.T.,.PARAMETER.");
    let spline = |degree: usize, knots: Vec<f64>, count: usize, share: f64, entity: &dyn Fn(String) -> String| {
        let mut points: Vec<DVec2> = (0..count).map(|i| at(TAU * (i % 12) as f64 / 12.0, 1.0)).collect();
        points[count - 1] += DVec2::from_angle(aside) * (gap / share);
        let names: Vec<String> = (200..200 + count).map(|id| format!("#{id}")).collect();
        let stated: String = points.iter().enumerate().map(|(i, p)| point(200 + i, *p)).collect();
        let net = points.iter().map(|p| DVec4::new(p.x, p.y, 0.0, 1.0)).collect();
        let curve = BSpline::new(degree, knots, net).unwrap();
        let (a, b) = curve.domain();
        let on = |share: f64| curve.point(a + (b - a) * share).truncate();
        let steps = 6000;
        let middle = DVec2::splat(5.0);
        let chord = |i: i32| [i, i + 1].map(|k| on(f64::from(k) / f64::from(steps)) - middle);
        let area = (0..steps).map(chord).map(|[p, q]| 0.5 * p.perp_dot(q)).sum();
        Ring { text: format!("{stated}#100={};", entity(names.join(","))), ends: [on(0.0), on(1.0)], area }
    };
    let uniform = || (0..19).map(f64::from).collect();
    match kind {
        "circle" => Ring { text: "#100=CIRCLE('',#16,3.);".into(), ..trimmed("", String::new(), 1.0) },
        "arc" => trimmed("CIRCLE('',#16,3.)", angles(), 1.0),
        "arc by points" => {
            let ring = trimmed("CIRCLE('',#16,3.)", "(#102),(#103),.T.,.CARTESIAN.".into(), 1.0);
            Ring { text: [ring.text, point(102, ring.ends[0]), point(103, ring.ends[1])].concat(), ..ring }
        }
        "ellipse" => trimmed("ELLIPSE('',#16,3.,1.5)", angles(), 0.5),
        "clamped" => {
            let knots = [0.0; 3].into_iter().chain((0..=10).map(f64::from)).chain([10.0; 3]).collect();
            spline(3, knots, 13, 1.0, &|points| {
                let (counts, knots) = ("4,1,1,1,1,1,1,1,1,1,4", "0.,1.,2.,3.,4.,5.,6.,7.,8.,9.,10.");
                format!("B_SPLINE_CURVE_WITH_KNOTS('',3,({points}),.UNSPECIFIED.,.T.,.F.,({counts}),({knots}),$)")
            })
        }
        "unclamped" => spline(3, uniform(), 15, 1.0 / 6.0, &|points| {
            let counts = ["1"; 19].join(",");
            let knots: Vec<String> = (0..19).map(|k| format!("{k}.")).collect();
            let knots = knots.join(",");
            format!("B_SPLINE_CURVE_WITH_KNOTS('',3,({points}),.UNSPECIFIED.,.T.,.F.,({counts}),({knots}),$)")
        }),
        "uniform" => spline(3, uniform(), 15, 1.0 / 6.0, &|points| {
            format!("UNIFORM_CURVE('',3,({points}),.UNSPECIFIED.,.T.,.F.)")
        }),
        _ => {
            let knots = [0.0].into_iter().chain((0..=12).map(f64::from)).chain([12.0]).collect();
            spline(1, knots, 13, 1.0, &|points| format!("POLYLINE('',({points}))"))
        }
    }
}

/// The file of what the curve bounds; how many loops it has, and its area, mm².
fn read(ring: &Ring, owner: &str, sense: &str) -> (Import, usize, f64) {
    let [start, end] = ring.ends;
    let bounds = format!(
        "#50=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,{sense},#100);#51=BOUNDARY_CURVE('',(#50),.U.);\
         #52=POLYLINE('',(#11,#12,#14,#13,#11));#53=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#52);\
         #54=BOUNDARY_CURVE('',(#53),.U.);#30=GEOMETRIC_SET('',(#21));"
    );
    let face = format!(
        "{}{}#60=VERTEX_POINT('',#61);#62=VERTEX_POINT('',#63);#64=EDGE_CURVE('',#60,#62,#100,.T.);\
         #65=ORIENTED_EDGE('',*,*,#64,{sense});#66=EDGE_LOOP('',(#65));#67=FACE_BOUND('',#66,.T.);\
         #68=POLY_LOOP('',(#11,#12,#14,#13));#69=FACE_OUTER_BOUND('',#68,.T.);#30=OPEN_SHELL('',(#21));",
        point(61, start),
        point(63, end)
    );
    let (with, item, hole) = match owner {
        "hole" => (bounds, "CURVE_BOUNDED_SURFACE('',#20,(#54,#51),.F.)", true),
        "hole of the surface" => (bounds, "CURVE_BOUNDED_SURFACE('',#20,(#51),.T.)", true),
        "border" => (bounds, "CURVE_BOUNDED_SURFACE('',#20,(#51),.F.)", false),
        "hole of a face" => (face, "FACE_SURFACE('',(#69,#67),#20,.T.)", true),
        _ => (face, "FACE_SURFACE('',(#67),#20,.T.)", false),
    };
    let found = import(&format!("{SQUARE}{}{with}#21={item};", ring.text));
    let area = if hole { 100.0 - ring.area } else { ring.area };
    (found, 1 + usize::from(hole), area)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_loop_of_one_curve_is_there_whatever_its_gap(
        kind in prop::sample::select(KINDS.to_vec()),
        owner in prop::sample::select(OWNERS.to_vec()),
        sense in prop::sample::select(vec![".T.", ".F."]),
        exponent in -16.0..-3.0f64,
        aside in -PI..PI,
    ) {
        let gap = 10f64.powf(exponent);
        let ring = ring(kind, gap, aside);
        let (found, loops, wanted) = read(&ring, owner, sense);
        let told: Vec<_> = found.warnings.iter().map(ToString::to_string).collect();
        prop_assert_eq!(found.model.face_count(), 1, "{:?}", told);
        prop_assert!(!found.report.warnings.contains_key("loop left out"), "{:?}", told);
        let face = &found.model.parts[0].faces[0];
        prop_assert_eq!(face.loops.len(), loops, "{:?}", told);
        let area = 50.0 * face.loops.iter().map(TrimLoop::signed_area).sum::<f64>();
        // sixteen chords a curve are 0.2 % off a circle
        prop_assert!((area - wanted).abs() < 3e-3 * ring.area + RADIUS * gap, "{}, not {}: {:?}", area, wanted, told);
    }
}

/// Ends half a radius apart make no loop: nothing is filled or left out without a word.
#[test]
fn a_wide_gap_is_reported() {
    for kind in ["arc", "clamped", "unclamped", "polyline"] {
        for owner in OWNERS {
            let (found, ..) = read(&ring(kind, 0.5 * RADIUS, 2.0), owner, ".T.");
            assert!(!found.warnings.is_empty(), "{kind}, {owner}: {:?}", found.model.parts);
        }
    }
}
