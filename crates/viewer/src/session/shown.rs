//! The model that is drawn: the world in the session's state.

use super::{Section, World};
use glam::DAffine3;
use selvedge::model::{Bounds, Colour, Instance, Model, SolidError, TrimLoop};
use std::collections::{BTreeMap, BTreeSet};

/// How the world is shown.
///
/// Items are numbered as the tree has them: instances first, Boolean solids behind them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneState {
    /// Items that are not shown.
    pub hidden: BTreeSet<usize>,
    /// Transparent instances.
    pub clear: BTreeSet<usize>,
    /// Instances that have another colour.
    pub colours: BTreeMap<usize, Colour>,
    /// Planes that cut it open, three at most.
    pub sections: Vec<Section>,
    /// How far parts are moved apart: 0 not at all, 1 by half the model's size.
    pub explosion: f64,
    /// Trim loops that were changed: of a part, a face, a loop.
    pub edits: BTreeMap<LoopKey, TrimLoop>,
}

/// Numbers of a part, of a face of it, of a loop of that.
pub type LoopKey = (usize, usize, usize);

/// Most sections at a time.
pub const MOST_SECTIONS: usize = 3;
/// Opacity of transparent instances.
const CLEAR: f32 = 0.25;

/// The model that is drawn.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// For the engine.
    pub model: Model,
    /// Of each of its instances the number in the world, in ascending order.
    pub instances: Vec<usize>,
    /// Its instances that are not shown.
    pub hidden: BTreeSet<usize>,
    /// Why a section is not cut.
    pub failed: Option<SolidError>,
}

impl SceneState {
    /// Shows an item, or hides it.
    pub fn set_hidden(&mut self, item: usize, hidden: bool) {
        if hidden {
            self.hidden.insert(item)
        } else {
            self.hidden.remove(&item)
        };
    }

    /// Hides everything but these.
    pub fn isolate(&mut self, items: &[usize], world: &World) {
        let all = world.model.instances.len() + world.model.solids.len();
        self.hidden = (0..all).filter(|item| !items.contains(item)).collect();
    }

    /// A model with the trim loops that were changed.
    pub fn edit(&self, model: &mut Model) {
        self.edit_with(model, |_, changed| changed.clone());
    }

    /// The same for a file. A moved curve is no edge of the source any more: a writer would take it for the edge of the
    /// face beside it, whatever the distance, and write one curve for both.
    pub fn edit_for_file(&self, model: &mut Model) {
        self.edit_with(model, apart);
    }

    fn edit_with(&self, model: &mut Model, edited: impl Fn(&TrimLoop, &TrimLoop) -> TrimLoop) {
        for (&(part, face, trim_loop), changed) in &self.edits {
            let faces = model.parts.get_mut(part).map(|part| &mut part.faces);
            let loops = faces.and_then(|faces| faces.get_mut(face)).map(|face| &mut face.loops);
            if let Some(found) = loops.and_then(|loops| loops.get_mut(trim_loop)) {
                *found = edited(found, changed);
            }
        }
    }

    /// The model of what is shown, and of nothing else.
    pub fn show(&self, world: &World) -> Shown {
        let count = world.model.instances.len();
        self.show_these((0..count).filter(|i| !self.hidden.contains(i)).collect(), world)
    }

    /// The same with hidden instances in it that the engine hides and shows in place. A section cuts whatever is in the
    /// model, so with one hidden instances are left out.
    pub fn show_and_hide(&self, world: &World) -> Shown {
        if self.is_cut() {
            return self.show(world);
        }
        let stays = |number: usize| {
            let placed = self.instance(number, world);
            let part = &world.model.parts[placed.part];
            !self.hidden.contains(&number) || !part.closed || placed.is_opaque(part)
        };
        let chosen = (0..world.model.instances.len()).filter(|number| stays(*number)).collect();
        let shown = self.show_these(chosen, world);
        let numbers = shown.instances.iter().enumerate();
        let hidden = numbers.filter(|(_, number)| self.hidden.contains(*number)).map(|(nth, _)| nth).collect();
        Shown { hidden, ..shown }
    }

    /// Whether a section cuts the model.
    pub fn is_cut(&self) -> bool {
        self.sections.iter().any(|section| section.on)
    }

    /// These instances, and the solids that are not hidden.
    fn show_these(&self, chosen: Vec<usize>, world: &World) -> Shown {
        let count = world.model.instances.len();
        let mut model = Model {
            instances: chosen.iter().map(|i| self.instance(*i, world)).collect(),
            solids: Vec::new(),
            ..world.model.clone()
        };
        let solids = world.model.solids.iter().enumerate();
        model.solids.extend(solids.filter(|(i, _)| !self.hidden.contains(&(count + i))).map(|(_, s)| s.clone()));
        self.edit(&mut model);
        if !self.is_cut() {
            return Shown { model, instances: chosen, ..Shown::default() };
        }
        let mut failed = None;
        for section in self.sections.iter().filter(|section| section.on) {
            match model.section(section.normal, section.offset) {
                Ok(cut) => model = cut,
                Err(error) => failed = Some(error),
            }
        }
        // a section omits the instances that it cuts away or makes solid; the others keep their order
        let mut left = chosen.iter().peekable();
        let mut instances = Vec::with_capacity(model.instances.len());
        for placed in &model.instances {
            let same = |i: &usize| self.instance(*i, world) == *placed;
            while left.peek().is_some_and(|i| !same(i)) {
                left.next();
            }
            instances.extend(left.next().copied());
        }
        Shown { model, instances, hidden: BTreeSet::new(), failed }
    }

