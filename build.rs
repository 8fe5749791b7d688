//! GLSL to SPIR-V, and the layouts of the structs that Rust and GLSL share.
//!
//! ```text
//!   feature compile-shaders          glsl/*.comp …  ──shaderc──▶  OUT_DIR/spirv/*.spv, layout.rs, interfaces.rs
//!   otherwise (what embedders get)   glsl/spirv/    ──copied───▶  the same
//!                                                                 OUT_DIR/shaders.rs
//! ```
//!
//! `interfaces.rs` says what each shader needs of its pipeline, `constants.rs` what constants the sources state.
//! `shaders.rs` has one `static` per entry point; `layout.rs` asserts at compile time that each
//! struct of `src/abi` has the offsets and size that the shaders read. `tools/shaders` writes the
//! committed files of `glsl/spirv/` by setting `SELVEDGE_SHADERS_TO`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

#[cfg(feature = "compile-shaders")]
#[path = "build/compile.rs"]
mod compile;
#[cfg(feature = "compile-shaders")]
#[path = "build/constants.rs"]
mod constants;
#[cfg(feature = "compile-shaders")]
#[path = "build/interface.rs"]
mod interface;
#[cfg(feature = "compile-shaders")]
#[path = "build/reflect.rs"]
mod reflect;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=build");
    println!("cargo::rerun-if-env-changed=SELVEDGE_SHADERS_TO");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo names the package's folder"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo names an output folder"));
    let artefacts = out.join("spirv");
    fs::remove_dir_all(&artefacts).ok();
    create_dir(&artefacts);
    make_artefacts(&root, &artefacts);
    if let Some(committed) = env::var_os("SELVEDGE_SHADERS_TO").map(PathBuf::from) {
        fs::remove_dir_all(&committed).ok();
        create_dir(&committed);
        copy_files(&artefacts, &committed);
    }
    write(&out.join("shaders.rs"), list_shaders(&artefacts).as_bytes());
}

#[cfg(feature = "compile-shaders")]
fn make_artefacts(root: &Path, artefacts: &Path) {
    println!("cargo::rerun-if-changed=glsl");
    println!("cargo::rerun-if-changed=src/abi");
    if let Err(message) = compile::all(root, artefacts) {
        panic!("\n{message}\n");
    }
}

#[cfg(not(feature = "compile-shaders"))]
fn make_artefacts(root: &Path, artefacts: &Path) {
    println!("cargo::rerun-if-changed=glsl/spirv");
    copy_files(&root.join("glsl/spirv"), artefacts);
}

/// `shaders.rs`: `scan_add.comp.spv` becomes `SCAN_ADD_COMP`. Those of `glsl/baselines` are there with their feature only.
fn list_shaders(artefacts: &Path) -> String {
    let mut text = String::new();
    for path in files(artefacts).iter().filter(|path| path.extension().is_some_and(|e| e == "spv")) {
        let entry_point = path.file_stem().expect("it has an extension").to_string_lossy();
        let name = entry_point.replace('.', "_").to_uppercase();
        let bytes = fs::metadata(path).map_or_else(|e| panic!("{}: {e}", path.display()), |m| m.len());
        let only = if entry_point.starts_with("baseline_") { "#[cfg(feature = \"baselines\")]\n" } else { "" };
        let words = format!("&words::<{}>(include_bytes!({path:?}))", bytes / 4);
        let value = format!("Shader {{ words: {words}, interface: interfaces::{name} }}");
        writeln!(text, "/// `glsl/{entry_point}`\n{only}pub static {name}: Shader = {value};")
            .expect("writing to a string");
    }
    text
}

fn create_dir(path: &Path) {
    fs::create_dir_all(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

fn write(path: &Path, bytes: &[u8]) {
    fs::write(path, bytes).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

fn copy_files(from: &Path, to: &Path) {
    for path in files(from) {
        let bytes = fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        write(&to.join(path.file_name().expect("a listed file has a name")), &bytes);
    }
}

/// The folders of a folder by name.
#[cfg(feature = "compile-shaders")]
fn folders(folder: &Path) -> Vec<PathBuf> {
    entries(folder).into_iter().filter(|path| path.is_dir()).collect()
}

/// The files of a folder by name, folders left out.
fn files(folder: &Path) -> Vec<PathBuf> {
    entries(folder).into_iter().filter(|path| path.is_file()).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
