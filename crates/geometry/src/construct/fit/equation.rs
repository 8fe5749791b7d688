//! Surfaces written as three expressions in `u` and `v`.
//!
//! ```text
//!   "-r*cos(u)^2"  ──scan──▶  (-1)*2.5*cos(u)^2  ──fasteval──▶  compiled
//!        │  names: u, v, constants, functions; else an error with its column
//!        └─ signs: a minus binds looser than a power, as on paper
//! ```
//!
//! The crate `fasteval` parses, compiles and evaluates, with limits on length and depth. It binds a sign tighter than
//! a power (`-u^2` would be positive) and reads `2u` as two millionths; the scan in front rewrites signs, writes
//! numbers out and checks that operands and operators alternate.

use crate::construct::ConstructError;
use fasteval::{Compiler, Evaler, Instruction, Parser, Slab};
use glam::DVec3;

/// Longest expression, characters.
const LONGEST: usize = 2048;
/// Deepest nesting of parentheses: the parser recurses.
const DEEPEST: usize = 32;
/// A function of one number.
type Unary = fn(f64) -> f64;
/// Functions of one argument; those without a body are the crate's own.
const FUNCTIONS: &[(&str, Option<Unary>)] = &[
    ("abs", None),
    ("sin", None),
    ("cos", None),
    ("tan", None),
    ("asin", None),
    ("acos", None),
    ("atan", None),
    ("sinh", None),
    ("cosh", None),
    ("tanh", None),
    ("asinh", None),
    ("acosh", None),
    ("atanh", None),
    ("floor", None),
    ("ceil", None),
    ("sqrt", Some(f64::sqrt)),
    ("cbrt", Some(f64::cbrt)),
    ("exp", Some(f64::exp)),
    ("ln", Some(f64::ln)),
    ("log2", Some(f64::log2)),
    ("log10", Some(f64::log10)),
    ("signum", Some(f64::signum)),
    ("trunc", Some(f64::trunc)),
    ("fract", Some(f64::fract)),
];
/// Functions of two arguments.
const PAIRS: &[&str] = &["atan2", "min", "max"];
/// Constants of every expression.
const NUMBERS: &[(&str, f64)] =
    &[("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU), ("e", std::f64::consts::E)];

/// `(x(u, v), y(u, v), z(u, v))`, parsed.
///
/// Operators `+ - * / ^` (a power binds tighter than a sign; powers of powers need parentheses), parentheses, numbers
/// like `2`, `.5`, `1e-3`, constants `pi`, `tau`, `e` and the caller's own, functions of one argument `abs sin cos
/// tan asin acos atan sinh cosh tanh asinh acosh atanh floor ceil sqrt cbrt exp ln log2 log10 signum trunc fract` and
/// of two `atan2 min max`. At most 2048 characters each, nested at most 32 deep.
#[derive(Debug)]
pub struct Equation {
    parts: [Part; 3],
}

#[derive(Debug)]
struct Part {
    slab: Slab,
    program: Instruction,
}

impl Equation {
    /// Parses the expressions of `x`, `y` and `z`; `constants` may not be called `u` or `v`.
    ///
    /// # Errors
    /// [`ConstructError::Expression`] with the expression, the column (from 1) and the fault.
    pub fn parse(texts: [&str; 3], constants: &[(&str, f64)]) -> Result<Self, ConstructError> {
        let part = |text: &str, expression: &'static str| {
            Scan::new(text, constants)
                .and_then(Scan::run)
                .and_then(|plain| Part::new(&plain))
                .map_err(|(at, message)| ConstructError::Expression { expression, column: at + 1, message })
        };
        Ok(Self { parts: [part(texts[0], "x")?, part(texts[1], "y")?, part(texts[2], "z")?] })
    }

    /// The point at `(u, v)`; not a number where an expression has no value.
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        let [x, y, z] = &self.parts;
        DVec3::new(x.value(u, v), y.value(u, v), z.value(u, v))
    }
}

