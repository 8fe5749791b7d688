//! Cameras from the command line, and the built-in views.
//!
//! ```text
//!   whole     the model in the picture, as large as it fits, from Camera::FROM
//!   close     the same direction, CLOSER times nearer, at the nearest detail that is seen
//!   grazing   along the largest extent, GRAZING_DEG above the two larger ones
//! ```

use crate::args::{CameraArgs, Size, Views};
use crate::closer::{Approach, details};
use anyhow::{Context, Result, bail};
use glam::DVec3;
use selvedge::model::{Bounds, Camera, Model, Projection};
use selvedge_io::import::{Import, NamedCamera};
use selvedge_jobs::Direction;

/// How much nearer the close view is. At six times a 1080p picture shows the detail of 6480 lines: far beyond the
/// resolution of a mesh made for the whole view.
const CLOSER: f64 = 6.0;
/// Low enough that a silhouette crosses many surfaces, high enough that a flat model shows its face.
const GRAZING_DEG: f64 = 8.0;

/// Field of view in radians of the perspective that frames a parallel view: its error is this share at most.
const NARROW: f64 = 1e-4;
/// Default size of a picture.
const SIZE: Size = Size(1920, 1080);

pub use selvedge_jobs::{CameraFile, bounds, whole};

/// A camera and its name in reports.
#[derive(Clone, Debug)]
pub struct View {
    pub name: String,
    pub camera: Camera,
}

impl CameraArgs {
    /// The camera: one of the file's by name, or that of the arguments.
    pub fn of(&self, import: &Import) -> Result<Camera> {
        self.over(bounds(&import.model), import)
    }

    /// The same, of a model with this box.
    fn over(&self, bounds: Bounds, import: &Import) -> Result<Camera> {
        match self.named(import)? {
            Some(named) => fitted(named.camera(bounds, self.pixels(import)), bounds),
            None => self.camera(&import.model, bounds, self.pixels(import)),
        }
    }

    /// From one of the standard directions, as large as the model fits.
    pub fn standard(&self, direction: Direction, import: &Import, size: (u32, u32)) -> Result<Camera> {
        let up = self.up.unwrap_or(direction.up());
        fitted(self.framed(&import.model, direction.from(), up, size), bounds(&import.model))
    }

    /// For a drawing: parallel, fitted to the picture, from a direction or from [`Camera::FROM`], unless the arguments
    /// state another camera.
    pub fn parallel(&self, direction: Option<Direction>, import: &Import) -> Result<Camera> {
        let size = self.pixels(import);
        let given = self.eye.is_some() || self.camera.is_some() || self.fov.is_some() || self.ortho.is_some();
        match direction {
            Some(direction) if given => self.standard(direction, import, size),
            None if given => self.of(import),
            _ => {
                let (from, up) = direction.map_or((Camera::FROM, DVec3::Z), |d| (d.from(), d.up()));
                let up = self.up.unwrap_or(up);
                let mut camera = Camera::framing(&import.model, from, up, NARROW, size);
                let back = camera.eye - camera.target;
                camera.projection = Projection::Orthographic { height: 2.0 * back.length() * (0.5 * NARROW).tan() };
                let bounds = bounds(&import.model);
                camera.target = self.target.unwrap_or(camera.target);
                camera.eye = camera.target + back.normalize() * bounds.diagonal().max(1e-9);
                fitted(camera, bounds)
            }
        }
    }

