//! Where surfaces of solids are, seen from a frame's eye: what changes with the camera and stays in `f64`.

use super::slot::upload_buffer;
use crate::abi;
use crate::frame::Centres;
use crate::gpu::{Buffer, Device, GpuError};
use crate::model::Camera;
use crate::scene::SceneData;
use glam::DVec3;

/// Buffers of one frame slot; `None` where the scene has nothing of the kind.
#[derive(Default)]
pub(super) struct SlotCentres {
    leaves: Option<Buffer>,
    surfaces: Option<Buffer>,
    /// Surfaces of the volume that trims the scene.
    volume: Option<Buffer>,
    /// The sun, and where its picture has the eye.
    sun: Option<Buffer>,
}

impl SlotCentres {
    /// Writes them for a camera; returns the buffers that were too small or are not needed any more.
    pub(super) fn write(
        &mut self,
        device: &Device,
        data: &SceneData,
        camera: &Camera,
    ) -> Result<impl Iterator<Item = Buffer>, GpuError> {
        let none = Vec::new();
        let volume = data.volume.as_ref().map_or(&none, |v| &v.surface_centres);
        let solids = &data.solids;
        let any = !solids.leaf_centres.is_empty(); // of which none need have a surface with an equation
        let lists: [(&mut Option<Buffer>, &str, &[DVec3], bool); 3] = [
            (&mut self.leaves, "solid leaf centres", &solids.leaf_centres, any),
            (&mut self.surfaces, "solid surface centres", &solids.surface_centres, any),
            (&mut self.volume, "volume centres", volume, !volume.is_empty()),
        ];
        let mut gone = Vec::new();
        for (place, name, list, wanted) in lists {
            let bytes = (list.len() * size_of::<[f32; 3]>()) as u64;
            if !wanted {
                gone.extend(place.take());
                continue;
            }
            if place.as_ref().is_none_or(|b| b.bytes() < bytes) {
                gone.extend(place.replace(upload_buffer(device, name, bytes)?));
            }
            let seen: Vec<[f32; 3]> = list.iter().map(|c| (*c - camera.eye).as_vec3().to_array()).collect();
            place.iter_mut().for_each(|buffer| buffer.write(0, &seen));
        }
        match &data.sun {
            None => gone.extend(self.sun.take()),
            Some(sun) => {
                if self.sun.is_none() {
                    self.sun = Some(upload_buffer(device, "sun", size_of::<abi::Sun>() as u64)?);
                }
                self.sun.iter_mut().for_each(|buffer| buffer.write(0, &[sun.seen_from(camera.eye)]));
            }
        }
        Ok(gone.into_iter())
    }

    /// Of Boolean solids.
    pub(super) fn solids(&self) -> Option<Centres<'_>> {
        let (leaves, surfaces) = (self.leaves.as_ref()?, self.surfaces.as_ref()?);
        Some(Centres { leaves, surfaces })
    }

    pub(super) fn sun(&self) -> Option<&Buffer> {
        self.sun.as_ref()
    }

    pub(super) fn volume(&self) -> Option<&Buffer> {
        self.volume.as_ref()
    }
}
