//! OpenSCAD's flattened solids, the output of `openscad -o x.csg`.
//!
//! ```text
//!   text ──lex──▶ words ──args, names──▶ node(name, arguments) ──one frame a node on a stack──▶ Assembly ──▶ Solid
//!
//!   difference() {        Frame { Difference, placed }      first child minus the rest
//!     cube(size = 2);       flat, body: leaves              a node without solids below it is skipped
//!     # sphere(r = 1);      # kept   % left out   * left out   ! alone, as if it stood at the top
//!   }
//! ```
//!
//! Circles, balls and cylinders are round unless few segments are stated: `0 < $fn < 13` is a choice of shape (a nut)
//! and gives exactly those facets; [`Facets::AsWritten`] gives the facets of every one. A twisted extrusion has
//! OpenSCAD's facets, including its circles. So has everything inside a hull, a Minkowski sum, an offset, a projection
//! (`facets`).
//!
//! A node that cannot be made is left out, and a warning names its line. So is a difference whose first operand is left
//! out, and a Minkowski sum with any operand left out; other nodes are made of the remaining children. An empty node
//! counts as the empty set: subtracting from it, or intersecting with it, is empty. Nesting is bounded by memory alone.

mod args;
mod body;
mod convex;
#[cfg(feature = "scad-facets")]
mod facets;
#[cfg(not(feature = "scad-facets"))]
#[path = "without_facets.rs"]
mod facets;
mod flat;
mod frame;
mod lex;
mod names;
mod polygon;
#[cfg(test)]
mod tests;
mod twist;

use super::colour::linear;
use super::solid::{Assembly, Fault, Placed};
use super::source::OtherFiles;
use super::{Import, ImportError, ImportReport, Options, Place, Stage, Warnings};
use crate::csg::Op;
use crate::model::{Colour, Model};
use args::{Args, Value};
pub(super) use convex::planes;
use facets::{Budget, Gather};
use flat::Lift;
use frame::{Frame, Made, Outcome};
use glam::{DAffine2, DAffine3, DMat3, DVec3};
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

/// Properties that nodes inherit from those around them.
#[derive(Clone, Copy, Debug)]
struct Context {
    transform: DAffine3,
    colour: Option<Colour>,
    /// Inside an extrusion.
    lift: Option<Lift>,
    /// 2-D coordinates to the coordinates that are lifted.
    plane: DAffine2,
    /// Inside a node that is made of facets.
    facets: bool,
    /// Inside a node that is left out: only parsed.
    skipped: bool,
}

const TOP: Context = Context {
    transform: DAffine3::IDENTITY,
    colour: None,
    lift: None,
    plane: DAffine2::IDENTITY,
    facets: false,
    skipped: false,
};

/// Whether the text begins as such a file does.
pub(super) fn recognise(text: &str) -> bool {
    let mut lexer = Lexer::new(text);
    while matches!(lexer.peek(), Ok(Token::Sign(b'%' | b'#' | b'!' | b'*'))) {
        let _ = lexer.take();
    }
    let known = |name: &str| {
        body::SOLIDS.contains(&name) || UNIONS.contains(&name) || OTHERS.contains(&name) || Gather::needs(name)
    };
    matches!(lexer.take(), Ok((Token::Name(name), _)) if known(name)) && matches!(lexer.accept(b'('), Ok(true))
}

/// Nodes that are the union of their children.
const UNIONS: [&str; 5] = ["group", "union", "color", "multmatrix", "render"];
/// Other nodes with children.
const OTHERS: [&str; 4] = ["difference", "intersection", "linear_extrude", "rotate_extrude"];

