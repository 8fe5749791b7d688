//! Where the items of one world are in the next one: in the same file, by the same names, in the same order.
//!
//! ```text
//!   file a: bolt, bolt, plate ─read again─▶ bolt, nut, bolt       hidden: second bolt, plate ─▶ third item
//!   file b: ring              ─closed────▶
//! ```

use super::shown::LoopKey;
use super::{SceneState, World};
use selvedge::model::{Colour, TrimLoop};
use selvedge::spline::Surface;
use std::collections::{BTreeMap, VecDeque};

/// The way from one world's numbers to another's.
#[derive(Clone, Debug)]
pub struct Carried<'a> {
    before: &'a World,
    after: &'a World,
    /// Of each item, instances first and solids behind them.
    items: Vec<Option<usize>>,
    /// Of parts that are placed in both.
    parts: BTreeMap<usize, usize>,
}

impl<'a> Carried<'a> {
    /// From `before` to `after`.
    pub fn new(before: &'a World, after: &'a World) -> Self {
        let (count, count_after) = (before.model.instances.len(), after.model.instances.len());
        let items = vec![None; count + before.model.solids.len()];
        let mut carried = Self { before, after, items, parts: BTreeMap::new() };
        for file in &before.files {
            let Some(again) = after.files.iter().find(|other| other.path == file.path) else { continue };
            let mut places: BTreeMap<(&str, &str), VecDeque<usize>> = BTreeMap::new();
            for number in again.instances.clone() {
                places.entry(names(after, number)).or_default().push_back(number);
            }
            for number in file.instances.clone() {
                let place = places.get_mut(&names(before, number)).and_then(VecDeque::pop_front);
                carried.items[number] = place;
                if let Some(place) = place {
                    let part = before.model.instances[number].part;
                    carried.parts.entry(part).or_insert(after.model.instances[place].part);
                }
            }
            for (solid, place) in file.solids.clone().zip(again.solids.clone()) {
                carried.items[count + solid] = Some(count_after + place);
            }
        }
        carried
    }

    /// Whether every item and every part keeps its number.
    pub fn is_identity(&self) -> bool {
        let is_same = |(item, place): (usize, &Option<usize>)| *place == Some(item);
        self.items.iter().enumerate().all(is_same) && self.parts.iter().all(|(part, place)| part == place)
    }

    /// Whether every loop that a state edits has its number and its curves in both worlds, on the same surface.
    pub fn keeps_edits(&self, state: &SceneState) -> bool {
        state.edits.keys().all(|key| self.edited(*key) == Some(*key))
    }

    /// The number of an edited loop in the second world. `None` where the face has another surface or the loop other
    /// curves there: an edit replaces the whole loop, and would undo what the file has changed.
    fn edited(&self, key: LoopKey) -> Option<LoopKey> {
        let (part, face, trim_loop) = key;
        let there = (*self.parts.get(&part)?, face, trim_loop);
        (original(self.before, key)? == original(self.after, there)?).then_some(there)
    }

    /// A state of the first world in numbers of the second one, without what is not in it, and without edits of loops
    /// that are others in it.
    pub fn state(&self, before: &SceneState) -> SceneState {
        let place = |item: &usize| self.items.get(*item).copied().flatten();
        let coloured = |(item, colour): (&usize, &Colour)| Some((place(item)?, *colour));
        let edited = |(key, edit): (&LoopKey, &TrimLoop)| Some((self.edited(*key)?, edit.clone()));
        SceneState {
            hidden: before.hidden.iter().filter_map(place).collect(),
            clear: before.clear.iter().filter_map(place).collect(),
            colours: before.colours.iter().filter_map(coloured).collect(),
            sections: before.sections.clone(),
            explosion: before.explosion,
            edits: before.edits.iter().filter_map(edited).collect(),
        }
    }
}

/// A loop as the file has it, and the surface that it is on.
fn original(world: &World, (part, face, trim_loop): LoopKey) -> Option<(&Surface, &TrimLoop)> {
    let face = world.model.parts.get(part)?.faces.get(face)?;
    Some((&face.surface, face.loops.get(trim_loop)?))
}

