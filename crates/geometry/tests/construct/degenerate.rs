//! Every construction refuses degenerate input, with words that name the fault.

use crate::{line, planar};
use glam::{DVec2, DVec3, DVec4};
use selvedge_geometry::construct::curve::{self, CurveEnds, Parameters};
use selvedge_geometry::construct::fit::{Equation, FitOptions, fit};
use selvedge_geometry::construct::grid::{
    HeightField, PointGrid, approximate, height_field, interpolate, interpolate_at,
};
use selvedge_geometry::construct::polyloop::PolyLoop;
use selvedge_geometry::construct::shapes::{self, GearBlank, SpurGear};
use selvedge_geometry::construct::subdivide::{ControlMesh, Scheme, limits, subdivide};
use selvedge_geometry::construct::{
    Boundary, Chain, ConstructError, Network, Sweep, capped_solid, coons, extrude, extruded_solid, gordon, lathe,
    lathed_solid, loft, offset, project, ruled, trim_loops, tube,
};
use selvedge_geometry::spline::{BSpline, Surface};
use std::f64::consts::TAU;

const NAN: f64 = f64::NAN;

/// The name of a case, its result, and words of its refusal; `""` where it must succeed.
type Row = (&'static str, Result<(), ConstructError>, &'static str);

fn row<T>(name: &'static str, made: Result<T, impl Into<ConstructError>>, words: &'static str) -> Row {
    (name, made.map(drop).map_err(Into::into), words)
}

fn judge(rows: &[Row]) {
    for (name, made, words) in rows {
        match made {
            Ok(()) => assert!(words.is_empty(), "{name} was made"),
            Err(e) => {
                let message = e.to_string();
                assert!(!words.is_empty() && message.contains(words), "{name}: `{message}` should say `{words}`");
            }
        }
    }
}

/// A closed polyline in the plane.
fn chain(points: &[(f64, f64)]) -> Chain {
    vec![planar(&[points, &points[..1]].concat())]
}

const BOW: [(f64, f64); 4] = [(1.0, 0.0), (2.0, 1.0), (2.0, 0.0), (1.0, 1.0)];
const LOPSIDED_BOW: [(f64, f64); 4] = [(1.0, 0.0), (2.0, 1.0), (2.0, 0.0), (1.0, 3.0)];
const SQUARE: [(f64, f64); 4] = [(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0)];

/// The wall of a prism over a closed polygon.
fn wall(points: &[(f64, f64)]) -> Surface {
    let around: Vec<DVec3> = points.iter().chain(&points[..1]).map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
    extrude(&line(&around), DVec3::Z).unwrap()
}

fn flat() -> Surface {
    extrude(&line(&[DVec3::NEG_ONE, DVec3::new(1.0, -1.0, -1.0)]), DVec3::Y * 2.0).unwrap()
}

fn hill() -> Surface {
    let net = (0..9).map(|i| DVec3::new((i % 3) as f64, (i / 3) as f64, if i == 4 { 1.0 } else { 0.0 }).extend(1.0));
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    Surface::new((2, 2), knots.clone(), knots, net.collect()).unwrap()
}

/// Every construction takes its curves as splines, which hold no NaN.
#[test]
fn no_spline_holds_a_number_that_is_none() {
    let curve = |p: DVec4| BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec4::W, p]);
    let flat = |p: DVec3| BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec3::Z, p]);
    let net = |p: DVec4| {
        Surface::new((1, 1), vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], vec![p, DVec4::W, DVec4::W, DVec4::W])
    };
    judge(&[
        row("a NaN in a curve", curve(DVec4::new(NAN, 0.0, 0.0, 1.0)), "control point 1 has a coordinate that is not"),
        row("an infinite weight", curve(DVec4::new(1.0, 0.0, 0.0, f64::INFINITY)), "control point 1"),
        row("a weight of 0", curve(DVec4::X), "control point 1"),
        row("a NaN in a planar curve", flat(DVec3::new(0.0, NAN, 1.0)), "control point 1"),
        row("a NaN in a net", net(DVec4::new(0.0, 0.0, NAN, 1.0)), "control point 0"),
        row("a NaN in a knot", BSpline::new(1, vec![0.0, 0.0, NAN, 1.0], vec![DVec4::W; 2]), "knot 2"),
        row("no domain", BSpline::new(1, vec![0.0; 4], vec![DVec4::W; 2]), "the parameter domain is empty"),
    ]);
}

