//! The rules of `ARCHITECTURE.md` that Cargo does not enforce: which module may use which within a crate.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules that each module of the library may use. A new module needs a line here and in `ARCHITECTURE.md`.
const MAY_USE: &[(&str, &[&str])] = &[
    // selvedge-geometry
    ("math", &[]),
    ("spline", &["math"]),
    ("model", &["csg", "math", "spline"]),
    ("trim", &["csg", "math", "spline", "model"]),
    ("construct", &["math", "spline", "model", "trim"]),
    ("edges", &["math", "silhouette", "spline", "trim", "model"]),
    ("silhouette", &["math", "spline"]),
    // with "describe" and "session" for the viewer's module of that name
    ("measure", &["describe", "edges", "math", "model", "session", "spline", "trim"]),
    ("csg", &[]),
    // selvedge-io
    ("brep", &["math", "spline", "trim", "model"]),
    ("import", &["brep", "construct", "csg", "native", "math", "spline", "model"]),
    ("export", &["construct", "csg", "edges", "spline", "trim", "model"]),
    ("native", &["model"]),
    // selvedge-check and selvedge-jobs: Cargo enforces it
    ("check", &[]),
    ("jobs", &[]),
    // selvedge-viewer: without a window
    ("navigation", &[]),
    ("pacing", &[]),
    ("desktop", &[]),
    ("watch", &[]),
    ("session", &[]),
    ("settings", &["navigation"]),
    ("commands", &["navigation"]),
    ("pick", &["session"]),
    ("view", &["navigation", "pacing", "pick"]),
    ("describe", &["session", "settings"]),
    ("panels", &["commands", "describe", "measure", "navigation", "pick", "session", "settings", "view"]),
    (
        "window",
        &[
            "commands",
            "describe",
            "desktop",
            "measure",
            "navigation",
            "panels",
            "pick",
            "session",
            "settings",
            "view",
            "watch",
        ],
    ),
    // the engine: without a GPU
    ("picture", &["baselines", "model"]),
    ("budget", &[]),
    ("abi", &[]),
    ("twin", &["abi", "math", "spline", "trim", "model"]),
    // for tests and measurements
    ("fixtures", &["abi", "budget", "math", "model", "picture", "scene", "spline", "twin"]),
    // GPU: no geometry
    ("gpu", &[]),
    ("shaders", &["gpu"]),
    ("bindings", &["gpu", "shaders"]),
    // geometry and GPU
    ("scene", &["abi", "bindings", "csg", "edges", "gpu", "math", "spline", "trim", "model", "picture", "baselines"]),
    ("frame", &["abi", "baselines", "bindings", "gpu", "picture", "scene", "shaders"]),
    ("renderer", &["abi", "budget", "frame", "gpu", "model", "picture", "scene"]),
    ("headless", &["baselines", "gpu", "model", "picture", "renderer", "scene"]),
    // for benchmarks and tests
    ("baselines", &["abi", "fixtures", "math", "model", "picture", "scene", "spline", "trim", "twin"]),
];

