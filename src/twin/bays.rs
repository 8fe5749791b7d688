//! Twin of `glsl/include/bays.glsl`: a strip of a face with many trim curves is cut into equal bays along `u`, and a scan
//! line then has a row in each of them.

use crate::abi::StripRows;

/// The bay of `u`, never less for a larger `u`; what is beyond the face belongs to its outermost bays.
pub fn bay_of(u: f32, bays: u32) -> u32 {
    let at = u * bays as f32;
    if at >= 1.0 { at.min((bays - 1) as f32) as u32 } else { 0 }
}

/// `u` as it is in a bay, 0 to 1 within it.
pub fn within_bay(u: f32, bay: u32, bays: u32) -> f32 {
    u * bays as f32 - bay as f32
}

/// The first bay that is seen, and how many from there to the last; `seen` has a bit for each that is.
pub fn seen_range(seen: u32) -> (u32, u32) {
    if seen == 0 {
        return (0, 1);
    }
    (seen.trailing_zeros(), 32 - seen.leading_zeros() - seen.trailing_zeros())
}

impl StripRows {
    /// The last bay that is seen.
    pub fn last_bay(&self) -> u32 {
        self.first_bay + self.bays - 1
    }

    /// The row of a scan line in a bay; in the nearest one where it has none in that.
    pub fn row_of(&self, line: u32, bay: u32) -> u32 {
        self.first + (bay.clamp(self.first_bay, self.last_bay()) - self.first_bay) * self.lines + line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bays_share_the_face_out_in_order() {
        for bays in [1, 2, 7, 32] {
            let of: Vec<u32> = (-50..=1050).map(|k| bay_of(k as f32 / 1000.0, bays)).collect();
            assert!(of.is_sorted() && of[0] == 0 && of[of.len() - 1] == bays - 1);
            let of_bay = |bay| of[50..1050].iter().filter(|&&b| b == bay).count().abs_diff(1000 / bays as usize);
            assert!((0..bays).all(|bay| of_bay(bay) <= 1), "{bays}");
        }
        assert_eq!([f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(|u| bay_of(u, 7)), [0, 6, 0]);
    }

    #[test]
    fn a_range_is_from_the_first_seen_to_the_last() {
        let ranges = [0, 1, 0b1010_0000, 1 << 31, u32::MAX].map(seen_range);
        assert_eq!(ranges, [(0, 1), (0, 1), (5, 3), (31, 1), (0, 32)]);
    }
}
