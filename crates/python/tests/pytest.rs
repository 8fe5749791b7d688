//! Hands the module to Python and runs the tests beside this file.
//!
//! `SELVEDGE_PYTHON` names a Python with numpy and pytest; without it that of `.venv`, which `tools/python` makes. The test
//! fails where there is none, unless `SELVEDGE_WITHOUT` has `python`, which leaves it out.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The module that cargo built beside this test.
fn module() -> PathBuf {
    let folder = env::current_exe().expect("a path").parent().expect("a folder").to_owned();
    let module = folder.join(format!("{}selvedge_python{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX));
    assert!(module.is_file(), "{} was not built", module.display());
    module
}

#[test]
fn python_passes_its_tests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let python = env::var_os("SELVEDGE_PYTHON").map_or_else(|| root.join(".venv/bin/python"), PathBuf::from);
    if env::var("SELVEDGE_WITHOUT").is_ok_and(|left_out| left_out.split(',').any(|name| name == "python")) {
        return;
    }
    let imported = Command::new(&python).args(["-c", "import numpy, pytest"]).status();
    assert!(
        imported.is_ok_and(|status| status.success()),
        "{}: no Python with numpy and pytest; tools/python makes one, and SELVEDGE_WITHOUT=python leaves this test out",
        python.display()
    );
    let site = tempfile::tempdir().expect("a folder");
    let package = site.path().join("selvedge");
    fs::create_dir(&package).expect("a folder");
    for file in fs::read_dir(root.join("crates/python/python/selvedge")).expect("the package") {
        let file = file.expect("a file").path();
        if file.is_file() {
            fs::copy(&file, package.join(file.file_name().expect("a name"))).expect("a copy");
        }
    }
    fs::copy(module(), package.join("_native.abi3.so")).expect("a copy");
    let mut command = Command::new(&python);
    // -rs: why tests are skipped
    command.args(["-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "--durations=5"]);
    command.arg(root.join("crates/python/tests")).env("PYTHONPATH", site.path()).env("PYTHONDONTWRITEBYTECODE", "1");
    let status = command.status().expect("Python runs");
    assert!(status.success(), "pytest: {status}");
}
