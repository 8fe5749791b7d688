//! How files are read, for all commands.

use crate::values::{length, mebibytes, seconds};
use clap::{Args, ValueEnum};
use selvedge::construct::subdivide::Scheme;
use selvedge_jobs::{Limits, memory};
use std::path::PathBuf;
use std::time::Duration;

/// Which files are read.
#[derive(Clone, Debug, Default, Args)]
pub struct ReadArgs {
    /// Refuse a file of which anything is left out: exit status 2 in place of a warning
    #[arg(long)]
    pub strict: bool,
    /// Look for files that a model names below this folder, too, not only beside that model; may be given several
    /// times
    #[arg(long, value_name = "DIR")]
    pub search: Vec<PathBuf>,
    /// Most MiB of memory that the process holds while a file is read, and with `render` while it is prepared and drawn,
    /// too; by default a file, gzip undone, has three quarters of the machine's memory, and 4096 MiB at most
    #[arg(long, value_name = "MIB", value_parser = mebibytes)]
    pub limit_mib: Option<f64>,
    /// Most seconds for a file: to read it, and with `render` to prepare and draw it, too; no limit by default
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub limit_s: Option<f64>,
}

impl ReadArgs {
    /// The limits of the work on a file, by its name in messages.
    pub fn limits(&self, name: &str) -> Limits {
        Limits::new(name, self.limit_s.map(Duration::from_secs_f64), self.most_memory())
    }

    /// Most bytes of memory that the process holds for a file.
    pub fn most_memory(&self) -> Option<u64> {
        self.limit_mib.map(|mebibytes| (mebibytes * f64::from(1 << 20)) as u64)
    }

    /// Most bytes of a file.
    pub fn most_bytes(&self) -> u64 {
        self.most_memory().unwrap_or_else(|| memory() / 4 * 3)
    }
}

/// How polygons are read.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct SubdivideArgs {
    /// Read an OBJ file's polygons as the control mesh of a smooth surface
    #[arg(long, value_enum, value_name = "SCHEME")]
    pub subdivide: Option<Smooth>,
    /// Largest distance of the faces from that surface, in the file's units; a hundred-thousandth of the size without
    /// it
    #[arg(long, value_name = "LENGTH", requires = "subdivide", value_parser = length)]
    pub within: Option<f64>,
    /// Give every round solid of an OpenSCAD file the facets that OpenSCAD gives it
    #[arg(long)]
    pub as_openscad: bool,
}

/// Schemes of subdivision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Smooth {
    /// Any polygons, bicubic patches
    CatmullClark,
    /// Triangles, quartic patches
    Loop,
}

impl Smooth {
    pub fn scheme(self) -> Scheme {
        match self {
            Self::CatmullClark => Scheme::CatmullClark,
            Self::Loop => Scheme::Loop,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_bounded_by_the_machine_or_by_the_user() {
        let most = ReadArgs::default().most_bytes();
        assert!(most > 1 << 20 && most < memory(), "{most} of {}", memory());
        let args = ReadArgs { limit_mib: Some(0.5), ..ReadArgs::default() };
        assert_eq!(args.most_bytes(), 1 << 19);
    }
}
