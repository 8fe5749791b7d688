//! Outlines of meshes: sides of triangles of which one faces the eye and the other does not.

use crate::edge_lines::centres;
use crate::shapes::{ball_mesh, block_mesh, whole_mesh};
use crate::solid_lines::{HALF, OFF, SIZE, away, draw, draw_next, lines, with};
use crate::support::{assert_silent, orthographic, perspective};
use crate::watched::renderer;
use glam::{DAffine3, DVec2, DVec3};
use selvedge::model::{Camera, Instance, Model};
use selvedge::picture::{EdgeChoice, EdgeSettings, Picture};
use selvedge_check::Tracer;
use selvedge_check::drawing::{DrawingSettings, LineImage, LineJudgement, judge_lines};

/// Number of an outline in the image of edges.
const OUTLINE: u32 = u32::MAX;
/// Triangles turn by 4 degrees from one to the next: the outline is within a tenth of a pixel of the ball's.
const LEVELS: u32 = 5;
const OFF_BALL: f64 = 0.1;

fn outlines() -> EdgeSettings {
    EdgeSettings { which: EdgeChoice::None, silhouettes: true, ..lines() }
}

fn marked(picture: &Picture, number: u32) -> Vec<DVec2> {
    centres(picture).filter(|(_, edge)| *edge == number).map(|(at, _)| at).collect()
}

/// The circle at which rays from the eye touch the unit ball.
fn outline_of_ball(camera: &Camera) -> Vec<DVec2> {
    let away = camera.eye.length();
    let axis = camera.eye / away;
    let (middle, round) = match camera.is_perspective() {
        true => (axis / away, (1.0 - 1.0 / (away * away)).sqrt()),
        false => (DVec3::ZERO, 1.0),
    };
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let point = |k: u32| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 2000.0).sin_cos();
        camera.project(middle + (x * cos + y * sin) * round).unwrap().0
    };
    (0..2000).map(point).collect()
}

fn judged(model: &Model, tracer: &Tracer, camera: &Camera, lines: &[u32]) -> LineJudgement {
    let settings = DrawingSettings { smooth: false, ..DrawingSettings::default() };
    let image = LineImage { lines, width: 2.0 * HALF, section_width: 4.0 * HALF };
    judge_lines(model, tracer, camera, &settings, image).unwrap()
}

#[test]
fn a_ball_of_triangles_has_the_balls_outline() {
    let model = whole_mesh("ball", ball_mesh(LEVELS));
    let (mut renderer, tracer) = (renderer(), Tracer::new(&model));
    for (view, camera) in [("from afar", perspective(&model, SIZE)), ("parallel", orthographic(&model, SIZE))] {
        let picture = draw_next(&mut renderer, (&model, with(outlines())), &camera);
        let (marked, outline) = (marked(&picture, OUTLINE), outline_of_ball(&camera));
        let bare = outline.iter().filter(|p| away(**p, &marked) > HALF + 0.5 + OFF_BALL).count();
        let stray = marked.iter().filter(|p| away(**p, &outline) > HALF + 0.5 + OFF_BALL + OFF).count();
        assert!(marked.len() > 100, "{view}: {}", marked.len());
        assert_eq!((bare, stray), (0, 0), "{view}: of {} points and {} pixels", outline.len(), marked.len());
        let found = judged(&model, &tracer, &camera, &picture.edge);
        assert!(found.visible > 100 && (found.missing, found.stray) == (0, 0), "{view}: {found:?}");
        let without = judged(&model, &tracer, &camera, &vec![0; picture.edge.len()]);
        assert!(without.missing == without.visible && without.stray == 0, "{view}: {without:?}");
    }
    assert_silent(renderer);
}

/// A block of triangles has creases, at which it turns away, too; across its sides it does not turn.
#[test]
fn creases_are_no_outlines() {
    let model = whole_mesh("block", block_mesh(-DVec3::ONE, DVec3::ONE, 1));
    let camera = perspective(&model, SIZE);
    let mut renderer = renderer();
    let picture = draw_next(&mut renderer, (&model, with(outlines())), &camera);
    assert!(picture.edge.iter().all(|edge| *edge == 0));
    let creases = EdgeSettings { which: EdgeChoice::Sharp, silhouettes: true, ..lines() };
    let picture = draw_next(&mut renderer, (&model, with(creases)), &camera);
    assert!(marked(&picture, OUTLINE).is_empty() && picture.edge.iter().filter(|edge| **edge != 0).count() > 200);
    assert_silent(renderer);
}

/// The outline of a ball behind another one ends where the nearer one hides it.
#[test]
fn a_mesh_hides_outlines_behind_it() {
    let mut model = whole_mesh("balls", ball_mesh(LEVELS));
    let beside = DAffine3::from_translation(DVec3::new(-1.0, 2.5, -0.4));
    model.instances.push(Instance { transform: beside, ..model.instances[0].clone() });
    let camera = perspective(&model, SIZE);
    let picture = draw(&model, with(outlines()), &camera);
    let found = judged(&model, &Tracer::new(&model), &camera, &picture.edge);
    assert!(found.visible > 100 && found.points > found.visible + 20, "{found:?}");
    assert_eq!((found.missing, found.stray), (0, 0), "{found:?}");
}
