//! OpenSCAD's flattened solids: what `openscad -o x.csg` writes.
//!
//! ```text
//!   text ──lex──▶ words ──args──▶ node(name, arguments) ──one frame a node on a stack──▶ Assembly ──▶ Solid
//!
//!   difference() {        Frame { Difference, placed }      first child minus the rest
//!     cube(size = 2);       flat, body: leaves              a node without solids below it is skipped
//!     # sphere(r = 1);      # kept   % left out   * left out   ! alone, as if it stood at the top
//!   }
//! ```
//!
//! Circles, balls and cylinders are round unless few segments are asked for: `0 < $fn < 13` is a choice of
//! shape (a nut) and gives exactly those facets; [`Facets::AsWritten`] gives the facets of every one.
//! An extrusion that turns has the facets of OpenSCAD, and so have its circles.
//! Nodes that have no counterpart refuse the whole file by name and line: with one operand missing,
//! a Boolean solid is another one. Nesting is bounded by memory alone.

mod args;
mod body;
mod convex;
mod flat;
mod lex;
mod polygon;
#[cfg(test)]
mod tests;
mod twist;

use super::colour::linear;
use super::solid::{Assembly, Placed};
use super::{Import, ImportError, ImportReport, Place, Warnings};
use crate::csg::Op;
use crate::model::{Colour, Model};
use args::{Args, Value};
pub(super) use convex::planes;
use flat::Lift;
use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};
use lex::{Lexer, Token};

/// Whether round solids are round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facets {
    /// Round, but for `$fn` below 13.
    #[default]
    Round,
    /// As many facets as OpenSCAD makes.
    AsWritten,
}

/// Why the text is not read, and where.
#[derive(Debug)]
pub(super) struct Fault {
    line: usize,
    message: String,
}

impl Fault {
    fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }
}

/// What nodes inherit from those around them.
#[derive(Clone, Copy, Debug)]
struct Context {
    transform: DAffine3,
    colour: Option<Colour>,
    /// Inside an extrusion.
    lift: Option<Lift>,
    /// 2-D coordinates to those that are lifted.
    plane: DAffine2,
    /// Inside what is left out: read for its grammar only.
    skipped: bool,
}

const TOP: Context =
    Context { transform: DAffine3::IDENTITY, colour: None, lift: None, plane: DAffine2::IDENTITY, skipped: false };

/// A node whose children are being read.
struct Frame {
    op: Op,
    inside: Context,
    /// Its children so far.
    sum: Option<u32>,
    /// Meets the sum in the end.
    cut: Option<u32>,
    /// `!`
    root: bool,
}

/// Whether the text begins as such a file does.
pub(super) fn recognise(text: &str) -> bool {
    let mut lexer = Lexer::new(text);
    while matches!(lexer.peek(), Ok(Token::Sign(b'%' | b'#' | b'!' | b'*'))) {
        let _ = lexer.take();
    }
    let known = |name: &str| body::SOLIDS.contains(&name) || UNIONS.contains(&name) || OTHERS.contains(&name);
    matches!(lexer.take(), Ok((Token::Name(name), _)) if known(name)) && matches!(lexer.accept(b'('), Ok(true))
}

/// Nodes that are the union of their children.
const UNIONS: [&str; 5] = ["group", "union", "color", "multmatrix", "render"];
/// Other nodes with children.
const OTHERS: [&str; 4] = ["difference", "intersection", "linear_extrude", "rotate_extrude"];

/// Reads flattened text; `name` is the file's name in messages.
pub(super) fn read(text: &str, name: &str, facets: Facets) -> Result<Import, ImportError> {
    let mut reader = Reader {
        lexer: Lexer::new(text),
        facets,
        assembly: Assembly::default(),
        warnings: Warnings::new(name),
        report: ImportReport { format: "OpenSCAD csg".to_owned(), ..ImportReport::default() },
        count: 0,
        root: None,
        triangles: twist::MOST_TRIANGLES,
    };
    let failed = |fault: Fault| ImportError::Solid { file: name.to_owned(), line: fault.line, message: fault.message };
    let sum = reader.file().map_err(failed)?;
    let mut model = Model { name: super::stem(name), ..Model::default() };
    if let Some(root) = reader.root.or(sum) {
        let solid = reader.assembly.finish(root);
        model.solids.push(solid.map_err(|message| failed(Fault::new(1, message)))?);
    }
    let (warnings, counts) = reader.warnings.finish();
    reader.report.warnings = counts;
    reader.report.bodies = model.solids.len();
    Ok(Import { model, warnings, report: reader.report, ..Import::default() })
}

struct Reader<'a> {
    lexer: Lexer<'a>,
    facets: Facets,
    assembly: Assembly,
    warnings: Warnings,
    report: ImportReport,
    /// Nodes so far.
    count: u32,
    root: Option<u32>,
    /// That extrusions which turn may still have.
    triangles: f64,
}