    /// The file's camera of the given name; without any camera argument the one that the file's picture names.
    fn named<'a>(&self, import: &'a Import) -> Result<Option<&'a NamedCamera>> {
        let silent = self.eye.is_none() && self.target.is_none() && self.up.is_none();
        let silent = silent && self.fov.is_none() && self.ortho.is_none();
        let Some(name) = &self.camera else {
            return Ok(import.picture.camera.filter(|_| silent).and_then(|i| import.cameras.get(i)));
        };
        let found = import.cameras.iter().find(|c| c.name == *name);
        if found.is_none() {
            let known: Vec<&str> = import.cameras.iter().map(|c| c.name.as_str()).collect();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            bail!("the file has no camera `{name}`; it has {known}");
        }
        Ok(found)
    }

    /// Width and height of the picture.
    pub fn pixels(&self, import: &Import) -> (u32, u32) {
        let asked = self.size.or(import.picture.size.map(|(w, h)| Size(w, h)));
        let Size(width, height) = asked.unwrap_or(SIZE);
        (width, height)
    }

    /// The camera of the arguments; missing ones are chosen to frame the model.
    fn camera(&self, model: &Model, bounds: Bounds, size: (u32, u32)) -> Result<Camera> {
        let up = self.up.unwrap_or(DVec3::Z);
        if let Some(eye) = self.eye {
            let target = self.target.unwrap_or(if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() });
            let around = self.projected(Camera::around(bounds, Camera::FROM, up, self.fov(), size));
            let camera = Camera { eye, target, ..around };
            let Some(depth_range) = self.near_far else { return fitted(camera, bounds) };
            let camera = Camera { depth_range, ..camera };
            camera.check().context("the camera shows nothing")?;
            return Ok(camera);
        }
        let mut camera = self.framed(model, Camera::FROM, up, size);
        if let Some(target) = self.target {
            (camera.eye, camera.target) = (camera.eye + target - camera.target, target);
        }
        fitted(camera, bounds)
    }

    /// The built-in views; a camera in the arguments replaces `whole` and is called `given`.
    pub fn views(&self, views: Views, import: &Import) -> Result<Vec<View>> {
        let (model, size) = (&import.model, self.pixels(import));
        let bounds = bounds(model);
        let whole = self.over(bounds, import)?;
        let wanted = |one| views == one || views == Views::All;
        let mut list = Vec::new();
        if wanted(Views::Whole) {
            let given = self.eye.is_some() || self.target.is_some() || self.named(import)?.is_some();
            list.push(View { name: if given { "given" } else { "whole" }.to_string(), camera: whole });
        }
        if wanted(Views::Close) {
            let close = Approach::new(model, whole).closer(CLOSER);
            list.push(View { name: "close".to_string(), camera: fitted(close, bounds)? });
        }
        if wanted(Views::Grazing) {
            list.push(View { name: "grazing".to_string(), camera: fitted(self.grazing(model, bounds, size), bounds)? });
        }
        Ok(list)
    }

    /// For each number a view so many times closer.
    pub fn zooms(&self, times: &[f64], import: &Import) -> Result<Vec<View>> {
        let bounds = bounds(&import.model);
        let whole = self.over(bounds, import)?;
        let approach = Approach::new(&import.model, whole);
        let view = |&times: &f64| {
            let camera = fitted(approach.closer(times), bounds)?;
            Ok(View { name: format!("{times} x"), camera })
        };
        times.iter().map(view).collect()
    }

    fn grazing(&self, model: &Model, bounds: Bounds, size: (u32, u32)) -> Camera {
        let extent = bounds.max - bounds.min;
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| extent[a].total_cmp(&extent[b]));
        let (up, along) = (DVec3::AXES[axes[0]], DVec3::AXES[axes[2]]);
        let (sin, cos) = GRAZING_DEG.to_radians().sin_cos();
        self.framed(model, along * cos + up * sin, up, size)
    }

    fn framed(&self, model: &Model, from: DVec3, up: DVec3, size: (u32, u32)) -> Camera {
        self.projected(Camera::framing(model, from, up, self.fov(), size))
    }

    fn projected(&self, camera: Camera) -> Camera {
        let parallel = self.ortho.map(|height| Projection::Orthographic { height });
        Camera { projection: parallel.unwrap_or(camera.projection), ..camera }
    }

    /// Vertical field of view, radians.
    fn fov(&self) -> f64 {
        self.fov.unwrap_or(Camera::FOV_DEG).to_radians()
    }
}

/// `camera` with a depth range that holds the model, checked.
fn fitted(camera: Camera, bounds: Bounds) -> Result<Camera> {
    selvedge_jobs::fitted(camera, bounds).context("the camera shows nothing")
}

