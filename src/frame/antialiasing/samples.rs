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

use super::average;
use crate::abi::Counters;
use crate::frame::Frame;
use crate::frame::common::room::{DRAWN_AND_READ, Room};
use crate::frame::shading::{self, resolve};
use crate::frame::transparency::Drawing;
use crate::gpu::{
    Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, TexelBuffer, Timestamps, barrier,
};
use crate::picture::Samples;
use crate::scene::SceneData;
use std::mem::offset_of;
use std::sync::Arc;

/// The passes of scenes whose pixels have several samples.
pub(crate) struct Passes {
    resolve: resolve::Resolve,
    average: average::Average,
}

impl Passes {
    /// `None` when pixels have one sample.
    pub(crate) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Option<Self>, GpuError> {
        if data.samples == Samples::One {
            return Ok(None);
        }
        let sums = resolve::Formats { colour: average::SUM_FORMAT, aovs: [false; 4], ..formats };
        let into = match data.is_layered {
            true => resolve::Destination::Behind { writes_depth: false },
            false => resolve::Destination::Sum,
        };
        let resolve = resolve::Resolve::new(device, into, sums, shading::kinds(data))?;
        Ok(Some(Self { resolve, average: average::Average::new(device, formats.colour)? }))
    }
}

/// The stage.
pub(crate) struct MoreSamples {
    passes: Arc<Passes>,
    /// The sum of the samples' colours.
    sum: Image,
}

/// A view besides the pixels' centres, written by the host.
pub(crate) struct ViewBuffers {
    pub constants: Buffer,
    pub views: TexelBuffer,
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

impl MoreSamples {
    pub(crate) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let sum = room.image("sum of samples", average::SUM_FORMAT, DRAWN_AND_READ)?;
        Ok(Self { passes: Arc::clone(passes), sum })
    }

    /// Every sample, their mean, and what the centres see, if something is made of it.
    pub(crate) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, times: &mut Timestamps) {
        let Self { passes, sum } = self;
        barrier::images(cmd, &[(sum, Access::FRAGMENT_READ.discarded(), Access::COLOUR_WRITE)]);
        let into = |load| [Attachment { image: sum, load }];
        let (cleared, added) = (into(Load::ColourF32([0.0; 4])), into(Load::Keep));
        let by = (Some(&passes.resolve), Drawing::Sample);
        let mut samples = frame.samples.iter();
        if let Some(ViewBuffers { constants, views }) = samples.next() {
            let first = Frame { constants, views, colour: &cleared, ..*frame };
            draw(&first, cmd, &mut Scopes::of(times), by, 0);
        }
        times.scope(cmd, "more samples", || {
            for (nth, ViewBuffers { constants, views }) in (1..).zip(samples) {
                let sample = Frame { constants, views, colour: &added, ..*frame };
                begin_again(&sample, cmd, sum);
                draw(&sample, cmd, &mut Scopes(None), by, nth);
            }
        });
        barrier::images(cmd, &[(sum, Access::COLOUR_WRITE, Access::FRAGMENT_READ)]);
        let keep = matches!(frame.colour[0].load, Load::Keep);
        let load = if keep { Load::Keep } else { Load::ColourF32([0.0; 4]) };
        let colour = Attachment { load, ..frame.colour[0] };
        times.scope(cmd, "average", || {
            passes.average.record(cmd, &average::Bindings { frame: frame.constants, sum }, colour);
        });
        if let Some(resolve) = frame.stages.shading.resolve().filter(|_| frame.draws_centres) {
            // the colour is there already
            let mut colour = frame.colour.to_vec();
            colour[0].load = Load::Keep;
            let centre = Frame { colour: &colour, ..*frame };
            times.scope(cmd, "centre sample", || {
                begin_again(&centre, cmd, frame.colour[0].image);
                let nth = frame.samples.len() as u64;
                draw(&centre, cmd, &mut Scopes(None), (Some(resolve), Drawing::Beside), nth);
            });
        }
    }
}

/// What is seen, from the patches and the trim table, and resolved.
fn draw(
    frame: &Frame<'_>,
    cmd: &Commands<'_>,
    times: &mut Scopes<'_>,
    by: (Option<&resolve::Resolve>, Drawing),
    nth: u64,
) {
    frame.visibility(cmd, times);
    frame.shade(cmd, times, by, nth);
}

/// Before the view is drawn once more, into `colour` again: what one drawing counts is cleared, what the patches
/// and the trim table are stays. So do the lengths of the longest lists of bands, by which capacities grow: the list of
/// any drawing may be the longest one.
fn begin_again(frame: &Frame<'_>, cmd: &Commands<'_>, colour: &Image) {
    let counters = &frame.stages.common.counters;
    frame.wait(cmd);
    let counted = [
        offset_of!(Counters, gap_candidates),
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
    let cleared = Access::TRANSFER_WRITE;
    barrier::buffers(cmd, &[(counters, cleared, Access::COMPUTE_WRITE | Access::INDIRECT_READ)]);
    let again = [(colour, Access::COLOUR_WRITE, Access::COLOUR_WRITE)];
    let hidden = frame.depth.map(|depth| (depth.image, Access::DEPTH_WRITE, Access::DEPTH_WRITE));
    barrier::images(cmd, &again.into_iter().chain(hidden).collect::<Vec<_>>());
}
