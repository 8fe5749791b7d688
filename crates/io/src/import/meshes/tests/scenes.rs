//! glTF.

use super::{CORNERS, FACES, import, refusal, volume};
use crate::import::{Options, open_with};
use base64::Engine;
use glam::DVec3;

fn data() -> Vec<u8> {
    let mut bytes: Vec<u8> = CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(FACES.iter().flatten().flat_map(|i| (*i as u16).to_le_bytes()));
    bytes
}

fn text(uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"name":"upper","translation":[0,2,0],"children":[1]}},{{"mesh":0,"scale":[3,3,3]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[0.25,0.5,0.75,0.5]}},"alphaMode":"BLEND"}}],
        "meshes":[{{"name":"tetra","primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}},
        {{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],
        "buffers":[{{"byteLength":72{uri}}}]}}"#
    )
}

fn with_data(bytes: &[u8]) -> String {
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    text(&format!(",\"uri\":\"data:application/octet-stream;base64,{data}\""))
}

fn binary(json: &str, data: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + data.len();
    let mut file = b"glTF".to_vec();
    file.extend(2_u32.to_le_bytes());
    file.extend((length as u32).to_le_bytes());
    file.extend((json.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(json);
    file.extend((data.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(data);
    file
}

#[test]
fn metres_and_y_up_become_millimetres_and_z_up() {
    for (bytes, ending) in [(with_data(&data()).into_bytes(), "gltf"), (binary(&text(""), &data()), "glb")] {
        let import = import(&bytes, ending);
        assert!((volume(&import.model) - 27e9 / 6.0).abs() < 1e-3, "{}", volume(&import.model));
        // x stays, y (2 to 5 m) is z, z (0 to 3 m) is -y
        let bounds = import.model.bounds();
        assert_eq!([bounds.min, bounds.max], [DVec3::new(0.0, -3000.0, 2000.0), DVec3::new(3000.0, 0.0, 5000.0)]);
        let part = &import.model.parts[0];
        // base colours are linear
        assert!(part.closed && part.name == "tetra" && part.meshes[0].colour == Some([0.25, 0.5, 0.75, 0.5]));
    }
    assert_eq!(super::super::recognise(&binary(&text(""), &data())), Some("glb"));
}

/// Buffers of a file have the same limit as the file. Buffers that are read are listed as inputs.
#[test]
fn buffers_beside_the_file() {
    let folder = std::env::temp_dir().join(format!("selvedge-gltf-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (file, beside) = (folder.join("t.gltf"), folder.join("my data.bin"));
    // longer than the text
    std::fs::write(&beside, [data(), vec![0; 4000]].concat()).unwrap();
    let named = text(",\"uri\":\"m%79%20data.bin\"");
    std::fs::write(&file, &named).unwrap();
    let read = |most: Option<u64>| open_with(&file, &Options { most_bytes: most, ..Options::default() });
    let (whole, short) = (read(None), read(Some(named.len() as u64)));
    std::fs::remove_dir_all(&folder).unwrap();
    let whole = whole.expect("a mesh");
    assert!((volume(&whole.model) - 27e9 / 6.0).abs() < 1e-3, "{}", volume(&whole.model));
    assert_eq!(whole.report.files_read, [beside]);
    let told = short.expect_err("too long").to_string();
    let most = format!("buffer 0: my data.bin: larger than {} bytes, the most that is read", named.len());
    assert!(named.len() < 4000 && told.ends_with(&most), "{told}");
}

/// What the file states and the model has not is reported. A scene that is not shown is no loss.
#[test]
fn what_is_lost_of_gltf_is_reported() {
    let whole = with_data(&data());
    let told = |text: &str| {
        let import = import(text.as_bytes(), "gltf");
        (import.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>(), import.summary().is_complete())
    };
    assert_eq!(told(&whole), (vec![], true));
    for (from, to, message, complete) in [
        (
            "\"POSITION\":0",
            "\"POSITION\":0,\"COLOR_0\":0",
            "colours left out: mesh 0, primitive 0: colours of vertices",
            false,
        ),
        ("\"count\":12", "\"count\":11", "polygons left out: 1 of fewer than three corners", false),
        ("\"mesh\":0,", "\"mesh\":0,\"weights\":[0.5],", "morph targets left out: 1 meshes or nodes use them", false),
        (
            "\"scene\":0",
            "\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],\"scene\":0",
            "copies left out: EXT_mesh_gpu_instancing",
            false,
        ),
        (
            "\"scene\":0",
            "\"extensionsUsed\":[\"KHR_materials_transmission\"],\"scene\":0",
            "extension not used: KHR_materials_transmission",
            true,
        ),
        (
            "\"scale\":[3,3,3]}",
            "\"scale\":[3,3,3]},{\"mesh\":0}",
            "object not placed: 1 nodes with a mesh are not in the scene that is drawn",
            true,
        ),
    ] {
        assert!(whole.contains(from), "{from}");
        assert_eq!(told(&whole.replacen(from, to, 1)), (vec![message.to_owned()], complete));
    }
}

#[test]
fn damaged_gltf() {
    let whole = with_data(&data());
    let mut far = data();
    far[70] = 9;
    let mut nan = data();
    nan[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    for (text, message) in [
        (with_data(&far), "mesh 0, primitive 0: vertex 9 of 4"),
        (with_data(&nan), "vertex 0 is not finite"),
        (with_data(&data()[..60]), "buffer 0: cut off: 60 of 72 bytes"),
        (whole.replace("\"count\":12", "\"count\":4000000000"), "4000000000 entries in 24 bytes"),
        (whole.replace("\"byteOffset\":48", "\"byteOffset\":4800"), "a view beyond its buffer"),
        (whole.replace("\"children\":[1]", "\"children\":[7]"), "t.x: "),
        (text(",\"uri\":\"no such file.bin\""), "no such file.bin"),
        (text(""), "buffer 0: is not in the file"),
        (whole[..whole.len() / 2].to_owned(), "t.x: "),
    ] {
        let found = refusal(text.as_bytes(), "gltf");
        assert!(found.contains(message), "{found}, not {message}");
    }
    let whole = binary(&text(""), &data());
    assert!(refusal(&whole[..whole.len() - 9], "glb").starts_with("t.x: "));
    assert!(refusal(&whole[..10], "glb").starts_with("t.x: "));
    // a node that is its own child
    let cycle = with_data(&data()).replace("\"children\":[1]", "\"children\":[0]");
    assert!(refusal(cycle.as_bytes(), "gltf").starts_with("t.x: "));
}
