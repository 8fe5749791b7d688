//! Hard cases of trimming as loops in the unit square, for every way to trim.
//!
//! Each has rows `(u, v, winding)` whose answer is known by hand. Coordinates are dyadic or far from every curve, so a
//! row *on* a straight curve has one right answer in single precision, too, by the half-open rules of
//! [`selvedge::trim`]. Numbers are those of the list in the tests of the exact loops,
//! `crates/geometry/tests/trim/hard_*.rs`.

use glam::{DVec2, DVec3};
use selvedge::model::TrimLoop;
use selvedge::spline::{BSpline, Bezier, Control};

#[allow(dead_code)]
#[path = "../../crates/geometry/tests/trim/shapes.rs"]
pub mod loops;
use loops::{at, circle, closed, curve, polygon, rational, rectangle};

/// Loops with known answers.
pub struct TrimCase {
    pub name: &'static str,
    pub loops: Vec<TrimLoop>,
    /// Points and winding numbers.
    pub rows: Vec<(f64, f64, i32)>,
    /// The point for close views.
    pub focus: (f64, f64),
}

fn case(name: &'static str, loops: Vec<TrimLoop>, rows: &[(f64, f64, i32)], focus: (f64, f64)) -> TrimCase {
    TrimCase { name, loops, rows: rows.to_vec(), focus }
}

/// One ulp of single precision up or down.
fn ulp(x: f64, up: bool) -> f64 {
    f64::from(if up { (x as f32).next_up() } else { (x as f32).next_down() })
}

/// Everything scaled by a power of two.
fn small(corners: &[(f64, f64)]) -> TrimLoop {
    polygon(&corners.iter().map(|&(u, v)| (u / 8.0, v / 8.0)).collect::<Vec<_>>())
}

/// All cases.
pub fn all() -> Vec<TrimCase> {
    let mut all = crossings();
    all.extend(rules());
    all.extend(many());
    all.extend(forms());
    all.extend(domains());
    all
}

/// 1 to 4: crossings of the scan line.
fn crossings() -> Vec<TrimCase> {
    let (above, below) = (ulp(0.5, true), ulp(0.5, false));
    let hexagon = small(&[(1.0, 2.0), (5.0, 2.0), (6.0, 4.0), (5.0, 6.0), (1.0, 6.0)]);
    let passed: Vec<_> = [below, 0.5, above]
        .iter()
        .flat_map(|&v| [(0.0625, v, 0), (0.125, v, 1), (0.625, v, 1), (0.875, v, 0)])
        .chain([(0.75, 0.5, 0), (ulp(0.75, false), 0.5, 1), (0.75, above, 0), (0.75, below, 0)])
        .collect();
    let notch = |tip: f64| polygon(&[(0.125, 0.125), (0.875, 0.125), (0.875, 0.875), (0.5, tip), (0.125, 0.875)]);
    let touched = [(0.0625, 0.5, 0), (0.25, 0.5, 1), (0.75, 0.5, 1), (0.875, 0.5, 0), (0.5, 0.75, 0)];
    let steps = [(1., 1.), (2., 1.), (3., 1.), (4., 1.), (4., 3.), (3., 3.), (2., 3.), (2., 5.), (1., 5.)];
    let along = [
        (0.1875, 0.125, 0),
        (0.4375, 0.125, 0),
        (0.1875, ulp(0.125, true), 1),
        (0.375, 0.375, 1),
        (0.5, 0.375, 0),
        (0.25, ulp(0.375, true), 0),
        (0.1875, ulp(0.375, true), 1),
        (0.1875, 0.625, 1),
        (0.1875, ulp(0.625, true), 0),
    ];
    let nearly = polygon(&[(0.125, 0.25), (0.875, 0.25 + 1e-7), (0.875, 0.75), (0.125, 0.75)]);
    let cap = closed(vec![curve(&[(0.75, 0.25), (0.5, 0.75), (0.25, 0.25)]), curve(&[(0.25, 0.25), (0.75, 0.25)])]);
    // v = 1/2 + (2t - 1)³ / 4, a triple root of v = 1/2
    let wave = curve(&[(0.125, 0.25), (0.375, 0.75), (0.625, 0.25), (0.875, 0.75)]);
    let triple = closed(vec![wave, curve(&[(0.875, 0.75), (0.125, 0.75)]), curve(&[(0.125, 0.75), (0.125, 0.25)])]);
    let upright = curve(&[(0.25, 0.125), (0.75, 0.375), (0.25, 0.625), (0.75, 0.875)]);
    let triple_u =
        closed(vec![upright, curve(&[(0.75, 0.875), (0.0625, 0.875)]), curve(&[(0.0625, 0.875), (0.25, 0.125)])]);
    vec![
        case("1 vertex passed", vec![hexagon], &passed, (0.75, 0.5)),
        case("1 vertex touched", vec![notch(0.5)], &touched, (0.5, 0.5)),
        case("1 vertex touched, one ulp below", vec![notch(below)], &touched, (0.5, 0.5)),
        case("1 vertex touched, one ulp above", vec![notch(above)], &touched, (0.5, 0.5)),
        case("2 runs along the scan line", vec![small(&steps)], &along, (0.25, 0.375)),
        case(
            "2 nearly along the scan line",
            vec![nearly],
            &[(0.5, ulp(0.25, false), 0), (0.5, 0.2500005, 1), (0.5, 0.5, 1), (0.0, 0.5, 0)],
            (0.5, 0.25),
        ),
        case(
            "3 extremum of v",
            vec![cap],
            &[
                (0.5, 0.5, 0),
                (0.5, ulp(0.5, true), 0),
                (0.375, 0.5, 0),
                (0.5, 0.499, 1),
                (0.5, 0.25, 0),
                (0.5, 0.375, 1),
            ],
            (0.5, 0.5),
        ),
        case(
            "4 triple root of v",
            vec![triple],
            &[(0.375, 0.5, 1), (0.625, 0.5, 0), (0.48, 0.5, 1), (0.52, 0.5, 0), (0.0625, 0.5, 0), (0.9, 0.5, 0)],
            (0.5, 0.5),
        ),
        case(
            "4 triple root of u",
            vec![triple_u],
            &[(0.499, 0.5, 1), (0.501, 0.5, 0), (0.4, 0.5, 1), (0.74, 0.874, 1), (0.05, 0.5, 0)],
            (0.5, 0.5),
        ),
    ]
}

