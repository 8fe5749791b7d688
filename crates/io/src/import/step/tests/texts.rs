//! Names in encodings that no STEP file states.

use super::wrap;
use crate::import::{Import, step};

fn names(import: &Import) -> (String, String, Vec<String>) {
    let told = import.warnings.iter().map(ToString::to_string).collect();
    (import.model.name.clone(), import.model.parts[0].name.clone(), told)
}

#[test]
fn names_in_chinese_and_in_utf16() {
    let name = "海绵2".to_owned();
    let found = step(include_bytes!("cases/names_gb18030.stp"), "case.stp").unwrap();
    assert_eq!(
        names(&found),
        (name.clone(), name.clone(), vec!["case.stp: text: it is not UTF-8: read as GBK".into()])
    );
    assert_eq!(found.report.warnings["text"], 1);
    let found = step(include_bytes!("cases/names_utf16.stp"), "case.stp").unwrap();
    assert_eq!(names(&found), (name.clone(), name, vec![]));
    assert_eq!(found.report.faces, 6);
}

/// The second byte of a Shift-JIS character may be a backslash, which is no escape there.
#[test]
fn a_backslash_within_a_character_is_none() {
    let title = "表示能力ソ十の歯車ハウジング";
    let (raw, ..) = encoding_rs::SHIFT_JIS.encode(title);
    assert!(raw.contains(&b'\\'));
    let data = "#11=CARTESIAN_POINT('',(0.,0.,0.));#12=CARTESIAN_POINT('',(1.,0.,0.));#13=CARTESIAN_POINT('',(0.,1.,0.));\
        #14=POLY_LOOP('',(#11,#12,#13));#15=FACE_OUTER_BOUND('',#14,.T.);#16=FACE('',(#15));#17=OPEN_SHELL('',(#16));\
        #18=SHELL_BASED_SURFACE_MODEL('@',(#17));";
    let text = wrap(data);
    let (before, after) = text.split_once('@').unwrap();
    let found = step(&[before.as_bytes(), &raw, after.as_bytes()].concat(), "t.step").unwrap();
    assert_eq!(found.model.parts[0].name, title);
    assert_eq!(found.warnings[0].to_string(), "t.step: text: it is not UTF-8: read as Shift_JIS");
    // escapes go on working beside it
    let found = step(text.replace('@', "caf\\X\\E9 \\X2\\6D77\\X0\\").as_bytes(), "t.step").unwrap();
    assert_eq!(found.model.parts[0].name, "café 海");
}
