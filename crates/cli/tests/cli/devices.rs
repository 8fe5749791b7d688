//! `selvedge devices`.

use super::{selvedge, text};

#[test]
fn every_device_lists_missing_features_and_limits() {
    let output = selvedge(&["devices"]);
    let told = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for what in
        ["yes, and is taken where no other is named", "segments of a side:", "subgroup sizes:", "largest picture:"]
    {
        assert!(told.contains(what), "{what} in {told}");
    }
    let output = selvedge(&["devices", "--json"]);
    let all: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let default: Vec<_> = all.as_array().unwrap().iter().filter(|device| device["is_default"] == true).collect();
    assert_eq!(default.len(), 1, "{all}");
    assert_eq!(default[0]["missing"].as_array().map(Vec::len), Some(0));
    assert!(default[0]["limits"]["storage_buffer_bytes"].as_u64().is_some_and(|bytes| bytes >= 1 << 27), "{all}");
    assert!(told.contains(default[0]["name"].as_str().unwrap()));
}
