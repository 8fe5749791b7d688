//! Pictures as PNG, compressed on all cores.
//!
//! ```text
//!   a stripe of rows ──filters──▶ bytes ──deflate──▶ blocks that end with a whole byte ─┐
//!   the next one     ──filters──▶ bytes ──deflate──▶ blocks, the last of all ───────────┴▶ one zlib stream ──▶ PNG
//! ```
//!
//! Stripes are compressed apart, and are the same for any number of cores: so is the file. Sources: RFC 1950 and 1951;
//! Portable Network Graphics, third edition, section 9 (filters) and 12.7 (their choice).

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rayon::prelude::*;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::mem::{swap, take};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes of a pixel.
const PIXEL: usize = 4;
/// Bytes of a stripe, roughly. Shorter stripes find fewer repetitions.
const STRIPE: usize = 1 << 20;
/// The first bytes of a zlib stream: deflate with a window of 32 KiB, of the usual level.
const ZLIB: [u8; 2] = [0x78, 0x9c];
/// The modulus of zlib's checksum, Adler-32.
const ADLER: u64 = 65_521;
/// The filters that are tried, by their numbers: what is left of a byte beside the pixel before, the one above, and
/// what the two and the one between them predict.
const SUB: u8 = 1;
const UP: u8 = 2;
const PAETH: u8 = 4;

/// Writes sRGB colour and opacity, row 0 on top.
///
/// # Errors
/// Those of `to`; pixels that are no such picture.
pub fn write(to: impl Write, (width, height): (u32, u32), pixels: &[[u8; 4]]) -> io::Result<()> {
    if pixels.len() as u64 != u64::from(width) * u64::from(height) {
        let told = format!("{} pixels are no picture of {width} x {height}", pixels.len());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, told));
    }
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    for part in compressed(pixels.as_flattened(), PIXEL * width as usize)? {
        writer.write_chunk(png::chunk::IDAT, &part)?;
    }
    Ok(writer.finish()?)
}

/// A stripe, deflated, with the checksum and the number of the bytes that it holds.
struct Stripe {
    deflated: Vec<u8>,
    adler: u32,
    bytes: u64,
}

/// The zlib stream of a picture in parts; `row` is the number of bytes of a row.
fn compressed(pixels: &[u8], row: usize) -> io::Result<Vec<Vec<u8>>> {
    let bytes = (STRIPE / row).max(1) * row;
    let stripe = |(n, stripe): (usize, &[u8])| {
        let (first, end) = (n * bytes, n * bytes + stripe.len());
        let above = first.checked_sub(row).map(|from| &pixels[from..first]);
        let rows = filtered(stripe, above, row);
        let (adler, bytes) = (adler2::adler32_slice(&rows), rows.len() as u64);
        Ok(Stripe { deflated: deflated(&rows, end == pixels.len())?, adler, bytes })
    };
    let stripes = pixels.par_chunks(bytes).enumerate().map(stripe).collect::<io::Result<Vec<_>>>()?;
    let adler = stripes.iter().fold(1, |adler, stripe| continued(adler, stripe.adler, stripe.bytes));
    let blocks = stripes.into_iter().map(|stripe| stripe.deflated);
    Ok([ZLIB.to_vec()].into_iter().chain(blocks).chain([adler.to_be_bytes().to_vec()]).collect())
}

/// The checksum of bytes with the checksum `before` and of `count` bytes with the checksum `of` behind them.
fn continued(before: u32, of: u32, count: u64) -> u32 {
    // low: 1 and the sum of all bytes; high: the sum of the low halves after each byte
    let halves = |adler: u32| (u64::from(adler & 0xffff), u64::from(adler >> 16));
    let ((low, high), (more_low, more_high)) = (halves(before), halves(of));
    let more = low + ADLER - 1;
    let (low, high) = ((more + more_low) % ADLER, (high + more_high + count % ADLER * more) % ADLER);
    (high << 16 | low) as u32
}

/// Deflated bytes: a whole stream of blocks if they are the last ones, or blocks that others follow.
fn deflated(bytes: &[u8], are_last: bool) -> io::Result<Vec<u8>> {
    let mut to = DeflateEncoder::new(Vec::new(), Compression::default());
    to.write_all(bytes)?;
    if are_last {
        return to.finish();
    }
    to.flush()?; // an empty block, which ends with a whole byte
    Ok(take(to.get_mut()))
}

