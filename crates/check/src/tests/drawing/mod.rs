//! Drawings against closed forms and brute force.

mod bodies;
mod judged;
mod meeting;
mod meshes;
mod solid_lines;
mod torus;

use super::shapes::view;
use crate::Tracer;
use crate::drawing::{Cubic, Drawing, DrawingSettings, Line, LineKind, Stroke, cubic_at};
use crate::model::{Camera, Instance, Model, Part, Projection};
use glam::{DAffine3, DVec2, DVec3};

/// Pixels: what the drawing promises of its curves.
const CURVE: f64 = 0.01;
/// Pixels: what it promises of ends.
const END: f64 = 0.05;

/// A picture of 800 x 600 from `eye`, parallel, `height` units high.
fn parallel(eye: DVec3, height: f64) -> Camera {
    Camera { projection: Projection::Orthographic { height }, size: (800, 600), ..upright(eye) }
}

/// The same in perspective.
fn perspective(eye: DVec3) -> Camera {
    Camera { size: (800, 600), ..upright(eye) }
}

fn upright(eye: DVec3) -> Camera {
    let up = if eye.normalize().z.abs() > 0.99 { DVec3::Y } else { DVec3::Z };
    Camera { up, ..view(eye) }
}

/// Parts at their places.
fn placed(parts: Vec<(Part, DAffine3)>) -> Model {
    let instance = |part: usize, transform: DAffine3| Instance { part, transform, colour: None, name: String::new() };
    let instances = parts.iter().enumerate().map(|(k, p)| instance(k, p.1)).collect();
    Model { parts: parts.into_iter().map(|p| p.0).collect(), instances, ..Model::default() }
}

fn alone(part: Part) -> Model {
    placed(vec![(part, DAffine3::IDENTITY)])
}

/// All lines, hidden ones too.
#[track_caller]
fn drawn(model: &Model, camera: &Camera) -> Drawing {
    let tracer = Tracer::new(model);
    let settings = DrawingSettings { hidden: true, ..DrawingSettings::default() };
    let drawing = Drawing::new(model, &tracer, camera, &settings).unwrap();
    assert!(drawing.deviation <= CURVE && drawing.unresolved == 0 && tracer.given_up() == 0, "{}", drawing.deviation);
    drawing
}

fn strokes(drawing: &Drawing, kind: LineKind, hidden: bool) -> Vec<Stroke> {
    drawing.strokes().into_iter().filter(|s| (s.kind, s.hidden) == (kind, hidden)).collect()
}

fn pixel(camera: &Camera, p: DVec3) -> DVec2 {
    camera.project(p).unwrap().0
}

/// Points of cubics, end to end.
fn points(curves: &[Cubic]) -> Vec<DVec2> {
    curves.iter().flat_map(|c| (0..=16).map(|k| cubic_at(c, f64::from(k) / 16.0))).collect()
}

/// Distance of a point from lines, to the rounding of 64 chords a cubic.
fn distance<'l>(lines: impl Iterator<Item = &'l Line>, p: DVec2) -> f64 {
    let mut least = f64::INFINITY;
    for c in lines.flat_map(|l| &l.curves) {
        let low = c.iter().copied().reduce(DVec2::min).unwrap() - least;
        let high = c.iter().copied().reduce(DVec2::max).unwrap() + least;
        if p.cmplt(low).any() || p.cmpgt(high).any() {
            continue;
        }
        for k in 0..64 {
            let [a, b] = [k, k + 1].map(|k| cubic_at(c, f64::from(k) / 64.0));
            let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            least = least.min(p.distance(a.lerp(b, if share.is_nan() { 0.0 } else { share })));
        }
    }
    least
}

fn ends(stroke: &Stroke) -> [DVec2; 2] {
    [stroke.curves[0][0], stroke.curves[stroke.curves.len() - 1][3]]
}

/// Each pair is the ends of one stroke, and each stroke one of the pairs.
#[track_caller]
fn same_segments(strokes: &[Stroke], wanted: &[[DVec2; 2]]) {
    let is = |s: &Stroke, w: &[DVec2; 2]| {
        let [a, b] = ends(s);
        a.distance(w[0]).max(b.distance(w[1])).min(a.distance(w[1]).max(b.distance(w[0]))) <= END
    };
    let told = || strokes.iter().map(ends).collect::<Vec<_>>();
    assert_eq!(strokes.len(), wanted.len(), "{:?} for {wanted:?}", told());
    for w in wanted {
        assert_eq!(strokes.iter().filter(|s| is(s, w)).count(), 1, "{w:?} in {:?}", told());
    }
}
