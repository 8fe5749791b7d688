//! Faces, edges, vertices, parts and points one after another, in the order of the model: what keys select without a
//! mouse. Points of a part are its vertices, then centres, then middles.

use super::PickFilter;
use crate::session::{Picked, PointKind, Session, World};
use glam::DVec2;
use selvedge::model::{Edge, Face};
use selvedge_geometry::edges::curve;
use selvedge_geometry::trim::LoopIndex;
use std::collections::BTreeSet;

/// Cells along a side of the grids whose middles are tried as a point of a face, coarse ones first.
const GRIDS: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// A kind of items.
#[derive(Clone, Copy)]
enum Kind {
    Face,
    Edge,
    Vertex,
    Part,
    Point,
}

/// The edges of a part that have a middle, with their numbers: a closed edge has none.
fn with_middle(world: &World, part: usize) -> impl Iterator<Item = (usize, &Edge)> {
    let all = world.edges_of(part).into_iter().flat_map(|edges| edges.edges.iter().enumerate());
    all.filter(|(_, edge)| edge.ends[0] != edge.ends[1] && !edge.curve.is_empty())
}

impl Kind {
    fn of(filter: PickFilter) -> Self {
        match filter {
            PickFilter::Any | PickFilter::Faces => Self::Face,
            PickFilter::Edges => Self::Edge,
            PickFilter::Vertices => Self::Vertex,
            PickFilter::Parts => Self::Part,
            PickFilter::Points => Self::Point,
        }
    }

    /// How many items of this kind an instance has. Edges and their points count once they are found.
    fn count(self, world: &World, instance: usize) -> usize {
        let part = world.model.instances[instance].part;
        let edges = world.edges_of(part);
        match self {
            Self::Face => world.model.parts[part].faces.len(),
            Self::Edge => edges.map_or(0, |edges| edges.edges.len()),
            Self::Vertex => edges.map_or(0, |edges| edges.vertices.len()),
            Self::Part => 1,
            Self::Point => {
                let vertices = edges.map_or(0, |edges| edges.vertices.len());
                vertices + world.centres_of(part).len() + with_middle(world, part).count()
            }
        }
    }

    /// The number of an item of this kind in its instance.
    fn number(self, world: &World, picked: &Picked) -> Option<usize> {
        let part = world.model.instances.get(picked.instance()?)?.part;
        let vertices = world.edges_of(part).map_or(0, |edges| edges.vertices.len());
        let centres = world.centres_of(part);
        match (self, *picked) {
            (Self::Face, Picked::Face { face, .. }) => Some(face),
            (Self::Edge, Picked::Edge { edge, .. }) => Some(edge),
            (Self::Vertex | Self::Point, Picked::Vertex { vertex, .. }) => Some(vertex),
            (Self::Point, Picked::Point { kind: PointKind::Centre, of, .. }) => {
                Some(vertices + centres.iter().position(|(edge, _)| *edge == of)?)
            }
            (Self::Point, Picked::Point { kind: PointKind::Middle, of, .. }) => {
                Some(vertices + centres.len() + with_middle(world, part).position(|(edge, _)| edge == of)?)
            }
            (Self::Part, Picked::Instance(_)) => Some(0),
            _ => None,
        }
    }

    /// An item of an instance, by its number; `None` where there is none.
    fn item(self, world: &World, instance: usize, nth: usize) -> Option<Picked> {
        let placed = world.model.instances.get(instance)?;
        let part = placed.part;
        Some(match self {
            Self::Face => Picked::Face { instance, face: nth, uv: inside(world.model.parts[part].faces.get(nth)?) },
            Self::Edge => Picked::Edge { instance, edge: nth },
            Self::Vertex => Picked::Vertex { instance, vertex: nth },
            Self::Part => Picked::Instance(instance),
            Self::Point => {
                let (vertices, centres) = (world.edges_of(part)?.vertices.len(), world.centres_of(part));
                let Some(nth) = nth.checked_sub(vertices) else {
                    return Some(Picked::Vertex { instance, vertex: nth });
                };
                let (kind, (of, at)) = match nth.checked_sub(centres.len()) {
                    None => (PointKind::Centre, centres[nth]),
                    Some(nth) => {
                        let (of, edge) = with_middle(world, part).nth(nth)?;
                        (PointKind::Middle, (of, curve::middle(edge, placed.transform)?))
                    }
                };
                Picked::Point { instance, kind, of, at }
            }
        })
    }
}

