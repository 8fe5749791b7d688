//! The pictures of each file, and their output files.
//!
//! ```text
//!   a/lid.step, b/box.step  x  iso, top  x  out/{stem}_{view}.png
//!   ─▶ Task lid: Shot iso out/lid_iso.png, Shot top out/lid_top.png;  Task box: …
//! ```

use crate::args::{Aov, RenderArgs};
use crate::camera::CameraFile;
use crate::model_renderer::Measured;
use crate::output;
use crate::target::{self, JSON, NPY, PNG, Target};
use anyhow::{Result, bail};
use selvedge::model::Camera;
use selvedge::picture::Picture;
use selvedge_jobs::{Direction, NAMED};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A file and its pictures.
pub struct Task {
    pub model: PathBuf,
    pub shots: Vec<Shot>,
    /// The file of a contact sheet; its shots have none.
    pub sheet: Option<PathBuf>,
}

/// A picture, and the files of it.
pub struct Shot {
    pub direction: Option<Direction>,
    /// `None` on a contact sheet.
    pub output: Option<PathBuf>,
    pub aovs: Vec<Aov>,
    pub stats: Option<PathBuf>,
    pub camera_out: Option<PathBuf>,
}

/// The pattern of the view's name in a path.
const VIEW: &str = "{view}";
/// The pattern of the model's name, without folder and ending.
const STEM: &str = "{stem}";

impl Task {
    /// One task for each model; no two write the same file.
    pub fn all(args: &RenderArgs) -> Result<Vec<Self>> {
        let several = args.models.len() > 1;
        let tasks = args.models.iter().map(|model| Self::new(args, model, several)).collect::<Result<Vec<_>>>()?;
        let mut known = HashMap::new();
        for task in &tasks {
            for Target { path, .. } in task.outputs() {
                if let Some(other) = known.insert(path.clone(), &task.model).filter(|other| **other != task.model) {
                    let (path, model) = (path.display(), task.model.display());
                    bail!("{path}: both {} and {model} go there: {STEM} stands for a file's name", other.display());
                }
            }
        }
        Ok(tasks)
    }

    fn new(args: &RenderArgs, model: &Path, several: bool) -> Result<Self> {
        let mut directions: Vec<_> = args.view.iter().flat_map(|views| &views.0).copied().map(Some).collect();
        if directions.is_empty() {
            directions = if args.contact_sheet { NAMED.map(Some).to_vec() } else { vec![None] };
        }
        let views = directions.len() > 1;
        let stemmed = |path: &Path| of_model(path, model, several);
        let shot = |direction: Option<Direction>| {
            let path = |path: &PathBuf| named_for(&stemmed(path)?, direction, views);
            let optional = |of: &Option<PathBuf>| of.as_ref().map(path).transpose();
            let output = if args.contact_sheet { None } else { Some(path(&args.output)?) };
            let aov = |aov: &Aov| Ok(Aov { file: path(&aov.file)?, ..aov.clone() });
            let aovs = args.aov.iter().map(aov).collect::<Result<_>>()?;
            Ok(Shot { direction, output, aovs, stats: optional(&args.stats)?, camera_out: optional(&args.camera_out)? })
        };
        let shots = directions.into_iter().map(shot).collect::<Result<_>>()?;
        let sheet = args.contact_sheet.then(|| stemmed(&args.output)).transpose()?;
        Ok(Self { model: model.to_owned(), shots, sheet })
    }

    /// Every file that is written.
    pub fn outputs(&self) -> Vec<Target> {
        let sheet = self.sheet.iter().map(|path| Target::new(path, PNG));
        sheet.chain(self.shots.iter().flat_map(Shot::outputs)).collect()
    }

    /// Whether all of them exist.
    pub fn is_done(&self) -> bool {
        self.outputs().iter().all(|target| target.path.is_file())
    }
}

/// A path with the model's name in place of its pattern, if there are several models.
fn of_model(path: &Path, model: &Path, several: bool) -> Result<PathBuf> {
    let text = path.to_string_lossy();
    if text.contains(STEM) {
        let stem = model.file_stem().unwrap_or(model.as_os_str()).to_string_lossy();
        return Ok(PathBuf::from(text.replace(STEM, &stem)));
    }
    if several {
        bail!("{text}: several files go there: {STEM} stands for a file's name, as in out/{STEM}_{VIEW}.png");
    }
    Ok(path.to_owned())
}

fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(VIEW)
}

/// A path with the view's name, if there are several views.
pub fn named_for(path: &Path, direction: Option<Direction>, several: bool) -> Result<PathBuf> {
    match direction {
        Some(direction) if several || is_pattern(path) => named(path, &direction.to_string()),
        None if is_pattern(path) => {
            bail!("{}: {VIEW} stands for the view's name: --view says which", path.display())
        }
        _ => Ok(path.to_owned()),
    }
}

/// The path of a view's file: the name in the pattern's place, or before the ending.
fn named(path: &Path, view: &str) -> Result<PathBuf> {
    if target::is_standard(path) {
        bail!("several pictures do not go to standard output: --contact-sheet makes one of them");
    }
    let text = path.to_string_lossy();
    Ok(match text.contains(VIEW) {
        true => PathBuf::from(text.replace(VIEW, view)),
        false => target::with_name(path, &format!("_{view}")),
    })
}

impl Shot {
    /// Every file that is written.
    fn outputs(&self) -> impl Iterator<Item = Target> {
        let picture = self.output.iter().map(|path| Target::new(path, PNG));
        let images = self.aovs.iter().map(|aov| Target::new(&aov.file, NPY));
        let json = self.stats.iter().chain(&self.camera_out).map(|path| Target::new(path, JSON));
        picture.chain(images).chain(json)
    }

    /// Writes all of them.
    pub fn write(&self, camera: &Camera, picture: &Picture, stats: Option<&Measured>) -> Result<()> {
        self.output.iter().try_for_each(|path| output::png(path, picture.size, &picture.colour))?;
        self.aovs.iter().try_for_each(|aov| output::npy(&aov.file, aov.image, picture))?;
        self.camera_out.iter().try_for_each(|path| output::json(path, &CameraFile::from(camera)))?;
        self.stats.iter().zip(stats).try_for_each(|(path, stats)| output::json(path, stats))
    }
}