#[test]
fn curves() {
    let (o, x, y) = (DVec3::ZERO, DVec3::X, DVec3::Y);
    let through = |p: &[DVec3], ends| curve::interpolate(p, &Parameters::ChordLength, ends);
    let given = |t: Vec<f64>| curve::interpolate(&[o, x, y], &Parameters::Given(t), CurveEnds::Natural);
    judge(&[
        row("a line to itself", curve::line(x, x), "the line has no length"),
        row("a line to nowhere", curve::line(o, x * NAN), "the line's end is not a finite number"),
        row("an arc of no angle", curve::ellipse(o, x, y, 1.0, 1.0), "the angle of the arc is 0"),
        row("an arc of a NaN", curve::ellipse(o, x, y, 0.0, NAN), "the angle of the arc is NaN"),
        row("an ellipse on a line", curve::ellipse(o, x, -x, 0.0, 1.0), "on one line"),
        row("an ellipse about nowhere", curve::ellipse(x * NAN, x, y, 0.0, 1.0), "the centre is not a finite"),
        row("a circle of radius 0", curve::circle(o, DVec3::Z, x, 0.0, TAU), "the radius is 0"),
        row("a circle without an axis", curve::circle(o, o, x, 1.0, TAU), "the axis has no length"),
        row("a circle that starts on its axis", curve::circle(o, x, x, 1.0, TAU), "the start, seen along the axis,"),
        row("a circle of radius NaN", curve::circle(o, DVec3::Z, x, NAN, TAU), "the radius is NaN"),
        row("half a parabola", curve::parabola(o, o, y, 0.0, 1.0), "the parabola's axis or tangent"),
        row("a parabola of a NaN", curve::parabola(o, x, y, NAN, 1.0), "the range of the parabola is NaN"),
        row("a hyperbola too far", curve::hyperbola(o, x, y, 0.0, 301.0), "the range of the hyperbola is 301"),
        row("a hyperbola on a line", curve::hyperbola(o, x, x, 0.0, 1.0), "the hyperbola's axis or tangent"),
        row("a chain that does not fit", curve::chain(3, vec![DVec4::W; 6]), "6 control points, but 4 are needed"),
        row("points that coincide", through(&[o, x, x, y], CurveEnds::Natural), "points 1 and 2 coincide"),
        row("a loop whose ends coincide", through(&[o, x, y, o], CurveEnds::Closed), "points 3 and 4 coincide"),
        row("a point that is none", through(&[o, x * NAN], CurveEnds::Natural), "a point is not a finite number"),
        row("one point", through(&[o], CurveEnds::Natural), "1 points, but at least 2"),
        row("a slope that is none", through(&[o, x], CurveEnds::Clamped(x, x * NAN)), "the last end's derivative"),
        row("parameters that stand", given(vec![0.0, 1.0, 1.0]), "parameter 2 is not larger"),
        row("a parameter that is none", given(vec![0.0, NAN, 1.0]), "parameter 1 is not larger"),
    ]);
}

#[test]
fn polyloops() {
    let p = |v: &[(f64, f64)]| PolyLoop::new(v.iter().map(|&(x, y)| DVec2::new(x, y)).collect());
    let square = p(&SQUARE).unwrap();
    judge(&[
        row("two vertices", p(&SQUARE[..2]), "2 vertices, but at least 3"),
        row("vertices that coincide", p(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0)]), "points 1 and 2 coincide"),
        row("the last on the first", p(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]), "points 3 and 0 coincide"),
        row("a vertex that is none", p(&[(0.0, 0.0), (1.0, NAN), (1.0, 1.0)]), "a vertex is not a finite number"),
        row("a tension of NaN", square.interpolating(NAN), "tension"),
        row("a four-point tension of NaN", square.four_points(NAN, 2), "tension"),
        row("40 rounds", square.cut_corners(40), "but at most"),
        row("a bow", p(&BOW), ""), // a curve may cross itself
    ]);
}

