//! Every entry point of `glsl/` by shaderc, twice: unoptimised for its names, optimised to ship.

use crate::{constants, files, folders, interface, reflect, write};
use std::fs;
use std::path::{Path, PathBuf};

/// Compiles `root/glsl` into `artefacts`, with `layout.rs`, `interfaces.rs` and `constants.rs`. The error is shaderc's, with file and line.
pub fn all(root: &Path, artefacts: &Path) -> Result<(), String> {
    let glsl = root.join("glsl");
    let compiler = shaderc::Compiler::new().map_err(|e| format!("shaderc does not start: {e}"))?;
    let reflected = options(&glsl, shaderc::OptimizationLevel::Zero)?;
    let shipped = options(&glsl, shaderc::OptimizationLevel::Performance)?;
    let mut layouts = reflect::Layouts::new(&root.join("src/abi"))?;
    let mut interfaces = interface::Interfaces::default();
    let mut errors = Vec::new();
    for path in entry_points(&glsl) {
        let kind = match path.extension().and_then(|extension| extension.to_str()) {
            Some("comp") => shaderc::ShaderKind::Compute,
            Some("vert") => shaderc::ShaderKind::Vertex,
            Some("tesc") => shaderc::ShaderKind::TessControl,
            Some("tese") => shaderc::ShaderKind::TessEvaluation,
            Some("frag") => shaderc::ShaderKind::Fragment,
            _ => continue,
        };
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let source = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let compile =
            |options| compiler.compile_into_spirv(&source, kind, &format!("glsl/{name}"), "main", Some(options));
        match compile(&reflected) {
            Ok(module) => {
                layouts.add(&name, module.as_binary())?;
                interfaces.add(&name, module.as_binary())?;
            }
            Err(error) => {
                errors.push(error.to_string());
                continue;
            }
        }
        let module = compile(&shipped).map_err(|e| e.to_string())?;
        write(&artefacts.join(format!("{name}.spv")), module.as_binary_u8());
    }
    if !errors.is_empty() {
        return Err(errors.join("\n"));
    }
    write(&artefacts.join("interfaces.rs"), interfaces.text().as_bytes());
    write(&artefacts.join("constants.rs"), constants::of_sources(&glsl)?.as_bytes());
    write(&artefacts.join("layout.rs"), layouts.assertions()?.as_bytes());
    Ok(())
}

/// Every file of the folders of `glsl`, one folder a stage, but for what they include.
fn entry_points(glsl: &Path) -> Vec<PathBuf> {
    let stages = folders(glsl).into_iter().filter(|folder| !folder.ends_with("include") && !folder.ends_with("spirv"));
    stages.flat_map(|folder| files(&folder)).collect()
}

fn options(glsl: &Path, level: shaderc::OptimizationLevel) -> Result<shaderc::CompileOptions<'static>, String> {
    let include = glsl.join("include");
    let mut options = shaderc::CompileOptions::new().map_err(|e| format!("shaderc has no options: {e}"))?;
    options.set_target_env(shaderc::TargetEnv::Vulkan, shaderc::EnvVersion::Vulkan1_3 as u32);
    options.set_optimization_level(level);
    options.set_warnings_as_errors();
    options.set_include_callback(move |name, _, from, _| {
        let content = fs::read_to_string(include.join(name)).map_err(|e| format!("\"{name}\" of {from}: {e}"))?;
        Ok(shaderc::ResolvedInclude { resolved_name: format!("glsl/include/{name}"), content })
    });
    Ok(options)
}
