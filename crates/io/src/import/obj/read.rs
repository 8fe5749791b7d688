//! The statements one by one, and the model that they make.

use super::axis::Basis;
use super::freeform::{Curves, Element, Piece, State, Trim};
use super::index;
use super::material::{Materials, brief};
use super::polygons::{Look, Polygons};
use crate::import::parts::{self, Stated};
use crate::import::source::OtherFiles;
use crate::import::{FACE_LOST, Import, ImportError, ImportReport, Place, Warnings};
use crate::model::Face;
use glam::{DVec3, DVec4};
use std::collections::BTreeMap;

/// The element between its first statement and its `end`.
enum Open {
    Curve(Element),
    /// A surface and the line on which it begins, for messages.
    Surface(Element, usize),
    /// An ignored element, or one whose beginning could not be read.
    Other,
}

/// A file while it is read.
pub(super) struct Reader<'f> {
    name: &'f str,
    files: OtherFiles<'f>,
    warnings: Warnings,
    report: ImportReport,
    vertices: Vec<DVec4>,
    parameters: Vec<DVec3>,
    polygons: Polygons,
    materials: Materials,
    look: Look,
    state: State,
    curves: Curves,
    open: Option<Open>,
    /// Control points that may still be made from shared geometry.
    work: usize,
    /// Surfaces by the name of their object.
    faces: Vec<(String, Stated)>,
    /// Statements that are not used: line of the first, and how many.
    unused: BTreeMap<String, (usize, usize)>,
}

/// Control points that may be made for each byte of text, beside a million: curves can be named often.
const WORK_PER_BYTE: usize = 16;

/// Different words that are counted as unused statements.
const MAX_UNUSED: usize = 64;

impl<'f> Reader<'f> {
    pub fn new(name: &'f str, files: OtherFiles<'f>, bytes: usize) -> Self {
        let report = ImportReport { format: "Wavefront OBJ".into(), ..ImportReport::default() };
        Self {
            name,
            files,
            report,
            warnings: Warnings::new(name),
            vertices: Vec::new(),
            parameters: Vec::new(),
            polygons: Polygons::default(),
            materials: Materials::default(),
            look: Look { object: String::new(), group: String::new(), material: String::new(), colour: None },
            state: State::default(),
            curves: Vec::new(),
            open: None,
            work: bytes.saturating_mul(WORK_PER_BYTE).saturating_add(1 << 20),
            faces: Vec::new(),
            unused: BTreeMap::new(),
        }
    }

    fn warn(&mut self, kind: &'static str, line: usize, message: String) {
        self.warnings.push(kind, || Place::Line(line), || message);
    }

    /// Takes one statement.
    pub fn statement(&mut self, line: usize, text: &str) {
        let mut words = text.split_whitespace();
        let Some(keyword) = words.next() else { return };
        let rest = || text.trim_start()[keyword.len()..].trim();
        match keyword {
            "v" => {
                let p = numbers(words).filter(|n| n.len() >= 3).map(|n| {
                    // six or more numbers are a colour after the point
                    DVec4::new(n[0], n[1], n[2], if n.len() == 4 { n[3] } else { 1.0 })
                });
                if p.is_none() {
                    self.warn("vertex not read", line, brief(text));
                } else if text.split_whitespace().count() > 5 {
                    self.unused("v with a colour", line);
                }
                self.vertices.push(p.unwrap_or(DVec4::NAN));
                self.polygons.vertex(p.unwrap_or(DVec4::NAN));
            }
            "vn" => {
                let n = numbers(words).filter(|n| n.len() == 3).map(|n| DVec3::from_slice(&n));
                if n.is_none() {
                    self.warn("normal not read", line, brief(text));
                }
                self.polygons.normal(n);
            }
            "vp" => {
                let n = numbers(words).filter(|n| (1..=3).contains(&n.len()));
                if n.is_none() {
                    self.warn("parameter vertex not read", line, brief(text));
                }
                let at = |n: &[f64], i: usize, missing: f64| n.get(i).copied().unwrap_or(missing);
                let p = n.map_or(DVec3::NAN, |n| DVec3::new(at(&n, 0, 0.0), at(&n, 1, 0.0), at(&n, 2, 1.0)));
                self.parameters.push(p);
            }
            "f" | "fo" => match self.polygons.polygon(words, &self.vertices, &self.look) {
                Ok(false) => {}
                Ok(true) => self.warn("normals not used", line, brief(text)),
                Err(why) => self.warn("polygon left out", line, why),
            },
            "o" => self.look.object = rest().to_owned(),
            "g" => self.look.group = rest().to_owned(),
            "usemtl" => {
                self.look.material = rest().to_owned();
                let colour = self.materials.get(rest());
                if colour.is_none() {
                    self.warn("no such material", line, brief(rest()));
                }
                self.look.colour = colour.flatten();
            }
            "mtllib" => {
                // several names, or one with spaces in it
                let names = if rest().matches(".mtl").count() > 1 { words.collect() } else { vec![rest()] };
                names.into_iter().for_each(|n| self.materials.open(self.files, n, line, &mut self.warnings));
            }
            _ => {
                if let Err(why) = self.free_form(keyword, words, line) {
                    self.fail(line, why);
                }
            }
        }
    }

