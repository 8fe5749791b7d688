//! Camera moves: pure functions from a camera and a movement of the mouse to the next camera.
//!
//! ```text
//!   orbit   eye, axis and up turn about a pivot      the pivot's pixel stays where it is
//!   roll    eye and up turn about the view's axis    the pivot's pixel stays where it is
//!   zoom    eye and target shrink towards an anchor  the anchor's pixel stays where it is
//!   pan     eye moves across                         the anchor follows the cursor
//!   settle  near and far plane around what is drawn  up to 10^6 times closer than the whole model
//! ```
//!
//! Pixels are those of the camera's picture, y down. All is in `f64`; fixed points stay fixed within its rounding.

pub mod cube;
pub mod gesture;
pub mod standard;
pub mod transition;

use glam::{DQuat, DVec2, DVec3};
use selvedge::model::{Bounds, Camera, Projection};
use serde::{Deserialize, Serialize};

/// Vertical field of view of a perspective view, radians: that of the pictures that `selvedge render` draws.
pub const FOV: f64 = Camera::FOV_DEG * std::f64::consts::PI / 180.0;
/// Room around what fits the picture.
const MARGIN: f64 = 1.06;
/// The near plane is no farther than this share of the distance to the target: the point that the mouse holds is not
/// cut away.
const NEAR: f64 = 0.05;
/// An up direction that sinks below the horizon by less is that of a view from the pole, rounded.
const LEVEL: f64 = 1e-9;
/// Smallest lengths that the camera's depths may have, model units.
const LEAST_DEPTH: f64 = 1e-12;

/// How a drag turns the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OrbitStyle {
    /// About the vertical z and the picture's horizontal: verticals stay upright.
    #[default]
    Turntable,
    /// About the picture's vertical and horizontal.
    Free,
}

/// Turns the view about `pivot` by a drag in pixels: half a turn over the picture's height.
pub fn orbit(camera: &Camera, pivot: DVec3, drag: DVec2, style: OrbitStyle) -> Camera {
    let step = drag * (std::f64::consts::PI / f64::from(camera.size.1.max(1)));
    let (right, up, forward) = camera.axes();
    let turn = match style {
        OrbitStyle::Free => DQuat::from_axis_angle(up, -step.x) * DQuat::from_axis_angle(right, -step.y),
        OrbitStyle::Turntable => {
            // where the eye would pass over the pole it stops there
            let elevation = (-forward.z).atan2(up.z);
            let quarter = std::f64::consts::FRAC_PI_2;
            let rise = if up.z >= -LEVEL {
                step.y.clamp(-quarter - elevation, quarter - elevation)
            } else {
                step.y // upside down: the hand finds its own way back
            };
            DQuat::from_axis_angle(DVec3::Z, -step.x) * DQuat::from_axis_angle(right, -rise)
        }
    };
    turned(camera, pivot, turn)
}

/// Turns the view about its axis, so that the picture turns about `pivot` by an angle, radians, counterclockwise.
pub fn roll(camera: &Camera, pivot: DVec3, angle: f64) -> Camera {
    let (_, _, forward) = camera.axes();
    turned(camera, pivot, DQuat::from_axis_angle(forward, angle))
}

/// The view turned about a point.
fn turned(camera: &Camera, pivot: DVec3, turn: DQuat) -> Camera {
    let (_, up, _) = camera.axes();
    let about = |p: DVec3| pivot + turn * (p - pivot);
    let moved = Camera { eye: about(camera.eye), target: about(camera.target), up: turn * up, ..*camera };
    kept(camera, moved)
}

/// `factor` times as large a view, below 1 a closer one; the point `anchor` keeps its pixel.
pub fn zoom(camera: &Camera, anchor: DVec3, factor: f64) -> Camera {
    let to = |p: DVec3| anchor + (p - anchor) * factor;
    let projection = match camera.projection {
        Projection::Orthographic { height } => Projection::Orthographic { height: height * factor },
        other => other,
    };
    kept(camera, Camera { eye: to(camera.eye), target: to(camera.target), projection, ..*camera })
}

/// Moves the view so that `anchor` is seen at `pixel`.
pub fn pan(camera: &Camera, anchor: DVec3, pixel: DVec2) -> Camera {
    let shift = anchor - at_depth(camera, pixel, depth(camera, anchor));
    kept(camera, Camera { eye: camera.eye + shift, target: camera.target + shift, ..*camera })
}

/// The target moved along the view axis to the depth of `anchor`: later moves are measured there.
pub fn aimed(camera: &Camera, anchor: DVec3) -> Camera {
    let (_, _, forward) = camera.axes();
    let moved = Camera { target: camera.eye + forward * depth(camera, anchor), ..*camera };
    kept(camera, moved)
}