impl Part {
    /// `plain` is the scan's output; [`Part::value`] has a value for every name in it.
    fn new(plain: &str) -> Result<Self, Failure> {
        let mut parser = Parser::new();
        // the scan has set tighter limits, on the text before signs and numbers were written out
        (parser.expr_len_limit, parser.expr_depth_limit) = (usize::MAX, 4 * DEEPEST);
        let mut slab = Slab::with_capacity(2 * LONGEST);
        let parsed = parser.parse_noclear(plain, &mut slab.ps).map_err(|e| (0, e.to_string()))?;
        let program = parsed.from(&slab.ps).compile(&slab.ps, &mut slab.cs);
        Ok(Self { slab, program })
    }

    fn value(&self, u: f64, v: f64) -> f64 {
        let mut names = |name: &str, arguments: Vec<f64>| match (name, arguments.as_slice()) {
            ("u", []) => Some(u),
            ("v", []) => Some(v),
            (name, [x]) => FUNCTIONS.iter().find(|f| f.0 == name).and_then(|f| f.1).map(|f| f(*x)),
            ("atan2", [y, x]) => Some(y.atan2(*x)),
            _ => None,
        };
        self.program.eval(&self.slab, &mut names).unwrap_or(f64::NAN)
    }
}

type Failure = (usize, String);

/// One pass over the characters.
struct Scan<'a> {
    text: Vec<char>,
    at: usize,
    constants: &'a [(&'a str, f64)],
    out: String,
    /// The column of each open parenthesis, the number of arguments its function still needs, and whether the operand
    /// before was an exponent.
    open: Vec<(usize, usize, bool)>,
    /// The operand that comes or came is an exponent.
    exponent: bool,
}

