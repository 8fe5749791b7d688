//! The older text form, version 4: a record a line, its kind by the first letter.
//!
//! ```text
//!   I 0 v4                        unit of the screen, and version; the next line is the title
//!   S 18 rod 5 0 0 0 0 0 9 ...    solid: number of its kind, name, (unused), up to 24 numbers
//!   C Y all 1000 0 ...            combination: region or not, name, region's number, air, ...
//!   M u rod 1 0 0 0 ...           its members: operation, name, matrix
//!   m 0 60 99 80 100 255          colour of the regions 60 to 99
//! ```
//!
//! Members bind as in GIFT: `a - b u c + d` is `(a - b) u (c + d)`. Corners of an arb8 after its first are stated
//! relative to that one; radii of a torus are the lengths of two of its vectors. Lengths are millimetres, most of them
//! from single precision. Source: the converters `g2asc` and `asc2g` of BRL-CAD.

use super::object::{Combination, Database, Record, colour_of};
use super::tree::{Item, matrix};
use crate::csg::Op;
use crate::import::{ImportReport, Place, Warnings};
use glam::{DAffine3, DVec3};
use std::borrow::Cow;
use std::iter::Peekable;

/// Names of units by their number.
const UNITS: [&str; 10] = ["", "mm", "cm", "m", "in", "ft", "um", "km", "yd", "mi"];

/// Lines with their numbers.
type Lines<'a> = Peekable<Box<dyn Iterator<Item = (usize, &'a str)> + 'a>>;

/// Whether the first line that says anything is the one that such files begin with.
pub(super) fn recognise(text: &str) -> bool {
    let mut lines = text.lines().filter(|l| !l.trim().is_empty() && !l.starts_with('#'));
    let words: Vec<&str> = lines.next().unwrap_or_default().split_whitespace().collect();
    matches!(words[..], ["I", unit, version] if unit.parse::<u32>().is_ok() && version.starts_with('v'))
}

/// All objects. What is not read is left out, and a warning says so.
pub(super) fn read<'a>(text: &'a str, report: &mut ImportReport, warnings: &mut Warnings) -> Database<'a> {
    let mut database = Database::default();
    let numbered: Box<dyn Iterator<Item = (usize, &'a str)> + 'a> = Box::new((1..).zip(text.lines()));
    let mut lines = numbered.peekable();
    while let Some((line, text)) = lines.next() {
        let words: Vec<&str> = text.split_whitespace().collect();
        let Some(first) = words.first().filter(|w| !w.starts_with('#')) else { continue };
        let mut skipped = |why: &'static str| {
            warnings.push("record left out", || Place::Line(line), || text.chars().take(60).collect::<String>() + why);
        };
        match *first {
            "I" => {
                lines.next();
                let unit = words.get(1).and_then(|w| w.parse::<usize>().ok()).and_then(|u| UNITS.get(u));
                match unit {
                    Some(unit) => report.units.extend(Some((*unit).to_owned()).filter(|u| !u.is_empty())),
                    None => skipped(": not a number of a unit; lengths are millimetres"),
                }
            }
            "S" if words.len() > 4 => {
                let record = solid(line, &words);
                database.add(record, None, None, report, warnings);
            }
            "C" if words.len() >= 13 => combination(line, &words, &mut lines, &mut database, report, warnings),
            "m" => {
                let numbers = words[1..].iter().map(|w| w.parse().ok()).collect::<Option<Vec<f64>>>();
                match numbers.as_deref() {
                    Some(&[_, low, high, r, g, b]) => {
                        database.table.push((low as i64, high as i64, colour_of([r, g, b])));
                    }
                    _ => skipped(": not a colour of regions"),
                }
            }
            "p" if words.len() == 10 => {
                let fields = spread(&words[2..], &[("V", 3), ("H", 3), ("r_v", 1), ("r_h", 1)]);
                database.add(Record { line, name: words[1], kind: "part", fields }, None, None, report, warnings);
            }
            "w" if words.len() == 2 => {
                let fields = pipe(&mut lines);
                database.add(Record { line, name: words[1], kind: "pipe", fields }, None, None, report, warnings);
            }
            "t" if words.len() == 7 => {
                let fields = triangles(&words, &mut lines);
                database.add(Record { line, name: words[1], kind: "bot", fields }, None, None, report, warnings);
            }
            // a free place of the database
            "F" => {}
            letter => {
                let kind = match letter {
                    "A" => "ars",
                    "P" => "poly",
                    "b" => "bspline",
                    "c" => "cline",
                    "d" => "sketch",
                    "e" => "extrusion",
                    "n" => "arbn",
                    "N" => "nmg",
                    "s" => "string",
                    _ => "",
                };
                let name = words.get(if letter == "A" || letter == "s" || letter == "N" { 2 } else { 1 });
                match name.filter(|_| !kind.is_empty()) {
                    Some(name) => {
                        let record = Record { line, name, kind, fields: Vec::new() };
                        database.add(record, None, None, report, warnings);
                        skip_body(letter, &mut lines);
                    }
                    None => skipped(""),
                }
            }
        }
    }
    database
}

