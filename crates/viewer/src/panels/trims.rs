//! Points of the selected face's trim loops, dragged on its surface.
//!
//! ```text
//!   handle under the cursor ─ray─▶ surface, from the point's own (u, v) by Newton ─▶ new (u, v) ─▶ loop with it
//! ```

use super::Ui;
use super::overlay::Place;
use crate::pick::towards;
use crate::session::{Picked, Session};
use egui::{Color32, Stroke, Vec2};
use glam::{DVec2, DVec3};
use selvedge::model::TrimLoop;

/// Points of a face that are shown; a face with more is too crowded to grip.
const MOST_POINTS: usize = 300;
/// Size of a handle, points.
const SIZE: f32 = 12.0;

/// A control point of a loop.
struct Handle {
    trim_loop: usize,
    curve: usize,
    point: usize,
    uv: DVec2,
}

/// Each control point once: a curve's last one is the next one's first.
fn handles(loops: &[&TrimLoop]) -> Vec<Handle> {
    let of_curve = |trim_loop: usize, curve: usize, points: Vec<DVec3>| {
        let count = points.len() - 1;
        let homogeneous = points.into_iter().take(count).enumerate();
        homogeneous
            .map(move |(point, p)| Handle { trim_loop, curve, point, uv: p.truncate() / p.z })
            .collect::<Vec<_>>()
    };
    let of_loop = |(i, l): (usize, &&TrimLoop)| {
        l.curves().enumerate().flat_map(|(c, curve)| of_curve(i, c, curve.points)).collect::<Vec<_>>()
    };
    loops.iter().enumerate().flat_map(of_loop).collect()
}

/// Draws and drags them, while trims are edited.
pub fn show(ctx: &egui::Context, place: &Place<'_>, ui: &mut Ui, session: &mut Session) {
    let Some(Picked::Face { instance, face, .. }) = session.selection.last().copied().filter(|_| ui.trims) else {
        return;
    };
    let world = session.world.clone();
    let placed = &world.model.instances[instance];
    let of_face = &world.model.parts[placed.part].faces[face];
    let state = session.scene.now().clone();
    let key = |trim_loop: usize| (placed.part, face, trim_loop);
    let loops = of_face.loops.iter().enumerate().map(|(i, l)| state.edits.get(&key(i)).unwrap_or(l));
    let loops: Vec<&TrimLoop> = loops.collect();
    let transform = state.placement(instance, &world);
    let all = handles(&loops);
    if all.len() > MOST_POINTS {
        ui.notice = Some(format!("This face has {} trim points, more than can be gripped.", all.len()));
        return;
    }
    let mut gripped = None;
    for handle in all {
        let point = transform.transform_point3(of_face.surface.point(handle.uv.x, handle.uv.y));
        let Some(at) = place.of(point) else { continue };
        let id = egui::Id::new(("trim", handle.trim_loop, handle.curve, handle.point));
        let area = egui::Area::new(id).fixed_pos(at - Vec2::splat(0.5 * SIZE)).order(egui::Order::Middle);
        let response = area.constrain(false).show(ctx, |ui| {
            let (rect, response) = ui.allocate_exact_size(Vec2::splat(SIZE), egui::Sense::drag());
            let lit = response.hovered() || response.dragged();
            let fill = if lit { Color32::from_rgb(255, 150, 20) } else { Color32::WHITE };
            let painter = ui.ctx().layer_painter(ui.layer_id()).with_clip_rect(place.rect);
            painter.circle(rect.center(), 4.0, fill, Stroke::new(1.5, Color32::from_rgb(30, 110, 255)));
            response
        });
        if response.inner.dragged() {
            gripped = Some((handle, response.inner));
        }
    }
    let Some((handle, response)) = gripped else { return };
    if response.drag_started() {
        session.scene.begin();
    }
    let Some(hand) = response.interact_pointer_pos() else { return };
    let pixel = (hand - place.rect.min) / place.to_points as f32;
    let (origin, direction) = place.camera.ray(DVec2::new(f64::from(pixel.x), f64::from(pixel.y)));
    let back = transform.inverse();
    let ray = (back.transform_point3(origin), back.transform_vector3(direction));
    // beyond the surface the point follows its border
    let Some((uv, ..)) = towards(&of_face.surface, ray, handle.uv) else { return };
    match loops[handle.trim_loop].with_point(handle.curve, handle.point, uv) {
        Ok(moved) => session.scene.go_on(|state| _ = state.edits.insert(key(handle.trim_loop), moved)),
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
        let loops: Vec<&TrimLoop> = import.model.parts[0].faces[0].loops.iter().take(3).collect();
        let all = handles(&loops);
        let degrees: usize = loops.iter().flat_map(|l| l.curves()).map(|c| c.degree()).sum();
        assert_eq!(all.len(), degrees);
        let last = &all[all.len() - 1];
        let to = last.uv + 1e-3;
        let moved = loops[last.trim_loop].with_point(last.curve, last.point, to).expect("a loop");
        let after = handles(&[&moved]);
        let of_loop: Vec<_> = all.iter().filter(|h| h.trim_loop == last.trim_loop).collect();
        for (before, after) in of_loop.iter().zip(&after) {
            let wanted = if before.uv == last.uv { to } else { before.uv };
            assert!(after.uv.distance(wanted) < 1e-12);
        }
    }
}
