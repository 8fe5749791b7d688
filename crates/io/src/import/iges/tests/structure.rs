//! Units, matrices, subfigures, groups, colours, names, status; cards of every shape; a whole solid.

use super::{Entity, GLOBAL, e, face, file, import, reaches};
use crate::import::{Import, ImportError, iges};
use crate::model::Face;
use glam::DVec3;

/// A unit square in the plane z = 0, parameters 0 to 1.
pub(super) const SQUARE: &str =
    "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,0.,1.,0.,0.,0.,1.,0.,1.,1.,0.;";

/// A cylinder of radius 2 and height 5, one closed solid of three faces, as Open CASCADE writes it.
pub(super) const CYLINDER: &str = include_str!("cylinder.igs");

#[test]
fn a_solid() {
    let i = iges(CYLINDER.as_bytes(), "cylinder.igs").unwrap();
    assert!(i.warnings.is_empty(), "{:?}", i.warnings);
    let part = &i.model.parts[0];
    assert!(part.closed);
    // three edges shared by six uses; four curves in parameters that stay unused
    assert_eq!((i.report.faces, i.report.edges, i.report.pcurves, part.faces.len()), (3, 3, 4, 3));
    assert_eq!((i.report.format.as_str(), i.model.unit.as_str()), ("IGES 5.3", "mm"));
    normals_leave(&part.faces, DVec3::new(0.0, 0.0, 2.5));
    // a face whose surface is none, and one whose loop is a line across it: what is left bounds nothing
    for (from, to) in [("510,39,1,1,47;", "510,47,1,1,47;"), ("508,1,0,17,1,1,0;", "508,1,0,17,2,1,0;")] {
        let i = iges(CYLINDER.replacen(from, to, 1).as_bytes(), "cylinder.igs").unwrap();
        assert_eq!((i.model.parts[0].faces.len(), i.model.parts[0].closed), (2, false), "{:?}", i.warnings);
    }
}

/// Each edge is used twice and known by its list and its place there.
#[test]
fn edges_of_a_solid_have_their_places() {
    let part = &iges(CYLINDER.as_bytes(), "cylinder.igs").unwrap().model.parts[0];
    let edges = part.edges().unwrap();
    let counts = edges.counts();
    assert_eq!((counts.sharp, counts.smooth, counts.seams, counts.borders, counts.vertices), (2, 0, 1, 0, 2));
    let mut sources: Vec<_> = edges.edges.iter().map(|e| e.source.unwrap().to_string()).collect();
    sources.sort();
    assert_eq!(sources, ["#17, item 1", "#17, item 2", "#17, item 3"]);
}

/// A solid in a mirror: normals still leave it.
#[test]
fn a_mirrored_solid() {
    // the matrix of an edge becomes that of the solid, and the height that it gave stands in the circle
    let (up, mirror) = ("124,1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,5.;", "124,-1.,0.,0.,7.,0.,1.,0.,0.,0.,0.,1.,0.;");
    let mut text = CYLINDER.replacen(&format!("{up:<64}"), &format!("{mirror:<64}"), 1);
    text = text.replacen("100,0.,0.,0.,2.,0.,2.,0.;", "100,5.,0.,0.,2.,0.,2.,0.;", 1);
    let matrix = |line: &str| match line.get(72..) {
        Some("D0000001") => format!("{}{:>8}{}\n", &line[..48], 21, &line[56..]),
        Some("D0000019") => format!("{}{:>8}{}\n", &line[..48], 0, &line[56..]),
        _ => format!("{line}\n"),
    };
    let i = iges(text.lines().map(matrix).collect::<String>().as_bytes(), "mirrored.igs").unwrap();
    assert!(i.warnings.is_empty(), "{:?}", i.warnings);
    normals_leave(&i.model.parts[0].faces, DVec3::new(7.0, 0.0, 2.5));
}

