//! A picture in memory, of any size: for files, and for the judge.

use super::screen::{Picture, Screen};
use super::targets::{Targets, buffer, free_buffer};
use super::{Failure, ViewError};
use ash::vk;
use gpu_allocator::MemoryLocation;
use selvedge::{ash, gpu_allocator};

/// The engine's images; row 0 on top.
#[derive(Clone, Debug, Default)]
pub struct Photograph {
    pub size: (u32, u32),
    /// sRGB, and opacity.
    pub colour: Vec<[u8; 4]>,
    /// As [`selvedge::picture::Picture`] has them.
    pub depth: Vec<f32>,
    pub face: Vec<u32>,
    pub normal: Vec<[f32; 3]>,
}

/// A frame is recorded again where a buffer was too small; the buffer then has room.
const MOST_TRIES: usize = 8;

impl Screen {
    /// Draws a picture and waits for it; no frame is in flight.
    pub fn photograph(&self, picture: &mut Picture<'_>) -> Result<Photograph, Failure> {
        let size = picture.camera.size;
        let targets = Targets::new(&self.context, size)?;
        let pixels = u64::from(size.0) * u64::from(size.1);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let made = buffer(&self.context, "photograph", pixels * BYTES, usage, MemoryLocation::GpuToCpu);
        let memory = match made {
            Ok(memory) => memory,
            Err(error) => {
                targets.destroy(&self.context);
                return Err(error.into());
            }
        };
        let drawn = self.drawn(picture, &targets, memory.0);
        let photograph = drawn.map(|()| read(memory.1.mapped_slice().unwrap_or_default(), size));
        targets.destroy(&self.context);
        free_buffer(&self.context, memory);
        photograph
    }

    fn drawn(&self, picture: &mut Picture<'_>, targets: &Targets, to: vk::Buffer) -> Result<(), Failure> {
        let mut tries = 0;
        while tries < MOST_TRIES {
            self.begin()?;
            let again =
                Picture { renderer: &mut *picture.renderer, camera: picture.camera, settings: picture.settings };
            self.record_into(again, targets).map_err(|error| Failure::Picture(error.into()))?;
            targets.copy_all(&self.context, to, IMAGES);
            self.submit_and_wait()?;
            let report = picture.renderer.report(0).map_err(ViewError::from)?;
            if report.as_ref().is_some_and(|report| report.complete) {
                return Ok(());
            }
            // a frame that copied a part of the scene tried nothing
            tries += usize::from(report.is_none_or(|report| report.waiting.is_none()));
        }
        Err(ViewError::Memory("a picture of this size never had enough room".to_owned()).into())
    }
}

/// Colour, depth, face, normal: their numbers among the targets, and bytes of a pixel.
const IMAGES: [(usize, u64); 4] = [(0, 4), (1, 4), (2, 4), (4, 16)];
const BYTES: u64 = 4 + 4 + 4 + 16;

fn read(bytes: &[u8], size: (u32, u32)) -> Photograph {
    let pixels = size.0 as usize * size.1 as usize;
    let (colour, rest) = bytes.split_at(4 * pixels);
    let (depth, rest) = rest.split_at(4 * pixels);
    let (face, normal) = rest.split_at(4 * pixels);
    let words =
        |bytes: &[u8]| bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word)).collect::<Vec<_>>();
    let floats = |bytes: &[u8]| words(bytes).into_iter().map(f32::from_bits).collect::<Vec<_>>();
    Photograph {
        size,
        colour: colour.as_chunks::<4>().0.to_vec(),
        depth: floats(depth),
        face: words(face),
        normal: floats(&normal[..16 * pixels]).chunks_exact(4).map(|n| [n[0], n[1], n[2]]).collect(),
    }
}
