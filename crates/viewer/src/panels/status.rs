//! The line below the picture, and the windows that it opens: warnings, messages, help.

use super::{Dialog, Facts, Ui};
use crate::commands::{Command, shortcuts};
use crate::describe;
use crate::session::Session;
use crate::settings::Settings;
use egui::WidgetInfo;
use selvedge::picture::Style;
use selvedge_check::light;

/// Steps of the strip that shows a scale.
const STRIP_STEPS: usize = 32;

/// Points between the window's bottom and the files that are being read.
const LOADING_ABOVE: f32 = 40.0;

/// Shows the line.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &Session, facts: &Facts<'_>) {
    panel.horizontal(|row| {
        badge(row, ui, session, facts);
        row.separator();
        let under = facts.view.hover.and_then(|hover| {
            let picked = hover.hit.picked?;
            let name = describe::short(&session.world, &picked);
            let at = session.world.point_of(&picked).or(hover.hit.point);
            Some(at.map_or(name.clone(), |p| format!("{name}   {}", point(p))))
        });
        row.label(under.unwrap_or_default());
        curvature_scale(row, ui.style, session);
        row.with_layout(egui::Layout::right_to_left(egui::Align::Center), |right| {
            let (width, height) = facts.view.camera().size;
            let size = match facts.picture {
                Some(size) if size != (width, height) => format!("{} x {} of {width} x {height}", size.0, size.1),
                _ => format!("{width} x {height}"),
            };
            right.label(size).on_hover_text(facts.device);
            if let Some(message) = ui.messages.last()
                && right.add(egui::Label::new(message).truncate().sense(egui::Sense::click())).clicked()
            {
                ui.warnings = true;
            }
        });
    });
}

/// Shows the files that are being read, over the picture: the view keeps its size.
pub fn loading(ctx: &egui::Context, ui: &mut Ui, facts: &Facts<'_>) {
    if facts.loading.is_empty() {
        return;
    }
    let window = egui::Window::new("Reading").title_bar(false).resizable(false);
    window.anchor(egui::Align2::CENTER_BOTTOM, [0.0, -LOADING_ABOVE]).show(ctx, |rows| {
        for (path, stage, share) in &facts.loading {
            rows.horizontal(|row| {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let bar = egui::ProgressBar::new(share.unwrap_or(0.0)).text(format!("{name}: {stage}"));
                row.add(bar.desired_width(320.0).animate(false));
                if row.button("Cancel").clicked() {
                    ui.commands.push(Command::Cancel);
                }
            });
        }
    });
}

/// A point as the status line shows it: shorter than in the panel.
fn point(p: glam::DVec3) -> String {
    p.to_array().map(|x| format!("{x:.4}")).join("  ")
}

/// The legend of a style of curvature: a strip from hollow to bulging between the ends of the scale.
fn curvature_scale(row: &mut egui::Ui, style: Style, session: &Session) {
    if !style.is_curvature() || session.world.is_empty() {
        return;
    }
    let range = session.world.curvature_range();
    let (name, end, unit) = match style {
        Style::GaussianCurvature => ("Gaussian curvature", range * range, "1/mm²"),
        _ => ("mean curvature", range, "1/mm"),
    };
    row.separator();
    row.label(format!("{name}: -{end}"));
    let (strip, _) = row.allocate_exact_size(egui::vec2(96.0, 10.0), egui::Sense::hover());
    let step = strip.width() / STRIP_STEPS as f32;
    for k in 0..STRIP_STEPS {
        let share = (2 * k + 1) as f64 / STRIP_STEPS as f64 - 1.0;
        let [r, g, b] = light::curvature_scale(share).to_array().map(|c| (255.0 * c).round() as u8);
        let left = strip.left() + k as f32 * step;
        let bar = egui::Rect::from_min_size(egui::pos2(left, strip.top()), egui::vec2(step, strip.height()));
        row.painter().rect_filled(bar, 0.0, egui::Color32::from_rgb(r, g, b));
    }
    row.label(format!("{end} {unit}"));
}

/// The accuracy promise of the picture.
fn badge(row: &mut egui::Ui, ui: &mut Ui, session: &Session, facts: &Facts<'_>) {
    let warnings: usize = session.world.files.iter().map(|file| file.warnings.len()).sum();
    let incomplete = session.world.files.iter().any(|file| !file.complete);
    let clamps = facts.stats.map_or(0, |stats| stats.clamps);
    let (good, bad) = (egui::Color32::from_rgb(60, 160, 80), row.visuals().warn_fg_color);
    let (text, colour) = match () {
        () if session.world.is_empty() => ("no file".to_owned(), row.visuals().weak_text_color()),
        () if facts.busy => ("working".to_owned(), row.visuals().weak_text_color()),
        () if session.world.is_partial() => ("being read".to_owned(), row.visuals().weak_text_color()),
        () if clamps > 0 => (format!("{clamps} places not as promised"), bad),
        () if incomplete => ("not all of the file".to_owned(), bad),
        () if facts.notice.is_some() => ("exact, with a note".to_owned(), bad),
        () => ("exact within 0.5 px".to_owned(), good),
    };
    row.colored_label(colour, text);
    if row.small_button(format!("{warnings} warnings")).clicked() {
        ui.warnings = !ui.warnings;
    }
}

