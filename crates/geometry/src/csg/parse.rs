//! Expressions as people write them: `(A+B)-(CD-E)`.
//!
//! ```text
//!   !A          complement, binds tightest        A+B   union                ╮ from the left,
//!   AB  A*B     intersection                      A-B   difference           ├ looser than the
//!                                                 A^B   symmetric difference ╯ intersection
//! ```
//!
//! A name is a letter and the digits after it (`A`, `B12`); blanks separate nothing. Two stacks and no
//! recursion (E. W. Dijkstra's shunting yard, 1961): the depth of brackets is bounded by memory alone.

use super::tree::{Builder, Op, Tree, TreeError};
use std::collections::HashMap;

/// A tree and the names of its primitives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expression {
    /// Leaves are indices into `names`.
    pub tree: Tree,
    /// Names in the order of their first use.
    pub names: Vec<String>,
}

/// Why a text is not an expression. Columns count characters from 1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
#[non_exhaustive]
pub enum ParseError {
    #[error("column {column}: `{found}` has no meaning here")]
    Character { column: usize, found: char },
    #[error("column {column}: a solid is missing")]
    Operand { column: usize },
    #[error("column {column}: this bracket is not closed")]
    Open { column: usize },
    #[error("column {column}: this bracket closes nothing")]
    Close { column: usize },
    #[error(transparent)]
    Tree(#[from] TreeError),
}

impl ParseError {
    /// Where it is; column 1 for an expression that is too large as a whole.
    pub fn column(&self) -> usize {
        match *self {
            Self::Character { column, .. }
            | Self::Operand { column }
            | Self::Open { column }
            | Self::Close { column } => column,
            Self::Tree(_) => 1,
        }
    }
}

/// An operator or bracket that waits for its right side.
enum Pending {
    Bracket { column: usize },
    Not,
    Pair(Op),
}

impl Pending {
    fn strength(&self) -> u8 {
        match self {
            Self::Bracket { .. } => 0,
            Self::Pair(Op::Intersection) => 2,
            Self::Pair(_) => 1,
            Self::Not => 3,
        }
    }
}

/// Reads one expression.
///
/// # Errors
/// [`ParseError`] with the column of the first fault.
pub fn parse(text: &str) -> Result<Expression, ParseError> {
    let mut yard = Yard::default();
    let mut names: Vec<String> = Vec::new();
    let mut indices: HashMap<String, u32> = HashMap::new();
    let mut operand = false; // what came last is a whole operand
    let mut columns = 0;
    let mut rest = text.chars().enumerate().peekable();
    while let Some((at, c)) = rest.next() {
        let column = at + 1;
        columns = column;
        let binary = match c {
            '+' => Some(Op::Union),
            '*' => Some(Op::Intersection),
            '-' => Some(Op::Difference),
            '^' => Some(Op::SymmetricDifference),
            _ => None,
        };
        match c {
            _ if c.is_whitespace() => {}
            _ if binary.is_some() || c == ')' => {
                if !operand {
                    return Err(ParseError::Operand { column });
                }
                match binary {
                    Some(op) => yard.operator(op),
                    None if yard.close() => {}
                    None => return Err(ParseError::Close { column }),
                }
                operand = binary.is_none();
            }
            '(' | '!' | 'A'..='Z' | 'a'..='z' => {
                if operand {
                    yard.operator(Op::Intersection);
                }
                operand = c.is_ascii_alphabetic();
                match c {
                    '(' => yard.pending.push(Pending::Bracket { column }),
                    '!' => yard.pending.push(Pending::Not),
                    _ => {
                        let mut name = c.to_string();
                        while let Some((_, digit)) = rest.next_if(|(_, c)| c.is_ascii_digit()) {
                            name.push(digit);
                            columns += 1;
                        }
                        let index = *indices.entry(name).or_insert_with_key(|name| {
                            names.push(name.clone());
                            names.len() as u32 - 1
                        });
                        let leaf = yard.nodes.leaf(index);
                        yard.done.push(leaf);
                    }
                }
            }
            found => return Err(ParseError::Character { column, found }),
        }
    }
    if !operand {
        return Err(ParseError::Operand { column: columns + 1 });
    }
    yard.reduce(1);
    if let Some(Pending::Bracket { column }) = yard.pending.pop() {
        return Err(ParseError::Open { column });
    }
    Ok(Expression { tree: yard.nodes.finish(yard.done[0])?, names })
}

#[derive(Default)]
struct Yard {
    nodes: Builder,
    pending: Vec<Pending>,
    done: Vec<u32>,
}

impl Yard {
    /// Finishes operators that bind at least as strongly as `strength`.
    fn reduce(&mut self, strength: u8) {
        while let Some(pending) = self.pending.pop_if(|p| p.strength() >= strength) {
            let right = self.done.pop().expect("every operator waits behind an operand");
            let node = match pending {
                Pending::Pair(op) => {
                    let left = self.done.pop().expect("a pair has a left side");
                    self.nodes.pair(op, left, right)
                }
                _ => self.nodes.complement(right),
            };
            self.done.push(node);
        }
    }

    fn operator(&mut self, op: Op) {
        self.reduce(Pending::Pair(op).strength());
        self.pending.push(Pending::Pair(op));
    }

    /// Back to the last open bracket; `false` when there is none.
    fn close(&mut self) -> bool {
        self.reduce(1);
        matches!(self.pending.pop(), Some(Pending::Bracket { .. }))
    }
}
