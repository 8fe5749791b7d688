//! The report and the exit status of `tools/gpu_check`, run with shell scripts in place of the program and the tests.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A bundle whose binaries are shell scripts; removed on drop.
struct Bundle(PathBuf);

impl Bundle {
    fn new(name: &str, embed: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("selvedge-gpu-check-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        for part in ["bin", "layers", "samples"] {
            fs::create_dir_all(folder.join(part)).unwrap();
        }
        let bundle = Self(folder);
        let devices = "[[ $1 == devices ]] || { echo \"ran $*\"; exit; }\n[[ ${2:-} == --json ]] && echo '[{\"name\":\"a\"}]' || echo a";
        bundle.script("bin/selvedge", devices);
        for test in ["gpu", "faults", "selvedge", "frame"] {
            bundle.script(&format!("bin/test-{test}"), "echo 'test result: ok. 1 passed; 0 failed'");
        }
        bundle.script("bin/test-embed", embed);
        fs::write(bundle.0.join("samples/a.step"), "").unwrap();
        fs::write(bundle.0.join("commit"), "abc\n").unwrap();
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tools/gpu_check");
        fs::copy(script, bundle.0.join("gpu_check")).unwrap();
        bundle
    }

    fn script(&self, name: &str, text: &str) {
        let path = self.0.join(name);
        fs::write(&path, format!("#!/bin/bash\n{text}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Status, and the report.
    fn run(&self, arguments: &[&str]) -> (Option<i32>, serde_json::Value) {
        let out = self.0.join("out");
        let mut command = Command::new("bash");
        command.arg(self.0.join("gpu_check")).arg("-o").arg(&out).args(arguments);
        let output = command.env_clear().env("PATH", "/usr/bin:/bin").current_dir(&self.0).output().unwrap();
        let report = fs::read(out.join("report.json")).ok();
        let report = report.map(|text| serde_json::from_slice(&text).expect("the report is JSON"));
        (output.status.code(), report.unwrap_or_default())
    }
}

impl Drop for Bundle {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn what_passes_is_reported_good() {
    let (status, report) = Bundle::new("good", "echo 'test result: ok. 3 passed; 0 failed'").run(&[]);
    assert_eq!(status, Some(0), "{report}");
    let steps = report["steps"].as_array().unwrap();
    let kinds = |kind: &str| steps.iter().filter(|step| step["kind"] == kind).count();
    assert_eq!([kinds("tests"), kinds("check"), kinds("bench")], [5, 2, 1]);
    assert_eq!(
        (&report["good"], &report["commit"], &report["devices"][0]["name"]),
        (&true.into(), &"abc".into(), &"a".into())
    );
}

#[test]
fn a_failed_test_is_named() {
    let fails = "echo 'test a::b ... FAILED'\nprintf 'a \"quoted\"\\ttab \\\\ \\033[0m\\n'\nexit 101";
    let (status, report) = Bundle::new("bad", fails).run(&["-q"]);
    assert_eq!((status, &report["good"]), (Some(1), &false.into()), "{report}");
    let embed = report["steps"].as_array().unwrap().iter().find(|step| step["name"] == "embed").unwrap();
    assert_eq!((&embed["status"], &embed["failed"][0]), (&101.into(), &"a::b".into()));
    assert_eq!(embed["result"], "a \"quoted\"\ttab \\ [0m");
}

/// A sweep of nets of their own takes so many milliseconds, one of copies of a net 4.8.
fn with_nets_of_their_own(name: &str, ms: f64) -> (Option<i32>, String) {
    let bundle = Bundle::new(name, "echo 'test result: ok. 3 passed; 0 failed'");
    let device = "[[ $1 != devices ]] || { [[ ${2:-} == --json ]] && echo '[]' || echo a; exit; }";
    let table = format!(
        "ms=4.8 && [[ \" $* \" != *' --distinct '* ]] || ms={ms}\n[[ $1 != sweep ]] || \
        for ((i = 1; i <= $#; i++)); do [[ ${{!i}} != --out ]] || {{ i=$((i + 1)); \
        printf 'model,all_ms,width\\nsheet,%s,640\\n' $ms >\"${{!i}}\"; }}; done\necho ran"
    );
    bundle.script("bin/selvedge", &format!("{device}\n{table}"));
    let (status, report) = bundle.run(&["-s"]);
    let of_ratio = |step: &&serde_json::Value| step["name"] == "262144-patches-own-over-one";
    let step = report["steps"].as_array().unwrap().iter().find(of_ratio).expect("the step is reported");
    (status, step["result"].as_str().unwrap_or_default().to_owned())
}

#[test]
fn nets_of_their_own_take_at_most_two_and_a_half_times_one_net() {
    assert_eq!(with_nets_of_their_own("quick", 5.424), (Some(0), "1.13 times".to_owned()));
    assert_eq!(with_nets_of_their_own("slow", 26.9), (Some(1), "5.60 times".to_owned()));
    // 896 microseconds: with a zero before them they are a number by tens still
    assert_eq!(with_nets_of_their_own("very-quick", 0.896), (Some(0), "0.18 times".to_owned()));
    assert_eq!(with_nets_of_their_own("not-measured", 0.0), (Some(1), String::new()));
}

#[test]
fn a_missing_model_or_device_is_told_by_the_status() {
    let bundle = Bundle::new("missing", "true");
    assert_eq!(bundle.run(&["nothere.step"]).0, Some(2));
    bundle.script("bin/selvedge", "exit 3");
    assert_eq!(bundle.run(&[]).0, Some(3));
}
