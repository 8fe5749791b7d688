//! The picture that the window shows, and the one that could not be drawn.
//!
//! ```text
//!   wanted ── is it shown, or has it failed? ─no─▶ drawn ──▶ shown: picks read its images, by its camera
//!                                                    └─────▶ failed: the one before stays, with its camera
//! ```

use selvedge::model::Camera;
use selvedge::picture::FrameSettings;

/// What a picture is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownPicture {
    pub camera: Camera,
    pub settings: FrameSettings,
    /// The engine's count of uploads and changes.
    pub generation: u64,
}

/// The last pictures.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pictures {
    shown: Option<ShownPicture>,
    failed: Option<ShownPicture>,
}

impl Pictures {
    /// Whether this picture is to be drawn. One that has failed is tried again only after another one was wanted.
    pub fn is_due(&mut self, wanted: &ShownPicture) -> bool {
        self.failed = self.failed.filter(|failed| failed == wanted);
        self.failed.is_none() && self.shown != Some(*wanted)
    }

    /// It is in the window; `complete` is false where parts of it are missing, so that it is due again.
    pub fn drawn(&mut self, picture: ShownPicture, complete: bool) {
        self.shown = complete.then_some(picture);
    }

    /// It cannot be drawn: the one before is in the window still.
    pub fn failed(&mut self, picture: ShownPicture) {
        self.failed = Some(picture);
    }

    /// The camera of the images in the window, where these are complete and of the engine's model as it is now.
    pub fn camera(&self, generation: u64) -> Option<Camera> {
        self.shown.filter(|shown| shown.generation == generation).map(|shown| shown.camera)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use selvedge::model::Bounds;

    fn from(x: f64) -> ShownPicture {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::ONE };
        let camera = Camera::around(bounds, DVec3::new(x, -1.0, 0.5), DVec3::Z, 0.6, (64, 48));
        ShownPicture { camera, settings: FrameSettings::default(), generation: 3 }
    }

    #[test]
    fn a_failed_picture_leaves_the_camera_of_the_one_before() {
        let (first, second, third) = (from(1.0), from(2.0), from(3.0));
        let mut pictures = Pictures::default();
        assert!(pictures.is_due(&first) && pictures.camera(3).is_none());
        pictures.drawn(first, true);
        assert!(!pictures.is_due(&first) && pictures.is_due(&second));
        pictures.failed(second);
        assert!(!pictures.is_due(&second), "it is not tried again and again");
        assert_eq!(pictures.camera(3), Some(first.camera));
        assert!(pictures.is_due(&third) && pictures.is_due(&second), "another one was wanted meanwhile");
        pictures.drawn(second, true);
        assert_eq!(pictures.camera(3), Some(second.camera));
    }

    #[test]
    fn an_incomplete_picture_and_one_of_another_model_are_not_picked_from() {
        let mut pictures = Pictures::default();
        pictures.drawn(from(1.0), true);
        assert_eq!((pictures.camera(3), pictures.camera(4)), (Some(from(1.0).camera), None));
        pictures.drawn(from(2.0), false);
        assert!(pictures.camera(3).is_none() && pictures.is_due(&from(2.0)));
    }
}
