//! Damaged text: never a panic, and a warning that names what was lost.

use super::{import, told};
use crate::import::damage::random::assert_sound;
use crate::import::damage::replaced;
use crate::import::obj;
use proptest::prelude::*;

const SPEC: &str = include_str!("spec.obj");

/// The example loses its face; `why` stands in the warning, with its line.
#[track_caller]
fn loses(from: &str, to: &str, why: &str) {
    let read = import(&replaced(SPEC, from, to));
    let told = told(&read);
    assert!(
        told.iter().any(|w| w.starts_with("t.obj:") && w.contains("face left out") && w.contains(why)),
        "{told:#?}"
    );
    assert_eq!(read.report.dropped.total(), 1);
    assert_eq!((read.report.faces, read.model.face_count()), (1, 0));
}

#[test]
fn each_damage_names_the_face() {
    loses("deg 2 2", "deg 2 0", "t.obj:32: face left out: parm v: degree 0");
    loses("deg 2 2", "deg 99999999 2", "parm u: degree 99999999 is not");
    loses("deg 2 2", "deg 3 2", "parm u: too few knots for the degree");
    loses("rat bspline", "rat blobs", "no cstype that is known");
    loses("parm u -1.00 -1.00", "parm u", "t.obj:32: face left out: parm u: too few knots for the degree");
    loses("parm u -1.00 -1.00 -1.00", "parm u", "t.obj:32: face left out: parm u: too few knots for the degree");
    loses("parm u -1.00 -1.00 -1.00 2.50", "parm u -1 -1 2.6 2.5", "is smaller than the one before");
    loses("parm v -2.00", "parm w -2.00", "t.obj:34: face left out: neither u nor v");
    loses("surf -1.0 2.5", "surf nan 2.5", "no finite numbers: nan 2.5");
    loses("surf -1.0 2.5", "surf 7 9", "range 7 9 outside the domain -1 2.5");
    loses("-9 -8 -7", "-10 -8 -7", "vertex -10 of 9");
    loses("-9 -8 -7", "0 -8 -7", "vertex 0 of 9");
    loses("-9 -8 -7", "x -8 -7", "vertex x is no whole number");
    loses("v  0.130 -1.030", "v inf 0", "control point 1 has a coordinate that is not finite");
    loses(" -9 -8", "", "7 control points where parm asks for 9");
    loses("0.500\n", "-0.5\n", "trim curve 1 could not be built");
    loses("trim 0.0 2.0 1", "trim 0.0 2.0 3", "curve 3 of 2");
    loses("trim 0.0 2.0 1", "trim 0.0 2.0", "2 words, which are no triples");
    loses("trim 0.0 2.0 1", "trim 5 6 1", "trim curve 1 has no part from 5 to 6");
    loses("trim 0.0 2.0 1", "trim 0.0 1.0 1", "trim loop is open by");
    loses("trim 0.0 2.0 1", "trim 0 1 1 1 0 1", "a trim loop without area");
}

#[test]
fn each_damage_names_the_polygon() {
    let head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 x 0\nv 0 0\nvn 0 0\nvn 0 0 1\n";
    let lost = |face: &str, why: &str| {
        let read = import(&format!("{head}f 1 2 3\n{face}\n"));
        let told = told(&read);
        let first = [
            "t.obj:4: vertex not read: v 1 x 0",
            "t.obj:5: vertex not read: v 0 0",
            "t.obj:6: normal not read: vn 0 0",
        ];
        assert_eq!(told[..3], first);
        assert_eq!(told[3..], [format!("t.obj:9: {why}")]);
        read.model.parts[0].meshes[0].triangles().len()
    };
    assert_eq!(lost("f 1 2 4", "polygon left out: vertex 4 could not be read"), 1);
    assert_eq!(lost("f 1 2 9", "polygon left out: vertex 9 of 5"), 1);
    assert_eq!(lost("f 1 2 -6", "polygon left out: vertex -6 of 5"), 1);
    assert_eq!(
        lost("f 1 2 99999999999999999999", "polygon left out: vertex 99999999999999999999 is no whole number"),
        1
    );
    assert_eq!(lost("f 1 2", "polygon left out: 2 corners"), 1);
    assert_eq!(lost(&format!("f{}", " 1".repeat(10_001)), "polygon left out: 10001 corners, more than 10000"), 1);
    assert_eq!(lost("f 1//1 2//2 3//2", "normals not used: f 1//1 2//2 3//2"), 2);
    assert_eq!(lost("f 1//7 2//2 3//2", "normals not used: f 1//7 2//2 3//2"), 2);
}

/// One long curve named by every loop: the work is cut off, not the program.
#[test]
fn sharing_is_bounded() {
    let count = 20_000;
    let knots: String = (0..count).map(|i| format!(" {i}")).collect();
    let trims = "trim 0 1 1\n".repeat(20_000);
    let text = format!(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvp 0 0\ncstype bezier\ndeg 1 1\ncurv2{}\nparm u{knots}\nend\n\
        surf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\n{trims}end\n",
        " 1".repeat(count)
    );
    let read = import(&text.replace("trim 0 1 1", &format!("trim 0 {count} 1")));
    assert!(told(&read).iter().any(|w| w.contains("face left out")), "{:?}", told(&read));
}

#[test]
fn what_is_no_obj() {
    for text in ["", "hello", "f 1 2 3", "\0\0\0\0"] {
        let error = obj(text.as_bytes(), "t.obj", None).unwrap_err();
        assert_eq!(error.to_string(), "t.obj: holds nothing that is Wavefront OBJ");
    }
}

fn damage() -> impl Strategy<Value = (usize, &'static str)> {
    let words = [
        "nan",
        "1e999",
        "-1",
        "0",
        "1000000000",
        "99999999999999999999",
        "x",
        "",
        "\\\n",
        "\n",
        "end\n",
        "f",
        "surf",
        "u",
    ];
    (any::<usize>(), prop::sample::select(words.to_vec()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Whatever the damage: an error or a valid model, soon.
    #[test]
    fn no_damage_panics(list in prop::collection::vec(damage(), 1..6), cut in prop::option::of(any::<usize>())) {
        let text = format!("{SPEC}f 1 2 3 4\nvn 0 0 1\nf 1//1 5//1 9//1 7//1 8//1\n");
        let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
        for (at, word) in list {
            let at = at % words.len();
            words[at] = word;
        }
        let mut text = words.join(" ");
        if let Some(cut) = cut {
            text.truncate(cut % text.len());
        }
        if let Ok(read) = obj(text.as_bytes(), "t.obj", None) {
            assert_sound(&read);
            prop_assert!(read.model.bounds().is_empty() || read.model.bounds().diagonal().is_finite());
        }
    }

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut text = SPEC.as_bytes().to_vec();
        text.extend(bytes);
        let _ = obj(&text, "t.obj", None);
    }
}