/// Reads flattened text, and the files that it names; `name` is its own name in messages.
pub(super) fn read(
    text: &str,
    name: &str,
    options: &Options<'_>,
    files: OtherFiles<'_>,
) -> Result<Import, ImportError> {
    let mut reader = Reader {
        lexer: Lexer::new(text),
        options: *options,
        bytes: text.len() as u64,
        reported: 0,
        facets: options.facets,
        files,
        assembly: Assembly::default(),
        warnings: Warnings::new(name),
        report: ImportReport { format: "OpenSCAD csg".to_owned(), ..ImportReport::default() },
        count: 0,
        root: None,
        triangles: twist::MOST_TRIANGLES,
        budget: Budget::whole(),
        muted: 0,
        again: MOST_AGAIN,
    };
    let failed = |fault: Fault| fault.of_file(name);
    let sum = reader.file().map_err(failed)?;
    let mut model = Model { name: super::stem(name), ..Model::default() };
    if let Some(root) = reader.root.or(sum) {
        let solid = reader.assembly.finish(root);
        model.solids.push(solid.map_err(|message| failed(Fault::new(1, message)))?);
    }
    let warnings = reader.warnings.finish(&mut reader.report);
    reader.report.bodies = model.solids.len();
    Ok(Import { model, warnings, report: reader.report, ..Import::default() })
}

struct Reader<'a> {
    lexer: Lexer<'a>,
    options: Options<'a>,
    /// Length of the text.
    bytes: u64,
    /// Place in it that was reported last.
    reported: usize,
    facets: Facets,
    files: OtherFiles<'a>,
    assembly: Assembly,
    warnings: Warnings,
    report: ImportReport,
    /// Nodes so far.
    count: u32,
    root: Option<u32>,
    /// Triangles that twisted extrusions may still have.
    triangles: f64,
    /// Work that facets may still cost.
    budget: Budget,
    /// Depth of nodes that will be read again: their warnings are not given the first time.
    muted: usize,
    /// Characters that may still be read again.
    again: usize,
}

/// Bytes after which the place in the text is reported again.
const REPORTED: usize = 1 << 16;
/// Characters that are read twice, to find the box of a resized node.
const MOST_AGAIN: usize = 1 << 30;

impl<'a> Reader<'a> {
    /// All nodes; their union.
    fn file(&mut self) -> Result<Option<u32>, Fault> {
        let mut stack = vec![Frame::new(Args::none(), TOP)];
        loop {
            let mut mods = [false; 4];
            while let Token::Sign(sign) = *self.lexer.peek()? {
                let Some(i) = b"%#!*".iter().position(|m| *m == sign) else { break };
                mods[i] = true;
                self.lexer.take()?;
            }
            let (token, line) = self.lexer.take()?;
            let inside = stack.last().expect("the file's own frame").inside;
            let args = match token {
                Token::End if stack.len() == 1 => return Ok(stack.pop().and_then(|f| f.sum)),
                Token::End => {
                    return Err(Fault::new(line, format!("the file ends {} `}}` too early", stack.len() - 1)));
                }
                Token::Sign(b'}') if stack.len() > 1 => {
                    let mut done = stack.pop().expect("longer than 1");
                    if let Some(frame) = self.read_again(&mut done) {
                        self.lexer.expect(b'{')?;
                        stack.push(frame);
                    } else {
                        let is_slow = done.gather.is_some();
                        self.close(done, stack.last_mut().expect("the file's own frame"));
                        self.tell(is_slow);
                    }
                    continue;
                }
                Token::Sign(b';') => continue,
                Token::Name(name) => {
                    self.lexer.expect(b'(')?;
                    Args::read(&mut self.lexer, name, line)?
                }
                other => return Err(Fault::new(line, format!("a node expected, not {}", other.name()))),
            };
            self.count = self.count.saturating_add(1);
            let inside = self.modified(inside, mods, &args);
            for what in args.unknown.iter().filter(|_| !inside.skipped) {
                self.warn("argument left out", &args, || format!("`{}` has {what}", args.node));
            }
            let mut made = Frame::new(args, inside);
            made.root = mods[2] && !inside.skipped;
            if !inside.skipped {
                if self.muted == 0 {
                    *self.report.nodes.entry(made.args.node.to_owned()).or_default() += 1;
                }
                if let Err(fault) = self.enter(&mut made) {
                    self.left_out(&mut made, fault);
                }
            }
            if self.lexer.accept(b'{')? {
                stack.push(made);
            } else {
                self.lexer.expect(b';')?;
                self.close(made, stack.last_mut().expect("the file's own frame"));
                self.tell(false);
            }
        }
    }

