//! The view of the model: its camera, its moves by the mouse, and the next picture.
//!
//! ```text
//!   press ─▶ Drag, waits for the point under the cursor ─▶ moves ─▶ camera ─▶ a picture of fewer pixels, in time
//!                                                 still for SETTLE, or released ─┴─▶ every pixel, once
//! ```
//!
//! The caller passes times in; there is no window here.

use crate::navigation::gesture::{Action, Held, Preset, Scrolled};
use crate::navigation::transition::{DURATION, Transition};
use crate::navigation::{self, FOV, OrbitStyle};
use crate::pacing::{Pacing, Step};
use crate::pick::Hit;
use glam::{DVec2, DVec3};
use selvedge::model::{Bounds, Camera, Projection};
use std::time::{Duration, Instant};

/// A view that rests so long is still.
pub const SETTLE: Duration = Duration::from_millis(80);
/// A button that comes up within so many pixels of where it went down is a click.
const CLICK_PX: f64 = 4.0;
/// One notch of the wheel.
const NOTCH: f64 = 0.84;
/// Least and most magnification of one step of a pinch, less 1: fingers move no faster.
const PINCH: (f64, f64) = (-0.75, 3.0);
/// A zoom drag over the height of the view.
const ZOOM_DRAG: f64 = 12.0;
/// Most views that "previous view" leads back to.
const MOST_VIEWS: usize = 50;

/// A drag, from the press on.
#[derive(Clone, Copy, Debug)]
struct Drag {
    start: DVec2,
    last: DVec2,
    /// The fixed point of the drag; `None` until it is found.
    held: Option<DVec3>,
    /// It has left the place where it began.
    moved: bool,
    /// The view before it is in the list of previous views.
    remembered: bool,
}

/// The item under the cursor when it was last looked up.
#[derive(Clone, Copy, Debug)]
pub struct Hover {
    /// Pixels of the view.
    pub cursor: DVec2,
    /// The item.
    pub hit: Hit,
}

/// The view.
#[derive(Debug)]
pub struct View {
    camera: Camera,
    bounds: Bounds,
    before: Vec<Camera>,
    drag: Option<Drag>,
    /// The point that the wheel zooms to, and the cursor that it is for.
    anchor: Option<(DVec2, DVec3)>,
    transition: Option<(Transition, Instant)>,
    moved: Option<Instant>,
    /// Nothing has moved it since [`View::reset`].
    untouched: bool,
    /// Chooses the size and the effects of pictures of a moving view.
    pub pacing: Pacing,
    /// The last result for the cursor.
    pub hover: Option<Hover>,
}

/// A picture that is due.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Due {
    /// Its size is the picture's.
    pub camera: Camera,
    /// Pixels of it along a side for one of the view, and effects that it leaves out.
    pub step: Step,
}

impl Default for View {
    fn default() -> Self {
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::ONE };
        Self {
            camera: Camera::around(bounds, Camera::FROM, DVec3::Z, FOV, (1, 1)),
            bounds,
            before: Vec::new(),
            drag: None,
            anchor: None,
            transition: None,
            moved: None,
            untouched: true,
            pacing: Pacing::default(),
            hover: None,
        }
    }
}

impl View {
    /// The camera, as large as the view.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Sets the box of the drawn model.
    pub fn set_bounds(&mut self, bounds: Bounds) {
        if !bounds.is_empty() && bounds != self.bounds {
            self.bounds = bounds;
            self.camera = navigation::settle(&self.camera, bounds);
        }
    }

    /// The view has so many pixels.
    pub fn resize(&mut self, size: (u32, u32)) {
        if size.0 > 0 && size.1 > 0 && size != self.camera.size {
            self.camera.size = size;
            self.anchor = None;
        }
    }

    fn set(&mut self, camera: Camera, now: Instant) {
        let camera = navigation::settle(&camera, self.bounds);
        if camera != self.camera {
            self.camera = camera;
            self.moved = Some(now);
            self.untouched = false;
        }
    }

    fn remember(&mut self) {
        if self.before.last() != Some(&self.camera) {
            if self.before.len() == MOST_VIEWS {
                self.before.remove(0);
            }
            self.before.push(self.camera);
        }
    }

    /// Goes to another view, at once or over a fifth of a second.
    pub fn go(&mut self, to: Camera, smooth: bool, now: Instant) {
        self.remember();
        self.towards(to, smooth, now);
    }

    fn towards(&mut self, to: Camera, smooth: bool, now: Instant) {
        self.anchor = None;
        let to = navigation::settle(&Camera { size: self.camera.size, ..to }, self.bounds);
        if smooth {
            self.transition = Some((Transition::new(self.camera, to, self.bounds), now));
            self.moved = Some(now);
            self.untouched = false;
        } else {
            self.set(to, now);
        }
    }

    /// Where a transition ends, or where it is.
    pub fn goal(&self) -> Camera {
        self.transition.map_or(self.camera, |(transition, _)| transition.end())
    }

    /// The whole model in the picture, from the same direction.
    pub fn fit(&mut self, smooth: bool, now: Instant) {
        let to = navigation::fit(&self.goal(), &self.bounds.corners());
        self.go(to, smooth, now);
    }

