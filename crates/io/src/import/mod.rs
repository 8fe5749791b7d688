//! CAD files in, [`Model`]s out.
//!
//! ```text
//!   path ──read, gunzip──▶ bytes ──format by content──▶ step, iges ───┬─▶ Import { model, warnings, report }
//!                                                    ├▶ obj, bv ─────┤
//!                                                    ├▶ rhino ───────┤
//!                                                    ├▶ meshes ──────┤  STL, OFF, PLY, 3MF, AMF, glTF
//!                                                    ├▶ scad, brlcad ┤  Boolean solids
//!                                                    ├▶ scene ───────┤  by the file's name
//!                                                    └▶ native ──────┘
//! ```
//!
//! A file that is not what it claims to be is an [`ImportError`]. Everything smaller (a bad record, a
//! face that cannot be built) is left out, and a [`Warning`] names the file and the line or entity.
//! Time and memory are bounded by a multiple of the file's size, whatever its content.

mod brlcad;
mod bv;
mod camera;
mod chain;
mod colour;
mod error;
mod facets;
mod iges;
mod locate;
#[cfg(feature = "meshes")]
mod meshes;
mod native;
mod obj;
mod parts;
mod progress;
mod report;
#[cfg(feature = "rhino")]
mod rhino;
mod scad;
#[cfg(feature = "scene")]
mod scene;
mod solid;
mod step;
mod subdivided;

pub use camera::{Lens, NamedCamera, PictureSettings, Stance};
pub use error::ImportError;
pub use obj::cage::Cage;
pub(crate) use progress::FaceCount;
pub use progress::{Options, Stage};
pub(crate) use report::Warnings;
pub use report::{FaceRecord, ImportReport, Place, Warning};
pub use scad::Facets;
pub use subdivided::open_subdivided;

use crate::model::Model;
use rayon::prelude::*;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// What a file held.
#[derive(Clone, Debug, Default)]
pub struct Import {
    /// Parts and instances, in millimetres.
    pub model: Model,
    /// What was left out or healed, in the order in which it was found.
    pub warnings: Vec<Warning>,
    /// Counts for people.
    pub report: ImportReport,
    /// Cameras that the file names; only scenes have any.
    pub cameras: Vec<NamedCamera>,
    /// What the file asks of its picture; only scenes ask.
    pub picture: PictureSettings,
}

/// A gzip stream may expand by this factor at most. STEP text shrinks 4 to 12 times; deflate itself
/// cannot exceed 1032.
const MAX_EXPANSION: u64 = 100;

/// How Rhino's files begin.
const RHINO: &[u8] = b"3D Geometry File Format ";

/// Expansion that is always allowed, whatever the factor.
const FREE_EXPANSION: u64 = 1 << 20;

/// Reads a file; the format is chosen by its content. Gzip (`.stpz`, `.step.gz`) is undone first.
///
/// # Errors
/// [`ImportError`] when the file cannot be read or is not a known format.
pub fn open(path: &Path) -> Result<Import, ImportError> {
    open_with(path, &Options::default())
}

/// As [`open`], and tells how far it has come; the result is the same.
///
/// # Errors
/// As [`open`].
pub fn open_with(path: &Path, options: &Options<'_>) -> Result<Import, ImportError> {
    let name = path.display().to_string();
    let bytes = load(path, &name, options)?;
    options.tell(Stage::Parse { bytes: bytes.len() as u64 });
    if native::recognise(&bytes) {
        return native(&bytes, &name);
    }
    if step::recognise(&bytes) {
        return step::read(&bytes, &name, options);
    }
    if iges::recognise(&bytes) {
        return iges(&bytes, &name);
    }
    if bytes.starts_with(RHINO) {
        return rhino(&bytes, &name);
    }
    let file = path.file_name().and_then(|f| f.to_str()).map(str::to_ascii_lowercase).unwrap_or_default();
    let named = |all: &[&str]| all.iter().any(|e| file.ends_with(e));
    let text = std::str::from_utf8(&bytes).unwrap_or_default();
    if named(&[".stp", ".step", ".p21", ".stpz", ".stp.gz", ".step.gz"]) {
        Err(ImportError::NotStep { file: name })
    } else if named(&[".igs", ".iges", ".igs.gz", ".iges.gz"]) {
        Err(ImportError::NotIges { file: name })
    } else if named(&[".selvedge", ".selvedge.gz"]) {
        native(&bytes, &name)
    } else if named(&[".csg", ".csg.gz"]) {
        scad::read(text_of(&bytes, &name)?, &name, options.facets, path.parent())
    } else if named(&[".asc", ".asc.gz"]) {
        brlcad(&bytes, &name)
    } else if named(&[".bv", ".bv.gz"]) {
        bv(&bytes, &name)
    } else if named(&[".toml", ".toml.gz"]) {
        scene(&bytes, &name, path.parent())
    } else if named(&[".obj", ".obj.gz"]) {
        obj(&bytes, &name, path.parent())
    } else if let Some(ending) = MESHES.into_iter().find(|e| named(&[&format!(".{e}"), &format!(".{e}.gz")])) {
        mesh(&bytes, &name, ending, path.parent())
    } else if scad::recognise(text) {
        scad::read(text, &name, options.facets, path.parent())
    } else if brlcad::recognise(text) {
        brlcad(&bytes, &name)
    } else if bv::recognise(&bytes) {
        bv(&bytes, &name)
    } else if obj::recognise(&bytes) {
        obj(&bytes, &name, path.parent())
    } else if let Some(ending) = recognise_mesh(&bytes) {
        mesh(&bytes, &name, ending, path.parent())
    } else {
        Err(ImportError::Format { file: name })
    }
}

