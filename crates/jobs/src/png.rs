//! Pictures as PNG.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes sRGB colour and opacity, row 0 on top.
///
/// # Errors
/// Those of `to`.
pub fn write(to: impl Write, (width, height): (u32, u32), pixels: &[[u8; 4]]) -> io::Result<()> {
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.as_flattened())?;
    Ok(writer.finish()?)
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