/// 5 and 6: the rule is a winding number other than zero.
fn rules() -> Vec<TrimCase> {
    let spike = curve(&[(0.25, 0.125), (0.75, 0.625), (0.25, 0.625), (0.75, 0.125)]); // c' = 0 at (0.5, 0.5)
    let cusp = closed(vec![spike, curve(&[(0.75, 0.125), (0.25, 0.125)])]);
    let eight = small(&[(2.0, 2.0), (6.0, 6.0), (6.0, 2.0), (2.0, 6.0)]);
    let star = small(&[(4.0, 7.0), (2.0, 1.0), (7.0, 5.0), (1.0, 5.0), (6.0, 1.0)]);
    let knot = curve(&[(0.25, 0.125), (1.0, 0.625), (-0.25, 0.625), (0.5, 0.125)]);
    let knotted = closed(vec![knot, curve(&[(0.5, 0.125), (0.25, 0.125)])]);
    let square = || rectangle((0.25, 0.25), (0.75, 0.75));
    let ring = || circle(at(0.5, 0.5), 0.25);
    let (a, b) = ((0.28, 0.125), (0.61, 0.875));
    let slanted =
        vec![polygon(&[(0.125, 0.125), a, b, (0.125, 0.875)]), polygon(&[a, (0.875, 0.125), (0.875, 0.875), b])];
    let mut shared: Vec<_> =
        (3..14).map(|k| (0.28 + (f64::from(k) / 16.0 - 0.125) * 0.44, f64::from(k) / 16.0, 1)).collect();
    shared.push((0.2, 0.5, 1));
    let pair = vec![small(&[(1.0, 2.0), (4.0, 4.0), (1.0, 6.0)]), small(&[(4.0, 4.0), (7.0, 2.0), (7.0, 6.0)])];
    let (left, right) = (0.5, 0.5 + 1.87e-6);
    vec![
        case("5 cusp", vec![cusp], &[(0.5, 0.375, -1), (0.5, 0.51, 0), (0.5, 0.499, -1), (0.3, 0.45, 0)], (0.5, 0.5)),
        case(
            "5 figure of eight",
            vec![eight],
            &[
                (0.375, 0.5, 1),
                (0.625, 0.5, -1),
                (0.5, 0.625, 0),
                (0.5, 0.375, 0),
                (ulp(0.5, false), 0.5, 1),
                (0.5, 0.5, -1),
            ],
            (0.5, 0.5),
        ),
        case("5 pentagram", vec![star], &[(0.5, 0.5, 2), (0.5, 0.75, 1), (0.5, 0.2, 0), (0.2, 0.61, 1)], (0.5, 0.625)),
        case(
            "5 a loop inside one cubic",
            vec![knotted],
            &[(0.375, 0.45, 1), (0.375, 0.2, -1), (0.375, 0.7, 0)],
            (0.375, 0.3),
        ),
        case(
            "6 squares that share an edge",
            vec![rectangle((0.25, 0.25), (0.5, 0.75)), rectangle((0.5, 0.25), (0.75, 0.75))],
            &[
                (0.375, 0.5, 1),
                (0.5, 0.5, 1),
                (ulp(0.5, false), 0.5, 1),
                (ulp(0.5, true), 0.5, 1),
                (0.5, 0.75, 1),
                (0.5, 0.25, 0),
            ],
            (0.5, 0.5),
        ),
        case("6 a slanted shared edge", slanted, &shared, (0.445, 0.5)),
        case(
            "6 a shared vertex",
            pair,
            &[(ulp(0.5, false), 0.5, 1), (0.5, 0.5, 1), (0.5, ulp(0.5, true), 0), (0.25, 0.5, 1), (0.75, 0.5, 1)],
            (0.5, 0.5),
        ),
        case(
            "6 nested the wrong way round",
            vec![rectangle((0.125, 0.125), (0.875, 0.875)), square()],
            &[(0.1875, 0.5, 1), (0.5, 0.5, 2), (0.8, 0.5, 1), (0.9, 0.5, 0)],
            (0.75, 0.5),
        ),
        case("6 a duplicate", vec![square(), square()], &[(0.5, 0.5, 2), (0.875, 0.5, 0), (0.25, 0.5, 2)], (0.75, 0.5)),
        case(
            "6 opposites cancel",
            vec![square(), square().reversed(), ring(), ring().reversed()],
            &[(0.5, 0.5, 0), (0.25, 0.5, 0), (0.3, 0.3, 0), (0.6, 0.4, 0)],
            (0.25, 0.5),
        ),
        case(
            "6 sliver",
            vec![rectangle((left, 0.25), (right, 0.75))],
            &[(0.5 + 9e-7, 0.5, 1), (0.5, 0.5, 1), (ulp(0.5, false), 0.5, 0), (0.500003, 0.5, 0), (0.5, 0.25, 0)],
            (0.5, 0.5),
        ),
    ]
}

