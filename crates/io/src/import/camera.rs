//! Cameras and picture settings that a file brings along.
//!
//! ```text
//!   At   eye ──────▶ target          Fit   from ◀── centre      the box of what is fitted just fills the picture
//! ```

use crate::model::{Bounds, Camera, Colour, Projection};
use glam::DVec3;

/// How a named camera foreshortens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Vertical field of view in radians.
    Perspective {
        /// In `(0, π)`.
        fov_y: f64,
    },
    /// Parallel projection.
    Parallel {
        /// Height of the picture in millimetres; `None` where it is fitted.
        height: Option<f64>,
    },
}

/// Where a named camera stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stance {
    /// At a point.
    At {
        /// The eye, millimetres.
        eye: DVec3,
        /// What it looks at; `None` for the middle of the model.
        target: Option<DVec3>,
    },
    /// Just so far away that all of a box is in the picture.
    Fit {
        /// From the box towards the eye.
        from: DVec3,
        /// The box; `None` for that of the model.
        bounds: Option<Bounds>,
        /// Room around it: 1 for none.
        margin: f64,
    },
}

/// A camera of a file, for pictures of any size.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCamera {
    /// What the file calls it.
    pub name: String,
    /// Where it stands.
    pub stance: Stance,
    /// A direction that points up in the picture.
    pub up: DVec3,
    /// How it foreshortens.
    pub lens: Lens,
}

/// The picture settings of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureSettings {
    /// Width and height in pixels.
    pub size: Option<(u32, u32)>,
    /// Index of a camera.
    pub camera: Option<usize>,
    /// Colour behind the model.
    pub background: Option<Colour>,
    /// From the model towards the sun; the engine's `SceneSettings::sun`.
    pub sun: Option<DVec3>,
}

impl NamedCamera {
    /// The camera for a model with a box and a picture with a size; its depth range holds the model.
    ///
    /// It may show nothing: see [`Camera::check`].
    pub fn camera(&self, model: Bounds, size: (u32, u32)) -> Camera {
        let middle = if model.is_empty() { DVec3::ZERO } else { model.centre() };
        let projection = match self.lens {
            Lens::Perspective { fov_y } => Projection::Perspective { fov_y },
            Lens::Parallel { height } => Projection::Orthographic { height: height.unwrap_or(1.0) },
        };
        let mut camera =
            Camera { eye: DVec3::ZERO, target: middle, up: self.up, projection, depth_range: (1.0, 2.0), size };
        match self.stance {
            Stance::At { eye, target } => (camera.eye, camera.target) = (eye, target.unwrap_or(middle)),
            Stance::Fit { from, bounds, margin } => fit(&mut camera, from, bounds.unwrap_or(model), margin, self.lens),
        }
        camera.fit_depth(model);
        camera
    }
}

/// Moves the eye along `from` until the corners of the box are inside the picture, the farthest of them at its border.
///
/// ```text
///   corner (x, y, z) from the centre, z towards the eye:   |x| <= (d - z) tan α   ─▶   d = max z + |x| / tan α
/// ```
fn fit(camera: &mut Camera, from: DVec3, bounds: Bounds, margin: f64, lens: Lens) {
    let centre = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
    (camera.target, camera.eye) = (centre, centre + from.normalize_or(DVec3::X));
    let (right, up, forward) = camera.axes();
    let aspect = f64::from(camera.size.0) / f64::from(camera.size.1);
    let radius = (0.5 * bounds.diagonal()).max(1e-9);
    // the larger of both directions, in heights of the picture
    let spread = |p: DVec3| (p.dot(right).abs() / aspect).max(p.dot(up).abs()) * margin;
    let corners = bounds.corners().map(|c| if bounds.is_empty() { DVec3::ZERO } else { c - centre });
    let distance = match camera.projection {
        Projection::Perspective { fov_y } => {
            let slope = (0.5 * fov_y).tan();
            let reach = |p: &DVec3| spread(*p) / slope - p.dot(forward);
            corners.iter().map(reach).fold(1e-3 * radius, f64::max)
        }
        _ => {
            if let Lens::Parallel { height: None } = lens {
                let height = corners.iter().map(|p| 2.0 * spread(*p)).fold(1e-6 * radius, f64::max);
                camera.projection = Projection::Orthographic { height };
            }
            2.0 * radius
        }
    };
    camera.eye = centre - forward * distance;
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Bounds = Bounds { min: DVec3::new(-10.0, -3.0, 0.0), max: DVec3::new(30.0, 3.0, 1.0) };

    fn named(lens: Lens) -> NamedCamera {
        let stance = Stance::Fit { from: DVec3::new(1.0, -1.6, 1.1), bounds: None, margin: 1.0 };
        NamedCamera { name: String::new(), stance, up: DVec3::Z, lens }
    }

    /// All corners are in the picture, one of them at its border.
    #[test]
    fn a_fitted_box_just_fills_the_picture() {
        for lens in [Lens::Perspective { fov_y: 0.6 }, Lens::Parallel { height: None }] {
            for size in [(400, 300), (100, 900), (900, 100)] {
                let camera = named(lens).camera(BOX, size);
                camera.check().unwrap();
                let (w, h) = (f64::from(size.0), f64::from(size.1));
                let nearest = BOX.corners().map(|c| {
                    let (p, depth) = camera.project(c).expect("in front");
                    assert!(depth >= camera.depth_range.0 && depth <= camera.depth_range.1);
                    p.x.min(w - p.x).min(p.y.min(h - p.y))
                });
                let nearest = nearest.into_iter().fold(f64::INFINITY, f64::min);
                assert!(nearest.abs() < 1e-6, "{lens:?} {size:?}: {nearest} pixels from the border");
            }
        }
    }

    #[test]
    fn a_margin_leaves_room() {
        let mut camera = named(Lens::Parallel { height: None });
        let Projection::Orthographic { height } = camera.camera(BOX, (400, 300)).projection else { panic!() };
        camera.stance = Stance::Fit { from: DVec3::new(1.0, -1.6, 1.1), bounds: None, margin: 1.25 };
        let Projection::Orthographic { height: wider } = camera.camera(BOX, (400, 300)).projection else { panic!() };
        assert!((wider / height - 1.25).abs() < 1e-12);
    }

    #[test]
    fn an_empty_model_has_a_camera() {
        named(Lens::Perspective { fov_y: 0.6 }).camera(Bounds::EMPTY, (64, 48)).check().unwrap();
    }
}