    /// The first view of a model: all of it, from a little above its front right.
    pub fn reset(&mut self, now: Instant) {
        let to = Camera::around(self.bounds, Camera::FROM, DVec3::Z, FOV, self.camera.size);
        let to = if self.is_parallel() { navigation::other_projection(&to) } else { to };
        self.set(navigation::fit(&to, &self.bounds.corners()), now);
        self.before.clear();
        self.untouched = true;
    }

    /// It is still the first view of a model, as [`reset`](Self::reset) has left it.
    pub fn is_untouched(&self) -> bool {
        self.untouched
    }

    /// Some points in the picture, from the same direction.
    pub fn fit_points(&mut self, points: &[DVec3], smooth: bool, now: Instant) {
        let to = navigation::fit(&self.goal(), points);
        self.go(to, smooth, now);
    }

    /// The whole model from another direction.
    pub fn look_from(&mut self, from: DVec3, up: DVec3, smooth: bool, now: Instant) {
        let to = navigation::looking(&self.goal(), from, up);
        self.go(navigation::fit(&to, &self.bounds.corners()), smooth, now);
    }

    /// Parallel or perspective, the other one.
    pub fn toggle_projection(&mut self, now: Instant) {
        let to = navigation::other_projection(&self.goal());
        self.go(to, false, now);
    }

    /// A parallel view.
    pub fn is_parallel(&self) -> bool {
        matches!(self.goal().projection, Projection::Orthographic { .. })
    }

    /// Goes back to the previous view; false where there is none.
    pub fn previous(&mut self, smooth: bool, now: Instant) -> bool {
        let Some(before) = self.before.pop() else { return false };
        self.towards(before, smooth, now);
        true
    }

    /// Turns by pixels about the middle of the model, as keys do.
    pub fn turn(&mut self, pixels: DVec2, style: OrbitStyle, now: Instant) {
        self.remember();
        let to = navigation::orbit(&self.goal(), self.bounds.centre(), pixels, style);
        self.transition = None;
        self.set(to, now);
    }

    /// Moves the picture by pixels, as keys do.
    pub fn shift(&mut self, pixels: DVec2, now: Instant) {
        let from = self.goal();
        let Some((at, _)) = from.project(from.target) else { return };
        self.remember();
        (self.anchor, self.transition) = (None, None);
        self.set(navigation::pan(&from, from.target, at + pixels), now);
    }

    /// Zooms by notches to what is in the middle of the picture, as keys do.
    pub fn zoom(&mut self, notches: f64, now: Instant) {
        self.remember();
        if let Some((transition, _)) = self.transition.take() {
            // what is under the cursor on the way is elsewhere at the goal
            self.hover = None;
            self.set(transition.end(), now);
        }
        let (width, height) = self.camera.size;
        self.wheel(DVec2::new(f64::from(width), f64::from(height)) * 0.5, notches, now);
    }

    /// A button went down at `cursor`. The view needs the point under it, unless it is known: [`hold`](Self::hold).
    pub fn press(&mut self, cursor: DVec2) {
        self.transition = None;
        let known = self.hover.filter(|hover| hover.cursor.distance(cursor) < 1.0).and_then(|hover| hover.hit.point);
        self.drag.get_or_insert(Drag { start: cursor, last: cursor, held: known, moved: false, remembered: false });
    }

    /// The cursor at the start of a drag that waits for its point.
    pub fn wants_point(&self) -> Option<DVec2> {
        self.drag.filter(|drag| drag.held.is_none()).map(|drag| drag.start)
    }

    /// The point under the start of the drag; without one, the point behind the cursor as deep as the model's middle.
    pub fn hold(&mut self, point: Option<DVec3>) {
        let (camera, middle) = (self.camera, self.bounds.centre());
        if let Some(drag) = &mut self.drag {
            let depth = navigation::depth(&camera, middle);
            drag.held = Some(point.unwrap_or_else(|| navigation::at_depth(&camera, drag.start, depth)));
        }
    }

    /// The cursor is at another place, with these buttons and keys down.
    pub fn moved(&mut self, cursor: DVec2, held: Held, (preset, style): (Preset, OrbitStyle), now: Instant) {
        let Some(drag) = &mut self.drag else { return };
        drag.moved |= drag.start.distance(cursor) > CLICK_PX;
        let (Some(point), true) = (drag.held, drag.moved) else { return };
        let step = cursor - drag.last;
        drag.last = cursor;
        if !std::mem::replace(&mut drag.remembered, true) {
            self.remember();
        }
        let Some(action) = preset.action(held) else { return };
        let camera = match action {
            Action::Orbit => {
                let turned = navigation::orbit(&self.camera, point, step, style);
                navigation::aimed(&turned, point)
            }
            Action::Pan => navigation::pan(&self.camera, point, cursor),
            Action::Zoom => {
                let height = f64::from(self.camera.size.1);
                let factor = (step.y / height * ZOOM_DRAG.ln()).exp();
                navigation::aimed(&navigation::zoom(&self.camera, point, factor), point)
            }
        };
        self.anchor = None;
        self.set(camera, now);
    }

