//! A tetrahedron of volume 1/6 in every format, and its damaged neighbours.

mod archives;
mod scenes;

use crate::import::{Import, mesh};
use crate::model::{Mesh, Model};
use glam::DVec3;

fn import(bytes: &[u8], ending: &str) -> Import {
    mesh(bytes, "t.x", ending, None).expect("a mesh")
}

fn refusal(bytes: &[u8], ending: &str) -> String {
    mesh(bytes, "t.x", ending, None).expect_err("no mesh").to_string()
}

/// The volume within all placed meshes.
fn volume(model: &Model) -> f64 {
    let of = |mesh: &Mesh, place: glam::DAffine3| {
        let corners = (0..mesh.triangles().len()).map(|t| mesh.corners(t).map(|p| place.transform_point3(p)));
        corners.map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
    };
    model.instances.iter().flat_map(|i| model.parts[i.part].meshes.iter().map(|m| of(m, i.transform))).sum()
}

const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

fn binary_stl(attributes: [u16; 4]) -> Vec<u8> {
    let mut file = vec![b' '; 80];
    file.extend(4_u32.to_le_bytes());
    for (face, attribute) in FACES.iter().zip(attributes) {
        file.extend([0; 12]);
        face.iter().flat_map(|i| CORNERS[*i as usize]).for_each(|x| file.extend(x.to_le_bytes()));
        file.extend(attribute.to_le_bytes());
    }
    file
}

fn text_stl() -> String {
    let corner = |i: &u32| {
        format!("vertex {0} {1} {2}\n", CORNERS[*i as usize][0], CORNERS[*i as usize][1], CORNERS[*i as usize][2])
    };
    let facet = |f: &[u32; 3]| {
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", f.iter().map(corner).collect::<String>())
    };
    format!("solid a tetrahedron\n{}endsolid\n", FACES.iter().map(facet).collect::<String>())
}

#[test]
fn stl() {
    for (bytes, name) in [(binary_stl([0; 4]), ""), (text_stl().into_bytes(), "a tetrahedron")] {
        let import = import(&bytes, "stl");
        assert!((volume(&import.model) - 1.0 / 6.0).abs() < 1e-15);
        let part = &import.model.parts[0];
        assert!(part.closed && part.meshes[0].positions().len() == 4 && part.name == name);
        assert!(import.warnings.is_empty() && super::recognise(&bytes) == Some("stl"));
    }
    // digits that a single float does not have
    let fine = text_stl().replace("vertex 1 0 0", "vertex 1.00000000001 0 0");
    assert_eq!(import(fine.as_bytes(), "stl").model.parts[0].meshes[0].bounds().max.x, 1.00000000001);
    // VisCAM: the top bit, then five bits of red, green, blue
    let red = import(&binary_stl([0xFC00; 4]), "stl");
    assert_eq!(red.model.parts[0].meshes[0].colour, Some([1.0, 0.0, 0.0, 1.0]));
    // Magics: a colour for the whole; triangles without the top bit have their own, red lowest
    let mut magics = binary_stl([0x8000, 0x8000, 0x8000, 31]);
    magics[..10].copy_from_slice(b"COLOR=\x00\xFF\x00\xFF");
    let two = import(&magics, "stl");
    let colours: Vec<_> = two.model.parts[0].meshes.iter().map(|m| m.colour.unwrap()).collect();
    assert_eq!(colours, [[0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]]);
    assert!(two.model.parts[0].closed);
}

