//! Tables of points and pictures of heights.

use crate::import::scene::grid::{heights_from_png, points_from_csv};
use glam::DVec3;

#[test]
fn tables_of_points() {
    let text = b"# a comment\n0,0,0, 1,0,0.5\n\n0,2,0, 1,2,-1e-3\n";
    let g = points_from_csv(text, "data.csv").unwrap();
    assert_eq!(g.counts(), (2, 2));
    assert_eq!(g.points()[3], DVec3::new(1.0, 2.0, -1e-3));
    for (text, place) in [
        ("0,0,0,1,0,0\n0,1,x,1,1,0\n", "data.csv, line 2, field 3: `x`"),
        ("0,0,0,1,0,0\n0,1,0\n", "data.csv, line 2, field 3: 3 numbers"),
        ("0,0,0,1\n", "data.csv, line 1, field 4: three numbers"),
        ("0,0,nan,1,0,0\n", "data.csv, line 1, field 3: `nan`"),
        ("", "0 points in a row"),
        ("\u{0}\u{1}", "data.csv, line 1"),
    ] {
        let e = points_from_csv(text.as_bytes(), "data.csv").unwrap_err().to_string();
        assert!(e.contains(place), "{e}");
    }
    assert!(points_from_csv(&[0xff, 0xfe, b','], "data.csv").is_err());
}

fn picture(colour: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

#[test]
fn pictures_of_heights() {
    use png::{BitDepth, ColorType};
    let deep = picture(ColorType::Grayscale, BitDepth::Sixteen, &[0, 1, 0x12, 0x34, 0xff, 0xff, 0, 0]);
    assert_eq!(heights_from_png(&deep, "h.png").unwrap(), (2, vec![1, 0x1234, 0xffff, 0]));
    let shallow = picture(ColorType::Grayscale, BitDepth::Eight, &[0, 255, 1, 128]);
    assert_eq!(heights_from_png(&shallow, "h.png").unwrap(), (2, vec![0, 65_535, 257, 128 * 257]));
    let colour = picture(ColorType::Rgb, BitDepth::Eight, &[0; 12]);
    assert!(heights_from_png(&colour, "h.png").unwrap_err().to_string().contains("grey"));
    for end in 0..deep.len() {
        // cut anywhere: an error, or the picture when only the end mark is missing
        let _ = heights_from_png(&deep[..end], "h.png");
    }
    assert!(heights_from_png(&deep[..40], "h.png").is_err());
    // a header that claims 2^31 x 2^31 samples
    let mut huge = deep.clone();
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    assert!(heights_from_png(&huge, "h.png").is_err());
}