/// Replaces the item selected last by the next one of the filter's kind, or by the one before it; with `add` it stays
/// selected, too. Behind the model's last item comes its first one. An item of another kind leads to the items of its
/// part, none to those of the model. Hidden parts are left out. False where nothing of the kind is shown.
pub fn step(session: &mut Session, filter: PickFilter, back: bool, add: bool) -> bool {
    let (kind, last) = (Kind::of(filter), session.selection.last().copied());
    let from = last.and_then(|picked| Some((picked.instance()?, kind.number(&session.world, &picked))));
    let Some((instance, nth)) = next(&session.world, &session.scene.now().hidden, kind, from, back) else {
        return false;
    };
    let Some(item) = kind.item(&session.world, instance, nth) else { return false };
    if !add {
        session.selection.pop();
    }
    session.selection.retain(|held| !held.is_same(&item));
    session.selection.push(item);
    true
}

/// Instance and number of the item beside that of an instance, or of the first or the last one of the instance.
fn next(
    world: &World,
    hidden: &BTreeSet<usize>,
    kind: Kind,
    from: Option<(usize, Option<usize>)>,
    back: bool,
) -> Option<(usize, usize)> {
    let count = world.model.instances.len();
    let end = if back { count.checked_sub(1)? } else { 0 };
    let (start, nth) = from.filter(|(instance, _)| *instance < count).unwrap_or((end, None));
    let shown = |instance: usize| if hidden.contains(&instance) { 0 } else { kind.count(world, instance) };
    let own = if start < count { shown(start) } else { 0 };
    let beside = match nth {
        Some(nth) if back => nth.checked_sub(1),
        Some(nth) => Some(nth + 1),
        None if back => own.checked_sub(1),
        None => Some(0),
    };
    if let Some(nth) = beside.filter(|nth| *nth < own) {
        return Some((start, nth));
    }
    let mut around = (1..=count).map(|by| if back { (start + count - by) % count } else { (start + by) % count });
    around.find_map(|instance| {
        let last = shown(instance).checked_sub(1)?;
        Some((instance, if back { last } else { 0 }))
    })
}

