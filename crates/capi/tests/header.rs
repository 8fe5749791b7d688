//! include/selvedge.h is cbindgen's output for the sources. `SELVEDGE_WRITE_HEADER=1 cargo test -p selvedge-capi`
//! writes it.

use std::fs;
use std::path::Path;

#[test]
fn the_header_is_that_of_the_sources() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).expect("a configuration");
    let sources = ["border", "host", "scene", "model", "picture", "renderer", "snap"]
        .map(|name| folder.join(format!("src/{name}.rs")));
    let builder = sources.iter().fold(cbindgen::Builder::new().with_config(config), |b, path| b.with_src(path));
    let mut made = Vec::new();
    builder.generate().expect("a header").write(&mut made);
    let made = String::from_utf8(made).expect("text");
    assert!(made.contains("selvedge_render("), "cbindgen found no functions");
    let path = folder.join("include/selvedge.h");
    if std::env::var_os("SELVEDGE_WRITE_HEADER").is_some() {
        fs::write(&path, &made).expect("written");
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == made, "include/selvedge.h is not that of the sources: SELVEDGE_WRITE_HEADER=1 writes it");
}
