//! Open files with their parts: show, hide, isolate, make transparent, colour, find.
//!
//! Rows that are scrolled out of sight are not laid out, and names are searched only when the text or the files change:
//! a frame costs the same for every number of parts and solids.

use super::Ui;
use crate::commands::Command;
use crate::session::{Picked, Session, World};
use egui::{Rect, Vec2, WidgetInfo, WidgetType};
use std::ops::Range;
use std::sync::Arc;

/// The instances that a search finds, from frame to frame.
#[derive(Debug, Default)]
pub struct Found {
    world: Arc<World>,
    search: String,
    /// Of each file, in ascending order.
    files: Vec<Vec<usize>>,
}

impl Found {
    /// Searches, unless it has the instances of this model for this text.
    fn update(&mut self, world: &Arc<World>, search: &str) {
        if Arc::ptr_eq(&self.world, world) && self.search == search {
            return;
        }
        let wanted = search.to_lowercase();
        let is_found = |i: &usize| wanted.is_empty() || world.instance_name(*i).to_lowercase().contains(&wanted);
        let files = world.files.iter().map(|file| file.instances.clone().filter(is_found).collect()).collect();
        *self = Self { world: Arc::clone(world), search: search.to_owned(), files };
    }
}

/// Shows it.
pub fn show(panel: &mut egui::Ui, ui: &mut Ui, session: &mut Session) {
    panel.horizontal(|row| {
        row.label("Find");
        let field = row.add(egui::TextEdit::singleline(&mut ui.search).desired_width(f32::INFINITY));
        field.widget_info(|| super::field("Find", &ui.search));
    });
    panel.horizontal(|row| {
        for (name, command) in [("Show all", Command::ShowAll), ("Hide", Command::Hide), ("Isolate", Command::Isolate)]
        {
            if row.small_button(name).clicked() {
                ui.commands.push(command);
            }
        }
    });
    panel.separator();
    ui.pointed = None;
    let mut found = std::mem::take(&mut ui.found);
    found.update(&session.world, &ui.search);
    egui::ScrollArea::both().auto_shrink(false).show(panel, |area| {
        let (world, selected) = (session.world.clone(), session.selected_instances());
        let last = session.selection.last().and_then(Picked::instance);
        for (file, found) in world.files.iter().zip(&found.files) {
            egui::CollapsingHeader::new(&file.name).id_salt(&file.path).default_open(true).show(area, |list| {
                if file.partial {
                    list.weak("being read");
                } else if !file.complete {
                    list.colored_label(list.visuals().warn_fg_color, "not complete").on_hover_text(&file.summary);
                }
                let to = last.filter(|_| ui.show_selection).and_then(|last| found.binary_search(&last).ok());
                rows(list, found.len() + file.solids.len(), to, |list, row| {
                    let solid = row.checked_sub(found.len()).map(|nth| file.solids.start + nth);
                    let item = solid.map_or_else(|| found[row], |solid| world.model.instances.len() + solid);
                    // a row is the same one wherever it is scrolled to
                    list.push_id(item, |list| match solid {
                        Some(solid) => solid_row(list, session, item, &format!("Solid {}", solid + 1)),
                        None => part(list, ui, session, item, &selected),
                    });
                });
            });
        }
        if world.is_empty() {
            area.label("Open a file, or drop one here.");
        }
    });
    ui.found = found;
    ui.show_selection = false;
}

fn eye(row: &mut egui::Ui, session: &mut Session, item: usize, name: &str) {
    let mut visible = !session.scene.now().hidden.contains(&item);
    let eye = row.checkbox(&mut visible, "").on_hover_text("Shown or hidden");
    eye.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, visible, format!("Show {name}")));
    if eye.changed() {
        session.scene.change(|state| state.set_hidden(item, !visible));
    }
}

fn solid_row(list: &mut egui::Ui, session: &mut Session, item: usize, name: &str) {
    list.horizontal(|row| {
        eye(row, session, item, name);
        row.label(name);
    });
}

