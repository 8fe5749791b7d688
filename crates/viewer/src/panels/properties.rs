//! What the selected things are.

use super::Ui;
use crate::commands::Command;
use crate::describe;
use crate::session::Session;

/// Things that are described at length; others are named.
const MOST: usize = 6;

/// Shows it.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &mut Session) {
    panel.heading("Selection");
    if session.selection.is_empty() {
        panel.label("Click a face, an edge, a corner. Shift adds.");
        return;
    }
    egui::ScrollArea::vertical().auto_shrink(false).show(panel, |area| {
        let world = session.world.clone();
        for (i, picked) in session.selection.iter().enumerate() {
            let title = describe::short(&world, picked);
            if i >= MOST {
                area.label(title);
                continue;
            }
            egui::CollapsingHeader::new(title).id_salt(("picked", i)).default_open(true).show(area, |list| {
                table(list, ui, i, &describe::long(&world, picked));
            });
        }
    });
}

/// Names and values; a click on a value copies it.
fn table(list: &mut egui::Ui, ui: &mut Ui, nth: usize, lines: &describe::Description) {
    egui::Grid::new(("table", nth)).num_columns(2).striped(true).show(list, |grid| {
        for (what, value) in lines {
            grid.label(*what);
            let text = egui::Label::new(value.replace(", ", "\n")).wrap().sense(egui::Sense::click());
            if grid.add(text).on_hover_text("Click to copy").clicked() {
                ui.commands.push(Command::CopyText(value.clone()));
            }
            grid.end_row();
        }
    });
}