    /// Reports the place in the text: every so often, and after a node that is made of facets.
    fn tell(&mut self, is_slow: bool) {
        let read = self.lexer.place();
        if is_slow || read >= self.reported + REPORTED {
            self.reported = read;
            self.options.tell(Stage::Records { read: read as u64, bytes: self.bytes });
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
            if set && self.muted == 0 {
                *self.report.nodes.entry(name.to_owned()).or_default() += 1;
            }
        }
        if background && !disabled {
            self.warn("background not drawn", args, || format!("`%{}` is no part of the solid", args.node));
        }
        if root {
            inside = TOP;
        }
        inside.skipped = background || disabled;
        inside
    }

    /// Begins a node: leaves are made, other nodes set up their frame.
    fn enter(&mut self, frame: &mut Frame<'a>) -> Result<(), Fault> {
        let (inside, args) = (&mut frame.inside, &frame.args);
        if inside.facets || Gather::needs(args.node) {
            return self.enter_facets(frame);
        }
        match args.node {
            "group" | "union" | "render" => {}
            "difference" => frame.op = Op::Difference,
            "intersection" => frame.op = Op::Intersection,
            "multmatrix" => {
                let m = matrix(args)?;
                if inside.lift.is_none() {
                    inside.transform *= m;
                } else {
                    inside.plane *= flat::in_plane(&m);
                }
            }
            "color" => match colour(args) {
                Ok(own) => inside.colour = inside.colour.or(own), // the outermost wins
                Err(fault) => self.warn("colour left out", args, || fault.message),
            },
            "linear_extrude" | "rotate_extrude" => {
                if inside.lift.is_some() {
                    return Err(args.fault("an extrusion inside an extrusion is not read"));
                }
                let (lift, wedge) = self.lift(args)?;
                inside.lift = Some(lift);
                let start = args.start(args.number("angle", 360.0)?)?;
                if start != 0.0 {
                    inside.transform *= DAffine3::from_rotation_z(start);
                }
                let placed = Placed { transform: inside.transform, colour: inside.colour, id: self.count };
                frame.cut = wedge.map(|planes| self.wedge(&planes, &placed));
            }
            _ => {
                let made = self.leaf(inside, args)?;
                frame.leaf(Outcome::Node(made));
            }
        }
        Ok(())
    }

    /// The same within nodes that are made of facets.
    fn enter_facets(&mut self, frame: &mut Frame<'a>) -> Result<(), Fault> {
        let args = &frame.args;
        let (op, mut matrix_of, mut lift) = match args.node {
            "difference" => (Op::Difference, None, None),
            "intersection" => (Op::Intersection, None, None),
            _ => (Op::Union, None, None),
        };
        match args.node {
            "multmatrix" => matrix_of = Some(matrix(args)?),
            "linear_extrude" => lift = Some(self.lift(args)?.0),
            name if UNIONS.contains(&name) || OTHERS.contains(&name) || Gather::needs(name) => {}
            _ => {
                let made = self.facet_leaf(args)?;
                frame.leaf(Outcome::Shape(made));
                return Ok(());
            }
        }
        frame.gather = Some(Box::new(Gather::new(args, op, matrix_of, lift)?));
        if args.node == "resize" && !frame.inside.facets {
            // its size comes from its facets; then its children are read again for their exact solids
            frame.start = Some(Box::new((self.lexer.clone(), self.count)));
            self.muted += 1;
        }
        frame.inside.facets = true;
        Ok(())
    }

