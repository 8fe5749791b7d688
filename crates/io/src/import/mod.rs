//! CAD files in, [`Model`]s out.
//!
//! ```text
//!   path ──source──▶ bytes ──format by content, name──▶ step, iges ───┬─▶ Import { model, warnings, report }
//!                                                    ├▶ obj, bv ─────┤
//!                                                    ├▶ rhino ───────┤
//!                                                    ├▶ meshes ──────┤  STL, OFF, PLY, 3MF, AMF, glTF
//!                                                    ├▶ scad, brlcad ┤  Boolean solids; .scad through openscad
//!                                                    ├▶ scene ───────┤  by the file's name
//!                                                    └▶ native ──────┘
//! ```
//!
//! A file of another format than it claims is an [`ImportError`]. Anything smaller (a bad record, a face that cannot be
//! built) is left out, and a [`Warning`] names the file and the line or entity; [`Import::summary`] counts the model's
//! contents and the losses. Time and memory are bounded by a multiple of the file's size, whatever its content.

mod brlcad;
mod bv;
mod camera;
mod chain;
mod colour;
#[cfg(test)]
mod damage;
#[cfg(test)]
mod ended;
mod error;
mod external;
mod facets;
mod far;
mod guard;
mod iges;
mod junctions;
mod locate;
#[cfg(feature = "meshes")]
mod meshes;
mod names;
mod native;
mod obj;
mod openscad;
mod parts;
mod preview;
#[cfg(test)]
mod previewed;
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
mod stop;
mod subdivided;
mod summary;
mod text;
mod torn;

pub use camera::{Lens, NamedCamera, PictureSettings, Stance};
pub use error::ImportError;
pub use external::{Files, Folders};
pub use obj::cage::Cage;
pub use preview::Preview;
pub(crate) use progress::{FaceCount, Pulse};
pub use progress::{Options, Stage};
pub use reasons::Reasons;
pub(crate) use report::{FACE_LOST, LOOP_LOST, Warnings};
pub use report::{FaceRecord, ImportReport, Place, Warning};
pub use scad::Facets;
pub use stop::{Stop, Unwound, caught};
pub use subdivided::open_subdivided;
pub use summary::{Summary, Tally};

use crate::model::Model;
use source::OtherFiles;
use std::io::Read;
use std::path::Path;

/// A model, and the report of reading it.
#[derive(Clone, Debug, Default)]
pub struct Import {
    /// Parts and instances, in millimetres.
    pub model: Model,
    /// What was left out or repaired, in the order in which it was found.
    pub warnings: Vec<Warning>,
    /// Counts for people.
    pub report: ImportReport,
    /// Cameras that the file names; only scenes have any.
    pub cameras: Vec<NamedCamera>,
    /// The file's picture settings; only scenes have any.
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

/// As [`open`], with progress and limits. Parts that stand in other files are looked for where [`Options::files`] says,
/// and left out without it.
///
/// # Errors
/// As [`open`].
pub fn open_with(path: &Path, options: &Options<'_>) -> Result<Import, ImportError> {
    let name = path.display().to_string();
    if options.run_openscad && openscad::is_program(path) {
        return openscad::open(path, &name, options);
    }
    let bytes = source::load(path, &name, options)?;
    let first = read(&bytes, &name, path.parent(), options)?;
    Ok(external::follow(first, &name, options, &|bytes, found| found_file(bytes, found, options)))
}

/// Reads a file that another one names, without previews. If it is a scene, the files that it names are read without
/// their own references: a scene and an assembly cannot name each other without end.
fn found_file(bytes: Vec<u8>, found: &str, options: &Options<'_>) -> Result<external::Read, ImportError> {
    let stage = Stage::Read { bytes: bytes.len() as u64 };
    let bytes = source::inflated(bytes, found, options.most_bytes(), &|| options.tell(stage))?;
    read(&bytes, found, Path::new(found).parent(), &Options { files: None, preview: None, ..*options })
}

/// Reads a stream to its end, as [`open_with`]; `name` is its name in messages, and its ending gives the format where
/// the content does not. Other files that it names are not found.
///
/// # Errors
/// As [`open`].
pub fn read_from(stream: &mut dyn Read, name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    let known = |beginning: &[u8]| Format::of(&text::utf8(beginning).text, beginning, name).is_some();
    let bytes = source::drain(stream, name, options.most_bytes(), known)?;
    let first = read(&bytes, name, None, options)?;
    Ok(external::follow(first, name, &Options { files: None, ..*options }, &|_, _| unreachable!("no file is found")))
}

/// The formats.
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
    /// A file of triangles, with its ending.
    Mesh(&'static str),
}

impl Format {
    /// Formats that are read byte by byte, by how they begin.
    fn certain(bytes: &[u8]) -> Option<Self> {
        if native::recognise(bytes) {
            Some(Self::Native)
        } else if bytes.starts_with(RHINO) {
            Some(Self::Rhino)
        } else {
            iges::recognise(bytes).then_some(Self::Iges)
        }
    }

