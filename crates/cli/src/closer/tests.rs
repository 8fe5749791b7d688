use super::*;
use glam::DAffine3;
use selvedge::model::{Primitive, Shape, Solid};
use selvedge_geometry::construct::shapes::{block, sphere};

fn placed(bodies: Vec<(Part, DAffine3)>) -> Model {
    let (parts, transforms): (Vec<Part>, Vec<DAffine3>) = bodies.into_iter().unzip();
    let place = |(part, transform)| Instance { part, transform, colour: None, name: String::new() };
    let instances = transforms.into_iter().enumerate().map(place).collect();
    Model { parts, instances, ..Model::default() }
}

fn body(min: DVec3, max: DVec3) -> (Part, DAffine3) {
    (block(min, max).unwrap().part, DAffine3::IDENTITY)
}

/// A ball, whose only details are its poles: these are `tilt` degrees from the z axis towards the x axis, and opposite.
fn ball(centre: DVec3, radius: f64, tilt: f64) -> (Part, DAffine3) {
    let turn = DAffine3::from_rotation_y(tilt.to_radians());
    (sphere(radius).unwrap().part, DAffine3::from_translation(centre) * turn)
}

fn solid(shape: Shape) -> Solid {
    Solid::of(Primitive { shape, transform: DAffine3::IDENTITY, colour: [0.5, 0.5, 0.5, 1.0], id: 9 }).unwrap()
}

fn view(eye: DVec3, target: DVec3) -> Camera {
    let projection = Projection::Perspective { fov_y: 0.9 };
    Camera { eye, target, up: DVec3::Z, projection, depth_range: (1e-3, 1e3), size: (400, 400) }
}

fn closer(model: &Model, whole: Camera, times: f64) -> Camera {
    Approach::new(model, whole).closer(times)
}

/// The corner of least depth is seen: the view keeps its direction, and magnifies by the number.
#[test]
fn the_nearest_corner_is_approached_along_the_view() {
    let model = placed(vec![body(-DVec3::ONE, DVec3::ONE)]);
    let whole = view(DVec3::new(5.0, -8.0, 5.5), DVec3::ZERO);
    for times in [1.0, 6.0, 1e6] {
        let camera = closer(&model, whole, times);
        assert!(camera.target.distance(DVec3::new(1.0, -1.0, 1.0)) < 1e-12, "{camera:?}");
        assert!((camera.eye - camera.target).distance(whole.eye / times) < 1e-12, "{camera:?}");
    }
    let parallel = Camera { projection: Projection::Orthographic { height: 4.0 }, ..whole };
    let camera = closer(&model, parallel, 10.0);
    assert!(camera.target.distance(DVec3::new(1.0, -1.0, 1.0)) < 1e-12, "{camera:?}");
    assert_eq!(camera.projection, Projection::Orthographic { height: 0.4 });
}

/// A block within a ball: its corners are nearer than the ball's pole, but the ball hides them.
#[test]
fn a_corner_behind_a_bulge_is_passed_over() {
    let inner = body(DVec3::new(1.0, -0.2, -0.2), DVec3::new(1.9, 0.2, 0.2));
    let model = placed(vec![inner, ball(DVec3::ZERO, 2.0, 60.0)]);
    let pole = 2.0 * DVec3::new(60f64.to_radians().sin(), 0.0, 60f64.to_radians().cos());
    for times in [1.0, 10.0, 1e3, 1e6] {
        let camera = closer(&model, view(DVec3::X * 10.0, DVec3::ZERO), times);
        assert!(camera.target.distance(pole) < 1e-9, "{camera:?}");
        assert!(camera.eye.length() > 2.0, "within the ball, {times} times closer: {camera:?}");
    }
}

/// Two balls that overlap: of their four poles two are within the other ball, and two are on the far side.
#[test]
fn without_a_detail_in_sight_the_eye_goes_to_what_it_sees() {
    let other = DVec3::new(1.5, 0.0, 1.2);
    let model = placed(vec![ball(DVec3::ZERO, 2.0, 60.0), ball(other, 1.2, 162.5)]);
    let whole = view(DVec3::X * 10.0, DVec3::ZERO);
    for times in [1.0, 10.0, 1e3, 1e6] {
        let camera = closer(&model, whole, times);
        assert!((camera.target.length() - 2.0).abs() < 1e-9, "{camera:?}");
        assert!(camera.eye.length() > 2.0 && camera.eye.distance(other) > 1.2, "{times} times closer: {camera:?}");
        let off = (camera.eye - camera.target).normalize().cross((whole.eye - camera.target).normalize());
        assert!(off.length() < 1e-6, "beside the way from the eye: {camera:?}");
    }
}

/// What is behind the eye has the least depth.
#[test]
fn details_behind_the_eye_are_none() {
    let before = body(DVec3::new(3.0, -1.0, -1.0), DVec3::new(4.0, 1.0, 1.0));
    let behind = body(DVec3::new(-4.0, -1.0, -1.0), DVec3::new(-3.0, 1.0, 1.0));
    let model = placed(vec![before, behind]);
    for times in [2.0, 1e3] {
        let camera = closer(&model, view(DVec3::ZERO, DVec3::X * 3.5), times);
        assert!((camera.target.abs() - DVec3::new(3.0, 1.0, 1.0)).length() < 1e-12, "{camera:?}");
        assert!(camera.target.x > 0.0 && camera.eye.x.abs() < 3.0, "{camera:?}");
    }
}

#[test]
fn a_boolean_solid_hides_details_and_has_an_outline() {
    let inner = body(DVec3::new(1.0, -0.2, -0.2), DVec3::new(1.9, 0.2, 0.2));
    let model = Model { solids: vec![solid(Shape::Sphere { radius: 2.0 })], ..placed(vec![inner]) };
    for times in [10.0, 1e3, 1e6] {
        let camera = closer(&model, view(DVec3::X * 10.0, DVec3::ZERO), times);
        assert!((camera.target.length() - 2.0).abs() < 1e-9 && camera.eye.length() > 2.0, "{camera:?}");
    }
}

/// A mesh whose vertices are out of the picture hides the block behind it.
#[test]
fn a_mesh_hides_details() {
    let corner =
        |k: u32| DVec3::new(5.0, if k.is_multiple_of(2) { -100.0 } else { 100.0 }, if k < 2 { -100.0 } else { 100.0 });
    let plate = Mesh::new(7, (0..4).map(corner).collect(), vec![[0, 1, 3], [0, 3, 2]], Vec::new()).unwrap();
    let plate = Part { meshes: vec![plate], ..Part::default() };
    let model = placed(vec![body(-DVec3::ONE, DVec3::ONE), (plate, DAffine3::IDENTITY)]);
    let camera = closer(&model, view(DVec3::X * 10.0, DVec3::ZERO), 1e3);
    assert!((camera.target.x - 5.0).abs() < 1e-9 && camera.eye.x > 5.0, "{camera:?}");
}

/// A volume cuts the upper corners away: the nearest one that is left is at the bottom.
#[test]
fn what_is_cut_away_is_no_detail() {
    let below = Shape::Block { min: DVec3::splat(-2.0), max: DVec3::new(2.0, 2.0, 0.5) };
    let model = Model { trim: Some(solid(below)), ..placed(vec![body(-DVec3::ONE, DVec3::ONE)]) };
    let camera = closer(&model, view(DVec3::new(5.0, -8.0, 5.5), DVec3::ZERO), 10.0);
    assert!(camera.target.distance(DVec3::new(1.0, -1.0, -1.0)) < 1e-9, "{camera:?}");
}
