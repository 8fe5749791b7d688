//! From the pixels that a frame has copied to the item under the cursor, and from a click to the selection.
//!
//! ```text
//!   move  ─▶ frame: copies pixels ─▶ the item under the cursor
//!   click ─▶ is that of this place, in the picture that is shown? ─yes─▶ selected, and shown by the next frame
//!               └─no─▶ frame: copies pixels ─▶ selected, and shown by the one after it
//! ```

use super::app::App;
use super::engine::Drawn;
use crate::pick::{Hit, PickFilter, Samples, Seen};
use crate::view::Hover;
use glam::DVec2;
use selvedge::model::Camera;
use std::time::Instant;

/// Places no farther apart are one, pixels of the view.
const SAME_PX: f64 = 0.5;

/// A click with the left button.
#[derive(Clone, Copy, Debug)]
pub struct Click {
    /// It adds to the selection.
    pub add: bool,
    /// Pixels of the view.
    pub at: DVec2,
    pub since: Instant,
}

/// Where and in which picture an item was looked up.
#[derive(Clone, Copy, Debug)]
pub struct LookUp {
    /// Pixels of the view.
    pub at: DVec2,
    /// Of the picture.
    pub camera: Camera,
    /// The engine's count of uploads and changes.
    pub generation: u64,
    pub filter: PickFilter,
}

impl App {
    /// The left button was clicked at a place of the view.
    pub fn clicked(&mut self, at: DVec2) {
        let click = Click { add: self.held.shift, at, since: Instant::now() };
        match self.known(at) {
            Some(hit) => self.select(hit, click),
            None => self.click = Some(click),
        }
    }

    /// The item at a place, where the last frame has looked it up and the next one would find the same.
    fn known(&self, at: DVec2) -> Option<Hit> {
        let of = self.look_up.filter(|of| of.at.distance(at) < SAME_PX && of.filter == self.ui.filter)?;
        let generation = self.opened.as_ref()?.engine.generation;
        let is_shown = of.generation == generation && self.pictures.camera(generation) == Some(of.camera);
        // a frame that is due may show something else
        self.view.hover.filter(|_| is_shown && self.is_up_to_date()).map(|hover| hover.hit)
    }

    /// Looks up the item in the pixels that a frame has copied.
    pub fn picked(&mut self, samples: &Samples, scene: &Drawn, of: LookUp) {
        let LookUp { at, camera, filter, .. } = of;
        let scale = f64::from(camera.size.0) / f64::from(self.rect.width.max(1));
        let Drawn { world, state, instances } = scene;
        let placed = |number: usize| state.placement(number, world);
        let seen = Seen { world, instances, hidden: &state.hidden, placement: &placed, camera: &camera };
        let hit = samples.pick(&seen, at * scale, filter);
        let before = self.view.hover.and_then(|h| h.hit.picked);
        self.view.hover = Some(Hover { cursor: at, hit });
        self.look_up = Some(of);
        if self.view.wants_point().is_some_and(|start| start.distance(at) < 1.0) {
            self.view.hold(hit.point);
            self.catch_up();
        }
        // a pick at an earlier place does not serve a click
        if let Some(click) = self.click.take_if(|click| click.at.distance(at) < SAME_PX) {
            self.select(hit, click);
        }
        self.again |= before != hit.picked;
    }

    fn select(&mut self, hit: Hit, click: Click) {
        match self.ui.filter {
            PickFilter::Points => self.session.select_point(hit.picked, click.add),
            _ => self.session.select(hit.picked, click.add),
        }
        self.ui.selected(&self.session, hit.point);
        self.selected = Some(click.since);
        self.again = true;
    }
}