/// Lines that belong to a solid that is not read.
fn skip_body(letter: &str, lines: &mut Lines<'_>) {
    let own = match letter {
        "A" => "B",
        "P" => "Q",
        "b" => "D",
        "n" => "n",
        _ => "",
    };
    let belongs = |(_, text): &(usize, &str)| {
        let first = text.split_whitespace().next().unwrap_or_default();
        // an `n` line of an arbn that begins another has a name and a count, not four numbers
        let member = first == own && !own.is_empty() && (own != "n" || text.split_whitespace().count() == 5);
        member || text.starts_with([' ', '\t']) || first.starts_with(|c: char| c.is_ascii_digit() || c == '-')
    };
    while lines.next_if(belongs).is_some() {}
}

/// Numbers by the fields that they fill one after another.
fn spread<'a>(numbers: &[&'a str], layout: &[(&'a str, usize)]) -> Vec<(Cow<'a, str>, Cow<'a, str>)> {
    let mut rest = numbers;
    let mut fields = Vec::new();
    for &(key, count) in layout {
        let (own, after) = rest.split_at(count.min(rest.len()));
        fields.push((Cow::Borrowed(key), Cow::Owned(own.join(" "))));
        rest = after;
    }
    fields
}

fn solid<'a>(line: usize, words: &[&'a str]) -> Record<'a> {
    let (name, numbers) = (words[2], &words[4..]);
    let (kind, layout): (&str, &[(&str, usize)]) = match words[1] {
        "16" => return Record { line, name, kind: "tor", fields: torus(numbers) },
        "18" => ("tgc", &[("V", 3), ("H", 3), ("A", 3), ("B", 3), ("C", 3), ("D", 3)]),
        "19" => ("ell", &[("V", 3), ("A", 3), ("B", 3), ("C", 3)]),
        "20" => return Record { line, name, kind: "arb8", fields: corners(numbers) },
        "24" => ("half", &[("N", 3), ("d", 1)]),
        "26" => ("rpc", &[("V", 3), ("H", 3), ("B", 3), ("r", 1)]),
        "27" => ("rhc", &[("V", 3), ("H", 3), ("B", 3), ("r", 1), ("c", 1)]),
        "28" => ("epa", &[("V", 3), ("H", 3), ("A", 3), ("r_1", 1), ("r_2", 1)]),
        "29" => ("ehy", &[("V", 3), ("H", 3), ("A", 3), ("r_1", 1), ("r_2", 1), ("c", 1)]),
        "30" => ("eto", &[("V", 3), ("N", 3), ("C", 3), ("r", 1), ("r_d", 1)]),
        "33" => ("hyp", &[("V", 3), ("H", 3), ("A", 3), ("b", 1), ("bnr", 1)]),
        other => (other, &[]),
    };
    Record { line, name, kind, fields: spread(numbers, layout) }
}

/// Three numbers from place `at` on; NaN for what is none.
fn vector(numbers: &[&str], at: usize) -> DVec3 {
    let one = |i: usize| numbers.get(at + i).and_then(|w| w.parse().ok()).unwrap_or(f64::NAN);
    DVec3::new(one(0), one(1), one(2))
}

/// `{:?}` of a number is read back as the same number.
fn text(p: DVec3) -> Cow<'static, str> {
    Cow::Owned(format!("{:?} {:?} {:?}", p.x, p.y, p.z))
}

fn torus<'a>(numbers: &[&str]) -> Vec<(Cow<'a, str>, Cow<'a, str>)> {
    let [v, h, a] = [0, 3, 6].map(|at| vector(numbers, at));
    let length = |x: f64| Cow::Owned(format!("{x:?}"));
    // the tube's radius is the axis' length, and by rounding may exceed the other
    let (major, minor) = (a.length(), h.length().min(a.length()));
    let all = [("V", text(v)), ("H", text(h)), ("r_a", length(major)), ("r_h", length(minor))];
    all.map(|(k, value)| (Cow::Borrowed(k), value)).to_vec()
}

