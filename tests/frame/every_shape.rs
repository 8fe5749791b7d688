//! Each shape at several sizes, in both projections: no message of the validation layers, and the same picture every
//! time.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, orthographic, perspective, render, watched, watched_for};
use selvedge::picture::{FrameSettings, Outputs, SceneSettings};

fn check(name: &str) {
    let shape = shapes::all().into_iter().find(|s| s.name == name).expect("a shape of that name");
    let mut renderer = watched(&shape.model);
    for size in [(1, 1), (17, 9), (320, 240)] {
        for camera in [perspective(&shape.model, size), orthographic(&shape.model, size)] {
            let picture = render(&mut renderer, &camera);
            assert_eq!(picture.stats.clamps, 0, "{name} at {size:?}");
            let covered = picture.face.iter().filter(|&&face| face != 0).count();
            // the only pixel of the smallest picture may show a hole
            if size != (1, 1) {
                assert_eq!(covered > 0, !shape.model.parts.is_empty(), "{name} at {size:?} covers {covered} pixels");
            }
        }
    }
    // the same again, at once and after another size
    let camera = perspective(&shape.model, (160, 120));
    let first = render(&mut renderer, &camera);
    assert_identical(&first, &render(&mut renderer, &camera), "drawn again");
    render(&mut renderer, &perspective(&shape.model, (200, 33)));
    assert_identical(&first, &render(&mut renderer, &camera), "after a resize and back");
    assert_silent(renderer);
}

macro_rules! every_shape {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name));
            }
        )*

        #[test]
        fn no_shape_is_forgotten() {
            let names: Vec<_> = shapes::all().iter().map(|s| s.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

every_shape!(sphere torus cylinder plate cube wave ripple pair far_away mirrored tetra facets beside globe floor ball touching ledges empty);

#[test]
fn a_full_picture_is_silent() {
    let model = shapes::pair();
    let mut renderer = watched(&model);
    let picture = render(&mut renderer, &perspective(&model, (1920, 1080)));
    assert_eq!(picture.stats.clamps, 0);
    assert_silent(renderer);
}

/// More pixels than one dimension of a dispatch covers on every device: 65,535 workgroups of 64.
#[test]
fn a_larger_picture_than_one_row_of_workgroups_is_silent() {
    let model = shapes::plate();
    let mut renderer = watched_for(Outputs::default(), &model, SceneSettings::default());
    let camera = perspective(&model, (2600, 1700));
    renderer.render(&camera, &FrameSettings::default(), Outputs::default()).unwrap();
    assert_silent(renderer);
}

/// Nothing to draw: the background, and the values of background pixels.
#[test]
fn nothing_is_all_background() {
    let model = shapes::empty();
    let mut renderer = watched(&model);
    let picture = render(&mut renderer, &perspective(&model, (17, 9)));
    assert!(picture.colour.iter().all(|c| *c == [255; 4]));
    assert!(picture.depth.iter().all(|d| *d == f32::INFINITY));
    assert!(picture.face.iter().all(|f| *f == 0));
    assert!(picture.uv.iter().flatten().all(|x| x.is_nan()));
    assert!(picture.normal.iter().flatten().all(|x| *x == 0.0));
    assert_eq!((picture.stats.sub_patches, picture.stats.triangles), (0, 0));
    assert_silent(renderer);
}