/// Normals point away from the middle.
fn normals_leave(faces: &[Face], middle: DVec3) {
    assert_eq!(faces.len(), 3);
    for f in faces {
        let (u, v) = f.surface.domain();
        let jet = f.surface.jet(0.5 * (u.0 + u.1), 0.5 * (v.0 + v.1));
        let normal = jet.du.cross(jet.dv) * if f.same_sense { 1.0 } else { -1.0 };
        assert!(normal.dot(jet.point - middle) > 0.0, "#{}", f.id);
    }
}

#[test]
fn units_and_scale() {
    for (global, side) in [
        (GLOBAL.replace("1.,2,2HMM", "1.,1,4HINCH"), 25.4),
        (GLOBAL.replace("1.,2,2HMM", "1.,3,2HCM"), 10.0),
        (GLOBAL.replace("1.,2,2HMM", "0.125,6,1HM"), 8000.0),
    ] {
        let i = iges(file(&global, &[e(SQUARE)]).as_bytes(), "t.igs").unwrap();
        assert!(i.warnings.is_empty(), "{:?}", i.warnings);
        let (lo, hi) = i.model.parts[0].faces[0].surface.bounds();
        assert_eq!((lo, hi), (DVec3::ZERO, DVec3::new(side, side, 0.0)), "{global}");
    }
}

#[test]
fn a_matrix_of_a_matrix() {
    // a quarter turn about z, then 10 along x
    let turn = Entity { matrix: 5, ..e("124,0.,-1.,0.,0.,1.,0.,0.,0.,0.,0.,1.,0.;") };
    let f = face(&[Entity { matrix: 3, ..e(SQUARE) }, turn, e("124,1.,0.,0.,10.,0.,1.,0.,0.,0.,0.,1.,0.;")]);
    reaches(&f, DVec3::new(9.0, 0.0, 0.0));
    reaches(&f, DVec3::new(10.0, 1.0, 0.0));
    // a matrix that stretches makes no circle
    let arc = Entity { matrix: 3, ..e("100,0.,0.,0.,1.,0.,0.,1.;") };
    let i = import(&[arc, e("124,2.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.;"), e("122,1,2.,0.,1.;")]);
    assert_eq!(i.warnings[0].message, "face left out: #1: the matrix distorts a round shape");
}

#[test]
fn subfigures() {
    let members = [
        Entity { status: "00010000", ..e(SQUARE) },
        Entity { status: "00000200", ..e("308,0,4Htile,1,1;") },
        e("408,3,1.,2.,3.,2.;"),
        Entity { status: "00000200", ..e("308,1,4Hpair,2,9,11;") },
        e("408,3,0.,0.,0.,1.;"),
        e("408,3,5.,0.,0.;"),
        Entity { matrix: 15, ..e("408,7,0.,0.,1.,1.;") },
        e("124,0.,-1.,0.,0.,1.,0.,0.,0.,0.,0.,1.,0.;"),
    ];
    // #9 and #11 belong to #7
    let i = import(&members);
    assert!(i.warnings.is_empty(), "{:?}", i.warnings);
    assert_eq!(i.model.parts.len(), 1);
    let all: Vec<_> =
        i.model.instances.iter().map(|i| (i.name.as_str(), i.transform.transform_point3(DVec3::X))).collect();
    let wanted = [
        ("tile", DVec3::new(3.0, 2.0, 3.0)),
        ("pair/tile", DVec3::new(0.0, 1.0, 1.0)),
        ("pair/tile", DVec3::new(0.0, 6.0, 1.0)),
    ];
    assert_eq!(all, wanted);
}

/// What nothing drawn leads to: a subfigure that is placed nowhere, one that only itself places, a face whose hole is
/// the face.
#[test]
fn what_nothing_draws_is_reported() {
    let spare = Entity { status: "00000200", ..e("308,0,5Hspare,1,1;") };
    let i = import(&[Entity { status: "00010000", ..e(SQUARE) }, spare, e(SQUARE)]);
    let told = |i: &Import| i.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>();
    assert_eq!(told(&i), ["subfigure not placed: nothing that is drawn places it"]);
    assert!(i.summary().is_complete() && i.model.instances.len() == 1);
    let i = import(&[e(SQUARE), e("308,0,1Ha,1,5;"), e("408,3,0.,0.,0.,1.;"), e("144,1,1,1,0,7;")]);
    let circles = ["entity left out: #3 refers to itself", "entity left out: #7 refers to itself"];
    assert_eq!(told(&i)[..2], circles);
    assert_eq!(i.summary().left_out["entity left out"].total(), 2);
    assert!(i.model.instances.is_empty());
}

