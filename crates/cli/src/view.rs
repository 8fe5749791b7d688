//! `selvedge view`: models in a window.

use crate::Outcome;
use crate::args::ViewArgs;
use anyhow::Result;
use selvedge_viewer::{ViewError, ViewOptions, run as run_window, settings};
use std::path::PathBuf;

/// Opens the window, and returns when it is closed.
pub fn run(args: &ViewArgs) -> Result<Outcome> {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let desktop = settings::folder(folder("XDG_CONFIG_HOME"), folder("HOME"));
    let usual = desktop.as_deref().map(settings::path);
    let closed = run_window(ViewOptions {
        files: args.models.clone(),
        device: args.device.clone(),
        validation: args.validation,
        settings: args.settings.clone().or(usual),
        desktop,
        size: args.size.map(|size| (size.0, size.1)),
        ..ViewOptions::default()
    })?;
    closed.messages.iter().for_each(|message| tracing::error!("validation: {message}"));
    Ok(if closed.messages.is_empty() { Outcome::Good } else { Outcome::Broken })
}

/// The window's device is missing, or failed.
pub fn is_of_device(error: &anyhow::Error) -> bool {
    error.downcast_ref::<ViewError>().is_some_and(ViewError::is_of_device)
}

#[cfg(test)]
mod pictures;

#[cfg(test)]
mod tests {
    use super::settings::Settings;
    use glam::{DAffine3, DVec3};
    use selvedge::model::{Instance, Mesh, Model, Part};
    use selvedge::picture::Samples;
    use selvedge_jobs::Ambient;

    /// The window and `render` have a share each of the model's diagonal.
    #[test]
    fn ambient_occlusion_reaches_as_far_in_the_window_as_in_render() {
        let corners = vec![DVec3::ZERO, DVec3::X * 6.0, DVec3::new(6.0, 6.0, 8.0)];
        let mesh = Mesh::new(1, corners, vec![[0, 1, 2]], vec![]).expect("a triangle");
        let part = Part { meshes: vec![mesh], ..Part::default() };
        let placed = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        let model = Model { parts: vec![part], instances: vec![placed], ..Model::default() };
        let settings = Settings { ambient: true, ..Settings::default() };
        let radius = settings.ambient_radius(model.control_bounds().diagonal());
        assert!(radius.is_some());
        assert_eq!(radius, Ambient::radius(Some(Ambient::Auto), Samples::One, &model));
    }
}
