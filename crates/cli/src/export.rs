//! `selvedge export`: a model as a STEP file.

use crate::args::ExportArgs;
use crate::target::{self, STEP, Target};
use crate::{Outcome, reading, remains};
use anyhow::Result;
use selvedge_io::export;

/// Reads the model and writes the file.
pub fn run(args: &ExportArgs) -> Result<Outcome> {
    let output = [Target::new(&args.output, STEP)];
    target::check(&[&args.model], &output)?;
    let import = reading::open(&args.model, &args.read, &args.subdivide)?;
    remains::judge(&args.model, &import.model)?;
    target::check_read(&import, &output)?;
    let model = import.model;
    let mut warnings = Vec::new();
    target::write(&args.output, |mut to| {
        warnings = export::step(&model, &mut to)?;
        Ok(())
    })?;
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