    /// A statement of free-form geometry.
    fn free_form<'t>(
        &mut self,
        keyword: &str,
        words: impl Iterator<Item = &'t str>,
        line: usize,
    ) -> Result<(), String> {
        let words: Vec<&str> = words.collect();
        let whole = |w: Option<&&str>| w.map_or(Ok(0), |w| w.parse().map_err(|_| format!("{keyword}: {}", brief(w))));
        match keyword {
            "cstype" => {
                let (rational, name) = match words[..] {
                    ["rat", name] => (true, name),
                    [name] => (false, name),
                    _ => (false, ""),
                };
                self.state.rational = rational;
                self.state.basis = Basis::named(name);
                if self.state.basis.is_none() {
                    self.warn("unknown cstype", line, brief(&words.join(" ")));
                }
            }
            "deg" => self.state.degree = [whole(words.first())?, whole(words.get(1))?],
            "step" => self.state.step = [whole(words.first())?, whole(words.get(1))?],
            "bmat" => *direction(&mut self.state.matrix, &words)? = values(words.get(1..).unwrap_or_default())?,
            "curv2" => {
                self.close(line);
                self.curves.push(None);
                self.report.pcurves += 1;
                self.open = Some(Open::Other);
                let place = |w: &&str| index(w, self.parameters.len(), "parameter vertex").map(|i| self.parameters[i]);
                let points = words.iter().map(place).collect::<Result<Vec<_>, _>>()?;
                let points = points.into_iter().map(|p| DVec4::new(p.x, p.y, 0.0, p.z)).collect();
                self.open = Some(Open::Curve(Element::new(self.state.clone(), points, [0.0; 4])));
            }
            "surf" => {
                self.close(line);
                self.report.faces += 1;
                // nothing is known of the surface yet: a fault from here on is reported as its own
                self.open = Some(Open::Surface(Element::new(State::default(), Vec::new(), [0.0; 4]), line));
                let range = values(words.get(..4).ok_or("surf without a range")?)?;
                let vertex = |w: &&str| index(w.split('/').next().unwrap_or_default(), self.vertices.len(), "vertex");
                let points =
                    words[4..].iter().map(|w| vertex(w).map(|i| self.vertices[i])).collect::<Result<_, _>>()?;
                let range = [range[0], range[1], range[2], range[3]];
                self.open = Some(Open::Surface(Element::new(self.state.clone(), points, range), line));
            }
            "curv" => {
                self.close(line);
                self.unused(keyword, line);
                self.open = Some(Open::Other);
            }
            "parm" => {
                if let Some(Open::Curve(element) | Open::Surface(element, _)) = &mut self.open {
                    *direction(&mut element.parm, &words)? = values(words.get(1..).unwrap_or_default())?;
                }
            }
            "trim" | "hole" => {
                let pieces = self.pieces(&words)?;
                if let Some(Open::Surface(element, _)) = &mut self.open {
                    element.trims.push(Trim { pieces, hole: keyword == "hole" });
                }
            }
            "end" => self.close(line),
            "call" => self.named(words.first().copied().unwrap_or_default(), line),
            _ => self.unused(keyword, line),
        }
        Ok(())
    }

    fn pieces(&self, words: &[&str]) -> Result<Vec<Piece>, String> {
        if words.is_empty() || !words.len().is_multiple_of(3) {
            return Err(format!("a loop of {} words, which are no triples", words.len()));
        }
        let piece = |w: &[&str]| {
            let range = values(&w[..2])?;
            Ok(Piece { from: range[0], to: range[1], curve: index(w[2], self.curves.len(), "curve")? })
        };
        words.chunks_exact(3).map(piece).collect()
    }

    /// Gives up the open element; the message says why.
    fn fail(&mut self, line: usize, why: String) {
        match self.open.take() {
            Some(Open::Surface(..)) => self.lose(line, why),
            Some(Open::Curve(_)) => self.warn("trim curve left out", line, why),
            _ => self.warn("statement not read", line, why),
        }
        self.open = Some(Open::Other);
    }

    fn lose(&mut self, line: usize, why: String) {
        self.report.dropped.add(&why);
        let id = self.faces.len() as u32 + 1;
        self.faces.push((self.look.object.clone(), Err((id, why.clone()))));
        self.warn(FACE_LOST, line, why);
    }

    /// Builds the element that is open.
    fn close(&mut self, line: usize) {
        match self.open.take() {
            Some(Open::Curve(element)) => match element.curve() {
                Ok(curve) => *self.curves.last_mut().expect("an open curve has its place") = Some(curve),
                Err(why) => self.warn("trim curve left out", line, why),
            },
            Some(Open::Surface(element, line)) => {
                let id = self.faces.len() as u32 + 1;
                match element.face(id, &self.curves, &mut self.work) {
                    Ok((face, notes)) => {
                        for note in &notes {
                            self.report.repaired.add(note);
                            self.warn("face repaired", line, note.clone());
                        }
                        let colour = self.look.colour;
                        self.faces.push((self.look.object.clone(), Ok((Face { colour, ..face }, notes))));
                    }
                    Err(why) => self.lose(line, why),
                }
            }
            _ => {}
        }
    }

    /// Another file of statements, which is not read.
    fn named(&mut self, file: &str, line: usize) {
        let file = brief(file);
        if !self.report.missing_files.contains(&file) && self.report.missing_files.len() < MAX_UNUSED {
            self.warn("external file not followed", line, file.clone());
            self.report.external_files.push(file.clone());
            self.report.missing_files.push(file);
        }
    }

    fn unused(&mut self, keyword: &str, line: usize) {
        let known = self.unused.contains_key(keyword) || self.unused.len() < MAX_UNUSED;
        let keyword = if known { brief(keyword) } else { "others".into() };
        self.unused.entry(keyword).or_insert((line, 0)).1 += 1;
    }

    /// The model of all statements.
    pub fn finish(mut self) -> Result<Import, ImportError> {
        self.close(0);
        let nothing = || ImportError::Nothing { file: self.name.to_owned(), format: "Wavefront OBJ" };
        if self.vertices.is_empty() && self.parameters.is_empty() {
            return Err(nothing());
        }
        let first = self.faces.len() as u32 + 1;
        let polygons = std::mem::take(&mut self.polygons);
        let meshes = polygons.meshes(first).unwrap_or_else(|why| {
            self.warnings.push("polygons left out", || Place::File, || why);
            Vec::new()
        });
        for (keyword, (line, count)) in std::mem::take(&mut self.unused) {
            let kind = match keyword.as_str() {
                "p" => "points not drawn",
                "l" => "lines not drawn",
                "curv" => "curves not drawn",
                _ => "statement not used",
            };
            self.warn(kind, line, format!("`{keyword}`, {count} times"));
        }
        if self.faces.is_empty() && meshes.is_empty() && !self.vertices.is_empty() {
            let count = self.vertices.len();
            self.warnings.push("vertices not drawn", || Place::File, || format!("{count} of no face"));
        }
        let meshes = meshes.into_iter().map(|(look, mesh)| (look.object, mesh));
        let model = parts::assemble(self.name, self.faces, meshes, &mut self.report);
        self.report.bodies = model.parts.len();
        self.report.occurrences = model.instances.iter().map(|i| i.name.clone()).filter(|n| !n.is_empty()).collect();
        self.report.files_read = self.materials.opened;
        let warnings = self.warnings.finish(&mut self.report);
        Ok(Import { model, warnings, report: self.report, ..Import::default() })
    }
}

impl Element {
    fn new(state: State, points: Vec<DVec4>, range: [f64; 4]) -> Self {
        Self { state, points, range, parm: Default::default(), trims: Vec::new() }
    }
}

/// All words as finite numbers.
fn numbers<'t>(words: impl Iterator<Item = &'t str>) -> Option<Vec<f64>> {
    words.map(|w| w.parse::<f64>().ok().filter(|x| x.is_finite())).collect()
}

fn values(words: &[&str]) -> Result<Vec<f64>, String> {
    numbers(words.iter().copied()).ok_or_else(|| format!("no finite numbers: {}", brief(&words.join(" "))))
}

/// The list for `u` or `v`, which the first word says.
fn direction<'l, T>(lists: &'l mut [T; 2], words: &[&str]) -> Result<&'l mut T, String> {
    match words.first() {
        Some(&"u") => Ok(&mut lists[0]),
        Some(&"v") => Ok(&mut lists[1]),
        _ => Err("neither u nor v".into()),
    }
}
