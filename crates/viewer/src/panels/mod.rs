//! What surrounds the picture: tree, properties, toolbar, status, help; and what is drawn over it.
//!
//! ```text
//!   ┌ toolbar: file, views, styles, lines, sections ───────────────┐
//!   │ tree   │                                       ┌cube┐│ what  │
//!   │        │            the picture                └────┘│ it is │
//!   ├────────┴─────────────────────────────────────────────┴───────┤
//!   └ status: under the cursor, size, promise, warnings ───────────┘
//! ```

mod overlay;
mod properties;
mod status;
mod toolbar;
mod tree;

use crate::commands::{self, Command};
use crate::pick::PickFilter;
use crate::session::Session;
use crate::settings::Settings;
use crate::view::View;
use glam::DVec3;
use selvedge::picture::{FrameStats, Style};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Messages that are kept.
const MOST_MESSAGES: usize = 50;

/// What the panels remember from frame to frame.
#[derive(Debug)]
pub struct Ui {
    /// What a click takes.
    pub filter: PickFilter,
    /// How surfaces are shown.
    pub style: Style,
    /// What is looked for in the tree.
    pub search: String,
    /// The help is open.
    pub help: bool,
    /// The list of warnings is open.
    pub warnings: bool,
    /// What a person should know, the last one last.
    pub messages: Vec<String>,
    /// Wishes that the window has to fulfil.
    pub commands: Vec<Command>,
    /// The pointer is over a panel, or held by one.
    pub pointer_taken: bool,
    /// Open files that were written, and when.
    pub changed: BTreeMap<PathBuf, Instant>,
    /// The window is to be closed.
    pub quit: bool,
    /// The tree scrolls to the selection once.
    pub show_selection: bool,
    /// The point of the last click.
    pub clicked: Option<DVec3>,
}

impl Default for Ui {
    fn default() -> Self {
        Self {
            filter: PickFilter::default(),
            style: Style::default(),
            search: String::new(),
            help: false,
            warnings: false,
            messages: Vec::new(),
            commands: Vec::new(),
            pointer_taken: false,
            changed: BTreeMap::new(),
            quit: false,
            show_selection: false,
            clicked: None,
        }
    }
}

/// What the panels are told of the rest.
pub struct Facts<'a> {
    /// Files that are being read: stage, and share of it.
    pub loading: Vec<(&'a Path, &'a str, Option<f32>)>,
    /// Of the picture that was drawn last.
    pub stats: Option<&'a FrameStats>,
    /// What of the settings does not apply to this model.
    pub notice: Option<&'a str>,
    /// The engine is being given another model.
    pub busy: bool,
    /// Size of the picture that is shown.
    pub picture: Option<(u32, u32)>,
    /// The view.
    pub view: &'a View,
    /// Name of the device.
    pub device: &'a str,
}

impl Ui {
    /// Tells something.
    pub fn tell(&mut self, message: String) {
        if self.messages.len() == MOST_MESSAGES {
            self.messages.remove(0);
        }
        self.messages.push(message);
    }

    /// Other files are open now.
    pub fn opened(&mut self) {
        self.clicked = None;
    }

    /// A click has changed the selection.
    pub fn selected(&mut self, session: &Session, point: Option<DVec3>) {
        self.show_selection = true;
        self.clicked = point;
        if let Some(picked) = session.selection.last() {
            tracing::info!("selected {}", crate::describe::short(&session.world, picked));
            for (what, value) in crate::describe::long(&session.world, picked) {
                tracing::debug!("{what}: {value}");
            }
        }
    }

    /// Fulfils a wish that concerns the session alone.
    pub fn obey(&mut self, command: Command, session: &mut Session) {
        let (chosen, world) = (session.selected_instances(), session.world.clone());
        match command {
            Command::Undo => drop(session.scene.undo()),
            Command::Redo => drop(session.scene.redo()),
            Command::Clear => {
                session.select(None, false);
                (self.help, self.warnings) = (false, false);
            }
            Command::Hide => {
                session.scene.change(|state| chosen.iter().for_each(|item| state.set_hidden(*item, true)));
                session.select(None, false);
            }
            Command::Isolate if !chosen.is_empty() => session.scene.change(|state| state.isolate(&chosen, &world)),
            Command::ShowAll => session.scene.change(|state| state.hidden.clear()),
            Command::SeeThrough => session.scene.change(|state| {
                let all = chosen.iter().all(|i| state.clear.contains(i));
                for i in &chosen {
                    if all {
                        state.clear.remove(i)
                    } else {
                        state.clear.insert(*i)
                    };
                }
            }),
            Command::Help => self.help = !self.help,
            _ => {}
        }
    }
}

/// Shows all panels; returns where the picture is, points.
pub fn show(
    ctx: &egui::Context,
    ui: &mut Ui,
    session: &mut Session,
    settings: &mut Settings,
    facts: &Facts<'_>,
) -> egui::Rect {
    ui.commands.extend(commands::pressed(ctx));
    egui::TopBottomPanel::top("toolbar").show(ctx, |panel| toolbar::show(panel, ui, session, settings, facts));
    egui::TopBottomPanel::bottom("status").show(ctx, |panel| status::show(panel, ui, session, facts));
    egui::SidePanel::left("tree").default_width(220.0).show(ctx, |panel| tree::show(panel, ui, session));
    egui::SidePanel::right("properties").default_width(240.0).show(ctx, |panel| properties::show(panel, ui, session));
    let rect = ctx.available_rect();
    overlay::show(ctx, rect, ui, session, facts);
    status::windows(ctx, ui, session, settings, facts);
    ui.pointer_taken = ctx.is_using_pointer() || ctx.is_pointer_over_area();
    rect
}

#[cfg(test)]
mod tests;
