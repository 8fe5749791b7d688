//! Models in memory.

use crate::border::{
    Failure, SelvedgeStatus, Sized, argument, border, c_text, free, given, handle, place, taken, text,
};
use selvedge_jobs::{Loaded, ReadOptions, Snapper, Source, Stop, bounds, read};
use std::ffi::{CString, c_char, c_void};
use std::path::Path;
use std::ptr::null;
use std::sync::OnceLock;
use std::time::Duration;

/// A model. Free it with selvedge_model_free; renderers and pictures do not need it any more then.
pub struct SelvedgeModel {
    pub(crate) loaded: Loaded,
    summary: CString,
    /// File and message of each warning.
    warnings: Vec<(CString, CString)>,
    /// Made by the first call that snaps.
    pub(crate) snapper: OnceLock<Snapper>,
}

/// How to read. Zeros are the defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeReadOptions {
    /// sizeof(SelvedgeReadOptions)
    pub struct_size: usize,
    /// Most bytes of a file, gzip undone; 0: three quarters of the machine's memory.
    pub limit_bytes: u64,
    /// If this is not 0, a file fails with SELVEDGE_STATUS_FILE when anything of it is left out.
    pub strict: u32,
    /// Most seconds for reading a file, beyond which it fails with SELVEDGE_STATUS_FILE; 0: no limit.
    pub limit_s: f64,
}

/// Counts and extent of a model.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeModelInfo {
    /// sizeof(SelvedgeModelInfo)
    pub struct_size: usize,
    /// Smallest coordinates, millimetres.
    pub low: [f64; 3],
    /// Largest coordinates.
    pub high: [f64; 3],
    /// Distinct bodies; images of parts count them from 1.
    pub parts: u64,
    /// Placed bodies; images of instances count them from 1.
    pub instances: u64,
    /// Distinct faces.
    pub faces: u64,
    /// See selvedge_model_warning.
    pub warnings: u64,
    /// 1: nothing of the file is left out.
    pub complete: u32,
    /// The drawn and the missing parts, one sentence; lives as long as the model.
    pub summary: *const c_char,
}

/// Something in the file that was left out, repaired or guessed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeWarning {
    /// sizeof(SelvedgeWarning)
    pub struct_size: usize,
    /// The file; lives as long as the model, as does the message.
    pub file: *const c_char,
    /// The fault, and what was done about it.
    pub message: *const c_char,
    /// Counted from 1; 0 for the file as a whole.
    pub line: u64,
    /// Number of the entity, of STEP's #123 it is 123; 0 for none.
    pub entity: u32,
    /// How many occurrences this one stands for.
    pub count: u64,
}

// SAFETY: each begins with its size and consists of numbers and pointers
unsafe impl Sized for SelvedgeReadOptions {}
// SAFETY: as above
unsafe impl Sized for SelvedgeModelInfo {}
// SAFETY: as above
unsafe impl Sized for SelvedgeWarning {}

/// Reads a file: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, .csg and others, by its content. `options`
/// may be null.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_open(
    path: *const c_char,
    options: *const SelvedgeReadOptions,
    model: *mut *mut SelvedgeModel,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (place, path, options) = unsafe { (place(model)?, text("the path", path)?, options_of(options)?) };
        let path = path.ok_or_else(|| argument("the path is a null pointer"))?;
        *place = SelvedgeModel::boxed(Source::Path(Path::new(path)), options)?;
        Ok(())
    })
}

/// The same of a file's content. `name` is its name in messages, and the name's ending gives the format where the
/// content does not.
///
/// # Safety
/// Pointers are null or point to what they say; `bytes` to `count` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_open_bytes(
    bytes: *const c_void,
    count: usize,
    name: *const c_char,
    options: *const SelvedgeReadOptions,
    model: *mut *mut SelvedgeModel,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (place, name, options) = unsafe { (place(model)?, text("the name", name)?, options_of(options)?) };
        if bytes.is_null() || isize::try_from(count).is_err() {
            return Err(argument("the bytes are a null pointer, or more than memory has"));
        }
        // SAFETY: as the caller promises
        let bytes = unsafe { std::slice::from_raw_parts(bytes.cast(), count) };
        *place = SelvedgeModel::boxed(Source::Bytes { bytes, name: name.unwrap_or("bytes") }, options)?;
        Ok(())
    })
}

