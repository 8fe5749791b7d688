//! Places where a picture has to have lines of Boolean solids, or may have some: no file states their edges, so
//! rays find them.
//!
//! ```text
//!   ●────×──●     between the centres of neighbouring pixels: where the surface changes, a line has to be
//!   │    ╲  │
//!   │     ╲ │     two changes on the four ways around: the line may go straight from one to the other
//!   ●──────×●     others (three lines meet, or one ends): rays FINE times as dense; lines are as fine as pixels there
//!
//!   edges of operands without equations: where the operand is seen beside a point of one, a line may be
//! ```
//!
//! What no pixel's centre sees needs no line. What is seen through is looked at layer by layer, as many as the ray of
//! some centre meets.

use super::changes::{Change, Changes, Look, OFF, Ray, Why, layers};
use super::judge::SPACING;
use super::path::{LineSource, Path, Spot, View};
use super::sources::{edge_path, of, segment};
use super::{DrawingError, DrawingSettings};
use crate::edges::scale;
use crate::model::{Camera, Mesh, Model, Part, Primitive, Shape};
use crate::solids::LayerTracer;
use crate::{Hit, Probe, Tracer, Visibility};
use glam::DVec2;
use rayon::prelude::*;

/// Rows of pixels that are looked at together.
const ROWS: usize = 16;
/// Rays along a pixel's side where lines meet.
const FINE: u32 = 4;

/// Whether there has to be a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Need {
    Must,
    /// It is not known.
    Unsure,
    /// Lines are right there, and not counted.
    May,
}

/// A place of lines, or a stretch of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub ends: [DVec2; 2],
    pub need: Need,
    /// Of a section.
    pub is_outline: bool,
    /// Pixels by which a line may be farther off than others.
    pub off: f64,
    /// Index into the primitives of the solids' union.
    pub primitive: usize,
}

/// All places of a view.
///
/// # Errors
/// [`DrawingError`] for an operand whose faces have no boundary curves.
pub(super) fn places(
    model: &Model,
    tracer: &Tracer,
    view: &View,
    camera: &Camera,
    settings: &DrawingSettings,
) -> Result<Vec<Place>, DrawingError> {
    let (width, height) = (camera.size.0 as usize, camera.size.1 as usize);
    let tops: Vec<usize> = (0..height).step_by(ROWS).collect();
    let mut out = Vec::new();
    let looks = (0..deepest(tracer, camera)).map(Look::Layer);
    for look in std::iter::once(Look::Opaque).chain(looks) {
        let Some(changes) = Changes::new(model, tracer, (camera, look), settings) else { continue };
        let of_band = |probe: &mut Probe<'_>, top: &usize| {
            let last = (top + ROWS).min(height - 1);
            Band::new(&changes, (*top, last), width, probe).places(&changes, settings, probe)
        };
        let found: Vec<Vec<Place>> = tops.par_iter().map_init(|| tracer.probe(camera), of_band).collect();
        out.extend(found.into_iter().flatten());
    }
    let primitives = tracer.solids.iter().flat_map(|solids| solids.union().primitives()).enumerate();
    for (number, primitive) in primitives {
        let operand = Operand { tracer, number, primitive };
        out.extend(operand.places(model.parts.len(), view, camera, settings)?);
    }
    Ok(out)
}

/// Layers that the centre of a pixel meets, at most.
fn deepest(tracer: &Tracer, camera: &Camera) -> usize {
    if !tracer.solids.as_ref().is_some_and(LayerTracer::has_clear) {
        return 0;
    }
    let of_row = |probe: &mut Probe<'_>, y: usize| {
        (0..camera.size.0 as usize).map(|x| layers(tracer, probe.hits(centre(x, y))).len()).max().unwrap_or(0)
    };
    let rows = (0..camera.size.1 as usize).into_par_iter();
    rows.map_init(|| tracer.probe(camera), of_row).max().unwrap_or(0)
}

