//! The properties of the selected items.

use super::Ui;
use crate::commands::Command;
use crate::describe;
use crate::measure::{CSV_HEADER, Measurement, stated};
use crate::pick::PickFilter;
use crate::session::Session;

/// Items that are described in full; further ones are only named.
const MOST: usize = 6;

/// Shows it.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &mut Session) {
    let points = ui.filter == PickFilter::Points;
    panel.horizontal(|row| {
        row.heading("Selection");
        if row.selectable_label(points, "Points").on_hover_text("Measure between points (P)").clicked() {
            ui.commands.push(Command::Points);
        }
    });
    if session.selection.is_empty() {
        panel.label(if points {
            "Click two points: corners, centres and middles of edges, places on edges and faces."
        } else {
            "Click a face, an edge, a corner. Shift adds."
        });
    }
    if let Some(notice) = &ui.notice {
        panel.colored_label(panel.visuals().warn_fg_color, notice);
    }
    super::colour::show(panel, ui, session);
    super::trims::list(panel, ui, session);
    // content wider than the panel scrolls: the picture keeps its size
    egui::ScrollArea::both().auto_shrink(false).show(panel, |area| {
        let world = session.world.clone();
        measured(area, ui);
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

/// The measurement of the selection, and the list of kept ones.
fn measured(area: &mut egui::Ui, ui: &mut Ui) {
    if let Some(measurement) = ui.measurement.clone() {
        area.strong("Measured");
        values(area, ui, MOST, &measurement);
        if area.button("Keep (M)").clicked() {
            ui.commands.push(Command::Measure);
        }
        area.separator();
    }
    if ui.kept.is_empty() {
        return;
    }
    area.horizontal(|row| {
        row.strong("Kept");
        if row.small_button("Copy text").clicked() {
            let text: Vec<String> = ui.kept.iter().map(Measurement::text).collect();
            ui.commands.push(Command::CopyText(text.join("\n\n")));
        }
        if row.small_button("Copy CSV").clicked() {
            let rows: String = ui.kept.iter().map(Measurement::csv).collect();
            ui.commands.push(Command::CopyText(CSV_HEADER.to_owned() + &rows));
        }
    });
    let mut removed = None;
    for (i, measurement) in ui.kept.clone().iter().enumerate() {
        egui::CollapsingHeader::new(&measurement.title).id_salt(("kept", i)).default_open(true).show(area, |list| {
            values(list, ui, MOST + 1 + i, measurement);
            if list.small_button("Remove").clicked() {
                removed = Some(i);
            }
        });
    }
    area.separator();
    removed.into_iter().for_each(|i| drop(ui.kept.remove(i)));
}

fn values(list: &mut egui::Ui, ui: &mut Ui, nth: usize, measurement: &Measurement) {
    let numbers = measurement.values.iter().map(|v| (v.what, stated(v)));
    let points = measurement.points.iter().map(|(what, p)| (*what, describe::vector(*p)));
    table(list, ui, nth, &numbers.chain(points).collect());
}

/// Names and values; a click on a value copies it.
fn table(list: &mut egui::Ui, ui: &mut Ui, nth: usize, lines: &describe::Description) {
    egui::Grid::new(("table", nth)).num_columns(2).striped(true).show(list, |grid| {
        for (what, value) in lines {
            grid.label(*what);
            // coordinates stand one below the other; many knots would fill the panel
            let shown = if describe::KNOTS.contains(what) { value.clone() } else { value.replace(", ", "\n") };
            let text = egui::Label::new(shown).wrap().sense(egui::Sense::click());
            if grid.add(text).on_hover_text("Click to copy").clicked() {
                ui.commands.push(Command::CopyText(value.clone()));
            }
            grid.end_row();
        }
    });
}