/// Endings of files of triangles.
const MESHES: [&str; 7] = ["stl", "off", "ply", "3mf", "amf", "gltf", "glb"];

#[cfg(feature = "meshes")]
use meshes::recognise as recognise_mesh;

#[cfg(not(feature = "meshes"))]
fn recognise_mesh(_: &[u8]) -> Option<&'static str> {
    None
}

/// Reads a file of triangles: `ending` is one of `stl`, `off`, `ply`, `3mf`, `amf`, `gltf`, `glb`; buffers of glTF are
/// looked for in `folder`, if there is one.
///
/// # Errors
/// [`ImportError::Mesh`] says where the file is damaged, or that the library was built without the feature `meshes`.
pub fn mesh(bytes: &[u8], name: &str, ending: &str, folder: Option<&Path>) -> Result<Import, ImportError> {
    #[cfg(feature = "meshes")]
    return meshes::read(bytes, name, ending, folder);
    #[cfg(not(feature = "meshes"))]
    return Err(ImportError::Mesh {
        file: name.to_owned(),
        message: format!(
            "{} bytes of .{ending}{}, for which the feature `meshes` is not built in",
            bytes.len(),
            folder.map(|f| format!(" in {}", f.display())).unwrap_or_default()
        ),
    });
}

/// The bytes of a file, gzip undone.
fn load(path: &Path, name: &str, options: &Options<'_>) -> Result<Vec<u8>, ImportError> {
    let unreadable = |source| ImportError::Read { file: name.to_owned(), source };
    let found = std::fs::metadata(path).map_err(unreadable)?;
    let size = found.len();
    if size > u64::from(u32::MAX) {
        return Err(ImportError::TooLarge { file: name.to_owned() });
    }
    options.tell(Stage::Read { bytes: size });
    let bytes = if found.is_file() && size > 0 { read_apart(path, size as usize) } else { std::fs::read(path) };
    let bytes = bytes.map_err(unreadable)?;
    if bytes.starts_with(&[0x1f, 0x8b]) { inflate(&bytes, name) } else { Ok(bytes) }
}

/// A file's first `size` bytes: to give memory to what is read takes about as long as to copy it, so several threads do.
fn read_apart(path: &Path, size: usize) -> std::io::Result<Vec<u8>> {
    const SHARE: usize = 1 << 20;
    let mut bytes = vec![0; size];
    bytes.par_chunks_mut(SHARE).enumerate().try_for_each(|(k, share)| {
        let mut file = File::open(path)?;
        file.seek(SeekFrom::Start((k * SHARE) as u64))?;
        file.read_exact(share)
    })?;
    Ok(bytes)
}

/// Reads ISO 10303-21 text (STEP AP203, AP214, AP242); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError`] when the text is not STEP or holds no usable data.
pub fn step(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    step::read(bytes, name, &Options::default())
}

/// Reads the engine's own form: see [`crate::native`].
///
/// # Errors
/// [`ImportError::Native`] when the bytes hold no valid model.
pub fn native(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    native::read(bytes, name)
}

