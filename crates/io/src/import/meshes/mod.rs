//! Files of triangles: STL, OFF, PLY, 3MF, AMF, glTF.
//!
//! ```text
//!   bytes ──by ending or content──▶ Found { pieces, placements } ──▶ parts of one mesh a colour, instances
//! ```
//!
//! A damaged file is an error that names the place: a mesh whose file was cut off looks whole from the other side.
//! Lengths are millimetres where the format states a unit (3MF, AMF, glTF), else coordinates are unchanged. A part is
//! closed when every side of a triangle has its opposite.

mod amf;
mod gltf;
mod off;
mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod threemf;
mod xml;

use super::facets::{closed, triangulate};
use super::source::OtherFiles;
use super::{Import, ImportError, ImportReport, Place, Warnings, stem, text};
use crate::model::{Colour, Instance, Mesh, Model, Part};
use glam::{DAffine3, DVec3};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

/// Colours of one object, each of which is a mesh of its own.
const MOST_COLOURS: usize = 256;
/// Objects that a file may place: components of components multiply.
const MOST_PLACED: usize = 1 << 16;
/// Notes that the refusal of a file without triangles has.
const MOST_TOLD: usize = 3;

/// One object of a file.
#[derive(Debug, Default)]
struct Piece {
    name: String,
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Of each triangle's corners, or none.
    normals: Vec<[DVec3; 3]>,
    /// Of each triangle, or none.
    colours: Vec<Option<Colour>>,
    /// Polygons of fewer than three corners, which are no triangles.
    few: usize,
}

/// Where an object stands.
#[derive(Debug)]
struct Placement {
    piece: usize,
    transform: DAffine3,
    name: String,
}

/// A kind of warning, and what it says.
type Note = (&'static str, String);

/// The objects of a file.
#[derive(Debug, Default)]
struct Found {
    format: &'static str,
    /// Name of the unit, if the format has one.
    unit: String,
    pieces: Vec<Piece>,
    /// Every piece once, where there are none.
    placements: Vec<Placement>,
    /// Things left out, by kind.
    notes: Vec<Note>,
    /// Files that were read, too.
    files: Vec<PathBuf>,
}

/// Why a file is refused: the line, if it is text, and the fault.
#[derive(Debug, PartialEq)]
struct Wrong {
    line: Option<usize>,
    message: String,
}

impl Wrong {
    fn new(message: impl Into<String>) -> Self {
        Self { line: None, message: message.into() }
    }

    fn at(line: usize, message: impl Into<String>) -> Self {
        Self { line: Some(line), message: message.into() }
    }
}

impl Piece {
    /// A polygon of corners that are there.
    fn polygon(&mut self, face: &[u32], colour: Option<Colour>) -> Result<(), String> {
        if let Some(far) = face.iter().find(|i| **i as usize >= self.points.len()) {
            return Err(format!("vertex {far} of {}", self.points.len()));
        }
        let corners: Vec<DVec3> = face.iter().map(|i| self.points[*i as usize]).collect();
        if corners.len() > super::facets::MAX_CORNERS {
            return Err(format!("{} corners", corners.len()));
        }
        self.few += usize::from(corners.len() < 3);
        for t in triangulate(&corners) {
            self.triangles.push(t.map(|i| face[i as usize]));
            self.colours.push(colour);
        }
        Ok(())
    }

    /// Triangles of one colour each, numbered from `id`.
    fn meshes(self, id: u32, notes: &mut Vec<Note>) -> Result<Vec<Mesh>, Wrong> {
        let wrong = |e: crate::model::MeshError| Wrong::new(e.to_string());
        let key = |c: &Option<Colour>| c.map(|c| c.map(f32::to_bits));
        let mut places: HashMap<Option<[u32; 4]>, usize> = HashMap::new();
        for colour in &self.colours {
            let next = places.len();
            places.entry(key(colour)).or_insert(next);
        }
        if places.len() > MOST_COLOURS {
            notes.push(("colours left out", format!("{} has more than {MOST_COLOURS} colours", self.name)));
            places.clear();
        }
        if places.len() < 2 {
            let colour = self.colours.first().copied().flatten().filter(|_| !places.is_empty());
            let mut mesh = Mesh::new(id, self.points, self.triangles, self.normals).map_err(wrong)?;
            mesh.colour = colour;
            return Ok(vec![mesh]);
        }
        let mut apart: Vec<Piece> = (0..places.len()).map(|_| Piece::default()).collect();
        let mut numbers: Vec<HashMap<u32, u32>> = vec![HashMap::new(); places.len()];
        for (t, (triangle, colour)) in self.triangles.iter().zip(&self.colours).enumerate() {
            let at = places[&key(colour)];
            let (piece, numbers) = (&mut apart[at], &mut numbers[at]);
            let corner = |i: u32| {
                *numbers.entry(i).or_insert_with(|| {
                    piece.points.push(self.points.get(i as usize).copied().unwrap_or(DVec3::NAN));
                    piece.points.len() as u32 - 1
                })
            };
            let corners = triangle.map(corner);
            piece.triangles.push(corners);
            piece.normals.extend(self.normals.get(t));
            piece.colours = vec![*colour];
        }
        let mesh = |(piece, id): (Piece, u32)| {
            let mut mesh = Mesh::new(id, piece.points, piece.triangles, piece.normals).map_err(wrong)?;
            mesh.colour = piece.colours[0];
            Ok(mesh)
        };
        apart.into_iter().zip(id..).map(mesh).collect()
    }
}

/// Points that triangles share where their coordinates are the same.
#[derive(Debug, Default)]
struct Shared {
    places: HashMap<[u64; 3], u32>,
    points: Vec<DVec3>,
}

impl Shared {
    fn number(&mut self, p: DVec3) -> u32 {
        let p = p + 0.0; // zero of either sign is one place
        *self.places.entry(p.to_array().map(f64::to_bits)).or_insert_with(|| {
            self.points.push(p);
            self.points.len() as u32 - 1
        })
    }
}

/// The bytes as UTF-8 without a mark of byte order, where the text within has this word at its beginning; else the
/// bytes, which may be no text.
fn utf8<'b>(bytes: &'b [u8], word: &str) -> Cow<'b, [u8]> {
    let begins = |text: &[u8]| {
        // a letter before it may say what vertices have: COFF
        let start = text.trim_ascii_start();
        start.windows(word.len()).take(2).any(|w| w.eq_ignore_ascii_case(word.as_bytes()))
    };
    match text::utf16(bytes) {
        Some((text, _)) if begins(text.as_bytes()) => Cow::Owned(text.into_bytes()),
        _ if begins(text::without_mark(bytes)) => Cow::Borrowed(text::without_mark(bytes)),
        _ => Cow::Borrowed(bytes),
    }
}

