//! Hidden lines.

use crate::edge_lines::{SIZE, draw_next, lines, with};
use crate::shapes;
use crate::support::{assert_silent, perspective};
use crate::watched::renderer;
use glam::DVec3;
use selvedge::model::Camera;
use selvedge::picture::{EdgeSettings, Picture};

/// Pixels through which the three edges at the cube's far corner pass, in order.
fn far_edges(camera: &Camera) -> [Vec<usize>; 3] {
    let far = DVec3::new(-1.0, 1.0, -1.0) * shapes::CUBE_HALF;
    [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
        let end = far - 2.0 * far * axis;
        let pixel = |k: u32| {
            let at = camera.project(far.lerp(end, f64::from(k) / 1000.0)).unwrap().0;
            at.y as usize * SIZE.0 as usize + at.x as usize
        };
        let mut pixels: Vec<usize> = (0..=1000).map(pixel).collect();
        pixels.dedup();
        pixels
    })
}

/// `hidden_lines` adds lines behind faces: dashed, and lighter than the others.
#[test]
fn hidden_lines_are_lighter_and_dashed() {
    let model = shapes::cube();
    let camera = perspective(&model, SIZE);
    let mut renderer = renderer();
    let [plain, hidden] = [false, true]
        .map(|hidden| draw_next(&mut renderer, (&model, with(EdgeSettings { hidden, ..lines() })), &camera));
    assert_silent(renderer);
    let more = |a: &Picture, b: &Picture| {
        let pairs = a.edge.iter().zip(&b.edge).zip(b.colour.iter());
        pairs.filter(|((a, b), _)| **a == 0 && **b != 0).map(|(_, c)| c[0]).collect::<Vec<_>>()
    };
    let dashes = more(&plain, &hidden);
    assert!(dashes.len() > 40, "{}", dashes.len());
    let darkest = |picture: &Picture| {
        let lines = picture.edge.iter().zip(&picture.colour).filter(|(edge, _)| **edge != 0);
        lines.map(|(_, colour)| colour[0]).min().unwrap()
    };
    assert!(*dashes.iter().min().unwrap() > 2 * darkest(&plain));
    assert!(more(&hidden, &plain).is_empty(), "a visible line stays where it was");
    for pixels in far_edges(&camera) {
        let alone = pixels.iter().filter(|at| plain.edge[**at] == 0);
        let marks: Vec<bool> = alone.map(|at| hidden.edge[*at] != 0).collect();
        let share = marks.iter().filter(|mark| **mark).count() as f64 / marks.len() as f64;
        let begins = marks.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        // dashes are four thirds as long as gaps, and ends of dashes cover part of a pixel
        assert!(begins >= 2 && (0.4..0.9).contains(&share), "{begins} dashes, {share} of {} pixels", marks.len());
    }
}
