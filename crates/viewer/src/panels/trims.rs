//! The points of one trim loop of the selected face, dragged on its surface.
//!
//! ```text
//!   click on the face ─▶ the loop nearest to it, or one of the list ─▶ handles of its points
//!   handle under the cursor ─ray─▶ surface, from the point's own (u, v) by Newton ─▶ new (u, v) ─▶ loop with it
//! ```
//!
//! Where a handle has the keys, arrow keys move it on the screen in the cursor's place.

use super::Ui;
use super::overlay::Place;
use crate::pick::{nearest_loop, towards};
use crate::session::{Picked, SceneState, Session};
use egui::{Color32, Pos2, Stroke, Vec2};
use glam::DVec2;
use selvedge::model::{Face, TrimLoop};

/// Points that have handles at once: those nearest to the cursor.
const MOST_POINTS: usize = 300;
/// Size of a handle, points.
const SIZE: f32 = 12.0;
/// Height of the list of loops, points.
const LIST: f32 = 110.0;

/// The loop whose points have handles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    instance: usize,
    face: usize,
    /// Where the face was clicked.
    uv: DVec2,
    /// Its number in the face.
    pub trim_loop: usize,
    /// Curve and point that the hand holds.
    gripped: Option<(usize, usize)>,
}

/// A control point of a loop.
#[derive(Clone, Copy, Debug)]
struct Handle {
    curve: usize,
    point: usize,
    uv: DVec2,
}

/// Each control point once: a curve's last one is the next one's first.
fn handles(trim_loop: &TrimLoop) -> Vec<Handle> {
    let mut all = Vec::new();
    for (curve, of_curve) in trim_loop.curves().enumerate() {
        let homogeneous = of_curve.points.iter().take(of_curve.degree()).enumerate();
        all.extend(homogeneous.map(|(point, p)| Handle { curve, point, uv: p.truncate() / p.z }));
    }
    all
}

/// The handles that are shown: those nearest to the cursor, and the one that the hand holds.
fn nearest(mut all: Vec<(Handle, Pos2)>, cursor: Pos2, gripped: Option<(usize, usize)>) -> Vec<(Handle, Pos2)> {
    if all.len() > MOST_POINTS {
        let held = |handle: &Handle| gripped == Some((handle.curve, handle.point));
        let key = |(handle, at): &(Handle, Pos2)| if held(handle) { -1.0 } else { at.distance_sq(cursor) };
        all.sort_by(|a, b| key(a).total_cmp(&key(b)));
        all.truncate(MOST_POINTS);
    }
    all
}

/// The loops of a face as they are now.
fn loops<'a>(
    state: &'a SceneState,
    (part, face): (usize, usize),
    of_face: &'a Face,
) -> impl Iterator<Item = &'a TrimLoop> {
    let now = move |(nth, original): (usize, &'a TrimLoop)| state.edits.get(&(part, face, nth)).unwrap_or(original);
    of_face.loops.iter().enumerate().map(now)
}

/// The loop whose points have handles, while trims are edited: after a click on a face the one nearest to it.
fn chosen(ui: &mut Ui, session: &Session) -> Option<Chosen> {
    let last = session.selection.last().copied().filter(|_| ui.trims);
    let Some(Picked::Face { instance, face, uv }) = last else {
        ui.chosen = None;
        return None;
    };
    if ui.chosen.is_none_or(|chosen| (chosen.instance, chosen.face, chosen.uv) != (instance, face, uv)) {
        let model = &session.world.model;
        let part = model.instances[instance].part;
        let of_face = &model.parts[part].faces[face];
        let found = nearest_loop(&of_face.surface, loops(session.scene.now(), (part, face), of_face), uv);
        if let Some(trim_loop) = found {
            tracing::info!("trim loop {} of {}", trim_loop + 1, of_face.loops.len());
        }
        ui.chosen = found.map(|trim_loop| Chosen { instance, face, uv, trim_loop, gripped: None });
    }
    ui.chosen
}

/// Lists the loops of the selected face, while trims are edited.
pub fn list(panel: &mut egui::Ui, ui: &mut Ui, session: &Session) {
    let Some(Chosen { instance, face, trim_loop, .. }) = chosen(ui, session) else { return };
    let model = &session.world.model;
    let part = model.instances[instance].part;
    let all: Vec<&TrimLoop> = loops(session.scene.now(), (part, face), &model.parts[part].faces[face]).collect();
    panel.strong(format!("Trim loop {} of {}", trim_loop + 1, all.len()));
    let height = panel.spacing().interact_size.y;
    let area = egui::ScrollArea::vertical().id_salt("trim loops").max_height(LIST).auto_shrink([false, true]);
    area.show_rows(panel, height, all.len(), |list, rows| {
        for nth in rows {
            let points: usize = all[nth].curves().map(|curve| curve.degree()).sum();
            let label = list.selectable_label(nth == trim_loop, format!("Loop {}: {points} points", nth + 1));
            if let Some(chosen) = ui.chosen.as_mut().filter(|_| label.clicked()) {
                (chosen.trim_loop, chosen.gripped) = (nth, None);
            }
        }
    });
    panel.separator();
}