/// Each row of a stripe, behind the number of its filter: the one that leaves the smallest bytes. `above` is the row
/// above the stripe, if there is one.
fn filtered(stripe: &[u8], above: Option<&[u8]>, row: usize) -> Vec<u8> {
    // behind a pixel of zeros, which is to the left of every row
    let (mut before, mut now) = (vec![0; PIXEL + row], vec![0; PIXEL + row]);
    if let Some(above) = above {
        before[PIXEL..].copy_from_slice(above);
    }
    let mut trials = [SUB, UP, PAETH].map(|filter| (filter, vec![0; row]));
    let mut rows = Vec::with_capacity(stripe.len() + stripe.len() / row);
    for line in stripe.chunks_exact(row) {
        now[PIXEL..].copy_from_slice(line);
        for (filter, left) in &mut trials {
            let around = line.iter().zip(&now).zip(&before[PIXEL..]).zip(&before);
            let bytes = left.iter_mut().zip(around.map(|(((x, left), up), corner)| (*x, *left, *up, *corner)));
            match *filter {
                SUB => bytes.for_each(|(to, (x, left, ..))| *to = x.wrapping_sub(left)),
                UP => bytes.for_each(|(to, (x, _, up, _))| *to = x.wrapping_sub(up)),
                _ => bytes.for_each(|(to, (x, left, up, corner))| *to = x.wrapping_sub(paeth(left, up, corner))),
            }
        }
        let size = |bytes: &[u8]| bytes.iter().map(|&b| u64::from(b.min(b.wrapping_neg()))).sum::<u64>();
        if let Some((filter, least)) = trials.iter().min_by_key(|(_, left)| size(left)) {
            rows.push(*filter);
            rows.extend_from_slice(least);
        }
        swap(&mut before, &mut now);
    }
    rows
}

/// The one of the bytes to the left, above, and above on the left that is nearest to `left + up - corner`.
fn paeth(left: u8, up: u8, corner: u8) -> u8 {
    let of_corner = (i16::from(left) + i16::from(up) - 2 * i16::from(corner)).unsigned_abs();
    let (of_left, of_up) = (u16::from(up.abs_diff(corner)), u16::from(left.abs_diff(corner)));
    if of_left <= of_up && of_left <= of_corner {
        left
    } else if of_up <= of_corner {
        up
    } else {
        corner
    }
}

/// The same to a file, which appears when it is complete: a failure leaves the old one. A device or a pipe is written
/// where it is.
///
/// # Errors
/// Those of the file; a name that ends in something else than `png`.
pub fn save(path: &Path, size: (u32, u32), pixels: &[[u8; 4]]) -> io::Result<()> {
    if path.extension().is_some_and(|ending| !ending.eq_ignore_ascii_case("png")) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "what is saved is PNG, so its name ends in .png"));
    }
    // the file itself, where the path is a link
    let place = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    match fs::metadata(&place) {
        Ok(found) if !found.is_file() => return filled(&place, size, pixels),
        Ok(found) if found.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
        _ => {}
    }
    // pictures of several threads and processes have names of their own
    static SAVED: AtomicU64 = AtomicU64::new(0);
    let mut name = OsString::from(format!(".part-{}-{}-", std::process::id(), SAVED.fetch_add(1, Ordering::Relaxed)));
    name.push(place.file_name().unwrap_or_default());
    let beside = place.with_file_name(name);
    let saved = filled(&beside, size, pixels).and_then(|()| fs::rename(&beside, &place));
    if saved.is_err() {
        // it may never have been there
        let _ = fs::remove_file(&beside);
    }
    saved
}

