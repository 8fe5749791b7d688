//! Previews of imports, kept for tests: parts of the model in the end, each of them valid.

use super::{Files, Import, Options, Preview, step, step_with};
use crate::export;
use crate::model::{Instance, Model, Part};
use glam::{DAffine3, DVec3};
use std::sync::{Mutex, PoisonError};

/// Takes all previews that it is offered.
#[derive(Default)]
struct All(Mutex<Vec<Model>>);

impl Preview for All {
    fn is_due(&self) -> bool {
        true
    }

    fn take(&self, model: Model) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(model);
    }
}

/// Reads with previews, and returns them beside the import. Without previews it is the same.
pub(super) fn previews(read: impl Fn(&Options<'_>) -> Import, options: &Options<'_>) -> (Vec<Model>, Import) {
    let all = All::default();
    let import = read(&Options { preview: Some(&all), ..*options });
    let plain = read(options);
    assert_eq!(import.model, plain.model);
    assert_eq!((import.warnings.as_slice(), &import.report), (plain.warnings.as_slice(), &plain.report));
    (all.0.into_inner().unwrap_or_else(PoisonError::into_inner), import)
}

fn is_empty(part: &Part) -> bool {
    part.faces.is_empty() && part.meshes.is_empty()
}

/// Each preview has more parts of the model than the one before, and nothing else.
pub(super) fn grow_to(previews: &[Model], whole: &Model) {
    let mut before = 0;
    for preview in previews {
        assert_eq!(preview.check(), Ok(()));
        assert_eq!((&preview.instances, &preview.unit, &preview.name), (&whole.instances, &whole.unit, &whole.name));
        assert_eq!(preview.parts.len(), whole.parts.len());
        let done = preview.parts.iter().position(is_empty).expect("a part is missing");
        assert!(before < done, "{done} parts after {before}");
        assert_eq!(preview.parts[..done], whole.parts[..done]);
        for (waiting, part) in preview.parts[done..].iter().zip(&whole.parts[done..]) {
            assert_eq!(*waiting, Part { name: part.name.clone(), ..Part::default() });
        }
        before = done;
    }
}

/// The sample's parts again and again, beside each other.
fn many() -> Model {
    let once = step(include_bytes!("../../../../samples/assembly.step"), "assembly.step").unwrap().model;
    let (mut model, width) = (Model::default(), once.bounds().diagonal());
    for nth in 0..12 {
        let (first, aside) = (model.parts.len(), DAffine3::from_translation(DVec3::X * width * f64::from(nth)));
        model.parts.extend(once.parts.iter().cloned());
        let moved = |i: &Instance| Instance { part: i.part + first, transform: aside * i.transform, ..i.clone() };
        model.instances.extend(once.instances.iter().map(moved));
    }
    model
}

#[test]
fn parts_of_step_come_one_after_another() {
    let mut text = Vec::new();
    export::step(&many(), &mut text).unwrap();
    let read = |options: &Options<'_>| step_with(&text, "many.step", options).unwrap();
    let (previews, import) = previews(read, &Options::default());
    // a preview is made after 256 faces and more
    let fewest = import.model.face_count() / 512;
    assert!(fewest >= 2 && previews.len() >= fewest, "{} previews of {fewest}", previews.len());
    grow_to(&previews, &import.model);
}

/// The importer tests between parts whether a preview is due, and copies nothing where none is.
#[test]
fn nothing_is_taken_that_is_not_due() {
    struct Never;
    impl Preview for Never {
        fn is_due(&self) -> bool {
            false
        }

        fn take(&self, _: Model) {
            panic!("it is not due");
        }
    }
    let mut text = Vec::new();
    export::step(&many(), &mut text).unwrap();
    let options = Options { preview: Some(&Never), ..Options::default() };
    assert!(step_with(&text, "many.step", &options).unwrap().model.face_count() > 512);
}

/// A bolt and a nut, each in a file of its own.
struct Two;

impl Files for Two {
    fn find(&self, name: &str, _: &str) -> Option<String> {
        ["bolt.stp", "nut.stp"].contains(&name).then(|| name.to_owned())
    }

    fn read(&self, _: &str, _: u64) -> std::io::Result<Vec<u8>> {
        Ok(include_bytes!("external/tests/bolt.stp").to_vec())
    }
}

#[test]
fn files_of_an_assembly_come_one_after_another() {
    let text = include_str!("external/tests/pair.stp");
    let options = Options { files: Some(&Two), ..Options::default() };
    let read = |options: &Options<'_>| step_with(text.as_bytes(), "pair.stp", options).unwrap();
    let (previews, import) = previews(read, &options);
    // before the first file, and before the second one
    let counts: Vec<_> = previews.iter().map(|m| (m.parts.len(), m.instances.len())).collect();
    assert_eq!(counts, [(0, 0), (1, 1)]);
    let whole = &import.model;
    assert_eq!((whole.parts.len(), whole.instances.len()), (2, 2));
    assert!(previews[1].check().is_ok() && previews[1].parts[0] == whole.parts[0]);
    assert!(whole.instances.contains(&previews[1].instances[0]));
}
