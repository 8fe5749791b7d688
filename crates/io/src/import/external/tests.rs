//! Assemblies in several files, held in memory.

use super::Files;
use crate::import::{Import, Options, step_with};
use glam::DVec3;
use std::io;
use std::sync::Mutex;

/// Two places, at x = 0 and 30, of a bolt that stands in `t8_bolt.stp`.
const ASSEMBLY: &str = include_str!("tests/assembly.stp");
/// A box of 10 mm.
const BOLT: &str = include_str!("tests/bolt.stp");

/// Files by their names; those that were read, in order.
struct Shelf {
    files: Vec<(&'static str, String)>,
    read: Mutex<Vec<String>>,
}

impl Shelf {
    fn new(files: &[(&'static str, &str)]) -> Self {
        let files = files.iter().map(|(name, text)| (*name, (*text).to_owned())).collect();
        Self { files, read: Mutex::default() }
    }

    /// Reads the file with the others on the shelf.
    fn open(&self, name: &str) -> Import {
        let text = self.files.iter().find(|f| f.0 == name).unwrap().1.clone();
        step_with(text.as_bytes(), name, &Options { files: Some(self), ..Options::default() }).unwrap()
    }

    fn read(&self) -> Vec<String> {
        self.read.lock().unwrap().clone()
    }
}

impl Files for Shelf {
    fn find(&self, name: &str, _from: &str) -> Option<String> {
        self.files.iter().find(|f| f.0 == name).map(|f| f.0.to_owned())
    }

    fn read(&self, found: &str, _: u64) -> io::Result<Vec<u8>> {
        self.read.lock().unwrap().push(found.to_owned());
        let file = self.files.iter().find(|f| f.0 == found).unwrap();
        if file.1.is_empty() { Err(io::Error::other("worn out")) } else { Ok(file.1.clone().into_bytes()) }
    }
}

fn told(import: &Import) -> Vec<String> {
    import.warnings.iter().map(ToString::to_string).collect()
}

/// Where the origin of each instance stands.
fn xs(import: &Import) -> Vec<f64> {
    import.model.instances.iter().map(|i| i.transform.transform_point3(DVec3::ZERO).x).collect()
}

#[test]
fn parts_of_another_file_stand_in_their_places() {
    let shelf = Shelf::new(&[("a.stp", ASSEMBLY), ("t8_bolt.stp", BOLT)]);
    let found = shelf.open("a.stp");
    assert_eq!(told(&found), [""; 0]);
    assert_eq!((found.model.parts.len(), found.model.face_instance_count(), xs(&found)), (1, 12, vec![0.0, 30.0]));
    assert_eq!(shelf.read(), ["t8_bolt.stp"]);
    let report = &found.report;
    assert_eq!((report.faces, report.bodies, report.face_records.len()), (6, 1, 6));
    assert_eq!(report.occurrences, ["o0", "o1"]);
    assert_eq!((report.external_files.as_slice(), report.missing_files.len()), (&["t8_bolt.stp".to_owned()][..], 0));
    assert_eq!((found.model.unit.as_str(), found.model.name.as_str()), ("mm", "assembly"));
}

/// The limit on a file counts for each of them.
#[test]
fn a_file_beyond_the_limit_is_left_out_by_name() {
    let shelf = Shelf::new(&[("a.stp", ASSEMBLY), ("t8_bolt.stp", BOLT)]);
    let read = |most: usize| {
        let options = Options { files: Some(&shelf), most_bytes: Some(most as u64), ..Options::default() };
        step_with(ASSEMBLY.as_bytes(), "a.stp", &options).unwrap()
    };
    assert_eq!(read(BOLT.len()).model.instances.len(), 2);
    let (most, short) = (BOLT.len() - 1, read(BOLT.len() - 1));
    let why = format!("external file not read: t8_bolt.stp: larger than {most} bytes, the most that is read");
    assert_eq!(told(&short), [format!("a.stp:28: #21: {why}")]);
    assert_eq!((short.model.instances.len(), short.report.missing_files), (0, vec!["t8_bolt.stp".to_owned()]));
}

#[test]
fn files_that_are_not_there_are_named() {
    let missing = Shelf::new(&[("a.stp", ASSEMBLY)]);
    for (found, message) in [
        (missing.open("a.stp"), "a.stp:28: #21: external file not read: t8_bolt.stp is not found"),
        (
            crate::import::step(ASSEMBLY.as_bytes(), "a.stp").unwrap(),
            "a.stp:28: #21: external file not followed: t8_bolt.stp",
        ),
        (
            Shelf::new(&[("a.stp", ASSEMBLY), ("t8_bolt.stp", "")]).open("a.stp"),
            "a.stp:28: #21: external file not read: t8_bolt.stp: worn out",
        ),
        (
            Shelf::new(&[("a.stp", ASSEMBLY), ("t8_bolt.stp", "no CAD")]).open("a.stp"),
            "a.stp:28: #21: external file not read: t8_bolt.stp: not STEP: no `ISO-10303-21;` at the start",
        ),
    ] {
        assert_eq!(told(&found).iter().map(|w| w.replace("stp:1: not", "stp: not")).collect::<Vec<_>>(), [message]);
        assert_eq!(
            (found.model.instances.len(), found.report.missing_files.as_slice()),
            (0, &["t8_bolt.stp".to_owned()][..])
        );
    }
}

/// The name in every attribute that a writer puts it in, and the ways in which a document becomes a part's.
#[test]
fn names_and_links_as_writers_put_them() {
    let (file, assigned) = ("DOCUMENT_FILE('','','',#20,'',$)", "ASSIGNMENT('t8_bolt.stp',#23,#24,(#21))");
    let (source, reference) = ("IDENTIFIER('')", "#28=APPLIED_DOCUMENT_REFERENCE(#21,'',(#12));");
    let property = "#27=PROPERTY_DEFINITION_REPRESENTATION(#26,#18);";
    let none = "ASSIGNMENT('',#23,#24,(#21))";
    for edits in [
        // CATIA: the id of the document
        &[(file, "DOCUMENT_FILE('t8_bolt.stp','','',#20,'',$)"), (assigned, none)][..],
        // a number for an id, the file as its name
        &[(file, "DOCUMENT_FILE('4711','t8_bolt.stp','the bolt',#20,'',$)"), (assigned, none)],
        // Creo: a title for a name, the source repeats the file
        &[(file, "DOCUMENT_FILE('t8_bolt.stp','THE - BOLT','',#20,'',$)"), (source, "IDENTIFIER('t8_bolt.stp')")],
        // the source alone
        &[(assigned, none), (source, "IDENTIFIER('t8_bolt.stp')")],
        // linked once: by the product, its version, the product itself, or the shape alone
        &[(property, "")],
        &[(property, ""), ("(#21,'',(#12))", "(#21,'',(#11))")],
        &[(property, ""), ("(#21,'',(#12))", "(#21,'',(#10))")],
        &[(reference, "")],
        // the document is a product, whose version has the file
        &[
            (property, ""),
            (
                reference,
                "#28=APPLIED_DOCUMENT_REFERENCE(#60,'',(#12));#60=DOCUMENT('d','','',#20);#61=PRODUCT('d','d','',(#8));\
                 #62=PRODUCT_DEFINITION_FORMATION('','',#61);#63=DOCUMENT_PRODUCT_EQUIVALENCE('equivalence',$,#60,#62);\
                 #64=PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS('','',#62,#9,(#21));",
            ),
        ],
        // the version of the part itself has it
        &[(property, ""), (reference, "#28=PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS('','',#11,#9,(#21));")],
    ] {
        let text = edits.iter().fold(ASSEMBLY.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replace(from, to)
        });
        let found = Shelf::new(&[("a.stp", &text), ("t8_bolt.stp", BOLT)]).open("a.stp");
        assert_eq!((told(&found), xs(&found)), (vec![], vec![0.0, 30.0]), "{edits:?}");
    }
}

/// One shape in two documents is drawn once; a shape that stands here, too, not from its document.
#[test]
fn a_part_is_drawn_once_however_many_documents_hold_it() {
    let second =
        "#70=DOCUMENT_FILE('bolt.jt','','',#20,'',$);#71=APPLIED_DOCUMENT_REFERENCE(#70,'',(#12));ENDSEC;\nEND-";
    let both = ASSEMBLY.replace("ENDSEC;\nEND-", second);
    for files in [&[("a.stp", both.as_str()), ("t8_bolt.stp", BOLT)][..], &[("a.stp", &both), ("bolt.jt", BOLT)]] {
        let found = Shelf::new(files).open("a.stp");
        assert_eq!((told(&found), xs(&found)), (vec![], vec![0.0, 30.0]));
    }
    let none = Shelf::new(&[("a.stp", both.as_str())]).open("a.stp");
    let [first, second] =
        ["t8_bolt.stp", "bolt.jt"].map(|n| format!("a.stp:28: #21: external file not read: {n} is not found"));
    assert_eq!(told(&none), [first, second]);

    let own = BOLT.replace(
        "#169=SHAPE",
        "#900=DOCUMENT_TYPE('');#901=DOCUMENT_FILE('b.stp','','',#900,'',$);\
        #902=APPLIED_DOCUMENT_REFERENCE(#901,'',(#166));#169=SHAPE",
    );
    let shelf = Shelf::new(&[("a.stp", &own), ("b.stp", BOLT)]);
    let found = shelf.open("a.stp");
    assert_eq!((told(&found), found.model.instances.len(), shelf.read().len()), (vec![], 1, 0));
    assert_eq!(found.report.ignored["documents of no shape, or of one that stands here"], 1);
}

/// Assemblies of assemblies: each file is read once, colours and names go down, a ring ends with its name.
#[test]
fn files_of_files_and_rings() {
    let outer = ASSEMBLY.replace("t8_bolt.stp", "inner.stp");
    let shelf = Shelf::new(&[("outer.stp", &outer), ("inner.stp", ASSEMBLY), ("t8_bolt.stp", BOLT)]);
    let found = shelf.open("outer.stp");
    assert_eq!((told(&found), xs(&found)), (vec![], vec![0.0, 30.0, 30.0, 60.0]));
    assert_eq!(shelf.read(), ["inner.stp", "t8_bolt.stp"]);
    assert_eq!(found.report.occurrences, ["o0/o0", "o0/o1", "o1/o0", "o1/o1"]);
    assert_eq!((found.model.parts.len(), found.report.faces), (1, 6));

    let ring = ASSEMBLY.replace("t8_bolt.stp", "outer.stp");
    let found = Shelf::new(&[("outer.stp", &outer), ("inner.stp", &ring)]).open("outer.stp");
    assert_eq!(found.model.instances.len(), 0);
    assert!(
        told(&found).contains(&"inner.stp:28: #21: external file left out: outer.stp contains itself".to_owned()),
        "{:?}",
        told(&found)
    );
    let itself = ASSEMBLY.replace("t8_bolt.stp", "a.stp");
    let found = Shelf::new(&[("a.stp", &itself)]).open("a.stp");
    assert_eq!(told(&found), ["a.stp:28: #21: external file left out: a.stp contains itself"]);
}

/// Twenty-five files of two places each ask for 2^25 instances.
#[test]
fn instances_of_all_files_are_bounded() {
    let names: Vec<&'static str> = (0..26).map(|i| &*format!("level{i}.stp").leak()).collect();
    let texts: Vec<String> = (0..25).map(|i| ASSEMBLY.replace("t8_bolt.stp", names[i + 1])).collect();
    let mut files: Vec<_> = (0..25).map(|i| (names[i], texts[i].as_str())).collect();
    files.push((names[25], BOLT));
    let found = Shelf::new(&files).open(names[0]);
    assert!(found.model.instances.len() <= 1 << 20);
    assert!(told(&found).iter().any(|w| w.contains("is one of more than 1048576 instances")), "{:?}", told(&found));
}

/// Warnings about a mentioned file carry that file's name.
#[test]
fn warnings_of_the_other_file_name_it() {
    let damaged = BOLT.replacen("PLANE('',", "PLAIN('',", 1);
    let found = Shelf::new(&[("a.stp", ASSEMBLY), ("t8_bolt.stp", &damaged)]).open("a.stp");
    assert_eq!((found.model.face_instance_count(), found.report.faces), (10, 6));
    let told = told(&found);
    assert!(
        told.len() == 1 && told[0].starts_with("t8_bolt.stp:") && told[0].contains("PLAIN is not supported"),
        "{told:?}"
    );
    assert_eq!(found.report.warnings["face left out"], 1);
}
