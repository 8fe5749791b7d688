//! Settings of lines along edges.

use crate::model::{Colour, EdgeKind};

/// Lines along the edges of parts and meshes: [`SceneSettings::edges`](super::SceneSettings::edges).
///
/// Widths are for a picture 1080 pixels high, and scale with its height. A point of an edge is drawn if the visible
/// surface is one of the edge's faces or lies behind the point. Images other than the colour do not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeSettings {
    /// The edges along which lines are drawn.
    pub which: EdgeChoice,
    /// Lines along edges across which the surface continues without a visible angle.
    pub tangent: TangentEdges,
    /// Outlines of curved faces and of meshes, where they turn away from the eye.
    pub silhouettes: bool,
    /// Also draw lines behind faces: dashed, in [`hidden_colour`](Self::hidden_colour).
    pub hidden: bool,
    /// Pixels at a height of 1080; from 0 to [`MOST_WIDTH`](Self::MOST_WIDTH).
    pub width: f64,
    /// Width of thin lines, likewise.
    pub thin_width: f64,
    /// Width of the outlines of sections, likewise: where a cut of a closed part or of a Boolean solid meets the rest, or
    /// ends.
    pub section_width: f64,
    /// Linear colour and opacity.
    pub colour: Colour,
    /// Linear colour and opacity of hidden lines.
    pub hidden_colour: Colour,
}

impl Default for EdgeSettings {
    /// All edges, 1.25 pixels wide and nearly black; thin lines along tangent edges, outlines of sections twice as wide; no
    /// hidden lines, no silhouettes.
    fn default() -> Self {
        Self {
            which: EdgeChoice::All,
            tangent: TangentEdges::Thin,
            silhouettes: false,
            hidden: false,
            width: 1.25,
            thin_width: 0.6,
            section_width: 2.5,
            colour: [0.012, 0.013, 0.016, 1.0],
            hidden_colour: [0.012, 0.013, 0.016, 0.35],
        }
    }
}

/// The edges along which lines are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EdgeChoice {
    /// Every edge except seams, where the parameters of a closed surface begin.
    #[default]
    All,
    /// Edges at which faces meet at an angle or end.
    Sharp,
    /// None.
    None,
}

/// Lines along edges across which the surface continues without a visible angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TangentEdges {
    /// Not at all.
    None,
    /// Thinner than others.
    #[default]
    Thin,
    /// Like the others.
    Full,
}

/// The width of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineStyle {
    Full,
    Thin,
    /// The outline of a section.
    Bold,
}

/// Settings out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BadEdges {
    /// A width.
    #[error("the width of edge lines must be from 0 to {most} pixels, not {0}", most = EdgeSettings::MOST_WIDTH)]
    Width(f64),
    /// A colour.
    #[error("the colour of edge lines must be of numbers from 0 to 1, not {0:?}")]
    Colour(Colour),
}

impl EdgeSettings {
    /// Most pixels of a line's width at a height of 1080.
    pub const MOST_WIDTH: f64 = 64.0;
    /// Height of the picture for which widths are stated.
    pub const HEIGHT: f64 = 1080.0;

    /// Checks that the settings can be drawn.
    ///
    /// # Errors
    /// [`BadEdges`].
    pub fn check(&self) -> Result<(), BadEdges> {
        for width in [self.width, self.thin_width, self.section_width] {
            if !(0.0..=Self::MOST_WIDTH).contains(&width) {
                return Err(BadEdges::Width(width));
            }
        }
        let bad = [self.colour, self.hidden_colour].into_iter().find(|c| !c.iter().all(|x| (0.0..=1.0).contains(x)));
        bad.map_or(Ok(()), |colour| Err(BadEdges::Colour(colour)))
    }

    /// The width of sections' outlines beside lines of another width, as much wider as here; at most
    /// [`MOST_WIDTH`](Self::MOST_WIDTH).
    pub fn wider(&self, width: f64) -> f64 {
        (width * self.section_width / self.width).min(Self::MOST_WIDTH)
    }

    /// The line along an edge of this kind, if any.
    pub(crate) fn style(&self, kind: EdgeKind) -> Option<LineStyle> {
        match (self.which, kind, self.tangent) {
            (EdgeChoice::None, _, _) | (_, EdgeKind::Seam, _) => None,
            (_, EdgeKind::Sharp | EdgeKind::Border, _) => Some(LineStyle::Full),
            (EdgeChoice::Sharp, EdgeKind::Smooth, _) | (_, EdgeKind::Smooth, TangentEdges::None) => None,
            (EdgeChoice::All, EdgeKind::Smooth, TangentEdges::Thin) => Some(LineStyle::Thin),
            (EdgeChoice::All, EdgeKind::Smooth, TangentEdges::Full) => Some(LineStyle::Full),
        }
    }
}

impl EdgeChoice {
    /// Every choice.
    pub const ALL: &'static [Self] = &[Self::All, Self::Sharp, Self::None];

    /// The name in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Sharp => "sharp",
            Self::None => "none",
        }
    }
}

impl std::str::FromStr for EdgeChoice {
    type Err = UnknownEdges;

    fn from_str(name: &str) -> Result<Self, UnknownEdges> {
        let found = Self::ALL.iter().copied().find(|choice| choice.name() == name);
        found.ok_or_else(|| UnknownEdges(name.to_owned(), "all, sharp, none"))
    }
}

impl TangentEdges {
    /// Every way.
    pub const ALL: &'static [Self] = &[Self::None, Self::Thin, Self::Full];

    /// The name in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Thin => "thin",
            Self::Full => "full",
        }
    }
}

impl std::str::FromStr for TangentEdges {
    type Err = UnknownEdges;

    fn from_str(name: &str) -> Result<Self, UnknownEdges> {
        let found = Self::ALL.iter().copied().find(|way| way.name() == name);
        found.ok_or_else(|| UnknownEdges(name.to_owned(), "none, thin, full"))
    }
}

/// A name that no choice of edges has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no choice of edges is called `{0}`; there are: {1}")]
pub struct UnknownEdges(String, &'static str);