/// Windows over the picture.
pub fn windows(ctx: &egui::Context, ui: &mut Ui, session: &Session, settings: &Settings, facts: &Facts<'_>) {
    let mut open = ui.warnings;
    egui::Window::new("Warnings").open(&mut open).default_width(480.0).show(ctx, |window| {
        egui::ScrollArea::vertical().max_height(360.0).show(window, |area| {
            if let Some(notice) = facts.notice {
                area.label(notice);
            }
            for message in ui.messages.iter().rev() {
                area.label(message);
            }
            for file in &session.world.files {
                area.strong(&file.name);
                area.label(&file.summary);
                file.warnings.iter().for_each(|warning| drop(area.label(warning)));
            }
        });
    });
    ui.warnings = open;
    shot(ctx, ui);
    save(ctx, ui);
    let mut open = ui.help;
    egui::Window::new("Keys and buttons").open(&mut open).default_width(360.0).show(ctx, |window| {
        let preset = settings.preset;
        window.strong(format!("Mouse, as in {}", preset.name()));
        egui::Grid::new("mouse").num_columns(2).striped(true).show(window, |grid| {
            for (what, hint) in ["turn", "move", "zoom"].into_iter().zip(preset.hints()) {
                grid.label(what);
                grid.label(hint);
                grid.end_row();
            }
            grid.label("select");
            grid.label("left click; Shift adds");
            grid.end_row();
            grid.label("measure points");
            grid.label("P, then left click on both");
            grid.end_row();
        });
        window.separator();
        egui::ScrollArea::vertical().max_height(320.0).show(window, |area| {
            egui::Grid::new("keys").num_columns(2).striped(true).show(area, |grid| {
                for shortcut in shortcuts() {
                    grid.monospace(shortcut.label());
                    grid.label(shortcut.what);
                    grid.end_row();
                }
            });
        });
    });
    ui.help = open;
}

/// Whether Enter ends the text of a dialog. The text of the dialog that was just opened takes the keys.
fn is_entered(field: &egui::Response, dialog: Dialog, just_opened: &mut Option<Dialog>) -> bool {
    if just_opened.take_if(|opened| *opened == dialog).is_some() {
        field.request_focus();
    }
    field.lost_focus() && field.ctx.input(|input| input.key_pressed(egui::Key::Enter))
}

/// What a number of pixels is, for those who do not see it.
fn side(name: &str, pixels: u32) -> WidgetInfo {
    WidgetInfo { label: Some(name.to_owned()), ..WidgetInfo::drag_value(true, f64::from(pixels)) }
}

/// The file and the size of a picture to write or to copy.
fn shot(ctx: &egui::Context, ui: &mut Ui) {
    let mut open = ui.shot.open;
    let mut wanted = None;
    egui::Window::new("Write picture").open(&mut open).show(ctx, |window| {
        let shot = &mut ui.shot;
        let mut path = shot.path.to_string_lossy().into_owned();
        let field = window.text_edit_singleline(&mut path);
        field.widget_info(|| super::field("File", &path));
        if field.changed() {
            shot.path = path.into();
        }
        if is_entered(&field, Dialog::Picture, &mut ui.just_opened) {
            wanted = Some(Command::WritePicture);
        }
        window.horizontal(|row| {
            let width = row.add(egui::DragValue::new(&mut shot.size.0).range(1..=16384));
            width.widget_info(|| side("Width", shot.size.0));
            row.label("x");
            let height = row.add(egui::DragValue::new(&mut shot.size.1).range(1..=16384));
            height.widget_info(|| side("Height", shot.size.1));
            row.checkbox(&mut shot.transparent, "transparent");
        });
        window.horizontal(|row| {
            for (name, command) in [("Write", Command::WritePicture), ("Copy", Command::CopyPicture)] {
                if row.button(name).clicked() {
                    wanted = Some(command);
                }
            }
        });
    });
    ui.shot.open = open;
    ui.commands.extend(wanted);
}

/// The file for the edited model.
fn save(ctx: &egui::Context, ui: &mut Ui) {
    let Some(path) = &mut ui.save else { return };
    let (mut open, mut wanted) = (true, false);
    egui::Window::new("Save model").open(&mut open).show(ctx, |window| {
        window.label("A file .selvedge, bit for bit, or .step:");
        let mut text = path.to_string_lossy().into_owned();
        let field = window.text_edit_singleline(&mut text);
        field.widget_info(|| super::field("File", &text));
        if field.changed() {
            *path = text.into();
        }
        let entered = is_entered(&field, Dialog::Model, &mut ui.just_opened);
        wanted = window.button("Save").clicked() || entered;
    });
    if wanted {
        ui.commands.push(Command::Save);
    } else if !open {
        ui.save = None;
    }
}
