//! A camera that shows all of a model as large as it fits.
//!
//! ```text
//!          eye            The sides of the pyramid that the picture shows have fixed directions. Each side touches the
//!          ╱╲             model where the model reaches farthest along the side's normal. Two opposite sides that
//!         ╱  ╲            touch meet in a line. The eye lies on the line that is farther back, of left and right or
//!        ╱╭───╲─╮         of top and bottom; across the other two sides it lies where the picture has the same
//!       ╱ ╰────╲╯         margin on both.
//! ```
//!
//! The sides are those of [`FILL`] of the picture. A search as for the box finds how far the model reaches, within
//! [`WITHIN`] of the box's diagonal; for Boolean solids it uses boxes turned across the direction. The model is in the
//! middle to [`CENTRED`] of the picture.

use super::Placed;
use super::search::{Search, Tolerance};
use super::solid::Extent;
use crate::model::{Bounds, Camera, Model};
use glam::DVec3;

/// Share of the tighter side of the picture that the model covers.
const FILL: f64 = 0.9;
/// How far a search may be off, in shares of the model's diagonal: small beside the nearest visible end.
const WITHIN: f64 = 1e-6;
/// Half the difference of two margins, in shares of the picture's half.
const CENTRED: f64 = 1e-3;
/// Least distance of the eye from the model, in shares of the model's diagonal, however thin the model looks.
const NEAREST: f64 = 1e-2;
/// Steps of the search for the slope of the sides that do not determine the eye.
const MOST_STEPS: usize = 24;

/// How far a model reaches along directions.
struct Reach<'a> {
    trim: Option<Extent<'a>>,
    solids: Vec<Extent<'a>>,
    placed: Placed<'a>,
    tolerance: Tolerance,
}

impl Reach<'_> {
    /// The largest `direction · p` of the drawn points.
    fn along(&self, direction: DVec3) -> f64 {
        let mut search = Search::new(&self.placed.bodies, &self.placed.placements, direction);
        let faces = search.refine(self.tolerance);
        let faces = self.trim.as_ref().map_or(faces, |volume| faces.min(volume.reach(direction)));
        let solids = self.solids.iter().map(|solid| solid.reach(direction));
        solids.filter(|height| height.is_finite()).fold(faces, f64::max)
    }

    /// Two planes `±axis - slope * forward` that touch the model.
    fn touching(&self, axis: DVec3, slope: f64, forward: DVec3) -> Pair {
        Pair { slope, above: self.along(axis - slope * forward), below: self.along(-axis - slope * forward) }
    }
}

/// Two sides of the pyramid, left and right of an axis, and how far the model reaches across each.
#[derive(Clone, Copy)]
struct Pair {
    slope: f64,
    above: f64,
    below: f64,
}

impl Pair {
    /// The place where the two meet, along the axis.
    fn across(self) -> f64 {
        0.5 * (self.above - self.below)
    }

    /// The same along the view's direction.
    fn depth(self) -> f64 {
        -0.5 * (self.above + self.below) / self.slope
    }

    /// How far each side is beyond an eye at this depth: convex in the slope.
    fn beyond(self, depth: f64) -> f64 {
        0.5 * (self.above + self.below) + self.slope * depth
    }
}

impl Camera {
    /// A camera that shows all of `model` from direction `from` (towards the eye): the model covers nine tenths of the
    /// tighter side of the picture. A model that its trims leave empty is shown as large as its control points.
    ///
    /// `fov_y` in radians, `size` in pixels.
    ///
    /// # Example
    /// ```
    /// use glam::DVec3;
    /// use selvedge_geometry::model::{Camera, Model};
    /// let camera = Camera::framing(&Model::default(), DVec3::X, DVec3::Z, 0.6, (640, 480));
    /// assert!(camera.check().is_ok());
    /// ```
    pub fn framing(model: &Model, from: DVec3, up: DVec3, fov_y: f64, size: (u32, u32)) -> Self {
        let placed = Placed::new(&model.parts, &model.instances);
        let bounds = model.bounds_with(&placed, 0..model.solids.len());
        if bounds.is_empty() {
            return Self::around(model.control_bounds(), from, up, fov_y, size);
        }
        let around = Self::around(bounds, from, up, fov_y, size);
        around.fitted(model, placed, bounds, fov_y).filter(|camera| camera.check().is_ok()).unwrap_or(around)
    }

    /// The same camera moved until the model covers [`FILL`] of the picture; `None` of a model without size.
    fn fitted<'a>(&self, model: &'a Model, placed: Placed<'a>, bounds: Bounds, fov_y: f64) -> Option<Self> {
        let diagonal = bounds.diagonal();
        let tolerance = Tolerance { analytic: WITHIN * diagonal, other: WITHIN * diagonal };
        let trim = model.trim.as_ref().map(Extent::new);
        let reach = Reach { trim, solids: model.solids.iter().map(Extent::new).collect(), placed, tolerance };
        let (right, up, forward) = self.axes();
        let slope_y = FILL * (0.5 * fov_y).tan();
        let slope_x = slope_y * f64::from(self.size.0) / f64::from(self.size.1);
        let pairs = [(right, slope_x), (up, slope_y)].map(|(axis, slope)| (axis, reach.touching(axis, slope, forward)));
        let front = -reach.along(-forward);
        let back = pairs.iter().map(|(_, pair)| pair.depth()).fold(front - NEAREST * diagonal, f64::min);
        let [across, upright] = pairs.map(|(axis, pair)| {
            let slope = pair.slope;
            // sides that do not determine the eye meet before its depth: a smaller slope makes them meet at it
            let (mut wide, mut narrow) =
                (pair, Pair { slope: 0.0, above: reach.along(axis), below: reach.along(-axis) });
            for step in 0..MOST_STEPS {
                let (over, under) = (narrow.beyond(back), wide.beyond(back));
                let enough = CENTRED * slope * (front - back);
                if -under <= enough {
                    break;
                }
                if over <= enough {
                    return narrow.across();
                }
                // every other step halves: secants of a convex function move one end only
                let share = if step % 2 == 0 { over / (over - under) } else { 0.5 };
                let next = reach.touching(axis, narrow.slope + share * (wide.slope - narrow.slope), forward);
                if next.beyond(back) > 0.0 { narrow = next } else { wide = next }
            }
            wide.across()
        });
        let middle = bounds.centre().dot(forward);
        let eye = right * across + up * upright + forward * back;
        if !(diagonal > 0.0 && eye.is_finite()) {
            return None;
        }
        let mut camera = Self { eye, target: eye + forward * (middle - back), ..*self };
        camera.fit_depth(bounds);
        Some(camera)
    }
}