impl<'a> Scan<'a> {
    fn new(text: &str, constants: &'a [(&'a str, f64)]) -> Result<Self, Failure> {
        let text: Vec<char> = text.chars().collect();
        if text.len() > LONGEST {
            return Err((LONGEST, format!("{} characters, but at most {LONGEST} are read", text.len())));
        }
        if let Some((name, _)) = constants.iter().find(|(name, value)| matches!(*name, "u" | "v") || !value.is_finite())
        {
            return Err((0, format!("`{name}` cannot be a constant: it is a parameter, or its value is not finite")));
        }
        Ok(Self { text, at: 0, constants, out: String::new(), open: Vec::new(), exponent: false })
    }

    fn run(mut self) -> Result<String, Failure> {
        loop {
            self.operand()?;
            if !self.operators()? {
                return Ok(self.out);
            }
        }
    }

    fn peek(&mut self) -> Option<char> {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn word(&mut self, belongs: impl Fn(char) -> bool) -> String {
        let start = self.at;
        while self.text.get(self.at).is_some_and(|c| belongs(*c)) {
            self.at += 1;
        }
        self.text[start..self.at].iter().collect()
    }

    /// Signs, opening parentheses and functions, up to a number or a name.
    fn operand(&mut self) -> Result<(), Failure> {
        loop {
            let c = self.peek();
            match c {
                Some('+' | '-') => self.signs(),
                Some('(') => self.parenthesis(1)?,
                Some(c) if c.is_ascii_digit() || c == '.' => return self.number(),
                Some(c) if c.is_alphabetic() || c == '_' => {
                    if self.name()? {
                        return Ok(());
                    }
                }
                Some(c) => return Err((self.at, format!("`{c}` where a number, a name or `(` is expected"))),
                None => return Err((self.at, "the expression ends where a number or a name is expected".to_owned())),
            }
        }
    }

    /// Signs in front of an operand: a factor of -1 that binds as a product.
    fn signs(&mut self) {
        let mut negative = false;
        while let Some(c @ ('+' | '-')) = self.peek() {
            negative ^= c == '-';
            self.at += 1;
        }
        if !negative {
            return;
        }
        if self.exponent {
            self.out.push('-'); // the exponent is the next number, name or parenthesis alone
        } else if self.out.ends_with('/') {
            self.out.push_str("(-1)/");
        } else {
            self.out.push_str("(-1)*");
        }
    }

    fn parenthesis(&mut self, arguments: usize) -> Result<(), Failure> {
        if self.open.len() == DEEPEST {
            return Err((self.at, format!("parentheses nested more than {DEEPEST} deep")));
        }
        self.open.push((self.at, arguments, self.exponent));
        self.exponent = false;
        self.at += 1;
        self.out.push('(');
        Ok(())
    }

    fn number(&mut self) -> Result<(), Failure> {
        let start = self.at;
        let mut digits = self.word(|c| c.is_ascii_digit() || c == '.');
        if self.text.get(self.at).is_some_and(|c| matches!(c, 'e' | 'E')) {
            let sign = self.text.get(self.at + 1).filter(|c| matches!(c, '+' | '-'));
            if self.text.get(self.at + 1 + usize::from(sign.is_some())).is_some_and(char::is_ascii_digit) {
                digits.push('e');
                digits.extend(sign);
                self.at += 1 + usize::from(sign.is_some());
                digits += &self.word(|c| c.is_ascii_digit());
            }
        }
        match digits.parse::<f64>() {
            Ok(x) if x.is_finite() => self.value(x),
            _ => return Err((start, format!("`{digits}` is not a finite number"))),
        }
        Ok(())
    }

    /// Plain decimals, which the parser reads exactly.
    fn value(&mut self, x: f64) {
        self.out += &if x < 0.0 { format!("(0-{})", -x) } else { format!("{x}") };
    }

    /// A name; false when it was a function, whose argument follows.
    fn name(&mut self) -> Result<bool, Failure> {
        let start = self.at;
        let name = self.word(|c| c.is_alphanumeric() || c == '_');
        let arguments = if FUNCTIONS.iter().any(|f| f.0 == name) {
            1
        } else if PAIRS.contains(&name.as_str()) {
            2
        } else {
            let own = self.constants.iter().chain(NUMBERS).find(|(n, _)| *n == name);
            match own {
                Some((_, x)) => self.value(*x),
                None if name == "u" || name == "v" => self.out += &name,
                None => return Err((start, format!("unknown name `{name}`"))),
            }
            return Ok(true);
        };
        if self.peek() != Some('(') {
            return Err((start, format!("`{name}` wants its argument in parentheses")));
        }
        self.out += &name;
        self.parenthesis(arguments)?;
        Ok(false)
    }

    /// Closing parentheses and the next operator; false at the end.
    fn operators(&mut self) -> Result<bool, Failure> {
        loop {
            let Some(c) = self.peek() else {
                return match self.open.last() {
                    Some((at, ..)) => Err((*at, "this parenthesis is not closed".to_owned())),
                    None => Ok(false),
                };
            };
            let at = self.at;
            match c {
                ')' => match self.open.pop() {
                    Some((_, 1, exponent)) => self.exponent = exponent,
                    Some((start, ..)) => return Err((start, "two arguments are wanted here".to_owned())),
                    None => return Err((at, "`)` without `(`".to_owned())),
                },
                ',' => {
                    match self.open.last_mut() {
                        Some((_, arguments @ 2, _)) => *arguments = 1,
                        _ => return Err((at, "`,` where no further argument is wanted".to_owned())),
                    }
                    self.exponent = false;
                }
                '^' if self.exponent => {
                    return Err((at, "a power of a power: write parentheses".to_owned()));
                }
                '+' | '-' | '*' | '/' | '^' => self.exponent = c == '^',
                _ => return Err((at, format!("`{c}` where an operator is expected"))),
            }
            self.out.push(c);
            self.at += 1;
            if c != ')' {
                return Ok(true);
            }
        }
    }
}

#[cfg(test)]
mod tests;
