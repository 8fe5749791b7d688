//! Grids from files: CSV tables of points and 16-bit pictures of heights.
//!
//! ```text
//!   one row of the grid a line:    x,y,z, x,y,z, …      lines of one length; # begins a comment
//! ```

use crate::construct::ConstructError;
use crate::construct::grid::{MOST_POINTS, PointGrid};
use glam::DVec3;

fn data(source_name: String, message: impl ToString) -> ConstructError {
    ConstructError::Data { source_name, message: message.to_string() }
}

/// The grid in a CSV table: a line a row, three numbers a point, no header. `name` is for messages.
///
/// # Errors
/// [`ConstructError::Data`] with file, line and field; errors of [`PointGrid::new`].
pub fn points_from_csv(text: &[u8], name: &str) -> Result<PointGrid, ConstructError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text);
    let mut points = Vec::new();
    let mut width: Option<usize> = None;
    for record in reader.records() {
        let record = record.map_err(|e| data(name.to_owned(), e))?;
        let line = record.position().map_or(0, csv::Position::line);
        let place = |field: usize| format!("{name}, line {line}, field {}", field + 1);
        if record.len() % 3 != 0 {
            return Err(data(place(record.len() - 1), "three numbers make a point; the last one lacks some"));
        }
        let wanted = *width.get_or_insert(record.len());
        if record.len() != wanted {
            let message = format!("{} numbers, but the lines before have {wanted}", record.len());
            return Err(data(place(record.len() - 1), message));
        }
        let mut numbers = Vec::with_capacity(record.len());
        for (i, field) in record.iter().enumerate() {
            match field.parse::<f64>() {
                Ok(x) if x.is_finite() => numbers.push(x),
                _ => return Err(data(place(i), format!("`{field}` is not a finite number"))),
            }
        }
        points.extend(numbers.chunks_exact(3).map(DVec3::from_slice));
    }
    PointGrid::new(width.unwrap_or(0) / 3, points)
}

/// Width and samples of a grey PNG, 8 bits (scaled to 16) or 16 bits deep. `name` is for messages.
///
/// # Errors
/// [`ConstructError::Data`] for other pictures and broken files; more than 2^24 samples.
pub fn heights_from_png(bytes: &[u8], name: &str) -> Result<(usize, Vec<u16>), ConstructError> {
    let fail = |message: String| data(name.to_owned(), message);
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(|e| fail(e.to_string()))?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width.saturating_mul(height) > MOST_POINTS {
        let got = width.saturating_mul(height);
        return Err(ConstructError::TooMany { what: "samples", got, most: MOST_POINTS });
    }
    let (colour, depth) = reader.output_color_type();
    if colour != png::ColorType::Grayscale || !matches!(depth, png::BitDepth::Eight | png::BitDepth::Sixteen) {
        return Err(fail(format!("a grey picture of 8 or 16 bits is wanted, not {colour:?} of {depth:?}")));
    }
    let bytes = if depth == png::BitDepth::Sixteen { 2 } else { 1 };
    let mut raw = vec![0; width * height * bytes];
    if reader.output_buffer_size() != Some(raw.len()) {
        return Err(fail("its rows are not packed as its size says".to_owned()));
    }
    reader.next_frame(&mut raw).map_err(|e| fail(e.to_string()))?;
    let samples = if bytes == 2 {
        raw.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect()
    } else {
        raw.iter().map(|b| u16::from(*b) * 257).collect()
    };
    Ok((width, samples))
}
