//! Pictures, and their images in memory.

use crate::border::{Failure, SelvedgeStatus, Sized, argument, border, free, given, handle, text};
use selvedge::picture::Picture;
use selvedge_jobs::{Image, Values, save_png};
use std::ffi::{c_char, c_void};
use std::path::Path;

/// sRGB and opacity, 4 bytes a pixel; every picture has it.
pub const SELVEDGE_COLOUR: u32 = 1 << 0;
/// Distance along the view axis, millimetres, one float a pixel; +infinity is background.
pub const SELVEDGE_DEPTH: u32 = 1 << 1;
/// Number of the face in the file, one uint32_t a pixel; 0 is background.
pub const SELVEDGE_FACE: u32 = 1 << 2;
/// Parameters in the face's domain, two floats a pixel; NaN is background.
pub const SELVEDGE_UV: u32 = 1 << 3;
/// Unit outward normal in model axes, three floats a pixel; 0 is background.
pub const SELVEDGE_NORMAL: u32 = 1 << 4;
/// Length of the ray within solids and closed parts, millimetres, one float a pixel.
pub const SELVEDGE_THICKNESS: u32 = 1 << 5;
/// Number of the edge whose line covers the pixel, one uint32_t a pixel; 0 is none, 4294967295 the outline of a curved face,
/// 4294967294 a line of a Boolean solid. The colour shows the lines, too.
pub const SELVEDGE_EDGE: u32 = 1 << 6;
/// Index of the part, plus 1, one uint32_t a pixel; 0 is none.
pub const SELVEDGE_PART: u32 = 1 << 7;
/// Index of the instance, plus 1, one uint32_t a pixel; 0 is none.
pub const SELVEDGE_INSTANCE: u32 = 1 << 8;

/// uint8_t
pub const SELVEDGE_UINT8: u32 = 1;
/// uint32_t
pub const SELVEDGE_UINT32: u32 = 2;
/// float
pub const SELVEDGE_FLOAT32: u32 = 3;

const FLAGS: [(u32, Image); 8] = [
    (SELVEDGE_DEPTH, Image::Depth),
    (SELVEDGE_FACE, Image::Face),
    (SELVEDGE_UV, Image::Uv),
    (SELVEDGE_NORMAL, Image::Normal),
    (SELVEDGE_THICKNESS, Image::Thickness),
    (SELVEDGE_EDGE, Image::Edge),
    (SELVEDGE_PART, Image::Part),
    (SELVEDGE_INSTANCE, Image::Instance),
];

/// The images of some flags.
pub fn images(flags: u32) -> Result<Vec<Image>, Failure> {
    let known = FLAGS.iter().fold(SELVEDGE_COLOUR, |all, (flag, _)| all | flag);
    if flags & !known != 0 {
        return Err(argument(format!("no image has the flag {:#x}", flags & !known)));
    }
    Ok(FLAGS.iter().filter(|(flag, _)| flags & flag != 0).map(|(_, image)| *image).collect())
}

/// A finished picture.
pub struct SelvedgePicture {
    picture: Picture,
    outputs: u32,
}

/// An image of a picture: rows without gaps, the first on top, the channels of a pixel together.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeImage {
    /// sizeof(SelvedgeImage)
    pub struct_size: usize,
    /// width x height x channels numbers; lives as long as the picture.
    pub data: *const c_void,
    /// SELVEDGE_UINT8, SELVEDGE_UINT32 or SELVEDGE_FLOAT32.
    pub kind: u32,
    /// Numbers a pixel.
    pub channels: u32,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
}

// SAFETY: begins with its size and consists of numbers and pointers
unsafe impl Sized for SelvedgeImage {}

impl SelvedgePicture {
    pub(crate) fn boxed(picture: Picture, outputs: u32) -> *mut Self {
        Box::into_raw(Box::new(Self { picture, outputs }))
    }
}

/// Fills `image`, whose struct_size is set, with the one of this flag: SELVEDGE_COLOUR, or one of the view's outputs.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_picture_image(
    picture: *const SelvedgePicture,
    which: u32,
    image: *mut SelvedgeImage,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let SelvedgePicture { picture, outputs } = unsafe { handle("picture", picture) }?;
        let wanted = images(which)?;
        let (data, kind, channels) = match (which, wanted.as_slice()) {
            (SELVEDGE_COLOUR, _) => (picture.colour.as_ptr().cast(), SELVEDGE_UINT8, 4),
            (_, [one]) if outputs & which == which => match one.of(picture) {
                Values::Floats(channels, values) => (values.as_ptr().cast(), SELVEDGE_FLOAT32, channels as u32),
                Values::Numbers(values) => (values.as_ptr().cast(), SELVEDGE_UINT32, 1),
            },
            (_, [one]) => return Err(argument(format!("the picture was drawn without its {}", one.name()))),
            _ => return Err(argument("one image at a time")),
        };
        let (width, height) = picture.size;
        // SAFETY: as the caller promises
        unsafe { given(image, SelvedgeImage { struct_size: 0, data, kind, channels, width, height }) }
    })
}

/// Places where the frame could not keep the promise of accuracy; 0 in a good picture, and for null.
///
/// # Safety
/// Null, or a picture.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_picture_clamps(picture: *const SelvedgePicture) -> u64 {
    // SAFETY: as the caller promises
    unsafe { picture.as_ref() }.map_or(0, |p| p.picture.stats.clamps)
}

/// Writes the colour as a PNG file.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_picture_save_png(
    picture: *const SelvedgePicture,
    path: *const c_char,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (picture, path) = unsafe { (handle("picture", picture)?, text("the path", path)?) };
        let path = path.ok_or_else(|| argument("the path is a null pointer"))?;
        let saved = save_png(Path::new(path), picture.picture.size, &picture.picture.colour);
        saved.map_err(|error| Failure(SelvedgeStatus::File, format!("cannot write {path}: {error}")))
    })
}

/// Frees a picture and its images; null is allowed.
///
/// # Safety
/// This library made it, and no other call uses it at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_picture_free(picture: *mut SelvedgePicture) {
    // SAFETY: as the caller promises
    unsafe { free(picture) }
}
