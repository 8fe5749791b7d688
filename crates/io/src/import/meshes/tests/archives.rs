//! 3MF and AMF.

use super::{import, refusal, volume};
use std::io::Write;
use zip::write::SimpleFileOptions;

fn zipped(files: &[(&str, &str)]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in files {
        archive.start_file(*name, SimpleFileOptions::default()).unwrap();
        archive.write_all(text.as_bytes()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

const MESH: &str = r#"<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>
<vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>
<triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3" pid="5" p1="1"/></triangles></mesh>"#;

fn model(unit: &str, resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<model unit=\"{unit}\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\">\n<resources>{resources}</resources>\
         <build>{build}</build></model>"
    )
}

fn object() -> String {
    format!(
        "<basematerials id=\"5\"><base name=\"a\" displaycolor=\"#FF0000\"/><base name=\"b\" displaycolor=\"#0000FF80\"/></basematerials>\
         <object id=\"1\" name=\"tetra\" pid=\"5\" pindex=\"0\">{MESH}</object>"
    )
}

const TWICE: &str = r#"<object id="2"><components><component objectid="1"/>
<component objectid="1" transform="2 0 0 0 2 0 0 0 2 10 0 0"/></components></object>"#;

fn whole(unit: &str) -> String {
    model(unit, &(object() + TWICE), r#"<item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 5"/>"#)
}

#[test]
fn objects_stand_where_components_put_them() {
    for (unit, scale) in [("millimeter", 1.0), ("inch", 25.4), ("micron", 1e-3), ("meter", 1000.0)] {
        let import = import(&zipped(&[("3D/3dmodel.model", &whole(unit))]), "3mf");
        let expected = (1.0 + 8.0) / 6.0 * scale * scale * scale;
        assert!((volume(&import.model) - expected).abs() < 1e-12 * expected, "{unit}");
        let bounds = import.model.bounds();
        assert!(
            (bounds.max.x - 12.0 * scale).abs() < 1e-12 * scale && (bounds.min.z - 5.0 * scale).abs() < 1e-12 * scale
        );
        assert_eq!(import.model.unit, unit);
        assert!(import.model.parts.len() == 1 && import.model.parts[0].name == "tetra" && import.model.parts[0].closed);
    }
    let colours: Vec<_> = import(&zipped(&[("3D/3dmodel.model", &whole("inch"))]), "3mf").model.parts[0]
        .meshes
        .iter()
        .map(|m| m.colour.unwrap())
        .collect();
    assert_eq!(colours[0], [1.0, 0.0, 0.0, 1.0]);
    assert!(colours[1][2] == 1.0 && (colours[1][3] - 128.0 / 255.0).abs() < 1e-6);
}

#[test]
fn other_files_of_the_archive_are_followed() {
    let rels = r#"<Relationships><Relationship Target="/3D/main.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
    let main = model("millimeter", "", r#"<item objectid="1" p:path="/3D/Objects/a.model"/>"#);
    let files =
        [("_rels/.rels", rels), ("3D/main.model", &main), ("3D/Objects/a.model", &model("millimeter", &object(), ""))];
    assert!((volume(&import(&zipped(&files), "3mf").model) - 1.0 / 6.0).abs() < 1e-15);
    assert!(refusal(&zipped(&files[..2]), "3mf").contains("3D/Objects/a.model"));
}

/// Required extensions, beams, colours that are none, and objects that nothing builds are reported.
#[test]
fn what_is_lost_of_3mf_is_reported() {
    let told = |text: &str| {
        let import = import(&zipped(&[("3D/3dmodel.model", text)]), "3mf");
        (import.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>(), import.summary().is_complete())
    };
    let file = whole("millimeter");
    assert_eq!(told(&file), (vec![], true));
    let again =
        object().split_once("<object").unwrap().1.replacen("id=\"1\" name=\"tetra\"", "id=\"9\" name=\"spare\"", 1);
    for (from, to, message, complete) in [
        ("<model ", "<model requiredextensions=\"p x\" xmlns:x=\"urn:x\" ", "extension left out: urn:x", false),
        (
            "</triangles>",
            "</triangles><beamlattice><beams><beam/></beams></beamlattice>",
            "beams left out: object 1: 1",
            false,
        ),
        ("p1=\"1\"", "p1=\"7\"", "colours left out: 1 triangles have a texture, a mixture or no such colour", false),
        ("p1=\"1\"", "p1=\"1\" p2=\"0\"", "colours left out: 1 triangles have the first corner's alone", false),
        ("</resources>", format!("<object{again}</resources>").as_str(), "object not placed: spare", true),
    ] {
        assert!(file.contains(from), "{from}");
        assert_eq!(told(&file.replacen(from, to, 1)), (vec![message.to_owned()], complete));
    }
}

/// Curved triangles are flat here, and a colour that varies is none.
#[test]
fn what_is_lost_of_amf_is_reported() {
    let told = |from: &str, to: &str| {
        assert!(AMF.contains(from), "{from}");
        let import = import(AMF.replacen(from, to, 1).as_bytes(), "amf");
        import.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(told("", ""), Vec::<String>::new());
    let normal = "</coordinates><normal><nx>1</nx><ny>0</ny><nz>0</nz></normal>";
    assert_eq!(told("</coordinates>", normal), ["curved triangles drawn flat: 1 normals of vertices and curved edges"]);
    for (from, to) in
        [("</coordinates>", "</coordinates><color><r>1</r><g>0</g><b>0</b></color>"), ("<r>0</r>", "<r>x</r>")]
    {
        assert_eq!(told(from, to), ["colours left out: 1 of vertices, of textures, or that are formulas"]);
    }
}

#[test]
fn damaged_3mf() {
    let file = whole("millimeter");
    let cycle = TWICE.replace("objectid=\"1\"", "objectid=\"2\"");
    for (text, message) in [
        (file.replace("v3=\"3\" pid", "v3=\"9\" pid"), "vertex `9` of 4"),
        (file.replace("z=\"1\"", "z=\"nan\""), "`nan` of vertex is no finite number"),
        (file.replace("10 0 0\"", "10 0\""), "a transform of 11 numbers"),
        (file.replace("millimeter", "cubit"), "the unit `cubit` is not known"),
        (file.replace("#FF0000", "red"), "`red` is no colour"),
        (file.replace("objectid=\"1\"", "objectid=\"7\""), "object 7 is not there"),
        (file.replace(TWICE, &cycle), "nested more than 64 deep"),
        (file[..file.len() / 2].to_owned(), "t.x:"),
        (model("millimeter", &object(), ""), "nothing is built"),
        (model("millimeter", "", ""), "3MF without a triangle"),
    ] {
        let found = refusal(&zipped(&[("3D/3dmodel.model", &text)]), "3mf");
        assert!(found.contains(message), "{found}, not {message}");
    }
    let archive = zipped(&[("3D/3dmodel.model", &file)]);
    assert!(refusal(&archive[..archive.len() / 2], "3mf").contains("no whole ZIP archive"));
    assert!(refusal(&zipped(&[("a.txt", "")]), "3mf").contains("3D/3dmodel.model"));
    // 64 MiB of blanks in a file of 64 KiB
    let bomb = zipped(&[("3D/3dmodel.model", &" ".repeat(64 << 20))]);
    assert!(refusal(&bomb, "3mf").contains("unpacks to more than"));
    // 2^20 copies by 20 levels of two components each
    let levels: String = (2..22)
        .map(|i| format!("<object id=\"{i}\"><components><component objectid=\"{0}\"/><component objectid=\"{0}\"/></components></object>", i - 1))
        .collect();
    let many = model("millimeter", &(object() + &levels), r#"<item objectid="21"/>"#);
    assert!(refusal(&zipped(&[("3D/3dmodel.model", &many)]), "3mf").contains("more than 65536 objects"));
}

pub(super) const AMF: &str = r#"<?xml version="1.0"?>
<amf unit="inch"><material id="3"><color><r>0</r><g>1</g><b>0</b></color></material>
<object id="a"><metadata type="name">tetra</metadata><mesh><vertices>
<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>0</y><z>1</z></coordinates></vertex></vertices>
<volume materialid="3"><triangle><v1>0</v1><v2>2</v2><v3>1</v3></triangle><triangle><v1>0</v1><v2>1</v2><v3>3</v3></triangle>
<triangle><v1>0</v1><v2>3</v2><v3>2</v3></triangle><triangle><v1>1</v1><v2>2</v2><v3>3</v3></triangle></volume></mesh></object>
<constellation id="c"><instance objectid="a"><deltax>1</deltax><rz>90</rz></instance></constellation></amf>"#;

#[test]
fn amf() {
    for bytes in [AMF.as_bytes().to_vec(), zipped(&[("t.amf", AMF)])] {
        let import = import(&bytes, "amf");
        let expected = 25.4_f64.powi(3) / 6.0;
        assert!((volume(&import.model) - expected).abs() < 1e-12 * expected);
        let part = &import.model.parts[0];
        assert!(part.closed && part.name == "tetra" && part.meshes[0].colour == Some([0.0, 1.0, 0.0, 1.0]));
        // a quarter turn about z, then an inch along x: x from 0 to 1, y from 0 to 1
        let bounds = import.model.bounds();
        assert!(
            (bounds.max - 25.4).abs().max_element() < 1e-12 && bounds.min.abs().max_element() < 1e-12,
            "{bounds:?}"
        );
    }
    for (text, message) in [
        (AMF.replace("<v3>3</v3></triangle></volume>", "<v3>4</v3></triangle></volume>"), "t.x:9: vertex `4` of 4"),
        (AMF.replace("<z>1</z>", "<z>inf</z>"), "t.x:7: `inf` of coordinates is no finite number"),
        (AMF.replace("objectid=\"a\"", "objectid=\"b\""), "the object `b` is not there"),
        (AMF[..AMF.len() - 20].to_owned(), "t.x:"),
    ] {
        let found = refusal(text.as_bytes(), "amf");
        assert!(found.contains(message), "{found}, not {message}");
    }
}