    /// An instance as it is drawn.
    pub fn instance(&self, number: usize, world: &World) -> Instance {
        let placed = &world.model.instances[number];
        let mut instance = placed.clone();
        instance.colour = self.colours.get(&number).copied().or(placed.colour);
        if self.clear.contains(&number) {
            let [r, g, b, _] = instance.colour.unwrap_or(selvedge::model::GREY);
            instance.colour = Some([r, g, b, CLEAR]);
        }
        instance.transform = self.placement(number, world);
        instance
    }

    /// Where an instance is drawn: part coordinates to model coordinates.
    pub fn placement(&self, number: usize, world: &World) -> DAffine3 {
        self.moved(number, world) * world.model.instances[number].transform
    }

    /// A box around everything drawn.
    pub fn bounds(&self, world: &World) -> Bounds {
        if world.bounds.is_empty() || self.explosion == 0.0 {
            return world.bounds;
        }
        let of_instance = |(number, placed): (usize, &Instance)| {
            let corners = world.part_bounds(placed.part).corners().map(|p| placed.transform.transform_point3(p));
            let own = corners.into_iter().fold(Bounds::EMPTY, Bounds::with);
            // control points may lie far outside of what is drawn
            let own = Bounds { min: own.min.max(world.bounds.min), max: own.max.min(world.bounds.max) };
            let by = self.moved(number, world).translation;
            Bounds { min: own.min + by, max: own.max + by }
        };
        let all = world.model.instances.iter().enumerate();
        let some = all.filter(|(_, placed)| !world.part_bounds(placed.part).is_empty());
        some.map(of_instance).fold(world.bounds, Bounds::union)
    }

    /// How the explosion moves an instance: away from the middle of the model.
    pub fn moved(&self, number: usize, world: &World) -> DAffine3 {
        if self.explosion == 0.0 {
            return DAffine3::IDENTITY;
        }
        let placed = &world.model.instances[number];
        let bounds = world.part_bounds(placed.part);
        if bounds.is_empty() {
            return DAffine3::IDENTITY;
        }
        let centre = placed.transform.transform_point3(bounds.centre());
        DAffine3::from_translation((centre - world.bounds.centre()) * self.explosion)
    }
}

/// A changed loop. Curves of an edge of the source do not name it any more if one of them is moved.
fn apart(original: &TrimLoop, changed: &TrimLoop) -> TrimLoop {
    let curves = original.curves().zip(changed.curves()).zip(changed.edges());
    let moved: BTreeSet<u32> =
        curves.filter(|((a, b), _)| a != b).filter_map(|(_, edge)| Some((*edge)?.edge)).collect();
    let edges = changed.edges().iter().map(|edge| edge.filter(|edge| !moved.contains(&edge.edge)));
    // as many as before
    changed.clone().with_edges(edges.collect()).unwrap_or_else(|_| changed.clone().without_edges())
}

#[cfg(test)]
mod tests {
    use super::super::file::Loaded;
    use super::*;
    use glam::DVec3;
    use std::path::Path;
    use std::sync::Arc;

    fn world() -> World {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        let loaded = Arc::new(Loaded { path, import, partial: false });
        World::new(&[Arc::clone(&loaded), loaded])
    }

    #[test]
    fn files_stand_side_by_side() {
        let world = world();
        let half = world.model.instances.len() / 2;
        assert!(half > 1);
        assert_eq!([world.files[0].instances.clone(), world.files[1].instances.clone()], [0..half, half..2 * half]);
        assert_eq!(world.model.check(), Ok(()));
        // numbers of edges lead to the second file's parts, too
        world.find_edges();
        let parts = world.model.parts.len();
        let counts: Vec<usize> = (0..parts).map(|p| world.edges_of(p).expect("found").edges.len()).collect();
        let last: usize = counts.iter().sum();
        assert_eq!(world.edge(1), Some((0, 0)));
        assert_eq!(world.edge(counts[0] as u32 + 1), Some((1, 0)));
        assert_eq!(world.edge(last as u32), Some((parts - 1, counts[parts - 1] - 1)));
        assert_eq!((world.edge(0), world.edge(last as u32 + 1)), (None, None));
    }

    #[test]
    fn each_face_is_found_by_its_number() {
        let world = world();
        for (part, of_part) in world.model.parts.iter().enumerate() {
            for face in &of_part.faces {
                let first = of_part.faces.iter().position(|other| other.id == face.id);
                assert_eq!(world.face(part, face.id), first);
            }
        }
        assert_eq!(world.face(world.model.parts.len(), 1), None);
    }

