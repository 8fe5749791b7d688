//! Arrays: copies of one entity at places that follow from a few numbers.
//!
//! ```text
//!   412  base, S, corner, columns, rows, dx, dy, angle, n, skip, list     column by column, each from below
//!   414  base, N, centre, R, first angle, step, n, skip, list             counter-clockwise about z
//! ```
//!
//! The grid is turned by its angle, and a circle's places go around it; the copies keep the orientation of the base and
//! are scaled by S about its origin. The list names the places, counted from 1, that are drawn, or with `skip` 1 those
//! that are not; where it is empty all are.
//!
//! Source: US Product Data Association, *IGES 5.3*, 1996.

use super::entity::{Entity, Fault};
use glam::{DAffine3, DVec2, DVec3};

/// Places of a 412 or a 414, in the space and the unit of its own definition.
pub(super) fn places(entity: Entity<'_>, most: usize) -> Result<Vec<DAffine3>, Fault> {
    let (scale, all, list) = if entity.kind() == 412 {
        let scale = if entity.real(2)? == 0.0 { 1.0 } else { entity.real(2)? };
        let (columns, rows) = (number(entity, 6, most)?, number(entity, 7, most)?);
        let (corner, step) = (entity.triple(3)?, DVec2::new(entity.real(8)?, entity.real(9)?));
        let turn = DVec2::from_angle(entity.real(10)?);
        let at = |i: usize| {
            let cell = DVec2::new((i / rows) as f64, (i % rows) as f64);
            corner + turn.rotate(cell * step).extend(0.0)
        };
        let count = columns.checked_mul(rows).filter(|n| *n <= most);
        let count = count.ok_or(Fault::Value { id: entity.id(), what: "the array has too many places" })?;
        (scale, (0..count).map(at).collect::<Vec<DVec3>>(), 11)
    } else {
        let (centre, radius) = (entity.triple(3)?, entity.real(6)?);
        let (first, step) = (entity.real(7)?, entity.real(8)?);
        let at = |i: usize| centre + (DVec2::from_angle(first + step * i as f64) * radius).extend(0.0);
        (1.0, (0..number(entity, 2, most)?).map(at).collect(), 9)
    };
    let count = entity.count(list, 1)?;
    let skip = entity.integer(list + 1)? == 1;
    let mut named = vec![false; all.len()];
    for index in list + 2..list + 2 + count {
        let place = usize::try_from(entity.integer(index)?).ok().and_then(|n| n.checked_sub(1));
        let what = "the array has no place of that number";
        *place.and_then(|n| named.get_mut(n)).ok_or(Fault::Value { id: entity.id(), what })? = true;
    }
    let kept = all.into_iter().zip(named).filter(|(_, named)| count == 0 || *named != skip);
    let scale = DAffine3::from_scale(DVec3::splat(scale));
    Ok(kept.map(|(at, _)| DAffine3::from_translation(at) * scale).collect())
}

/// A number of places.
fn number(entity: Entity<'_>, index: usize, most: usize) -> Result<usize, Fault> {
    let found = usize::try_from(entity.integer(index)?).ok().filter(|n| (1..=most).contains(n));
    found.ok_or(Fault::Value { id: entity.id(), what: "the array has no places, or too many" })
}
