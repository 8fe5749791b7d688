//! Boolean solids, assemblies and arrays, where they stand.

use super::structure::CYLINDER;
use super::{Entity, e, import};
use crate::import::Import;
use crate::model::SurfaceTable;
use glam::{DAffine3, DVec3};
use selvedge_check::solids::SolidTracer;

/// A unit square in the plane z = 0.
const SQUARE: &str = "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,0.,1.,0.,0.,0.,1.,0.,1.,1.,0.;";

/// A point, and whether it is inside.
pub(super) type Probe = ([f64; 3], bool);

/// Whether points are inside of the file's only solid: a line through each.
pub(super) fn holds(import: &Import, points: &[Probe]) {
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    let [solid] = &import.model.solids[..] else { panic!("{} solids", import.model.solids.len()) };
    let tracer = SolidTracer::new(solid, SurfaceTable::ROUNDED).unwrap();
    for (p, inside) in points {
        let trace = tracer.trace(DVec3::from_array(*p), DVec3::new(0.3, 0.5, 0.8));
        assert_eq!(trace.inside(0.0), *inside, "at {p:?}");
    }
}

#[test]
fn primitives_stand_where_they_should() {
    let d = 1e-6;
    let cases: [(&str, &[Probe]); 8] = [
        ("150,1.,2.,3.;", &[([d, d, d], true), ([1.0 - d, 2.0 - d, 3.0 - d], true), ([1.0 + d, 1.0, 1.0], false)]),
        // local x along y, local z along x, so local y along z
        (
            "150,1.,2.,3.,10.,20.,30.,0.,1.,0.,1.,0.,0.;",
            &[([13.0 - d, 21.0 - d, 32.0 - d], true), ([13.0 - d, 21.0 + d, 31.0], false), ([10.5, 20.5, 30.5], true)],
        ),
        ("152,4.,2.,3.,1.;", &[([2.5 - d, 1.0, 1.0], true), ([2.5 + d, 1.0, 1.0], false), ([0.9, 1.9, 2.9], true)]),
        ("154,5.,2.,1.,0.,0.,1.,0.,0.;", &[([6.0 - d, 0.0, 1.9], true), ([0.9, 0.0, 0.0], false)]),
        ("156,4.,3.,1.,0.,0.,0.,0.,0.,1.;", &[([2.0 - d, 0.0, 2.0], true), ([2.0 + d, 0.0, 2.0], false)]),
        ("158,2.,1.,1.,1.;", &[([3.0 - d, 1.0, 1.0], true), ([3.0 + d, 1.0, 1.0], false)]),
        ("160,4.,1.;", &[([4.0, 0.0, 0.9], true), ([0.0, 0.0, 0.0], false), ([0.0, 5.0 - d, 0.0], true)]),
        ("168,3.,2.,1.;", &[([3.0 - d, 0.0, 0.0], true), ([0.0, 2.0 + d, 0.0], false), ([0.0, 0.0, 1.0 - d], true)]),
    ];
    for (text, points) in cases {
        holds(&import(&[e(text)]), points);
    }
}

