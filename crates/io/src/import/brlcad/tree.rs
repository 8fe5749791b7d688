//! Expressions of combinations: nested lists to postfix order, in one pass without recursion.
//!
//! ```text
//!   - {u {l a} {l b}} {l c {1 0 0 5 ...}}    ──▶    a b u c(moved) -
//! ```

use super::Fault;
use crate::csg::Op;
use glam::{DAffine3, DMat3, DVec3};

/// One step of the expression.
#[derive(Debug, PartialEq)]
pub(super) enum Item<'a> {
    Member { name: &'a str, matrix: DAffine3, line: usize },
    Not,
    Pair(Op),
}

impl<'a> Item<'a> {
    /// The member's name.
    pub fn name(&self) -> Option<&'a str> {
        if let Self::Member { name, .. } = self { Some(name) } else { None }
    }
}

/// A list whose end has not come.
#[derive(Default)]
struct List<'a> {
    words: Vec<&'a str>,
    children: usize,
    /// From inner lists of numbers.
    matrix: Option<DAffine3>,
}

/// Parses what stands between the outermost braces.
pub(super) fn parse(text: &str, line: usize) -> Result<Vec<Item<'_>>, Fault> {
    let bad = |what: &str| Fault::new(line, format!("tree: {what}"));
    let mut items = Vec::new();
    let mut open = vec![List::default()];
    let mut rest = text;
    loop {
        rest = rest.trim_start();
        let end = rest.find(|c: char| c.is_whitespace() || c == '{' || c == '}').unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        if !word.is_empty() {
            open.last_mut().expect("the outermost list").words.push(word);
            rest = after;
            continue;
        }
        let sign = rest.bytes().next();
        rest = rest.get(1..).unwrap_or_default();
        if sign == Some(b'{') {
            open.push(List::default());
            continue;
        }
        let list = open.pop().expect("the outermost list");
        let parent = open.last_mut();
        if parent.is_some() == sign.is_none() {
            return Err(bad("braces do not match"));
        }
        let numbers = list.words.len() == 16 && list.words[0].parse::<f64>().is_ok();
        match parent {
            Some(parent) if numbers => parent.matrix = Some(matrix(&list.words).ok_or_else(|| bad("not a matrix"))?),
            Some(parent) => {
                items.push(item(&list, line)?);
                parent.children += 1;
            }
            None => {
                if !list.words.is_empty() {
                    items.push(item(&list, line)?);
                }
                return Ok(items);
            }
        }
    }
}

fn item<'a>(list: &List<'a>, line: usize) -> Result<Item<'a>, Fault> {
    let name = list.words.first().copied().unwrap_or_default();
    Ok(match (name, list.words.len(), list.children) {
        ("l", 2, 0) => Item::Member { name: list.words[1], matrix: list.matrix.unwrap_or(DAffine3::IDENTITY), line },
        ("u", 1, 2) => Item::Pair(Op::Union),
        ("n" | "+", 1, 2) => Item::Pair(Op::Intersection),
        ("-", 1, 2) => Item::Pair(Op::Difference),
        ("^", 1, 2) => Item::Pair(Op::SymmetricDifference),
        ("!", 1, 1) => Item::Not,
        _ => {
            let name: String = name.chars().take(40).collect();
            return Err(Fault::new(line, format!("tree: `{name}` with {} operands is not read", list.children)));
        }
    })
}

/// Sixteen words: the rows of a homogeneous matrix; `None` for one that is not affine.
pub(super) fn matrix(words: &[&str]) -> Option<DAffine3> {
    let all: Vec<f64> = words.iter().map(|w| w.parse().ok().filter(|x: &f64| x.is_finite())).collect::<Option<_>>()?;
    let w = all[15];
    // older databases have the rounding of single precision, here too
    if w == 0.0 || all[12..15].iter().any(|x| x.abs() > 1e-7 * w.abs()) {
        return None;
    }
    let column = |i: usize| DVec3::new(all[i], all[4 + i], all[8 + i]) / w;
    Some(DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) })
}
