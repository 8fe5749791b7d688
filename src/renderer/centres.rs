//! Positions of solids' surfaces relative to the frame's eye, computed in `f64` for every camera.

use super::Retired;
use super::slot::{upload_buffer, upload_texels};
use crate::abi;
use crate::frame::Centres;
use crate::gpu::{Buffer, Device, GpuError, TexelBuffer};
use crate::model::Camera;
use crate::scene::{SceneData, SolidData};

/// Buffers of one frame slot; `None` where the scene has nothing of the kind.
#[derive(Default)]
pub(super) struct SlotCentres {
    leaves: Option<Buffer>,
    surfaces: Option<TexelBuffer>,
    /// Surfaces of the volume that trims the scene.
    volume: Option<TexelBuffer>,
    /// The sun, and where its picture has the eye.
    sun: Option<Buffer>,
    /// The parts that it sees.
    sun_parts: Option<TexelBuffer>,
}

impl SlotCentres {
    /// Writes them for a camera and a sun with or without `shadows`; what was too small or is not needed any more goes
    /// to `retired`.
    pub(super) fn write(
        &mut self,
        device: &Device,
        data: &SceneData,
        camera: &Camera,
        shadows: bool,
        retired: &mut Vec<Retired>,
    ) -> Result<(), GpuError> {
        let solids = &data.solids;
        // of the leaves none need have a surface with an equation
        let any = !solids.leaf_centres.is_empty();
        let leaves: Vec<_> = solids.leaf_centres.iter().map(|c| (c - camera.eye).as_vec3().to_array()).collect();
        let bytes = size_of_val(leaves.as_slice()) as u64;
        if !any || self.leaves.as_ref().is_some_and(|b| b.bytes() < bytes) {
            retired.extend(self.leaves.take().map(Retired::Buffer));
        }
        if any && self.leaves.is_none() {
            self.leaves = Some(upload_buffer(device, "solid leaf centres", bytes)?);
        }
        self.leaves.iter_mut().for_each(|buffer| buffer.write(0, &leaves));
        let seen = |data: &SolidData| data.places.iter().map(|p| p.seen_from(camera.eye)).collect::<Vec<_>>();
        let parts = data.sun.as_ref().map(|sun| sun.middles_from(camera.eye)).filter(|parts| !parts.is_empty());
        let lists = [
            (&mut self.surfaces, "solid surface places", any.then(|| seen(solids))),
            (&mut self.volume, "volume surface places", data.volume.as_ref().map(seen)),
            (&mut self.sun_parts, "sun parts", parts),
        ];
        for (place, name, texels) in lists {
            let bytes = texels.as_ref().map_or(0, |texels| size_of_val(texels.as_slice()) as u64);
            if texels.is_none() || place.as_ref().is_some_and(|t| t.bytes() < bytes) {
                retired.extend(place.take().map(Retired::TexelBuffer));
            }
            if texels.is_some() && place.is_none() {
                *place = Some(upload_texels(device, name, bytes)?);
            }
            place.iter_mut().zip(&texels).for_each(|(buffer, texels)| buffer.write(0, texels));
        }
        match &data.sun {
            None => retired.extend(self.sun.take().map(Retired::Buffer)),
            Some(sun) => {
                if self.sun.is_none() {
                    self.sun = Some(upload_buffer(device, "sun", size_of::<abi::Sun>() as u64)?);
                }
                let seen = sun.seen_from(camera.eye);
                // no tiles: nothing stands before the sun
                let seen = if shadows { seen } else { abi::Sun { across: 0, ..seen } };
                self.sun.iter_mut().for_each(|buffer| buffer.write(0, &[seen]));
            }
        }
        Ok(())
    }

    /// Of Boolean solids.
    pub(super) fn solids(&self) -> Option<Centres<'_>> {
        let (leaves, surfaces) = (self.leaves.as_ref()?, self.surfaces.as_ref()?);
        Some(Centres { leaves, surfaces })
    }

    pub(super) fn sun(&self) -> Option<&Buffer> {
        self.sun.as_ref()
    }

    pub(super) fn sun_parts(&self) -> Option<&TexelBuffer> {
        self.sun_parts.as_ref()
    }

    pub(super) fn volume(&self) -> Option<&TexelBuffer> {
        self.volume.as_ref()
    }
}