#[test]
fn surfaces_from_curves() {
    let o = DVec3::ZERO;
    let a = line(&[o, DVec3::X]);
    let point = line(&[o, o]);
    let up = |z: f64| line(&[DVec3::Z * z, DVec3::X + DVec3::Z * z]);
    let square = planar(&[(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1)]);
    let straight = line(&[o, DVec3::Z]);
    let sweep = Sweep::new(&square, &straight, 1e-3);
    let planar_point = planar(&[(1.0, 1.0), (1.0, 1.0)]);
    let cornered = line(&[o, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
    // beyond the circle's centre wherever its x points, or the other way
    let far = planar(&[(-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5), (-1.5, -1.5)]);
    let arc = curve::circle(o, DVec3::Z, DVec3::X, 1.0, 3.0).unwrap();
    let four = |bottom, top, left, right, tolerance| coons(Boundary { bottom, top, left, right }, tolerance);
    let (bottom, top) = (line(&[o, DVec3::X]), line(&[DVec3::Y, DVec3::X + DVec3::Y]));
    let (left, right) = (line(&[o, DVec3::Y]), line(&[DVec3::X, DVec3::X + DVec3::Y]));
    let (here, there) = (line(&[o, o]), line(&[DVec3::X, DVec3::X]));
    let both = [bottom.clone(), bottom.clone()];
    let ends = [here.clone(), there.clone()];
    let at = [0.0, 1.0];
    let network = |tolerance| gordon(Network { u_curves: &both, v_curves: &ends, u: &at, v: &at }, tolerance);
    let axis = planar(&[(0.0, 0.0), (0.0, 1.0)]);
    judge(&[
        row("an extrusion by nothing", extrude(&a, o), "the direction of an extrusion has no length"),
        row("an extrusion along itself", extrude(&a, DVec3::X), "the profile across the direction"),
        row("an extruded point", extrude(&point, DVec3::Z), "the profile across the direction"),
        row("an extrusion by a NaN", extrude(&a, DVec3::NAN), "the direction of an extrusion is not a finite"),
        row("a lathe of a NaN", lathe(&square, NAN), "the angle of a lathe is NaN"),
        row("a lathe across its axis", lathe(&square, TAU), "the profile crosses the axis"),
        row("a lathe of its axis", lathe(&axis, TAU), "the profile lies on the axis"),
        row("a sweep along nothing", Sweep { path: &point, ..sweep }.build(), "the path has no length"),
        row("a sweep of a point", Sweep { profile: &planar_point, ..sweep }.build(), "the profile has no length"),
        row("a sweep round a corner", Sweep { path: &cornered, ..sweep }.build(), "the path has a corner at 0.5"),
        row("a sweep that folds", Sweep { path: &arc, scale: (20.0, 20.0), ..sweep }.build(), "the surface folds"),
        row("a sweep beyond a centre", Sweep { path: &arc, profile: &far, ..sweep }.build(), "the surface folds"),
        row("a sweep turned by a NaN", Sweep { twist: NAN, ..sweep }.build(), "the twist of a sweep is not"),
        row("a sweep scaled by a NaN", Sweep { scale: (1.0, NAN), ..sweep }.build(), "a scale of a sweep is NaN"),
        row(
            "a sweep that looks nowhere",
            Sweep { up: Some(DVec3::NAN), ..sweep }.build(),
            "the direction of the profile",
        ),
        row("a sweep without a bound", Sweep { tolerance: NAN, ..sweep }.build(), "the tolerance is NaN"),
        row("a tube along nothing", tube(&point, 1.0, 1e-3), "the path has no length"),
        row("a tube of radius NaN", tube(&straight, NAN, 1e-3), "the radius of a tube is NaN"),
        row("a tube as wide as its bend", tube(&arc, 1.0, 1e-3), "the surface folds"),
        row("a tube round a corner", tube(&cornered, 0.1, 1e-3), "the path has a corner"),
        row("between one curve", ruled(&a, &a), "sections 0 and 1 coincide"),
        row("between one point", ruled(&point, &point), "sections 0 and 1 coincide"),
        row("a loft of the same", loft(&[up(0.0), up(1.0), up(1.0), up(2.0)], false), "sections 1 and 2 coincide"),
        row("a loft back to its start", loft(&[up(0.0), up(1.0), up(2.0), up(0.0)], true), "sections 3 and 0 coincide"),
        row("a loft of one", loft(&[up(0.0)], false), "1 sections, but at least 2"),
        row("corners apart", four(&bottom, &top, &left, &left, 1e-6), "1e0 apart at corner 1"),
        row("corners within a NaN", four(&bottom, &top, &left, &right, NAN), "the tolerance is NaN"),
        row("nothing between one curve", four(&bottom, &bottom, &here, &there, 1e-9), "sections 0 and 1 coincide"),
        row("nothing between one point", four(&here, &here, &here, &here, 1e-9), "sections 0 and 1 coincide"),
        row("a triangle", four(&here, &top, &left, &line(&[o, DVec3::X + DVec3::Y]), 1e-9), ""),
        row("a network of one curve", network(1e-9), "sections 0 and 1 coincide"),
        row("a network within a NaN", network(NAN), "the tolerance is NaN"),
    ]);
}

#[test]
fn surfaces_from_surfaces() {
    let at = |x: f64| curve::circle(DVec3::new(x, 0.0, 3.0), DVec3::Z, DVec3::X, 0.3, TAU).unwrap();
    let cast = |along, tolerance| project(&flat(), &[at(0.0)], along, tolerance);
    let roof = extrude(&line(&[DVec3::ZERO, DVec3::ONE, DVec3::X * 2.0]), DVec3::Y).unwrap();
    let collapsed = Surface::new(
        (1, 1),
        vec![0.0, 0.0, 1.0, 1.0],
        vec![0.0, 0.0, 1.0, 1.0],
        [DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::X].map(|p| p.extend(1.0)).to_vec(),
    );
    judge(&[
        row("an offset by a NaN", offset(&hill(), NAN, 1e-3), "the distance of an offset is not a finite"),
        row("an offset within a NaN", offset(&hill(), 0.1, NAN), "the tolerance is NaN"),
        row("an offset of a roof", offset(&roof, 0.1, 1e-3), "has a corner at 1"),
        row("an offset that folds", offset(&hill(), -50.0, 1e-3), "folds at"),
        row("an offset of a line", offset(&collapsed.unwrap(), 0.1, 1e-3), "has no normal at"),
        row("an outline of nothing", project(&flat(), &[], DVec3::Z, 1e-3), "0 curves of an outline"),
        row("an outline beside it", project(&flat(), &[at(9.0)], DVec3::NEG_Z, 1e-3), "misses the surface"),
        row("an outline cast nowhere", cast(DVec3::ZERO, 1e-3), "the direction of a projection has no length"),
        row("an outline cast by a NaN", cast(DVec3::NAN, 1e-3), "the direction of a projection is not a finite"),
        row("an outline within a NaN", cast(DVec3::NEG_Z, NAN), "the tolerance is NaN"),
    ]);
}

#[test]
fn equations() {
    let square = ((0.0, 1.0), (0.0, 1.0));
    let run = |f: fn(f64, f64) -> DVec3, tolerance| fit(f, square.0, square.1, &FitOptions::new(tolerance));
    let parse = |x: &str| Equation::parse([x, "v", "0"], &[("r", 1.0)]);
    let plane = |u: f64, v: f64| DVec3::new(u, v, 0.0);
    judge(&[
        row("a NaN somewhere", run(|u, v| DVec3::new(u, v, (u - 0.5).ln()), 1e-3), "has no finite value at"),
        row("one point", run(|_, _| DVec3::ONE, 1e-3), "has no length"),
        row("a jump", run(|u, v| DVec3::new(u, v, (u - 0.3).signum()), 1e-3), "was asked for and"),
        row("no bound", run(plane, NAN), "the tolerance is NaN"),
        row("no domain", fit(plane, (1.0, 1.0), square.1, &FitOptions::new(1e-3)), "the domain in u is 0"),
        row("a domain of NaN", fit(plane, square.0, (0.0, NAN), &FitOptions::new(1e-3)), "the domain in v is NaN"),
        row("no expression", parse(""), "x, column"),
        row("an open parenthesis", parse("sin(u"), "x, column"),
        row("an unknown name", parse("u + w"), "unknown name `w`"),
    ]);
}

#[test]
fn grids() {
    let grid = |f: fn(usize) -> DVec3| PointGrid::new(5, (0..25).map(f).collect());
    let plane = |i: usize| DVec3::new((i % 5) as f64, (i / 5) as f64, 0.0);
    let even = grid(plane).unwrap();
    let twice = grid(|i| DVec3::new((i % 5).min(3) as f64, (i / 5) as f64, 0.0)).unwrap();
    let rows = grid(|i| DVec3::new((i % 5) as f64, (i / 5).max(1) as f64, 0.0)).unwrap();
    let one = grid(|_| DVec3::ONE).unwrap();
    let steps = |last: f64| vec![0.0, 1.0, 2.0, 3.0, last];
    let field = HeightField { width: 2, x: (0.0, 1.0), y: (0.0, 1.0), z: (0.0, 1.0) };
    judge(&[
        row("a NaN", grid(|i| DVec3::new((i % 5) as f64, if i == 7 { NAN } else { 0.0 }, 0.0)), "in row 1, column 2"),
        row("columns that coincide", interpolate(&twice), "points 3 and 4 coincide"),
        row("the same, approximated", approximate(&twice, (4, 4)), "points 3 and 4 coincide"),
        row("rows that coincide", interpolate(&rows), "points 0 and 1 coincide"),
        row("one point", interpolate(&one), "of the grid has no length"),
        row("one point, approximated", approximate(&one, (4, 4)), "of the grid has no length"),
        row("parameters that stand", interpolate_at(&even, steps(3.0), steps(4.0)), "parameters in u 4 is not larger"),
        row("a parameter that is none", interpolate_at(&even, steps(4.0), steps(NAN)), "parameters in v 4 is not"),
        row("more controls than data", approximate(&even, (6, 4)), "but at most"),
        row(
            "heights over nothing",
            height_field(&[0; 4], &HeightField { x: (1.0, 1.0), ..field }),
            "is 0, but must be",
        ),
        row("heights of NaN", height_field(&[0; 4], &HeightField { z: (NAN, 1.0), ..field }), "is not a finite"),
    ]);
}

#[test]
fn solids() {
    let square = [chain(&SQUARE)];
    let inside: Vec<(f64, f64)> = SQUARE.iter().map(|&(x, y)| (x + 0.5, y + 0.5)).collect();
    let pair = [chain(&SQUARE), chain(&inside)];
    let point = [vec![planar(&[(1.0, 1.0), (1.0, 1.0)])]];
    let open = vec![planar(&SQUARE)];
    let line = chain(&[(1.0, 0.0), (2.0, 0.0)]);
    judge(&[
        row("a bow, extruded", extruded_solid(&[chain(&BOW)], DVec3::Z), "the profile (by its chords) crosses itself"),
        row("a bow, turned", lathed_solid(&[chain(&BOW)], TAU), "the profile (by its chords) crosses itself"),
        row("a bow as a loop", trim_loops(&[chain(&BOW)]), "the profile (by its chords) crosses itself"),
        row("a wall over a bow", capped_solid(&[wall(&BOW)]), "the end of a wall (by its chords) crosses itself"),
        row("over a lopsided one", capped_solid(&[wall(&LOPSIDED_BOW)]), "the end of a wall (by its chords) crosses"),
        row("loops that cross", extruded_solid(&pair, DVec3::Z), "crosses itself"),
        row("walls that cross", capped_solid(&[wall(&SQUARE), wall(&inside)]), "the end of a wall (by its chords)"),
        row("a wall over a line", capped_solid(&[wall(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])]), "seen along its axis,"),
        row("a wall", capped_solid(&[wall(&SQUARE)]), ""),
        row("a point, extruded", extruded_solid(&point, DVec3::Z), "the profile has no length"),
        row("a point, turned", lathed_solid(&point, TAU), "the profile has no length"),
        row("a point as a loop", trim_loops(&point), "the profile has no length"),
        row("an open chain", extruded_solid(&[open], DVec3::Z), "open"),
        row("a line there and back", extruded_solid(&[line], DVec3::Z), "the profile encloses no area"),
        row("extruded within its plane", extruded_solid(&square, DVec3::X), "across the plane of its profile"),
        row("extruded by a NaN", extruded_solid(&square, DVec3::NAN), "is not a finite number"),
        row("turned by a NaN", lathed_solid(&square, NAN), "the angle of a lathe is NaN"),
        row("no loops", trim_loops(&[]), "0 curves of a profile"),
        row("a ball of nothing", shapes::sphere(0.0), "the radius of a sphere is 0"),
        row("a ball of NaN", shapes::sphere(NAN), "the radius of a sphere is not a finite number"),
        row("a block of NaN", shapes::block(DVec3::NAN, DVec3::ONE), "a corner of a block is not a finite"),
        row("a flat block", shapes::block(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0)), "the side of a block along y"),
        row("a cylinder of NaN", shapes::cylinder(1.0, NAN), "the height of a cylinder is not a finite"),
        row("a cone of NaN", shapes::cone(NAN, 1.0, 1.0), "the bottom radius of a cone is not a finite"),
        row("a torus through itself", shapes::torus(1.0, 2.0), "the minor radius of a torus is 2"),
        row("a tube of no wall", shapes::tube(1.0, 1.0, 1.0), "the inner radius of a tube is 1"),
        row("a gear of NaN", SpurGear::new(NAN, 20, 2.0, 1.0).build(), "is not a finite number"),
        row("a blank of NaN", blank(NAN).build(), "the bore of a gear blank is not a finite number"),
    ]);
}

