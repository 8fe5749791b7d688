//! Points of a model to snap to.

use crate::border::{SelvedgeStatus, Sized, argument, border, given, handle, taken};
use crate::model::SelvedgeModel;
use crate::renderer::{NO_VIEW, SelvedgeView};
use selvedge_jobs::{SNAP_KINDS, Snapped, Snapper};
use std::sync::Arc;

/// An edge's end.
pub const SELVEDGE_SNAP_VERTEX: u32 = 1;
/// The centre of a round edge.
pub const SELVEDGE_SNAP_CENTRE: u32 = 2;
/// A point on an edge.
pub const SELVEDGE_SNAP_EDGE: u32 = 4;

/// In the order of `SNAP_KINDS`.
const BITS: [u32; 3] = [SELVEDGE_SNAP_VERTEX, SELVEDGE_SNAP_CENTRE, SELVEDGE_SNAP_EDGE];

/// A point of a model near a place in a picture.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeSnap {
    /// sizeof(SelvedgeSnap)
    pub struct_size: usize,
    /// SELVEDGE_SNAP_VERTEX, SELVEDGE_SNAP_CENTRE or SELVEDGE_SNAP_EDGE; 0: no point was found, and the other fields
    /// are 0.
    pub kind: u32,
    /// Number of the edge, as in the image of edges; for a vertex, the number of an edge that ends there.
    pub edge: u32,
    /// Number of the placed body, as in the image of instances.
    pub instance: u32,
    /// Millimetres.
    pub point: [f64; 3],
    /// Position in the picture, pixels from the upper left corner; the first pixel's centre is 0.5, 0.5.
    pub pixel: [f64; 2],
    /// Distance from the given place, pixels.
    pub distance_px: f64,
    /// Distance from the eye along the view axis, millimetres.
    pub depth: f64,
}

// SAFETY: it begins with its size and consists of numbers
unsafe impl Sized for SelvedgeSnap {}

impl SelvedgeSnap {
    fn of(found: Option<Snapped>) -> Self {
        let (point, pixel) = found.map_or(([0.0; 3], [0.0; 2]), |found| (found.point, found.pixel));
        let kind = |found: Snapped| BITS.iter().zip(SNAP_KINDS).find(|(_, (name, _))| *name == found.kind);
        Self {
            struct_size: 0,
            kind: found.and_then(kind).map_or(0, |(bit, _)| *bit),
            edge: found.map_or(0, |found| found.edge as u32),
            instance: found.map_or(0, |found| found.instance as u32 + 1),
            point,
            pixel,
            distance_px: found.map_or(0.0, |found| found.distance_px),
            depth: found.map_or(0.0, |found| found.depth),
        }
    }
}

/// Finds a visible point of the model within `radius` pixels of a place in the view's picture, and fills `snap`, whose
/// struct_size is set. `kinds`: SELVEDGE_SNAP_VERTEX | SELVEDGE_SNAP_CENTRE | SELVEDGE_SNAP_EDGE. A vertex is preferred
/// to a centre, and both to an edge; within a kind the nearest point is taken. An edge offers only its point nearest to
/// the place. Only size and camera of the view are read. The search uses double precision and no device.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_model_snap(
    model: *const SelvedgeModel,
    view: *const SelvedgeView,
    x: f64,
    y: f64,
    radius: f64,
    kinds: u32,
    snap: *mut SelvedgeSnap,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (model, view) = unsafe { (handle("model", model)?, taken(view, NO_VIEW)?) };
        if kinds == 0 || kinds & !BITS.iter().fold(0, |all, bit| all | bit) != 0 {
            return Err(argument(format!("{kinds} is no choice of vertices, centres and edges")));
        }
        let wanted = BITS.iter().zip(SNAP_KINDS).filter(|(bit, _)| kinds & **bit != 0);
        let wanted: Vec<_> = wanted.map(|(_, (_, kind))| kind).collect();
        // SAFETY: as the caller promises
        let camera = unsafe { view.camera_of(&model.loaded.model) }?;
        let snapper = match model.snapper.get() {
            Some(snapper) => snapper,
            None => {
                let made = Snapper::new(Arc::clone(&model.loaded.model))?;
                model.snapper.get_or_init(|| made)
            }
        };
        let found = snapper.snap(&camera, [x, y], radius, &wanted)?;
        // SAFETY: as the caller promises
        unsafe { given(snap, SelvedgeSnap::of(found)) }
    })
}
