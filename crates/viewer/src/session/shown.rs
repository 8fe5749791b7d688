//! The model that is drawn: the world in the session's state.

use super::World;
use glam::{DAffine3, DVec3};
use selvedge::model::{Bounds, Colour, Instance, Model, SolidError, TrimLoop};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A plane that cuts the model open: the side `normal · p <= offset` stays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Unit length.
    pub normal: DVec3,
    /// Model units.
    pub offset: f64,
    /// It cuts.
    pub on: bool,
}

impl Section {
    /// Across an axis, through the middle of the model.
    pub fn across(axis: DVec3, bounds: Bounds) -> Self {
        let middle = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
        Self { normal: axis, offset: axis.dot(middle), on: true }
    }

    /// The same plane, the other side stays.
    pub fn flipped(self) -> Self {
        Self { normal: -self.normal, offset: -self.offset, ..self }
    }

    /// Smallest and largest offset at which it passes through the box.
    pub fn range(&self, bounds: Bounds) -> (f64, f64) {
        let along = bounds.corners().map(|corner| self.normal.dot(corner));
        along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
    }
}

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
    /// Of each of its instances the number in the world.
    pub instances: Vec<usize>,
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
        for (&(part, face, trim_loop), changed) in &self.edits {
            let faces = model.parts.get_mut(part).map(|part| &mut part.faces);
            let loops = faces.and_then(|faces| faces.get_mut(face)).map(|face| &mut face.loops);
            if let Some(found) = loops.and_then(|loops| loops.get_mut(trim_loop)) {
                found.clone_from(changed);
            }
        }
    }

    /// The same state but for its trim loops.
    pub fn differs_in_loops_alone(&self, other: &Self) -> bool {
        Self { edits: BTreeMap::new(), ..self.clone() } == Self { edits: BTreeMap::new(), ..other.clone() }
    }

    /// The model that is drawn.
    pub fn show(&self, world: &World) -> Shown {
        let count = world.model.instances.len();
        let visible: Vec<usize> = (0..count).filter(|i| !self.hidden.contains(i)).collect();
        let mut model = Model {
            instances: visible.iter().map(|i| self.instance(*i, world)).collect(),
            solids: Vec::new(),
            ..world.model.clone()
        };
        let solids = world.model.solids.iter().enumerate();
        model.solids.extend(solids.filter(|(i, _)| !self.hidden.contains(&(count + i))).map(|(_, s)| s.clone()));
        self.edit(&mut model);
        let mut failed = None;
        for section in self.sections.iter().filter(|section| section.on) {
            match model.section(section.normal, section.offset) {
                Ok(cut) => model = cut,
                Err(error) => failed = Some(error),
            }
        }
        // a section omits the instances that it cuts away or makes solid; the others keep their order
        let mut left = visible.iter().peekable();
        let mut instances = Vec::with_capacity(model.instances.len());
        for placed in &model.instances {
            let same = |i: &usize| self.instance(*i, world) == *placed;
            while left.peek().is_some_and(|i| !same(i)) {
                left.next();
            }
            instances.extend(left.next().copied());
        }
        Shown { model, instances, failed }
    }

    /// An instance as it is drawn.
    fn instance(&self, number: usize, world: &World) -> Instance {
        let placed = &world.model.instances[number];
        let mut instance = placed.clone();
        instance.colour = self.colours.get(&number).copied().or(placed.colour);
        if self.clear.contains(&number) {
            let [r, g, b, _] = instance.colour.unwrap_or(selvedge::model::GREY);
            instance.colour = Some([r, g, b, CLEAR]);
        }
        instance.transform = self.moved(number, world) * placed.transform;
        instance
    }

    /// How the explosion moves an instance: away from the middle of the model.
    pub fn moved(&self, number: usize, world: &World) -> DAffine3 {
        if self.explosion == 0.0 {
            return DAffine3::IDENTITY;
        }
        let placed = &world.model.instances[number];
        let bounds = world.model.parts[placed.part].control_bounds();
        if bounds.is_empty() {
            return DAffine3::IDENTITY;
        }
        let centre = placed.transform.transform_point3(bounds.centre());
        DAffine3::from_translation((centre - world.bounds.centre()) * self.explosion)
    }
}

#[cfg(test)]
mod tests {
    use super::super::file::Loaded;
    use super::*;
    use std::path::Path;
    use std::sync::Arc;

    fn world() -> World {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        let loaded = Arc::new(Loaded { path, import });
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
        assert!(state.differs_in_loops_alone(&SceneState::default()));
        assert!(!state.differs_in_loops_alone(&SceneState { explosion: 0.5, ..SceneState::default() }));
        assert_eq!(SceneState::default().show(&world).model.parts[part].faces[face].loops[0], before);
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
