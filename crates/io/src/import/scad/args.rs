//! Arguments of a node: named values, and how finely the node's curves are cut.
//!
//! ```text
//!   cylinder($fn = 0, $fa = 12, $fs = 2, h = 10, r1 = 5, r2 = 5, center = false)
//!            └─ segments ────────────┘   number("h")            flag("center")
//! ```

use super::lex::{Lexer, Token};
use super::{Fault, names};
use glam::DVec2;

/// A value; lists may nest [`MOST_NESTED`] deep.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Undefined,
    Flag(bool),
    Number(f64),
    /// Escapes undone.
    Text(String),
    List(Vec<Value>),
}

/// Depth of lists: points of a list of lists need 2.
const MOST_NESTED: usize = 16;

/// The arguments between a node's brackets, and its place.
#[derive(Debug)]
pub(super) struct Args<'a> {
    pub node: &'a str,
    pub line: usize,
    all: Vec<(Option<&'a str>, Value)>,
    /// What the node states and nothing uses.
    pub unknown: Vec<String>,
}

impl<'a> Args<'a> {
    /// Reads from after the opening bracket to the closing one.
    pub fn read(lexer: &mut Lexer<'a>, node: &'a str, line: usize) -> Result<Self, Fault> {
        let mut all = Vec::new();
        while !lexer.accept(b')')? {
            let (token, at) = lexer.take()?;
            let argument = match token {
                Token::Name(name) if lexer.accept(b'=')? => {
                    let (token, at) = lexer.take()?;
                    (Some(name), value(lexer, token, at, 0)?)
                }
                token => (None, value(lexer, token, at, 0)?),
            };
            all.push(argument);
            if !lexer.accept(b',')? && *lexer.peek()? != Token::Sign(b')') {
                let (found, at) = lexer.take()?;
                return Err(Fault::new(at, format!("`,` or `)` expected, not {}", found.name())));
            }
        }
        let unknown = names::settle(node, &mut all);
        Ok(Self { node, line, all, unknown })
    }

    /// Of no node.
    pub fn none() -> Self {
        Self { node: "", line: 1, all: Vec::new(), unknown: Vec::new() }
    }

    pub fn fault(&self, message: impl std::fmt::Display) -> Fault {
        Fault::new(self.line, format!("{}: {message}", self.node))
    }

    /// The value of a name; `undef` counts as absent.
    pub fn get(&self, name: &str) -> Option<&Value> {
        let found = self.all.iter().find(|(n, _)| *n == Some(name)).map(|(_, v)| v);
        found.filter(|v| **v != Value::Undefined)
    }

    /// A number, or the default where there is none.
    pub fn number(&self, name: &str, default: f64) -> Result<f64, Fault> {
        match self.get(name) {
            None => Ok(default),
            Some(Value::Number(x)) => Ok(*x),
            Some(_) => Err(self.fault(format!("`{name}` is not a number"))),
        }
    }

    pub fn flag(&self, name: &str) -> bool {
        matches!(self.get(name), Some(Value::Flag(true)))
    }

    /// A list of `N` numbers, or one number for all.
    pub fn vector<const N: usize>(&self, name: &str, default: f64) -> Result<[f64; N], Fault> {
        match self.get(name) {
            None => Ok([default; N]),
            Some(Value::Number(x)) => Ok([*x; N]),
            Some(v) => v.vector().ok_or_else(|| self.fault(format!("`{name}` is not {N} numbers"))),
        }
    }

    /// A list of points.
    pub fn points<const N: usize>(&self, name: &str) -> Result<Vec<[f64; N]>, Fault> {
        let Some(Value::List(list)) = self.get(name) else { return Ok(Vec::new()) };
        let points = list.iter().map(|v| v.vector().filter(|p: &[f64; N]| p.iter().all(|x| x.is_finite())));
        points
            .collect::<Option<_>>()
            .ok_or_else(|| self.fault(format!("`{name}` are not points of {N} finite numbers")))
    }

