//! Damaged files: never a panic, and a warning that names what was lost.

use super::{import, wrap};
use crate::import::damage::random::{self, Damage};
use crate::import::damage::replaced;
use crate::import::{Import, step};
use crate::model::SurfaceKind;
use proptest::prelude::*;

/// A cylinder with a hole of a rational spline edge, coloured and placed twice: a little of everything.
pub(super) const GOOD: &str = include_str!("good.step");

#[test]
fn the_good_file_is_good() {
    let import = step(GOOD.as_bytes(), "good.step").unwrap();
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    assert_eq!((import.report.faces, import.model.instances.len()), (3, 2));
    assert_eq!((import.report.edges, import.report.bodies), (3, 1));
    let records = &import.report.face_records;
    let kinds: Vec<_> = records.iter().map(|r| (r.id, r.kind.unwrap(), r.degree, r.loops)).collect();
    let (disc, wall) = (SurfaceKind::Plane, SurfaceKind::Cylinder);
    assert_eq!(kinds, [(61, wall, [2, 1], 1), (62, disc, [1, 1], 1), (63, disc, [1, 1], 1)]);
    // coordinates of a few hundred millimetres: nothing but rounding
    assert!(records.iter().all(|r| r.deviation < 1e-12 && r.gap < 1e-12 && r.notes.is_empty()), "{records:#?}");
    assert_eq!(import.report.sloppy, 0);
}

/// Loses exactly the named face; `#lost` and `reason` stand in the warning.
fn loses(from: &str, to: &str, lost: u32, reason: &str) {
    let import = step(replaced(GOOD, from, to).as_bytes(), "good.step").unwrap();
    let found: Vec<String> = import.warnings.iter().map(ToString::to_string).collect();
    let named = |w: &String| w.contains(&format!(" #{lost}: face left out: ")) && w.contains(reason);
    assert!(found.iter().any(named), "{from} -> {to}: {found:#?}");
    assert_eq!(import.report.dropped.total(), import.report.warnings["face left out"]);
    assert!(import.model.face_count() < 3);
    let record = import.report.face_records.iter().find(|r| r.id == lost).unwrap();
    assert!(record.kind.is_none() && record.notes[0].contains(reason), "{record:?}");
}

#[test]
fn each_damage_names_its_face() {
    loses("CYLINDRICAL_SURFACE('',#24,5.)", "CYLINDRICAL_SURFACE('',#24,0.)", 61, "#43: attribute 2");
    loses("CYLINDRICAL_SURFACE('',#24,5.)", "CYLINDRICAL_SURFACE('',#43,5.)", 61, "#43");
    loses("CYLINDRICAL_SURFACE('',#24,5.)", "BLOB_SURFACE('',#24,5.)", 61, "BLOB_SURFACE is not supported");
    loses("#10=CARTESIAN_POINT('',(5.,0.,0.))", "#10=CARTESIAN_POINT('',(NaN,0.,0.))", 61, "#10: a coordinate");
    loses("EDGE_LOOP('',(#51,#52", "EDGE_LOOP('',(#51,#999", 61, "#999 does not exist");
    loses("EDGE_LOOP('',(#54))", "EDGE_LOOP('',())", 62, "#57: the loop has no edge");
    loses("PLANE('',#24)", "OFFSET_SURFACE('',#44,1.,.F.)", 62, "#44 refers to itself");
    loses("(#58),#44", "(),#44", 62, "");
}

/// The good file without what matches, and its warnings.
fn without(records: &[u32], cut_before: Option<u32>) -> (Import, Vec<String>) {
    let named = |line: &str, id: u32| line.starts_with(&format!("#{id}="));
    let lines = GOOD.lines().take_while(|line| cut_before.is_none_or(|id| !named(line, id)));
    let kept: Vec<&str> = lines.filter(|line| !records.iter().any(|id| named(line, *id))).collect();
    let import = step(kept.join("\n").as_bytes(), "good.step").unwrap();
    let told = import.warnings.iter().map(ToString::to_string).collect();
    (import, told)
}