/// The objects in the bytes, and in other files that they name. `ending` gives the format.
fn found(bytes: &[u8], ending: &str, files: OtherFiles<'_>) -> Result<Found, Wrong> {
    let pulse = files.parsing(bytes.len());
    match ending {
        "stl" => stl::read(&utf8(bytes, "solid"), &pulse),
        "off" => off::read(&utf8(bytes, "off"), &pulse),
        "ply" => ply::read(&utf8(bytes, "ply")),
        "3mf" => threemf::read(bytes),
        "amf" => amf::read(&utf8(bytes, "<")),
        _ => gltf::read(bytes, files),
    }
}

/// A note on polygons that are no triangles, if there are any.
fn polygons_left_out(pieces: &[Piece]) -> Option<Note> {
    let few: usize = pieces.iter().map(|p| p.few).sum();
    (few > 0).then(|| ("polygons left out", format!("{few} of fewer than three corners")))
}

/// The format of the bytes, if they begin as one of these files does.
pub(super) fn recognise(bytes: &[u8]) -> Option<&'static str> {
    let bytes = text::without_mark(bytes);
    let start = bytes.trim_ascii_start();
    if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        return Some("ply");
    }
    if bytes.starts_with(b"glTF") {
        return Some("glb");
    }
    if off::recognise(start) {
        return Some("off");
    }
    stl::recognise(bytes).then_some("stl")
}