/// Modules that may name Vulkan's types.
const VULKAN: &[&str] = &["gpu", "scene", "frame", "renderer", "headless", "window"];
/// Modules that may contain `unsafe`: the layer itself, and modules that act as a host or talk to one.
const UNSAFE: &[&str] = &["gpu", "renderer", "headless", "window"];
/// Files beside `gpu` and `headless` that may record barriers: the frame, the records of its stages, and the one pass
/// with several steps.
const RECORDS: &[&str] = &[
    "src/frame.rs",
    "src/frame/pick.rs",
    "src/frame/reuse.rs",
    "src/frame/antialiasing/samples.rs",
    "src/frame/antialiasing/smooth_borders.rs",
    "src/frame/antialiasing/smooth_trims.rs",
    "src/frame/baselines/mod.rs",
    "src/frame/common/mod.rs",
    "src/frame/common/scan.rs",
    "src/frame/edges/mod.rs",
    "src/frame/edges/solid_lines.rs",
    "src/frame/gaps/mod.rs",
    "src/frame/occlusion/mod.rs",
    "src/frame/occlusion/parts.rs",
    "src/frame/shading/contact.rs",
    "src/frame/shading/linear.rs",
    "src/frame/shading/mod.rs",
    "src/frame/shadows/mod.rs",
    "src/frame/solids/mod.rs",
    "src/frame/solids/bands.rs",
    "src/frame/solids/operands.rs",
    "src/frame/solids/peel.rs",
    "src/frame/solids/tiles.rs",
    "src/frame/tessellation/mod.rs",
    "src/frame/transparency/mod.rs",
    "src/frame/trim/edit.rs",
    "src/frame/trim/table.rs",
    "src/frame/viewport.rs",
    "src/frame/visibility/mod.rs",
];
/// Files of a stage's folder that are neither a pass nor a record.
const NO_PASSES: &[&str] = &[
    "src/frame/antialiasing/capacities.rs",
    "src/frame/antialiasing/mod.rs",
    "src/frame/common/border_list.rs",
    "src/frame/common/draw.rs",
    "src/frame/common/kernel.rs",
    "src/frame/common/line_items.rs",
    "src/frame/common/room.rs",
    "src/frame/edges/capacities.rs",
    "src/frame/gaps/capacities.rs",
    "src/frame/solids/buffers.rs",
    "src/frame/solids/capacities.rs",
    "src/frame/solids/lists.rs",
    "src/frame/tessellation/capacities.rs",
    "src/frame/tessellation/divide.rs",
    "src/frame/trim/capacities.rs",
    "src/frame/trim/mod.rs",
];
/// Calls that a library leaves to its host.
const HOSTS: &[&str] =
    &["println!", "print!(", "eprintln!", "eprint!(", "dbg!(", "std::env::", "process::exit", "process::abort"];
/// Sources of the library crates.
const LIBRARIES: &[&str] =
    &["src", "crates/geometry/src", "crates/io/src", "crates/check/src", "crates/jobs/src", "crates/viewer/src"];
/// Longest source file.
const MOST_LINES: usize = 500;

/// One source file of the library, without comments and tests.
struct Source {
    path: String,
    module: String,
    code: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &str) -> Vec<PathBuf> {
    let mut all = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { all.push(path) }
        }
    }
    all.sort();
    all
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/")
}

impl Source {
    fn new(path: String, text: &str) -> Self {
        let module = match path.strip_prefix("crates/") {
            Some(within) if within.starts_with("check/") => "check",
            Some(within) if within.starts_with("jobs/") => "jobs",
            Some(within) => within.split_once("/src/").expect("a source file").1,
            None => path.trim_start_matches("src/"),
        };
        let module = module.split(['/', '.']).next().unwrap().to_owned();
        // unit tests may use anything, and come last
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        let code = code.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
        Self { path, module, code }
    }

    /// Modules named after `crate::`.
    fn uses(&self) -> Vec<&str> {
        let name = |rest: &'_ str| rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next().unwrap().len();
        self.code.split("crate::").skip(1).map(|rest| &rest[..name(rest)]).collect()
    }

    /// Whether it is a pass, in the folder of its stage.
    fn is_pass(&self) -> bool {
        let of_stage = self.path.strip_prefix("src/frame/").is_some_and(|within| within.contains('/'));
        let path = self.path.as_str();
        of_stage && !RECORDS.contains(&path) && !NO_PASSES.contains(&path) || path == "src/frame/common/scan.rs"
    }