/// 7: many and thin loops.
fn many() -> Vec<TrimCase> {
    let holes = 24;
    let mut plate = vec![rectangle((0.0, 0.0), (1.0, 1.0))];
    let mut rows = Vec::new();
    for i in 0..holes * holes {
        let (u, v) = (f64::from(i % holes) / 32.0 + 0.125, f64::from(i / holes) / 32.0 + 0.125);
        plate.push(circle(at(u, v), 1.0 / 128.0).reversed());
        rows.extend([(u, v, 0), (u + 1.0 / 64.0, v, 1), (u, v + 1.0 / 64.0, 1), (u + 0.005, v + 0.005, 0)]);
    }
    let slits = [(0.25, 1e-4), (0.5, 1e-5), (0.75, 1e-6)];
    let cut = slits.map(|(v, height)| rectangle((0.25, v), (0.75, v + height)).reversed());
    let slit_rows: Vec<_> = slits
        .iter()
        .flat_map(|&(v, height)| [(0.5, v + 0.5 * height, 0), (0.5, v, 1), (0.5, v + 2.0 * height, 1), (0.8, v, 1)])
        .collect();
    let teeth = 256;
    let mut comb = vec![(0.0, 0.25), (1.0, 0.25)];
    let step = 1.0 / f64::from(2 * teeth);
    for i in (0..teeth).rev() {
        let u = f64::from(2 * i) * step;
        comb.extend([(u + step, 0.25 + step), (u + step, 0.75), (u, 0.75), (u, 0.25 + step)]);
    }
    let comb_rows: Vec<_> = (0..2 * teeth).map(|i| ((f64::from(i) + 0.5) * step, 0.5, 1 - i % 2)).collect();
    vec![
        case("7 holes", plate, &rows, (0.5, 0.5)),
        case(
            "7 slits",
            std::iter::once(rectangle((0.0, 0.0), (1.0, 1.0))).chain(cut).collect(),
            &slit_rows,
            (0.5, 0.5),
        ),
        case("7 comb", vec![polygon(&comb)], &comb_rows, (0.5, 0.5)),
    ]
}

