//! Text in a font that is made here: one glyph, a square of 600 units that stands 100 right of its origin.

use crate::import::scad::args::Args;
use crate::import::scad::facets::{Region, text};
use crate::import::scad::lex::Lexer;
use fontdb::Database;
use glam::DVec2;

/// A TrueType font: 1000 units an em; `A` and the missing glyph are the square, advance 800.
fn font(family: &str) -> Vec<u8> {
    let be = |words: &[i32]| words.iter().flat_map(|w| (*w as i16).to_be_bytes()).collect::<Vec<u8>>();
    let name: Vec<u8> = family.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let mut names = be(&[0, 2, 30]);
    names.extend(be(&[3, 1, 0x409, 1, name.len() as i32, 0]));
    names.extend(be(&[3, 1, 0x409, 6, name.len() as i32, 0]));
    names.extend(name);
    let mut glyph = be(&[1, 100, 0, 700, 600, 3, 0]); // one outline, its box, last point, no instructions
    glyph.extend([1, 1, 1, 1]); // four corners on the curve
    glyph.extend(be(&[100, 0, 600, 0]));
    glyph.extend(be(&[0, 600, 0, -600]));
    let length = glyph.len() as i32;
    let mut head = be(&[1, 0, 1, 0, 0, 0, 0x5F0F, 0x3CF5, 0, 1000]);
    head.extend([0; 16]);
    head.extend(be(&[100, 0, 700, 600, 0, 8, 2, 0, 0]));
    let mut cmap = be(&[0, 1, 3, 1, 0, 12, 4, 32, 0, 4, 4, 1, 0]);
    cmap.extend(be(&[65, -1, 0, 65, -1, 1 - 65, 1, 0, 0]));
    let mut os2 = vec![0; 96];
    os2[1] = 4;
    os2[4..6].copy_from_slice(&400_u16.to_be_bytes());
    os2[6..8].copy_from_slice(&5_u16.to_be_bytes());
    let mut post = be(&[3, 0]);
    post.extend([0; 28]);
    let tables: [(&[u8; 4], Vec<u8>); 10] = [
        (b"OS/2", os2),
        (b"cmap", cmap),
        (b"glyf", glyph),
        (b"head", head),
        (b"hhea", be(&[1, 0, 800, -200, 0, 800, 100, 100, 700, 1, 0, 0, 0, 0, 0, 0, 0, 1])),
        (b"hmtx", be(&[800, 100, 100])),
        (b"loca", be(&[0, 0, length / 2])),
        (b"maxp", be(&[1, 0, 2, 4, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0])),
        (b"name", names),
        (b"post", post),
    ];
    let mut file = be(&[1, 0, tables.len() as i32, 128, 3, 32]);
    let mut data = Vec::new();
    let first = 12 + 16 * tables.len();
    for (tag, table) in &tables {
        file.extend(*tag);
        file.extend([0; 4]);
        file.extend(((first + data.len()) as u32).to_be_bytes());
        file.extend((table.len() as u32).to_be_bytes());
        data.extend(table);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    file.extend(data);
    file
}

fn fonts(family: &str) -> Database {
    let mut fonts = Database::new();
    fonts.load_font_data(font(family));
    assert_eq!(fonts.len(), 1, "the font is one");
    fonts
}

fn drawn(arguments: &str, fonts: &Database) -> Result<(Region, Option<String>), String> {
    let mut lexer = Lexer::new(arguments);
    let args = Args::read(&mut lexer, "text", 1).unwrap();
    text::text(&args, fonts).map_err(|f| f.message)
}

fn bounds(region: &Region) -> [DVec2; 2] {
    let low = region.corners().fold(DVec2::INFINITY, DVec2::min);
    [low, region.corners().fold(DVec2::NEG_INFINITY, DVec2::max)]
}

#[test]
fn glyphs_stand_where_openscad_puts_them() {
    let fonts = fonts("Liberation Sans");
    // size 72: an em of 100, a square of 60 that stands 10 right of its origin, advance 80
    for (arguments, low, high) in [
        ("text = \"A\", size = 72)", [10.0, 0.0], [70.0, 60.0]),
        ("text = \"AA\", size = 72)", [10.0, 0.0], [150.0, 60.0]),
        ("text = \"AA\", size = 72, spacing = 2)", [10.0, 0.0], [230.0, 60.0]),
        ("text = \"A\", size = 36, halign = \"right\", valign = \"top\")", [-35.0, -30.0], [-5.0, 0.0]),
        ("text = \"A\", size = 72, halign = \"center\", valign = \"center\")", [-30.0, -30.0], [30.0, 30.0]),
        ("text = \"AA\", size = 72, direction = \"rtl\")", [10.0, 0.0], [150.0, 60.0]),
    ] {
        let (region, note) = drawn(arguments, &fonts).unwrap();
        let [l, h] = bounds(&region);
        let near = |a: DVec2, b: [f64; 2]| a.distance(DVec2::from_array(b)) < 1e-9;
        assert!(near(l, low) && near(h, high), "{arguments}: {l} {h}");
        assert_eq!(note, None);
        let expected = if arguments.contains("AA") { 7200.0 } else { 3600.0 };
        let scale = if arguments.contains("36") { 0.25 } else { 1.0 };
        assert!((region.area() - scale * expected).abs() < 1e-8, "{arguments}: {}", region.area());
    }
    assert!(drawn("text = \"\")", &fonts).unwrap().0.is_empty());
}

#[test]
fn fonts_that_are_not_there_are_named() {
    let (_, note) = drawn("text = \"A\", font = \"Gill:style=Bold\")", &fonts("Liberation Sans")).unwrap();
    assert_eq!(note.unwrap(), "the font `Gill` is not installed: Liberation Sans is used");
    let error = drawn("text = \"A\", font = \"Gill\")", &fonts("Other")).unwrap_err();
    assert!(error.contains("the font `Gill` is not installed, nor is Liberation Sans"), "{error}");
    let error = drawn("text = \"A\")", &Database::new()).unwrap_err();
    assert!(error.contains("Liberation Sans` is not installed"), "{error}");
    let error = drawn("text = \"A\", size = nan)", &fonts("Liberation Sans")).unwrap_err();
    assert!(error.contains("not finite"), "{error}");
    // a font that is cut off is refused
    let whole = font("Liberation Sans");
    let mut cut = Database::new();
    cut.load_font_data(whole[..whole.len() / 2].to_vec());
    assert!(drawn("text = \"A\")", &cut).is_err());
}
