//! Open files and the state of the scene: visibility, colours, sections, selection; plain data without a window.
//!
//! ```text
//!   files, previews ─merge─▶ World: one model, the parts of each file, edges of each part
//!                     │
//!   SceneState ───────┴─show─▶ Shown: the model that is drawn, and the world's instance of each of its own
//!   (hidden, see-through, colours, sections, explosion; undone and redone)
//! ```

pub mod carry;
pub mod file;
pub mod joiner;
pub mod loads;
pub mod picked;
pub mod schedule;
pub mod section;
pub mod shown;
pub mod undo;
pub mod world;

pub use carry::Carried;
pub use file::{Finder, Loaded, Loader, LoaderEvent};
pub use joiner::{Joiner, JoinerEvent};
pub use loads::{Ended, Loads, News};
pub use picked::{Picked, PointKind};
pub use section::Section;
pub use shown::{SceneState, Shown};
pub use undo::History;
pub use world::{FilePart, World};

use selvedge::model::{Colour, GREY};
use std::sync::Arc;

/// The state of a session, without the window.
#[derive(Debug, Default)]
pub struct Session {
    /// The open files.
    pub world: Arc<World>,
    /// How they are shown; changes can be undone and redone.
    pub scene: History<SceneState>,
    /// The selection, in the order of clicks.
    pub selection: Vec<Picked>,
}

impl Session {
    /// Replaces the open files. Hidden, coloured and edited items stay so, found again by their names, and sections
    /// stay. Edited loops whose original is another one now, or is gone, lose their edits; returns how many. Earlier
    /// states can be undone as long as no item has another number, and none of them edits such a loop. The selection is
    /// cleared.
    pub fn open(&mut self, world: impl Into<Arc<World>>) -> usize {
        let world = world.into();
        let carried = Carried::new(&self.world, &world);
        let edits = self.scene.now().edits.len();
        if !carried.is_identity() || !self.scene.states().all(|state| carried.keeps_edits(state)) {
            self.scene = History::new(carried.state(self.scene.now()));
        }
        self.world = world;
        self.selection.clear();
        edits - self.scene.now().edits.len()
    }

    /// A click: replaces the selection, or adds an item to it or removes it.
    pub fn select(&mut self, picked: Option<Picked>, add: bool) {
        if !add {
            self.selection.clear();
            self.selection.extend(picked);
            return;
        }
        let Some(picked) = picked else { return };
        match self.selection.iter().position(|held| held.is_same(&picked)) {
            Some(held) => drop(self.selection.remove(held)),
            None => self.selection.push(picked),
        }
    }

    /// A click on a point to measure from or to: a second point joins the first, a third one begins anew.
    pub fn select_point(&mut self, picked: Option<Picked>, add: bool) {
        let joins = picked.is_some() && matches!(self.selection[..], [first] if first.is_point());
        self.select(picked, add || joins);
    }

    /// The selected items of the tree.
    pub fn selected_instances(&self) -> Vec<usize> {
        let mut all: Vec<usize> = self.selection.iter().filter_map(Picked::instance).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The colour of an instance; of one whose faces have their own, that of the first such face.
    pub fn colour(&self, instance: usize) -> Colour {
        let placed = &self.world.model.instances[instance];
        let own = || self.world.model.parts[placed.part].faces.iter().find_map(|face| face.colour);
        let changed = self.scene.now().colours.get(&instance).copied();
        changed.or(placed.colour).or_else(own).unwrap_or(GREY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn a_click_replaces_and_shift_adds_and_takes_away() {
        let face = |face, u| Picked::Face { instance: 0, face, uv: DVec2::new(u, 0.0) };
        let mut session = Session::default();
        session.select(Some(face(1, 0.1)), false);
        session.select(Some(face(2, 0.2)), true);
        assert_eq!(session.selection.len(), 2);
        session.select(Some(face(1, 0.7)), true);
        assert_eq!(session.selection, [face(2, 0.2)]);
        session.select(None, true);
        assert_eq!(session.selection.len(), 1);
        session.select(Some(Picked::Instance(3)), false);
        assert_eq!((session.selection.len(), session.selected_instances()), (1, vec![3]));
        session.select(None, false);
        assert!(session.selection.is_empty());
    }

    #[test]
    fn two_clicks_select_two_points_and_a_third_begins_anew() {
        let point = |x| Picked::Point { instance: 0, kind: PointKind::OnFace, of: 4, at: DVec3::X * x };
        let (a, b, vertex) = (point(1.0), point(2.0), Picked::Vertex { instance: 0, vertex: 7 });
        let mut session = Session::default();
        session.select(Some(Picked::Instance(3)), false);
        let mut after = |picked: Option<Picked>, add: bool| {
            session.select_point(picked, add);
            session.selection.clone()
        };
        assert_eq!(after(Some(a), false), [a], "a part is no point to join");
        assert_eq!(after(Some(vertex), false), [a, vertex]);
        assert_eq!(after(Some(b), false), [b]);
        assert_eq!(after(Some(a), true), [b, a]);
        assert_eq!(after(Some(vertex), true), [b, a, vertex]);
        assert_eq!(after(None, false), []);
        assert_eq!(after(Some(a), false), [a]);
        assert_eq!(after(Some(a), false), [], "the same point again takes it away");
    }
}
