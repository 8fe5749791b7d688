//! The standard views, by name.

use glam::DVec3;

/// A direction to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum StandardView {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    Iso,
}

impl StandardView {
    /// All of them, as menus list them.
    pub const ALL: [Self; 7] = [Self::Front, Self::Back, Self::Left, Self::Right, Self::Top, Self::Bottom, Self::Iso];

    /// As menus name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "Front",
            Self::Back => "Back",
            Self::Left => "Left",
            Self::Right => "Right",
            Self::Top => "Top",
            Self::Bottom => "Bottom",
            Self::Iso => "Iso",
        }
    }

    /// From the model towards the eye, not normalised; front looks along +y.
    pub fn from(self) -> DVec3 {
        match self {
            Self::Front => DVec3::NEG_Y,
            Self::Back => DVec3::Y,
            Self::Left => DVec3::NEG_X,
            Self::Right => DVec3::X,
            Self::Top => DVec3::Z,
            Self::Bottom => DVec3::NEG_Z,
            Self::Iso => DVec3::new(1.0, -1.0, 1.0),
        }
    }

    /// Up in the picture.
    pub fn up(self) -> DVec3 {
        up_from(self.from())
    }
}

/// Up in the picture of a view from a direction: z, and where that is along the view, y from above and -y from below.
pub fn up_from(from: DVec3) -> DVec3 {
    let across = from.normalize().cross(DVec3::Z).length();
    if across > 1e-6 { DVec3::Z } else { DVec3::Y * from.z.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_is_to_the_right_of_front_and_top_has_the_back_above() {
        for view in StandardView::ALL {
            assert!(view.from().cross(view.up()).length() > 0.5, "{view:?}");
        }
        // seen from the front, x grows to the right
        let (forward, up) = (-StandardView::Front.from(), StandardView::Front.up());
        assert_eq!(forward.cross(up), DVec3::X);
        let (forward, up) = (-StandardView::Top.from(), StandardView::Top.up());
        assert_eq!((forward.cross(up), up), (DVec3::X, DVec3::Y));
        assert_eq!(StandardView::Bottom.up(), DVec3::NEG_Y);
    }
}