    /// All violations in the file.
    fn complaints(&self) -> Vec<String> {
        let mut all = Vec::new();
        let mut complain = |what: String| all.push(format!("{}: {what}", self.path));
        let module = self.module.as_str();
        match MAY_USE.iter().find(|(name, _)| *name == module) {
            _ if ["check", "jobs"].contains(&module) => {}
            None => complain(format!("tests/architecture.rs does not say what `{module}` may use")),
            Some((_, may)) => {
                for used in self.uses().into_iter().filter(|used| *used != module && !may.contains(used)) {
                    complain(format!("`{module}` may not use `{used}`"));
                }
            }
        }
        if self.is_pass() {
            for beside in ["crate::frame::", "super::"] {
                let uses = |line: &str| line.contains(beside) && !line.contains("crate::frame::common::");
                if self.code.lines().any(uses) {
                    complain("a pass may not use another".to_owned());
                }
            }
        }
        if !VULKAN.contains(&module) && ["ash::", "vk::"].iter().any(|name| names(&self.code, name)) {
            complain("Vulkan's types".to_owned());
        }
        if !UNSAFE.contains(&module) && self.code.contains("unsafe ") {
            complain("`unsafe`".to_owned());
        }
        let barriers = ["gpu", "headless"].contains(&module) || RECORDS.contains(&self.path.as_str());
        if !barriers && ["barrier::", "cmd.after("].iter().any(|name| self.code.contains(name)) {
            complain("barriers between passes stand in the records of src/frame".to_owned());
        }
        for forbidden in HOSTS.iter().filter(|f| self.code.contains(**f)) {
            complain(format!("`{forbidden}` is the host's"));
        }
        all
    }
}

/// Whether code has a path with this start: `ash::`, not `hash::`.
fn names(code: &str, start: &str) -> bool {
    let is_within = |at: usize| code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
    code.match_indices(start).any(|(at, _)| !is_within(at))
}

/// Files and folders of the modules that a file declares for tests only.
fn for_tests(path: &str, text: &str) -> Vec<String> {
    let folder = path.trim_end_matches(".rs").trim_end_matches("mod").trim_end_matches("lib").trim_end_matches('/');
    let declared = text.split("#[cfg(test)]").skip(1).filter_map(|rest| rest.trim_start().strip_prefix("mod "));
    let names =
        declared.filter_map(|rest| rest.split_once(';')).map(|(name, _)| name).filter(|name| !name.contains(' '));
    names.flat_map(|name| [format!("{folder}/{name}.rs"), format!("{folder}/{name}/")]).collect()
}

fn library() -> Vec<Source> {
    let texts = LIBRARIES
        .iter()
        .flat_map(|folder| files(folder))
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .map(|path| (relative(&path), fs::read_to_string(path).unwrap()));
    let texts: Vec<_> = texts.collect();
    let tests: Vec<_> = texts.iter().flat_map(|(path, text)| for_tests(path, text)).collect();
    let shipped = texts.iter().filter(|(path, _)| !tests.iter().any(|test| path.starts_with(test)));
    shipped
        .filter(|(path, _)| !path.ends_with("src/lib.rs"))
        .map(|(path, text)| Source::new(path.clone(), text))
        .collect()
}