/// `zoom` times magnified: the eye stays, the angle narrows. From 1 on the picture's middle moves from the model's to
/// the start of a trim curve. In an open shell that is the curve nearest to the model's middle; on a solid it is the
/// one nearest to the eye, which little can hide.
pub fn zoomed(model: &Model, size: (u32, u32), zoom: f64) -> Camera {
    let bounds = bounds(model);
    let mut camera = Camera::around(bounds, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let solid = model.parts.iter().any(|part| part.closed);
    let from = if solid { camera.eye } else { bounds.centre() };
    let nearest = |p: &DVec3| p.distance_squared(from);
    if let Some(detail) = details(model).min_by(|a, b| nearest(a).total_cmp(&nearest(b))) {
        camera.target = camera.target.lerp(detail, 1.0 - 1.0 / zoom);
    }
    if let Projection::Perspective { fov_y } = &mut camera.projection {
        *fov_y = 2.0 * ((*fov_y * 0.5).tan() / zoom).atan();
    }
    camera.fit_depth(bounds);
    camera
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;
    use glam::DAffine3;
    use selvedge::model::{Primitive, Shape, Solid};

    const BOX: Bounds = Bounds { min: DVec3::new(-10.0, -3.0, 0.0), max: DVec3::new(30.0, 3.0, 1.0) };

    fn args(words: &[&str]) -> CameraArgs {
        let cli = Cli::try_parse_from(["selvedge", "render", "m.step", "-o", "a.png"].iter().chain(words));
        let Command::Render(args) = cli.expect("parses").command else { panic!("render") };
        args.camera
    }

    /// A solid that is the box.
    fn model() -> Model {
        let shape = Shape::Block { min: BOX.min, max: BOX.max };
        let block = Primitive { shape, transform: DAffine3::IDENTITY, colour: [0.5; 4], id: 1 };
        Model { solids: vec![Solid::of(block).expect("a block")], ..Model::default() }
    }

    /// As for a file without a camera.
    fn framing(words: &[&str]) -> Result<Camera> {
        let args = args(words);
        args.camera(&model(), BOX, args.pixels(&Import::default()))
    }

    #[test]
    fn a_zoom_magnifies_by_its_number() {
        let model = selvedge::baselines::many_holes(3);
        let whole = zoomed(&model, (400, 400), 1.0);
        for zoom in [10.0, 1000.0] {
            let camera = zoomed(&model, (400, 400), zoom);
            assert_eq!((camera.check(), camera.eye), (Ok(()), whole.eye));
            let step = camera.axes().0 * 1e-4;
            let pixels = |c: &Camera| {
                let at = |p| c.project(p).expect("in front").0;
                at(camera.target + step).distance(at(camera.target))
            };
            let times = pixels(&camera) / pixels(&whole);
            assert!((times / zoom - 1.0).abs() < 0.05, "{times} instead of {zoom}"); // another direction, too
        }
    }

    fn corners_inside(camera: &Camera) -> bool {
        let (w, h) = (f64::from(camera.size.0), f64::from(camera.size.1));
        BOX.corners().iter().all(|&corner| {
            let (p, depth) = camera.project(corner).expect("in front");
            let range = camera.depth_range.0..=camera.depth_range.1;
            (0.0..=w).contains(&p.x) && (0.0..=h).contains(&p.y) && range.contains(&depth)
        })
    }

    #[test]
    fn without_a_camera_all_of_the_model_is_in_the_picture() {
        assert!(corners_inside(&framing(&[]).expect("camera")));
        assert!(corners_inside(&framing(&["--size", "100x900"]).expect("camera")));
    }

    #[test]
    fn grazing_looks_along_the_largest_extent_from_eight_degrees() {
        let camera = args(&[]).grazing(&model(), BOX, (1920, 1080));
        let back = (camera.eye - camera.target).normalize();
        assert!((back.z - 8f64.to_radians().sin()).abs() < 1e-12 && back.y.abs() < 1e-12 && back.x > 0.9);
        assert!(corners_inside(&camera));
    }

    #[test]
    fn an_eye_without_a_target_looks_at_the_middle() {
        let camera = framing(&["--eye", "0,-90,5"]).expect("camera");
        assert_eq!((camera.eye, camera.target), (DVec3::new(0.0, -90.0, 5.0), BOX.centre()));
    }

    #[test]
    fn an_impossible_camera_is_refused() {
        assert!(framing(&["--eye", "1,2,3", "--target", "1,2,3"]).is_err());
        assert!(framing(&["--eye", "0,0,50", "--target", "0,0,0"]).is_err());
        assert!(framing(&["--fov", "180"]).is_err());
    }
}
