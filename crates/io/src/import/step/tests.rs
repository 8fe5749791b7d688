//! Whole files: hand-made snippets with exact numbers, damaged files, and the models of a folder.

mod assemblies;
mod classes;
mod closing;
mod colours;
mod csg;
mod damage;
mod derived;
mod edges;
mod looks;
mod models;
mod once;
mod places;
mod repaired;
mod shapes;
mod swept;
mod tessellated;
mod texts;
mod units;

use crate::import::{Import, step};

/// A file with this data section.
fn wrap(data: &str) -> String {
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('t','',(''),(''),'','the writer','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n{data}\nENDSEC;\nEND-ISO-10303-21;\n"
    )
}

/// Reads a file with this data section.
fn import(data: &str) -> Import {
    step(wrap(data).as_bytes(), "t.step").expect("a STEP file")
}