    #[test]
    fn what_is_hidden_is_not_drawn_and_the_rest_is_known_again() {
        let world = world();
        let mut state = SceneState::default();
        state.set_hidden(1, true);
        let shown = state.show(&world);
        let expected: Vec<usize> = (0..world.model.instances.len()).filter(|i| *i != 1).collect();
        assert_eq!((shown.instances, shown.model.instances.len()), (expected.clone(), expected.len()));
        state.isolate(&[2], &world);
        assert_eq!(state.show(&world).instances, [2]);
    }

    #[test]
    fn hidden_instances_stay_in_the_model_unless_rays_or_a_section_need_them_gone() {
        let world = world();
        let count = world.model.instances.len();
        let mut state = SceneState::default();
        state.hidden.extend([1, 2]);
        let shown = state.show_and_hide(&world);
        let all: Vec<usize> = (0..count).collect();
        assert_eq!((shown.instances, shown.hidden), (all, BTreeSet::from([1, 2])));
        // the engine follows rays through a closed part of glass, and hides none
        assert!(world.model.parts[world.model.instances[1].part].closed);
        state.clear.insert(1);
        let shown = state.show_and_hide(&world);
        let expected: Vec<usize> = (0..count).filter(|i| *i != 1).collect();
        assert_eq!((shown.instances, shown.hidden), (expected, BTreeSet::from([1])));
        let mut section = Section::across(DVec3::X, world.bounds);
        section.offset = section.range(world.bounds).1 + 1.0;
        state.sections = vec![section];
        let shown = state.show_and_hide(&world);
        assert!(shown.hidden.is_empty() && shown.instances == state.show(&world).instances);
        assert!(!shown.instances.contains(&2));
    }

    #[test]
    fn what_is_moved_apart_stays_within_its_bounds() {
        let world = world();
        let state = SceneState { explosion: 0.7, ..SceneState::default() };
        let (bounds, drawn) = (state.bounds(&world), state.show(&world).model.bounds());
        // a face may be beyond its box by a hundred-thousandth of the diagonal (`Face::bounds`)
        let room = DVec3::splat(2e-5 * bounds.diagonal());
        assert!((drawn.min + room).cmpge(bounds.min).all(), "{drawn:?} is beyond {bounds:?}");
        assert!((drawn.max - room).cmple(bounds.max).all(), "{drawn:?} is beyond {bounds:?}");
        assert!(drawn.diagonal() > 1.1 * world.bounds.diagonal(), "the parts are apart");
        assert_eq!(SceneState::default().bounds(&world), world.bounds);
    }

    #[test]
    fn colours_and_glass_are_those_of_the_instance_alone() {
        let world = world();
        let red = [1.0, 0.0, 0.0, 1.0];
        let mut state = SceneState::default();
        state.colours.insert(0, red);
        state.clear.extend([0, 1]);
        let shown = state.show(&world).model;
        assert_eq!(shown.instances[0].colour, Some([1.0, 0.0, 0.0, CLEAR]));
        assert_eq!(shown.instances[1].colour.map(|c| c[3]), Some(CLEAR));
        assert_eq!(shown.instances[2].colour, world.model.instances[2].colour);
    }

    #[test]
    fn changed_loops_are_drawn_and_undone() {
        let world = world();
        let (part, face) = (0..world.model.parts.len())
            .flat_map(|p| (0..world.model.parts[p].faces.len()).map(move |f| (p, f)))
            .find(|(p, f)| !world.model.parts[*p].faces[*f].loops.is_empty())
            .expect("a trimmed face");
        let before = world.model.parts[part].faces[face].loops[0].clone();
        let to = before.curves().next().expect("a curve").point(0.0) + 0.01;
        let after = before.with_point(0, 0, to).expect("a loop");
        let mut state = SceneState::default();
        state.edits.insert((part, face, 0), after.clone());
        state.edits.insert((part, face, 999), after.clone());
        assert_eq!(state.show(&world).model.parts[part].faces[face].loops[0], after);
        assert_eq!(SceneState::default().show(&world).model.parts[part].faces[face].loops[0], before);
        let mut saved = world.model.clone();
        state.edit_for_file(&mut saved);
        let saved = &saved.parts[part].faces[face].loops[0];
        let named = |trim_loop: &TrimLoop| trim_loop.edges().iter().flatten().count();
        assert!(saved.curves().eq(after.curves()) && named(saved) < named(&after), "the moved curve names its edge");
    }

    #[test]
    fn a_section_leaves_instances_that_are_known_again() {
        let world = world();
        let mut section = Section::across(DVec3::X, world.bounds);
        let (low, high) = section.range(world.bounds);
        assert!(low < section.offset && section.offset < high);
        let mut state = SceneState { sections: vec![section], ..SceneState::default() };
        let shown = state.show(&world);
        assert!(shown.failed.is_none() && !shown.model.solids.is_empty());
        for (drawn, number) in shown.model.instances.iter().zip(&shown.instances) {
            assert_eq!(drawn.transform, world.model.instances[*number].transform);
        }
        section.on = false;
        state.sections = vec![section];
        assert!(state.show(&world).model.solids.is_empty());
        assert_eq!(section.flipped().flipped(), section);
    }
}
