//! PLY, text and binary, by ply-rs.
//!
//! ```text
//!   element vertex: x y z [red green blue [alpha]]     element face: a list of corners [red green blue [alpha]]
//! ```
//!
//! Triangles may stand in strips (`tristrips`), which -1 ends. Colours of vertices would vary over a triangle: where
//! they differ they are left out, with a warning.
//!
//! Source: G. Turk, *The PLY Polygon File Format*, 1994.

use super::{Found, Piece, Wrong};
use crate::import::colour::linear;
use crate::model::Colour;
use glam::DVec3;
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// What is kept of an element.
#[derive(Default)]
struct Element {
    place: DVec3,
    corners: Vec<i64>,
    /// Red, green, blue, opacity, each of 1.
    colour: [Option<f64>; 4],
}

impl Element {
    fn colour(&self) -> Option<Colour> {
        let [Some(r), Some(g), Some(b), a] = self.colour else { return None };
        Some(linear([r, g, b], a.unwrap_or(1.0)))
    }
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self { place: DVec3::NAN, ..Self::default() }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let (number, most) = match &property {
            Property::Char(x) => (f64::from(*x), 127.0),
            Property::UChar(x) => (f64::from(*x), 255.0),
            Property::Short(x) => (f64::from(*x), 32767.0),
            Property::UShort(x) => (f64::from(*x), 65535.0),
            Property::Int(x) => (f64::from(*x), 255.0),
            Property::UInt(x) => (f64::from(*x), 255.0),
            Property::Float(x) => (f64::from(*x), 1.0),
            Property::Double(x) => (*x, 1.0),
            _ => (f64::NAN, 1.0),
        };
        let part = Some(number / most);
        match name {
            "x" => self.place.x = number,
            "y" => self.place.y = number,
            "z" => self.place.z = number,
            "red" | "diffuse_red" => self.colour[0] = part,
            "green" | "diffuse_green" => self.colour[1] = part,
            "blue" | "diffuse_blue" => self.colour[2] = part,
            "alpha" => self.colour[3] = part,
            "vertex_indices" | "vertex_index" => self.corners = numbers(property),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

/// A list of other numbers has one value, which is no vertex and ends no strip.
fn numbers(list: Property) -> Vec<i64> {
    match list {
        Property::ListChar(l) => l.into_iter().map(i64::from).collect(),
        Property::ListUChar(l) => l.into_iter().map(i64::from).collect(),
        Property::ListShort(l) => l.into_iter().map(i64::from).collect(),
        Property::ListUShort(l) => l.into_iter().map(i64::from).collect(),
        Property::ListInt(l) => l.into_iter().map(i64::from).collect(),
        Property::ListUInt(l) => l.into_iter().map(i64::from).collect(),
        _ => vec![i64::MIN],
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Found, Wrong> {
    // the library's messages go on with the line and with its grammar
    let wrong = |e: &dyn std::fmt::Display| {
        let message = e.to_string();
        Wrong::new(format!("cut off or no PLY: {}", message.lines().next().unwrap_or_default()))
    };
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(|e| wrong(&e))?;
    for element in header.elements.values() {
        // an element takes a byte at least, but for one without properties
        if element.count > bytes.len() {
            return Err(Wrong::new(format!("{} of `{}` are more than the file holds", element.count, element.name)));
        }
    }
    let mut payload = parser.read_payload(&mut reader, &header).map_err(|e| wrong(&e))?;
    let vertices = payload.shift_remove("vertex").unwrap_or_default();
    let faces = payload.shift_remove("face").unwrap_or_default();
    let strips = payload.shift_remove("tristrips").unwrap_or_default();
    let mut piece = Piece { points: vertices.iter().map(|v| v.place).collect(), ..Piece::default() };
    if let Some(k) = piece.points.iter().position(|p| !p.is_finite()) {
        return Err(Wrong::new(format!("vertex {k}: a coordinate is not there or not finite")));
    }
    let own = vertices.first().and_then(Element::colour);
    let varies = vertices.iter().any(|v| v.colour() != own);
    let mut notes = Vec::new();
    for (k, face) in faces.iter().enumerate() {
        let corners: Option<Vec<u32>> = face.corners.iter().map(|i| u32::try_from(*i).ok()).collect();
        let corners = corners.ok_or_else(|| Wrong::new(format!("face {k}: a corner that is no vertex")))?;
        let colour = face.colour().or(own.filter(|_| !varies));
        piece.polygon(&corners, colour).map_err(|what| Wrong::new(format!("face {k}: {what}")))?;
    }
    for (k, strip) in strips.iter().flat_map(|s| s.corners.split(|i| *i == -1)).enumerate() {
        let corners: Option<Vec<u32>> = strip.iter().map(|i| u32::try_from(*i).ok()).collect();
        let corners = corners.ok_or_else(|| Wrong::new(format!("strip {k}: a corner that is no vertex")))?;
        for (turn, w) in corners.windows(3).enumerate().filter(|(_, w)| w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) {
            let triangle = if turn.is_multiple_of(2) { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            let colour = own.filter(|_| !varies);
            piece.polygon(&triangle, colour).map_err(|what| Wrong::new(format!("strip {k}: {what}")))?;
        }
    }
    if varies {
        notes.push(("colours left out", "colours of vertices, which vary over triangles".to_owned()));
    }
    for (name, left) in payload.iter().filter(|(_, l)| !l.is_empty()) {
        notes.push(("elements left out", format!("{} of `{name}`", left.len())));
    }
    Ok(Found { format: "PLY", pieces: vec![piece], notes, ..Found::default() })
}
