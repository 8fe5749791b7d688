//! The panels around the picture: tree, properties, toolbar, status, help; and the drawings over it.
//!
//! ```text
//!   ┌ toolbar: file, views, styles, lines, sections ───────────────┐
//!   │ tree   │                                       ┌cube┐│ what  │
//!   │        │            the picture                └────┘│ it is │
//!   ├────────┴─────────────────────────────────────────────┴───────┤
//!   └ status: under the cursor, size, promise, warnings ───────────┘
//! ```
//!
//! Widgets that show no text of their own have a name in egui's accessibility information.

mod colour;
mod handles;
mod overlay;
mod properties;
mod status;
mod toolbar;
mod tree;
mod trims;

use crate::commands::{self, Command};
use crate::measure::{Measurement, cut};
use crate::pick::PickFilter;
use crate::pick::step::step;
use crate::session::Picked;
use crate::session::Session;
use crate::session::shown::MOST_SECTIONS;
use crate::settings::Settings;
use crate::view::View;
use glam::DVec3;
use selvedge::model::Camera;
use selvedge::picture::{FrameStats, Style};
use std::path::{Path, PathBuf};

/// Messages that are kept.
const MOST_MESSAGES: usize = 50;
/// Measurements that are kept: each is laid out, and drawn as a dimension, in every frame.
const MOST_KEPT: usize = 200;

/// The state of the panels from frame to frame.
#[derive(Debug)]
pub struct Ui {
    /// The kinds of items that a click selects.
    pub filter: PickFilter,
    /// How surfaces are shown.
    pub style: Style,
    /// The text to search in the tree.
    pub search: String,
    /// The items that have it.
    found: tree::Found,
    /// The help is open.
    pub help: bool,
    /// The list of warnings is open.
    pub warnings: bool,
    /// Messages for the user, the last one last.
    pub messages: Vec<String>,
    /// Commands for the window.
    pub commands: Vec<Command>,
    /// The window is to be closed.
    pub quit: bool,
    /// The tree scrolls to the selection once.
    pub show_selection: bool,
    /// The instance whose row in the tree is under the pointer, or has the keys: the picture marks it.
    pub pointed: Option<usize>,
    /// The point of the last click.
    pub clicked: Option<DVec3>,
    /// The selection needs a measurement.
    pub wants_measure: bool,
    /// The measurement of the selection.
    pub measurement: Option<Measurement>,
    /// The measurement is kept when it arrives.
    keeps: bool,
    /// Measurements that are kept.
    pub kept: Vec<Measurement>,
    /// Where pictures go.
    pub shot: Shot,
    /// The last verdict of the judge.
    pub verdict: Option<Verdict>,
    /// A trim loop of the selected face can be dragged.
    pub trims: bool,
    /// The loop whose points have handles.
    chosen: Option<trims::Chosen>,
    /// A notice on the selected face.
    pub notice: Option<String>,
    /// The file to save the model to, while its dialog is open.
    pub save: Option<PathBuf>,
    /// The dialog that was just opened: its text field takes the keys.
    just_opened: Option<Dialog>,
    /// A colour that is being typed.
    colour: Option<String>,
}

/// The dialogs with a text that Enter carries out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dialog {
    Picture,
    Model,
}

/// The dialog for writing a picture.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The dialog is open.
    pub open: bool,
    /// The file.
    pub path: PathBuf,
    /// Width and height.
    pub size: (u32, u32),
    /// A transparent background.
    pub transparent: bool,
}

/// The judge's verdict on a view.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The view.
    pub camera: Camera,
    /// Pixels judged.
    pub sampled: u64,
    /// Those that break the promise.
    pub wrong: u64,
    /// Pixels that do not agree at their centre, the worst first, a thousand at most.
    pub pixels: Vec<[u32; 2]>,
}

impl Default for Ui {
    fn default() -> Self {
        Self {
            filter: PickFilter::default(),
            style: Style::default(),
            search: String::new(),
            found: tree::Found::default(),
            help: false,
            warnings: false,
            messages: Vec::new(),
            commands: Vec::new(),
            quit: false,
            show_selection: false,
            pointed: None,
            clicked: None,
            wants_measure: false,
            measurement: None,
            keeps: false,
            kept: Vec::new(),
            shot: Shot { open: false, path: PathBuf::from("view.png"), size: (1280, 720), transparent: false },
            verdict: None,
            trims: false,
            chosen: None,
            notice: None,
            save: None,
            just_opened: None,
            colour: None,
        }
    }
}

/// The window's state, for the panels.
pub struct Facts<'a> {
    /// Files that are being read: stage, and share of it.
    pub loading: Vec<(&'a Path, &'a str, Option<f32>)>,
    /// Statistics of the last picture.
    pub stats: Option<&'a FrameStats>,
    /// A setting that does not apply to this model.
    pub notice: Option<&'a str>,
    /// The engine is uploading another model.
    pub busy: bool,
    /// Size of the picture that is shown.
    pub picture: Option<(u32, u32)>,
    /// The view.
    pub view: &'a View,
    /// Name of the device.
    pub device: &'a str,
}

impl Ui {
    /// Adds a message.
    pub fn tell(&mut self, message: String) {
        if self.messages.len() == MOST_MESSAGES {
            self.messages.remove(0);
        }
        self.messages.push(message);
    }

    /// Other files are open now.
    pub fn opened(&mut self) {
        (self.clicked, self.measurement, self.verdict) = (None, None, None);
        self.kept.clear();
    }

