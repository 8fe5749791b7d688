//! Why a file gives no model at all.

/// Every variant names the file; the message says what each field is.
#[allow(missing_docs)]
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The operating system or the gzip decoder refused.
    #[error("{file}: {source}")]
    Read { file: String, source: std::io::Error },
    /// Neither content nor extension is one that is read here.
    #[error("{file}: not a CAD file of a known format")]
    Format { file: String },
    /// More than [`Options::most_bytes`](field@super::Options::most_bytes) allows.
    #[error("{file}: larger than {limit} bytes, the most that is read")]
    TooLarge { file: String, limit: u64 },
    /// Not a file, or nothing that ever ends.
    #[error("{file}: {what}")]
    NoFile { file: String, what: &'static str },
    /// A gzip bomb, or not CAD text.
    #[error("{file}: gzip data expand to more than {limit} bytes")]
    Expansion { file: String, limit: u64 },
    /// The first token is missing.
    #[error("{file}:1: not STEP: no `ISO-10303-21;` at the start")]
    NotStep { file: String },
    /// A header at most, or nothing that could be read as one.
    #[error("{file}:{line}: the file ends without a DATA section")]
    NoData { file: String, line: usize },
    /// No card with `S` or `G` in column 73.
    #[error("{file}:1: not IGES: column 73 holds no section letter")]
    NotIges { file: String },
    /// The standard's other two forms.
    #[error("{file}:1: IGES in {form} form is not supported: write it as fixed-format ASCII")]
    IgesForm { file: String, form: &'static str },
    /// Nothing that could be an entity.
    #[error("{file}:{line}: the file ends without a directory section")]
    NoDirectory { file: String, line: usize },
    /// More than half of the records are not records.
    #[error("{file}:{line}: gave up: {bad} of the first {seen} records cannot be read")]
    Nonsense { file: String, line: usize, bad: usize, seen: usize },
    /// Text or bytes in which the format's reader finds nothing.
    #[error("{file}: holds nothing that is {format}")]
    Nothing { file: String, format: &'static str },
    /// Rhino's form, damaged or not built in.
    #[error("{file}: {why}")]
    Rhino { file: String, why: String },
    /// The engine's own form, of another version or damaged.
    #[error("{file}: {source}")]
    Native { file: String, source: crate::native::NativeError },
    /// An invalid scene.
    #[error("{file}:{line}:{column}: {message}")]
    Scene { file: String, line: usize, column: usize, message: String },
    /// Polygons that are no control mesh of a smooth surface.
    #[error("{file}: {source}")]
    Construct { file: String, source: crate::construct::ConstructError },
    /// Triangles, damaged or not built in; the file's name has the line, where there are lines.
    #[error("{file}: {message}")]
    Mesh { file: String, message: String },
    /// `openscad` is not installed, or refuses its program.
    #[error("{file}: {message}")]
    OpenScad { file: String, message: String },
    /// Text that is not a Boolean solid's.
    #[error("{file}:{line}: {message}")]
    Solid { file: String, line: usize, message: String },
}

impl ImportError {
    /// The file.
    pub fn file(&self) -> &str {
        match self {
            Self::Read { file, .. }
            | Self::Format { file }
            | Self::TooLarge { file, .. }
            | Self::NoFile { file, .. }
            | Self::Expansion { file, .. }
            | Self::NotStep { file }
            | Self::NoData { file, .. }
            | Self::NotIges { file }
            | Self::IgesForm { file, .. }
            | Self::NoDirectory { file, .. }
            | Self::Nonsense { file, .. }
            | Self::Nothing { file, .. }
            | Self::Rhino { file, .. }
            | Self::Native { file, .. }
            | Self::Scene { file, .. }
            | Self::Construct { file, .. }
            | Self::Mesh { file, .. }
            | Self::OpenScad { file, .. }
            | Self::Solid { file, .. } => file,
        }
    }

    /// The line, counted from 1, where one is at fault.
    pub fn line(&self) -> Option<usize> {
        match self {
            Self::NotStep { .. } | Self::NotIges { .. } | Self::IgesForm { .. } => Some(1),
            Self::NoData { line, .. }
            | Self::NoDirectory { line, .. }
            | Self::Nonsense { line, .. }
            | Self::Scene { line, .. }
            | Self::Solid { line, .. } => Some(*line),
            _ => None,
        }
    }
}
