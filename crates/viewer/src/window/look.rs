//! The scene's and the frame's settings for the engine, and marks for the composite pass.

use super::app::App;
use crate::pick::Mark;
use crate::session::Picked;
use selvedge::model::Colour;
use selvedge::picture::{FrameSettings, SceneSettings};

impl App {
    /// Settings of the model that is drawn.
    pub fn scene_settings(&self) -> SceneSettings {
        let scene = self.settings.scene(self.ui.style, self.session.world.bounds.diagonal());
        SceneSettings { editable: self.ui.trims, ..scene }
    }

    /// Settings of the pictures in the window.
    pub fn frame_settings(&self) -> FrameSettings {
        FrameSettings {
            style: self.ui.style,
            curvature_range: if self.ui.style.is_curvature() { self.session.world.curvature_range() } else { 1.0 },
            background: Some(self.background()),
            ..FrameSettings::default()
        }
    }

    /// The zoom of the panels: that of the settings. Under X11 a window has the display's new scale only when a window
    /// manager moves it; until then the zoom makes up for what the event of the scale said.
    pub fn zoom(&self) -> f32 {
        let own = self.opened.as_ref().map(|opened| opened.window.scale_factor());
        let missing = self.scale.zip(own).map_or(1.0, |(scale, own)| scale / own);
        self.settings.text * missing as f32
    }

    /// Behind the model, linear light.
    pub fn background(&self) -> Colour {
        background(self.context.style().visuals.dark_mode)
    }

    /// Hovered and selected items, by the numbers of the shown picture.
    pub fn marks(&self) -> (Option<Mark>, Vec<Mark>) {
        let drawn = self.opened.as_ref().and_then(|o| o.engine.drawn(&self.session.world));
        let Some(drawn) = drawn else { return (None, Vec::new()) };
        let number = |instance: usize| drawn.instances.binary_search(&instance).ok().map(|i| i as u32 + 1);
        let mark = |picked: &Picked| match *picked {
            Picked::Face { instance, face, .. } => {
                let part = self.session.world.model.instances.get(instance)?.part;
                let id = self.session.world.model.parts[part].faces.get(face)?.id;
                Some(Mark { instance: number(instance)?, face: id })
            }
            Picked::Instance(instance) => Some(Mark { instance: number(instance)?, face: 0 }),
            Picked::Number { instance: None, id } => Some(Mark { instance: 0, face: id }),
            Picked::Number { instance: Some(instance), id } => Some(Mark { instance: number(instance)?, face: id }),
            // the panels draw these
            Picked::Edge { .. } | Picked::Vertex { .. } | Picked::Point { .. } => None,
        };
        let dragging = self.view.is_dragging();
        let under = self.view.hover.as_ref().and_then(|hover| hover.hit.picked);
        let under = under.or(self.ui.pointed.map(Picked::Instance));
        let hovered = under.filter(|_| !dragging).and_then(|picked| mark(&picked));
        (hovered, self.session.selection.iter().filter_map(mark).collect())
    }
}

/// Behind the model, linear light.
pub fn background(dark: bool) -> Colour {
    if dark { [0.030, 0.032, 0.037, 1.0] } else { [0.80, 0.82, 0.85, 1.0] }
}
