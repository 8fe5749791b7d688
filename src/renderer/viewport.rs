//! The images that a frame draws into if its targets have a corner.

use super::targets::TARGETS;
use super::{RenderError, Renderer, Retired, Targets};
use crate::frame::viewport::{self, Pair};
use crate::gpu::{GpuError, Image};

/// One for each target, of the picture's size.
pub(super) struct Viewport {
    images: [Option<Image>; TARGETS],
    size: (u32, u32),
}

impl Viewport {
    /// There is one for each of these targets.
    fn suffices(&self, targets: &Targets<'_>, size: (u32, u32)) -> bool {
        let all = targets.all();
        self.size == size && (0..TARGETS).all(|nth| all[nth].is_none() || self.images[nth].is_some())
    }

    /// The host's targets with these images in their place.
    pub(super) fn targets<'a>(&'a self, host: &Targets<'a>) -> Targets<'a> {
        host.replaced(|nth, _| self.images[nth].as_ref())
    }

    /// Each target and what is drawn in its place.
    pub(super) fn pairs<'a>(&'a self, host: &Targets<'a>) -> Vec<Pair<'a>> {
        host.all().into_iter().zip(&self.images).filter_map(|(target, own)| target.zip(own.as_ref())).collect()
    }
}

impl Renderer {
    /// Makes the images for these targets. Retires the old ones if they do not fit, or if the targets have no corner.
    pub(super) fn make_viewport(&mut self, targets: &Targets<'_>, size: (u32, u32)) -> Result<(), RenderError> {
        let wanted = targets.corner.is_some();
        if self.viewport.as_ref().is_some_and(|own| wanted && own.suffices(targets, size)) {
            return Ok(());
        }
        let made = wanted.then(|| -> Result<Viewport, GpuError> {
            let mut images = [const { None }; TARGETS];
            for (own, target) in images.iter_mut().zip(targets.all()) {
                *own = target.map(|target| viewport::image(&self.device, target, size)).transpose()?;
            }
            Ok(Viewport { images, size })
        });
        let made = made.transpose()?;
        if let Some(old) = std::mem::replace(&mut self.viewport, made) {
            self.retire(Retired::Viewport(Box::new(old)));
        }
        Ok(())
    }
}
