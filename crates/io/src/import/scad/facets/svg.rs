//! SVG drawings as regions, through usvg.
//!
//! Every path is filled, by odd and even; y runs upwards from the lower edge of the sheet; millimetres. Texts and
//! pictures are left out.

use super::Region;
use glam::DVec2;

/// The filled paths of an SVG file at so many dots an inch, its curves in `segments` for a circle; and notes on what is
/// left out.
pub(super) fn region(bytes: &[u8], dpi: f64, segments: f64, centred: bool) -> Result<(Region, Vec<String>), String> {
    let options = usvg::Options { dpi: dpi as f32, ..usvg::Options::default() };
    let tree = usvg::Tree::from_data(bytes, &options).map_err(|e| e.to_string())?;
    let unit = 25.4 / dpi;
    let size = DVec2::new(f64::from(tree.size().width()), f64::from(tree.size().height()));
    let mut paths = Vec::new();
    let mut waiting: Vec<&usvg::Group> = vec![tree.root()];
    while let Some(group) = waiting.pop() {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => waiting.push(inner),
                usvg::Node::Path(path) => paths.push(path),
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
            }
        }
    }
    let steps = (segments / 4.0).ceil().clamp(2.0, 1000.0) as u32;
    let regions = paths.iter().map(|path| {
        let transform = path.abs_transform();
        let place = |p: usvg::tiny_skia_path::Point| {
            let mut p = p;
            transform.map_point(&mut p);
            unit * DVec2::new(f64::from(p.x), size.y - f64::from(p.y))
        };
        let (mut done, mut open): (Vec<Vec<DVec2>>, Vec<DVec2>) = (Vec::new(), Vec::new());
        for segment in path.data().segments() {
            use usvg::tiny_skia_path::PathSegment;
            let control = match segment {
                PathSegment::MoveTo(p) => {
                    done.push(std::mem::take(&mut open));
                    open.push(place(p));
                    continue;
                }
                PathSegment::Close => continue,
                PathSegment::LineTo(p) => {
                    open.push(place(p));
                    continue;
                }
                PathSegment::QuadTo(a, b) => vec![place(a), place(b)],
                PathSegment::CubicTo(a, b, c) => vec![place(a), place(b), place(c)],
            };
            let mut row = vec![open.last().copied().unwrap_or_default()];
            row.extend(control);
            for i in 1..=steps {
                let mut points = row.clone();
                while points.len() > 1 {
                    points = points.windows(2).map(|w| w[0].lerp(w[1], f64::from(i) / f64::from(steps))).collect();
                }
                open.push(points[0]);
            }
        }
        done.push(open);
        done.retain(|c| c.len() > 2);
        Region::new(&done, true)
    });
    let all = Region::union(regions.collect());
    let shift = glam::DAffine2::from_translation(-0.5 * unit * size);
    Ok((if centred { all.moved(&shift) } else { all }, left_out(bytes)))
}

/// Elements that become no path, by their names in the text: the tree does not keep them.
fn left_out(bytes: &[u8]) -> Vec<String> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    let Ok(document) = roxmltree::Document::parse_with_options(text, options) else { return Vec::new() };
    let count = |name: &str| document.descendants().filter(|n| n.is_element() && n.tag_name().name() == name).count();
    let counts = ["text", "image"].map(|name| (name, count(name)));
    counts.into_iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!("{n} of `{name}` are not read")).collect()
}
