//! Chooses the way to trim before any array is made.
//!
//! ```text
//!   rows of a placed face  =  bins (strips + length)        length: of a curve along v, in rows, if the scene is
//!                                                           as wide as a picture of PICTURE_PX
//!   Auto:  rows of all faces <= MOST_ROWS  and  points <= MOST_POINTS  ──▶ table        else ──▶ exact
//! ```
//!
//! [`MOST_ROWS`] is a quarter of what the table's passes can number, so finer tolerances, larger pictures and close
//! views mostly fit, too. No count made before there is a view is a bound for all views: an eye inside a face sees any
//! number of rows. If a view needs more rows than possible, the renderer uploads the model again for the exact way
//! (`renderer/load.rs`). The renderer stores a copy of the model for that; therefore [`MOST_POINTS`] limits the points,
//! too.

use super::cells::strips;
use super::instance::stretch;
use super::request::SceneRequest;
use super::whole_view::Ball;
use crate::abi;
use crate::model::{Face, Mesh, Model, Part, Shape};
use crate::picture::{SceneSettings, Smooth, TakenWay, TrimWay};
use rayon::prelude::*;

/// Most rows that a table is expected to have if [`TrimWay::Auto`] chooses it.
const MOST_ROWS: f64 = (1u32 << 21) as f64;
/// Most control points and mesh corners together: 64 MiB.
const MOST_POINTS: usize = 1 << 21;
/// Width of the picture for which rows are counted, in pixels; the ball around the scene is as wide.
const PICTURE_PX: f64 = 2048.0;
/// Distance of scan lines at the default tolerance, in pixels.
const ROW_PX: f64 = 0.125;
/// Chords for each knot span of a measured curve.
const CHORDS: u32 = 4;

/// The way in which `settings` trim a model, never [`TrimWay::Auto`]; `None` if no face is trimmed.
pub fn trim_way(model: &Model, settings: SceneSettings) -> Option<TrimWay> {
    let bodies = model.parts.iter().chain(operands(model).map(|(part, _)| part));
    let is_trimmed = bodies.flat_map(|part| &part.faces).any(|face| !face.loops.is_empty());
    is_trimmed.then(|| taken(model, settings.into()))?.reported()
}

/// The way that the settings name, or that suits the model.
pub(super) fn taken(model: &Model, settings: SceneRequest) -> TakenWay {
    #[cfg(feature = "baselines")]
    if let Some(method) = settings.baseline.trim {
        return TakenWay::Baseline(method);
    }
    match settings.trim {
        TrimWay::Table => TakenWay::Table,
        TrimWay::Exact => TakenWay::Exact,
        TrimWay::Auto if settings.smooth != Smooth::None || !suits_table(model) => TakenWay::Exact,
        TrimWay::Auto => TakenWay::Table,
    }
}

fn suits_table(model: &Model) -> bool {
    points(model) <= MOST_POINTS && rows(model) <= MOST_ROWS
}

/// Spline parts that Boolean solids use, and the scale of each.
fn operands(model: &Model) -> impl Iterator<Item = (&Part, f64)> {
    model.solids.iter().flat_map(|solid| solid.primitives()).filter_map(|primitive| match &primitive.shape {
        Shape::Part(part) => Some((&**part, stretch(primitive.transform.matrix3))),
        _ => None,
    })
}

fn points(model: &Model) -> usize {
    let bodies = model.parts.iter().chain(operands(model).map(|(part, _)| part));
    let of = |part: &Part| {
        let faces = part.faces.iter().map(|face| face.surface.points().len());
        faces.chain(part.meshes.iter().map(Mesh::positions).map(<[_]>::len)).sum::<usize>()
    };
    bodies.map(of).sum()
}

/// Approximate number of rows of the trim table for a picture of the whole scene. If the rows that it has at any size
/// are already too many, their number.
fn rows(model: &Model) -> f64 {
    let Some(ball) = Ball::around(model.control_bounds()) else { return 0.0 };
    let of_strips = |face: &Face| {
        let (strips, bins) = strips_and_bins(face);
        strips * bins
    };
    let fewest = summed(model, of_strips, |_| 1.0);
    if fewest > MOST_ROWS {
        return fewest;
    }
    let of_length = |face: &Face| strips_and_bins(face).1 * length(face);
    let lines_a_unit = PICTURE_PX / (2.0 * ball.radius) / ROW_PX;
    fewest + summed(model, of_length, |scale| scale * lines_a_unit)
}

