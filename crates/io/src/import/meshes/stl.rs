//! STL, the text and the binary form.
//!
//! ```text
//!   solid NAME                              80 bytes, number of triangles (u32), then 50 bytes each:
//!     facet normal nx ny nz                 normal, three corners (f32 × 12), two bytes that may be a colour
//!       outer loop
//!         vertex x y z  (three times)       Normals are not used: they repeat the corners, or are wrong.
//!       endloop
//!     endfacet                              Colours: Magics where the header says COLOR=, else VisCAM where
//!   endsolid                                all triangles have one
//! ```
//!
//! Sources: 3D Systems, *StereoLithography Interface Specification*, 1989; Materialise Magics and VisCAM for colours.

use super::{Found, Piece, Shared, Wrong};
use crate::import::Pulse;
use crate::import::colour::linear;
use crate::model::Colour;
use glam::DVec3;

const HEADER: usize = 84;
const RECORD: usize = 50;

/// A binary file of the length that it states, or text that begins with a solid and a facet.
pub(super) fn recognise(bytes: &[u8]) -> bool {
    if stated(bytes).is_some_and(|n| n > 0 && bytes.len() == HEADER + RECORD * n) {
        return true;
    }
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]).to_ascii_lowercase();
    head.trim_start().starts_with("solid") && head.contains("facet") && head.contains("vertex")
}

/// The number of triangles that a binary file states.
fn stated(bytes: &[u8]) -> Option<usize> {
    Some(u32::from_le_bytes(bytes.get(80..HEADER)?.try_into().ok()?) as usize)
}

/// Reads either form; a triangle or a line is one piece of work.
pub(super) fn read(bytes: &[u8], pulse: &Pulse<'_>) -> Result<Found, Wrong> {
    let exact = stated(bytes).is_some_and(|n| bytes.len() == HEADER + RECORD * n);
    let start = bytes.trim_ascii_start();
    let text = start.len() >= 5 && start[..5].eq_ignore_ascii_case(b"solid");
    if exact || !text || bytes[..bytes.len().min(1024)].contains(&0) {
        binary(bytes, pulse)
    } else {
        ascii(bytes, pulse)
    }
}

fn binary(bytes: &[u8], pulse: &Pulse<'_>) -> Result<Found, Wrong> {
    let count = stated(bytes).ok_or_else(|| Wrong::new("cut off: the header of a binary STL has 84 bytes"))?;
    let there = (bytes.len() - HEADER) / RECORD;
    if there < count {
        return Err(Wrong::new(format!("cut off: {there} of the {count} triangles that it states")));
    }
    let mut notes = Vec::new();
    let rest = bytes.len() - HEADER - RECORD * count;
    if rest > 0 {
        notes.push(("bytes left out", format!("{rest} bytes follow the last triangle")));
    }
    let mut shared = Shared::default();
    let mut piece = Piece::default();
    let mut attributes = Vec::with_capacity(count);
    for (t, record) in bytes[HEADER..].chunks_exact(RECORD).take(count).enumerate() {
        pulse.work(1);
        let number = |at: usize| {
            let at = 4 * at;
            f64::from(f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]))
        };
        let corner = |k: usize| DVec3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2));
        let corners = [corner(1), corner(2), corner(3)];
        if corners.iter().any(|p| !p.is_finite()) {
            return Err(Wrong::new(format!("triangle {}: a coordinate is not finite", t + 1)));
        }
        piece.triangles.push(corners.map(|p| shared.number(p)));
        attributes.push(u16::from_le_bytes([record[48], record[49]]));
    }
    piece.points = shared.points;
    let magics = bytes[..80].windows(6).position(|w| w == b"COLOR=").and_then(|at| bytes[..80].get(at + 6..at + 10));
    piece.colours = match magics {
        Some(whole) => {
            let whole = linear([0, 1, 2].map(|i| f64::from(whole[i]) / 255.0), f64::from(whole[3]) / 255.0);
            let own = |a: &u16| if a >> 15 == 0 { five_bits([*a, a >> 5, a >> 10]) } else { whole };
            attributes.iter().map(|a| Some(own(a))).collect()
        }
        None if attributes.iter().all(|a| a >> 15 == 1) => {
            attributes.iter().map(|a| Some(five_bits([a >> 10, a >> 5, *a]))).collect()
        }
        None => {
            let other = attributes.iter().filter(|a| **a != 0).count();
            if other > 0 {
                notes.push((
                    "colours not used",
                    format!("{other} of {count} triangles have an attribute, and not all a colour"),
                ));
            }
            Vec::new()
        }
    };
    Ok(Found { format: "STL, binary", pieces: vec![piece], notes, ..Found::default() })
}

fn five_bits(c: [u16; 3]) -> Colour {
    linear(c.map(|c| f64::from(c & 31) / 31.0), 1.0)
}

fn ascii(bytes: &[u8], pulse: &Pulse<'_>) -> Result<Found, Wrong> {
    let text = String::from_utf8_lossy(bytes);
    let mut pieces: Vec<(Piece, Shared)> = Vec::new();
    let mut corners: Option<Vec<u32>> = None; // of the loop that is being read
    let (mut open, mut last) = (false, 0);
    for (content, line) in text.lines().zip(1..) {
        pulse.work(1);
        let mut words = content.split_whitespace();
        let Some(keyword) = words.next().map(str::to_ascii_lowercase) else { continue };
        last = line;
        match (keyword.as_str(), pieces.last_mut(), &mut corners) {
            ("solid" | "endsolid" | "facet" | "endfacet" | "outer", _, Some(_)) => {
                return Err(Wrong::at(line, format!("`{keyword}` before the end of a loop")));
            }
            ("solid", ..) => {
                let name = words.collect::<Vec<_>>().join(" ");
                pieces.push((Piece { name, ..Piece::default() }, Shared::default()));
                open = true;
            }
            ("facet" | "endfacet", Some(_), _) => {}
            ("endsolid", Some(_), _) => open = false,
            ("outer", Some(_), _) => corners = Some(Vec::new()),
            ("vertex", Some((_, shared)), Some(corners)) => {
                let number = |w: &str| w.parse::<f64>().ok().filter(|x| x.is_finite());
                let p: Option<Vec<f64>> = words.take(3).map(number).collect();
                let p = p
                    .filter(|p| p.len() == 3)
                    .ok_or_else(|| Wrong::at(line, "a vertex without three finite numbers"))?;
                corners.push(shared.number(DVec3::from_slice(&p)));
            }
            ("endloop", Some((piece, shared)), open) => {
                let face = open.take().unwrap_or_default();
                if face.len() < 3 {
                    return Err(Wrong::at(line, format!("a facet of {} corners", face.len())));
                }
                std::mem::swap(&mut piece.points, &mut shared.points);
                let made = piece.polygon(&face, None);
                std::mem::swap(&mut piece.points, &mut shared.points);
                made.map_err(|what| Wrong::at(line, what))?;
            }
            _ => return Err(Wrong::at(line, format!("`{keyword:.20}` where STL has no such word"))),
        }
    }
    if corners.is_some() {
        return Err(Wrong::at(last, "cut off: the file ends inside a facet"));
    }
    let mut notes = Vec::new();
    if open {
        notes.push(("solid not ended", format!("line {last}: the file ends without `endsolid`")));
    }
    let done = |(piece, shared): (Piece, Shared)| Piece { points: shared.points, ..piece };
    Ok(Found { format: "STL, text", pieces: pieces.into_iter().map(done).collect(), notes, ..Found::default() })
}
