//! Parts that come one after another.

use super::structure::SQUARE;
use super::{Entity, GLOBAL, e, file};
use crate::import::previewed::{grow_to, previews};
use crate::import::{Options, iges};

#[test]
fn parts_come_one_after_another() {
    // squares of one level are a part
    let squares: Vec<Entity> = (1..=600).map(|level| Entity { level, ..e(SQUARE) }).collect();
    let text = file(GLOBAL, &squares);
    let read = |options: &Options<'_>| iges::read(text.as_bytes(), "t.igs", options).unwrap();
    let (previews, import) = previews(read, &Options::default());
    let done = |n: usize| previews[n].face_count();
    assert_eq!((import.model.parts.len(), previews.len(), done(0), done(1)), (600, 2, 256, 512));
    grow_to(&previews, &import.model);
}