/// Draws and drags the handles, while trims are edited.
pub fn show(ctx: &egui::Context, place: &Place<'_>, ui: &mut Ui, session: &mut Session) {
    let Some(Chosen { instance, face, trim_loop: nth, gripped, .. }) = chosen(ui, session) else { return };
    let world = session.world.clone();
    let part = world.model.instances[instance].part;
    let of_face = &world.model.parts[part].faces[face];
    let state = session.scene.now().clone();
    let Some(trim_loop) = loops(&state, (part, face), of_face).nth(nth) else { return };
    let transform = state.placement(instance, &world);
    let in_view = |handle: Handle| {
        let at = place.of(transform.transform_point3(of_face.surface.point(handle.uv.x, handle.uv.y)))?;
        (place.rect.contains(at) || gripped == Some((handle.curve, handle.point))).then_some((handle, at))
    };
    let all: Vec<(Handle, Pos2)> = handles(trim_loop).into_iter().filter_map(in_view).collect();
    if all.len() > MOST_POINTS {
        let count = all.len();
        ui.notice = Some(format!("Of {count} points in view, the {MOST_POINTS} nearest to the cursor have handles."));
    }
    let cursor = ctx.input(|input| input.pointer.latest_pos()).unwrap_or(place.rect.center());
    let (mut held, mut stepped) = (None, None);
    for (handle, at) in nearest(all, cursor, gripped) {
        let id = egui::Id::new(("trim", nth, handle.curve, handle.point));
        let area = egui::Area::new(id).fixed_pos(at - Vec2::splat(0.5 * SIZE)).order(egui::Order::Middle);
        // Tab leads to the handle, not to its area, too
        let response = area.constrain(false).sense(egui::Sense::hover()).show(ctx, |ui| {
            let (rect, response) = ui.allocate_exact_size(Vec2::splat(SIZE), egui::Sense::drag());
            let name = || format!("Point {} of curve {}", handle.point + 1, handle.curve + 1);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, name()));
            let lit = response.hovered() || response.dragged() || response.has_focus();
            let fill = if lit { Color32::from_rgb(255, 150, 20) } else { Color32::WHITE };
            let painter = ui.ctx().layer_painter(ui.layer_id()).with_clip_rect(place.rect);
            painter.circle(rect.center(), 4.0, fill, Stroke::new(1.5, Color32::from_rgb(30, 110, 255)));
            response
        });
        if response.inner.dragged() {
            held = Some((handle, response.inner));
        } else if let Some(by) = super::arrows(&response.inner) {
            stepped = Some((handle, at + by));
        }
    }
    if let Some(chosen) = &mut ui.chosen {
        chosen.gripped = held.as_ref().map(|(handle, _)| (handle.curve, handle.point));
    }
    let drags = held.is_some();
    let (handle, hand) = match (held, stepped) {
        (Some((handle, response)), _) => {
            if response.drag_started() {
                session.scene.begin();
            }
            let Some(hand) = response.interact_pointer_pos() else { return };
            (handle, hand)
        }
        (None, Some(stepped)) => stepped,
        (None, None) => return,
    };
    let pixel = (hand - place.rect.min) / place.to_points as f32;
    let (origin, direction) = place.camera.ray(DVec2::new(f64::from(pixel.x), f64::from(pixel.y)));
    let back = transform.inverse();
    let ray = (back.transform_point3(origin), back.transform_vector3(direction));
    // beyond the surface the point follows its border
    let Some((uv, ..)) = towards(&of_face.surface, ray, handle.uv) else { return };
    match trim_loop.with_point(handle.curve, handle.point, uv) {
        Ok(moved) => {
            let edit = |state: &mut SceneState| _ = state.edits.insert((part, face, nth), moved);
            if drags { session.scene.go_on(edit) } else { session.scene.change(edit) }
        }
        Err(error) => ui.notice = Some(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn each_point_has_one_handle_and_moves_alone() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/panel.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        for trim_loop in import.model.parts[0].faces[0].loops.iter().take(3) {
            let all = handles(trim_loop);
            let degrees: usize = trim_loop.curves().map(|c| c.degree()).sum();
            assert_eq!(all.len(), degrees);
            let last = &all[all.len() - 1];
            let to = last.uv + 1e-3;
            let moved = trim_loop.with_point(last.curve, last.point, to).expect("a loop");
            for (before, after) in all.iter().zip(&handles(&moved)) {
                let wanted = if before.uv == last.uv { to } else { before.uv };
                assert!(after.uv.distance(wanted) < 1e-12);
            }
        }
    }

    #[test]
    fn of_many_points_those_near_the_cursor_have_handles_and_the_held_one() {
        let place = |i: usize| Pos2::new((i % 40) as f32 * 10.0, (i / 40) as f32 * 10.0);
        let handle = |i: usize| Handle { curve: i, point: 0, uv: DVec2::ZERO };
        let all = |count: usize| (0..count).map(|i| (handle(i), place(i))).collect::<Vec<_>>();
        assert_eq!(nearest(all(MOST_POINTS), Pos2::ZERO, None).len(), MOST_POINTS);
        let (cursor, count) = (Pos2::new(200.0, 150.0), 1600);
        let held = count - 1;
        for gripped in [None, Some((held, 0))] {
            let shown = nearest(all(count), cursor, gripped);
            assert_eq!(shown.len(), MOST_POINTS);
            let is_shown = |i: usize| shown.iter().any(|(handle, _)| handle.curve == i);
            assert_eq!(is_shown(held), gripped.is_some());
            let others = shown.iter().filter(|(handle, _)| handle.curve != held);
            let farthest = others.map(|(_, at)| at.distance(cursor)).fold(0.0, f32::max);
            assert!((0..count).all(|i| is_shown(i) || place(i).distance(cursor) >= farthest), "{farthest}");
        }
    }
}