#[test]
fn damaged_stl() {
    let whole = binary_stl([0; 4]);
    assert!(refusal(&whole[..200], "stl").contains("t.x: cut off: 2 of the 4 triangles"));
    assert!(refusal(&whole[..40], "stl").contains("cut off: the header"));
    let mut many = whole.clone();
    many[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(refusal(&many, "stl").contains("4 of the 4294967295 triangles"));
    let mut nan = whole.clone();
    nan[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(refusal(&nan, "stl").contains("triangle 2: a coordinate is not finite"));
    let longer = import(&[whole, vec![0; 7]].concat(), "stl");
    assert!(longer.warnings[0].to_string().contains("7 bytes follow"));
    let text = text_stl();
    for (text, message) in [
        (text[..text.len() - 40].to_owned(), "t.x:26: cut off: the file ends inside a facet"),
        (text.replacen("vertex 0 1 0", "vertex 0 nan 0", 1), "t.x:5: a vertex without three finite numbers"),
        (text.replacen("vertex 0 1 0", "vertex 0 1", 1), "t.x:5: a vertex without"),
        (text.replacen("vertex 0 1 0\n", "", 1), "t.x:6: a facet of 2 corners"),
        (text.replacen("outer loop", "inner loop", 1), "t.x:3: `inner` where"),
        ("solid\nendsolid\n".to_owned(), "STL, text without a triangle"),
    ] {
        let found = refusal(text.as_bytes(), "stl");
        assert!(found.contains(message), "{found}, not {message}");
    }
    let open = import(text.replace("endsolid\n", "").as_bytes(), "stl");
    assert!(open.warnings[0].to_string().contains("without `endsolid`"));
}

const OFF: &str = "OFF\n4 4 0 # no edges\n\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

#[test]
fn off() {
    let plain = import(OFF.as_bytes(), "off");
    assert!((volume(&plain.model) - 1.0 / 6.0).abs() < 1e-15 && plain.model.parts[0].closed);
    assert_eq!(super::recognise(OFF.as_bytes()), Some("off"));
    // counts on the first line, colours in both forms, a polygon
    let coloured = "OFF 4 2 4\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3 255 0 0\n4 3 2 1 0 0.0 1.0 0.0 0.5\n";
    let model = import(coloured.as_bytes(), "off").model;
    let colours: Vec<_> = model.parts[0].meshes.iter().map(|m| m.colour.unwrap()).collect();
    assert_eq!(colours, [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.5]]);
    assert_eq!(model.parts[0].meshes[0].triangles().len(), 2);
    for (text, message) in [
        (OFF.replace("3 1 2 3\n", ""), "t.x:10: cut off: 3 of 4 faces"),
        (OFF.replace("3 1 2 3", "3 1 2 4"), "t.x:11: vertex 4 of 4"),
        (OFF.replace("3 1 2 3", "3 1 2"), "t.x:11: a face without 3 corners"),
        (OFF.replace("0 0 1\n", "0 0 inf\n"), "t.x:7: a vertex without three finite numbers"),
        (OFF.replace("4 4 0", "4000000000 4 0"), "t.x:11: cut off: 8 of 4000000000 vertices"),
        (OFF.replace("4 4 0", "4 4000000000 0"), "cut off: 4 of 4000000000 faces"),
        (OFF.replace("4 4 0", "4 x"), "t.x:2: no numbers of vertices and faces"),
        (OFF.replace("OFF", "OF"), "t.x:1: the first word"),
        ("OFF".to_owned(), "cut off"),
    ] {
        let found = refusal(text.as_bytes(), "off");
        assert!(found.contains(message), "{found}, not {message}");
    }
}

fn ply(format: &str, body: &[u8]) -> Vec<u8> {
    let head = format!(
        "ply\nformat {format} 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    );
    [head.as_bytes(), body].concat()
}

#[test]
fn ply_files() {
    let text = b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    let mut binary: Vec<u8> = CORNERS.iter().flatten().flat_map(|x| x.to_be_bytes()).collect();
    for face in FACES {
        binary.push(3);
        binary.extend(face.iter().flat_map(|i| i.to_be_bytes()));
    }
    for bytes in [ply("ascii", text), ply("binary_big_endian", &binary)] {
        let import = import(&bytes, "ply");
        assert!((volume(&import.model) - 1.0 / 6.0).abs() < 1e-15 && import.model.parts[0].closed);
        assert_eq!(super::recognise(&bytes), Some("ply"));
    }
    let cut = ply("binary_big_endian", &binary[..binary.len() - 5]);
    assert!(refusal(&cut, "ply").contains("cut off"));
    let far = ply("ascii", &[&text[..text.len() - 8], b"3 1 2 9\n"].concat());
    assert!(refusal(&far, "ply").contains("face 3: vertex 9 of 4"), "{}", refusal(&far, "ply"));
    let negative = ply("ascii", &[&text[..text.len() - 8], b"3 1 2 -1\n"].concat());
    assert!(refusal(&negative, "ply").contains("face 3: a corner that is no vertex"));
    let word = ply("ascii", &[b"nan", &text[1..]].concat());
    assert!(refusal(&word, "ply").contains("Line 11"), "{}", refusal(&word, "ply"));
    let nan = ply("binary_big_endian", &[&f32::NAN.to_be_bytes(), &binary[4..]].concat());
    assert!(
        refusal(&nan, "ply").contains("vertex 0: a coordinate is not there or not finite"),
        "{}",
        refusal(&nan, "ply")
    );
    let many = String::from_utf8(ply("ascii", text)).unwrap().replace("vertex 4", "vertex 4000000000");
    assert!(refusal(many.as_bytes(), "ply").contains("4000000000 of `vertex` are more than the file holds"));
    let coloured = String::from_utf8(ply(
        "ascii",
        b"0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n0 0 1 255 0 0\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
    ));
    let coloured = coloured.unwrap().replace(
        "property float z\n",
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
    );
    assert_eq!(import(coloured.as_bytes(), "ply").model.parts[0].meshes[0].colour, Some([1.0, 0.0, 0.0, 1.0]));
    let varied = import(coloured.replacen("255 0 0", "0 255 0", 1).as_bytes(), "ply");
    assert_eq!(varied.model.parts[0].meshes[0].colour, None);
    assert!(varied.warnings[0].to_string().contains("colours of vertices"));
}

/// What the file states and the model has not is reported: attributes that are no colours, polygons without an inside,
/// loops without an end, numbers behind a vertex.
#[test]
fn what_is_lost_of_triangles_is_reported() {
    let told = |bytes: &[u8], ending: &str| {
        import(bytes, ending).warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>()
    };
    let some = binary_stl([0xFC00, 0, 3, 0]);
    assert_eq!(told(&some, "stl"), ["colours not used: 2 of 4 triangles have an attribute, and not all a colour"]);
    let open = text_stl().replacen("endloop\n", "", 1);
    assert_eq!(refusal(open.as_bytes(), "stl"), "t.x:7: `endfacet` before the end of a loop");
    let line = OFF.replace("4 4 0", "4 5 0") + "2 0 1\n";
    assert_eq!(told(line.as_bytes(), "off"), ["polygons left out: 1 of fewer than three corners"]);
    let none = refusal(b"OFF\n2 1 0\n0 0 0\n1 0 0\n2 0 1\n", "off");
    let holds = "OFF without a triangle; it holds 2 vertices; polygons left out: 1 of fewer than three corners";
    assert!(none.ends_with(holds), "{none}");
    let unnamed = String::from_utf8(ply("ascii", b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
    let unnamed = refusal(unnamed.unwrap().replace("vertex_indices", "corners").as_bytes(), "ply");
    assert!(unnamed.ends_with("polygons left out: 4 of fewer than three corners"), "{unnamed}");
}

/// Text with a mark of byte order, and text in UTF-16 of either order.
#[test]
fn texts_of_other_encodings() {
    let ply = ply("ascii", b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    let coff = OFF.replacen("OFF", "COFF", 1);
    for (text, ending) in [
        (text_stl(), "stl"),
        (OFF.to_owned(), "off"),
        (coff, "off"),
        (String::from_utf8(ply).unwrap(), "ply"),
        (archives::AMF.to_owned(), "amf"),
    ] {
        let whole = volume(&import(text.as_bytes(), ending).model);
        let marked = format!("\u{feff}{text}");
        let little: Vec<u8> = marked.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = marked.encode_utf16().flat_map(u16::to_be_bytes).collect();
        for bytes in [marked.into_bytes(), little, big] {
            assert_eq!(volume(&import(&bytes, ending).model), whole, "{ending}");
        }
    }
}

/// Colours of OFF's vertices: one for all, several, entries of a table; the same for faces.
#[test]
fn colours_of_off() {
    let coloured = |last: &str, face: &str| {
        let row = |p: &[f32; 3]| format!("{} {} {} 255 0 0 255\n", p[0], p[1], p[2]);
        let rows: String = CORNERS[..3].iter().map(row).collect();
        import(format!("COFF\n4 1 0\n{rows}0 0 1 {last}\n3 0 1 2 {face}\n").as_bytes(), "off")
    };
    let colour = |i: &Import| i.model.parts[0].meshes[0].colour;
    let told = |i: &Import| i.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>();
    let red = coloured("255 0 0 255", "");
    assert_eq!((colour(&red), told(&red).len()), (Some([1.0, 0.0, 0.0, 1.0]), 0));
    let varied = coloured("0 0 255 255", "");
    assert_eq!(colour(&varied), None);
    assert_eq!(told(&varied), ["colours left out: colours of vertices, which vary over triangles"]);
    let table = coloured("255 0 0 255", "7");
    assert_eq!(told(&table), ["colours left out: 1 lines end in numbers that are no colour here"]);
    assert!(table.summary().left_out.contains_key("colours left out"));
}

/// A strip turns every second triangle, and -1 ends it.
#[test]
fn strips_of_ply() {
    let strips = |rows: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
             element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
             0 0 0\n1 0 0\n0 1 0\n0 0 1\n{rows}\n"
        )
    };
    // 0 2 1, then 2 3 1 turned; 0 3 2; 0 1 3
    let closed = import(strips("12 0 2 1 3 -1 0 3 2 -1 0 1 3").as_bytes(), "ply");
    assert!(closed.model.parts[0].closed && closed.warnings.is_empty());
    assert!((volume(&closed.model) - 1.0 / 6.0).abs() < 1e-15);
    assert!(refusal(strips("3 0 2 9").as_bytes(), "ply").contains("strip 0: vertex 9 of 4"));
    assert!(refusal(strips("3 0 2 -7").as_bytes(), "ply").contains("strip 0: a corner that is no vertex"));
}

#[test]
fn bounds_are_those_of_the_file() {
    let bounds = import(OFF.as_bytes(), "off").model.bounds();
    assert_eq!([bounds.min, bounds.max], [DVec3::ZERO, DVec3::ONE]);
}