    fn named_mesh(file: &str) -> Option<Self> {
        MESHES.into_iter().find(|ending| file.rsplit('.').next() == Some(ending)).map(Self::Mesh)
    }

    /// By the beginning of the content where it is certain, else by the name, else by what the content looks like.
    fn of(text: &str, bytes: &[u8], name: &str) -> Option<Self> {
        if let Some(format) = Self::certain(bytes) {
            return Some(format);
        }
        if step::recognise(text.as_bytes()) {
            return Some(Self::Step);
        }
        const NAMED: [(&str, Format); 13] = [
            (".stp", Format::Step),
            (".step", Format::Step),
            (".p21", Format::Step),
            (".stpz", Format::Step),
            (".igs", Format::Iges),
            (".iges", Format::Iges),
            (".selvedge", Format::Native),
            (".3dm", Format::Rhino),
            (".csg", Format::Scad),
            (".asc", Format::Brlcad),
            (".bv", Format::Bv),
            (".toml", Format::Scene),
            (".obj", Format::Obj),
        ];
        let file = name.to_ascii_lowercase();
        let file = file.strip_suffix(".gz").unwrap_or(&file);
        if let Some((_, format)) = NAMED.iter().find(|(ending, _)| file.ends_with(ending)) {
            return Some(*format);
        }
        if let Some(mesh) = Self::named_mesh(file) {
            return Some(mesh);
        }
        if scad::recognise(text) {
            Some(Self::Scad)
        } else if brlcad::recognise(text) {
            Some(Self::Brlcad)
        } else if bv::recognise(text.as_bytes()) {
            Some(Self::Bv)
        } else if obj::recognise(text.as_bytes()) {
            Some(Self::Obj)
        } else {
            recognise_mesh(bytes).map(Self::Mesh)
        }
    }
}

/// Reads loaded bytes, with the files that they mention. Data and materials are looked for in `folder`, if there is
/// one.
fn read(bytes: &[u8], name: &str, folder: Option<&Path>, options: &Options<'_>) -> Result<external::Read, ImportError> {
    options.tell(Stage::Parse { bytes: bytes.len() as u64 });
    let mut mentions = Vec::new();
    // formats that are not text, or count bytes, are not decoded
    let lower = name.to_ascii_lowercase();
    let mesh_by_name = Format::named_mesh(lower.strip_suffix(".gz").unwrap_or(&lower));
    let text =
        if Format::certain(bytes).or(mesh_by_name).is_none() { text::utf8(bytes) } else { text::Text::default() };
    let utf8 = text.text.as_bytes();
    let format = Format::of(&text.text, bytes, name);
    let mut import = match format {
        Some(Format::Native) => native(bytes, name)?,
        Some(Format::Rhino) => rhino(bytes, name)?,
        Some(Format::Iges) => iges::read(bytes, name, options)?,
        Some(Format::Step) => {
            let import;
            (import, mentions) = step::read(utf8, name, options)?;
            import
        }
        Some(Format::Scad) => scad::read(&text.text, name, options, OtherFiles::new(name, folder, options))?,
        Some(Format::Brlcad) => brlcad(utf8, name)?,
        Some(Format::Bv) => bv(utf8, name)?,
        Some(Format::Scene) => read_scene(bytes, name, folder, options)?,
        Some(Format::Obj) => obj::read(utf8, name, OtherFiles::new(name, folder, options))?,
        Some(Format::Mesh(ending)) => read_mesh(bytes, name, ending, OtherFiles::new(name, folder, options))?,
        None => return Err(ImportError::Format { file: name.to_owned() }),
    };
    if !matches!(format, Some(Format::Mesh(_))) {
        text.tell(name, &mut import);
    }
    far::leave_out(&mut import, name);
    Ok((import, mentions))
}

/// Reads text, whatever its encoding.
fn decoded(
    bytes: &[u8],
    name: &str,
    read: impl FnOnce(&str) -> Result<Import, ImportError>,
) -> Result<Import, ImportError> {
    let text = text::utf8(bytes);
    let mut import = read(&text.text)?;
    text.tell(name, &mut import);
    Ok(import)
}

/// Endings of files of triangles.
const MESHES: [&str; 7] = ["stl", "off", "ply", "3mf", "amf", "gltf", "glb"];

#[cfg(feature = "meshes")]
use meshes::{read as read_mesh, recognise as recognise_mesh};

#[cfg(not(feature = "meshes"))]
fn recognise_mesh(_: &[u8]) -> Option<&'static str> {
    None
}

