//! Drawings over the picture: view cube, marked edges and points, dimensions.

use super::{Facts, Ui};
use crate::commands::Command;
use crate::navigation::cube;
use crate::pick::PickFilter;
use crate::session::{Picked, PointKind, Session};
use egui::{Color32, Pos2, Rect, Shape, Stroke};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::model::{Camera, Edge};

/// Side of the cube's widget, points.
const CUBE: f32 = 96.0;
/// Chords of one Bézier piece of a marked edge.
const CHORDS: usize = 24;
/// From a point to its name.
const BESIDE: egui::Vec2 = egui::Vec2::new(12.0, -12.0);
/// Half of the size of a point's mark.
const MARK: f32 = 5.0;
const HOVERED: Color32 = Color32::from_rgb(255, 150, 20);
const SELECTED: Color32 = Color32::from_rgb(30, 110, 255);

/// Draws it.
pub fn show(ctx: &egui::Context, rect: Rect, ui: &mut Ui, session: &mut Session, facts: &Facts<'_>) {
    if rect.width() < CUBE || rect.height() < CUBE {
        return;
    }
    let painter = ctx.layer_painter(egui::LayerId::background()).with_clip_rect(rect);
    let to_points = f64::from(rect.width()) / f64::from(facts.view.camera().size.0.max(1));
    let place = Place { camera: facts.view.camera(), rect, to_points };
    let hovered = facts.view.hover.and_then(|hover| hover.hit.picked);
    let all = session.selection.iter().map(|picked| (picked, SELECTED)).chain(hovered.iter().map(|p| (p, HOVERED)));
    for (picked, colour) in all {
        mark(&painter, &place, session, picked, colour);
    }
    if let Some(picked) = hovered.filter(|_| ui.filter == PickFilter::Points) {
        name(&painter, &place, session, &picked);
    }
    // dimensions are those of the model as it is
    let is_together = session.scene.now().explosion == 0.0;
    for measurement in ui.kept.iter().chain(&ui.measurement).filter(|_| is_together) {
        measurement.dimensions.iter().for_each(|(ends, text)| dimension(&painter, &place, *ends, text));
    }
    wrong_pixels(&painter, &place, ui);
    ui.notice = None;
    super::trims::show(ctx, &place, ui, session);
    super::handles::show(ctx, &place, session);
    view_cube(ctx, rect, ui, facts.view.camera());
}

/// A line between two points with its measurement.
fn dimension(painter: &egui::Painter, place: &Place<'_>, ends: [DVec3; 2], text: &str) {
    let (Some(a), Some(b)) = (place.of(ends[0]), place.of(ends[1])) else { return };
    painter.line_segment([a, b], Stroke::new(1.5, SELECTED));
    for end in [a, b] {
        painter.circle_filled(end, 3.0, SELECTED);
    }
    label(painter, a + (b - a) * 0.5, egui::Align2::CENTER_CENTER, text, SELECTED);
}

/// A text on a ground of a colour.
fn label(painter: &egui::Painter, at: Pos2, anchor: egui::Align2, text: &str, colour: Color32) {
    let galley = painter.layout_no_wrap(text.to_owned(), egui::FontId::proportional(13.0), Color32::WHITE);
    let ground = anchor.anchor_size(at, galley.size());
    painter.rect_filled(ground.expand(3.0), 3.0, colour);
    painter.galley(ground.min, galley, Color32::WHITE);
}

/// The kind of the point under the cursor, beside it.
fn name(painter: &egui::Painter, place: &Place<'_>, session: &Session, picked: &Picked) {
    let text = match picked {
        Picked::Vertex { .. } => "vertex",
        Picked::Point { kind: PointKind::Centre, .. } => "centre",
        Picked::Point { kind: PointKind::Middle, .. } => "middle",
        Picked::Point { kind: PointKind::OnEdge, .. } => "on edge",
        Picked::Point { kind: PointKind::OnFace, .. } => "on face",
        _ => return,
    };
    let Some(at) = place_of(place, session, picked) else { return };
    label(painter, at + BESIDE, egui::Align2::LEFT_BOTTOM, text, HOVERED);
}

/// Where a vertex or a point is drawn.
fn place_of(place: &Place<'_>, session: &Session, picked: &Picked) -> Option<Pos2> {
    let point = session.world.point_of(picked)?;
    let moved = session.scene.now().moved(picked.instance()?, &session.world);
    place.of(moved.transform_point3(point))
}

/// Wrong pixels of the verdict, while the view is the judged one.
fn wrong_pixels(painter: &egui::Painter, place: &Place<'_>, ui: &Ui) {
    let Some(verdict) = ui.verdict.as_ref().filter(|v| v.camera == *place.camera && v.wrong > 0) else { return };
    for [x, y] in &verdict.pixels {
        let at = DVec2::new(f64::from(*x) + 0.5, f64::from(*y) + 0.5) * place.to_points;
        let at = Pos2::new(place.rect.min.x + at.x as f32, place.rect.min.y + at.y as f32);
        painter.circle_filled(at, 2.5, Color32::RED);
    }
}