/// Reads a scene file, see `docs/scene.md`; other files are looked for in `folder`, if there is one.
///
/// # Errors
/// [`ImportError::Scene`] names the line and column of the first thing that is wrong, or says that the library was
/// built without the feature `scene`.
pub fn scene(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Import, ImportError> {
    #[cfg(feature = "scene")]
    return scene::read(bytes, name, folder);
    #[cfg(not(feature = "scene"))]
    return Err(ImportError::Scene {
        file: name.to_owned(),
        line: 1,
        column: 1,
        message: format!(
            "{} bytes of a scene{}, for which the feature `scene` is not built in",
            bytes.len(),
            folder.map(|f| format!(" in {}", f.display())).unwrap_or_default()
        ),
    });
}

/// Reads Wavefront OBJ text; materials are looked for in `folder`, if there is one.
///
/// # Errors
/// [`ImportError::Nothing`] when the text holds no vertex.
pub fn obj(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Import, ImportError> {
    obj::read(bytes, name, folder)
}

/// Reads the polygons of Wavefront OBJ text as control meshes, for subdivision; one an object.
///
/// # Errors
/// [`ImportError::Solid`] names the first line that cannot be read, [`ImportError::Nothing`] a file without polygons.
pub fn cages(bytes: &[u8], name: &str) -> Result<Vec<Cage>, ImportError> {
    obj::cage::read(bytes, name)
}

/// Reads a file of polygons as control meshes; gzip is undone first.
///
/// # Errors
/// As [`cages`], and when the file cannot be read.
pub fn open_cages(path: &Path) -> Result<Vec<Cage>, ImportError> {
    let name = path.display().to_string();
    cages(&load(path, &name, &Options::default())?, &name)
}

/// Reads a BezierView `.bv` file.
///
/// # Errors
/// [`ImportError::Nothing`] when the text does not begin with a patch.
pub fn bv(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    bv::read(bytes, name)
}

/// Reads a Rhino `.3dm` file.
///
/// # Errors
/// [`ImportError::Rhino`] when it cannot be decoded, or when the library was built without the feature
/// `rhino`.
pub fn rhino(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    #[cfg(feature = "rhino")]
    return rhino::read(bytes, name);
    #[cfg(not(feature = "rhino"))]
    return Err(ImportError::Rhino {
        file: name.to_owned(),
        why: format!("{} bytes of a Rhino file, for which the feature `rhino` is not built in", bytes.len()),
    });
}

/// Reads IGES 5.3 and older in fixed format; `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError`] when the text is not IGES, is in compressed or binary form, or holds no entity.
pub fn iges(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    iges::read(bytes, name)
}

/// Reads OpenSCAD's flattened solids (`openscad -o x.csg`); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError::Solid`] names the line of what is no such text. A node that cannot be made is left out with a warning.
pub fn scad(bytes: &[u8], name: &str, facets: Facets) -> Result<Import, ImportError> {
    scad::read(text_of(bytes, name)?, name, facets, Path::new(name).parent())
}

/// Reads BRL-CAD's text of solids (`g2asc`, version 5); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError::Solid`] names the line and object that is not read.
pub fn brlcad(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    brlcad::read(text_of(bytes, name)?, name)
}

fn text_of<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str, ImportError> {
    std::str::from_utf8(bytes).map_err(|e| {
        let line = 1 + bytes[..e.valid_up_to()].iter().filter(|b| **b == b'\n').count();
        ImportError::Solid { file: name.to_owned(), line, message: "not UTF-8 text".to_owned() }
    })
}

/// The file's name without folder and extension.
fn stem(file: &str) -> String {
    Path::new(file).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Undoes gzip; output is bounded by [`MAX_EXPANSION`].
fn inflate(bytes: &[u8], name: &str) -> Result<Vec<u8>, ImportError> {
    let limit = (bytes.len() as u64 * MAX_EXPANSION + FREE_EXPANSION).min(u64::from(u32::MAX));
    let mut text = Vec::new();
    flate2::read::MultiGzDecoder::new(bytes)
        .take(limit + 1)
        .read_to_end(&mut text)
        .map_err(|source| ImportError::Read { file: name.to_owned(), source })?;
    if text.len() as u64 > limit {
        return Err(ImportError::Expansion { file: name.to_owned(), limit });
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gzip(text: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn gzip_round_trip() {
        let text = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n";
        assert_eq!(inflate(&gzip(text), "a.stpz").unwrap(), text);
    }

    #[test]
    fn gzip_bomb_is_an_error() {
        let bomb = gzip(&vec![b' '; 1 << 24]);
        assert!(matches!(inflate(&bomb, "bomb.gz"), Err(ImportError::Expansion { .. })));
    }

    /// Files of no share, of one, and of several that do not fill the last.
    #[test]
    fn files_are_read_whole() {
        let path = std::env::temp_dir().join(format!("selvedge-read-{}", std::process::id()));
        for size in [0usize, 1, 1 << 20, (3 << 20) + 17] {
            let written: Vec<u8> = (0..size).map(|i| (i ^ i >> 8 ^ i >> 16) as u8).collect();
            std::fs::write(&path, &written).unwrap();
            let read = load(&path, "read", &Options::default()).unwrap();
            assert!(read == written, "{size} bytes");
        }
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn missing_and_unknown_files_are_named() {
        let error = open(Path::new("no/such/file.step")).unwrap_err();
        assert!(error.to_string().contains("no/such/file.step"));
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs");
        assert!(matches!(open(&script), Err(ImportError::Format { .. })));
    }
}
