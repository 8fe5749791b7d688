//! `selvedge export`: a model as a STEP file.

use crate::args::ExportArgs;
use crate::{Outcome, session};
use anyhow::{Context, Result};
use selvedge_io::export;
use std::fs::File;
use std::io::{BufWriter, Write};

/// Reads the model and writes the file.
pub fn run(args: &ExportArgs) -> Result<Outcome> {
    let model = session::open(&args.model, &args.subdivide)?.model;
    let name = || args.output.display().to_string();
    let mut out = BufWriter::new(File::create(&args.output).with_context(name)?);
    let warnings = export::step(&model, &mut out).with_context(name)?;
    out.flush().with_context(name)?;
    if model.trim.is_some() {
        tracing::warn!("the faces are written whole: the form cannot say that a volume trims them");
    }
    for w in warnings {
        let name = match w.item {
            export::Item::Part(p) => model.parts.get(p).map_or("", |p| &p.name),
            export::Item::Solid(_) => "",
        };
        tracing::warn!("{} {name:?}: {}", w.item, w.message);
    }
    Ok(Outcome::Good)
}