/// Distance of a point from the eye, along the view axis.
pub fn depth(camera: &Camera, point: DVec3) -> f64 {
    let (_, _, forward) = camera.axes();
    (point - camera.eye).dot(forward)
}

/// The point that a pixel sees at a depth along the view axis.
pub fn at_depth(camera: &Camera, pixel: DVec2, depth: f64) -> DVec3 {
    let (origin, direction) = camera.ray(pixel);
    let (_, _, forward) = camera.axes();
    origin + direction * (depth / direction.dot(forward))
}

/// The first camera, where the moved one shows nothing.
fn kept(camera: &Camera, moved: Camera) -> Camera {
    // near and far are set anew by `settle`
    let checked = Camera { depth_range: (1.0, 2.0), ..moved };
    if checked.check().is_ok() { moved } else { *camera }
}

/// Sets eye and depths for a model within `bounds`: all of it lies in front of a parallel view's eye, and between near
/// and far plane; a perspective view's near plane lies close before the target.
pub fn settle(camera: &Camera, bounds: Bounds) -> Camera {
    let mut settled = *camera;
    if let Projection::Orthographic { height } = camera.projection {
        let (_, _, forward) = camera.axes();
        let radius = (0.5 * bounds.diagonal()).max(height);
        let centre = if bounds.is_empty() { camera.target } else { bounds.centre() };
        let back = 1.1 * radius - depth(camera, centre);
        settled.eye -= forward * back;
        // the target is where the eye looks, whatever its depth
        if depth(&settled, settled.target) <= LEAST_DEPTH {
            settled.target = settled.eye + forward * radius;
        }
    }
    settled.fit_depth(bounds);
    if camera.is_perspective() {
        let held = camera.eye.distance(camera.target) * NEAR;
        let (near, far) = settled.depth_range;
        settled.depth_range = (near.min(held).max(LEAST_DEPTH), far);
    }
    kept(camera, settled)
}

/// The view from the same direction in which these points fill the picture.
pub fn fit(camera: &Camera, points: &[DVec3]) -> Camera {
    if points.is_empty() {
        return *camera;
    }
    let (right, up, forward) = camera.axes();
    let bounds = points.iter().fold(Bounds::EMPTY, |all, p| all.with(*p));
    let centre = bounds.centre();
    let aspect = f64::from(camera.size.0) / f64::from(camera.size.1.max(1));
    let least = (1e-6 * bounds.diagonal()).max(LEAST_DEPTH);
    let across = |p: &DVec3| {
        let from = *p - centre;
        (from.dot(right).abs(), from.dot(up).abs(), from.dot(forward))
    };
    let centred = Camera { projection: in_the_middle(camera), ..*camera };
    let (distance, projection) = match centred.projection {
        Projection::Perspective { fov_y } => {
            let tan = (0.5 * fov_y).tan();
            let needed = points.iter().map(across).map(|(x, y, z)| (x / aspect).max(y) / tan * MARGIN - z);
            (needed.fold(least, f64::max), centred.projection)
        }
        _ => {
            let half = points.iter().map(across).map(|(x, y, _)| (x / aspect).max(y)).fold(least, f64::max);
            (bounds.diagonal().max(least), Projection::Orthographic { height: 2.0 * half * MARGIN })
        }
    };
    kept(camera, Camera { eye: centre - forward * distance, target: centre, projection, ..*camera })
}

/// The view from a direction, towards the eye, at the same distance from the target.
pub fn looking(camera: &Camera, from: DVec3, up: DVec3) -> Camera {
    let distance = camera.eye.distance(camera.target);
    kept(camera, Camera { eye: camera.target + from.normalize() * distance, up, ..*camera })
}

/// Parallel instead of perspective or the other way round; objects at the target keep their size.
pub fn other_projection(camera: &Camera) -> Camera {
    let distance = camera.eye.distance(camera.target);
    match in_the_middle(camera) {
        Projection::Perspective { fov_y } => {
            let height = 2.0 * distance * (0.5 * fov_y).tan();
            kept(camera, Camera { projection: Projection::Orthographic { height }, ..*camera })
        }
        Projection::Orthographic { height } => {
            let (_, _, forward) = camera.axes();
            let eye = camera.target - forward * (0.5 * height / (0.5 * FOV).tan());
            kept(camera, Camera { eye, projection: Projection::Perspective { fov_y: FOV }, ..*camera })
        }
        Projection::Pinhole { .. } => *camera,
    }
}

/// The projection with its axis in the middle of the picture, and with the same vertical scale.
fn in_the_middle(camera: &Camera) -> Projection {
    match camera.projection {
        Projection::Pinhole { focal, .. } => {
            Projection::Perspective { fov_y: 2.0 * (0.5 * f64::from(camera.size.1) / focal.y).atan() }
        }
        other => other,
    }
}

#[cfg(test)]
mod tests;
