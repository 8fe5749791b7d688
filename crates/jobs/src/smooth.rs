//! Which borders are smooth by default.

use selvedge::picture::{Samples, Smooth};

/// The setting `said`. By default it is the borders of all faces with one sample; several samples smooth borders
/// already.
pub fn smooth(said: Option<Smooth>, samples: Samples) -> Smooth {
    said.unwrap_or(if samples == Samples::One { Smooth::Borders } else { Smooth::None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_counts() {
        assert_eq!(smooth(None, Samples::One), Smooth::Borders);
        assert_eq!(smooth(None, Samples::Eight), Smooth::None);
        assert_eq!(smooth(Some(Smooth::Trims), Samples::Eight), Smooth::Trims);
    }
}