/// Lays out those of `count` rows that are in sight, and scrolls to one of them.
fn rows(list: &mut egui::Ui, count: usize, to: Option<usize>, mut show: impl FnMut(&mut egui::Ui, usize)) {
    let height = list.spacing().interact_size.y;
    let step = height + list.spacing().item_spacing.y;
    let start = list.cursor().min;
    if let Some(row) = to {
        let place = Rect::from_min_size(start + Vec2::new(0.0, step * row as f32), Vec2::new(1.0, height));
        list.scroll_to_rect(place, None);
    }
    let seen = in_sight(list.clip_rect().y_range(), start.y, step, count);
    list.add_space(step * seen.start as f32);
    seen.clone().for_each(|row| show(list, row));
    list.add_space(step * (count - seen.end) as f32);
}

/// The rows that meet a range of heights.
fn in_sight(seen: egui::Rangef, start: f32, step: f32, count: usize) -> Range<usize> {
    let row = |y: f32| ((y - start) / step).max(0.0);
    let first = (row(seen.min).floor() as usize).min(count);
    first..(row(seen.max).ceil() as usize).clamp(first, count)
}

fn part(list: &mut egui::Ui, ui: &mut Ui, session: &mut Session, instance: usize, selected: &[usize]) {
    let name = session.world.instance_name(instance);
    list.horizontal(|row| {
        eye(row, session, instance, &name);
        let mut colour = session.colour(instance);
        let mut rgb = [colour[0], colour[1], colour[2]];
        let button = row.color_edit_button_rgb(&mut rgb).on_hover_text("Colour");
        button.widget_info(|| WidgetInfo::labeled(WidgetType::ColorButton, true, format!("Colour of {name}")));
        if button.changed() {
            colour[..3].copy_from_slice(&rgb);
            session.scene.change(|state| _ = state.colours.insert(instance, colour));
        }
        let label = row.selectable_label(selected.binary_search(&instance).is_ok(), name);
        if label.hovered() || label.has_focus() {
            ui.pointed = Some(instance);
        }
        if label.clicked() {
            let add = row.input(|input| input.modifiers.shift);
            session.select(Some(Picked::Instance(instance)), add);
        }
        label.context_menu(|menu| {
            let mut item = |menu: &mut egui::Ui, name: &str, command: Command| {
                if menu.button(name).clicked() {
                    session.select(Some(Picked::Instance(instance)), false);
                    ui.commands.push(command);
                    menu.close();
                }
            };
            item(menu, "Hide", Command::Hide);
            item(menu, "Isolate", Command::Isolate);
            item(menu, "See through", Command::SeeThrough);
            item(menu, "Zoom to", Command::FitSelection);
            item(menu, "Own colour", Command::OwnColours);
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Loaded;

    fn world() -> Arc<World> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        Arc::new(World::new(&[Arc::new(Loaded { path, import, partial: false })]))
    }

    #[test]
    fn names_are_searched_only_when_the_text_or_the_files_change() {
        let (world, other) = (world(), world());
        let mut found = Found::default();
        found.update(&world, "");
        let all: Vec<usize> = (0..world.model.instances.len()).collect();
        assert_eq!(found.files, std::slice::from_ref(&all));
        found.files.clear();
        found.update(&world, "");
        assert!(found.files.is_empty(), "it is not searched again");
        found.update(&world, &world.instance_name(1).to_uppercase());
        assert!(found.files[0].contains(&1) && found.files[0].len() < all.len(), "{:?}", found.files);
        found.update(&other, "");
        assert_eq!(found.files, [all]);
        found.files.clear();
        found.update(&world, "");
        assert_eq!(found.files.len(), 1, "another model");
    }

    #[test]
    fn only_rows_in_sight_are_laid_out() {
        let of = |min: f32, max: f32| in_sight(egui::Rangef::new(min, max), 100.0, 20.0, 50);
        assert_eq!(of(0.0, 700.0), 0..30);
        assert_eq!(of(310.0, 390.0), 10..15);
        assert_eq!([of(0.0, 90.0), of(2000.0, 2400.0)], [0..0, 50..50]);
    }
}
