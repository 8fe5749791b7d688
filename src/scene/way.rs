//! Which way a scene is trimmed, told before anything is made for either.
//!
//! ```text
//!   rows of a placed face  =  bins (strips + length)        length: of a curve along v, in rows, where the scene is as
//!                                                           wide as a picture of PICTURE_PX
//!   Auto:  rows of all faces <= MOST_ROWS  and  points <= MOST_POINTS  ──▶ table        else ──▶ exact
//! ```
//!
//! [`MOST_ROWS`] is a quarter of what the table's passes can number, so finer tolerances, larger pictures and views of a part
//! of the model mostly have room, too. No count that is made before there is a view bounds all of them: an eye within a face
//! sees as many rows as it likes. A view that wants more than there can be has the renderer load the model once more, for the
//! exact way (`renderer/load.rs`). The renderer keeps a copy of the model for that, which is why [`MOST_POINTS`] is a bound, too.

use super::cells::strips;
use super::instance::stretch;
use super::request::SceneRequest;
use super::whole_view::Ball;
use crate::abi;
use crate::model::{Face, Mesh, Model, Part, Shape};
use crate::picture::{SceneSettings, Smooth, TakenWay, TrimWay};
use rayon::prelude::*;

/// Rows that the table is expected to have at most where [`TrimWay::Auto`] takes it.
const MOST_ROWS: f64 = (1u32 << 21) as f64;
/// Control points and corners of meshes: 64 MiB of points.
const MOST_POINTS: usize = 1 << 21;
/// Of the picture for which rows are counted: the ball around the scene is as wide.
const PICTURE_PX: f64 = 2048.0;
/// Between scan lines at the default tolerance.
const ROW_PX: f64 = 0.125;
/// Of each knot span of a curve whose length is told.
const CHORDS: u32 = 4;

/// How `settings` trim a model, never [`TrimWay::Auto`]; `None` where nothing of it is trimmed.
pub fn trim_way(model: &Model, settings: SceneSettings) -> Option<TrimWay> {
    let bodies = model.parts.iter().chain(operands(model).map(|(part, _)| part));
    let is_trimmed = bodies.flat_map(|part| &part.faces).any(|face| !face.loops.is_empty());
    is_trimmed.then(|| taken(model, settings.into()))?.reported()
}

/// The way that is asked for, or suits the model.
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

/// Spline parts that Boolean solids name, and how many times as large they are placed.
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

/// That the trim table of a picture of the whole scene has, about; where those that it has however small it is seen are too
/// many, these.
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

/// Of all placed faces that have loops: `of` each, as many times as `by` its scale.
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

/// Knots along v between which a surface is one polynomial.
fn v_spans(face: &Face) -> impl Iterator<Item = (f64, f64)> {
    let (v0, v1) = face.surface.domain().1;
    let pairs = face.surface.knots().1.windows(2).map(|pair| (pair[0], pair[1]));
    pairs.filter(move |(a, b)| a < b && *a >= v0 && *b <= v1)
}

/// The longest of a few curves along v, as chords between points of the surface: control points may lie far from it.
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

    /// Its bodies once more for each place, side by side.
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

    /// A control point of little weight may lie a million times as far away as any point of the surface.
    #[test]
    fn lengths_are_of_the_surface_not_of_its_control_points() {
        let column = |x: f64| [(0.0, 1.0), (1.0, 1e-6), (1.0, 1.0)].map(|(y, w)| DVec4::new(x * w, y, 0.0, w));
        let [left, right] = [column(0.0), column(1.0)];
        let points = left.into_iter().zip(right).flat_map(|(a, b)| [a, b]).collect();
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let surface = Surface::new((1, 2), vec![0.0, 0.0, 1.0, 1.0], knots, points).unwrap();
        let mut face = bracket().parts[0].faces[0].clone();
        face.surface = surface;
        // up to 1.5 in the middle, and back to 1 at the end
        let length = length(&face);
        assert!(length > 1.5 && length < 3.0, "{length}");
    }

    /// The bound is passed by as many copies as have so many rows: not one fewer.
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
