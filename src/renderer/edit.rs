//! Trim loops edited between frames.

use super::{EditError, Renderer};
use crate::model::{LoopAt, TrimLoop};
use glam::DVec2;
use std::sync::Arc;

impl Renderer {
    /// Moves one control point of a trim loop to `to` in the `(u, v)` of its face; the next frame recorded
    /// shows it. Frames in flight still draw the loop as it was.
    ///
    /// Costs what the loop and its face cost: no other face is touched or sent again.
    ///
    /// # Errors
    /// [`EditError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn edit_trim(&mut self, at: LoopAt, curve: usize, point: usize, to: DVec2) -> Result<(), EditError> {
        let Some(loaded) = &self.loaded else { panic!("upload a model before editing it") };
        let edit = loaded.data.edit.as_ref().ok_or(EditError::NotEditable)?;
        let new = edit.shape(at)?.with_point(curve, point, to)?;
        self.edit_loop(at, &new)
    }

    /// Replaces a trim loop by one with as many curves of the same degrees; as
    /// [`edit_trim`](Self::edit_trim).
    ///
    /// # Errors
    /// [`EditError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn edit_loop(&mut self, at: LoopAt, new: &TrimLoop) -> Result<(), EditError> {
        let (Some(source), Some(loaded)) = (&mut self.source, &mut self.loaded) else {
            panic!("upload a model before editing it")
        };
        let writes = loaded.data.edit.as_mut().ok_or(EditError::NotEditable)?.replace(at, new)?;
        Arc::make_mut(&mut source.model).parts[at.part].faces[at.face].loops[at.trim_loop] = new.clone();
        if loaded.scene.is_some() {
            loaded.edits.extend(writes);
        } else {
            loaded.data.apply(&writes);
        }
        Ok(())
    }
}