/// Points just inside and outside of a circle of radius 1/4 around the middle, all around.
fn around(winding: i32) -> Vec<(f64, f64, i32)> {
    let ring = |i: i32, radius: f64| {
        let (sin, cos) = f64::from(10 * i).to_radians().sin_cos();
        (0.5 + radius * cos, 0.5 + radius * sin)
    };
    let radii = [(0.125, winding), (0.25 - 4e-6, winding), (0.25 + 4e-6, 0), (0.375, 0)];
    (0..36).flat_map(|i| radii.map(|(radius, w)| (ring(i, radius).0, ring(i, radius).1, w))).collect()
}

/// 8 and 9: degree, weights, degenerate representations.
fn forms() -> Vec<TrimCase> {
    let fifth = 0.2;
    let ring = [(0., -1., 1.), (4., -1., fifth), (2., 3., fifth), (-2., 3., fifth), (-4., -1., fifth), (0., -1., 1.)];
    let quintic = rational(&ring.map(|(x, y, w)| (0.5 + 0.25 * x, 0.5 + 0.25 * y, w)));
    let raise = |c: Bezier<DVec3>| (2..15).fold(c, |c, _| c.elevated());
    let raised: Vec<_> = circle(at(0.5, 0.5), 0.25).curves().map(raise).collect();
    let bend = |mut c: Bezier<DVec3>| {
        c.points[0] *= 1e-3;
        c.points[2] *= 1e3;
        c
    };
    let bent: Vec<_> = circle(at(0.5, 0.5), 0.25).curves().map(bend).collect();
    let bent = TrimLoop::new(bent, DVec2::splat(1e-15)).expect("the shape is closed").reversed();
    let degenerate = closed(vec![
        curve(&[(0.25, 0.25), (0.25, 0.25), (0.75, 0.25), (0.75, 0.25)]),
        curve(&[(0.75, 0.25), (0.75, 0.25)]),
        curve(&[(0.75, 0.25), (0.75, 0.75), (0.75, 0.75)]),
        rational(&[(0.75, 0.75, 1.0), (0.75, 0.75, 0.125), (0.75, 0.75, 8.0)]),
        curve(&[(0.75, 0.75), (0.25, 0.75), (0.25, 0.25)]),
    ]);
    let cubic = |a: (f64, f64), b: (f64, f64)| {
        let along = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
        curve(&[a, along(0.25), along(0.875), b])
    };
    let corners = [(0.5, 0.25), (0.75, 0.5), (0.5, 0.75), (0.25, 0.5)];
    let diamond = closed((0..4).map(|i| cubic(corners[i], corners[(i + 1) % 4])).collect());
    let points = [(0.75, 0.25), (0.75, 0.5), (0.5, 0.625), (0.25, 0.5), (0.25, 0.25)];
    let points = points.map(|(u, v)| DVec3::from_point(at(u, v), 1.0)).to_vec();
    let knots = vec![0.0, 0.0, 0.0, 0.5, 0.5 + 1e-9, 1.0, 1.0, 1.0];
    let spline = BSpline::new(2, knots, points).expect("a B-spline");
    let mut spans: Vec<_> = spline.beziers().into_iter().map(|s| s.piece).collect();
    spans.push(curve(&[(0.25, 0.25), (0.75, 0.25)]));
    vec![
        case("8 circle of degree five", vec![closed(vec![quintic])], &around(1), (0.75, 0.5)),
        case("8 circle of degree fifteen", vec![closed(raised)], &around(1), (0.75, 0.5)),
        case("8 weight ratio of a million", vec![bent], &around(-1), (0.5, 0.75)),
        case(
            "9 zero lengths and repeated control points",
            vec![degenerate],
            &[(0.5, 0.5, 1), (0.5, 0.25, 0), (0.3125, 0.3125, 1), (0.3125, 0.6875, 0), (0.625, 0.734375, 1)],
            (0.75, 0.75),
        ),
        case(
            "9 lines stored as cubics",
            vec![diamond],
            &[
                (0.5, 0.5, 1),
                (ulp(0.375, false), 0.375, 0),
                (0.375, 0.375, 1),
                (0.625, 0.375, 0),
                (ulp(0.625, false), 0.375, 1),
            ],
            (0.625, 0.375),
        ),
        case(
            "9 knot span of a billionth",
            vec![closed(spans)],
            &[(0.5, 0.5, 1), (0.5, 0.64, 0), (0.5, 0.3, 1)],
            (0.5, 0.58),
        ),
    ]
}