/// # Safety
/// As [`taken`].
unsafe fn options_of(from: *const SelvedgeReadOptions) -> Result<SelvedgeReadOptions, Failure> {
    // SAFETY: as the caller promises
    unsafe { taken(from, SelvedgeReadOptions { struct_size: 0, limit_bytes: 0, strict: 0, limit_s: 0.0 }) }
}

impl SelvedgeModel {
    fn boxed(source: Source<'_>, options: SelvedgeReadOptions) -> Result<*mut Self, Failure> {
        let seconds = options.limit_s;
        if !(seconds >= 0.0 && seconds.is_finite()) {
            return Err(argument(format!("limit_s must be a number of seconds, not {seconds}")));
        }
        let duration = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        let how = ReadOptions {
            most_bytes: Some(options.limit_bytes).filter(|n| *n > 0),
            most_time: Some(duration).filter(|_| seconds > 0.0),
            ..ReadOptions::default()
        };
        let loaded = read(source, &how, &Stop::default(), &|_| ())?;
        if options.strict != 0 && !loaded.summary.is_complete() {
            return Err(Failure(SelvedgeStatus::File, format!("{}: {}", loaded.file, loaded.summary)));
        }
        let summary = c_text(&loaded.summary.to_string());
        let warnings = loaded.warnings.iter().map(|w| (c_text(&w.file), c_text(&w.message))).collect();
        Ok(Box::into_raw(Box::new(Self { loaded, summary, warnings, snapper: OnceLock::new() })))
    }
}

/// Fills `info`, whose struct_size is set.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_model_info(
    model: *const SelvedgeModel,
    info: *mut SelvedgeModelInfo,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let SelvedgeModel { loaded, summary, warnings, .. } = unsafe { handle("model", model) }?;
        let bounds = bounds(&loaded.model);
        let value = SelvedgeModelInfo {
            struct_size: 0,
            low: bounds.min.into(),
            high: bounds.max.into(),
            parts: loaded.model.parts.len() as u64,
            instances: loaded.model.instances.len() as u64,
            faces: loaded.model.face_count() as u64,
            warnings: warnings.len() as u64,
            complete: loaded.summary.is_complete().into(),
            summary: summary.as_ptr(),
        };
        // SAFETY: as the caller promises
        unsafe { given(info, value) }
    })
}

/// Fills `warning`, whose struct_size is set, with the one of this index, counted from 0.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_model_warning(
    model: *const SelvedgeModel,
    index: u64,
    warning: *mut SelvedgeWarning,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let model = unsafe { handle("model", model) }?;
        let at =
            usize::try_from(index).ok().and_then(|i| Some((model.loaded.warnings.get(i)?, model.warnings.get(i)?)));
        let (noted, (file, message)) =
            at.ok_or_else(|| argument(format!("there is no warning {index}: there are {}", model.warnings.len())))?;
        let (line, entity) = noted.place.numbers();
        let value = SelvedgeWarning {
            struct_size: 0,
            file: file.as_ptr(),
            message: message.as_ptr(),
            line: line.map_or(0, |line| line as u64),
            entity: entity.unwrap_or(0),
            count: noted.count as u64,
        };
        // SAFETY: as the caller promises
        unsafe { given(warning, value) }
    })
}

/// Frees a model; null is allowed.
///
/// # Safety
/// This library made it, and no other call uses it at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_model_free(model: *mut SelvedgeModel) {
    // SAFETY: as the caller promises
    unsafe { free(model) }
}

/// No text.
pub const NO_TEXT: *const c_char = null();
