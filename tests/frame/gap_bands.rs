//! Lists of gap candidates for bands of rows: the same picture as from one list, bit for bit.

use crate::hidden::crowd;
use crate::shapes;
use crate::support::{assert_identical, assert_silent, perspective, plain, render, render_next};
use crate::watched::{limited, renderer};
use glam::{DAffine3, DVec3};
use selvedge::gpu::LowerLimits;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{Samples, SceneSettings, TrimWay};

const SIZE: (u32, u32) = (500, 200);
/// Candidates that a list has room for: those of 100 rows. A band has a multiple of 30 rows: two have 90, and one 20.
const ROOM: u32 = 500 * 100;
/// A candidate takes 12 bytes.
const LITTLE: LowerLimits = LowerLimits { storage_range: Some(12 * ROOM), ..LowerLimits::NONE };

const BY_ARCS: SceneSettings = plain(TrimWay::Exact);

/// Closed parts whose faces are turned inside out, so that every pixel of them shows a back face: 16 by 6 cubes of 30
/// pixels, a pixel and a half apart. No pixel is so far from all borders that it is left out.
fn inside_out() -> (Model, Camera) {
    let mut model = shapes::cube();
    model.parts[0].faces.iter_mut().for_each(|face| face.same_sense = !face.same_sense);
    let side = 2.0 * shapes::CUBE_HALF;
    let place = |i: u32| 1.05 * side * DVec3::new(f64::from(i % 16), f64::from(i / 16), 0.0);
    model.instances = (0..16 * 6).map(|i| shapes::placed(DAffine3::from_translation(place(i)), None)).collect();
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, SIZE);
    let height = side * f64::from(SIZE.1) / 30.0;
    (model, Camera { projection: Projection::Orthographic { height }, ..above })
}

/// More candidates than one list has room for. Each band has more than its list begins with room for.
#[test]
fn a_picture_has_more_candidates_than_a_buffer_holds() {
    let (model, camera) = inside_out();
    let mut in_bands = limited(LITTLE);
    in_bands.upload_with(&model, BY_ARCS).unwrap();
    let banded = render(&mut in_bands, &camera);
    let again = render(&mut in_bands, &camera);
    assert!(banded.stats.gap_candidates > u64::from(ROOM), "{:?}", banded.stats);
    assert_eq!((banded.stats.retries, again.stats.retries), (1, 0), "{:?}", banded.stats);
    assert_identical(&banded, &again, "with room from the start");
    assert_silent(in_bands);

    let mut unlimited = renderer();
    let whole = render_next(&mut unlimited, &model, BY_ARCS, &camera);
    assert_eq!(whole.stats.gap_candidates, banded.stats.gap_candidates);
    assert_identical(&whole, &banded, "in bands");
    assert_silent(unlimited);
}

/// The scene has real gaps. Of several samples each is drawn by itself, so each fills the lists anew.
#[test]
fn gaps_are_filled_the_same_in_bands() {
    let model = crowd();
    let camera = perspective(&model, SIZE);
    let mut unlimited = renderer();
    for samples in [Samples::One, Samples::Four] {
        let settings = SceneSettings { samples, ..BY_ARCS };
        let mut in_bands = limited(LITTLE);
        in_bands.upload_with(&model, settings).unwrap();
        let banded = render(&mut in_bands, &camera);
        let lists = in_bands.objects().iter().filter(|name| *name == "gap candidates").count();
        assert_eq!(lists, 3, "{samples:?}");
        assert_silent(in_bands);
        let whole = render_next(&mut unlimited, &model, settings, &camera);
        assert_eq!(whole.stats.gap_candidates, banded.stats.gap_candidates, "{samples:?}");
        assert!(whole.stats.gap_candidates > 100, "{samples:?}: {:?}", whole.stats);
        assert_identical(&whole, &banded, &format!("{samples:?}"));
    }
    assert_silent(unlimited);
}