#[test]
fn trees_assemblies_and_instances() {
    // a block less a cylinder through it, moved by (100, 0, 0), and a ball
    let all = || {
        vec![
            e("150,4.,4.,4.;"),
            e("154,4.,1.,2.,2.,0.,0.,0.,1.;"),
            e("180,3,-1,-3,3;"),
            Entity { matrix: 9, ..e("430,5;") },
            e("124,1.,0.,0.,100.,0.,1.,0.,0.,0.,0.,1.,0.;"),
        ]
    };
    let i = import(&all());
    holds(&i, &[([102.0, 2.0, 2.0], false), ([102.0, 3.1, 2.0], true), ([2.0, 3.1, 2.0], false)]);
    assert_eq!((i.report.nodes["block"], i.report.nodes["Boolean tree"], i.report.bodies), (1, 1, 1));
    // the same twice, the second one raised by an assembly
    let mut twice = all();
    twice.extend([e("184,2,7,7,0,13;"), e("124,1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,50.;")]);
    let i = import(&twice);
    assert!(i.warnings.is_empty() && i.model.parts.is_empty(), "{:?}", i.warnings);
    let heights: Vec<f64> = i.model.solids.iter().map(|s| s.bounds().min.z).collect();
    assert!(heights.len() == 2 && heights[0].abs() < 1e-9 && (heights[1] - 50.0).abs() < 1e-9, "{heights:?}");
    // an invalid tree costs the solid, with a warning
    for (tree, why) in [
        ("180,2,-1,3;", "#5: an operation lacks an operand"),
        ("180,2,-1,-3;", "#5: its operations do not join all operands"),
        ("180,3,-1,-3,4;", "#5: an operation is no union, intersection or difference"),
    ] {
        let mut all = all();
        all.truncate(2);
        all.push(e(tree));
        let i = import(&all);
        let told = format!("#5: Boolean solid left out: {why}");
        assert!(i.warnings.len() == 1 && i.warnings[0].to_string().ends_with(&told), "{:?}", i.warnings);
        // the cylinder that no tree names is drawn by itself
        assert_eq!(i.model.solids.len(), usize::from(!tree.contains("-3")));
    }
}

#[test]
fn rectangular_arrays() {
    let base = || Entity { status: "00010000", ..e(SQUARE) };
    let corners = |i: &Import| {
        let at = |t: &DAffine3| t.translation.round().truncate().to_array().map(|x| x as i32);
        i.model.instances.iter().map(|i| at(&i.transform)).collect::<Vec<_>>()
    };
    let i = import(&[base(), e("412,1,1.,5.,0.,0.,3,2,30.,40.,0.,0,0;")]);
    assert!(i.warnings.is_empty(), "{:?}", i.warnings);
    assert_eq!((i.model.parts.len(), i.model.parts[0].faces.len()), (1, 1));
    assert_eq!(corners(&i), [[5, 0], [5, 40], [35, 0], [35, 40], [65, 0], [65, 40]]);
    // places named, or all but those; a grid turned by a right angle; twice as large
    let i = import(&[base(), e("412,1,2.,0.,0.,0.,3,2,30.,40.,1.5707963267948966,2,0,2,3;")]);
    assert_eq!(corners(&i), [[-40, 0], [0, 30]]);
    assert!((i.model.instances[0].transform.matrix3.determinant() - 8.0).abs() < 1e-12);
    let i = import(&[base(), e("412,1,1.,0.,0.,0.,3,2,30.,40.,0.,2,1,2,3;")]);
    assert_eq!(corners(&i), [[0, 0], [30, 40], [60, 0], [60, 40]]);
    // four places on a circle of radius 10 about (1, 2)
    let i = import(&[base(), e("414,1,4,1.,2.,0.,10.,0.,1.5707963267948966,0,0;")]);
    assert_eq!(corners(&i), [[11, 2], [1, 12], [-9, 2], [1, -8]]);
    // an array of arrays
    let i = import(&[
        base(),
        Entity { status: "00010000", ..e("412,1,1.,0.,0.,0.,2,1,3.,0.,0.,0,0;") },
        e("412,3,1.,0.,0.,0.,1,2,0.,9.,0.,0,0;"),
    ]);
    assert_eq!(corners(&i), [[0, 0], [3, 0], [0, 9], [3, 9]]);
}

