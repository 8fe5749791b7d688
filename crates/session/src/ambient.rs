//! Ambient occlusion as people ask for it: by a radius, by a share of the model, or not at all.

use selvedge::model::Model;
use selvedge::picture::Samples;
use std::str::FromStr;

/// Share of the model's diagonal that is the radius where nobody says another.
const SHARE: f64 = 0.04;

/// How much of what lies close hides the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ambient {
    /// None is drawn.
    None,
    /// What lies within a twenty-fifth of the model's diagonal.
    Auto,
    /// What lies within a radius in units of the model.
    Radius(f64),
}

impl Ambient {
    /// [`SceneSettings::ambient`](selvedge::picture::SceneSettings::ambient) of a model: as it is said; else
    /// [`Auto`](Self::Auto), but that it does not go with several samples.
    pub fn radius(said: Option<Self>, samples: Samples, model: &Model) -> Option<f64> {
        let usual = if samples == Samples::One { Self::Auto } else { Self::None };
        match said.unwrap_or(usual) {
            Self::None => None,
            Self::Auto => {
                Some(SHARE * model.control_bounds().diagonal()).filter(|radius| radius.is_finite() && *radius > 0.0)
            }
            Self::Radius(radius) => Some(radius),
        }
    }
}

impl FromStr for Ambient {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => Ok(Self::None),
            "auto" => Ok(Self::Auto),
            _ => text
                .parse()
                .ok()
                .filter(|radius: &f64| radius.is_finite() && *radius > 0.0)
                .map(Self::Radius)
                .ok_or_else(|| format!("`{text}` is no radius above 0, and neither auto nor none")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_is_a_length() {
        assert_eq!("none".parse(), Ok(Ambient::None));
        assert_eq!("auto".parse(), Ok(Ambient::Auto));
        assert_eq!("2.5".parse(), Ok(Ambient::Radius(2.5)));
        for bad in ["", "0", "-1", "nan", "inf", "some"] {
            assert!(bad.parse::<Ambient>().unwrap_err().contains("no radius"), "{bad}");
        }
    }

    #[test]
    fn what_is_said_counts() {
        let model = Model::default();
        assert_eq!(Ambient::radius(Some(Ambient::Radius(2.0)), Samples::Four, &model), Some(2.0));
        assert_eq!(Ambient::radius(None, Samples::Four, &model), None);
        assert_eq!(Ambient::radius(None, Samples::One, &model), None, "a model without a size has no share of it");
    }
}
