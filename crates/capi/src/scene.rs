//! A host's scene between frames: instances change, models come and go, and a pixel of a frame is read back.
//!
//! ```text
//!   selvedge_host_add ─▶ number ─▶ selvedge_host_instances ─▶ first, count
//!                                                              ╰▶ selvedge_host_set_transform, _visible, _colour, _selected
//!   selvedge_host_pick(x, y) ─▶ the next record ─▶ … the host's fence ─▶ selvedge_host_picked(slot) ─▶ SelvedgeHit
//! ```

use crate::border::{Failure, Outcome, SelvedgeStatus, Sized, argument, border, given, handle};
use crate::host::{SelvedgeHost, render};
use crate::model::SelvedgeModel;
use glam::{DAffine3, DVec3};
use selvedge::model::Colour;
use selvedge::renderer::{Hit, InstanceError, ModelId, Renderer};
use std::collections::HashMap;

/// What a frame shows at a pixel. Numbers are those of the images, counted from 1; 0 is none.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeHit {
    /// sizeof(SelvedgeHit)
    pub struct_size: usize,
    /// Number in the image of faces. 0: the pixel shows no model, or no pixel was read back; the other fields are 0.
    pub face: u32,
    /// Number of the part; 0 for Boolean solids.
    pub part: u32,
    /// Number of the instance; 0 for Boolean solids.
    pub instance: u32,
    /// Number of the edge, among those of the part, whose line covers the pixel; 0 without one.
    pub edge_of_part: u32,
    /// Parameters in the face's domain; of a triangle, the weights of its second and third corner.
    pub uv: [f64; 2],
    /// Millimetres.
    pub point: [f64; 3],
    /// Unit outward normal in model axes; zeros where there is none.
    pub normal: [f64; 3],
    /// Distance from the eye along the view axis, millimetres.
    pub depth: f64,
}

// SAFETY: it begins with its size and consists of numbers
unsafe impl Sized for SelvedgeHit {}

impl SelvedgeHit {
    fn of(hit: Option<Hit>) -> Self {
        let number = |index: Option<usize>| index.map_or(0, |index| index as u32 + 1);
        Self {
            struct_size: 0,
            face: hit.map_or(0, |hit| hit.id),
            part: number(hit.and_then(|hit| hit.part)),
            instance: number(hit.and_then(|hit| hit.instance)),
            edge_of_part: number(hit.and_then(|hit| hit.edge)),
            uv: hit.and_then(|hit| hit.uv).unwrap_or_default().into(),
            point: hit.map_or(DVec3::ZERO, |hit| hit.point).into(),
            normal: hit.and_then(|hit| hit.normal).unwrap_or_default().into(),
            depth: hit.map_or(0.0, |hit| hit.depth),
        }
    }
}

/// The models that were added, by the numbers that hosts know them by.
#[derive(Default)]
pub(crate) struct Added {
    last: u64,
    living: HashMap<u64, ModelId>,
}

impl Added {
    /// A model was uploaded in place of all. Numbers are not used again.
    pub(crate) fn clear(&mut self) {
        self.living.clear();
    }

    fn insert(&mut self, id: ModelId) -> u64 {
        self.last += 1;
        self.living.insert(self.last, id);
        self.last
    }

    fn get(&self, number: u64) -> Result<ModelId, Failure> {
        let none =
            || argument(format!("no added model has the number {number}: it was removed, or another one uploaded"));
        self.living.get(&number).copied().ok_or_else(none)
    }
}

/// Changes one instance of the scene. A number that is no index stands for one beyond all.
///
/// # Safety
/// The pointer is null, or this library made it and it was not freed.
unsafe fn changed(
    host: *const SelvedgeHost,
    instance: u64,
    change: impl FnOnce(&mut Renderer, usize) -> Result<(), InstanceError>,
) -> Outcome {
    // SAFETY: as the caller promises
    let host = unsafe { handle("host", host) }?;
    host.model()?;
    let index = usize::try_from(instance).unwrap_or(usize::MAX);
    change(&mut host.renderer(), index).map_err(|error| argument(error.to_string()))
}

/// Moves an instance, counted from 0. `columns` takes part to model coordinates: the columns x, y, z and the
/// translation, millimetres; finite, not flat, with factors of lengths from 1e-30 to 1e30. The next frame shows the new
/// place; the model is not uploaded again.
///
/// # Safety
/// Pointers are null or point to what they say; `columns` to 12 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_set_transform(
    host: *const SelvedgeHost,
    instance: u64,
    columns: *const f64,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let columns = unsafe { columns.cast::<[f64; 12]>().as_ref() };
        let columns = columns.ok_or_else(|| argument("the transform is a null pointer"))?;
        let [x, y, z, t] = [0, 3, 6, 9].map(|k| DVec3::from_slice(&columns[k..k + 3]));
        // SAFETY: as the caller promises
        unsafe { changed(host, instance, |renderer, i| renderer.set_transform(i, DAffine3::from_cols(x, y, z, t))) }
    })
}