/// From the model to the panel.
pub(super) struct Place<'a> {
    pub camera: &'a Camera,
    pub rect: Rect,
    pub to_points: f64,
}

impl Place<'_> {
    pub fn of(&self, p: DVec3) -> Option<Pos2> {
        let (pixel, depth) = self.camera.project(p)?;
        (depth >= self.camera.depth_range.0).then(|| {
            let at = pixel * self.to_points;
            Pos2::new(self.rect.min.x + at.x as f32, self.rect.min.y + at.y as f32)
        })
    }
}

/// Draws an edge, a vertex or another point; faces are marked in the picture.
fn mark(painter: &egui::Painter, place: &Place<'_>, session: &Session, picked: &Picked, colour: Color32) {
    let (world, state) = (&session.world, session.scene.now());
    let Some(instance) = picked.instance().filter(|i| *i < world.model.instances.len()) else { return };
    if state.hidden.contains(&instance) {
        return;
    }
    let draw = |edge: usize, width: f32| {
        let edges = world.edges_of(world.model.instances[instance].part);
        if let Some(edge) = edges.and_then(|edges| edges.edges.get(edge)) {
            curve(painter, place, edge, state.placement(instance, world), Stroke::new(width, colour));
        }
    };
    match *picked {
        Picked::Edge { edge, .. } => draw(edge, 3.0),
        // the edge that it is the centre, the middle or a point of
        Picked::Point { kind, of, .. } if kind != PointKind::OnFace => draw(of, 1.5),
        _ => {}
    }
    let Some(at) = place_of(place, session, picked) else { return };
    let (white, stroke) = (Stroke::new(1.0, Color32::WHITE), Stroke::new(2.0, colour));
    match *picked {
        Picked::Point { kind: PointKind::Centre, .. } => {
            painter.circle_stroke(at, MARK, stroke);
            painter.circle_filled(at, 1.5, colour);
        }
        Picked::Point { kind: PointKind::Middle, .. } => {
            let corners = [(-MARK, MARK), (MARK, MARK), (0.0, -MARK)].map(|(x, y)| at + egui::Vec2::new(x, y));
            painter.add(Shape::convex_polygon(corners.to_vec(), colour, white));
        }
        Picked::Point { kind: PointKind::OnEdge, .. } => {
            for across in [egui::Vec2::new(MARK, MARK), egui::Vec2::new(MARK, -MARK)] {
                painter.line_segment([at - across, at + across], stroke);
            }
        }
        // a vertex, or a point of a face
        _ => {
            painter.circle(at, 4.0, colour, white);
        }
    }
}

/// Draws the curve of a placed edge.
fn curve(painter: &egui::Painter, place: &Place<'_>, edge: &Edge, transform: DAffine3, stroke: Stroke) {
    for span in &edge.curve {
        let points = (0..=CHORDS).map(|i| span.piece.point(i as f64 / CHORDS as f64));
        let points: Vec<Option<Pos2>> = points.map(|p| place.of(transform.transform_point3(p))).collect();
        for pair in points.windows(2) {
            if let [Some(a), Some(b)] = *pair {
                painter.line_segment([a, b], stroke);
            }
        }
    }
}

fn view_cube(ctx: &egui::Context, rect: Rect, ui: &mut Ui, camera: &Camera) {
    let corner = Pos2::new(rect.max.x - CUBE - 8.0, rect.min.y + 8.0);
    egui::Area::new("cube".into()).fixed_pos(corner).order(egui::Order::Middle).sense(egui::Sense::hover()).show(
        ctx,
        |area| {
            // Tab leads past it: keys and the menu have its views
            let (own, response) = area.allocate_exact_size(egui::Vec2::splat(CUBE), egui::Sense::CLICK);
            let to_panel = |p: DVec2| own.center() + egui::Vec2::new(p.x as f32, p.y as f32) * (0.5 * CUBE);
            let at = response.hover_pos().map(|p| (p - own.center()) / (0.5 * CUBE));
            let under = at.and_then(|p| cube::direction_at(camera, DVec2::new(f64::from(p.x), f64::from(p.y))));
            let painter = area.painter();
            for side in cube::sides(camera) {
                let lit = under.is_some_and(|d| d.dot(side.normal) > 0.5);
                let base = if lit { HOVERED } else { area.visuals().widgets.inactive.bg_fill };
                let shade = base.gamma_multiply(0.75 + 0.25 * side.facing as f32);
                let stroke = Stroke::new(1.0, area.visuals().widgets.active.fg_stroke.color);
                painter.add(Shape::convex_polygon(side.corners.map(to_panel).to_vec(), shade, stroke));
                if side.facing > 0.35 {
                    let middle = to_panel(cube::place(camera, side.normal));
                    let font = egui::FontId::proportional(10.0);
                    let colour = area.visuals().strong_text_color();
                    painter.text(middle, egui::Align2::CENTER_CENTER, side.name, font, colour);
                }
            }
            if response.clicked() {
                ui.commands.extend(under.map(Command::LookFrom));
            }
        },
    );
}