/// Reads a file of triangles.
pub(super) fn read(bytes: &[u8], name: &str, ending: &str, files: OtherFiles<'_>) -> Result<Import, ImportError> {
    let wrong = |w: Wrong| ImportError::Mesh {
        file: match w.line {
            Some(line) => format!("{name}:{line}"),
            None => name.to_owned(),
        },
        message: w.message,
    };
    let Found { format, unit, pieces, mut placements, mut notes, files } =
        found(bytes, ending, files).map_err(wrong)?;
    notes.extend(polygons_left_out(&pieces));
    if pieces.iter().all(|p| p.triangles.is_empty()) {
        let beside: String = notes.iter().take(MOST_TOLD).map(|(kind, note)| format!("; {kind}: {note}")).collect();
        let message = match pieces.iter().map(|p| p.points.len()).sum::<usize>() {
            0 => format!("{format} without a triangle{beside}"),
            points => format!("{format} without a triangle; it holds {points} vertices{beside}"),
        };
        return Err(ImportError::Mesh { file: name.to_owned(), message });
    }
    let mut model = Model { name: stem(name), unit: unit.clone(), ..Model::default() };
    let units = if unit.is_empty() { Vec::new() } else { vec![unit] };
    let mut report = ImportReport { format: format.to_owned(), units, files_read: files, ..ImportReport::default() };
    if placements.is_empty() {
        let all =
            |(piece, p): (usize, &Piece)| Placement { piece, transform: DAffine3::IDENTITY, name: p.name.clone() };
        placements = pieces.iter().enumerate().map(all).collect();
    }
    let placed: HashSet<usize> = placements.iter().map(|p| p.piece).collect();
    for (k, piece) in pieces.iter().enumerate().filter(|(k, p)| !placed.contains(k) && !p.triangles.is_empty()) {
        let called = if piece.name.is_empty() { format!("object {} of the file", k + 1) } else { piece.name.clone() };
        notes.push(("object not placed", called));
    }
    let mut id = 1;
    let mut places = Vec::with_capacity(pieces.len());
    for piece in pieces {
        if piece.triangles.is_empty() {
            places.push(None);
            continue;
        }
        let part = piece.name.clone();
        let meshes = piece.meshes(id, &mut notes).map_err(wrong)?;
        id += meshes.len() as u32;
        report.meshes += meshes.len();
        places.push(Some(model.parts.len()));
        let closed = closed(&meshes);
        model.parts.push(Part { name: part, closed, meshes, ..Part::default() });
    }
    for Placement { piece, transform, name } in placements {
        if let Some(part) = places[piece] {
            model.instances.push(Instance { part, transform, colour: None, name });
        }
    }
    report.bodies = model.parts.len();
    let mut warnings = Warnings::new(name);
    notes.into_iter().for_each(|(kind, note)| warnings.push(kind, || Place::File, || note));
    let warnings = warnings.finish(&mut report);
    Ok(Import { model, warnings, report, ..Import::default() })
}

/// Points, and the corners of triangles among them.
#[cfg(feature = "scad-facets")]
pub(super) type Triangles = (Vec<DVec3>, Vec<[u32; 3]>);

/// The triangles of a file, each object where it stands, and what is left out but colours.
#[cfg(feature = "scad-facets")]
pub(super) fn pieces(bytes: &[u8], ending: &str) -> Result<(Vec<Triangles>, Vec<String>), String> {
    let wrong = |w: Wrong| match w.line {
        Some(line) => format!("line {line}: {}", w.message),
        None => w.message,
    };
    let alone = OtherFiles::new("", None, &super::Options::default());
    let Found { pieces, placements, mut notes, .. } = found(bytes, ending, alone).map_err(wrong)?;
    notes.extend(polygons_left_out(&pieces));
    let lost = notes.into_iter().filter(|(kind, _)| kind.ends_with("left out") && !kind.starts_with("colours"));
    let lost = lost.map(|(kind, note)| format!("{kind}: {note}")).collect();
    if let Some(piece) = pieces.iter().find(|p| p.points.iter().any(|x| !x.is_finite())) {
        return Err(format!("{}: a coordinate is not finite", piece.name));
    }
    if placements.is_empty() {
        return Ok((pieces.into_iter().map(|p| (p.points, p.triangles)).collect(), lost));
    }
    let placed = |p: &Placement| {
        let piece = &pieces[p.piece];
        let turn = |t: &[u32; 3]| if p.transform.matrix3.determinant() < 0.0 { [t[0], t[2], t[1]] } else { *t };
        let points = piece.points.iter().map(|x| p.transform.transform_point3(*x)).collect();
        (points, piece.triangles.iter().map(turn).collect())
    };
    Ok((placements.iter().map(placed).collect(), lost))
}
