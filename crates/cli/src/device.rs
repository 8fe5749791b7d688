//! The device that draws, and `selvedge devices`, which lists all of them.
//!
//! Compiled pipelines are stored in the user's cache folder of the XDG Base Directory Specification 0.8:
//! `$XDG_CACHE_HOME/selvedge`, or `~/.cache/selvedge`.

use crate::Outcome;
use crate::args::DevicesArgs;
use crate::output;
use anyhow::Result;
use selvedge::headless::{DeviceSummary, HeadlessOptions, devices};
use std::path::PathBuf;

/// Options of the device whose name contains `name`.
pub fn options(name: Option<&str>, validation: bool) -> HeadlessOptions {
    let folder = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let pipeline_folder = cache(folder("XDG_CACHE_HOME"), folder("HOME"));
    HeadlessOptions { device: name.map(str::to_owned), validation, pipeline_folder, ..Default::default() }
}

fn cache(cache_home: Option<PathBuf>, home: Option<PathBuf>) -> Option<PathBuf> {
    // the specification calls relative paths invalid: they are ignored
    let absolute = cache_home.filter(|folder| folder.is_absolute());
    let folder = absolute.or_else(|| home.filter(|home| home.is_absolute()).map(|home| home.join(".cache")))?;
    Some(folder.join("selvedge"))
}

/// `selvedge devices`.
pub fn run(args: &DevicesArgs) -> Result<Outcome> {
    let all = devices()?;
    let text = if args.json {
        serde_json::to_string_pretty(&all)?
    } else {
        all.iter().map(described).collect::<Vec<_>>().join("\n\n")
    };
    output::print(&text)?;
    Ok(Outcome::Good)
}

fn described(device: &DeviceSummary) -> String {
    let limits = &device.limits;
    let has = |has: bool| if has { "yes" } else { "no" };
    let mib = |bytes: u64| format!("{:.0} MiB", bytes as f64 / f64::from(1 << 20));
    let runs = match device.lacks() {
        Some(what) => format!("no, it lacks {what}"),
        None if device.is_default => "yes, and is taken where no other is named".to_owned(),
        None => "yes".to_owned(),
    };
    let lines = [
        ("selvedge runs on it", runs),
        ("kind", device.kind.to_owned()),
        ("driver", device.driver.clone()),
        ("Vulkan", device.vulkan.clone()),
        ("device memory", mib(limits.device_memory_bytes)),
        ("driver tells what is left", has(limits.tells_budget).to_owned()),
        ("largest list, written", mib(limits.storage_buffer_bytes)),
        ("largest list, read", mib(limits.texel_buffer_bytes)),
        ("largest picture", format!("{0} x {0} px", limits.picture_px)),
        ("segments of a side", limits.tessellation_level.to_string()),
        (
            "vertices of a tessellated draw",
            limits.tessellated_vertices.map_or("any number".to_owned(), |most| format!("at most {most}")),
        ),
        ("workgroups of a dispatch", limits.workgroups.to_string()),
        ("subgroup sizes", format!("{} to {}", limits.subgroup_sizes[0], limits.subgroup_sizes[1])),
        ("times of passes", has(limits.has_timestamps).to_owned()),
        ("counts of triangles", has(limits.counts_triangles).to_owned()),
    ];
    let lines = lines.map(|(what, value)| format!("\n  {:<32}{value}", format!("{what}:")));
    format!("{}{}", device.name, lines.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cache_is_where_the_specification_has_it() {
        let at = |cache_home: Option<&str>, home: Option<&str>| {
            cache(cache_home.map(PathBuf::from), home.map(PathBuf::from))
        };
        assert_eq!(at(Some("/c"), Some("/h")), Some(PathBuf::from("/c/selvedge")));
        assert_eq!(at(Some("relative"), Some("/h")), Some(PathBuf::from("/h/.cache/selvedge")));
        assert_eq!(at(None, Some("h")), None);
        assert_eq!(at(None, None), None);
    }
}
