//! CAD files in, [`Model`]s out.
//!
//! ```text
//!   path ──source──▶ bytes ──format by content, name──▶ step, iges ───┬─▶ Import { model, warnings, report }
//!                                                    ├▶ obj, bv ─────┤
//!                                                    ├▶ rhino ───────┤
//!                                                    ├▶ scad, brlcad ┤  Boolean solids
//!                                                    ├▶ meshes ──────┤  STL, OFF, PLY, 3MF, AMF, glTF
//!                                                    ├▶ scene ───────┤  by the file's name
//!                                                    └▶ native ──────┘
//! ```
//!
//! A file that is not what it claims to be is an [`ImportError`]. Everything smaller (a bad record, a
//! face that cannot be built) is left out, and a [`Warning`] names the file and the line or entity;
//! [`Import::summary`] counts what is there and what is not.
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
mod reasons;
mod report;
#[cfg(feature = "rhino")]
mod rhino;
mod scad;
#[cfg(feature = "scene")]
mod scene;
mod solid;
mod source;
mod step;
mod subdivided;
mod summary;

pub use camera::{Lens, NamedCamera, PictureSettings, Stance};
pub use error::ImportError;
pub use obj::cage::Cage;
pub(crate) use progress::FaceCount;
pub use progress::{Options, Stage};
pub use reasons::Reasons;
pub(crate) use report::{FACE_LOST, Warnings};
pub use report::{FaceRecord, ImportReport, Place, Warning};
pub use scad::Facets;
pub use subdivided::open_subdivided;
pub use summary::{Summary, Tally};

use crate::model::Model;
use std::io::Read;
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

/// How Rhino's files begin.
const RHINO: &[u8] = b"3D Geometry File Format ";

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
    let bytes = source::load(path, &name, options)?;
    read(&bytes, &name, path.parent(), options)
}

/// Reads a stream to its end, as [`open_with`]; `name` stands for it in messages, and its ending tells the format where
/// the content does not. Other files that it names are not found.
///
/// # Errors
/// As [`open`].
pub fn read_from(stream: &mut dyn Read, name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    let known = |beginning: &[u8]| Format::of(beginning, name).is_some();
    let bytes = source::drain(stream, name, options.most_bytes(), known)?;
    read(&bytes, name, None, options)
}

/// What is read here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Native,
    Step,
    Iges,
    Rhino,
    Scad,
    Brlcad,
    Bv,
    Scene,
    Obj,
    /// Triangles, by the ending of the form's name.
    Mesh(&'static str),
}

impl Format {
    /// By the beginning of the content where it is certain, else by the name, else by what the content looks like.
    fn of(bytes: &[u8], name: &str) -> Option<Self> {
        let certain: [(Self, fn(&[u8]) -> bool); 4] = [
            (Self::Native, native::recognise),
            (Self::Step, step::recognise),
            (Self::Iges, iges::recognise),
            (Self::Rhino, |bytes| bytes.starts_with(RHINO)),
        ];
        if let Some((format, _)) = certain.iter().find(|(_, recognise)| recognise(bytes)) {
            return Some(*format);
        }
        const NAMED: [(&str, Format); 19] = [
            (".stp", Format::Step),
            (".step", Format::Step),
            (".p21", Format::Step),
            (".stpz", Format::Step),
            (".igs", Format::Iges),
            (".iges", Format::Iges),
            (".selvedge", Format::Native),
            (".csg", Format::Scad),
            (".asc", Format::Brlcad),
            (".bv", Format::Bv),
            (".toml", Format::Scene),
            (".obj", Format::Obj),
            (".stl", Format::Mesh("stl")),
            (".off", Format::Mesh("off")),
            (".ply", Format::Mesh("ply")),
            (".3mf", Format::Mesh("3mf")),
            (".amf", Format::Mesh("amf")),
            (".gltf", Format::Mesh("gltf")),
            (".glb", Format::Mesh("glb")),
        ];
        let file = name.to_ascii_lowercase();
        let file = file.strip_suffix(".gz").unwrap_or(&file);
        if let Some((_, format)) = NAMED.iter().find(|(ending, _)| file.ends_with(ending)) {
            return Some(*format);
        }
        let text =
            std::str::from_utf8(bytes).or_else(|e| std::str::from_utf8(&bytes[..e.valid_up_to()])).unwrap_or_default();
        if scad::recognise(text) {
            Some(Self::Scad)
        } else if brlcad::recognise(text) {
            Some(Self::Brlcad)
        } else if bv::recognise(bytes) {
            Some(Self::Bv)
        } else if obj::recognise(bytes) {
            Some(Self::Obj)
        } else {
            recognise_mesh(bytes).map(Self::Mesh)
        }
    }
}

/// Reads what has been loaded; other files are looked for in `folder`, if there is one.
fn read(bytes: &[u8], name: &str, folder: Option<&Path>, options: &Options<'_>) -> Result<Import, ImportError> {
    options.tell(Stage::Parse { bytes: bytes.len() as u64 });
    match Format::of(bytes, name) {
        Some(Format::Native) => native(bytes, name),
        Some(Format::Step) => step::read(bytes, name, options),
        Some(Format::Iges) => iges(bytes, name),
        Some(Format::Rhino) => rhino(bytes, name),
        Some(Format::Scad) => scad::read(text_of(bytes, name)?, name, options.facets, folder),
        Some(Format::Brlcad) => brlcad(bytes, name),
        Some(Format::Bv) => bv(bytes, name),
        Some(Format::Scene) => scene(bytes, name, folder),
        Some(Format::Obj) => obj(bytes, name, folder),
        Some(Format::Mesh(ending)) => mesh(bytes, name, ending, folder),
        None => Err(ImportError::Format { file: name.to_owned() }),
    }
}

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
pub fn open_cages(path: &Path, options: &Options<'_>) -> Result<Vec<Cage>, ImportError> {
    let name = path.display().to_string();
    cages(&source::load(path, &name, options)?, &name)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_and_unknown_files_are_named() {
        let error = open(Path::new("no/such/file.step")).unwrap_err();
        assert!(error.to_string().contains("no/such/file.step"));
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs");
        assert!(matches!(open(&script), Err(ImportError::Format { .. })));
    }
}