#[test]
fn impossible_arrays_are_reported() {
    for (array, why) in [
        ("412,1,1.,0.,0.,0.,0,2,30.,40.,0.,0,0;", "array left out: #3: the array has no places, or too many"),
        ("412,1,1.,0.,0.,0.,100000,100000,30.,40.,0.,0,0;", "array left out: #3: the array has too many places"),
        ("412,1,1.,0.,0.,0.,3,2,30.,40.,0.,1,0,7;", "array left out: #3: the array has no place of that number"),
        // an array of itself is its own user, so nothing begins there
        ("412,3,1.,0.,0.,0.,3,2,30.,40.,0.,0,0;", "entity left out: #3 refers to itself"),
        ("414,9,4,1.,2.,0.,10.,0.,1.5,0,0;", "array left out: #9 does not exist"),
    ] {
        let i = import(&[Entity { status: "00010000", ..e(SQUARE) }, e(array)]);
        assert!(i.model.instances.is_empty(), "{array}");
        let told = i.warnings.iter().any(|w| w.to_string().ends_with(&format!("#3: {why}")));
        assert!(told, "{array}: {:?}", i.warnings);
    }
}

#[test]
fn an_offset_is_drawn_where_its_edges_are() {
    let plane = "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,0.,10.,0.,0.,0.,20.,0.,10.,20.,0.;";
    let at = |z: f64| {
        let c = [(1., 1.), (9., 1.), (9., 19.), (1., 19.), (1., 1.)];
        let side = |w: &[(f64, f64)]| e(&format!("110,{},{},{z},{},{},{z};", w[0].0, w[0].1, w[1].0, w[1].1));
        let mut all = vec![e(plane), e("140,0.,0.,1.,1.,1;")];
        all.extend(c.windows(2).map(side));
        all.extend([e("102,4,5,7,9,11;"), e("142,0,3,0,13,2;"), e("144,3,1,0,15;")]);
        import(&all)
    };
    for (z, told) in [(1.0, 0), (-1.0, 1)] {
        let i = at(z);
        let face = &i.model.parts[0].faces[0];
        let height = face.surface.patches().point(0.5, 0.5).z;
        assert!((height - z).abs() < 1e-9, "{height}");
        assert_eq!(i.warnings.len(), told, "{:?}", i.warnings);
        assert!(i.report.gap < 1e-9);
    }
    assert!(
        at(-1.0).warnings[0]
            .to_string()
            .ends_with("#3: offset on the other side: its edges lie there, and so it is drawn")
    );
    // edges that lie on neither side leave it where it is stated, with a warning
    let i = at(-0.5);
    assert!(
        i.report.gap > 1.4 && i.warnings.iter().all(|w| w.to_string().contains("lies 1.500e0 mm off")),
        "{:?}",
        i.warnings
    );
}

/// Half a cone whose sides meet 0.3 micrometres behind its axis, and 0.03 mm beside it, so that its profile misses it.
#[test]
fn a_cone_whose_tip_lies_off_its_axis() {
    let off = |tip: f64, beside: f64| {
        import(&[
            e("110,0.,0.,0.,0.,0.,1.;"),
            e(&format!("110,5.,0.,0.,{tip},{beside},10.;")),
            e("120,1,3,0.,6.283185307179586;"),
            e("100,0.,0.,0.,5.,0.,-4.990133642141358,-0.31395259764656674;"),
            e(&format!("110,-4.990133642141358,-0.31395259764656674,0.,{tip},{beside},10.;")),
            e(&format!("110,{tip},{beside},10.,5.,0.,0.;")),
            e("102,3,7,9,11;"),
            e("142,0,5,0,13,2;"),
            e("144,5,1,0,15;"),
        ])
    };
    // the arc's share of a cone of radius 5 and height 10
    let angle = std::f64::consts::PI + (0.31395259764656674f64).atan2(4.990133642141358);
    let wanted = 0.5 * angle * 5.0 * 125f64.sqrt();
    for (tip, beside, told) in [(0.0, 0.0, ""), (-0.0003, 0.0, "behind the tip"), (0.0, -0.03, "beside the tip")] {
        let i = off(tip, beside);
        assert_eq!(i.model.face_count(), 1, "{:?}", i.warnings);
        let face = &i.model.parts[0].faces[0];
        let grid = face.surface.patches();
        let index = crate::trim::LoopIndex::new(&face.loops);
        let (u, v) = face.surface.domain();
        let (n, mut area) = (400, 0.0);
        let cell = (u.1 - u.0) * (v.1 - v.0) / f64::from(n * n);
        for k in 0..n * n {
            let at = |(a, b): (f64, f64), k: i32| a + (b - a) * (f64::from(k) + 0.5) / f64::from(n);
            let p = glam::DVec2::new(at(u, k % n), at(v, k / n));
            let jet = grid.jet(p.x, p.y);
            area += if index.contains(p) { jet.du.cross(jet.dv).length() * cell } else { 0.0 };
        }
        assert!((area - wanted).abs() < 2e-2 * wanted, "{tip}: {area}, not {wanted}");
        assert!(i.warnings.is_empty() == told.is_empty(), "{:?}", i.warnings);
        assert!(told.is_empty() || i.warnings.iter().any(|w| w.to_string().contains(told)), "{:?}", i.warnings);
    }
    // farther off than the face shows, it is no tip
    let i = off(0.0, -0.5);
    assert_eq!(i.model.face_count(), 0);
    assert!(i.warnings.iter().any(|w| w.to_string().contains("no other loop or pole closes it")), "{:?}", i.warnings);
}

