//! Lines along edges: `--edges` and its companions.

use anyhow::Result;
use clap::Args;
use selvedge::model::Colour;
use selvedge::picture::{EdgeChoice, EdgeSettings, Style, TangentEdges};
use selvedge_jobs::colour;

/// Which lines are drawn, and how.
#[derive(Debug, Args)]
pub struct LineArgs {
    /// Draw lines along edges: all, sharp (where faces meet at an angle or end) or none. The default is none, and sharp with
    /// silhouettes where --style technical is said
    #[arg(long, value_name = "all|sharp|none")]
    pub edges: Option<EdgeChoice>,
    /// Draw the outlines of curved faces, where they fold away from the eye
    #[arg(long)]
    pub silhouettes: bool,
    /// Draw lines that lie behind faces, too: dashed and lighter
    #[arg(long, requires = "edges")]
    pub hidden_lines: bool,
    /// How to draw edges at which the surface goes on without a visible angle: none, thin or full
    #[arg(long, value_name = "none|thin|full", default_value = "thin", requires = "edges")]
    pub tangent_edges: TangentEdges,
    /// Colour of lines, a CSS colour
    #[arg(long, value_name = "COLOUR", value_parser = colour)]
    pub edge_colour: Option<Colour>,
    /// Width of lines in pixels of a picture 1080 pixels high; it grows and shrinks with the height
    #[arg(long, value_name = "PX", default_value_t = EdgeSettings::default().width)]
    pub edge_width: f64,
    /// Width of the outlines of sections, as that of lines; twice that of lines without it
    #[arg(long, value_name = "PX")]
    pub section_width: Option<f64>,
}

impl LineArgs {
    /// The renderer's settings in a picture of this style; `None` without lines.
    pub fn settings(&self, style: Style) -> Result<Option<EdgeSettings>> {
        let is_drawing = style == Style::Technical && self.edges.is_none();
        let which = self.edges.unwrap_or(if is_drawing { EdgeChoice::Sharp } else { EdgeChoice::None });
        let silhouettes = self.silhouettes || is_drawing;
        let usual = EdgeSettings::default();
        let lighter = usual.hidden_colour[3];
        let colour = self.edge_colour.unwrap_or(usual.colour);
        let [r, g, b, opacity] = colour;
        let settings = EdgeSettings {
            which,
            tangent: self.tangent_edges,
            silhouettes,
            hidden: self.hidden_lines,
            width: self.edge_width,
            thin_width: self.edge_width * usual.thin_width / usual.width,
            section_width: self.section_width.unwrap_or(usual.wider(self.edge_width)),
            colour,
            hidden_colour: [r, g, b, opacity * lighter],
        };
        settings.check()?;
        Ok((which != EdgeChoice::None || silhouettes).then_some(settings))
    }
}
