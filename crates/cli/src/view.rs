//! `selvedge view`: models in a window.

use crate::Outcome;
use crate::args::ViewArgs;
use anyhow::Result;
use selvedge_viewer::{ViewError, ViewOptions, run as run_window, settings};
use std::path::PathBuf;

/// Opens the window, and returns when it is closed.
pub fn run(args: &ViewArgs) -> Result<Outcome> {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let usual = settings::path(folder("XDG_CONFIG_HOME"), folder("HOME"));
    let closed = run_window(ViewOptions {
        files: args.models.clone(),
        device: args.device.clone(),
        validation: args.validation,
        settings: args.settings.clone().or(usual),
        size: args.size.map(|size| (size.0, size.1)),
    })?;
    closed.messages.iter().for_each(|message| tracing::error!("validation: {message}"));
    Ok(if closed.messages.is_empty() { Outcome::Good } else { Outcome::Broken })
}

/// The window's device is missing, or failed.
pub fn is_of_device(error: &anyhow::Error) -> bool {
    error.downcast_ref::<ViewError>().is_some_and(ViewError::is_of_device)
}
