//! Imports that a callback ends, for tests: what is done until then is counted, not timed.

use super::progress::BEAT;
use super::source::OtherFiles;
use super::{Options, Stage, Stop, Unwound, caught, iges, obj, step_with};
use std::fmt::Write;
use std::sync::{Mutex, PoisonError};

/// Ends an import when it tells a stage of this kind for the `times`-th time; returns all that it has told.
fn ended(read: impl FnOnce(&Options<'_>), is_it: fn(&Stage) -> bool, times: usize) -> Vec<Stage> {
    let (stop, told) = (Stop::default(), Mutex::new(Vec::new()));
    let tell = |stage: Stage| {
        {
            let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
            told.push(stage);
            if told.iter().filter(|stage| is_it(stage)).count() == times {
                stop.set();
            }
        }
        stop.check();
    };
    let end = caught(|| read(&Options { progress: Some(&tell), ..Options::default() }));
    assert!(matches!(end, Err(Unwound::Stopped)), "it was read to its end: {end:?}");
    told.into_inner().unwrap_or_else(PoisonError::into_inner)
}

fn is_parsing(stage: &Stage) -> bool {
    matches!(stage, Stage::Parse { .. })
}

/// One face whose surface has more control points than the work between two calls: the second call for its body comes
/// while they are looked up, before any face is built.
#[test]
fn a_body_of_step_is_ended_while_it_is_mapped() {
    const SIDE: usize = 300;
    const { assert!(SIDE * SIDE > BEAT as usize) };
    let mut text = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n".to_owned();
    let mut rows = Vec::with_capacity(SIDE);
    for row in 0..SIDE {
        let id = |column: usize| 10 + row * SIDE + column;
        for column in 0..SIDE {
            writeln!(text, "#{}=CARTESIAN_POINT('',({row}.,{column}.,0.));", id(column)).expect("memory");
        }
        let points: Vec<String> = (0..SIDE).map(|column| format!("#{}", id(column))).collect();
        rows.push(format!("({})", points.join(",")));
    }
    let knots = (0..SIDE).map(|k| format!("{k}.")).collect::<Vec<_>>().join(",");
    let multiplicities = format!("2{},2", ",1".repeat(SIDE - 2));
    let (rows, m, k) = (rows.join(","), multiplicities, knots);
    writeln!(
        text,
        "#2=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,({rows}),.UNSPECIFIED.,.F.,.F.,.F.,({m}),({m}),({k}),({k}),\
         .UNSPECIFIED.);"
    )
    .expect("memory");
    text += "#1=ADVANCED_FACE('',(),#2,.T.);\nENDSEC;\nEND-ISO-10303-21;\n";
    let read = |options: &Options<'_>| _ = step_with(text.as_bytes(), "net.step", options);
    let told = ended(read, |stage| matches!(stage, Stage::Bodies { .. }), 2);
    assert!(told.iter().all(|stage| !matches!(stage, Stage::Faces { .. })), "{told:?}");
    // the end of the text, and the records that are sorted by kind behind it
    let bytes = text.len() as u64;
    let sorted = told.iter().filter(|stage| **stage == Stage::Records { read: bytes, bytes }).count();
    assert!(sorted > SIDE * SIDE / BEAT as usize, "{sorted}");
}

/// Cards of the start section, which hold notes for people.
#[test]
fn iges_is_ended_while_its_cards_are_read() {
    let cards = (1..=2 * BEAT).map(|n| format!("{:<72}S{n:>7}\n", "note"));
    let text = cards.collect::<String>() + include_str!("iges/tests/cylinder.igs");
    ended(|options| _ = iges::read(text.as_bytes(), "long.igs", options), is_parsing, 2);
}

#[test]
fn obj_is_ended_between_its_lines() {
    let text = "v 0 0 0\n".repeat(2 * BEAT as usize);
    let read = |options: &Options<'_>| {
        _ = obj::read(text.as_bytes(), "long.obj", OtherFiles::new("long.obj", None, options));
    };
    ended(read, is_parsing, 2);
}

#[cfg(feature = "meshes")]
#[test]
fn stl_is_ended_between_its_triangles() {
    let count = 2 * BEAT as u32;
    let mut bytes = vec![0; 80];
    bytes.extend(count.to_le_bytes());
    bytes.resize(bytes.len() + 50 * count as usize, 0);
    let read = |options: &Options<'_>| {
        _ = super::read_mesh(&bytes, "t.stl", "stl", OtherFiles::new("t.stl", None, options));
    };
    ended(read, is_parsing, 2);
}
