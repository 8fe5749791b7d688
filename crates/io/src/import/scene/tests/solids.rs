//! Solids, expressions and instances.

use super::import;
use crate::import::Import;
use crate::model::{Shape, Solid};
use glam::DVec3;

fn contains(solid: &Solid, at: [f64; 3]) -> bool {
    solid.tree().contains(|p| {
        let p = &solid.primitives()[p as usize];
        let own = p.to_own().expect("not flat").transform_point3(DVec3::from_array(at));
        p.shape.carriers().iter().all(|c| c.value(own) <= 0.0)
    })
}

fn inside(import: &Import, at: [f64; 3]) -> bool {
    import.model.solids.iter().any(|s| contains(s, at))
}

const PLATE: &str = "[solid.plate]\nshape = \"block\"\nsize = [4, 4, 1]\ncolour = \"#ff0000\"\n\
                     [solid.H]\nshape = \"cylinder\"\nradius = 0.5\nheight = 3\nat = [1, 1, -1]\n\
                     [solid.drilled]\nshape = \"boolean\"\nof = \"P-H\"\nwith.P = \"plate\"\n";

#[test]
fn a_drilled_plate() {
    let import = import(PLATE);
    // operands are not drawn beside the solid
    assert_eq!(import.model.solids.len(), 1);
    for (at, expected) in [
        ([0.2, 0.2, 0.5], true),
        ([1.0, 1.0, 0.5], false),
        ([1.0, 1.49, 0.5], false),
        ([1.0, 1.51, 0.5], true),
        ([1.0, 1.0, 1.5], false),
        ([4.1, 1.0, 0.5], false),
    ] {
        assert_eq!(inside(&import, at), expected, "{at:?}");
    }
    let finer =
        crate::import::scene(format!("selvedge = 1\ncoincident = 2e-7\n{PLATE}").as_bytes(), "t.toml", None).unwrap();
    assert_eq!((import.model.coincident, finer.model.coincident), (None, Some(2e-7)));
    let primitives = import.model.solids[0].primitives();
    assert_eq!(primitives[0].colour, [1.0, 0.0, 0.0, 1.0]);
    assert_ne!(primitives[0].id, primitives[1].id);
}

#[test]
fn instances_move_turn_scale_and_repeat() {
    let text = format!(
        "unit = \"cm\"\n{PLATE}[[instance]]\nof = \"drilled\"\nat = [10, 0, 0]\nscale = 2\nrepeat = 4\n\
         step = {{ rotate = 90 }}\ncolour = \"#0000ff\"\n"
    );
    let import = import(&text);
    assert_eq!(import.model.solids.len(), 4);
    // the hole's middle, first along x, then a quarter turn about the origin each time; a centimetre has 10 mm
    for (hole, solid) in [[120.0, 20.0], [-20.0, 120.0], [-120.0, -20.0], [20.0, -120.0]].iter().zip(0..) {
        let [x, y] = *hole;
        assert!(!inside(&import, [x, y, 10.0]), "{hole:?}");
        assert!(contains(&import.model.solids[solid], [x + 10.1, y, 10.0]), "{hole:?}");
        assert!(!contains(&import.model.solids[solid], [x + 9.9, y, 10.0]), "{hole:?}");
    }
    assert!(import.model.solids[3].primitives().iter().all(|p| p.colour == [0.0, 0.0, 1.0, 1.0]));
}

/// Every primitive against its closed form, in a unit other than the millimetre.
#[test]
fn primitives_in_another_unit() {
    let of = |shape: &str| import(&format!("unit = \"in\"\n[solid.s]\n{shape}\n"));
    let inch = |p: DVec3| p / 25.4;
    type Inside<'a> = &'a dyn Fn(DVec3) -> bool;
    let cases: &[(&str, Inside<'_>)] = &[
        ("shape = \"block\"\nsize = [1, 2, 3]\ncentred = true", &|p| {
            (p.abs() * 2.0).cmple(DVec3::new(1.0, 2.0, 3.0)).all()
        }),
        ("shape = \"block\"\nfrom = [-1, 0, 0]\nto = [1, 1, 2]", &|p| {
            p.cmpge(DVec3::new(-1.0, 0.0, 0.0)).all() && p.cmple(DVec3::new(1.0, 1.0, 2.0)).all()
        }),
        ("shape = \"sphere\"\nradius = 1.5", &|p| p.length() <= 1.5),
        ("shape = \"cylinder\"\nradius = 1\nheight = 2", &|p| p.x.hypot(p.y) <= 1.0 && (0.0..=2.0).contains(&p.z)),
        ("shape = \"cone\"\nbottom = 2\ntop = 0\nheight = 2", &|p| {
            p.x.hypot(p.y) <= 2.0 - p.z && (0.0..=2.0).contains(&p.z)
        }),
        ("shape = \"torus\"\nmajor = 1.5\nminor = 0.5", &|p| (p.x.hypot(p.y) - 1.5).hypot(p.z) <= 0.5),
        ("shape = \"half-space\"\nnormal = [1, 1, 0]\noffset = 1", &|p| p.x + p.y <= 1.0),
        ("shape = \"quadric\"\nsquares = [1, 2, 0]\nlinear = [0, 0, -1]\nconstant = -0.5", &|p| {
            p.x * p.x + 2.0 * p.y * p.y - p.z <= 0.5
        }),
    ];
    for (shape, expected) in cases {
        let import = of(shape);
        let points = (0..3000).map(|i| {
            let k = f64::from(i) + 0.5;
            ((DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5) * k).fract() - 0.5) * 6.0 * 25.4
        });
        let hits = points.filter(|p| {
            assert_eq!(inside(&import, p.to_array()), expected(inch(*p)), "{shape} at {p}");
            expected(inch(*p))
        });
        assert!(hits.count() > 20, "{shape}");
    }
}

