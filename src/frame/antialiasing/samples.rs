//! The frame's part for pixels of several samples.
//!
//! ```text
//!   patches, trim table: once, for the pixels' centres
//!            │
//!            ▼           a quarter of a pixel to the right, ...
//!   mesh ─▶ … ─▶ resolve ──added──▶ sum      once a sample, each with a view of its own
//!                                    ▼
//!                                 average ──▶ the host's colour
//!   mesh ─▶ … ─▶ resolve ──▶ the host's depth, depth, face, (u, v), normal      where asked for: the centre's
//! ```
//!
//! Samples lie less than half a pixel beside the centre. That changes no depth, so tessellation and trim table are
//! fine enough for all of them: only the stretch towards the picture's corners changes, by half a pixel's slope, less
//! than a thousandth. Boxes are looked for a pixel beyond the picture, of which borders take half, and `spread_px`
//! around centres.

use crate::abi::Counters;
use crate::frame::antialiasing::average;
use crate::frame::shading::resolve;
use crate::frame::{Drawing, Frame, shading};
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, Texels, Timestamps, barrier};
use crate::picture::Samples;
use crate::scene::SceneData;
use std::mem::offset_of;

/// The passes of scenes whose pixels have several samples.
pub(crate) struct SamplePasses {
    resolve: resolve::Resolve,
    average: average::Average,
}

impl SamplePasses {
    /// `None` when pixels have one sample.
    pub(crate) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Option<Self>, GpuError> {
        if data.samples == Samples::One {
            return Ok(None);
        }
        let sums = resolve::Formats { colour: average::SUM_FORMAT, aovs: false, ..formats };
        let into = match data.is_layered {
            true => resolve::Destination::Behind { writes_depth: false },
            false => resolve::Destination::Sum,
        };
        let resolve = resolve::Resolve::new(device, into, sums, shading::kinds(data))?;
        Ok(Some(Self { resolve, average: average::Average::new(device, formats.colour)? }))
    }
}

/// A view besides the pixels' centres, written by the host.
pub(crate) struct ViewBuffers {
    pub constants: Buffer,
    pub views: Texels,
}

/// Timed scopes, or none: each sample costs what the first one does.
pub(crate) struct Scopes<'t>(Option<&'t mut Timestamps>);

impl<'t> Scopes<'t> {
    pub(crate) fn of(times: &'t mut Timestamps) -> Self {
        Self(Some(times))
    }

    pub(crate) fn scope(&mut self, cmd: &Commands<'_>, name: &str, record: impl FnOnce()) {
        match &mut self.0 {
            Some(times) => times.scope(cmd, name, record),
            None => record(),
        }
    }

    pub(crate) fn drawing(&mut self, cmd: &Commands<'_>, name: &str, record: impl FnOnce()) {
        match &mut self.0 {
            Some(times) => times.drawing(cmd, name, record),
            None => record(),
        }
    }
}

impl Frame<'_> {
    /// Every sample, their mean, and what the centres see.
    pub(crate) fn record_samples(&self, cmd: &Commands<'_>, times: &mut Timestamps, passes: &SamplePasses) {
        let Some(sum) = &self.buffers.sum else { unreachable!("made with the passes") };
        let Some((first, others)) = self.samples.split_first() else { unreachable!("written by the host") };
        let keep = matches!(self.colour[0].load, Load::Keep);
        barrier::images(cmd, &[(sum, Access::FRAGMENT_READ.discarded(), Access::COLOUR_WRITE)]);
        let into = |load| [Attachment { image: sum, load }];
        let cleared = into(Load::ColourF32([0.0; 4]));
        let (constants, views) = (&first.constants, &first.views);
        let sample = Frame { constants, views, colour: &cleared, ..*self };
        sample.draw(cmd, &mut Scopes::of(times), (Some(&passes.resolve), Drawing::Sample), 0);
        let added = into(Load::Keep);
        times.scope(cmd, "more samples", || {
            for (nth, ViewBuffers { constants, views }) in (1..).zip(others) {
                let sample = Frame { constants, views, colour: &added, ..*self };
                sample.begin_again(cmd, sum);
                sample.draw(cmd, &mut Scopes(None), (Some(&passes.resolve), Drawing::Sample), nth);
            }
        });
        barrier::images(cmd, &[(sum, Access::COLOUR_WRITE, Access::FRAGMENT_READ)]);
        let load = if keep { Load::Keep } else { Load::ColourF32([0.0; 4]) };
        let colour = Attachment { load, ..self.colour[0] };
        times.scope(cmd, "average", || {
            passes.average.record(cmd, &average::Bindings { frame: self.constants, sum }, colour);
        });
        if let Some(resolve) = &self.passes.resolve {
            // the colour is there already
            let mut colour = self.colour.to_vec();
            colour[0].load = Load::Keep;
            let centre = Frame { colour: &colour, ..*self };
            times.scope(cmd, "centre sample", || {
                centre.begin_again(cmd, self.colour[0].image);
                centre.draw(cmd, &mut Scopes(None), (Some(resolve), Drawing::Beside), self.samples.len() as u64);
            });
        }
    }

    /// What is seen, from the patches and the trim table, and resolved.
    fn draw(
        &self,
        cmd: &Commands<'_>,
        times: &mut Scopes<'_>,
        (resolve, drawing): (Option<&resolve::Resolve>, Drawing),
        nth: u64,
    ) {
        self.see(cmd, times);
        self.show(cmd, times, (resolve, drawing), nth);
    }

    /// Before the view is drawn once more, into `colour` again: what one drawing counts is cleared, what the patches
    /// and the trim table are stays.
    fn begin_again(&self, cmd: &Commands<'_>, colour: &Image) {
        let counters = &self.buffers.counters;
        self.wait(cmd);
        let counted = [
            offset_of!(Counters, doubts),
            offset_of!(Counters, contacts),
            offset_of!(Counters, overlaps),
            offset_of!(Counters, tile_leaves),
            offset_of!(Counters, fragments),
            offset_of!(Counters, mended),
            offset_of!(Counters, unpaired),
        ];
        for at in counted {
            cmd.fill_word(counters, (at / size_of::<u32>()) as u64, 0);
        }
        let cleared = Access { layout: Access::COMPUTE_WRITE.layout, ..Access::TRANSFER_WRITE };
        barrier::buffers(cmd, &[(counters, cleared, Access::COMPUTE_WRITE | Access::INDIRECT_READ)]);
        let again = [(colour, Access::COLOUR_WRITE, Access::COLOUR_WRITE)];
        let hidden = self.depth.map(|depth| (depth.image, Access::DEPTH_WRITE, Access::DEPTH_WRITE));
        barrier::images(cmd, &again.into_iter().chain(hidden).collect::<Vec<_>>());
    }
}
