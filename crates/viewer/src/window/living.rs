//! Changes of a scene in place: instances that are hidden, coloured or moved, and edited loops.
//!
//! ```text
//!   state before, state after ─▶ what differs ─▶ set_visible, set_colour, set_transform, edit_loop of the renderer
//!        └─ a section, a part to see through, a solid ─▶ an upload
//! ```

use crate::session::{SceneState, World};
use selvedge::model::LoopAt;
use selvedge::renderer::{EditError, InstanceError, Renderer};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The instances of the renderer's model.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Of each the number in the world, in ascending order.
    pub instances: Arc<[usize]>,
    /// Those that are hidden.
    pub hidden: BTreeSet<usize>,
}

/// Why only an upload shows a state.
#[derive(Debug, thiserror::Error)]
pub enum WantsUpload {
    #[error("sections, or what is seen through, differ")]
    Shape,
    #[error("item {0} is not in the model")]
    Missing(usize),
    #[error("loops are not editable")]
    Loops,
    #[error(transparent)]
    Instance(#[from] InstanceError),
    #[error(transparent)]
    Edit(#[from] EditError),
}

/// The way from one state to another.
#[derive(Clone, Copy, Debug)]
pub struct Change<'a> {
    pub world: &'a World,
    pub before: &'a SceneState,
    pub after: &'a SceneState,
}

impl Change<'_> {
    /// Makes it in the renderer, whose loops may be `editable`.
    ///
    /// # Errors
    /// [`WantsUpload`]; the scene may be between both states.
    pub fn apply(self, renderer: &mut Renderer, placed: &mut Placed, editable: bool) -> Result<(), WantsUpload> {
        let Self { world, before, after } = self;
        let cuts = |state: &SceneState| state.sections.iter().copied().filter(|s| s.on).collect::<Vec<_>>();
        let moves = before.explosion != after.explosion;
        if before.clear != after.clear || cuts(before) != cuts(after) || moves && after.is_cut() {
            return Err(WantsUpload::Shape);
        }
        if before.edits != after.edits {
            self.edit(renderer, editable)?;
        }
        let differ = |number: &usize| before.colours.get(number) != after.colours.get(number);
        let both: BTreeSet<usize> = before.colours.keys().chain(after.colours.keys()).copied().collect();
        for number in both.into_iter().filter(differ) {
            if let Some(nth) = self.number_of(number, placed)? {
                renderer.set_colour(nth, after.instance(number, world).colour)?;
            }
        }
        if moves {
            for (nth, number) in placed.instances.iter().enumerate() {
                renderer.set_transform(nth, after.placement(*number, world))?;
            }
        }
        for number in before.hidden.symmetric_difference(&after.hidden) {
            let Some(nth) = self.number_of(*number, placed)? else { continue };
            let visible = !after.hidden.contains(number);
            renderer.set_visible(nth, visible)?;
            if visible {
                placed.hidden.remove(&nth)
            } else {
                placed.hidden.insert(nth)
            };
        }
        Ok(())
    }

    /// The number of an item in the renderer's model; `None` where it is in neither state.
    fn number_of(self, item: usize, placed: &Placed) -> Result<Option<usize>, WantsUpload> {
        match placed.instances.binary_search(&item) {
            Ok(nth) => Ok(Some(nth)),
            Err(_) if self.before.hidden.contains(&item) && self.after.hidden.contains(&item) => Ok(None),
            Err(_) => Err(WantsUpload::Missing(item)),
        }
    }

    fn edit(self, renderer: &mut Renderer, editable: bool) -> Result<(), WantsUpload> {
        if !editable {
            return Err(WantsUpload::Loops);
        }
        let (before, after) = (&self.before.edits, &self.after.edits);
        let both: BTreeSet<_> = before.keys().chain(after.keys()).copied().collect();
        for key in both.into_iter().filter(|key| before.get(key) != after.get(key)) {
            let (part, face, trim_loop) = key;
            let faces = self.world.model.parts.get(part).map(|part| &part.faces);
            let original = faces.and_then(|faces| faces.get(face)?.loops.get(trim_loop));
            if let Some(wanted) = after.get(&key).or(original).filter(|_| original.is_some()) {
                renderer.edit_loop(LoopAt { part, face, trim_loop }, wanted)?;
            }
        }
        Ok(())
    }
}