/// Faces instead of equations, and a part as operand.
#[test]
fn closed_parts() {
    let faces = import("[solid.s]\nshape = \"cylinder\"\nradius = 1\nheight = 2\nfaces = true\nat = [5, 0, 0]\n");
    assert!(faces.model.solids.is_empty() && faces.model.parts[0].closed);
    let bounds = faces.model.bounds();
    assert!((bounds.centre() - DVec3::new(5.0, 0.0, 1.0)).length() < 1e-12, "{bounds:?}");
    let text = "[curve.c]\nshape = \"circle\"\nradius = 3\n[solid.P]\nshape = \"extrude\"\nloops = [\"c\", { curves = \"c\", scale = 0.5 }]\n\
                along = [0, 0, 2]\n[solid.B]\nshape = \"block\"\nsize = [9, 9, 9]\n[solid.cut]\nshape = \"boolean\"\nof = \"P-B\"\n";
    let cut = import(text);
    let Shape::Part(part) = &cut.model.solids[0].primitives()[0].shape else { panic!("a part") };
    // two rings, each one curve, and two lids with a hole
    assert_eq!((part.faces.len(), part.closed), (4, true));
    assert!(part.faces[2..].iter().all(|f| f.loops.len() == 2));
}

/// Instances share a part; a part of several surfaces has them all.
#[test]
fn parts_are_shared() {
    let text = "[surface.a]\nshape = \"plane\"\nu = [0, 1]\nv = [0, 1]\n[surface.b]\nshape = \"plane\"\nu = [0, 1]\nv = [0, 1]\n\
                y = [0, 0, 1]\ncolour = \"#00ff00\"\n[part.corner]\nsurfaces = [\"a\", \"b\"]\ncolour = \"#ff0000\"\n\
                [[instance]]\nof = \"corner\"\nrepeat = 5\nstep.at = [2, 0]\nname = \"c\"\n";
    let import = import(text);
    assert_eq!((import.model.parts.len(), import.model.instances.len()), (1, 5));
    let colours: Vec<_> = import.model.parts[0].faces.iter().map(|f| f.colour).collect();
    assert_eq!(colours, [Some([1.0, 0.0, 0.0, 1.0]), Some([0.0, 1.0, 0.0, 1.0])]);
    assert_eq!(import.model.bounds().max, DVec3::new(9.0, 1.0, 1.0));
    assert!(import.model.instances.iter().all(|i| i.name == "c"));
    assert_eq!(import.report.nodes["plane"], 2);
}

/// A polygon's corners are edges: four walls and two lids; a smooth curve stays one wall.
#[test]
fn profiles_are_cut_at_their_corners() {
    let text = "[curve.c]\nshape = \"polyline\"\nclosed = true\npoints = [[0, 0], [3, 0], [3, 2], [0, 2]]\n\
                [curve.p]\nshape = \"polyloop\"\npoints = [[0, 0], [3, 0], [3, 2], [0, 2]]\n\
                [solid.a]\nshape = \"extrude\"\nloops = [\"c\"]\nalong = [0, 0, 1]\n\
                [solid.b]\nshape = \"extrude\"\nloops = [\"p\"]\nalong = [0, 0, 1]\n";
    let import = import(text);
    assert_eq!(import.model.parts.iter().map(|p| p.faces.len()).collect::<Vec<_>>(), [6, 3]);
}

/// Only named items are transparent, and an opacity holds for all of it.
#[test]
fn what_xray_names_is_seen_through() {
    let two =
        format!("{PLATE}[solid.ball]\nshape = \"sphere\"\nradius = 1\n[[instance]]\nof = [\"drilled\", \"ball\"]\n");
    let opacities = |text: &str| {
        let import = import(&format!("{text}{two}"));
        let of = |s: &Solid| s.primitives().iter().map(|p| p.colour[3]).collect::<Vec<_>>();
        import.model.solids.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(opacities(""), [vec![1.0; 2], vec![1.0]]);
    assert_eq!(opacities("xray = { of = \"drilled\", opacity = 0.5 }\n"), [vec![0.5; 2], vec![1.0]]);
    let both = "xray = [{ of = [\"ball\", \"drilled\"], opacity = 0.5 }, { of = \"ball\", opacity = 0 }]\n";
    assert_eq!(opacities(both), [vec![0.5; 2], vec![0.0]]);
    let refused = |text: &str| super::refused(&format!("{text}{two}"));
    assert_eq!(
        refused("xray = { of = \"plate\", opacity = 0.5 }\n"),
        "2:15: `of`: nothing that is called `plate` is placed; there are `ball`, `drilled`"
    );
    assert_eq!(refused("xray = { of = \"ball\", opacity = 2 }\n"), "2:33: `opacity`: an opacity is from 0 to 1, not 2");
}