fn corners<'a>(numbers: &[&str]) -> Vec<(Cow<'a, str>, Cow<'a, str>)> {
    let first = vector(numbers, 0);
    let corner = |i: usize| if i == 0 { first } else { first + vector(numbers, 3 * i) };
    (0..8).map(|i| (Cow::Owned(format!("V{}", i + 1)), text(corner(i)))).collect()
}

/// Lines of inner and outer diameter, radius of the bend and place, until the pipe's end.
fn pipe<'a>(lines: &mut Lines<'a>) -> Vec<(Cow<'a, str>, Cow<'a, str>)> {
    let mut fields = Vec::new();
    let mut point = 0;
    while let Some((_, text)) = lines.next_if(|(_, text)| !text.starts_with("END_PIPE")) {
        let words: Vec<&str> = text.split_whitespace().collect();
        for (key, value) in spread(&words, &[("I", 1), ("O", 1), ("R", 1), ("V", 3)]) {
            fields.push((Cow::Owned(format!("{key}{point}")), value));
        }
        point += 1;
    }
    lines.next();
    fields
}

/// Vertices and triangles, each a line that begins with a tab and its number.
fn triangles<'a>(words: &[&'a str], lines: &mut Lines<'a>) -> Vec<(Cow<'a, str>, Cow<'a, str>)> {
    let count = |w: &str| w.parse::<usize>().unwrap_or(0);
    let mut block = |rows: usize| {
        let mut all = String::new();
        for _ in 0..rows {
            let Some((_, row)) = lines.next_if(|(_, text)| text.starts_with('\t')) else { break };
            let numbers = row.split_once(':').map_or("x", |(_, rest)| rest);
            all.extend(numbers.split_whitespace().take(3).flat_map(|w| [w, " "]));
        }
        all
    };
    let (vertices, faces) = (block(count(words[5])), block(count(words[6])));
    // thicknesses, and which side they are on
    while lines.next_if(|(_, text)| text.starts_with('\t')).is_some() {}
    let mode = ["", "surf", "volume", "plate", "plate_nocos"].get(count(words[2])).copied().unwrap_or_default();
    let orient = if words[3] == "3" { "lh" } else { "rh" };
    let all = [("mode", mode.into()), ("orient", orient.into()), ("V", vertices.into()), ("F", faces.into())];
    all.map(|(k, value)| (Cow::Borrowed(k), value)).to_vec()
}

fn combination<'a>(
    line: usize,
    words: &[&'a str],
    lines: &mut Lines<'a>,
    database: &mut Database<'a>,
    report: &mut ImportReport,
    warnings: &mut Warnings,
) {
    let number = |i: usize| words.get(i).and_then(|w| w.parse::<i64>().ok()).unwrap_or(0);
    let [name_follows, parameters_follow, holds] = [13, 14, 15].map(|i| number(i) != 0);
    for _ in 0..usize::from(name_follows) + usize::from(parameters_follow) {
        lines.next();
    }
    let region = matches!(words[1], "Y" | "R" | "P" | "V");
    let mut all = Combination { region, number: number(3), air: number(4) != 0, holds, ..Combination::default() };
    // what has been read since the last union, as one operand of it
    let mut terms = 0;
    while let Some((at, text)) = lines.next_if(|(_, text)| text.starts_with("M ")) {
        let words: Vec<&str> = text.split_whitespace().collect();
        let stated = match words.get(1) {
            Some(&"u") => Some(Op::Union),
            Some(&"-") => Some(Op::Difference),
            Some(&"+") => Some(Op::Intersection),
            _ => None,
        };
        // a member without its operation or place is missing; subtracted, it leaves nothing of the rest
        let known = words.get(3..19).and_then(matrix).filter(|_| stated.is_some());
        let (name, matrix) = known.map_or(("", DAffine3::IDENTITY), |m| (words[2], m));
        let op = stated.unwrap_or(Op::Difference);
        all.items.push(Item::Member { name, matrix, line: at });
        match op {
            _ if terms == 0 => terms = 1,
            Op::Union => terms += 1,
            other => all.items.push(Item::Pair(other)),
        }
        // the term that this union ends is joined to those before it
        if op == Op::Union && terms > 2 {
            let term = all.items.pop();
            all.items.push(Item::Pair(Op::Union));
            all.items.extend(term);
            terms = 2;
        }
    }
    all.items.extend((terms > 1).then_some(Item::Pair(Op::Union)));
    let colour = (number(9) != 0).then(|| colour_of([10, 11, 12].map(|i| number(i) as f64)));
    let record = Record { line, name: words[2], kind: "comb", fields: Vec::new() };
    database.add(record, Some(all), colour, report, warnings);
}