/// Shows (not 0) or hides an instance, counted from 0.
///
/// # Safety
/// The pointer is null or points to a value of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_set_visible(
    host: *const SelvedgeHost,
    instance: u64,
    visible: u32,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        unsafe { changed(host, instance, |renderer, i| renderer.set_visible(i, visible != 0)) }
    })
}

/// Gives an instance, counted from 0, a colour in place of those of its faces: red, green, blue and opacity, from 0 to 1
/// in linear light. The opacity must be 1. Null: the colours of its faces.
///
/// # Safety
/// Pointers are null or point to what they say; `colour` to 4 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_set_colour(
    host: *const SelvedgeHost,
    instance: u64,
    colour: *const f32,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let colour = unsafe { colour.cast::<Colour>().as_ref() }.copied();
        // SAFETY: as the caller promises
        unsafe { changed(host, instance, |renderer, i| renderer.set_colour(i, colour)) }
    })
}

/// Marks an instance, counted from 0, by a colour over its own, as strong as its opacity; numbers as in
/// selvedge_host_set_colour. Null: no mark.
///
/// # Safety
/// Pointers are null or point to what they say; `colour` to 4 numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_set_selected(
    host: *const SelvedgeHost,
    instance: u64,
    colour: *const f32,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let colour = unsafe { colour.cast::<Colour>().as_ref() }.copied();
        // SAFETY: as the caller promises
        unsafe { changed(host, instance, |renderer, i| renderer.set_selected(i, colour)) }
    })
}

/// Adds a model to the uploaded one, without an upload of the rest where the scene allows that: docs/embedding.md. The
/// next frame shows it. `added` gets its number, above 0. Frames in flight draw the scene as it was; nothing waits.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_add(
    host: *const SelvedgeHost,
    model: *const SelvedgeModel,
    added: *mut u64,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (host, model, added) = unsafe { (handle("host", host)?, handle("model", model)?, added.as_mut()) };
        let added = added.ok_or_else(|| argument("the place for the number is a null pointer"))?;
        *added = 0;
        host.model()?;
        let id = host.renderer().add(&model.loaded.model).map_err(render)?;
        *added = host.added().insert(id);
        Ok(())
    })
}

/// Removes a model that was added; the next frame does not show it. The instances of others keep their numbers.
///
/// # Safety
/// The pointer is null or points to a value of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_remove(host: *const SelvedgeHost, added: u64) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let host = unsafe { handle("host", host) }?;
        let id = host.added().get(added)?;
        host.renderer().remove(id).map_err(|error| argument(error.to_string()))?;
        host.added().living.remove(&added);
        Ok(())
    })
}

/// Says which instances are those of an added model: `count` of them from `first` on, counted from 0.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_instances(
    host: *const SelvedgeHost,
    added: u64,
    first: *mut u64,
    count: *mut u64,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (host, places) = unsafe { (handle("host", host)?, (first.as_mut(), count.as_mut())) };
        let (Some(first), Some(count)) = places else { return Err(argument("a place for a number is a null pointer")) };
        let id = host.added().get(added)?;
        let instances = host.renderer().instances_of(id).map_err(|error| argument(error.to_string()))?;
        (*first, *count) = (instances.start as u64, instances.len() as u64);
        Ok(())
    })
}

/// Lets the next frame recorded read back what it shows at a pixel: column and row, from the upper left corner of the
/// picture. The last call before the frame counts.
///
/// # Safety
/// The pointer is null or points to a value of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_pick(host: *const SelvedgeHost, x: u32, y: u32) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let host = unsafe { handle("host", host) }?;
        host.model()?;
        host.renderer().pick(x, y);
        Ok(())
    })
}

/// Fills `hit`, whose struct_size is set, with what the frame recorded last into the slot shows at the pixel of
/// selvedge_host_pick. That frame has finished.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_picked(
    host: *const SelvedgeHost,
    slot: u32,
    hit: *mut SelvedgeHit,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let host = unsafe { handle("host", host) }?;
        let found = host.renderer().picked(host.slot(slot)?);
        // SAFETY: as the caller promises
        unsafe { given(hit, SelvedgeHit::of(found)) }
    })
}

/// The frame recorded last, into this slot, never reached the GPU: the host reset its command buffer, or the submission
/// failed. The next frame copies again what it would have copied.
///
/// # Safety
/// The pointer is null or points to a value of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_discard(host: *const SelvedgeHost, slot: u32) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let host = unsafe { handle("host", host) }?;
        let slot = host.slot(slot)?;
        host.renderer().discard(slot);
        Ok(())
    })
}

/// A call of the host's own returned VK_ERROR_DEVICE_LOST: from now on frames are refused with SELVEDGE_STATUS_RENDER,
/// and selvedge_host_free frees handles alone.
///
/// # Safety
/// The pointer is null or points to a value of its type.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_device_lost(host: *const SelvedgeHost) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let host = unsafe { handle("host", host) }?;
        host.renderer().device_lost();
        Ok(())
    })
}
