//! How many points at borders there is room for to follow exact surfaces.

use crate::abi::{Counters, FollowedPixel, FollowedPoint};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, SMALLER, TooMany};

/// As many pixels as one point that is followed: of the points beside outlines of small balls, one in sixty is.
const PIXELS_OF_A_POINT: u64 = 16;
/// Points over the picture's diagonal in pixels, at least: borders are long, not wide. Two parts in full view at 820 x 756
/// have the most: zoo_gear.step 37, nist_pmi_2.stp 36.
const OF_DIAGONAL: f64 = 64.0;
/// Bytes of a point, and of a pixel that waits for its points: each list has as many.
const BYTES: usize = size_of::<FollowedPoint>();
const _: () = assert!(size_of::<FollowedPixel>() <= BYTES);

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    /// Points in the list of one band.
    pub followed: u32,
}

impl Capacities {
    /// A first guess that fits small pictures.
    pub(crate) fn first(counts: Counts) -> Self {
        Self { followed: u32::from(counts.follows_borders) * (1 << 15) }
    }

    /// At least one point for every [`PIXELS_OF_A_POINT`] pixels of a picture, and [`OF_DIAGONAL`] for every pixel of its
    /// diagonal, as far as a storage buffer of `range` bytes holds them.
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), range: u32) -> Self {
        let some = u64::from(size.0) * u64::from(size.1) / PIXELS_OF_A_POINT;
        let some = some.max((OF_DIAGONAL * f64::from(size.0).hypot(size.1.into())) as u64);
        let most = range / BYTES as u32;
        let some = if counts.follows_borders { some.min(most.into()) as u32 } else { 0 };
        Self { followed: self.followed.max(some).min(most) }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let wanted = ("points at borders of curved faces", c.followed_points);
        TooMany::of_bytes(wanted, BYTES, range, SMALLER).map_or(Ok(()), Err)?;
        Ok(Self { followed: grown(self.followed, c.followed_points, range / BYTES as u32) })
    }
}