fn names(world: &World, instance: usize) -> (&str, &str) {
    let placed = &world.model.instances[instance];
    (&placed.name, &world.model.parts[placed.part].name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::{Loaded, Session};
    use std::collections::BTreeSet;
    use std::path::Path;
    use std::sync::Arc;

    fn file(name: &str) -> Arc<Loaded> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
        let import = selvedge_io::import::open(&path).expect("a sample");
        Arc::new(Loaded { path, import, partial: false })
    }

    #[test]
    fn a_file_beside_others_changes_no_number() {
        let (assembly, bracket) = (file("assembly.step"), file("bracket.step"));
        let (one, two) = (World::new(&[Arc::clone(&assembly)]), World::new(&[assembly, bracket]));
        assert!(Carried::new(&one, &two).is_identity());
        assert!(Carried::new(&World::default(), &two).is_identity());
        assert!(!Carried::new(&two, &one).is_identity());
    }

    #[test]
    fn items_are_found_again_when_a_file_before_theirs_is_closed() {
        let (assembly, bracket) = (file("assembly.step"), file("bracket.step"));
        let (two, one) = (World::new(&[Arc::clone(&bracket), Arc::clone(&assembly)]), World::new(&[assembly]));
        let (first, part) = (bracket.import.model.instances.len(), bracket.import.model.parts.len());
        let curve = bracket.import.model.parts[0].faces.iter().find_map(|face| face.loops.first()).expect("a loop");
        let faces = &two.model.parts[part].faces;
        let face = faces.iter().position(|face| !face.loops.is_empty()).expect("a trimmed face");
        let red = [1.0, 0.0, 0.0, 1.0];
        let mut state = SceneState::default();
        state.hidden.extend([0, first + 2]);
        state.clear.insert(first + 1);
        state.colours.extend([(0, red), (first + 3, red)]);
        state.edits.extend([((0, 0, 0), curve.clone()), ((part, face, 0), curve.clone())]);
        let carried = Carried::new(&two, &one).state(&state);
        assert_eq!((carried.hidden, carried.clear), (BTreeSet::from([2]), BTreeSet::from([1])));
        assert_eq!(carried.colours, BTreeMap::from([(3, red)]));
        assert_eq!(carried.edits.into_keys().collect::<Vec<_>>(), [(0, face, 0)]);
    }

    /// A part that comes before the others moves their numbers, and one that goes takes its state with it.
    #[test]
    fn items_are_found_again_by_their_names() {
        let loaded = file("assembly.step");
        let before = World::new(&[Arc::clone(&loaded)]);
        let mut import = loaded.import.clone();
        let gone = import.model.instances.remove(0);
        let name = "another".to_owned();
        import.model.instances.insert(1, selvedge::model::Instance { name, ..gone });
        let after = World::new(&[Arc::new(Loaded { path: loaded.path.clone(), import, partial: false })]);
        let mut state = SceneState::default();
        state.hidden.extend([0, 1, 2]);
        assert_eq!(Carried::new(&before, &after).state(&state).hidden, BTreeSet::from([0, 2]));
    }

    /// All instances have their numbers from the first preview on.
    #[test]
    fn the_state_of_a_preview_is_that_of_the_whole() {
        let whole = file("assembly.step");
        let mut import = whole.import.clone();
        let done = import.model.instances[0].part;
        let rest = import.model.parts.iter_mut().enumerate().filter(|(part, _)| *part != done);
        rest.for_each(|(_, part)| part.faces.clear());
        let faces = &import.model.parts[done].faces;
        let face = faces.iter().position(|face| !face.loops.is_empty()).expect("a trimmed face");
        let curve = &faces[face].loops[0];
        let edit = curve.with_point(0, 0, curve.curves().next().expect("a curve").point(0.0) + 0.01).expect("a loop");
        let mut session = Session::default();
        session.open(World::new(&[Arc::new(Loaded { path: whole.path.clone(), import, partial: true })]));
        assert!(session.world.is_partial() && !session.world.files[0].complete);
        session.scene.change(|state| _ = state.hidden.insert(1));
        session.scene.change(|state| _ = state.edits.insert((done, face, 0), edit));
        let before = session.scene.clone();
        assert_eq!((session.open(World::new(&[whole])), session.scene == before), (0, true));
        assert!(!session.world.is_partial());
    }

    /// An edit belongs to a loop, not to a number.
    #[test]
    fn edits_of_loops_that_the_file_has_changed_go() {
        let loaded = file("assembly.step");
        let world = |import: &selvedge_io::import::Import| {
            World::new(&[Arc::new(Loaded { path: loaded.path.clone(), import: import.clone(), partial: false })])
        };
        let part = loaded.import.model.instances[0].part;
        let faces = &loaded.import.model.parts[part].faces;
        let trimmed: Vec<usize> = (0..faces.len()).filter(|face| !faces[*face].loops.is_empty()).collect();
        let (first, second) = (trimmed[0], trimmed[1]);
        let curve = &faces[first].loops[0];
        let edit = curve.with_point(0, 0, curve.curves().next().expect("a curve").point(0.0) + 0.01).expect("a loop");

        let mut session = Session::default();
        session.open(world(&loaded.import));
        session.scene.change(|state| {
            state.edits.extend([((part, first, 0), edit.clone()), ((part, second, 0), edit.clone())]);
        });
        assert_eq!((session.open(world(&loaded.import)), session.scene.has()), (0, (true, false)), "nothing differs");
        let mut changed = loaded.import.clone();
        changed.model.parts[part].faces[first].loops[0] = edit.clone();
        assert_eq!((session.open(world(&changed)), session.scene.has()), (1, (false, false)));
        let kept: Vec<_> = session.scene.now().edits.keys().copied().collect();
        assert_eq!(kept, [(part, second, 0)]);

        // redo would bring the edit back
        session.scene.change(|state| _ = state.edits.insert((part, first, 0), edit.clone()));
        assert!(session.scene.undo());
        assert_eq!((session.open(world(&loaded.import)), session.scene.has()), (0, (false, false)));
        // another surface under the same curves
        let surface = &faces[second].surface;
        let raised = surface.points().iter().map(|p| *p + glam::DVec4::Z * p.w).collect();
        let (u, v) = surface.knots();
        let mut changed = loaded.import.clone();
        changed.model.parts[part].faces[second].surface =
            Surface::new(surface.degrees(), u.to_vec(), v.to_vec(), raised).expect("a surface");
        assert_eq!(session.open(world(&changed)), 1);
    }
}