/// A point that the loops keep, near the middle of them where it may be; the middle where grids find none.
fn inside(face: &Face) -> DVec2 {
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let whole = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let bounds = face.loops.iter().map(|trim_loop| trim_loop.bounds());
    let (low, high) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or(whole);
    let index = LoopIndex::new(&face.loops);
    let middles = |cells: u32| {
        let share = move |i: u32| (f64::from(i) + 0.5) / f64::from(cells);
        (0..cells).flat_map(move |j| (0..cells).map(move |i| DVec2::new(share(i), share(j))))
    };
    let mut all = GRIDS.into_iter().flat_map(middles).map(|share| low + share * (high - low));
    all.find(|uv| index.contains(*uv)).unwrap_or(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Loaded;
    use glam::DAffine3;
    use selvedge_geometry::edges::curve::CurveShape;
    use std::path::Path;
    use std::sync::Arc;

    fn session() -> Session {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        let mut session = Session::default();
        session.open(World::new(&[Arc::new(Loaded { path, import, partial: false })]));
        session.world.find_edges();
        session
    }

    /// Steps until the first item comes again, at most so often.
    fn around(session: &mut Session, filter: PickFilter, back: bool) -> Vec<Picked> {
        let mut all: Vec<Picked> = Vec::new();
        for _ in 0..100_000 {
            assert!(step(session, filter, back, false));
            let [item] = session.selection[..] else { panic!("{:?}", session.selection) };
            if all.first().is_some_and(|first| first.is_same(&item)) {
                return all;
            }
            all.push(item);
        }
        panic!("the first item does not come again");
    }

    #[test]
    fn each_item_comes_once_and_backwards_the_other_way_round() {
        let mut session = session();
        let world = Arc::clone(&session.world);
        let of_all =
            |count: &dyn Fn(usize) -> usize| world.model.instances.iter().map(|i| count(i.part)).sum::<usize>();
        let edges = |part: usize| world.edges_of(part).expect("found").edges.len();
        let vertices = |part: usize| world.edges_of(part).expect("found").vertices.len();
        // a round edge has a centre, and one with two ends a middle
        let points = |part: usize| {
            let edges = &world.edges_of(part).expect("found").edges;
            let open = edges.iter().filter(|edge| edge.ends[0] != edge.ends[1]).count();
            vertices(part) + world.centres_of(part).len() + open
        };
        let counts = [
            (PickFilter::Any, of_all(&|part: usize| world.model.parts[part].faces.len())),
            (PickFilter::Edges, of_all(&edges)),
            (PickFilter::Vertices, of_all(&vertices)),
            (PickFilter::Parts, world.model.instances.len()),
            (PickFilter::Points, of_all(&points)),
        ];
        for (filter, count) in counts {
            session.selection.clear();
            let forward = around(&mut session, filter, false);
            assert_eq!(forward.len(), count, "{filter:?}");
            session.selection.clear();
            let mut backward = around(&mut session, filter, true);
            backward.reverse();
            assert!(forward.iter().zip(&backward).all(|(a, b)| a.is_same(b)), "{filter:?}");
        }
    }

    #[test]
    fn points_are_those_of_the_model_and_two_of_them_are_measured() {
        let mut session = session();
        let all = around(&mut session, PickFilter::Points, false);
        let middle_of_line = |picked: &Picked| {
            let Picked::Point { instance, kind: PointKind::Middle, of, at } = *picked else { return None };
            let edges = session.world.edges_of(session.world.model.instances[instance].part)?;
            let edge = edges.edges.get(of)?;
            let is_line = matches!(curve::shape(edge, DAffine3::IDENTITY), CurveShape::Line(_));
            is_line.then(|| (at, edge.ends.map(|end| edges.vertices[end])))
        };
        let (at, [from, to]) = all.iter().find_map(middle_of_line).expect("a straight edge");
        // an edge ends at its vertices within the tolerance of the file
        assert!(at.distance(from.midpoint(to)) < 1e-6 * from.distance(to), "{at} between {from} and {to}");
        let is_centre = |picked: &&Picked| matches!(picked, Picked::Point { kind: PointKind::Centre, .. });
        let centre = *all.iter().find(is_centre).expect("a round edge");
        session.select(Some(centre), false);
        assert!(step(&mut session, PickFilter::Points, false, true));
        let [first, second] = session.selection[..] else { panic!("{:?}", session.selection) };
        assert!(first.is_same(&centre) && second.is_point());
    }

    #[test]
    fn hidden_parts_are_left_out_and_a_part_leads_to_its_faces() {
        let mut session = session();
        session.scene.change(|state| _ = state.hidden.insert(0));
        session.select(Some(Picked::Instance(2)), false);
        assert!(step(&mut session, PickFilter::Faces, false, false));
        assert!(matches!(session.selection[..], [Picked::Face { instance: 2, face: 0, .. }]));
        assert!(step(&mut session, PickFilter::Faces, false, true));
        assert!(matches!(session.selection[..], [Picked::Face { face: 0, .. }, Picked::Face { face: 1, .. }]));
        assert!(step(&mut session, PickFilter::Faces, false, false));
        assert!(matches!(session.selection[..], [Picked::Face { face: 0, .. }, Picked::Face { face: 2, .. }]));
        session.selection.clear();
        assert!(around(&mut session, PickFilter::Faces, false).iter().all(|picked| picked.instance() != Some(0)));
        let all = 0..session.world.model.instances.len();
        session.scene.change(|state| state.hidden.extend(all));
        assert!(!step(&mut session, PickFilter::Parts, false, false));
        assert!(!step(&mut Session::default(), PickFilter::Any, true, false), "nothing is open");
    }

    #[test]
    fn the_point_of_a_face_is_one_that_its_loops_keep() {
        let session = session();
        let faces: Vec<&Face> = session.world.model.parts.iter().flat_map(|part| &part.faces).collect();
        let (mut kept, mut moved) = (0, 0);
        for face in &faces {
            let ((u0, u1), (v0, v1)) = face.surface.domain();
            let (uv, middle) = (inside(face), 0.5 * DVec2::new(u0 + u1, v0 + v1));
            let index = LoopIndex::new(&face.loops);
            kept += usize::from(index.contains(uv));
            moved += usize::from(!index.contains(middle));
        }
        assert!(kept == faces.len() && moved > 0, "{kept} of {}, {moved} with a hole in the middle", faces.len());
    }
}