    /// The frame of a node that is read again, now that its size is known.
    fn read_again(&mut self, done: &mut Frame<'a>) -> Option<Frame<'a>> {
        let (start, count) = *done.start.take()?;
        self.muted -= 1;
        let length = self.lexer.place().saturating_sub(start.place());
        let scale = done.gather.as_ref().and_then(|g| g.scale());
        if self.again < length {
            self.warn("resized in facets", &done.args, || "too much is resized to be read once more".to_owned());
            return None;
        }
        let scale = scale?;
        self.again -= length;
        self.lexer = start;
        self.count = count;
        let mut inside = Context { facets: false, ..done.inside };
        if inside.lift.is_none() {
            inside.transform *= DAffine3::from_scale(scale);
        } else {
            inside.plane *= DAffine2::from_scale(scale.truncate());
        }
        let mut frame = Frame::new(std::mem::replace(&mut done.args, Args::none()), inside);
        frame.root = done.root;
        Some(frame)
    }

    /// Hands a finished node to its parent.
    fn close(&mut self, mut done: Frame<'a>, parent: &mut Frame<'a>) {
        if done.is_absent() {
            return;
        }
        if done.start.take().is_some() {
            self.muted -= 1; // it has no children
        }
        let outcome = match self.finish(&mut done) {
            Ok(outcome) => outcome,
            Err(fault) => {
                self.left_out(&mut done, fault);
                if parent.gather.is_some() { Outcome::Shape(Made::Lost) } else { Outcome::Node(Made::Lost) }
            }
        };
        if done.root {
            if let Outcome::Node(Made::Is(node)) = outcome {
                self.root.get_or_insert(node);
            }
            return;
        }
        parent.add(outcome, &mut self.assembly);
    }

    /// The result of a node, for its parent.
    fn finish(&mut self, done: &mut Frame<'a>) -> Result<Outcome, Fault> {
        let Some(gather) = done.gather.take() else { return Ok(done.outcome(&mut self.assembly)) };
        let strangers = gather.strangers();
        if strangers > 0 {
            self.warn("mixed dimensions", &done.args, || {
                format!(
                    "`{}`: {strangers} children are left out, flat among solids or solid among flat",
                    done.args.node
                )
            });
        }
        let shape = gather.finish(&mut self.budget).map_err(|what| done.args.fault(what))?;
        if done.within_facets {
            return Ok(Outcome::Shape(shape));
        }
        Ok(Outcome::Node(self.placed(&done.args, &done.inside, shape)?))
    }

    /// Names a node that cannot be made; its children are only parsed.
    fn left_out(&mut self, frame: &mut Frame<'a>, fault: Fault) {
        if self.muted == 0 {
            self.warnings.push("node left out", || Place::Line(fault.line), || fault.message);
        }
        frame.lose();
    }

    fn warn(&mut self, kind: &'static str, args: &Args<'_>, message: impl FnOnce() -> String) {
        if self.muted == 0 {
            self.warnings.push(kind, || Place::Line(args.line), message);
        }
    }
}

/// A 4 x 4 matrix by rows.
fn matrix(args: &Args<'_>) -> Result<DAffine3, Fault> {
    let rows = match args.get("m") {
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
fn colour(args: &Args<'_>) -> Result<Option<Colour>, Fault> {
    let Some(value) = args.get("c") else { return Ok(None) };
    let alpha = args.number("alpha", 1.0)?;
    let three = || value.vector::<3>().map(|[r, g, b]| [r, g, b, alpha]);
    let parts =
        value.vector::<4>().or_else(three).ok_or_else(|| args.fault("`c` is neither three nor four numbers"))?;
    let [r, g, b, a] = parts;
    Ok(parts.iter().all(|c| *c >= 0.0).then(|| linear([r, g, b], a)))
}
