//! `selvedge convert`: a model written in the engine's own form.

use crate::args::ConvertArgs;
use crate::target::{self, NATIVE, Target};
use crate::{Outcome, reading, remains};
use anyhow::Result;
use selvedge_io::native;

/// Reads the model and writes it.
pub fn run(args: &ConvertArgs) -> Result<Outcome> {
    let output = [Target::new(&args.output, NATIVE)];
    target::check(&[&args.model], &output)?;
    let import = reading::open(&args.model, &args.read, &args.subdivide)?;
    remains::judge(&args.model, &import.model)?;
    target::check_read(&import, &output)?;
    let bytes = native::write(&import.model);
    target::write(&args.output, |to| Ok(to.write_all(&bytes)?))?;
    tracing::info!("wrote {} bytes to {}", bytes.len(), args.output.display());
    Ok(Outcome::Good)
}
