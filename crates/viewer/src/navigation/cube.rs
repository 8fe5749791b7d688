//! The view cube: faces, edges and corners of a cube that turns with the view, each a direction to look from.
//!
//! ```text
//!        ┌──┬─────┬──┐     a point of the cube's surface has three coordinates in [-1, 1];
//!       ╱  ╱     ╱  ╱│     those beyond BORDER count: one a face, two an edge, three a corner
//!      ├──┬─────┬──┤ │
//!      │  │FRONT│  │╱│
//! ```

use glam::{DVec2, DVec3};
use selvedge::model::Camera;

/// Where an edge begins, from the middle of a face at 0 to its side at 1.
const BORDER: f64 = 0.62;
/// Half the size of the widget, in half sides of the cube: a corner is √3 from the middle.
pub const REACH: f64 = 1.75;

/// One side of the cube, as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// Its name.
    pub name: &'static str,
    /// Outward normal.
    pub normal: DVec3,
    /// Corners in order, in the widget: x right, y down, from -1 to 1.
    pub corners: [DVec2; 4],
    /// Cosine of the angle between its normal and the direction to the eye.
    pub facing: f64,
}

const SIDES: [(&str, DVec3); 6] = [
    ("FRONT", DVec3::NEG_Y),
    ("BACK", DVec3::Y),
    ("LEFT", DVec3::NEG_X),
    ("RIGHT", DVec3::X),
    ("TOP", DVec3::Z),
    ("BOTTOM", DVec3::NEG_Z),
];

/// Where a point of the cube is in the widget.
pub fn place(camera: &Camera, p: DVec3) -> DVec2 {
    let (right, up, _) = camera.axes();
    DVec2::new(p.dot(right), -p.dot(up)) / REACH
}

/// The sides that face the eye.
pub fn sides(camera: &Camera) -> Vec<Side> {
    let (_, _, forward) = camera.axes();
    let seen = SIDES.iter().filter(|(_, normal)| normal.dot(forward) < -1e-6);
    seen.map(|&(name, normal)| {
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corners = corners.map(|(a, b)| place(camera, normal + u * a + v * b));
        Side { name, normal, corners, facing: -normal.dot(forward) }
    })
    .collect()
}

/// The direction to look from, under a point of the widget, with coordinates -1, 0 and 1; `None` beside the cube.
pub fn direction_at(camera: &Camera, at: DVec2) -> Option<DVec3> {
    let (right, up, forward) = camera.axes();
    let at = at * REACH;
    let origin = right * at.x - up * at.y - forward * 10.0;
    let mut range = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (o, d) = (origin[axis], forward[axis]);
        if d.abs() < 1e-12 {
            if o.abs() > 1.0 {
                return None;
            }
            continue;
        }
        let (a, b) = ((-1.0 - o) / d, (1.0 - o) / d);
        range = (range.0.max(a.min(b)), range.1.min(a.max(b)));
    }
    if range.0 > range.1 {
        return None;
    }
    let p = origin + forward * range.0;
    Some(DVec3::from_array(p.to_array().map(|x| if x.abs() > BORDER { x.signum() } else { 0.0 })))
}

#[cfg(test)]
mod tests {
    use super::super::standard::{StandardView, up_from};
    use super::*;
    use selvedge::model::Projection;

    fn camera(from: DVec3) -> Camera {
        Camera {
            eye: from * 10.0,
            target: DVec3::ZERO,
            up: up_from(from),
            projection: Projection::Perspective { fov_y: 0.6 },
            depth_range: (1.0, 100.0),
            size: (100, 100),
        }
    }

    #[test]
    fn each_of_26_places_gives_its_direction() {
        let coordinates = [-1.0, 0.0, 1.0];
        let all = coordinates.iter().flat_map(|x| coordinates.map(|y| coordinates.map(|z| DVec3::new(*x, y, z))));
        let mut count = 0;
        for direction in all.flatten().filter(|d| *d != DVec3::ZERO) {
            // seen from a little beside, as in practice
            let camera = camera(direction + DVec3::new(0.11, 0.07, 0.05));
            let found = direction_at(&camera, place(&camera, direction));
            assert_eq!(found, Some(direction));
            count += 1;
        }
        assert_eq!(count, 26);
    }

    #[test]
    fn beside_the_cube_there_is_nothing_and_sides_that_face_away_are_not_drawn() {
        let iso = camera(StandardView::Iso.from());
        assert_eq!(direction_at(&iso, DVec2::new(0.99, 0.99)), None);
        let names: Vec<_> = sides(&iso).iter().map(|side| side.name).collect();
        assert_eq!(names, ["FRONT", "RIGHT", "TOP"]);
    }
}