    /// The selection was measured.
    pub fn measured(&mut self, measurement: Option<Measurement>) {
        for value in measurement.iter().flat_map(|m| &m.values) {
            tracing::info!("{}: {} {}", value.what, value.value, value.unit);
        }
        if std::mem::take(&mut self.keeps) {
            measurement.clone().into_iter().for_each(|measurement| self.keep(measurement));
        }
        self.measurement = measurement;
    }

    /// Keeps a measurement in the list; the list's first one goes where there are too many.
    fn keep(&mut self, measurement: Measurement) {
        if self.kept.len() == MOST_KEPT {
            self.kept.remove(0);
        }
        self.kept.push(measurement);
    }

    /// Takes the judge's verdict.
    pub fn judged(&mut self, verdict: Verdict) {
        self.tell(match verdict.wrong {
            0 => format!("Checked {} pixels: all as promised.", verdict.sampled),
            wrong => format!("Checked {} pixels: {wrong} are wrong.", verdict.sampled),
        });
        self.verdict = Some(verdict);
    }

    /// The selection has changed: faces, edges and corners are measured at once, parts on demand.
    fn remeasure(&mut self, session: &Session) {
        self.measurement = None;
        let quick = session.selection.iter().all(|picked| !matches!(picked, Picked::Instance(_)));
        self.wants_measure = quick && (1..=2).contains(&session.selection.len());
    }

    /// A click has changed the selection.
    pub fn selected(&mut self, session: &Session, point: Option<DVec3>) {
        self.show_selection = true;
        self.clicked = point;
        self.remeasure(session);
        if let Some(picked) = session.selection.last() {
            tracing::info!("selected {}", crate::describe::short(&session.world, picked));
            for (what, value) in crate::describe::long(&session.world, picked) {
                tracing::debug!("{what}: {value}");
            }
        }
    }

    /// Carries out a command that concerns the session alone.
    pub fn obey(&mut self, command: Command, session: &mut Session) {
        let (chosen, world) = (session.selected_instances(), session.world.clone());
        match command {
            Command::Undo => drop(session.scene.undo()),
            Command::Redo => drop(session.scene.redo()),
            Command::Clear => {
                session.select(None, false);
                (self.help, self.warnings, self.shot.open) = (false, false, false);
                (self.measurement, self.verdict, self.save) = (None, None, None);
            }
            Command::Next { back, add } => {
                let is_other = step(session, self.filter, back, add);
                if is_other {
                    self.selected(session, None);
                }
            }
            Command::OwnColours => {
                session.scene.change(|state| chosen.iter().for_each(|item| _ = state.colours.remove(item)));
            }
            Command::Hide => {
                session.scene.change(|state| chosen.iter().for_each(|item| state.set_hidden(*item, true)));
                session.select(None, false);
            }
            Command::Isolate if !chosen.is_empty() => session.scene.change(|state| state.isolate(&chosen, &world)),
            Command::Cut if session.scene.now().sections.len() < MOST_SECTIONS => {
                if let Some(section) = cut::at_selection(session) {
                    session.scene.change(|state| state.sections.push(section));
                }
            }
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
            Command::Points => {
                let is_on = self.filter == PickFilter::Points;
                self.filter = if is_on { PickFilter::Any } else { PickFilter::Points };
            }
            Command::Trims => self.trims = !self.trims,
            Command::SaveAs => {
                self.save = if self.save.is_none() { Some(PathBuf::from("edited.selvedge")) } else { None };
                self.just_opened = self.save.is_some().then_some(Dialog::Model);
            }
            Command::Screenshot => {
                self.shot.open = !self.shot.open;
                self.just_opened = self.shot.open.then_some(Dialog::Picture);
            }
            Command::Measure => match self.measurement.clone() {
                Some(measurement) => self.keep(measurement),
                None => (self.wants_measure, self.keeps) = (true, true),
            },
            _ => {}
        }
    }
}

/// The context of the panels: one pass a frame, since a key or a drag counts once. The cursor of a text does not blink:
/// nothing is drawn while nothing changes.
pub fn context() -> egui::Context {
    let ctx = egui::Context::default();
    ctx.all_styles_mut(|style| style.visuals.text_cursor.blink = false);
    ctx.options_mut(|options| options.max_passes = std::num::NonZeroUsize::MIN);
    ctx
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
    status::loading(ctx, ui, facts);
    status::windows(ctx, ui, session, settings, facts);
    rect
}

/// What a text field is, for those who do not see it: its label stands beside it.
fn field(name: &str, text: &str) -> egui::WidgetInfo {
    egui::WidgetInfo { label: Some(name.to_owned()), ..egui::WidgetInfo::text_edit(true, text, text, "") }
}

/// How far the arrow keys move a handle that has the keys, points: one a press, ten with Shift. They then lead to no
/// other widget.
fn arrows(handle: &egui::Response) -> Option<egui::Vec2> {
    if !handle.has_focus() {
        return None;
    }
    if handle.gained_focus() {
        // it keeps the arrows from the frame after the next on
        handle.ctx.request_repaint();
    }
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    handle.ctx.memory_mut(|memory| memory.set_focus_lock_filter(handle.id, filter));
    let by = handle.ctx.input(|input| {
        let presses = |key| input.num_presses(key) as f32;
        let right = presses(egui::Key::ArrowRight) - presses(egui::Key::ArrowLeft);
        let down = presses(egui::Key::ArrowDown) - presses(egui::Key::ArrowUp);
        egui::Vec2::new(right, down) * if input.modifiers.shift { 10.0 } else { 1.0 }
    });
    (by != egui::Vec2::ZERO).then_some(by)
}

#[cfg(test)]
mod tests;