#[cfg(not(feature = "meshes"))]
fn read_mesh(bytes: &[u8], name: &str, ending: &str, files: OtherFiles<'_>) -> Result<Import, ImportError> {
    let place = files.folder.map(|f| format!(" in {}", f.display())).unwrap_or_default();
    let what = format!("{} bytes of .{ending}{place}", bytes.len());
    let message = format!("{what}, for which the feature `meshes` is not built in");
    Err(ImportError::Mesh { file: name.to_owned(), message })
}

/// Reads a file of triangles: `ending` is one of `stl`, `off`, `ply`, `3mf`, `amf`, `gltf`, `glb`; buffers of glTF are
/// looked for in `folder`, if there is one.
///
/// # Errors
/// [`ImportError::Mesh`] says where the file is damaged, or that the library was built without the feature `meshes`.
pub fn mesh(bytes: &[u8], name: &str, ending: &str, folder: Option<&Path>) -> Result<Import, ImportError> {
    read_mesh(bytes, name, ending, OtherFiles::new(name, folder, &Options::default()))
}

/// Reads ISO 10303-21 text (STEP AP203, AP214, AP242); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError`] when the text is not STEP or holds no usable data.
pub fn step(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    step_with(bytes, name, &Options::default())
}

/// As [`step`]; parts that stand in other files are looked for where [`Options::files`] says.
///
/// # Errors
/// As [`step`].
pub fn step_with(bytes: &[u8], name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    decoded(bytes, name, |text| {
        let first = step::read(text.as_bytes(), name, options)?;
        Ok(external::follow(first, name, options, &|bytes, found| found_file(bytes, found, options)))
    })
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
    read_scene(bytes, name, folder, &Options::default())
}

#[cfg(feature = "scene")]
use scene::read as read_scene;

#[cfg(not(feature = "scene"))]
fn read_scene(bytes: &[u8], name: &str, folder: Option<&Path>, _: &Options<'_>) -> Result<Import, ImportError> {
    let place = folder.map(|f| format!(" in {}", f.display())).unwrap_or_default();
    let message = format!("{} bytes of a scene{place}, for which the feature `scene` is not built in", bytes.len());
    Err(ImportError::Scene { file: name.to_owned(), line: 1, column: 1, message })
}

/// Reads Wavefront OBJ text; materials are looked for in `folder`, if there is one.
///
/// # Errors
/// [`ImportError::Nothing`] when the text holds no vertex.
pub fn obj(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Import, ImportError> {
    let files = OtherFiles::new(name, folder, &Options::default());
    decoded(bytes, name, |text| obj::read(text.as_bytes(), name, files))
}

/// Reads the polygons of Wavefront OBJ text as control meshes, for subdivision; one an object.
///
/// # Errors
/// [`ImportError::Solid`] names the first line that cannot be read, [`ImportError::Nothing`] a file without polygons.
pub fn cages(bytes: &[u8], name: &str) -> Result<Vec<Cage>, ImportError> {
    obj::cage::read(text::utf8(bytes).text.as_bytes(), name)
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
    decoded(bytes, name, |text| bv::read(text.as_bytes(), name))
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
    iges::read(bytes, name, &Options::default())
}

/// Reads OpenSCAD's flattened solids (`openscad -o x.csg`); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError::Solid`] names the line of the fault. A node that cannot be made is left out with a warning.
pub fn scad(bytes: &[u8], name: &str, facets: Facets) -> Result<Import, ImportError> {
    scad_with(bytes, name, &Options { facets, ..Options::default() })
}

/// As [`scad`], with the limits of `options` for the files that it names.
///
/// # Errors
/// As [`scad`].
pub fn scad_with(bytes: &[u8], name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    let files = OtherFiles::new(name, Path::new(name).parent(), options);
    decoded(bytes, name, |text| scad::read(text, name, options, files))
}

/// Reads BRL-CAD's text of solids (`g2asc`, version 5 and the older 4); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError::Solid`] names the line of the fault, or of the first object that is not read where nothing else is
/// left.
pub fn brlcad(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    decoded(bytes, name, |text| brlcad::read(text, name))
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