#[test]
fn nobody_uses_what_it_may_not() {
    let library = library();
    assert!(library.len() > 80, "only {} files were found", library.len());
    let complaints: Vec<_> = library.iter().flat_map(Source::complaints).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// The check above reports violations.
#[test]
fn a_forbidden_use_is_seen() {
    let complaints = |path: &str, text: &str| Source::new(path.to_owned(), text).complaints().len();
    assert_eq!(
        complaints("crates/geometry/src/trim/new.rs", "use crate::spline::Bezier;\n// crate::gpu in words\n"),
        0
    );
    assert_eq!(complaints("crates/geometry/src/trim/new.rs", "use crate::gpu::Buffer;\n"), 1);
    assert_eq!(complaints("src/gpu/new.rs", "fn f(m: &crate::model::Model) {}\n"), 1);
    assert_eq!(complaints("src/frame/gaps/new.rs", "use super::scan;\n"), 1);
    assert_eq!(complaints("src/frame/gaps/new.rs", "fn f() { barrier::memory(cmd, a, b) }\n"), 1);
    assert_eq!(complaints("src/frame/gaps/new.rs", "fn f() { unsafe { g() } }\n"), 1);
    assert_eq!(complaints("crates/geometry/src/spline/new.rs", "use ash::vk;\n"), 1);
    assert_eq!(complaints("crates/geometry/src/spline/new.rs", "use std::hash::Hash;\n"), 0);
    assert_eq!(complaints("crates/jobs/src/new.rs", "fn f(x: selvedge::ash::vk::Image) {}\n"), 1);
    assert_eq!(
        complaints("crates/io/src/import/new.rs", "println!(\"read\");\n#[cfg(test)]\nmod tests { println!() }\n"),
        1
    );
    assert_eq!(complaints("src/novel.rs", ""), 1);
    let declares = "#[cfg(test)]\nmod parity;\nmod trim;\n#[cfg(test)]\nmod tests {}";
    assert_eq!(for_tests("src/lib.rs", declares), ["src/parity.rs", "src/parity/"]);
    assert_eq!(for_tests("src/twin/mod.rs", declares), ["src/twin/parity.rs", "src/twin/parity/"]);
    assert_eq!(for_tests("src/twin/factor.rs", declares)[0], "src/twin/factor/parity.rs");
}

/// The size of a subgroup differs between devices, so no shader uses subgroups.
#[test]
fn no_shader_depends_on_the_size_of_a_subgroup() {
    let shaders = files("glsl").into_iter().filter(|path| path.extension().is_none_or(|e| e != "spv"));
    let texts: Vec<_> = shaders.map(|path| (relative(&path), fs::read_to_string(&path).unwrap())).collect();
    assert!(texts.len() > 80, "only {} files were found", texts.len());
    let asks = texts.iter().filter(|(_, text)| text.to_lowercase().contains("subgroup"));
    assert_eq!(asks.map(|(path, _)| path).collect::<Vec<_>>(), [""; 0]);
}

/// The header of a source: the lines of its module's documentation.
fn header(text: &str) -> String {
    text.lines().take_while(|line| line.starts_with("//!")).collect::<Vec<_>>().join("\n")
}

/// A pass with a twin says in its header how near its results are to the twin's.
#[test]
fn passes_state_their_parity() {
    let headers =
        files("src/frame").into_iter().map(|path| (relative(&path), header(&fs::read_to_string(path).unwrap())));
    let with_twins: Vec<_> = headers.filter(|(_, header)| header.contains("Twin: ")).collect();
    assert!(with_twins.len() > 20, "only {} passes were found", with_twins.len());
    let silent = with_twins.iter().filter(|(_, header)| !header.to_lowercase().contains("parity"));
    assert_eq!(silent.map(|(path, _)| path).collect::<Vec<_>>(), [""; 0]);
}

/// Names that mean one thing in GLSL and another in Rust.
const HOMONYMS: &[&str] =
    &["BLOCK", "CHORDS", "GROUP", "MARGIN", "MARGIN_PX", "MOST_CELLS", "MOST_STEPS", "ROUNDING", "SIDE", "SPARE"];

/// Names and values of the literal constants of a file, GLSL or Rust.
fn literals(text: &str) -> Vec<(&str, &str)> {
    let declared = |line: &'_ str| line.split_once("const ").map(|(_, rest)| rest.len());
    let rest = text.lines().filter_map(|line| declared(line).map(|length| &line[line.len() - length..]));
    let halves = rest.filter_map(|rest| rest.split_once(" = "));
    let named = halves.map(|(declared, value)| match declared.split_once(": ") {
        Some((name, _)) => (name, value),
        None => (declared.rsplit(' ').next().unwrap_or_default(), value),
    });
    named.filter(|(_, value)| value.starts_with(|c: char| c.is_ascii_digit())).collect()
}

/// Constants stated in GLSL must not be stated again in Rust, which reads them by `abi::constants`.
fn second_homes(glsl: &[String], rust: &[(String, String)]) -> Vec<String> {
    let stated: Vec<_> = glsl.iter().flat_map(|text| literals(text)).map(|(name, _)| name).collect();
    let of_rust = rust.iter().flat_map(|(path, text)| literals(text).into_iter().map(move |(name, _)| (path, name)));
    let twice = of_rust.filter(|(_, name)| stated.contains(name) && !HOMONYMS.contains(name));
    twice.map(|(path, name)| format!("{path}: `{name}` is stated in GLSL, use `abi::constants`")).collect()
}

#[test]
fn shared_constants_have_one_home() {
    let read = |path: &PathBuf| fs::read_to_string(path).ok();
    // baselines, in glsl/baselines, have constants of their own
    let own = |path: &&PathBuf| !relative(path).contains("/baseline");
    let glsl: Vec<_> = files("glsl").iter().filter(own).filter_map(read).collect();
    let rust: Vec<_> = files("src").iter().filter_map(|path| Some((relative(path), read(path)?))).collect();
    let twice = second_homes(&glsl, &rust);
    assert!(twice.is_empty(), "{}", twice.join("\n"));
}

#[test]
fn a_second_home_is_seen() {
    let glsl = ["const uint FAILED_DRAWS = 2u;\nconst float HALF = 0.5; // of it\n".to_owned()];
    let twice = |text: &str| second_homes(&glsl, &[("a.rs".to_owned(), text.to_owned())]).len();
    assert_eq!(twice("pub const FAILED_DRAWS: u32 = 4;\nconst HALF: f64 = 0.5;\n"), 2);
    assert_eq!(twice("const HALF: f64 = scene::HALF as f64;\nconst OTHER: u32 = 1;\n"), 0);
}

#[test]
fn no_file_is_too_long_to_read() {
    let written = |path: &PathBuf| {
        let kinds = ["rs", "glsl", "comp", "vert", "tesc", "tese", "frag"];
        path.extension().is_some_and(|e| kinds.iter().any(|kind| e == *kind))
    };
    let sources = ["src", "glsl", "tests", "build", "crates"].into_iter().flat_map(files).filter(written);
    // the build writes glsl/spirv
    let text =
        sources.map(|p| (relative(&p), fs::read_to_string(p))).filter(|(name, _)| !name.starts_with("glsl/spirv/"));
    let long: Vec<_> = text.filter(|(_, text)| text.as_ref().unwrap().lines().count() > MOST_LINES).collect();
    let names: Vec<_> = long.iter().map(|(name, _)| name).collect();
    assert!(names.is_empty(), "longer than {MOST_LINES} lines: {names:?}");
}

/// The names of the tests of a source that are ignored: the function that follows each attribute.
fn ignored(text: &str) -> Vec<String> {
    let mut lines = text.lines().map(str::trim);
    let mut found = Vec::new();
    while lines.any(|line| line.starts_with("#[ignore")) {
        let function = lines.by_ref().find_map(|line| line.strip_prefix("fn ")).expect("a test follows its attribute");
        found.push(function.split('(').next().unwrap_or_default().to_owned());
    }
    found
}

/// `tools/soak` runs every test that `tools/test` ignores.
#[test]
fn every_ignored_test_is_named_in_soak() {
    let sources =
        ["src", "tests", "crates"].into_iter().flat_map(files).filter(|p| p.extension().is_some_and(|e| e == "rs"));
    let text = |path: &PathBuf| fs::read_to_string(path).unwrap_or_default();
    let mut of_sources: Vec<String> = sources.flat_map(|path| ignored(&text(&path))).collect();
    let soak = text(&root().join("tools/soak"));
    let list = soak.split("tests=(\n").nth(1).and_then(|rest| rest.split("\n)").next()).expect("a list of tests");
    let name = |line: &str| line.trim().rsplit("::").next().unwrap_or_default().to_owned();
    let mut of_soak: Vec<String> = list.lines().map(name).collect();
    of_sources.sort();
    of_soak.sort();
    assert_eq!(of_sources, of_soak, "ignored tests, and those of tools/soak");
}

/// Types that break a rule of `docs/embedding.md`, "What may grow": an error has `#[non_exhaustive]`, settings do not,
/// and those of the engine have defaults.
fn grows_wrongly(path: &str, text: &str) -> Vec<String> {
    let (mut attributes, mut wrong) = (String::new(), Vec::new());
    for line in text.lines() {
        if let Some(declared) = ["pub enum ", "pub struct "].iter().find_map(|kind| line.strip_prefix(kind)) {
            let name = declared.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
            let is_open = attributes.contains("#[non_exhaustive]");
            let is_error = line.starts_with("pub enum") && attributes.contains("Error");
            let is_settings = ["Settings", "Options"].iter().any(|end| name.ends_with(end));
            let defaults = attributes.contains("Default") || text.contains(&format!("impl Default for {name} "));
            if is_error && !is_open {
                wrong.push(format!("{path}: the error {name} is not non_exhaustive"));
            }
            if is_settings && (is_open || path.starts_with("src/") && !defaults) {
                wrong.push(format!("{path}: hosts cannot write {name} {{ .., ..Default::default() }}"));
            }
        }
        match line {
            attribute if attribute.starts_with("#[") => attributes += attribute,
            comment if comment.starts_with("//") => {}
            _ => attributes.clear(),
        }
    }
    wrong
}

#[test]
fn hosts_may_write_settings_and_errors_may_grow() {
    // within the crate alone: the window's modules are private
    let is_private = |path: &str| path.starts_with("crates/viewer/src/window/") && !path.ends_with("/mod.rs");
    let sources = LIBRARIES.iter().flat_map(|folder| files(folder)).map(|path| (relative(&path), path));
    let sources = sources.filter(|(path, _)| path.ends_with(".rs") && !is_private(path));
    let wrong: Vec<_> =
        sources.flat_map(|(path, file)| grows_wrongly(&path, &fs::read_to_string(file).unwrap())).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_type_that_grows_wrongly_is_seen() {
    let wrong = |text: &str| grows_wrongly("src/a.rs", text).len();
    assert_eq!(wrong("#[derive(Debug, thiserror::Error)]\n/// One.\npub enum NoRoom {\n"), 1);
    assert_eq!(wrong("#[derive(Debug, thiserror::Error)]\n#[non_exhaustive]\npub enum NoRoom {\n"), 0);
    assert_eq!(wrong("#[derive(Default)]\n#[non_exhaustive]\npub struct FrameSettings {\n"), 1);
    assert_eq!(wrong("#[derive(Debug)]\npub struct FrameSettings {\n"), 1);
    assert_eq!(wrong("#[derive(Default)]\npub struct FrameSettings {\n}\n#[derive(Debug)]\npub enum Way {\n"), 0);
}

#[test]
fn an_ignored_test_is_found() {
    let text = "#[test]\n    #[ignore = \"minutes\"]\n    fn long() {}\n#[test]\nfn short() {}\n#[ignore]\n#[test]\nfn other() {}\n";
    assert_eq!(ignored(text), ["long", "other"]);
}

/// Paths of files between backticks, without the `::function` behind some of them.
fn paths_of(text: &str) -> Vec<&str> {
    let kinds = ["rs", "glsl", "comp", "vert", "tesc", "tese", "frag", "step"];
    let spans = text.split('`').skip(1).step_by(2).map(|span| span.split("::").next().unwrap_or_default());
    spans.filter(|path| path.rsplit_once('.').is_some_and(|(_, kind)| kinds.contains(&kind))).collect()
}

#[test]
fn files_of_the_walkthrough_exist() {
    let text = fs::read_to_string(root().join("docs/walkthrough.md")).unwrap();
    let paths = paths_of(&text);
    assert!(paths.len() > 30, "only {} paths were found", paths.len());
    let missing: Vec<_> = paths.into_iter().filter(|path| !root().join(path).is_file()).collect();
    assert_eq!(missing, [""; 0], "paths begin at the repository's root");
}

#[test]
fn a_path_is_found() {
    let text = "`Face` (`src/a.rs`), `b.rs::of` and `model::Face { u, … }`; c.rs\n";
    assert_eq!(paths_of(text), ["src/a.rs", "b.rs"]);
}