fn blank(bore: f64) -> GearBlank {
    GearBlank { radius: 5.0, width: 1.0, hub_radius: 2.0, hub_width: 2.0, bore, keyway: None }
}

#[test]
fn subdivision() {
    let mesh = |positions: [DVec3; 4]| ControlMesh {
        positions: positions.to_vec(),
        faces: vec![vec![0, 1, 2], vec![0, 2, 3]],
        creases: Vec::new(),
    };
    let [o, x, y] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for scheme in [Scheme::CatmullClark, Scheme::Loop] {
        let run = |m: &ControlMesh, tolerance| subdivide(m, scheme, tolerance);
        let good = mesh([o, x, x + y, y]);
        let twisted = ControlMesh { faces: vec![vec![0, 1, 2], vec![2, 0, 3], vec![0, 2, 1]], ..good.clone() };
        judge(&[
            row(
                "a vertex that is none",
                run(&mesh([o, x, DVec3::NAN, y]), 1e-3),
                "vertex 2 of the mesh (from 0) is not",
            ),
            row("one point", run(&mesh([x; 4]), 1e-3), "the control mesh has no length"),
            row("a bound of NaN", run(&good, NAN), "the tolerance is NaN"),
            row("an edge of three faces", run(&twisted, 1e-3), "the edge between vertices"),
            row("no faces", run(&ControlMesh::default(), 1e-3), "0 faces of a control mesh"),
            row("a limit that is none", limits(&mesh([o, x, DVec3::NAN, y]), Scheme::Loop), "vertex 2 of the mesh"),
            row("a good one", run(&good, 1e-3), ""),
        ]);
    }
}

/// The table notices a construction that should fail and does not.
#[test]
#[should_panic(expected = "a wall was made")]
fn what_is_made_is_seen() {
    judge(&[row("a wall", capped_solid(&[wall(&SQUARE)]), "crosses")]);
}