    /// Lists of indices below `count`; none where the name is absent.
    pub fn indices(&self, name: &str, count: usize) -> Result<Vec<Vec<u32>>, Fault> {
        let Some(Value::List(list)) = self.get(name) else { return Ok(Vec::new()) };
        let index = |v: &Value| match v {
            Value::Number(x) if *x >= 0.0 && *x < count as f64 && x.fract() == 0.0 => Some(*x as u32),
            _ => None,
        };
        let row = |v: &Value| if let Value::List(row) = v { row.iter().map(index).collect() } else { None };
        let rows: Option<_> = list.iter().map(row).collect();
        rows.ok_or_else(|| self.fault(format!("`{name}` are not lists of indices below {count}")))
    }

    /// The outlines of `polygon(points, paths)`.
    pub fn outlines(&self) -> Result<Vec<Vec<DVec2>>, Fault> {
        let points: Vec<DVec2> = self.points("points")?.into_iter().map(DVec2::from_array).collect();
        let paths = self.indices("paths", points.len())?;
        let along = |path: &Vec<u32>| path.iter().map(|i| points[*i as usize]).collect();
        Ok(if paths.is_empty() { vec![points.clone()] } else { paths.iter().map(along).collect() })
    }

    /// Radians about z at which a part of a turn of `angle` degrees starts; 0 for a whole turn.
    pub fn start(&self, angle: f64) -> Result<f64, Fault> {
        let start = self.number("start", 0.0)?;
        let part = angle.is_finite() && angle.abs() < 360.0;
        Ok(if part && start.is_finite() { start.to_radians() } else { 0.0 })
    }

    /// `$fn`, or 0 without it.
    pub fn fragments(&self) -> f64 {
        self.number("$fn", 0.0).unwrap_or(0.0)
    }

    /// Segments of a circle, as OpenSCAD counts them: `$fn`, or as few as `$fa` degrees and `$fs` units allow.
    pub fn segments(&self, radius: f64) -> f64 {
        let (angle, length) = (self.number("$fa", 12.0).unwrap_or(12.0), self.number("$fs", 2.0).unwrap_or(2.0));
        let fixed = self.fragments();
        if fixed > 0.0 {
            return fixed.max(3.0).ceil();
        }
        (360.0 / angle.max(0.01)).min(std::f64::consts::TAU * radius / length.max(0.01)).max(5.0).ceil()
    }
}

impl Value {
    pub fn vector<const N: usize>(&self) -> Option<[f64; N]> {
        let Self::List(list) = self else { return None };
        let number = |v: &Value| if let Value::Number(x) = v { Some(*x) } else { None };
        list.iter().map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
    }
}

/// A text with OpenSCAD's escapes resolved; other escapes stay.
fn unescaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        let escape = (c == '\\').then(|| rest.clone().next()).flatten();
        let meant = match escape {
            Some('n') => '\n',
            Some('t') => '\t',
            Some('r') => '\r',
            Some(c @ ('"' | '\\')) => c,
            _ => {
                plain.push(c);
                continue;
            }
        };
        rest.next();
        plain.push(meant);
    }
    plain
}

/// The value that begins with `token`.
fn value<'a>(lexer: &mut Lexer<'a>, token: Token<'a>, line: usize, depth: usize) -> Result<Value, Fault> {
    Ok(match token {
        Token::Number(x) => Value::Number(x),
        Token::Text(text) => Value::Text(unescaped(text)),
        Token::Name("true") => Value::Flag(true),
        Token::Name("false") => Value::Flag(false),
        Token::Name("undef") => Value::Undefined,
        Token::Name("inf") => Value::Number(f64::INFINITY),
        Token::Name("nan") => Value::Number(f64::NAN),
        Token::Sign(b'[') if depth >= MOST_NESTED => {
            return Err(Fault::new(line, format!("lists nested more than {MOST_NESTED} deep")));
        }
        Token::Sign(b'[') => {
            let mut list = Vec::new();
            while !lexer.accept(b']')? {
                let (token, line) = lexer.take()?;
                list.push(value(lexer, token, line, depth + 1)?);
                if !lexer.accept(b',')? && *lexer.peek()? != Token::Sign(b']') {
                    let (found, at) = lexer.take()?;
                    return Err(Fault::new(at, format!("`,` or `]` expected, not {}", found.name())));
                }
            }
            Value::List(list)
        }
        other => return Err(Fault::new(line, format!("a value expected, not {}", other.name()))),
    })
}
