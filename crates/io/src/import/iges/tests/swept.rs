//! Swept solids: points inside and outside, by dimensions worked out by hand.

use super::solids::{Probe, holds};
use super::{Entity, e, import};
use std::f64::consts::FRAC_1_SQRT_2;

/// In the plane z = 0: a square from (2, 0) to (4, 2).
fn square() -> Entity {
    Entity { form: 63, ..e("106,1,4,0.,2.,0.,4.,0.,4.,2.,2.,2.;") }
}

/// The solid `swept` of the curve, as the only operand of a tree.
fn check(curve: Entity, swept: Entity, points: &[Probe]) {
    holds(&import(&[curve, swept, e("180,1,-3;"), e("124,-1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.;")]), points);
}

/// The tracer rounds control points to single precision.
const E: f64 = 1e-5;

#[test]
fn extrusions() {
    let points = [
        ([2.0 + E, 1.0, 1.5], true),
        ([2.0 - E, 1.0, 1.5], false),
        ([4.0 - E, 2.0 - E, 3.0 - E], true),
        ([2.2, 0.3, E], true),
        ([2.2, 0.3, -E], false),
        ([2.2, 0.3, 3.0 + E], false),
    ];
    check(square(), e("164,1,3.;"), &points);
    check(square(), e("164,1,3.,0.,0.,-7.;"), &points.map(|([x, y, z], inside)| ([x, y, -z], inside)));
    // mirrored by the matrix
    let mirrored = points.map(|([x, y, z], inside)| ([-x, y, z], inside));
    check(square(), Entity { matrix: 7, ..e("164,1,3.;") }, &mirrored);
    // a circle, leaning by 45 degrees: 1 along x at a height of 1
    let lean = format!("164,1,{},1.,0.,1.;", 2.0 / FRAC_1_SQRT_2);
    let points = [([3.0 - E, 0.0, 1.0], true), ([3.0 + E, 0.0, 1.0], false), ([-0.5, 0.0, 1.0], false)];
    check(e("100,0.,1.,0.,2.,0.,2.,0.;"), e(&lean), &points);
}

#[test]
fn revolutions() {
    let closed = |parameters: &str| Entity { form: 1, ..e(parameters) };
    // about y: a square ring
    let ring = [([0.0, 1.0, 2.0 + E], true), ([0.0, 1.0, 2.0 - E], false), ([-4.0 + E, 1.0, 0.0], true)];
    for whole in ["162,1,1.,0.,0.,0.,0.,1.,0.;", "162,1,,0.,0.,0.,0.,1.,0.;"] {
        check(square(), closed(whole), &ring);
    }
    // a quarter takes x to -z; mirrored, -x to -z
    let quarter = |x: f64| {
        [
            ([x * 2.2, 0.3, -E], true),
            ([x * 2.2, 0.3, E], false),
            ([x * E, 0.3, -2.2], true),
            ([-x * E, 0.3, -2.2], false),
            ([x * 3.0 * FRAC_1_SQRT_2, 1.0, -3.0 * FRAC_1_SQRT_2], true),
        ]
    };
    check(square(), closed("162,1,.25,0.,0.,0.,0.,1.,0.;"), &quarter(1.0));
    check(square(), Entity { matrix: 7, ..closed("162,1,.25,0.,0.,0.,0.,1.,0.;") }, &quarter(-1.0));
    // closed by the axis: a line makes a frustum of radii 2 and 1, half a circle a ball
    let line = || e("110,2.,0.,0.,1.,3.,0.;");
    let frustum = [([0.0, 1.5, 1.5 - E], true), ([0.0, 1.5, 1.5 + E], false), ([0.5, 3.0 - E, 0.0], true)];
    check(line(), e("162,1,1.,0.,0.,0.,0.,1.,0.;"), &frustum);
    let half = [([0.0, 1.5, -1.5 + E], true), ([0.0, 1.5, -1.5 - E], false), ([0.0, 1.0, E], false)];
    check(line(), e("162,1,.5,0.,0.,0.,0.,1.,0.;"), &half);
    let ball = [([0.0, 0.0, 2.0 - E], true), ([0.0, 2.0 - E, 0.0], true), ([-1.2, 1.2, 1.2], false)];
    check(e("100,0.,0.,0.,0.,-2.,0.,2.;"), e("162,1,1.,0.,0.,0.,0.,1.,0.;"), &ball);
}