/// Whether a line of this kind has to be there; `None` where it is not drawn.
fn need(change: &Change, settings: &DrawingSettings) -> Option<Need> {
    match change.why {
        Why::Unsure => Some(Need::Unsure),
        Why::Line(kind) => settings.draws(kind).then_some(Need::Must),
    }
}

/// The changes between the centres of some rows of pixels.
struct Band {
    width: usize,
    /// Number of the first row.
    top: usize,
    /// Of each pixel: to the one beside it.
    right: Vec<Vec<Change>>,
    /// To the one below; the last row has none.
    below: Vec<Vec<Change>>,
}

fn centre(x: usize, y: usize) -> DVec2 {
    DVec2::new(x as f64, y as f64) + 0.5
}

impl Band {
    /// From one row to another, which the next band has, too, unless it is the picture's last.
    fn new(changes: &Changes<'_>, (top, last): (usize, usize), width: usize, probe: &mut Probe<'_>) -> Self {
        let pixels = (top..=last).flat_map(|y| (0..width).map(move |x| centre(x, y)));
        let rays: Vec<Ray> = pixels.map(|pixel| changes.ray(pixel, probe)).collect();
        let (mut right, mut below) = (Vec::with_capacity(rays.len()), Vec::with_capacity(rays.len()));
        for (at, ray) in rays.iter().enumerate() {
            let beside = rays.get(at + 1).filter(|_| (at + 1) % width != 0);
            right.push(beside.map_or_else(Vec::new, |beside| changes.between(ray, beside, probe)));
            below.push(rays.get(at + width).map_or_else(Vec::new, |under| changes.between(ray, under, probe)));
        }
        Self { width, top, right, below }
    }

    fn places(&self, changes: &Changes<'_>, settings: &DrawingSettings, probe: &mut Probe<'_>) -> Vec<Place> {
        let mut out = Vec::new();
        let rows = self.right.len() / self.width;
        // the last row is the next band's first
        let own = if rows > ROWS { ROWS * self.width } else { self.right.len() };
        for change in self.right[..own].iter().chain(&self.below[..own]).flatten() {
            let place = |need: Need| Place {
                ends: [change.pixel; 2],
                need,
                is_outline: change.is_outline,
                off: change.off,
                primitive: change.primitive,
            };
            out.extend(need(change, settings).map(place));
        }
        for row in 1..rows {
            for x in 1..self.width {
                let at = (row - 1) * self.width + x - 1;
                let sides = [&self.right[at], &self.below[at], &self.below[at + 1], &self.right[at + self.width]];
                let found: Vec<&Change> = sides.into_iter().flatten().collect();
                match found.as_slice() {
                    [] => {}
                    [a, b] if sides.iter().all(|side| side.len() < 2) => out.extend(stretch(a, b, settings)),
                    _ => {
                        let corner = centre(x - 1, self.top + row - 1);
                        let within = within(changes, corner, probe);
                        let may = |change: &Change| {
                            need(change, settings).map(|_| Place {
                                ends: [change.pixel; 2],
                                need: Need::May,
                                is_outline: change.is_outline,
                                off: change.off.max(OFF),
                                primitive: change.primitive,
                            })
                        };
                        out.extend(found.iter().copied().chain(&within).filter_map(may));
                    }
                }
            }
        }
        out
    }
}

/// The line between two changes that belong together.
fn stretch(a: &Change, b: &Change, settings: &DrawingSettings) -> Option<Place> {
    need(a, settings).and(need(b, settings)).map(|_| Place {
        ends: [a.pixel, b.pixel],
        need: Need::May,
        is_outline: a.is_outline || b.is_outline,
        off: a.off.max(b.off),
        primitive: a.primitive,
    })
}