#[test]
fn what_a_cut_file_still_holds_is_drawn() {
    let truncated = |line: usize| format!("good.step:{line}: truncated: the file ends without END-ISO-10303-21");
    // one face of the shell is gone: the others stay
    let (import, told) = without(&[63], None);
    assert_eq!(told, ["good.step: face left out: #63 does not exist"]);
    assert_eq!((import.model.face_count(), import.model.instances.len()), (2, 2));
    // an entry of the shell that is no reference: its face is unlisted, and a group of its own, by its number
    let import = step(GOOD.replace("(#61,#62,#63)", "(#61,$,#63)").as_bytes(), "good.step").unwrap();
    let told: Vec<_> = import.warnings.iter().map(ToString::to_string).collect();
    let expected = [
        "good.step:58: #62: face without shell: 1 of them are drawn as one open shell",
        "good.step:60: #64: face left out: #64: attribute 1 is not a list of references",
    ];
    assert_eq!(told, expected);
    assert_eq!(import.model.parts.iter().map(|p| p.faces.len()).collect::<Vec<_>>(), [1, 2]);
    // the solid and its placement are gone
    let (import, told) = without(&[], Some(65));
    let expected = "good.step:60: #64: shell without body: drawn with the file's first units";
    assert_eq!(told, [truncated(60), expected.into()]);
    assert_eq!((import.model.face_count(), import.model.instances.len()), (3, 1));
    // the shell, too
    let (import, told) = without(&[], Some(64));
    let expected = "good.step:57: #61: face without shell: 3 of them are drawn as one open shell";
    assert_eq!(told, [truncated(59), expected.into()]);
    assert_eq!((import.model.parts.len(), import.model.face_count(), import.report.edges), (1, 3, 3));
    assert!(!import.model.parts[0].closed);
    // only the shell
    let (import, told) = without(&[64], None);
    let expected = ["good.step:60: #65: body left out: #64 does not exist", expected];
    assert_eq!(told, [expected[1], expected[0]]);
    assert_eq!(import.model.face_count(), 3);
}

/// A solid that lacks a face bounds nothing, however the face was lost: it has no volume, no caps, no inside.
#[test]
fn a_solid_without_all_its_faces_is_not_closed() {
    let hidden =
        |id: u32| replaced(GOOD, "\nENDSEC;\nEND-ISO", &format!("\n#999=INVISIBILITY((#{id}));\nENDSEC;\nEND-ISO"));
    let voids =
        |list: &str| replaced(GOOD, "MANIFOLD_SOLID_BREP('can',#64)", &format!("BREP_WITH_VOIDS('can',#64,({list}))"));
    for (text, faces, closed) in [
        (GOOD.to_owned(), 3, true),
        // not to be found, not to be mapped, not to be built, hidden
        (replaced(GOOD, "(#61,#62,#63)", "(#61,#62,#998)"), 2, false),
        (replaced(GOOD, "CYLINDRICAL_SURFACE('',#24,5.)", "CYLINDRICAL_SURFACE('',#24,0.)"), 2, false),
        (replaced(GOOD, "#57=EDGE_LOOP('',(#54))", "#57=EDGE_LOOP('',(#52))"), 2, false),
        (hidden(62), 2, false),
        (hidden(998), 3, true),
        (voids(""), 3, true),
        (voids("#998"), 3, false),
    ] {
        let import = step(text.as_bytes(), "good.step").unwrap();
        let solid = import.model.parts.iter().find(|part| part.faces.len() > 1).unwrap();
        assert_eq!((solid.faces.len(), solid.closed), (faces, closed), "{:?}", import.warnings);
    }
}

/// A fourth face of the can, collapsed to a line or to a point, whose loop is one spline: what lacks it has no gap. The
/// same with a neighbour that is lost as a whole.
#[test]
fn a_collapsed_face_within_one_spline_leaves_its_solid_closed() {
    let with = |tip: &str, damage: &[&str; 2]| {
        let more = format!(
            "#700=DIRECTION('',(0.,1.,0.));#701=AXIS2_PLACEMENT_3D('',#12,#700,#22);#702=PLANE('',#701);\
             #703=B_SPLINE_CURVE_WITH_KNOTS('',1,(#10,{tip},#10),.UNSPECIFIED.,.T.,.F.,(2,1,2),(0.,1.,2.),$);\
             #704=EDGE_CURVE('',#40,#40,#703,.T.);#705=ORIENTED_EDGE('',*,*,#704,.T.);#706=EDGE_LOOP('',(#705));\
             #707=FACE_OUTER_BOUND('',#706,.T.);#708=ADVANCED_FACE('',(#707),#702,.T.);\nENDSEC;\nEND-ISO"
        );
        let text = replaced(GOOD, "\nENDSEC;\nEND-ISO", &format!("\n{more}"));
        let text = replaced(&text, "(#61,#62,#63)", "(#61,#62,#63,#708)");
        step(replaced(&text, damage[0], damage[1]).as_bytes(), "good.step").unwrap()
    };
    let lost = |import: &Import| {
        let told = import.warnings.iter().map(ToString::to_string).filter(|w| w.contains("face left out"));
        let solid = import.model.parts.iter().find(|part| part.faces.len() > 1).unwrap();
        (solid.faces.len(), solid.closed, told.collect::<Vec<_>>())
    };
    let whole = ["CYLINDRICAL_SURFACE('',#24,5.)"; 2];
    for tip in ["#11", "#10"] {
        let (faces, closed, told) = lost(&with(tip, &whole));
        assert_eq!((faces, closed, told.len()), (3, true, 1), "{told:?}");
        assert!(told[0].contains("#708"), "{told:?}");
        let neighbours =
            [[whole[0], "CYLINDRICAL_SURFACE('',#24,0.)"], ["#57=EDGE_LOOP('',(#54))", "#57=EDGE_LOOP('',(#52))"]];
        for (neighbour, id) in neighbours.iter().zip(["#61", "#62"]) {
            let (faces, closed, told) = lost(&with(tip, neighbour));
            assert_eq!((faces, closed, told.len()), (2, false, 2), "{told:?}");
            assert!(told.iter().any(|w| w.contains(id)), "{told:?}");
        }
    }
}