/// A type of a writer's own, and the instance of a network subfigure, whose definition is not read.
#[test]
fn types_that_are_not_read_are_reported() {
    let i = import(&[e(SQUARE), e("5001,1.,2.;"), e("420,9,0.,0.,0.,1.,1.,1.,0,,0,0;"), e("410,1,1.;")]);
    let told: Vec<_> = i.warnings.iter().map(|w| w.message.clone()).collect();
    let network = "entity left out: type 420 form 0 is not supported (#5)";
    assert_eq!(told, ["entity of an unknown type not drawn: type 5001", network]);
    assert_eq!(i.model.instances.len(), 1);
}

/// Parts that stand in other files.
#[test]
fn external_files_are_named() {
    let all = [e(SQUARE), e("416,8Hbolt.igs,1HA;"), e("416,8Hbolt.igs,1HB;"), e("408,3,0.,0.,0.;")];
    let i = import(&all);
    let told: Vec<_> = i.warnings.iter().map(|w| w.message.clone()).collect();
    assert!(told.contains(&"external file not followed: bolt.igs".to_owned()), "{told:?}");
    assert!(told.iter().any(|t| t.starts_with("subfigure left out: ")), "{told:?}");
    let summary = i.summary();
    assert_eq!((summary.elsewhere.as_slice(), summary.faces.drawn), (&["bolt.igs".to_owned()][..], 1));
    assert!(!summary.is_complete());
}

/// A mark of byte order moves no column.
#[test]
fn a_mark_of_byte_order_is_no_column() {
    let marked = ["\u{feff}", CYLINDER].concat();
    let i = crate::import::read_from(&mut marked.as_bytes(), "cylinder.igs", &Default::default()).unwrap();
    assert!(i.warnings.is_empty(), "{:?}", i.warnings);
    assert_eq!(i.report.faces, 3);
}

#[test]
fn subfigures_stand_in_the_files_unit() {
    let global = GLOBAL.replace("1.,2,2HMM", "1.,1,4HINCH");
    let all = [e(SQUARE), Entity { status: "00000200", ..e("308,0,4Htile,1,1;") }, e("408,3,1.,2.,3.,1.;")];
    let i = iges(file(&global, &all).as_bytes(), "t.igs").unwrap();
    let corner = i.model.instances[0].transform.transform_point3(DVec3::new(25.4, 0.0, 0.0));
    assert!(corner.distance(25.4 * DVec3::new(2.0, 2.0, 3.0)) < 1e-12, "{corner}");
}

#[test]
fn groups_levels_colours_and_names() {
    let square = |colour: i32, level: i32| Entity { colour, level, ..e(SQUARE) };
    let name = Entity { form: 15, ..e("406,1,4HRoof;") };
    let group = Entity { form: 7, ..e("402,2,1,3,0,1,11;") };
    let i =
        import(&[square(0, 0), square(2, 0), square(-13, 4), square(5, 4), group, name, e("314,100.,50.,0.,2HXX;")]);
    assert!(i.warnings.is_empty(), "{:?}", i.warnings);
    let parts: Vec<_> = i.model.parts.iter().map(|p| (p.name.as_str(), p.faces.len(), p.closed)).collect();
    assert_eq!(parts, [("Roof", 2, false), ("level 4", 2, false)]);
    let colours: Vec<_> = i.model.parts.iter().flat_map(|p| &p.faces).map(|f| f.colour).collect();
    // 50 % sRGB is 0.2140 of the light
    let half = ((0.5f64 + 0.055) / 1.055).powf(2.4) as f32;
    let wanted = [None, Some([1.0, 0.0, 0.0, 1.0]), Some([1.0, half, 0.0, 1.0]), Some([1.0, 1.0, 0.0, 1.0])];
    assert_eq!(colours, wanted);
}

