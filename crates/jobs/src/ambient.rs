//! Settings of ambient occlusion: a radius, a share of the model's diagonal, or none.

use selvedge::model::Model;
use selvedge::picture::Samples;
use std::str::FromStr;

/// The radius of [`Ambient::Auto`] as a share of the model's diagonal.
const SHARE: f64 = 0.04;

/// The radius within which surfaces hide the sky from each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ambient {
    /// No ambient occlusion.
    None,
    /// A twenty-fifth of the model's diagonal.
    Auto,
    /// A radius in units of the model.
    Radius(f64),
}

impl Ambient {
    /// [`SceneSettings::ambient`](selvedge::picture::SceneSettings::ambient) of a model. If `said` is `None`, it is
    /// [`Auto`](Self::Auto) with one sample and none with several. A model without a size has none.
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
    use selvedge::glam::{DAffine3, DVec3};
    use selvedge::model::{Instance, Mesh, Part};

    #[test]
    fn a_radius_is_a_length() {
        assert_eq!("none".parse(), Ok(Ambient::None));
        assert_eq!("auto".parse(), Ok(Ambient::Auto));
        assert_eq!("2.5".parse(), Ok(Ambient::Radius(2.5)));
        for bad in ["", "0", "-1", "nan", "inf", "some"] {
            assert!(bad.parse::<Ambient>().unwrap_err().contains("no radius"), "{bad}");
        }
    }

    /// The diagonal of a triangle is that of its box, 6 x 6 x 8.
    #[test]
    fn what_is_said_counts() {
        let corners = vec![DVec3::ZERO, DVec3::X * 6.0, DVec3::new(6.0, 6.0, 8.0)];
        let part = Part { meshes: vec![Mesh::new(1, corners, vec![[0, 1, 2]], vec![]).unwrap()], ..Part::default() };
        let placed = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        let model = Model { parts: vec![part], instances: vec![placed], ..Model::default() };
        assert_eq!(Ambient::radius(Some(Ambient::Radius(2.0)), Samples::Four, &model), Some(2.0));
        assert_eq!(Ambient::radius(None, Samples::Four, &model), None);
        let radius = Ambient::radius(None, Samples::One, &model).unwrap();
        assert!((radius - 136f64.sqrt() / 25.0).abs() < 1e-12, "{radius}");
        assert_eq!(Ambient::radius(None, Samples::One, &Model::default()), None, "nothing has no diagonal");
    }
}