impl<'a> Reader<'a> {
    /// All nodes; their union.
    fn file(&mut self) -> Result<Option<u32>, Fault> {
        let frame = |op, inside| Frame { op, inside, sum: None, cut: None, root: false };
        let mut stack = vec![frame(Op::Union, TOP)];
        loop {
            let mut mods = [false; 4];
            while let Token::Sign(sign) = *self.lexer.peek()? {
                let Some(i) = b"%#!*".iter().position(|m| *m == sign) else { break };
                mods[i] = true;
                self.lexer.take()?;
            }
            let (token, line) = self.lexer.take()?;
            let inside = stack.last().expect("the file's own frame").inside;
            let (name, args) = match token {
                Token::End if stack.len() == 1 => return Ok(stack.pop().and_then(|f| f.sum)),
                Token::End => {
                    return Err(Fault::new(line, format!("the file ends {} `}}` too early", stack.len() - 1)));
                }
                Token::Sign(b'}') if stack.len() > 1 => {
                    let done = stack.pop().expect("longer than 1");
                    let parent = stack.last_mut().expect("the file's own frame");
                    self.close(done, parent);
                    continue;
                }
                Token::Sign(b';') => continue,
                Token::Name(name) => {
                    self.lexer.expect(b'(')?;
                    (name, Args::read(&mut self.lexer, name, line)?)
                }
                other => return Err(Fault::new(line, format!("a node expected, not {}", other.name()))),
            };
            self.count = self.count.saturating_add(1);
            let inside = self.modified(inside, mods, &args);
            let mut made = frame(Op::Union, inside);
            made.root = mods[2] && !inside.skipped;
            if !inside.skipped {
                *self.report.nodes.entry(name.to_owned()).or_default() += 1;
                self.enter(&mut made, &args)?;
            }
            if self.lexer.accept(b'{')? {
                stack.push(made);
            } else {
                self.lexer.expect(b';')?;
                self.close(made, stack.last_mut().expect("the file's own frame"));
            }
        }
    }

    fn modified(
        &mut self,
        mut inside: Context,
        [background, highlight, root, disabled]: [bool; 4],
        args: &Args<'_>,
    ) -> Context {
        if inside.skipped {
            return inside;
        }
        for (set, name) in [(background, "%"), (highlight, "#"), (root, "!"), (disabled, "*")] {
            if set {
                *self.report.nodes.entry(name.to_owned()).or_default() += 1;
            }
        }
        if background && !disabled {
            self.warn("background left out", args, || format!("`%{}` is no part of the solid", args.node));
        }
        if root {
            inside = TOP;
        }
        inside.skipped = background || disabled;
        inside
    }

    /// Makes what the node itself is.
    fn enter(&mut self, frame: &mut Frame, args: &Args<'a>) -> Result<(), Fault> {
        let inside = &mut frame.inside;
        match args.node {
            "group" | "union" | "render" => {}
            "difference" => frame.op = Op::Difference,
            "intersection" => frame.op = Op::Intersection,
            "multmatrix" => {
                let m = matrix(args)?;
                if inside.lift.is_none() {
                    inside.transform *= m;
                } else {
                    let xy = |v: DVec3| DVec2::new(v.x, v.y);
                    let matrix2 = DMat2::from_cols(xy(m.matrix3.x_axis), xy(m.matrix3.y_axis));
                    inside.plane *= DAffine2 { matrix2, translation: xy(m.translation) };
                }
            }
            "color" => inside.colour = inside.colour.or(colour(args)), // the outermost wins
            "linear_extrude" | "rotate_extrude" => {
                if inside.lift.is_some() {
                    return Err(args.fault("an extrusion inside an extrusion is not read"));
                }
                let (lift, wedge) = self.lift(args)?;
                inside.lift = Some(lift);
                let placed = Placed { transform: inside.transform, colour: inside.colour, id: self.count };
                frame.cut = wedge.map(|planes| self.wedge(&planes, &placed));
            }
            _ => frame.sum = self.leaf(inside, args)?,
        }
        Ok(())
    }

    /// Hands a finished node to its parent.
    fn close(&mut self, done: Frame, parent: &mut Frame) {
        let Some(mut node) = done.sum else { return };
        if let Some(cut) = done.cut {
            node = self.assembly.nodes.pair(Op::Intersection, node, cut);
        }
        if done.root {
            self.root.get_or_insert(node);
        }
        parent.sum = Some(match parent.sum {
            Some(sum) => self.assembly.nodes.pair(parent.op, sum, node),
            None => node,
        });
    }

    fn warn(&mut self, kind: &'static str, args: &Args<'_>, message: impl FnOnce() -> String) {
        self.warnings.push(kind, || Place::Line(args.line), message);
    }
}

/// A 4 x 4 matrix by rows.
fn matrix(args: &Args<'_>) -> Result<DAffine3, Fault> {
    let rows = match args.first().or_else(|| args.get("m")) {
        Some(Value::List(rows)) => rows.iter().map(Value::vector::<4>).collect::<Option<Vec<_>>>(),
        _ => None,
    };
    let rows = rows
        .filter(|r| r.len() == 3 || r.len() == 4)
        .ok_or_else(|| args.fault("not a matrix of 4 rows of 4 numbers"))?;
    if rows.get(3).is_some_and(|r| *r != [0.0, 0.0, 0.0, 1.0]) {
        return Err(args.fault("the last row of a matrix is not 0, 0, 0, 1"));
    }
    let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
    Ok(DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) })
}

/// Linear light; none for OpenSCAD's "no colour", which is negative.
fn colour(args: &Args<'_>) -> Option<Colour> {
    let [r, g, b, a] = args.first().or_else(|| args.get("c"))?.vector::<4>()?;
    [r, g, b, a].iter().all(|c| *c >= 0.0).then(|| linear([r, g, b], a))
}