/// The cylinder of radius 2 and height 5, faces and edges, less a ball in its middle.
#[test]
fn a_solid_of_faces_is_an_operand() {
    let section = |letter: char| CYLINDER.lines().filter(move |l| l.as_bytes().get(72) == Some(&(letter as u8)));
    let solid = section('D').position(|l| l.starts_with("     186")).unwrap() + 1;
    let (entries, cards) = (section('D').count(), section('P').count());
    let mut text: String = ['S', 'G', 'D'].into_iter().flat_map(section).map(|l| format!("{l}\n")).collect();
    let more = ["158,1.,0.,0.,2.5;".to_owned(), format!("180,3,-{solid},-{},3;", entries + 1)];
    for (i, parameters) in more.iter().enumerate() {
        let (kind, id, card) = (&parameters[..3], entries + 2 * i + 1, cards + i + 1);
        text += &format!("{kind:>8}{card:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}00000000D{id:>7}\n", 0, 0, 0, 0, 0, 0);
        text += &format!("{kind:>8}{:>8}{:>8}{:>8}{:>8}{:>16}{:>8}{:>8}D{:>7}\n", 0, 0, 1, 0, "", "", 0, id + 1);
    }
    text += &section('P').map(|l| format!("{l}\n")).collect::<String>();
    for (i, parameters) in more.iter().enumerate() {
        text += &format!("{parameters:<64}{:>8}P{:>7}\n", entries + 2 * i + 1, cards + i + 1);
    }
    let counts = format!("S{:>7}G{:>7}D{:>7}P{:>7}", 1, section('G').count(), entries + 4, cards + 2);
    text += &format!("{counts:<72}T{:>7}\n", 1);
    let i = crate::import::iges(text.as_bytes(), "t.igs").unwrap();
    holds(&i, &[([0.0, 0.0, 2.5], false), ([1.9, 0.0, 2.5], true), ([2.1, 0.0, 2.5], false), ([0.0, 0.0, 4.9], true)]);
    assert!(i.model.parts.is_empty() && i.model.instances.is_empty());
    assert_eq!((i.report.bodies, i.report.faces), (1, 3));
    // the records of its faces name no part
    assert!(i.report.face_records.iter().all(|r| r.part == 0));
    // without one of them it has no inside
    let i = crate::import::iges(text.replacen("510,39,1,1,47;", "510,47,1,1,47;", 1).as_bytes(), "t.igs").unwrap();
    let lost = i.warnings.iter().any(|w| w.message.contains("is not closed, so it has no inside"));
    assert!(lost && i.model.solids.is_empty() && i.summary().draws_nothing(), "{:?}", i.warnings);
}
