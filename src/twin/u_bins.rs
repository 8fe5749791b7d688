//! Twin of `glsl/include/u_bins.glsl`: a strip of a face with many trim curves is cut into equal bins along `u`, and a scan
//! line then has a row in each of them.

use crate::abi::StripRows;

/// The bin of `u`, monotone in `u`; `u` beyond the face belongs to its outermost bins.
pub fn bin_of(u: f32, bins: u32) -> u32 {
    let at = u * bins as f32;
    if at >= 1.0 { at.min((bins - 1) as f32) as u32 } else { 0 }
}

/// `u` relative to a bin, 0 to 1 within it.
pub fn within_bin(u: f32, bin: u32, bins: u32) -> f32 {
    u * bins as f32 - bin as f32
}

/// The first visible bin, and the number from there to the last; `seen` has a bit for each visible bin.
pub fn seen_range(seen: u32) -> (u32, u32) {
    if seen == 0 {
        return (0, 1);
    }
    (seen.trailing_zeros(), 32 - seen.leading_zeros() - seen.trailing_zeros())
}

impl StripRows {
    /// The last visible bin.
    pub fn last_bin(&self) -> u32 {
        self.first_bin + self.bins - 1
    }

    /// The row of a scan line in a bin; if it has none there, in the nearest bin that has one.
    pub fn row_of(&self, line: u32, bin: u32) -> u32 {
        self.first + (bin.clamp(self.first_bin, self.last_bin()) - self.first_bin) * self.lines + line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_share_the_face_out_in_order() {
        for bins in [1, 2, 7, 32] {
            let of: Vec<u32> = (-50..=1050).map(|k| bin_of(k as f32 / 1000.0, bins)).collect();
            assert!(of.is_sorted() && of[0] == 0 && of[of.len() - 1] == bins - 1);
            let of_bin = |bin| of[50..1050].iter().filter(|&&b| b == bin).count().abs_diff(1000 / bins as usize);
            assert!((0..bins).all(|bin| of_bin(bin) <= 1), "{bins}");
        }
        assert_eq!([f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(|u| bin_of(u, 7)), [0, 6, 0]);
    }

    #[test]
    fn a_range_is_from_the_first_seen_to_the_last() {
        let ranges = [0, 1, 0b1010_0000, 1 << 31, u32::MAX].map(seen_range);
        assert_eq!(ranges, [(0, 1), (0, 1), (5, 3), (31, 1), (0, 32)]);
    }
}
