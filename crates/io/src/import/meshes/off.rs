//! OFF of Geomview, text.
//!
//! ```text
//!   OFF                     or COFF: vertices with colours, used where they are one colour
//!   8 6 12                  vertices, faces, edges (not used); may stand on the first line
//!   x y z                   a line each
//!   4 0 1 2 3  [r g b [a]]  corners from 0; colours of 0 to 255, or of 0.0 to 1.0
//! ```
//!
//! Source: *Geomview Manual*, OFF.

use super::{Found, Piece, Wrong};
use crate::import::Pulse;
use crate::import::colour::linear;
use crate::model::Colour;
use glam::DVec3;

pub(super) fn recognise(start: &[u8]) -> bool {
    let word = start.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    word == b"OFF" || word == b"COFF"
}

/// Reads the text; a vertex or a face is one piece of work.
pub(super) fn read(bytes: &[u8], pulse: &Pulse<'_>) -> Result<Found, Wrong> {
    let text = String::from_utf8_lossy(bytes);
    let lines = text.lines().zip(1..).map(|(l, n)| (l.split('#').next().unwrap_or_default().trim(), n));
    let mut lines = lines.filter(|(l, _)| !l.is_empty()).peekable();
    let (first, line) = lines.next().ok_or_else(|| Wrong::new("an empty file"))?;
    let coloured = first.starts_with("COFF");
    let head = ["COFF", "OFF"].into_iter().find_map(|h| first.strip_prefix(h)).map(str::trim);
    let head = head.ok_or_else(|| Wrong::at(line, "the first word is neither OFF nor COFF"))?;
    let (counts, line) = if head.is_empty() {
        lines.next().ok_or_else(|| Wrong::at(line, "cut off: no numbers of vertices and faces"))?
    } else {
        (head, line)
    };
    let counts: Option<Vec<usize>> = counts.split_whitespace().take(2).map(|w| w.parse().ok()).collect();
    let Some([vertices, faces]) = counts.as_deref() else {
        return Err(Wrong::at(line, "no numbers of vertices and faces"));
    };
    let mut piece = Piece::default();
    let mut notes = Vec::new();
    let mut last = line;
    // the first vertex's colour, whether others have another, numbers that are no colour
    let (mut own, mut varies, mut unread) = (None, false, 0);
    for k in 0..*vertices {
        pulse.work(1);
        let (content, line) =
            lines.next().ok_or_else(|| Wrong::at(last, format!("cut off: {k} of {vertices} vertices")))?;
        let number = |w: &str| w.parse::<f64>().ok().filter(|x| x.is_finite());
        let words: Vec<&str> = content.split_whitespace().collect();
        let p: Option<Vec<f64>> = words.iter().copied().take(3).map(number).collect();
        let p = p.filter(|p| p.len() == 3).ok_or_else(|| Wrong::at(line, "a vertex without three finite numbers"))?;
        piece.points.push(DVec3::from_slice(&p));
        let this = if coloured { colour(&words[3..]) } else { None };
        unread += usize::from(words.len() > 3 && this.is_none());
        own = if k == 0 { this } else { own };
        varies |= this != own;
        last = line;
    }
    for k in 0..*faces {
        pulse.work(1);
        let (content, line) = lines.next().ok_or_else(|| Wrong::at(last, format!("cut off: {k} of {faces} faces")))?;
        let mut words = content.split_whitespace();
        let count: Option<usize> = words.next().and_then(|w| w.parse().ok());
        let count = count.ok_or_else(|| Wrong::at(line, "a face without its number of corners"))?;
        let corners: Option<Vec<u32>> = words.by_ref().take(count).map(|w| w.parse().ok()).collect();
        let corners = corners
            .filter(|c| c.len() == count)
            .ok_or_else(|| Wrong::at(line, format!("a face without {count} corners")))?;
        let words: Vec<&str> = words.collect();
        let this = colour(&words);
        unread += usize::from(!words.is_empty() && this.is_none());
        let this = this.or(if varies { None } else { own });
        piece.polygon(&corners, this).map_err(|what| Wrong::at(line, what))?;
        last = line;
    }
    if let Some((_, line)) = lines.next() {
        notes.push(("lines left out", format!("line {line} follows the last face")));
    }
    if varies {
        notes.push(("colours left out", "colours of vertices, which vary over triangles".to_owned()));
    }
    if unread > 0 {
        notes.push(("colours left out", format!("{unread} lines end in numbers that are no colour here")));
    }
    Ok(Found { format: "OFF", pieces: vec![piece], notes, ..Found::default() })
}

/// Whole numbers are of 255; a single number names an entry of a table that no reader has.
fn colour(words: &[&str]) -> Option<Colour> {
    if words.len() < 3 {
        return None;
    }
    let whole = words.iter().all(|w| w.parse::<u32>().is_ok());
    let part = |w: &&str| w.parse::<f64>().ok().map(|x| if whole { x / 255.0 } else { x });
    let parts: Vec<f64> = words.iter().map(part).collect::<Option<_>>()?;
    Some(linear([parts[0], parts[1], parts[2]], parts.get(3).copied().unwrap_or(1.0)))
}