/// Sum over all placed faces with loops: `of` the face, times `by` of its scale.
fn summed(model: &Model, of: impl Fn(&Face) -> f64 + Sync, by: impl Fn(f64) -> f64) -> f64 {
    let of_part = |part: &Part| part.faces.par_iter().filter(|face| !face.loops.is_empty()).map(&of).sum::<f64>();
    let parts: Vec<f64> = model.parts.par_iter().map(of_part).collect();
    let placed = model.instances.iter().map(|i| (parts[i.part], stretch(i.transform.matrix3)));
    let operands = operands(model).map(|(part, scale)| (of_part(part), scale));
    placed.chain(operands).map(|(sum, scale)| sum * by(scale)).sum()
}

fn strips_and_bins(face: &Face) -> (f64, f64) {
    let strips = strips(face, v_spans(face).count(), TakenWay::Table);
    let face = abi::Face { strips, ..Default::default() };
    (f64::from(face.strip_count()), f64::from(face.bin_count()))
}

/// The knot spans along v; in each, the surface is one polynomial.
fn v_spans(face: &Face) -> impl Iterator<Item = (f64, f64)> {
    let (v0, v1) = face.surface.domain().1;
    let pairs = face.surface.knots().1.windows(2).map(|pair| (pair[0], pair[1]));
    pairs.filter(move |(a, b)| a < b && *a >= v0 && *b <= v1)
}

/// The longest of three curves along v, as chords between points of the surface. Control points may lie far from the
/// surface.
fn length(face: &Face) -> f64 {
    let (u0, u1) = face.surface.domain().0;
    let chords = if face.surface.degrees().1 > 1 { CHORDS } else { 1 };
    let along = |u: f64| {
        let at = |v: f64| face.surface.jet(u, v).point;
        let step = |(a, b): (f64, f64), k: u32| at(a + (b - a) * f64::from(k) / f64::from(chords));
        let span = |ends| (0..chords).map(|k| step(ends, k).distance(step(ends, k + 1))).sum::<f64>();
        v_spans(face).map(span).sum::<f64>()
    };
    [u0, 0.5 * (u0 + u1), u1].map(along).into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::model::Instance;
    use crate::picture::FrameSettings;
    use crate::spline::Surface;
    use glam::{DAffine3, DVec3, DVec4};

    fn bracket() -> Model {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/bracket.step");
        selvedge_io::import::open(&path).unwrap().model
    }

    /// A model with copies of its bodies side by side.
    fn repeated(model: &Model, times: usize) -> Model {
        let step = model.bounds().diagonal();
        let shifted = |n: usize| DAffine3::from_translation(DVec3::X * (n as f64 * step));
        let of = |n: usize| {
            model.instances.iter().map(move |i| Instance { transform: shifted(n) * i.transform, ..i.clone() })
        };
        Model { instances: (0..times).flat_map(of).collect(), ..model.clone() }
    }

    #[test]
    fn rows_are_those_of_the_default_tolerance() {
        assert_eq!(ROW_PX, Budget::of(FrameSettings::default().tolerance_px).row);
    }

    /// A control point of small weight may lie a million times farther away than any point of the surface.
    #[test]
    fn lengths_are_of_the_surface_not_of_its_control_points() {
        let column = |x: f64| [(0.0, 1.0), (1.0, 1e-6), (1.0, 1.0)].map(|(y, w)| DVec4::new(x * w, y, 0.0, w));
        let [left, right] = [column(0.0), column(1.0)];
        let points = left.into_iter().zip(right).flat_map(|(a, b)| [a, b]).collect();
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let surface = Surface::new((1, 2), vec![0.0, 0.0, 1.0, 1.0], knots, points).unwrap();
        let mut face = bracket().parts[0].faces[0].clone();
        face.surface = surface;
        // it rises to 1.5 in the middle and falls back to 1
        let length = length(&face);
        assert!(length > 1.5 && length < 3.0, "{length}");
    }

    /// The bound is exceeded at the number of copies that have so many rows, and not earlier.
    #[test]
    fn few_rows_are_for_the_table_and_many_for_the_exact_way() {
        let bracket = bracket();
        let auto = SceneSettings::default();
        assert_eq!(trim_way(&bracket, auto), Some(TrimWay::Table));
        let fewest = (1..).map(|n| 1 << n).find(|&n| rows(&repeated(&bracket, n)) > MOST_ROWS).unwrap();
        assert_eq!(trim_way(&repeated(&bracket, fewest / 2), auto), Some(TrimWay::Table));
        let many = repeated(&bracket, fewest);
        assert_eq!(trim_way(&many, auto), Some(TrimWay::Exact));
        assert_eq!(trim_way(&many, SceneSettings { trim: TrimWay::Table, ..auto }), Some(TrimWay::Table));
        assert_eq!(trim_way(&bracket, SceneSettings { smooth: Smooth::Trims, ..auto }), Some(TrimWay::Exact));
        let mut plain = bracket.clone();
        plain.parts.iter_mut().flat_map(|p| &mut p.faces).for_each(|f| f.loops.clear());
        assert_eq!(trim_way(&plain, auto), None);
    }
}
