//! Meshes: groups, colours, normals, closedness.

use super::{import, told};
use crate::import::open;
use glam::DVec3;

const CUBE: &str = "o cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    g ends\nf 4 3 2 1\nf 5 6 7 8\ng sides\nf 1 2 6 5\nf 2 3 7 6\nf -6 -5 \\\n -1 -2\nf 4 1 5 8\n";

#[test]
fn a_cube_of_two_groups() {
    let cube = import(CUBE);
    assert!(cube.warnings.is_empty(), "{:?}", told(&cube));
    let [part] = &cube.model.parts[..] else { panic!("one part") };
    assert_eq!((part.name.as_str(), part.closed, part.meshes.len()), ("cube", true, 2));
    let triangles: Vec<usize> = part.meshes.iter().map(|m| m.triangles().len()).collect();
    assert_eq!(triangles, [4, 8]);
    assert_eq!((part.meshes[0].id, part.meshes[1].id), (1, 2));
    assert!(part.meshes.iter().all(|m| m.normals().is_empty()));
    // six times the volume, by the signed tetrahedra to the origin: 6 for the unit cube facing outwards
    let volume = |m: &crate::model::Mesh| -> f64 {
        (0..m.triangles().len()).map(|t| m.corners(t)).map(|[a, b, c]| a.dot(b.cross(c))).sum()
    };
    assert_eq!(part.meshes.iter().map(volume).sum::<f64>(), 6.0);
    assert_eq!(cube.model.instances.len(), 1);

    let open = import(&CUBE.replace("f 4 1 5 8\n", ""));
    assert!(!open.model.parts[0].closed);
}

#[test]
fn normals_are_kept_where_they_are_given() {
    let text = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nvn 0 0 5\nvn 0 1 0\nf 1//1 2//2 3//-2\nf 2/1/1 4/1/2 3\n";
    let mesh = import(text).model.parts[0].meshes[0].clone();
    let [flat, given, partly] = mesh.normals() else { panic!("three triangles") };
    assert_eq!(*flat, [DVec3::new(0., 0., 2.); 3]);
    assert_eq!(*given, [DVec3::new(0., 0., 5.), DVec3::Y, DVec3::new(0., 0., 5.)]);
    // one corner has none: the whole polygon is flat
    let [a, b, c] = mesh.corners(2);
    assert_eq!(*partly, [(b - a).cross(c - a); 3]);
}

#[test]
fn colours_come_from_the_file_beside() {
    let folder = std::env::temp_dir().join(format!("selvedge-obj-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let materials = "newmtl red one\nKd 1 0 0.5 # diffuse\nd 0.25\nnewmtl none\nillum 2\nKd 1 1\nd -halo 0.5\n\
        newmtl grey\nKd 0.5\nTr 0.75\nmap_Kd wood.png\n";
    std::fs::write(folder.join("my colours.mtl"), materials).unwrap();
    let triangle = "f 1 2 3\n";
    let text = format!(
        "mtllib my colours.mtl\nmtllib ../other.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red one\n{triangle}usemtl none\n{triangle}\
        usemtl missing\n{triangle}usemtl grey\n{triangle}usemtl red one\n{triangle}"
    );
    let path = folder.join("coloured.obj");
    std::fs::write(&path, text).unwrap();
    let result = open(&path);
    std::fs::remove_dir_all(&folder).unwrap();
    let read = result.unwrap();
    let meshes = &read.model.parts[0].meshes;
    let found: Vec<_> = meshes.iter().map(|m| (m.triangles().len(), m.colour)).collect();
    // sRGB 0.5 is 0.214 041 14 in linear light (IEC 61966-2-1)
    let half = 0.214_041_14;
    assert_eq!(found, [(2, Some([1.0, 0.0, half, 0.25])), (1, None), (1, None), (1, Some([half, half, half, 0.25]))]);
    let told: String = told(&read).join("\n");
    for expected in [
        "material statement not read: my colours.mtl:6: Kd 1 1",
        "material statement not read: my colours.mtl:7: d -halo 0.5",
        "texture left out: my colours.mtl:11: map_Kd wood.png",
        "coloured.obj:2: materials not read: ../other.mtl: not beside the model",
        "coloured.obj:10: no such material: missing",
    ] {
        assert!(told.contains(expected), "{expected} in {told}");
    }
    assert_eq!(read.warnings.len(), 5);
    assert!(!read.summary().is_complete(), "as in other formats, a texture is a loss");
}

#[test]
fn statements_without_surfaces_are_counted() {
    let read = import("v 0 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\ns 1\nf 1/1 2/2 3/1\np 1\nl 1 2\nfrobnicate\n");
    let expected = [
        "t.obj:10: statement not used: `frobnicate`, 1 times",
        "t.obj:9: lines not drawn: `l`, 1 times",
        "t.obj:8: points not drawn: `p`, 1 times",
        "t.obj:6: statement not used: `s`, 1 times",
        "t.obj:1: statement not used: `v with a colour`, 1 times",
        "t.obj:4: statement not used: `vt`, 2 times",
    ];
    assert_eq!(told(&read), expected);
    assert_eq!(read.model.parts[0].meshes[0].triangles(), [[0, 1, 2]]);
    // nothing but lines, nothing but points
    let holds = |text: &str| import(text).summary().to_string();
    assert!(
        holds("v 0 0 0\nv 1 0 0\nl 1 2\n").contains("it holds 1 x lines (`l`, 1 times), 1 x vertices (2 of no face)")
    );
    assert!(holds("v 0 0 0\n").ends_with("nothing of it can be drawn; it holds 1 x vertices (1 of no face)"));
}

#[test]
fn names_in_other_encodings() {
    let (raw, ..) = encoding_rs::GB18030.encode("齿轮箱外壳零件总成右侧支架");
    let text = [&b"o "[..], &raw, &CUBE.as_bytes()[6..]].concat();
    let cube = crate::import::obj(&text, "t.obj", None).unwrap();
    assert_eq!(
        (cube.model.parts[0].name.as_str(), told(&cube)),
        ("齿轮箱外壳零件总成右侧支架", vec!["t.obj: text: it is not UTF-8: read as GBK".into()])
    );
    let wide: Vec<u8> = CUBE.replace("cube", "齿轮").encode_utf16().flat_map(u16::to_be_bytes).collect();
    let cube = crate::import::obj(&[b"\xfe\xff", &wide[..]].concat(), "t.obj", None).unwrap();
    assert_eq!((cube.model.parts[0].name.as_str(), told(&cube)), ("齿轮", vec![]));
}
