//! Points picked by the mouse, and their distance, against what the file states and what exact rays see.

use super::hand::numbers;
use super::scene::Scene;
use super::{Screen, entity, opened, text_of};
use glam::{DMat4, DVec2, DVec3};
use selvedge_geometry::edges::curve;
use selvedge_geometry::edges::nearest::nearest;

/// Pixels around a place that have no other point to measure from, and no edge.
const ALONE: f64 = 15.0;
/// The accuracy that measuring promises, relative: the coordinates of the file have 12 digits.
const PROMISED: f64 = 1e-9;

/// Points of the model: corners; middles of edges, and centres.
struct Points {
    corners: Vec<DVec3>,
    others: Vec<DVec3>,
}

impl Points {
    fn new(scene: &Scene) -> Self {
        let (edges, transform) = (scene.world.edges_of(0).expect("found"), scene.world.model.instances[0].transform);
        let middles = edges.edges.iter().filter_map(|edge| curve::middle(edge, transform));
        let centres = scene.world.centres_of(0).iter().map(|(_, centre)| *centre);
        let placed = |p: DVec3| transform.transform_point3(p);
        Self {
            corners: edges.vertices.iter().copied().map(placed).collect(),
            others: middles.chain(centres).map(placed).collect(),
        }
    }

    /// The place of a point in the window, if nothing is in front of it and no other point beside it.
    fn place(&self, scene: &Scene, p: DVec3) -> Option<DVec2> {
        let at = scene.in_window(&scene.camera, p);
        let (_, depth) = scene.camera.project(p)?;
        let slack = 1e-3 * scene.world.bounds.diagonal();
        let is_hidden = scene.hit(at).is_some_and(|hit| hit.depth < depth - slack);
        (scene.is_in_view(at) && !is_hidden && !self.is_beside(scene, at, Some(p))).then_some(at)
    }

    /// Whether another point is beside a place.
    fn is_beside(&self, scene: &Scene, at: DVec2, itself: Option<DVec3>) -> bool {
        let is_other = |p: &&DVec3| itself.is_none_or(|itself| p.distance(itself) > 1e-6);
        let is_near = |p: &DVec3| scene.in_window(&scene.camera, *p).distance(at) < ALONE;
        self.corners.iter().any(is_near) || self.others.iter().filter(is_other).any(is_near)
    }
}

/// The entities that an entity names.
fn named(entity: &str) -> Vec<u32> {
    let digits = |rest: &str| rest.split(|c: char| !c.is_ascii_digit()).next().and_then(|word| word.parse().ok());
    entity.split('#').skip(2).filter_map(digits).collect()
}

/// The coordinates of a `CARTESIAN_POINT` that an entity names first.
fn stated_point(text: &str, number: u32) -> DVec3 {
    let point = entity(text, named(entity(text, number))[0]);
    let [x, y, z] = numbers(&point.to_lowercase(), "('',(")[..] else { panic!("{point}") };
    DVec3::new(x, y, z)
}

#[test]
fn points_are_measured_as_the_file_states_them() {
    let Some(screen) = Screen::open((900, 560)) else { return };
    let display = &screen.display;
    let (folder, mut program, scene) = opened(display, "bracket.step");
    let text = text_of(&folder.path().join("bracket.step"));
    let text = text.as_str();
    let points = Points::new(&scene);
    let edges = scene.world.edges_of(0).expect("found");
    // vertices and curve of each edge of the file
    let stated = || edges.edges.iter().filter_map(move |edge| Some(named(entity(text, edge.source?.entity))));
    let centre = stated().filter(|of| entity(text, of[2]).contains("=CIRCLE(")).find_map(|of| {
        let axes = named(entity(text, of[2]))[0];
        let centre = stated_point(text, axes);
        Some((points.place(&scene, centre)?, centre))
    });
    let middle = stated().filter(|of| entity(text, of[2]).contains("=LINE(")).find_map(|of| {
        let middle = 0.5 * (stated_point(text, of[0]) + stated_point(text, of[1]));
        Some((points.place(&scene, middle)?, middle))
    });
    let ((at_centre, centre), (at_middle, middle)) =
        (centre.expect("a centre is seen"), middle.expect("a middle is seen"));

    program.after(|| display.key("p"));
    display.click(at_centre);
    let selected = program.wait("selected ");
    assert!(selected.contains("selected centre of edge "), "{selected}");
    program.rest();
    display.click(at_middle);
    let selected = program.wait("selected ");
    assert!(selected.contains("selected middle of edge "), "{selected}");
    let distance = numbers(&program.wait("distance: "), "distance: ")[0];
    assert!((distance / centre.distance(middle) - 1.0).abs() < PROMISED, "{distance} from {centre} to {middle}");
    program.rest();

    // in the middle of a face its point is that of an exact ray
    let to_pixels = scene.camera.pixel_matrix() * DMat4::from(scene.world.model.instances[0].transform);
    let (at, hit) = scene.place(|hit, _| {
        let (pixel, _) = scene.camera.project(hit.point).expect("in front");
        let on_edge = edges.edges.iter().any(|edge| nearest(edge, to_pixels, pixel, ALONE).is_some());
        !on_edge && !points.is_beside(&scene, pixel + scene.corner, None)
    });
    display.click(at);
    let selected = program.wait("selected ");
    assert!(selected.contains("selected point on ") && selected.contains(&format!("#{} of ", hit.face)), "{selected}");
    let found = numbers(&program.wait("point: "), "point: ");
    let found = DVec3::from_slice(&found);
    assert!(found.distance(hit.point) < PROMISED * scene.world.bounds.diagonal(), "{found} instead of {}", hit.point);
    program.close(display);
}
