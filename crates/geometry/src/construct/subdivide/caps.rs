//! The levels around an irregular vertex, and how many of them its caps need: the same for both schemes.

use super::super::ConstructError;
use super::Bound;
use super::limit::Limit;
use glam::DVec3;

/// Most rings around a vertex. A ring takes a cap's deviation by 0.61 at a vertex of 8 (by 1/2 at one of 4, by 0.65 at
/// those of many): 32 of them reach some `1e-7` of the size.
const MOST_RINGS: usize = 32;
/// Levels after a cap's own that it is compared with.
const JUDGED_LEVELS: usize = 40;

/// The neighbourhood of a vertex at one level of a scheme: sectors between rays.
pub(super) trait Level: Sized {
    /// Bézier points of a patch.
    type Patch;

    /// The next level.
    fn refined(&self) -> Self;

    /// The patch of a sector next to the vertex, exact except at the vertex.
    fn cap(&self, sector: usize, limit: &Limit) -> Self::Patch;

    /// Largest distance of a cap from the surface, from the levels after its own.
    fn deviation(cap: &Self::Patch, sector: usize, finer: &[Self], limit: DVec3) -> f64;
}

/// Of so many sectors, the levels from the first one to that of the caps, and each sector's cap: as many rings as the
/// caps need to be within the tolerance.
///
/// # Errors
/// [`ConstructError::Bound`] where the most rings are too few.
pub(super) fn capped<L: Level>(
    first: L,
    sectors: usize,
    limit: &Limit,
    tolerance: f64,
    bound: &mut Bound,
) -> Result<(Vec<L>, Vec<L::Patch>), ConstructError> {
    let mut levels = vec![first];
    let mut rings = 1;
    loop {
        while levels.len() <= rings + JUDGED_LEVELS {
            levels.push(levels[levels.len() - 1].refined());
        }
        let caps: Vec<L::Patch> = (0..sectors).map(|i| levels[rings].cap(i, limit)).collect();
        let off = caps.iter().enumerate().map(|(i, c)| L::deviation(c, i, &levels[rings + 1..], limit.point));
        let off = off.fold(0.0, f64::max);
        if off <= tolerance {
            bound.add(off, rings);
            levels.truncate(rings + 1);
            return Ok((levels, caps));
        }
        if rings == MOST_RINGS {
            return Err(ConstructError::Bound { asked: tolerance, reached: off, pieces: rings });
        }
        rings += 1;
    }
}

/// The sector before or after sector `i`, if they meet: the first one is after the last one where they are closed.
pub(super) fn beside<T>(sectors: &[T], closed: bool, i: usize, after: bool) -> Option<&T> {
    let n = sectors.len();
    match after {
        true if i + 1 < n => Some(&sectors[i + 1]),
        false if i > 0 => Some(&sectors[i - 1]),
        true if closed => Some(&sectors[0]),
        false if closed => Some(&sectors[n - 1]),
        _ => None,
    }
}