fn filled(path: &Path, size: (u32, u32), pixels: &[[u8; 4]]) -> io::Result<()> {
    let mut to = BufWriter::new(File::create(path)?);
    write(&mut to, size, pixels)?;
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pixels of a file, whose checksums are right.
    fn read(file: &[u8]) -> ((u32, u32), Vec<u8>) {
        let mut options = png::DecodeOptions::default();
        options.set_ignore_adler32(false);
        let mut reader = png::Decoder::new_with_options(io::Cursor::new(file), options).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        reader.finish().unwrap();
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
        ((info.width, info.height), pixels)
    }

    /// Random, one colour, shaded; of less than a row, of a long row, of several stripes.
    #[test]
    fn a_decoder_reads_every_pixel() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        };
        for (width, height) in [(1, 1), (3, 5), (1, 70_000), (300_000, 2), (500, 2000)] {
            let count = width as usize * height as usize;
            let noise: Vec<[u8; 4]> = (0..count).map(|_| [random(), random(), random(), random()]).collect();
            let shaded = |n: usize| [(n % 500 / 2) as u8, (n / 3000) as u8, ((n % 500 + n / 500) / 16) as u8, 255];
            for pixels in [noise, vec![[7, 8, 9, 255]; count], (0..count).map(shaded).collect()] {
                let mut file = Vec::new();
                write(&mut file, (width, height), &pixels).unwrap();
                let (size, found) = read(&file);
                assert!(size == (width, height) && found == pixels.as_flattened(), "{width} x {height}");
            }
        }
    }

    /// A picture of one colour has a few bytes a row.
    #[test]
    fn what_repeats_takes_no_room() {
        let mut file = Vec::new();
        write(&mut file, (1000, 1000), &vec![[200, 100, 50, 255]; 1_000_000]).unwrap();
        assert!(file.len() < 20_000, "{} bytes", file.len());
    }

    #[test]
    fn each_row_has_the_filter_that_leaves_least() {
        let pixels = |of: fn(u8, u8) -> u8| -> Vec<u8> {
            (0..3).flat_map(|y| (0..8).flat_map(move |x| [of(x, y); PIXEL])).collect()
        };
        let filters = |bytes: &[u8]| {
            let rows = filtered(bytes, Some(&[90; 8 * PIXEL]), 8 * PIXEL);
            rows.chunks_exact(1 + 8 * PIXEL).map(|row| row[0]).collect::<Vec<_>>()
        };
        assert_eq!(filters(&pixels(|_, y| 120 * (y % 2)))[1..], [SUB, SUB], "rows of one colour each");
        assert_eq!(filters(&pixels(|x, _| 97_u8.wrapping_mul(x)))[1..], [UP, UP], "columns of one colour each");
        let both = |x: u8, y: u8| 100 * if x < 4 { y % 2 } else { x % 2 };
        assert_eq!(filters(&pixels(both))[1..], [PAETH, PAETH], "rows beside columns");
        // 20 + 12 - 21 = 11, to which 12 is nearest; 5 + 9 - 7 = 7
        assert_eq!((paeth(20, 12, 21), paeth(5, 9, 7), paeth(5, 5, 5)), (12, 7, 5));
    }

    /// Of all bytes, by RFC 1950: 1 and the sum, and the sum of the sums, both modulo 65521.
    #[test]
    fn checksums_are_continued() {
        let bytes: Vec<u8> = (0..200_000_u64).map(|n| (n * n >> 3) as u8).collect();
        let whole = bytes.iter().fold((1, 0), |(low, high), &byte| {
            let low = (low + u32::from(byte)) % 65_521;
            (low, (high + low) % 65_521)
        });
        for at in [0, 1, 65_521, 199_999] {
            let (first, rest) = bytes.split_at(at);
            let found = continued(adler2::adler32_slice(first), adler2::adler32_slice(rest), rest.len() as u64);
            assert_eq!(found, whole.1 << 16 | whole.0, "{at}");
        }
    }

    #[test]
    fn a_picture_replaces_another_when_it_is_whole() {
        let folder = std::env::temp_dir().join(format!("selvedge-png-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("a.png");
        let files = || fs::read_dir(&folder).unwrap().count();
        save(&path, (2, 1), &[[1, 2, 3, 4]; 2]).unwrap();
        let old = fs::read(&path).unwrap();
        assert!(old.starts_with(b"\x89PNG") && files() == 1);
        // a pixel is missing
        save(&path, (2, 1), &[[9; 4]]).unwrap_err();
        assert!(fs::read(&path).unwrap() == old && files() == 1);
        save(&path, (1, 1), &[[9; 4]]).unwrap();
        assert!(fs::read(&path).unwrap() != old && files() == 1);
        // someone's model
        let model = folder.join("a.step");
        fs::write(&model, "ISO-10303-21;").unwrap();
        let told = save(&model, (1, 1), &[[9; 4]]).unwrap_err().to_string();
        assert!(told.contains(".png") && fs::read(&model).unwrap() == b"ISO-10303-21;", "{told}");
        save(&folder.join("none/a.png"), (1, 1), &[[9; 4]]).unwrap_err();
        assert_eq!(files(), 2);
        #[cfg(unix)]
        save(Path::new("/dev/null"), (1, 1), &[[9; 4]]).unwrap();
        fs::remove_dir_all(&folder).unwrap();
    }
}