/// 10 to 12: gaps, borders, seams.
fn domains() -> Vec<TrimCase> {
    let corners = [(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)];
    let sides = (0..4).map(|i| curve(&[(corners[i].0, corners[i].1 + 1e-6), corners[(i + 1) % 4]]));
    let gappy = TrimLoop::new(sides.collect(), DVec2::splat(1e-5)).expect("within the snap");
    let outer = || rectangle((0.125, 0.125), (0.875, 0.875));
    let hole = || circle(at(0.5, 0.5), 0.125);
    let first = |w: i32| [(0.1875, 0.5, w), (0.5, 0.5, 0), (0.8125, 0.5, w), (0.9375, 0.5, 0)];
    let seam = vec![
        rectangle((0.0, 0.0), (1.0, 1.0)),
        rectangle((0.0, 0.25), (0.125, 0.75)).reversed(),
        rectangle((0.875, 0.25), (1.0, 0.75)).reversed(),
    ];
    vec![
        case("10 gaps snapped", vec![gappy], &[(0.5, 0.5, 1), (0.125, 0.2500005, 0), (0.875, 0.75, 0)], (0.25, 0.25)),
        case("10 outer loop not first", vec![hole().reversed(), outer()], &first(1), (0.625, 0.5)),
        case("10 all the wrong way round", vec![outer().reversed(), hole()], &first(-1), (0.625, 0.5)),
        case(
            "10 leaving the domain",
            vec![rectangle((-0.5, 0.25), (0.5, 1.5))],
            &[(0.25, 0.5, 1), (0.0, 0.5, 1), (0.25, 0.25, 0), (0.25, 1.0, 1), (0.75, 0.5, 0)],
            (0.5, 0.5),
        ),
        case(
            "10 no extent",
            vec![outer(), polygon(&[(0.25, 0.25), (0.75, 0.75)])],
            &[(0.5, 0.5, 1), (0.9, 0.5, 0)],
            (0.5, 0.5),
        ),
        case(
            "11 hole across a seam",
            seam,
            &[(0.0, 0.5, 0), (0.0625, 0.5, 0), (0.125, 0.5, 1), (0.875, 0.5, 0), (0.0, 0.25, 1), (0.0, 0.75, 0)],
            (0.125, 0.75),
        ),
        case(
            "12 border of the domain",
            vec![rectangle((0.0, 0.0), (1.0, 1.0))],
            &[
                (0.5, 0.5, 1),
                (0.0, 0.5, 1),
                (1.0, 0.5, 0),
                (ulp(1.0, false), 0.5, 1),
                (0.5, 0.0, 0),
                (0.5, 1.0, 1),
                (1.0000002, 0.5, 0),
            ],
            (0.5, 0.5),
        ),
        case(
            "12 points on a slanted line",
            vec![small(&[(1.0, 1.0), (7.0, 1.0), (1.0, 4.0)])],
            &[
                (0.25, 0.25, 1),
                (0.5, 0.3125, 0),
                (ulp(0.5, false), 0.3125, 1),
                (0.625, 0.25, 0),
                (ulp(0.625, false), 0.25, 1),
            ],
            (0.5, 0.3125),
        ),
    ]
}
