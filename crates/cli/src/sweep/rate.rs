//! Triangles a second, beside those of a plain grid: a mesh of vertices that stand in a buffer, drawn as instances, with the
//! same attachments, as many triangles and as large a picture.

use super::{Row, WARM_UP_FRAMES, pass_ms, renderer};
use crate::args::SweepArgs;
use anyhow::{Context, Result};
use glam::{DAffine3, DVec3};
use selvedge::model::{Camera, Instance, Mesh, Model, Part};
use selvedge::picture::{FrameSettings, Outputs};

/// Squares along each side of the mesh.
const SIDE: usize = 64;

/// The rate of the row that drew the most triangles.
pub fn sentence(args: &SweepArgs, rows: &[Row]) -> Result<String> {
    let row = rows.iter().max_by_key(|r| r.triangles).context("nothing was drawn")?;
    let model = grid(row.triangles as usize / (2 * SIDE * SIDE) + 1)?;
    let mut camera = Camera::around(model.bounds(), DVec3::new(0.0, -0.3, 1.0), DVec3::Y, 0.6, (row.width, row.height));
    camera.fit_depth(model.bounds());
    let mut renderer = renderer(args)?;
    renderer.upload(&model)?;
    let settings = FrameSettings { all_passes: true, ..FrameSettings::default() };
    let mut frames = Vec::new();
    for _ in 0..WARM_UP_FRAMES + args.frames {
        frames.push(renderer.render(&camera, &settings, Outputs::default())?.stats);
    }
    let frames = &frames[WARM_UP_FRAMES..];
    let plain = frames[0].triangles as f64 / pass_ms(frames, "mesh") / 1e3;
    let ours = row.triangles as f64 / (row.tessellation_ms + row.visibility_ms) / 1e3;
    Ok(format!(
        "{}: {ours:.2} million triangles a second in tessellation and visibility, of {}; {plain:.2} in an instanced \
         grid of {}: {:.0} %\n",
        row.model,
        row.triangles,
        frames[0].triangles,
        100.0 * ours / plain
    ))
}

/// That many copies of a square in a square.
fn grid(copies: usize) -> Result<Model> {
    let at = |i: usize, j: usize| (j * (SIDE + 1) + i) as u32;
    let positions = (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| DVec3::new(i as f64, j as f64, 0.0)));
    let squares = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (i, j)));
    let triangles = squares.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        [[a, b, d], [a, d, c]]
    });
    let mesh = Mesh::new(1, positions.collect(), triangles.collect(), Vec::new())?;
    let across = (1..).find(|n: &usize| n * n >= copies).unwrap_or(1);
    let instance = |copy: usize| {
        let place = DVec3::new((copy % across) as f64, (copy / across) as f64, 0.0) * SIDE as f64;
        Instance { part: 0, transform: DAffine3::from_translation(place), colour: None, name: String::new() }
    };
    Ok(Model {
        parts: vec![Part { meshes: vec![mesh], ..Part::default() }],
        instances: (0..copies).map(instance).collect(),
        ..Model::default()
    })
}