/// By itself it is a part of faces, in its own colour; an instance places it.
#[test]
fn a_swept_solid_is_a_closed_part() {
    let red = Entity { colour: 2, ..e("164,1,3.;") };
    let i =
        import(&[square(), red, Entity { matrix: 7, ..e("430,3;") }, e("124,1.,0.,0.,9.,0.,1.,0.,0.,0.,0.,1.,0.;")]);
    assert!(i.warnings.is_empty() && i.model.solids.is_empty(), "{:?}", i.warnings);
    assert_eq!((i.model.parts.len(), i.model.parts[0].faces.len(), i.model.parts[0].closed), (1, 6, true));
    let bounds = i.model.bounds();
    assert!((bounds.min.x - 11.0).abs() < 1e-12 && (bounds.max.x - 13.0).abs() < 1e-12, "{bounds:?}");
    let alone = import(&[square(), Entity { colour: 2, ..e("164,1,3.;") }]);
    assert!(alone.model.parts[0].faces.iter().all(|f| f.colour == Some([1.0, 0.0, 0.0, 1.0])));
}

#[test]
fn impossible_sweeps_are_reported() {
    let open = || e("106,1,3,0.,2.,0.,4.,0.,4.,2.;");
    let cases = [
        (open(), e("164,1,3.;"), "the curve that is swept is not closed"),
        (square(), e("164,1,0.;"), "parameter 2 is not a length above 0"),
        (square(), e("164,1,3.,1.,0.,0.;"), "what is swept moves within its own plane"),
        (
            Entity { form: 63, ..e("106,2,4,2.,0.,0.,4.,0.,0.,4.,2.,.1,2.,2.,0.;") },
            e("164,1,3.;"),
            "the curve that is swept is not plane",
        ),
        (e("110,2.,0.,0.,4.,0.,0.;"), e("162,1,1.,0.,0.,0.,1.,0.,0.;"), "the curve that is swept bounds no area"),
        (square(), e("162,1,1.5,0.,0.,0.,0.,1.,0.;"), "parameter 2 is not a share of a turn, above 0 and at most 1"),
        (square(), e("162,1,1.,3.,0.,0.,0.,1.,0.;"), "the axis crosses what turns"),
        // which shows at no vertex
        (e("100,0.,0.,0.,2.,0.,2.,0.;"), e("162,1,1.,0.,0.,0.,0.,1.,0.;"), "the axis crosses what turns"),
        (square(), e("162,1,1.,0.,0.,0.,0.,1.,1.;"), "the axis does not lie in the plane of what turns"),
        (open(), Entity { form: 1, ..e("162,1,1.,0.,0.,0.,0.,1.,0.;") }, "the curve that is swept is not closed"),
        (e("102,0;"), e("164,1,3.;"), "a composite without curves"),
    ];
    for (curve, swept, why) in cases {
        let words = (curve.parameters.clone(), swept.parameters.clone());
        let i = import(&[curve, swept]);
        let told: Vec<String> = i.warnings.iter().map(ToString::to_string).collect();
        assert!(
            told.len() == 1 && told[0].contains("#3: body left out: #") && told[0].ends_with(why),
            "{words:?}: {told:?}"
        );
        assert_eq!(i.summary().left_out.len(), 1, "{words:?}");
    }
    // lines of a composite that do not meet
    let i = import(&[e("110,2.,0.,0.,4.,0.,0.;"), e("110,4.,.1,0.,2.,2.,0.;"), e("102,2,1,3;"), e("164,5,3.;")]);
    assert!(i.warnings[0].to_string().ends_with("#7: the curve that is swept is torn"), "{:?}", i.warnings);
}
