//! Height maps: `surface(file)`, a text of numbers or a picture.
//!
//! ```text
//!   a ─── b      four triangles a square, around the mean of its corners;
//!   │ ╲ ╱ │      below, a wall down to 1 under the lowest point
//!   │  m  │
//!   │ ╱ ╲ │      text: the first row is that of y = 0; picture: the last row is,
//!   c ─── d      and white is 100 high
//! ```
//!
//! Source: `SurfaceNode` of OpenSCAD 2021.01.

use super::solid::Triangles;
use glam::DVec3;

/// Points of a map.
const MOST_POINTS: usize = 4_000_000;

/// Heights by rows, from y = 0.
#[derive(Debug, PartialEq)]
pub(super) struct Relief {
    width: usize,
    heights: Vec<f64>,
}

/// A picture or a text.
pub(super) fn read(bytes: &[u8], inverted: bool) -> Result<Relief, String> {
    let relief = if bytes.starts_with(b"\x89PNG") { picture(bytes, inverted)? } else { table(bytes)? };
    let rows = relief.heights.len() / relief.width.max(1);
    if relief.width < 2 || rows < 2 {
        return Err(format!("{} by {rows} heights are no surface", relief.width));
    }
    Ok(relief)
}

/// Rows of numbers; shorter ones are filled with the least of all.
fn table(bytes: &[u8]) -> Result<Relief, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "neither text nor a PNG picture")?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (line, content) in text.lines().enumerate() {
        let content = content.split('#').next().unwrap_or_default();
        let number = |w: &str| w.parse::<f64>().ok().filter(|x| x.is_finite());
        let row: Option<Vec<f64>> = content.split_whitespace().map(number).collect();
        let row = row.ok_or_else(|| format!("line {} holds something that is no finite number", line + 1))?;
        if !row.is_empty() {
            rows.push(row);
        }
    }
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    if width.saturating_mul(rows.len()) > MOST_POINTS {
        return Err(format!("{width} by {} heights are too many", rows.len()));
    }
    let least = rows.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    rows.iter_mut().for_each(|row| row.resize(width, least));
    Ok(Relief { width, heights: rows.concat() })
}

fn picture(bytes: &[u8], inverted: bool) -> Result<Relief, String> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.saturating_mul(height) > MOST_POINTS {
        return Err(format!("{width} by {height} pixels are too many"));
    }
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("a picture that is too large")?];
    let frame = reader.next_frame(&mut pixels).map_err(|e| e.to_string())?;
    let samples = frame.color_type.samples();
    let height_of = |p: &[u8]| {
        let [r, g, b] = if samples < 3 { [p[0]; 3] } else { [p[0], p[1], p[2]] }.map(f64::from);
        let light = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        100.0 / 255.0 * if inverted { 1.0 - light } else { light }
    };
    let rows = pixels.chunks_exact(frame.line_size).take(height).rev();
    let heights = rows.flat_map(|row| row.chunks_exact(samples).take(width).map(height_of)).collect();
    Ok(Relief { width, heights })
}

impl Relief {
    /// The solid under the surface, its corner at the origin or its middle there.
    pub fn mesh(&self, centred: bool) -> Triangles {
        let (w, h) = (self.width, self.heights.len() / self.width);
        let base = self.heights.iter().copied().fold(f64::INFINITY, f64::min) - 1.0;
        let shift = if centred { 0.5 * DVec3::new(w as f64 - 1.0, h as f64 - 1.0, 0.0) } else { DVec3::ZERO };
        let place = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) - shift;
        let at = |x: usize, y: usize| self.heights[y * w + x];
        let mut points = Vec::with_capacity(3 * w * h);
        for y in 0..h {
            points.extend((0..w).map(|x| place(x as f64, y as f64, at(x, y))));
        }
        for y in 0..h - 1 {
            points.extend((0..w - 1).map(|x| {
                let mean = 0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1));
                place(x as f64 + 0.5, y as f64 + 0.5, mean)
            }));
        }
        let number = |x: usize, y: usize| (y * w + x) as u32;
        let mut triangles = Vec::with_capacity(4 * w * h);
        for y in 0..h - 1 {
            for x in 0..w - 1 {
                let [a, b, c, d] = [number(x, y), number(x + 1, y), number(x + 1, y + 1), number(x, y + 1)];
                let m = (w * h + y * (w - 1) + x) as u32;
                triangles.extend([[a, b, m], [b, c, m], [c, d, m], [d, a, m]]);
            }
        }
        // around the rim, counter-clockwise from above
        let bottom = (0..w - 1).map(|x| (x, 0));
        let right = (0..h - 1).map(|y| (w - 1, y));
        let top = (1..w).rev().map(|x| (x, h - 1));
        let left = (1..h).rev().map(|y| (0, y));
        let rim: Vec<(usize, usize)> = bottom.chain(right).chain(top).chain(left).collect();
        let first = points.len() as u32;
        points.extend(rim.iter().map(|&(x, y)| place(x as f64, y as f64, base)));
        points.push(place(0.5 * (w as f64 - 1.0), 0.5 * (h as f64 - 1.0), base));
        let middle = points.len() as u32 - 1;
        for k in 0..rim.len() {
            let next = (k + 1) % rim.len();
            let [p, q] = [rim[k], rim[next]].map(|(x, y)| number(x, y));
            let [low, after] = [first + k as u32, first + next as u32];
            triangles.extend([[low, after, q], [low, q, p], [after, low, middle]]);
        }
        Triangles { points, triangles }
    }
}
