//! The scene's buffers by the arrays that they hold, and larger ones in their place.
//!
//! ```text
//!   Write beyond the end ─▶ a buffer twice as large ◀──copy on the GPU── the one before, retired
//! ```
//!
//! Doubled each time, a buffer is copied once or twice for each byte that is ever added to it.

use super::edit::{EditTarget, Write};
use super::upload::{Scene, Trims};
use crate::gpu::{Buffer, GpuError, TexelBuffer};
use std::collections::BTreeMap;

/// A buffer of the scene.
pub(crate) enum Array {
    Structs(Buffer),
    Texels(TexelBuffer),
}

impl Array {
    pub(crate) fn buffer(&self) -> &Buffer {
        match self {
            Self::Structs(buffer) => buffer,
            Self::Texels(texels) => texels,
        }
    }
}

/// A place in the scene where a buffer is.
enum Place<'a> {
    Structs(&'a mut Buffer),
    Texels(&'a mut TexelBuffer),
}

/// The field of the scene that holds an array, by `$structs` or `$texels` as its kind is; shared or mutable.
macro_rules! at {
    ($scene:expr, $to:expr, $structs:path, $texels:path, $as_ref:ident, $($mutable:tt)?) => {{
        let scene = $scene;
        match $to {
            EditTarget::Patches => Some($texels(& $($mutable)? scene.patches)),
            EditTarget::Outside => scene.outside.$as_ref().map($structs),
            EditTarget::Cones => scene.cones.$as_ref().map($structs),
            EditTarget::Points => Some($texels(& $($mutable)? scene.points)),
            EditTarget::Links => scene.links.$as_ref().map($structs),
            EditTarget::Faces => Some($texels(& $($mutable)? scene.faces)),
            EditTarget::FaceInstances => Some($texels(& $($mutable)? scene.face_instances)),
            EditTarget::Instances => Some($texels(& $($mutable)? scene.instances)),
            EditTarget::Items => Some($texels(& $($mutable)? scene.patch_instances)),
            EditTarget::Sources => scene.sources.$as_ref().map($texels),
            EditTarget::Mesh(nth) => scene.meshes.$as_ref().and_then(|meshes| match nth {
                0 => Some($structs(& $($mutable)? meshes.meshes)),
                1 => Some($structs(& $($mutable)? meshes.instances)),
                2 => Some($structs(& $($mutable)? meshes.positions)),
                3 => Some($structs(& $($mutable)? meshes.triangles)),
                4 => Some($structs(& $($mutable)? meshes.normals)),
                _ => meshes.neighbours.$as_ref().map($structs),
            }),
            of_trims => match (of_trims, scene.trims.$as_ref()) {
                (EditTarget::Cells, Some(Trims::Table(trims))) => Some($structs(& $($mutable)? trims.cells)),
                (EditTarget::CellInstances, Some(Trims::Table(trims))) => {
                    Some($structs(& $($mutable)? trims.cell_instances))
                }
                (EditTarget::Curves, Some(Trims::Table(trims))) => Some($texels(& $($mutable)? trims.curves)),
                (EditTarget::CurvePoints, Some(Trims::Table(trims))) => {
                    Some($texels(& $($mutable)? trims.curve_points))
                }
                (EditTarget::CurveInstances, Some(Trims::Table(trims))) => {
                    Some($texels(& $($mutable)? trims.curve_instances))
                }
                (EditTarget::WideStrips, Some(Trims::Table(trims))) => trims.wide_strips.$as_ref().map($structs),
                (EditTarget::Exact(0), Some(Trims::Exact(trims))) => Some($texels(& $($mutable)? trims.faces)),
                (EditTarget::Exact(1), Some(Trims::Exact(trims))) => Some($texels(& $($mutable)? trims.cells)),
                (EditTarget::Exact(_), Some(Trims::Exact(trims))) => Some($texels(& $($mutable)? trims.arcs)),
                _ => None,
            },
        }
    }};
}

fn structs(buffer: &Buffer) -> &Buffer {
    buffer
}

fn texels(texels: &TexelBuffer) -> &Buffer {
    texels
}

impl Scene {
    /// The buffer of an array; `None` where nothing of the scene reads it.
    pub(crate) fn buffer(&self, of: EditTarget) -> Option<&Buffer> {
        at!(self, of, structs, texels, as_ref,)
    }

    fn place(&mut self, of: EditTarget) -> Option<Place<'_>> {
        at!(self, of, Place::Structs, Place::Texels, as_mut, mut)
    }

    /// Buffers in place of those that have no room for the writes, still empty.
    pub(crate) fn larger<'w>(
        &mut self,
        writes: impl Iterator<Item = &'w Write>,
    ) -> Result<BTreeMap<EditTarget, Array>, GpuError> {
        let mut ends: BTreeMap<EditTarget, u64> = BTreeMap::new();
        for write in writes {
            let end = ends.entry(write.to).or_default();
            *end = (*end).max(write.offset + write.bytes.len() as u64);
        }
        let mut larger = BTreeMap::new();
        for (of, bytes) in ends {
            let had = self.buffer(of).map_or(u64::MAX, Buffer::bytes);
            if bytes <= had {
                continue;
            }
            let Some(place) = self.place(of) else { continue };
            let made = |bytes| match &place {
                Place::Structs(buffer) => buffer.of_size(bytes).map(Array::Structs),
                Place::Texels(texels) => texels.of_size(bytes).map(Array::Texels),
            };
            // where there is no room for as much again, what is needed may still fit
            let doubled = made(bytes.max(2 * had));
            let array = doubled.or_else(|error| if error.is_device_lost() { Err(error) } else { made(bytes) })?;
            larger.insert(of, array);
        }
        Ok(larger)
    }

    /// Puts a buffer in the place of another of its kind, which is returned.
    pub(crate) fn replace(&mut self, of: EditTarget, by: Array) -> Array {
        match (self.place(of), by) {
            (Some(Place::Structs(place)), Array::Structs(by)) => Array::Structs(std::mem::replace(place, by)),
            (Some(Place::Texels(place)), Array::Texels(by)) => Array::Texels(std::mem::replace(place, by)),
            (_, by) => by,
        }
    }
}