/// Changes between rays that are denser, right of and below the centre of a pixel.
fn within(changes: &Changes<'_>, corner: DVec2, probe: &mut Probe<'_>) -> Vec<Change> {
    let side = FINE as usize + 1;
    let step = |k: usize| DVec2::new((k % side) as f64, (k / side) as f64) / f64::from(FINE);
    let rays: Vec<Ray> = (0..side * side).map(|k| changes.ray(corner + step(k), probe)).collect();
    let mut out = Vec::new();
    for (k, ray) in rays.iter().enumerate() {
        let right = rays.get(k + 1).filter(|_| (k + 1) % side != 0);
        for other in right.into_iter().chain(rays.get(k + side)) {
            out.extend(changes.between(ray, other, probe));
        }
    }
    out
}

/// A primitive that may have edges of its own.
struct Operand<'a> {
    tracer: &'a Tracer,
    number: usize,
    primitive: &'a Primitive,
}

impl Operand<'_> {
    /// Points of its edges that may be seen; none of a primitive with equations. An error counts its number on from
    /// `parts`.
    fn places(
        &self,
        parts: usize,
        view: &View,
        camera: &Camera,
        settings: &DrawingSettings,
    ) -> Result<Vec<Place>, DrawingError> {
        let bare;
        let part: &Part = match &self.primitive.shape {
            Shape::Part(part) => part,
            Shape::Mesh(mesh) => {
                bare = Part { meshes: vec![Mesh::clone(mesh)], ..Part::default() };
                &bare
            }
            _ => return Ok(Vec::new()),
        };
        let failed = |source| DrawingError::Edges { part: parts + self.number, source };
        let edges = part.edges().map_err(failed)?;
        let transform = &self.primitive.transform;
        // of no instance
        let instance = usize::MAX;
        let curves = edges.edges.iter().enumerate().map(|(number, edge)| edge_path(instance, number, edge, transform));
        // beside faces meshes bound nothing
        let sides = edges.of_meshes.iter().filter(|_| part.faces.is_empty()).map(|side| {
            let source = LineSource::Side { instance, mesh: side.triangles[0].0 };
            segment(source, of(side.kind), side.ends, transform)
        });
        let paths: Vec<Path<'_>> = curves.chain(sides).filter(|path| settings.draws(path.kind)).collect();
        let known = edges.deviation * scale(transform);
        let points = |probe: &mut Probe<'_>, mut path: Path<'_>| {
            path.follow(view);
            let length = path.length();
            let count = (length / SPACING).ceil() as usize;
            let along = |k: usize| path.parameter(length * (k as f64 + 0.5) / count as f64);
            let spots = (0..count).filter_map(|k| path.spot(view, along(k))).filter(|spot| view.shows(spot));
            spots.filter(|spot| self.is_near(spot, known, probe)).map(|spot| self.place(&spot)).collect::<Vec<_>>()
        };
        Ok(paths.into_par_iter().map_init(|| self.tracer.probe(camera), points).flatten_iter().collect())
    }

    fn place(&self, spot: &Spot) -> Place {
        let (need, primitive) = (Need::May, self.number);
        Place { ends: [spot.pixel; 2], need, is_outline: false, off: OFF, primitive }
    }

    /// Nothing hides the point, and one of nine pixels around it sees the operand, maybe through others: it may be cut away
    /// there.
    fn is_near(&self, spot: &Spot, known: f64, probe: &mut Probe<'_>) -> bool {
        let own = |hit: &Hit| self.tracer.primitive(hit) == Some(self.number);
        let seen = self.tracer.sight(spot.point, known, &own, probe);
        let is_hidden = !matches!(seen, Visibility::Visible | Visibility::Unsure);
        let mut around = (0..9).map(|k| DVec2::new(f64::from(k % 3 - 1), f64::from(k / 3 - 1)));
        // edges are seen through what is seen through
        let mut sees = |pixel: DVec2| {
            let mut hits = probe.hits(pixel).iter();
            let is_layer = |hit: &&Hit| self.tracer.is_layer(hit);
            hits.clone().take_while(is_layer).any(own) || hits.find(|hit| !is_layer(hit)).is_some_and(own)
        };
        !is_hidden && around.any(|way| sees(spot.pixel + way))
    }
}
