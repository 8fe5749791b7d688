//! Cameras and the picture's settings.

use super::import;
use crate::model::{Camera, Projection};
use glam::DVec3;

const BALLS: &str = "unit = \"cm\"\n[solid.a]\nshape = \"sphere\"\nradius = 1\n[solid.b]\nshape = \"sphere\"\nradius = 2\n\
                     [[instance]]\nof = \"a\"\nat = [10, 0, 0]\n[[instance]]\nof = \"b\"\n";

fn cameras(text: &str) -> Vec<Camera> {
    let import = import(&format!("{BALLS}{text}"));
    let bounds = import.model.bounds();
    let cameras: Vec<Camera> = import.cameras.iter().map(|c| c.camera(bounds, (400, 300))).collect();
    cameras.iter().for_each(|c| assert_eq!(c.check(), Ok(())));
    cameras
}

#[test]
fn an_eye_and_what_it_looks_at() {
    let all = cameras(
        "[camera.one]\neye = [0, -30, 5]\ntarget = [1, 2, 3]\nup = [0, 1, 1]\nfov = 40\n[camera.two]\neye = [0, -30, 5]\northo = 8\n",
    );
    assert_eq!((all[0].eye, all[0].target), (DVec3::new(0.0, -300.0, 50.0), DVec3::new(10.0, 20.0, 30.0)));
    assert_eq!(all[0].projection, Projection::Perspective { fov_y: 40f64.to_radians() });
    assert_eq!(all[1].projection, Projection::Orthographic { height: 80.0 });
    // the middle of both balls' box
    assert_eq!(all[1].target, DVec3::new(45.0, 0.0, 0.0));
}

#[test]
fn a_fitted_camera_sees_one_thing_or_all() {
    let all = cameras(
        "[camera.all]\nfrom = [0, -1, 0]\n[camera.small]\nfit = \"a\"\nfrom = [0, -1, 0]\northo = true\nmargin = 1\n",
    );
    assert_eq!(all[0].target, DVec3::new(45.0, 0.0, 0.0));
    assert_eq!(all[1].target, DVec3::new(100.0, 0.0, 0.0));
    assert_eq!(all[1].projection, Projection::Orthographic { height: 20.0 });
}

#[test]
fn the_picture_names_a_camera() {
    let text = "[camera.x]\nfov = 20\n[camera.y]\nfov = 30\n[picture]\nsize = [64, 48]\ncamera = \"y\"\nbackground = \"#000000\"\nsun = [1, 0, 2]\n";
    let import = import(&format!("{BALLS}{text}"));
    assert_eq!(import.picture.size, Some((64, 48)));
    assert_eq!(import.cameras[import.picture.camera.unwrap()].name, "y");
    assert_eq!(import.picture.background, Some([0.0, 0.0, 0.0, 1.0]));
    assert_eq!(import.picture.sun, Some(DVec3::new(1.0, 0.0, 2.0)));
}
