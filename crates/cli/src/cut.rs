//! A model cut open or made transparent before it is drawn: `--section`, `--trim-by`, `--xray`.

use crate::args::ReadArgs;
use crate::reading;
use anyhow::{Context, Result, bail};
use clap::Args;
use glam::DVec3;
use selvedge::model::{Model, Solid};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// How the model is cut open.
#[derive(Debug, Default, Args)]
pub struct CutArgs {
    /// Draw only the part where NX x + NY y + NZ z <= D, millimetres, with caps on closed parts and solids; several cut
    /// one after another
    #[arg(long, value_name = "NX,NY,NZ,D", allow_hyphen_values = true)]
    pub section: Vec<Plane>,
    /// Draw only the surface within the solids of another file (.csg, .asc or a scene), open where it is cut; applied
    /// before any section
    #[arg(long, value_name = "FILE")]
    pub trim_by: Option<PathBuf>,
    /// Make occurrences and parts of this name transparent, or faces and primitives of number N with #N, as in the face
    /// image; opacity from 0 to 1, 0.25 by default; may be given several times
    #[arg(long, value_name = "NAME[=OPACITY]")]
    pub xray: Vec<Xray>,
}

/// A name to make transparent, and its opacity.
#[derive(Clone, Debug, PartialEq)]
pub struct Xray {
    name: String,
    opacity: f32,
}

impl FromStr for Xray {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, opacity) = match text.rsplit_once('=') {
            Some((name, opacity)) => (name, opacity.parse().map_err(|_| "wants NAME=OPACITY, as in lid=0.3")?),
            None => (text, 0.25),
        };
        if !(0.0..=1.0).contains(&opacity) {
            return Err("an opacity is from 0 to 1".into());
        }
        Ok(Self { name: name.to_owned(), opacity })
    }
}

/// `normal · p <= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: DVec3,
    offset: f64,
}

impl FromStr for Plane {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse::<f64>()).collect();
        match numbers.as_deref() {
            Ok(&[x, y, z, offset]) if [x, y, z, offset].iter().all(|n| n.is_finite()) => {
                let normal = DVec3::new(x, y, z);
                if normal == DVec3::ZERO {
                    Err("the first three numbers are all 0".into())
                } else {
                    Ok(Self { normal, offset })
                }
            }
            _ => Err("wants four finite numbers, as in 1,0,0,2.5".into()),
        }
    }
}

/// Why a model that nothing cuts has no picture.
pub const NO_BOX: &str = "no box holds its solids: they are unbounded, or empty";

impl CutArgs {
    /// The files that are read: the model's, and the one that trims it.
    pub fn inputs<'p>(&'p self, model: &'p Path) -> Vec<&'p Path> {
        std::iter::once(model).chain(self.trim_by.as_deref()).collect()
    }

    /// Cuts the model.
    pub fn apply(&self, model: &mut Model, read: &ReadArgs) -> Result<()> {
        for Xray { name, opacity } in &self.xray {
            model.xray(&[name], *opacity).context("--xray")?;
        }
        if let Some(path) = &self.trim_by {
            let by = reading::open(path, read, &Default::default())?.model;
            let file = || path.display().to_string();
            if !by.instances.is_empty() {
                bail!("{}: holds parts, and a volume that trims needs equations", file());
            }
            if by.solids.is_empty() {
                bail!("{}: holds no solid to trim by", file());
            }
            let volume = Solid::union(&by.solids).with_context(file)?;
            model.trim_by(&volume).with_context(file)?;
        }
        for plane in &self.section {
            *model = model.section(plane.normal, plane.offset)?;
        }
        if model.control_bounds().is_empty() {
            if self.trim_by.is_none() && self.section.is_empty() && !model.solids.is_empty() {
                bail!("{NO_BOX}");
            }
            bail!("what cuts the model open leaves nothing of it");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opacities() {
        let of = |name: &str, opacity| Ok(Xray { name: name.to_owned(), opacity });
        assert_eq!("lid".parse(), of("lid", 0.25));
        assert_eq!("a=b=0.5".parse(), of("a=b", 0.5));
        assert_eq!("#3=0".parse(), of("#3", 0.0));
        for bad in ["a=b", "a=2", "a=-1", "a=nan", "a="] {
            assert!(bad.parse::<Xray>().is_err(), "{bad}");
        }
    }

    #[test]
    fn planes() {
        assert_eq!("-1, 0,2,3e1".parse(), Ok(Plane { normal: DVec3::new(-1.0, 0.0, 2.0), offset: 30.0 }));
        for bad in ["1,0,0", "0,0,0,1", "1,0,0,x", "1,0,0,inf", "1,2,3,4,5", ""] {
            assert!(bad.parse::<Plane>().is_err(), "{bad}");
        }
    }
}
