//! Handles of section planes: an arrow along the normal, dragged along itself. The plane snaps to parallel faces, unless
//! Ctrl is held. Where the handle has the keys, each arrow key moves the plane by a point of the arrow: right and up
//! along it, left and down against it.
//!
//! ```text
//!      plane │     the mouse moves by d on the screen; the arrow of length L in the model is a on the screen:
//!            ●──▶     offset += L (d · a) / |a|²
//! ```

use super::overlay::Place;
use crate::session::{Section, Session};
use egui::{Color32, Stroke, Vec2, WidgetInfo};
use glam::DVec3;
use selvedge::model::Bounds;

/// Size of the handle, points.
const SIZE: f32 = 18.0;
/// Length of an arrow, of the model's diagonal.
const ARROW: f64 = 0.08;
/// The plane snaps to faces that are no farther from the hand, points.
const SNAP: f64 = 4.0;
/// An arrow shorter than this on the screen, points, points at the eye: it cannot be dragged.
const SHORTEST: f32 = 6.0;

/// Where the handle of a section is, and the end of its arrow.
fn arrow(section: &Section, bounds: Bounds) -> (DVec3, DVec3) {
    let middle = bounds.centre();
    let foot = middle + section.normal * (section.offset - section.normal.dot(middle));
    (foot, foot + section.normal * (ARROW * bounds.diagonal()))
}

/// How far a plane moves, model units, when the mouse moves by `drag`, points.
fn moved(drag: Vec2, arrow: Vec2, length: f64) -> f64 {
    length * f64::from(drag.dot(arrow) / arrow.length_sq())
}

/// Draws and drags them.
pub fn show(ctx: &egui::Context, place: &Place<'_>, session: &mut Session) {
    let bounds = session.world.bounds;
    if bounds.is_empty() {
        return;
    }
    for (i, section) in session.scene.now().sections.clone().iter().enumerate().filter(|(_, s)| s.on) {
        let (foot, tip) = arrow(section, bounds);
        let (Some(from), Some(to)) = (place.of(foot), place.of(tip)) else { continue };
        let along = to - from;
        let area = egui::Area::new(egui::Id::new(("section", i))).fixed_pos(from - Vec2::splat(0.5 * SIZE));
        let area = area.order(egui::Order::Middle).constrain(false).sense(egui::Sense::hover());
        let response = area.show(ctx, |ui| {
            let (rect, response) = ui.allocate_exact_size(Vec2::splat(SIZE), egui::Sense::drag());
            response.widget_info(|| WidgetInfo::slider(true, section.offset, format!("Handle of section {}", i + 1)));
            let lit = response.hovered() || response.dragged() || response.has_focus();
            let colour = if lit { Color32::from_rgb(255, 150, 20) } else { Color32::from_rgb(40, 170, 90) };
            let painter = ui.ctx().layer_painter(ui.layer_id()).with_clip_rect(place.rect);
            painter.arrow(rect.center(), along, Stroke::new(2.5, colour));
            painter.circle(rect.center(), 6.0, colour, Stroke::new(1.0, Color32::WHITE));
            response.on_hover_text(format!("Section at {}", crate::describe::number(section.offset)))
        });
        let response = response.inner;
        let (low, high) = section.range(bounds);
        if let Some(by) = super::arrows(&response).filter(|_| along.length() >= SHORTEST) {
            let step = ARROW * bounds.diagonal() * f64::from((by.x - by.y) / along.length());
            let offset = (section.offset + step).clamp(low, high);
            session.scene.change(|state| state.sections[i].offset = offset);
        }
        if along.length() < SHORTEST || !response.dragged() && !response.drag_started() {
            continue;
        }
        let length = ARROW * bounds.diagonal();
        let step = moved(response.drag_delta(), along, length);
        // where the hand is, beside the face that the plane has snapped to
        let hand = egui::Id::new(("hand", i));
        let before = if response.drag_started() {
            session.scene.begin();
            section.offset
        } else {
            ctx.data(|data| data.get_temp::<f64>(hand)).unwrap_or(section.offset)
        };
        let free = (before + step).clamp(low, high);
        ctx.data_mut(|data| data.insert_temp(hand, free));
        let snaps = !ctx.input(|input| input.modifiers.command) && session.scene.now().explosion == 0.0;
        let reach = if snaps { SNAP * length / f64::from(along.length()) } else { 0.0 };
        let face = section.snapped(free, session.world.planes(), reach);
        let offset = if face == free { free } else { face - Section::BELOW * bounds.diagonal() };
        session.scene.go_on(|state| state.sections[i].offset = offset);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_follows_the_hand_along_its_arrow_alone() {
        let arrow = Vec2::new(30.0, 40.0);
        assert!((moved(Vec2::new(60.0, 80.0), arrow, 5.0) - 10.0).abs() < 1e-6);
        assert!(moved(Vec2::new(-40.0, 30.0), arrow, 5.0).abs() < 1e-6);
    }

    #[test]
    fn the_handle_lies_on_its_plane() {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::new(10.0, 20.0, 30.0) };
        let section = Section { normal: DVec3::new(0.6, 0.0, 0.8), offset: 4.0, on: true };
        let (foot, tip) = arrow(&section, bounds);
        assert!((section.normal.dot(foot) - 4.0).abs() < 1e-12);
        assert!((tip - foot).normalize().distance(section.normal) < 1e-12);
    }
}
