//! Which way a scene is trimmed, told before anything is made for either.
//!
//! ```text
//!   rows of a placed face  =  bays (strips + height)        height: its longest column of control points, in rows, where
//!                                                           the scene is as wide as a picture of PICTURE_PX
//!   Auto:  rows of all faces <= MOST_ROWS  and  points <= MOST_POINTS  ──▶ table        else ──▶ exact
//! ```
//!
//! [`MOST_ROWS`] is a quarter of what the table's passes can number, so finer tolerances, larger pictures and views of a part
//! of the model mostly have room, too. No count that is made before there is a view bounds all of them: an eye within a face
//! sees as many rows as it likes. A view that wants more than there can be has the renderer load the model once more, for the
//! exact way (`renderer/load.rs`). The renderer keeps a copy of the model for that, which is why [`MOST_POINTS`] is a bound, too.

use super::around::Ball;
use super::cells::strips;
use super::data::stretch;
use crate::abi;
use crate::model::{Face, Mesh, Model, Part, Shape};
use crate::picture::{SceneSettings, TakenWay, TrimWay};
use crate::spline::Control;
use rayon::prelude::*;

/// Rows that the table is expected to have at most where [`TrimWay::Auto`] takes it.
const MOST_ROWS: f64 = (1u32 << 21) as f64;
/// Control points and corners of meshes: 64 MiB of points.
const MOST_POINTS: usize = 1 << 21;
/// Of the picture for which rows are counted: the ball around the scene is as wide.
const PICTURE_PX: f64 = 2048.0;
/// Between scan lines at the default tolerance.
const ROW_PX: f64 = 0.125;

/// How `settings` trim a model, never [`TrimWay::Auto`]; `None` where nothing of it is trimmed.
pub fn trim_way(model: &Model, settings: SceneSettings) -> Option<TrimWay> {
    let bodies = model.parts.iter().chain(operands(model).map(|(part, _)| part));
    let is_trimmed = bodies.flat_map(|part| &part.faces).any(|face| !face.loops.is_empty());
    is_trimmed.then(|| taken(model, settings).into())
}

/// The way that is asked for, or suits the model.
pub(super) fn taken(model: &Model, settings: SceneSettings) -> TakenWay {
    match settings.trim {
        TrimWay::Table => TakenWay::Table,
        TrimWay::Exact => TakenWay::Exact,
        #[cfg(feature = "rivals")]
        TrimWay::Rival(rival) => TakenWay::Rival(rival),
        TrimWay::Auto if settings.smooth_trims || !suits_table(model) => TakenWay::Exact,
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

/// That the trim table of a picture of the whole scene has, about.
fn rows(model: &Model) -> f64 {
    let Some(ball) = Ball::around(model.control_bounds()) else { return 0.0 };
    let lines_a_unit = PICTURE_PX / (2.0 * ball.radius) / ROW_PX;
    let of_part = |part: &Part| {
        let faces = part.faces.par_iter().filter(|face| !face.loops.is_empty());
        faces.map(rows_of).reduce(|| (0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
    };
    let parts: Vec<_> = model.parts.par_iter().map(of_part).collect();
    let placed = model.instances.iter().map(|i| (parts[i.part], stretch(i.transform.matrix3)));
    let operands = operands(model).map(|(part, scale)| (of_part(part), scale));
    placed.chain(operands).map(|((fewest, length), scale)| fewest + length * scale * lines_a_unit).sum()
}

/// Rows of a face however small it is seen, and lengths along which it has one more for each scan line.
fn rows_of(face: &Face) -> (f64, f64) {
    let (v0, v1) = face.surface.domain().1;
    let (_, knots) = face.surface.knots();
    let inner = knots.windows(2).filter(|pair| pair[0] < pair[1] && pair[0] >= v0 && pair[1] <= v1).count();
    let strips = strips(face, inner, TakenWay::Table);
    let face_strips = abi::Face { strips, ..Default::default() };
    let (strips, bays) = (f64::from(face_strips.strip_count()), f64::from(face_strips.bay_count()));
    let (count_u, count_v) = face.surface.counts();
    let at = |i: usize, j: usize| face.surface.points()[j * count_u + i].point();
    let column = |i: usize| (1..count_v).map(|j| at(i, j).distance(at(i, j - 1))).sum::<f64>();
    (bays * strips, bays * (0..count_u).map(column).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Budget;
    use crate::model::Instance;
    use crate::picture::FrameSettings;
    use glam::{DAffine3, DVec3};

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
        assert_eq!(trim_way(&bracket, SceneSettings { smooth_trims: true, ..auto }), Some(TrimWay::Exact));
        let mut plain = bracket.clone();
        plain.parts.iter_mut().flat_map(|p| &mut p.faces).for_each(|f| f.loops.clear());
        assert_eq!(trim_way(&plain, auto), None);
    }
}
