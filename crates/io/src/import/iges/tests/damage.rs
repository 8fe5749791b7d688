//! Damaged files: never a panic, and a message that names what was lost and where.

use super::structure::CYLINDER;
use super::{Entity, GLOBAL, e, file, import};
use crate::import::damage::random::{self, Damage};
use crate::import::damage::{replaced, replaced_in_columns};
use crate::import::{ImportError, iges};
use proptest::prelude::*;

/// Every warning of the cylinder's file after a change of its text.
fn after(from: &str, to: &str) -> Vec<String> {
    let import = iges(replaced_in_columns(CYLINDER, from, to).as_bytes(), "c.igs").unwrap();
    assert_eq!(import.report.dropped.total(), import.report.faces - import.model.face_count());
    import.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn each_damage_names_what_it_costs() {
    let one = |from: &str, to: &str, wanted: &str| assert_eq!(after(from, to), [wanted], "{from} -> {to}");
    let side = |what: &str| format!("c.igs:68: #5: face left out: {what}");
    one("192,9,11,2.,13; ", "192,9,11,-2.,13;", &side("#7: parameter 3 is not a length above 0"));
    one("192,9,11,2.,13; ", "192,9,11,NaN,13;", &side("#7: parameter 3 is not a length above 0"));
    one("192,9,11,2.,13; ", "192,9,11,1E999;", &side("#7: parameter 3 is not a length above 0"));
    one("192,9,11,2.,13;", "192,2,11,2.,13;", &side("#2 does not exist"));
    one("192,9,11,2.,13;", "192,7,11,2.,13;", &side("#7 refers to itself"));
    one("192,9,11,2.,13;", "192,5,11,2.,13;", &side("#5 refers to itself"));
    one("192,9,11,2.,13;", "192,3,11,2.,13;", &side("#3 refers to itself"));
    one("192,9,11,2.,13;", "192,,11,2.,13;", &side("#7: parameter 1 is not a pointer"));
    one("192,9,11,2.,13;", "192,1.5,11,2.;", &side("#7: parameter 1 is not an integer"));
    one("192,9,11,2.,13; ", "192,11,11,2.,13;", &side("#11 is of type 123, not 116, a point"));
    one("510,7,1,1,15;", "510,7,9,1,15;", &side("#5: parameter 2 is not a count that its record can hold"));
    // entities that lost their owner have a warning too, after it
    let first = |from: &str, to: &str, wanted: &str| assert_eq!(after(from, to)[0], wanted, "{from} -> {to}");
    first("510,7,1,1,15;", "510,9,1,1,15;", &side("type 116 form 0 is not supported (#9)"));
    let body = |what: &str| format!("c.igs:66: #1: body left out: {what}");
    first("514,3,5,", "514,9,5,", &body("#3: parameter 1 is not a count that its record can hold"));
    first("514,3,5,", "514,x,5,", &body("#3: parameter 1 is not an integer"));
    first("186,3,1,0;", "186,5,1,0;", &body("#5 is of type 510, not 514, a shell"));
    let both = [
        "c.igs:67: #3: entity without its owner not drawn: type 514",
        "c.igs:66: #1: entity left out: #1 refers to itself",
    ];
    assert_eq!(after("186,3,1,0;", "186,1,1,0;"), both);
}

#[test]
fn damage_that_costs_several_faces() {
    let all = after("504,3,19,23,1,23,1,", "504,3,19,23,9,23,1,");
    assert_eq!(all.len(), 2, "{all:?}");
    assert!(all.iter().all(|w| w.ends_with("face left out: #23: the list has no vertex of that number")), "{all:?}");
    let all = after("502,2,2.,", "502,9,2.,");
    assert!(all.iter().all(|w| w.contains("#23: parameter 1 is not a count that its record can hold")), "{all:?}");
    assert_eq!(all.len(), 3);
}

#[test]
fn cards_that_are_missing_or_wrong() {
    let lines: Vec<&str> = CYLINDER.lines().collect();
    let without = |lost: usize| -> Vec<String> {
        let kept = lines.iter().enumerate().filter(|(i, _)| i + 1 != lost).map(|(_, l)| format!("{l}\n"));
        let import = iges(kept.collect::<String>().as_bytes(), "c.igs").unwrap();
        import.warnings.iter().map(ToString::to_string).collect()
    };
    assert_eq!(without(lines.len()), ["c.igs:96: file cut short: there is no terminate section"]);
    let second = without(11);
    assert_eq!(second[0], "c.igs:96: cards missing: 59 of 60 directory cards were found");
    assert_eq!(second[1], "c.igs:10: directory entry left out: #5 has one card instead of two");
    assert!(second.contains(&"c.igs: face left out: #5 does not exist".to_owned()), "{second:?}");
}

#[test]
fn damage_of_the_syntax() {
    let found = |text: &str| -> Vec<String> {
        let import = iges(text.as_bytes(), "t.igs").unwrap();
        import.warnings.iter().map(ToString::to_string).collect()
    };
    let good = file(GLOBAL, &[e("116,0.,0.,0.;"), e("116,1.,0.,0.;")]);
    let says = |from: &str, to: &str, wanted: &str| {
        let all = found(&replaced(&good, from, to));
        assert!(all.iter().any(|w| w == wanted), "{from} -> {to}: {all:#?}");
    };
    says(
        "116,0.,0.,0.;",
        "117,0.,0.,0.;",
        "t.igs:8: #1: entity without parameters: its parameters are of type 117, not of type 116",
    );
    says("116,0.,0.,0.;", "116,0.,0.,0. ", "t.igs:8: #1: record without end: no record delimiter on its cards");
    says("     116       2", "     116      92", "t.igs:6: #3: entity without parameters: card P92 does not exist");
    says(
        "     116       2",
        "     11x       2",
        "t.igs:6: directory entry left out: #3: its type \"11x\" is not an integer",
    );
    says("     116       2", "   99999       2", "t.igs:6: directory entry left out: #3: type 99999 does not exist");
    says("D      3", "D      1", "t.igs:6: directory entry left out: #1 has one card instead of two");
    says("P      1", "Q      1", "t.igs:8: card skipped: no section letter in column 73");
    says("D      2", "\u{fc}      2", "t.igs:5: card skipped: no section letter in column 73");
}

#[test]
fn a_file_that_is_mostly_no_cards_is_nonsense() {
    let good = file(GLOBAL, &[e("116,0.,0.,0.;")]);
    let cards = good.lines().count();
    let error = |bad: usize| iges((good.clone() + &"no card\n".repeat(bad)).as_bytes(), "t.igs").map(|i| i.warnings);
    assert!(error(999).is_ok());
    let wanted = ImportError::Nonsense { file: "t.igs".into(), line: cards + 1000, bad: 1000, seen: cards + 1000 };
    assert_eq!(error(3000).unwrap_err().to_string(), wanted.to_string());
}

/// Sixty entries, each of which claims the cards of all later ones and has no end of its own.
#[test]
fn claims_to_cards_are_bounded() {
    let all: Vec<Entity> = (0..60).map(|_| e("116,0.,0.,0. ")).collect();
    let text = file(GLOBAL, &all).replace("     116       0       0       1", "     116       0       0      60");
    let import = iges(text.as_bytes(), "t.igs").unwrap();
    let lost = import.warnings.iter().filter(|w| w.message.contains("cards are shared too often"));
    // four times the sixty cards: the first four entries have 60 + 59 + 58 + 57 of them, the fifth has the rest
    assert_eq!(lost.map(|w| w.count).sum::<usize>(), 55);
}

/// 2^40 squares from a few lines, and a subfigure that holds itself.
#[test]
fn subfigures_without_end() {
    let mut all = vec![e("110,0.,0.,0.,1.,0.,0.;")];
    for level in 0..40 {
        // 308 at 3 + 6 level holds two placements of the one before
        let (a, b, inner) = (5 + 6 * level, 7 + 6 * level, 3 + 6 * level - 6);
        let held =
            if level == 0 { "308,0,1Ha,0;".to_owned() } else { format!("308,{level},1Ha,2,{},{};", a - 6 + 6, b) };
        all.extend([
            e(&held),
            e(&format!("408,{},0.,0.,0.;", inner.max(3))),
            e(&format!("408,{},0.,0.,0.;", inner.max(3))),
        ]);
    }
    let import = import(&all);
    assert!(import.model.instances.len() <= 1 << 20);
    let own = super::import(&[e("308,0,1Ha,1,3;"), e("408,1,0.,0.,0.;"), e("408,1,0.,0.,0.;")]);
    assert!(own.warnings.iter().any(|w| w.message == "subfigure left out: #1 refers to itself"), "{:?}", own.warnings);
}

/// Thousands of subfigures, each in the next: they are followed to the limit, and a warning says that there are more.
#[test]
fn deep_subfigures_are_reported_as_deep() {
    let mut all = vec![e("308,0,1Ha,0;")];
    for level in 0..5000 {
        let definition = 1 + 4 * level;
        all.push(e(&format!("408,{definition},0.,0.,0.;")));
        all.push(e(&format!("308,0,1Ha,1,{};", definition + 2)));
    }
    all.push(e(&format!("408,{},0.,0.,0.;", 1 + 4 * 5000)));
    let deep = import(&all);
    let told = |w: &crate::import::Warning| w.message.contains("is nested deeper than 256 levels");
    assert!(deep.warnings.iter().any(told), "{:?}", deep.warnings);
}

/// A line: nothing to draw, and the summary names it.
#[test]
fn lines_are_reported() {
    let summary = import(&[e("110,0.,0.,0.,1.,0.,0.;")]).summary();
    assert_eq!(
        summary.to_string(),
        "nothing of it can be drawn; it holds 1 x no surface (type 110, a curve or a point)"
    );
}

/// Thousands of faces on one surface of many numbers: the work is cut off, not the program.
#[test]
fn sharing_is_bounded() {
    let mut text = "128,99,99,1,1,0,0,1,0,0".to_owned();
    for _ in 0..2 {
        (0..102).for_each(|k: i32| text += &format!(",{}.", (k - 1).clamp(0, 99)));
    }
    text += &",1.".repeat(10_000);
    (0..10_000).for_each(|i| text += &format!(",{}.,{}.,0.", i % 100, i / 100));
    text += ";";
    let mut all = vec![e(&text)];
    (0..200).for_each(|_| all.push(e("144,1,0,0;")));
    let import = import(&all);
    assert!(import.warnings.iter().any(|w| w.message.contains("shared so often")), "{:?}", import.warnings.last());
}

fn damage() -> impl Strategy<Value = Damage> {
    let words = [
        "NaN",
        "1E999",
        "-1",
        "0",
        "1",
        "7",
        "23",
        "1000000000",
        "99999999999999999999",
        "",
        "3Hx,y",
        "9H",
        "1e-320",
        "360.",
    ];
    random::damage(b",;HSGDPT \n\r", &words, None)
}

/// Whatever the damage: an error or a valid model, with a bounded number of warnings.
fn sound_when(mut text: Vec<u8>, list: &[Damage]) {
    list.iter().for_each(|d| d.apply(&mut text));
    if let Ok(import) = iges(&text, "t.igs") {
        random::assert_sound(&import);
    }
}

/// Found by random damage.
#[test]
fn a_byte_and_a_number() {
    let damage =
        [Damage::Byte(2_658_311_982_870_046_897, 0), Damage::Number(4_048_638_073_093_488_114, "NaN".to_owned())];
    sound_when(CYLINDER.as_bytes().to_vec(), &damage);
}

/// Every kind of entity once, whether or not anything uses it.
fn zoo() -> Vec<u8> {
    let texts = [
        "110,0.,0.,0.,1.,0.,0.;",
        "100,0.,0.,0.,2.,0.,-2.,0.;",
        "120,1,3,0.,6.28318530717958;",
        "122,3,2.,0.,5.;",
        "118,1,3,0,0;",
        "104,1.,0.,4.,0.,0.,-4.,0.,2.,0.,0.,1.;",
        "106,1,3,1.,0.,0.,4.,0.,4.,3.;",
        "102,2,1,3;",
        "122,15,0.,0.,3.;",
        "130,3,1,0,3,0,0.5,0.,0.5,0.,0.,0.,1.,0.,3.;",
        "122,19,1.5,0.,5.;",
        "116,1.,0.,0.;",
        "196,23,2.;",
        "140,0.,0.,1.,0.5,25;",
        "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,0.,1.,0.,0.,0.,1.,0.,1.,1.,0.;",
        "100,0.,0.5,0.5,0.7,0.5,0.7,0.5;",
        "142,0,29,31,31,1;",
        "144,29,0,1,0,33;",
        "308,0,1Ha,1,35;",
        "408,37,1.,2.,3.,2.;",
        "314,10.,20.,30.;",
    ];
    let all: Vec<Entity> = texts.iter().map(|t| Entity { colour: -41, ..e(t) }).collect();
    file(GLOBAL, &all).into_bytes()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_damage_panics(solid in any::<bool>(), list in prop::collection::vec(damage(), 1..6)) {
        sound_when(if solid { CYLINDER.as_bytes().to_vec() } else { zoo() }, &list);
    }

    /// Arbitrary bytes in the parameters of an entity.
    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
        let mut text = file(GLOBAL, &[e(&format!("128{:60};", ","))]).into_bytes();
        let at = text.windows(4).position(|w| w == b"128,").unwrap_or(0) + 4;
        text.splice(at..at + bytes.len(), bytes).for_each(drop);
        let _ = iges(&text, "t.igs");
    }
}
