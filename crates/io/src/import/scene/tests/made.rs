//! Curves, surfaces and loops against closed forms.

use super::{face, import};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A turned half circle is a ball, whatever the unit.
#[test]
fn a_lathe_in_inches() {
    let text = "unit = \"in\"\n[curve.c]\nshape = \"arc\"\nradius = 2\nfrom = -90\nto = 90\n\
                [surface.s]\nshape = \"lathe\"\nprofile = \"c\"\nat = [1, 0, 0]\n";
    let import = import(text);
    assert_eq!(import.model.unit, "in");
    let surface = &import.model.parts[0].faces[0].surface;
    for k in 0..100 {
        let (u, v) = (TAU * f64::from(k) / 99.0, (f64::from(k * 7 % 100) / 99.0 - 0.5) * TAU / 2.0);
        let p = surface.point(u, v);
        assert!((p.distance(DVec3::X * 25.4) - 50.8).abs() < 1e-12 * 50.8, "{p}");
    }
}

#[test]
fn every_curve_passes_where_it_says() {
    let cases: &[(&str, &[[f64; 3]])] = &[
        ("shape = \"line\"\nfrom = [1, 2]\nto = [3, 4, 5]", &[[1.0, 2.0, 0.0], [3.0, 4.0, 5.0]]),
        ("shape = \"arc\"\nradius = 2\ncentre = [1, 0]\nfrom = 0\nto = 90", &[[3.0, 0.0, 0.0], [1.0, 2.0, 0.0]]),
        ("shape = \"circle\"\nradius = 2\naxis = [1, 0, 0]", &[[0.0, 2.0, 0.0], [0.0, -2.0, 0.0]]),
        ("shape = \"ellipse\"\nx = [3, 0]\ny = [0, 1]", &[[3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]]),
        (
            "shape = \"parabola\"\napex = [0, 0]\nx = [0, 1]\ny = [1, 0]\nrange = [-1, 2]",
            &[[-1.0, 1.0, 0.0], [2.0, 4.0, 0.0]],
        ),
        ("shape = \"polyline\"\npoints = [[0, 0], [1, 0], [1, 1]]\nclosed = true", &[[0.0; 3], [0.0; 3]]),
        ("shape = \"bezier\"\npoints = [[0, 0], [1, 0], [1, 1]]", &[[0.0; 3], [1.0, 1.0, 0.0]]),
        ("shape = \"bspline\"\ndegree = 2\npoints = [[0, 0], [1, 0], [1, 1], [3, 1]]", &[[0.0; 3], [3.0, 1.0, 0.0]]),
        ("shape = \"through\"\npoints = [[0, 0], [1, 2], [3, 1]]\nat = [0, 0, 7]", &[[0.0, 0.0, 7.0], [3.0, 1.0, 7.0]]),
        (
            "shape = \"polyloop\"\nstyle = \"through\"\npoints = [[1, 0], [0, 1], [-1, 0]]",
            &[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        ),
        ("shape = \"line\"\nfrom = [1, 0]\nto = [2, 0]\nrotate = 90\nscale = 2", &[[0.0, 2.0, 0.0], [0.0, 4.0, 0.0]]),
    ];
    for (curve, ends) in cases {
        // shown as the sides of an extrusion
        let text =
            format!("[curve.c]\n{curve}\n[surface.s]\nshape = \"extrude\"\nprofile = \"c\"\nalong = [1, 2, 9]\n");
        let surface = face(&text).surface;
        let ((u0, u1), (v0, v1)) = surface.domain();
        let middle = 0.5 * (u0 + u1);
        let second = if curve.contains("circle") || curve.contains("ellipse") { middle } else { u1 };
        for (u, p) in [(u0, ends[0]), (second, ends[1])] {
            let p = DVec3::from_array(p);
            assert!(surface.point(u, v0).distance(p) < 1e-12, "{curve}: {} for {p}", surface.point(u, v0));
            assert!(surface.point(u, v1).distance(p + DVec3::new(1.0, 2.0, 9.0)) < 1e-12, "{curve}");
        }
    }
}

/// A joined profile: a bar with round ends, whose length is known.
#[test]
fn joined_curves_turn_round_where_they_must() {
    let text = "[curve.a]\nshape = \"line\"\nfrom = [0, 1]\nto = [4, 1]\n[curve.b]\nshape = \"arc\"\ncentre = [4, 0]\n\
                radius = 1\nfrom = -90\nto = 90\n[curve.j]\nshape = \"joined\"\nof = [\"a\", \"b\"]\n\
                [surface.s]\nshape = \"extrude\"\nprofile = \"j\"\nalong = [0, 0, 1]\n";
    let surface = face(text).surface;
    let ((u0, u1), (v0, _)) = surface.domain();
    assert_eq!(surface.point(u0, v0), DVec3::new(0.0, 1.0, 0.0));
    assert!(surface.point(u1, v0).distance(DVec3::new(4.0, -1.0, 0.0)) < 1e-12);
    let mut length = 0.0;
    let at = |k: u32| surface.point(u0 + (u1 - u0) * f64::from(k) / 4000.0, v0);
    (0..4000).for_each(|k| length += at(k).distance(at(k + 1)));
    // chords of a two-thousandth of a half circle are short by a 1e-6 of it
    assert!((length - 4.0 - 0.5 * TAU).abs() < 1e-5, "{length}");
}

#[test]
fn equations_are_kept_within_their_bound() {
    let text = "tolerance = 1e-6\n[surface.s]\nshape = \"equations\"\nx = \"(a+cos(v))*cos(u)\"\ny = \"(a+cos(v))*sin(u)\"\n\
                z = \"sin(v)\"\nconstants = { a = 3 }\nu = [0, \"2*pi\"]\nv = [0, \"tau\"]\n";
    let import = import(text);
    let surface = &import.model.parts[0].faces[0].surface;
    let grid = surface.patches();
    let mut worst: f64 = 0.0;
    for k in 0..5000_u32 {
        let (u, v) = (TAU * f64::from(k) / 5000.0, TAU * f64::from(k * 37 % 5000) / 5000.0);
        let ring = DVec3::new((3.0 + v.cos()) * u.cos(), (3.0 + v.cos()) * u.sin(), v.sin());
        worst = worst.max(grid.point(u, v).distance(ring));
    }
    let record = &import.report.face_records[0];
    assert!(worst <= record.deviation && record.deviation <= 1e-6, "{worst:e}, {record:?}");
    assert_eq!(record.notes[1], "2 seams and 0 poles");
}

/// Doubled area that the loops keep, by their signed areas.
fn kept(face: &crate::model::Face) -> f64 {
    face.loops.iter().map(crate::model::TrimLoop::signed_area).sum()
}

#[test]
fn loops_are_oriented_by_what_they_lie_in() {
    let text = "[curve.sq]\nshape = \"polyline\"\nclosed = true\npoints = [[0, 0], [0, 1], [1, 1], [1, 0]]\n\
                [surface.s]\nshape = \"plane\"\nu = [0, 10]\nv = [0, 10]\nborder = true\n\
                loops = [{ curves = \"sq\", at = [1, 1], scale = 4 }, { curves = \"sq\", at = [2, 2], rotate = 0 }]\n";
    // all of it, less a hole of 4 by 4, with an island of 1 in it
    assert_eq!(kept(&face(text)), 2.0 * (100.0 - 16.0 + 1.0));
}

/// A circle cast obliquely on a sloping plane is an ellipse of the plane's (u, v); on a ball it is where rays hit.
#[test]
fn outlines_are_cast_along_their_direction() {
    let ring = "tolerance = 1e-5\n[curve.ring]\nshape = \"circle\"\ncentre = [5, 5, 20]\nradius = 2\n";
    let cast = "loops = [{ curves = \"ring\", along = [0.2, 0, -1] }]\n";
    let plane = format!("{ring}[surface.s]\nshape = \"plane\"\nx = [1, 0, 0.5]\nu = [0, 20]\nv = [0, 10]\n{cast}");
    let on_plane = face(&plane);
    let mut met = 0;
    for c in on_plane.loops[0].curves() {
        for k in 0..8 {
            let uv = c.point(f64::from(k) / 8.0);
            let p = on_plane.surface.point(uv.x, uv.y);
            let back = p + DVec3::new(0.2, 0.0, -1.0) * (p.z - 20.0);
            assert!((DVec2::new(back.x - 5.0, back.y - 5.0).length() - 2.0).abs() < 1e-5, "{back}");
            met += 1;
        }
    }
    assert!(met > 16);
    let ball = format!(
        "{ring}[curve.m]\nshape = \"arc\"\nradius = 9\nfrom = -90\nto = 90\n[surface.s]\nshape = \"lathe\"\n\
         profile = \"m\"\nat = [5, 5, 0]\nrotate = [0, 40, 0]\nloops = [{{ curves = \"ring\", along = [0, 0, -1] }}]\n"
    );
    let import = import(&ball);
    let on_ball = &import.model.parts[0].faces[0];
    for c in on_ball.loops[0].curves() {
        for k in 0..8 {
            let uv = c.point(f64::from(k) / 8.0);
            let p = on_ball.surface.point(uv.x, uv.y);
            // the nearer of both sides, seen from above
            assert!((DVec2::new(p.x - 5.0, p.y - 5.0).length() - 2.0).abs() < 1e-5 && p.z > 8.0, "{p}");
        }
    }
    let record = &import.report.face_records[0];
    assert!(record.deviation > 0.0 && record.deviation <= 1e-5 && record.notes[0].starts_with("outlines cast"));
}

/// Mirrored and flipped surfaces turn their normals round.
#[test]
fn sides_of_surfaces() {
    let plane =
        |more: &str| face(&format!("[surface.s]\nshape = \"plane\"\nu = [0, 1]\nv = [0, 1]\n{more}\n")).same_sense;
    assert!(plane("") && !plane("flip = true") && !plane("scale = [-1, 1, 1]") && plane("scale = -1\nflip = true"));
}

#[test]
fn every_gallery_scene_is_read() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/gallery");
    let mut shapes = std::collections::BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let import = crate::import::open(&path).unwrap_or_else(|e| panic!("{e}"));
            assert!(!import.model.bounds().is_empty() && import.warnings.is_empty(), "{}", path.display());
            shapes.extend(import.report.nodes.into_keys());
        }
    }
    // every construction has its picture
    for shape in
        ["extrude", "lathe", "sweep", "tube", "ruled", "loft", "coons", "gordon", "offset", "equations", "grid"]
    {
        assert!(shapes.contains(shape), "{shape} is not in {shapes:?}");
    }
}
