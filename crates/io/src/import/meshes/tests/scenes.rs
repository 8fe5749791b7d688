//! glTF.

use super::{CORNERS, FACES, import, refusal, volume};
use crate::import::{Folders, Options, open_with, read_from};
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

/// A buffer beyond the file's folder is refused, there or not, and found below a folder that is searched.
#[test]
fn buffers_elsewhere() {
    let root = std::env::temp_dir().join(format!("selvedge-gltf-elsewhere-{}", std::process::id()));
    let (folder, away) = (root.join("model"), root.join("away/below"));
    for folder in [&folder, &away] {
        std::fs::create_dir_all(folder).unwrap();
    }
    let (file, beyond) = (folder.join("t.gltf"), root.join("beyond.bin"));
    for path in [&beyond, &away.join("away.bin"), &folder.join("near.bin")] {
        std::fs::write(path, data()).unwrap();
    }
    let read = |uri: &str, search: bool| {
        std::fs::write(&file, text(&format!(",\"uri\":\"{uri}\""))).unwrap();
        let folders = Folders::new(if search { vec![root.join("away")] } else { Vec::new() });
        let options = Options { files: Some(&folders), ..Options::default() };
        open_with(&file, &options).map(|import| import.report.files_read).map_err(|e| e.to_string())
    };
    let absolute = beyond.display().to_string().replace('\\', "/");
    for uri in ["../beyond.bin", "%2e%2e/beyond.bin", "..\\\\beyond.bin", "near/../../beyond.bin", &absolute] {
        let told = read(uri, true).expect_err(uri);
        assert!(told.contains("beyond.bin: not beside the model, nor below a folder that is searched"), "{told}");
    }
    // a folder of this name would lie beside the model
    for uri in [format!("file://{absolute}"), "http://host/beyond.bin".to_owned()] {
        let told = read(&uri, true).expect_err(&uri);
        assert!(told.contains("beyond.bin: ") && told.contains("buffer 0: "), "{told}");
    }
    for (uri, search, found) in [
        ("near.bin", false, Some("near.bin")),
        ("NEAR.BIN", false, Some("near.bin")),
        ("../near.bin", false, Some("near.bin")),
        ("away.bin", false, None),
        ("away.bin", true, Some("away.bin")),
        ("../below/away.bin", true, Some("away.bin")),
    ] {
        let named = read(uri, search).ok().map(|all| all[0].file_name().unwrap().display().to_string());
        assert_eq!(named.as_deref(), found, "{uri}");
    }
    std::fs::remove_dir_all(&root).unwrap();
    // a stream has no folder
    let stream = text(",\"uri\":\"Cargo.toml\"");
    let folders = Folders::default();
    let options = Options { files: Some(&folders), ..Options::default() };
    let told = read_from(&mut stream.as_bytes(), "-.gltf", &options).expect_err("a stream").to_string();
    assert!(told.contains("Cargo.toml: the model was not read from a folder"), "{told}");
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

/// The colour of all vertices is a factor of the material's, and no loss.
#[test]
fn one_colour_of_vertices_is_drawn() {
    let with = |colours: &[u8], kind: &str, material: bool| {
        let coloured = with_data(&[&data()[..], colours].concat())
            .replace("\"byteLength\":72", &format!("\"byteLength\":{}", 72 + colours.len()))
            .replace(
                "\"byteLength\":24}",
                &format!("\"byteLength\":24}},{{\"buffer\":0,\"byteOffset\":72,\"byteLength\":{}}}", colours.len()),
            )
            .replace("\"type\":\"SCALAR\"}", &format!("\"type\":\"SCALAR\"}},{{\"bufferView\":2,\"count\":4,{kind}}}"))
            .replace("\"POSITION\":0", "\"POSITION\":0,\"COLOR_0\":2");
        let coloured = if material { coloured } else { coloured.replace(",\"material\":0", "") };
        let import = import(coloured.as_bytes(), "gltf");
        let told: Vec<_> = import.warnings.iter().map(|w| w.message.clone()).collect();
        assert_eq!(import.summary().is_complete(), told.is_empty());
        (import.model.parts[0].meshes[0].colour, told)
    };
    let floats = |last: f32| -> Vec<u8> {
        let all = [[1.0, 0.5, 0.25]; 3].into_iter().chain([[1.0, 0.5, last]]).flatten();
        all.flat_map(f32::to_le_bytes).collect()
    };
    let (three, four) =
        ("\"componentType\":5126,\"type\":\"VEC3\"", "\"componentType\":5121,\"normalized\":true,\"type\":\"VEC4\"");
    assert_eq!(with(&[255; 16], four, true), (Some([0.25, 0.5, 0.75, 0.5]), vec![]));
    assert_eq!(with(&[255; 16], four, false), (Some([1.0; 4]), vec![]));
    assert_eq!(with(&floats(0.25), three, true), (Some([0.25, 0.25, 0.1875, 0.5]), vec![]));
    // one vertex has another
    let told = vec!["colours left out: mesh 0, primitive 0: colours of vertices".to_owned()];
    assert_eq!(with(&floats(0.5), three, true), (Some([0.25, 0.5, 0.75, 0.5]), told));
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
    // accessors without `min` and `max` are read; an index out of range is an error that names its place
    let bare = with_data(&data()).replace(",\"min\":[0,0,0],\"max\":[1,1,1]", "");
    assert!((volume(&import(bare.as_bytes(), "gltf").model) - 27e9 / 6.0).abs() < 1e-3);
    assert!(refusal(bare.replace("\"mesh\":0", "\"mesh\":7").as_bytes(), "gltf").contains("nodes[1].mesh"));
    // the first version had objects in place of lists
    let first = "{\"accessors\": {}, \"asset\": {\"generator\": \"x\", \"version\": \"1.0\"}}";
    assert!(refusal(first.as_bytes(), "gltf").starts_with("t.x: glTF 1.0, and 2.0 is read: "));
    assert!(
        refusal(b"glTF\x01\0\0\0\x14\0\0\0\0\0\0\0\0\0\0\0", "glb").starts_with("t.x: glTF 1.0, and 2.0 is read: ")
    );
    // a node that is its own child
    let cycle = with_data(&data()).replace("\"children\":[1]", "\"children\":[0]");
    assert!(refusal(cycle.as_bytes(), "gltf").starts_with("t.x: "));
}
