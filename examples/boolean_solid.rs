//! A Boolean solid made in code, not from a file: a block less a ball and a bore.
//!
//! `cargo run --release --features headless --example boolean_solid`

use selvedge::csg::parse;
use selvedge::glam::{DAffine3, DVec3};
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, Model, Primitive, Shape, Solid};
use selvedge::picture::{FrameSettings, Outputs, Picture};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let picture = run((320, 240))?;
    let seen = |id: u32| picture.face.iter().filter(|face| **face == id).count();
    println!("block {}, ball {}, bore {} pixels", seen(1), seen(2), seen(3));
    Ok(())
}

/// Draws it.
pub fn run(size: (u32, u32)) -> Result<Picture, Box<dyn Error>> {
    let primitive = |id, shape, at| Primitive {
        shape,
        transform: DAffine3::from_translation(at),
        colour: [0.4, 0.45, 0.5, 1.0],
        id,
    };
    let block = Shape::Block { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
    let bore = Shape::Cylinder { radius: 0.4, height: 4.0 };
    let primitives = vec![
        primitive(1, block, DVec3::ZERO),
        primitive(2, Shape::Sphere { radius: 0.9 }, DVec3::new(1.0, -1.0, 1.0)),
        primitive(3, bore, DVec3::new(-0.3, 0.3, -2.0)),
    ];
    // the names stand for the primitives in order
    let solid = Solid::new(primitives, parse("A-B-C")?.tree)?;
    let model = Model { solids: vec![solid], ..Model::default() };
    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default())?;
    renderer.upload(&model)?;
    let camera = Camera::framing(&model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    Ok(renderer.render(&camera, &FrameSettings::default(), Outputs::ALL)?)
}