#[test]
fn what_is_not_drawn_is_counted() {
    let status = |status: &'static str, text: &str| Entity { status, ..e(text) };
    let i = import(&[
        status("01000000", SQUARE),
        status("00000100", SQUARE),
        status("00000600", SQUARE),
        status("00000500", "110,0.,0.,0.,1.,0.,0.;"),
        e("108,0.,0.,1.,5.;"),
        e("182,1,0.,0.,0.;"),
        e(SQUARE),
    ]);
    let found: Vec<_> = i.warnings.iter().map(ToString::to_string).collect();
    let wanted = [
        "t.igs:18: #1: blanked entity not drawn: type 128",
        "t.igs:20: #3: annotation not drawn: type 128",
        "t.igs:22: #5: construction not drawn: type 128",
        "t.igs:24: #7: no surface, not drawn: type 110, a curve or a point",
        "t.igs:25: #9: no surface, not drawn: type 108, an unbounded surface",
        "t.igs:26: #11: entity left out: type 182 form 0 is not supported (#11)",
    ];
    assert_eq!(found, wanted);
    assert_eq!(i.model.face_count(), 1);
}

#[test]
fn cards_of_every_shape() {
    let good = file(GLOBAL, &[e(SQUARE)]);
    let faces = |bytes: &[u8]| iges(bytes, "t.igs").map(|i| (i.model.face_count(), i.warnings.len())).unwrap();
    assert_eq!(faces(good.as_bytes()), (1, 0));
    assert_eq!(faces(good.replace('\n', "\r\n").as_bytes()), (1, 0));
    assert_eq!(faces(good.replace('\n', "").as_bytes()), (1, 0));
    assert_eq!(faces(good.replace('\n', "   \n\n").as_bytes()), (1, 0));
    let global = GLOBAL.replacen(",,", "1H||1H!|", 1).replace(',', "|").replace(';', "!");
    let delimited = file(&global, &[e(&SQUARE.replace(',', "|").replace(';', "!"))]);
    assert_eq!(faces(delimited.as_bytes()), (1, 0));
    let form = |tail: &str| iges(format!("{:<72}{tail}\n", "").as_bytes(), "t.igs").unwrap_err();
    assert!(matches!(form("C      1"), ImportError::IgesForm { form: "compressed ASCII", .. }));
    assert!(matches!(form("B      1"), ImportError::IgesForm { form: "binary", .. }));
    assert!(matches!(form("X      1"), ImportError::NotIges { .. }));
    assert!(matches!(form("S      1"), ImportError::NoDirectory { line: 1, .. }));
}

/// A product's name in the file's own encoding: six bytes are two characters, and columns count bytes.
#[test]
fn names_in_chinese() {
    let (name, other) = ("齿轮箱", "箱外壳零件总成右侧支架");
    let [raw, more] = [name, other].map(|words| encoding_rs::GB18030.encode(words).0.into_owned());
    assert_eq!((raw.len(), more.len()), (6, 22));
    let global = super::GLOBAL.replace("4Hpart", "6H######").replace("5Ht.igs", "22H@@@@@@@@@@@@@@@@@@@@@@");
    let text = super::file(&global, &[e(SQUARE)]).into_bytes();
    let put = |text: &[u8], mark: u8, with: &[u8]| {
        let at = text.iter().position(|b| *b == mark).unwrap();
        assert!(text[at..at + with.len()].iter().all(|b| *b == mark));
        [&text[..at], with, &text[at + with.len()..]].concat()
    };
    let bytes = put(&put(&text, b'#', &raw), b'@', &more);
    let import = crate::import::iges(&bytes, "t.igs").unwrap();
    assert_eq!(import.model.name, name);
    assert_eq!(import.warnings[0].to_string(), "t.igs: text: it is not UTF-8: read as GBK");
    let wide: Vec<u8> = String::from_utf8(text).unwrap().encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(crate::import::iges(&wide, "t.igs").unwrap().model.name, "######");
}
