//! Whether Boolean solids leave anything to draw, for commands that open no device.
//!
//! The exact tracer follows rays through a picture of the whole model, coarse to fine, until one meets a surface. A model
//! with a surface costs a few rays, an empty one a picture of [`SIZE`].

use crate::cut::NO_BOX;
use crate::{camera, reading};
use anyhow::{Result, bail};
use glam::DVec2;
use rayon::prelude::*;
use selvedge::model::Model;
use selvedge_check::Tracer;
use std::path::Path;

/// The default size of pictures, so that `render` and these commands agree.
const SIZE: (u32, u32) = (1920, 1080);
/// Pixels between rays, one round after another.
const STRIDES: [usize; 3] = [32, 8, 1];

/// Refuses a model whose solids are all empty, as `render` does after its picture.
pub fn judge(path: &Path, model: &Model) -> Result<()> {
    if is_certain(model) || any(model) {
        return Ok(());
    }
    if camera::bounds(model).is_empty() {
        bail!("{}: nothing of it can be drawn: {NO_BOX}", reading::named(path));
    }
    let (width, height) = SIZE;
    bail!(
        "{}: nothing of it can be drawn: its solids leave no surface, or none at the centre of any pixel of a picture of \
         {width} x {height}",
        reading::named(path)
    )
}

/// Whether faces and meshes are certainly visible: no volume trims them.
fn is_certain(model: &Model) -> bool {
    let drawn = |part: usize| model.parts.get(part).is_some_and(|p| !(p.faces.is_empty() && p.meshes.is_empty()));
    model.trim.is_none() && (model.solids.is_empty() || model.instances.iter().any(|i| drawn(i.part)))
}

/// Whether a ray meets anything, or may have missed it.
fn any(model: &Model) -> bool {
    let tracer = Tracer::new(model);
    let camera = camera::whole(camera::bounds(model), SIZE);
    let row = |y: usize, stride: usize| {
        let mut probe = tracer.probe(&camera);
        let mut pixels = (stride / 2..SIZE.0 as usize).step_by(stride);
        pixels.any(|x| probe.first(DVec2::new(x as f64, y as f64) + 0.5).is_some())
    };
    let met = STRIDES.iter().any(|&stride| {
        let rows: Vec<_> = (stride / 2..SIZE.1 as usize).step_by(stride).collect();
        rows.into_par_iter().any(|y| row(y, stride))
    });
    met || tracer.given_up() > 0
}