    /// The last button came up; true when it was a click and not a drag. After a drag the view is still at once.
    pub fn release(&mut self) -> bool {
        let Some(drag) = self.drag.take() else { return false };
        if drag.moved {
            self.moved = None;
        }
        !drag.moved
    }

    /// A drag moves the view.
    pub fn is_dragging(&self) -> bool {
        self.drag.is_some_and(|drag| drag.moved)
    }

    /// The wheel, by notches, upwards closer.
    pub fn wheel(&mut self, cursor: DVec2, notches: f64, now: Instant) {
        self.closer(cursor, NOTCH.powf(notches.clamp(-8.0, 8.0)), now);
    }

    /// Two fingers are farther apart by a share of their distance, or closer together below 0. What is no number, as
    /// systems may report it, is no pinch.
    pub fn pinch(&mut self, cursor: DVec2, apart: f64, now: Instant) {
        if apart.is_finite() {
            self.closer(cursor, (1.0 + apart.clamp(PINCH.0, PINCH.1)).recip(), now);
        }
    }

    /// A scroll of a wheel or of two fingers.
    pub fn scroll(&mut self, cursor: DVec2, scrolled: Scrolled, style: OrbitStyle, now: Instant) {
        let point = self.under(cursor);
        let (camera, anchor) = match scrolled {
            Scrolled::Zoom(notches) => return self.wheel(cursor, notches, now),
            Scrolled::Orbit(by) => {
                let turned = navigation::orbit(&self.camera, point, by, style);
                (navigation::aimed(&turned, point), point)
            }
            Scrolled::Pan(by) => {
                let Some((at, _)) = self.camera.project(point) else { return };
                let moved = navigation::pan(&self.camera, point, at + by);
                // the next step moves what is then under the cursor, as deep as this point
                (moved, navigation::at_depth(&moved, cursor, navigation::depth(&moved, point)))
            }
        };
        self.transition = None;
        self.set(camera, now);
        self.anchor = Some((cursor, anchor));
    }

    /// Two fingers turn by an angle, radians, counterclockwise, and the picture with them; with
    /// [`OrbitStyle::Turntable`] verticals stay upright, and it does not turn.
    pub fn twist(&mut self, cursor: DVec2, angle: f64, style: OrbitStyle, now: Instant) {
        if style == OrbitStyle::Free && angle.is_finite() {
            let point = self.under(cursor);
            self.transition = None;
            self.set(navigation::roll(&self.camera, point, angle), now);
            self.anchor = Some((cursor, point));
        }
    }

    /// The point under a cursor that rests: that of the last scroll, or what is seen there, or one as deep as the
    /// target.
    fn under(&self, cursor: DVec2) -> DVec3 {
        let known = self.anchor.filter(|(at, _)| at.distance(cursor) < 2.0).map(|(_, point)| point);
        let hovered = self.hover.filter(|h| h.cursor.distance(cursor) < 2.0).and_then(|h| h.hit.point);
        let behind = || {
            let depth = navigation::depth(&self.camera, self.camera.target);
            navigation::at_depth(&self.camera, cursor, depth)
        };
        known.or(hovered).unwrap_or_else(behind)
    }

    /// Zooms to the point under the cursor, which stays there.
    fn closer(&mut self, cursor: DVec2, factor: f64, now: Instant) {
        let point = self.under(cursor);
        self.anchor = Some((cursor, point));
        self.transition = None;
        let zoomed = navigation::zoom(&self.camera, point, factor);
        self.set(navigation::aimed(&zoomed, point), now);
    }

    /// Moves a transition on.
    pub fn advance(&mut self, now: Instant) {
        let Some((transition, start)) = self.transition else { return };
        let share = now.saturating_duration_since(start).as_secs_f64() / DURATION.as_secs_f64();
        let camera = transition.at(share, self.bounds);
        if share >= 1.0 {
            self.transition = None;
        }
        self.set(camera, now);
    }

    /// The next picture of the current view: of fewer pixels and effects while the view moves.
    pub fn due(&self, now: Instant) -> Due {
        self.of(if self.moving(now) { self.pacing.step() } else { Step::STILL })
    }

    /// The first picture of all, of as many pixels as one of a moving view and without effects: it is shown earlier.
    pub fn first(&self) -> Due {
        self.of(self.pacing.first())
    }

    fn of(&self, step: Step) -> Due {
        let size = Pacing::size(step.scale, self.camera.size);
        Due { camera: Camera { size, ..self.camera }, step }
    }

    /// The view moves, or did a moment ago.
    pub fn moving(&self, now: Instant) -> bool {
        self.transition.is_some() || self.moved.is_some_and(|moved| now.saturating_duration_since(moved) < SETTLE)
    }

    /// When the next picture is due without an event: the next step of a transition, or the still picture.
    pub fn wake(&self, now: Instant) -> Option<Instant> {
        match (self.transition, self.moved) {
            (Some(_), _) => Some(now),
            (None, Some(moved)) if self.moving(now) => Some(moved + SETTLE),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
