//! `selvedge convert`: a model written in another form, which the extension of the file chooses.

use crate::args::ConvertArgs;
use crate::{Outcome, output, session};
use anyhow::{Result, bail};
use selvedge_io::native;
use std::io::Write;

/// Reads the model and writes it.
pub fn run(args: &ConvertArgs) -> Result<Outcome> {
    let extension = args.output.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let write = match extension.as_deref() {
        Some("selvedge") => native::write,
        _ => bail!("{}: writes .selvedge files only", args.output.display()),
    };
    let import = session::open(&args.model, &args.subdivide)?;
    let bytes = write(&import.model);
    output::file(&args.output, |to| Ok(to.write_all(&bytes)?))?;
    tracing::info!("wrote {} bytes to {}", bytes.len(), args.output.display());
    Ok(Outcome::Good)
}
