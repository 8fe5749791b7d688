//! Placed parts that move, hide and change their colour between frames.

use super::Renderer;
use crate::model::{Colour, Coloured, Instance, ModelError};
use crate::scene::{InstanceError, Shown};
use glam::DAffine3;
use std::sync::Arc;

/// The scene lives: each of these changes one instance, an index into
/// [`Model::instances`](crate::model::Model::instances); the next frame recorded shows it. Frames in flight still draw it as
/// it was. None of them uploads anything else or waits. Each costs what the instance costs: its placement and 64 bytes, and
/// a box for each of its cells in the trim table.
///
/// The picture is that of the changed model, uploaded anew. What the upload chose for the model as it was stays: how its
/// faces are trimmed, and how finely trimmed faces are cut for a model of that size.
impl Renderer {
    /// Places an instance anew: part coordinates to model coordinates.
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_transform(&mut self, instance: usize, transform: DAffine3) -> Result<(), InstanceError> {
        self.change(instance, true, |placed, _| placed.transform = transform)
    }

    /// Shows or hides an instance, with its lines.
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_visible(&mut self, instance: usize, visible: bool) -> Result<(), InstanceError> {
        self.change(instance, true, |_, shown| shown.visible = visible)
    }

    /// Gives an instance a colour in place of those of its faces; `None`: theirs. Its opacity is 1.
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_colour(&mut self, instance: usize, colour: Option<Colour>) -> Result<(), InstanceError> {
        self.change(instance, false, |placed, _| placed.colour = colour)
    }

    /// Marks an instance by a colour over its own, as strong as its opacity; `None`: no mark.
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_selected(&mut self, instance: usize, highlight: Option<Colour>) -> Result<(), InstanceError> {
        let is_colour = |c: &Colour| c.iter().all(|x| (0.0..=1.0).contains(x));
        if highlight.is_some_and(|c| !is_colour(&c)) {
            return Err(ModelError::Colour { what: Coloured::Instance(instance) }.into());
        }
        self.change(instance, false, |_, shown| shown.highlight = highlight)
    }

    /// `moves`: where it is seen.
    fn change(
        &mut self,
        nth: usize,
        moves: bool,
        change: impl FnOnce(&mut Instance, &mut Shown),
    ) -> Result<(), InstanceError> {
        let (Some(source), Some(loaded)) = (&mut self.source, &mut self.loaded) else {
            panic!("upload a model before changing it")
        };
        let model = &source.model;
        let living = model.instances.get(nth).filter(|_| !source.models.is_free(nth));
        let mut placed = living.ok_or(InstanceError::NoSuchInstance(nth))?.clone();
        let mut shown = source.shown[nth];
        loaded.data.may_change(nth, moves)?;
        change(&mut placed, &mut shown);
        placed.check(nth, model.parts.len())?;
        let part = &model.parts[placed.part];
        // an open part has no inside, and is drawn opaque whatever its faces are
        let stays_opaque = || placed.is_opaque(part) || placed.colour.is_none() && !part.closed;
        if placed.colour != model.instances[nth].colour && !stays_opaque() {
            return Err(InstanceError::SeenThrough(nth));
        }
        match loaded.data.change(nth, &placed, shown) {
            Some(record) => {
                loaded.changes.insert(record.offset, record);
                source.moved();
            }
            None => source.forget(),
        }
        loaded.moved |= moves;
        Arc::make_mut(&mut source.model).instances[nth] = placed;
        source.shown[nth] = shown;
        Ok(())
    }
}