/// Surfaces of one spline shared by every face of a shell: the work is cut off, not the program.
#[test]
fn sharing_is_bounded() {
    let net = "#7,".repeat(2000);
    let curve = format!("#7=CARTESIAN_POINT('',(0.,0.,0.));#8=POLYLINE('',({net}#7));#9=VERTEX_POINT('',#7);");
    let mut data = curve;
    for i in 0..5000 {
        let id = 100 + i;
        data += &format!("#{id}=EDGE_CURVE('',#9,#9,#8,.T.);");
    }
    let edges: String = (0..5000).map(|i| format!("#{},", 100 + i)).collect();
    data += &format!(
        "#20=EDGE_LOOP('',({edges}));#21=FACE_BOUND('',#20,.T.);#22=ADVANCED_FACE('',(#21),#23,.T.);\
        #23=SPHERICAL_SURFACE('',#24,1.);#24=AXIS2_PLACEMENT_3D('',#7,$,$);#25=CLOSED_SHELL('',(#22));#26=MANIFOLD_SOLID_BREP('',#25);"
    );
    let import = import(&data);
    assert!(import.warnings.iter().any(|w| w.message.contains("shared so often")), "{:?}", import.warnings);
}

#[test]
fn a_solid_whose_shell_is_itself() {
    let import = import("#1=MANIFOLD_SOLID_BREP('',#2);#2=ORIENTED_CLOSED_SHELL('',*,#2,.T.);");
    assert_eq!(import.model.face_count(), 0);
    assert!(import.warnings.iter().any(|w| w.message.contains("#2 refers to itself")), "{:?}", import.warnings);
}

fn damage() -> impl Strategy<Value = Damage> {
    let words =
        ["NaN", "1E999", "-1", "0", "1000000000", "99999999999999999999", "$", "*", "()", "'x'", ".T.", "1e-320"];
    random::damage(b";(),#*$./&", &words, Some(110))
}

/// Whatever the damage: an error or a valid model, with a bounded number of warnings.
fn sound_when(list: &[Damage]) {
    let mut text = GOOD.as_bytes().to_vec();
    list.iter().for_each(|d| d.apply(&mut text));
    let Ok(import) = step(&text, "t.step") else { return };
    random::assert_sound(&import);
    // a warning of one loss states its whole reason
    for (why, _) in import.report.dropped.iter().filter(|(_, count)| *count == 1) {
        assert!(import.warnings.iter().any(|w| w.message.contains(&why)), "{why}: {:?}", import.warnings);
    }
}

/// Found by random damage.
#[test]
fn bytes_that_are_missing() {
    sound_when(&[Damage::Remove(2_623_484_653_231_844_243, 56)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_damage_panics(list in prop::collection::vec(damage(), 1..6)) {
        sound_when(&list);
    }

    /// Arbitrary bytes behind a valid start.
    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let mut text = wrap("").into_bytes();
        let at = text.windows(5).position(|w| w == b"DATA;").unwrap_or(0) + 5;
        text.splice(at..at, bytes).for_each(drop);
        let _ = step(&text, "t.step");
    }
}

/// Found by fuzzing: edges farther off their flat face than it is wide leave pre-images that no curve
/// follows well. The number of trim curves and the work for them stay bounded.
#[test]
fn edges_far_off_their_surface_end() {
    let import = step(include_bytes!("far_edges.step"), "far_edges.step").unwrap();
    let record = &import.report.face_records[0];
    assert!(record.gap > 9.0 && record.curves < 4 * 2048, "{record:?}");
    assert!(record.notes.iter().any(|n| n.contains("its edges are followed loosely")), "{record:?}");
}
