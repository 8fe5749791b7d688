//! Standard directions to look from, by name or by angles, and lists of them.
//!
//! ```text
//!              z up                  azimuth    around z from the front: 90 is the right
//!               │  back              elevation  above the ground: 90 is the top
//!               │ ╱
//!     left ─────┼───── right         front looks along +y, right along -x, top along -z
//!             ╱ │
//!         front │                    iso is azimuth 45, elevation atan(1 / √2): all three axes are as long
//! ```

use glam::DVec3;
use std::fmt;
use std::str::FromStr;

/// Where the eye is, as angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    azimuth: f64,
    elevation: f64,
    name: Option<&'static str>,
}

/// Elevation of `iso`: `atan(1 / √2)`, degrees.
const ISO_DEG: f64 = 35.264_389_682_754_654;

const fn named(name: &'static str, azimuth: f64, elevation: f64) -> Direction {
    Direction { azimuth, elevation, name: Some(name) }
}

/// The named directions, as a contact sheet shows them.
pub const NAMED: [Direction; 7] = [
    named("iso", 45.0, ISO_DEG),
    named("front", 0.0, 0.0),
    named("right", 90.0, 0.0),
    named("back", 180.0, 0.0),
    named("left", -90.0, 0.0),
    named("top", 0.0, 90.0),
    named("bottom", 0.0, -90.0),
];

impl Direction {
    /// Unit vector from the model towards the eye.
    pub fn from(self) -> DVec3 {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (turn(self.azimuth), turn(self.elevation));
        DVec3::new(sin_a * cos_e, -cos_a * cos_e, sin_e)
    }

    /// The direction that is up in the picture: z, tilted where the eye rises to the top or sinks to the bottom.
    pub fn up(self) -> DVec3 {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (turn(self.azimuth), turn(self.elevation));
        DVec3::new(-sin_a * sin_e, cos_a * sin_e, cos_e)
    }
}

/// Sine and cosine of degrees, exact at right angles.
fn turn(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => degrees.to_radians().sin_cos(),
    }
}

/// As in the names of files.
impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name {
            Some(name) => f.write_str(name),
            None => write!(f, "{}_{}", self.azimuth, self.elevation),
        }
    }
}

/// Directions in the order in which they are named, none of them twice.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions(pub Vec<Direction>);

impl FromStr for Directions {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut list: Vec<Direction> = Vec::new();
        let mut words = text.split(',').map(str::trim);
        while let Some(word) = words.next() {
            let direction = match NAMED.iter().find(|known| known.name == Some(word)) {
                Some(known) => *known,
                None => angles(word, words.next()).ok_or_else(|| unknown(word))?,
            };
            if list.iter().any(|other| other.to_string() == direction.to_string()) {
                return Err(format!("the view {direction} is named twice"));
            }
            list.push(direction);
        }
        Ok(Self(list))
    }
}

/// An azimuth, any number of degrees, and an elevation from -90 to 90.
fn angles(azimuth: &str, elevation: Option<&str>) -> Option<Direction> {
    let azimuth = azimuth.parse::<f64>().ok().filter(|a| a.is_finite())?;
    let elevation = elevation?.parse::<f64>().ok().filter(|e| (-90.0..=90.0).contains(e))?;
    Some(Direction { azimuth, elevation, name: None })
}

fn unknown(word: &str) -> String {
    let names: Vec<_> = NAMED.iter().filter_map(|known| known.name).collect();
    format!("no view is called `{word}`; wants {} or AZIMUTH,ELEVATION, the elevation from -90 to 90", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    fn of(text: &str) -> Vec<Direction> {
        text.parse::<Directions>().expect("directions").0
    }

    #[test]
    fn names_and_angles_say_the_same() {
        for (name, angles, from, up) in [
            ("front", "0,0", DVec3::NEG_Y, DVec3::Z),
            ("right", "90,0", DVec3::X, DVec3::Z),
            ("back", "180,0", DVec3::Y, DVec3::Z),
            ("left", "-90,0", DVec3::NEG_X, DVec3::Z),
            ("top", "0,90", DVec3::Z, DVec3::Y),
            ("bottom", "0,-90", DVec3::NEG_Z, DVec3::NEG_Y),
        ] {
            for text in [name, angles] {
                assert_eq!((of(text)[0].from(), of(text)[0].up()), (from, up), "{text}");
            }
        }
        let iso = of("iso")[0].from();
        assert!((iso - DVec3::new(1.0, -1.0, 1.0).normalize()).length() < 1e-15);
    }

    #[test]
    fn the_picture_is_upright_from_everywhere() {
        for text in ["iso", "30,20", "-200,-75", "123.4,89.9"] {
            let direction = of(text)[0];
            let axes = DMat3::from_cols(direction.up().cross(direction.from()), direction.up(), direction.from());
            assert!((axes.determinant() - 1.0).abs() < 1e-12 && direction.up().z >= 0.0, "{text}");
        }
    }

    #[test]
    fn a_list_is_in_the_order_of_its_names() {
        let list: Vec<_> = of("iso, 30,20,-45,-10,back").iter().map(ToString::to_string).collect();
        assert_eq!(list, ["iso", "30_20", "-45_-10", "back"]);
    }

    #[test]
    fn what_is_no_view_is_refused() {
        for bad in ["", "side", "30", "30,91", "nan,0", "iso,iso", "30,20,30,20", "iso,,top"] {
            assert!(bad.parse::<Directions>().is_err(), "{bad}");
        }
    }
}
