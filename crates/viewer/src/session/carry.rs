//! Where the items of one world are in the next one: in the same file, by the same names, in the same order.
//!
//! ```text
//!   file a: bolt, bolt, plate ─read again─▶ bolt, nut, bolt       hidden: second bolt, plate ─▶ third item
//!   file b: ring              ─closed────▶
//! ```

use super::shown::LoopKey;
use super::{SceneState, World};
use selvedge::model::{Colour, TrimLoop};
use std::collections::{BTreeMap, VecDeque};

/// The way from one world's numbers to another's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Carried {
    /// Of each item, instances first and solids behind them.
    items: Vec<Option<usize>>,
    /// Of parts that are placed in both.
    parts: BTreeMap<usize, usize>,
}

impl Carried {
    /// From `before` to `after`.
    pub fn new(before: &World, after: &World) -> Self {
        let (count, count_after) = (before.model.instances.len(), after.model.instances.len());
        let mut carried = Self { items: vec![None; count + before.model.solids.len()], parts: BTreeMap::new() };
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

    /// A state of the first world in numbers of the second one, without what is not in it.
    pub fn state(&self, before: &SceneState) -> SceneState {
        let place = |item: &usize| self.items.get(*item).copied().flatten();
        let coloured = |(item, colour): (&usize, &Colour)| Some((place(item)?, *colour));
        let edited = |(key, edit): (&LoopKey, &TrimLoop)| {
            let (part, face, trim_loop) = *key;
            Some(((*self.parts.get(&part)?, face, trim_loop), edit.clone()))
        };
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

fn names(world: &World, instance: usize) -> (&str, &str) {
    let placed = &world.model.instances[instance];
    (&placed.name, &world.model.parts[placed.part].name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Loaded;
    use std::collections::BTreeSet;
    use std::path::Path;
    use std::sync::Arc;

    fn file(name: &str) -> Arc<Loaded> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
        let import = selvedge_io::import::open(&path).expect("a sample");
        Arc::new(Loaded { path, import })
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
        let red = [1.0, 0.0, 0.0, 1.0];
        let mut state = SceneState::default();
        state.hidden.extend([0, first + 2]);
        state.clear.insert(first + 1);
        state.colours.extend([(0, red), (first + 3, red)]);
        state.edits.extend([((0, 0, 0), curve.clone()), ((part, 1, 0), curve.clone())]);
        let carried = Carried::new(&two, &one).state(&state);
        assert_eq!((carried.hidden, carried.clear), (BTreeSet::from([2]), BTreeSet::from([1])));
        assert_eq!(carried.colours, BTreeMap::from([(3, red)]));
        assert_eq!(carried.edits.into_keys().collect::<Vec<_>>(), [(0, 1, 0)]);
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
        let after = World::new(&[Arc::new(Loaded { path: loaded.path.clone(), import })]);
        let mut state = SceneState::default();
        state.hidden.extend([0, 1, 2]);
        assert_eq!(Carried::new(&before, &after).state(&state).hidden, BTreeSet::from([0, 2]));
    }
}
