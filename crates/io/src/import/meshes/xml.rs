//! The common part of 3MF and AMF: XML, numbers in it, and the archives around it.

use super::Wrong;
use roxmltree::Node;
use std::io::Read;

/// Bytes that one file of an archive may have when it is unpacked.
const MOST_BYTES: u64 = 2 << 30;
/// By how much an archive may grow, beyond 16 MiB.
const MOST_GROWTH: u64 = 400;

pub(super) type Archive<'a> = zip::ZipArchive<std::io::Cursor<&'a [u8]>>;

pub(super) fn archive(bytes: &[u8]) -> Result<Archive<'_>, Wrong> {
    zip::ZipArchive::new(std::io::Cursor::new(bytes)).map_err(|e| Wrong::new(format!("no whole ZIP archive: {e}")))
}

/// One file of an archive, as text.
pub(super) fn unpacked(archive: &mut Archive<'_>, name: &str, packed: usize) -> Result<String, Wrong> {
    let wrong = |what: String| Wrong::new(format!("{name}: {what}"));
    let limit = MOST_BYTES.min((16 << 20) + MOST_GROWTH * packed as u64);
    let file = archive.by_name(name).map_err(|e| wrong(e.to_string()))?;
    let mut text = String::new();
    file.take(limit + 1).read_to_string(&mut text).map_err(|e| wrong(e.to_string()))?;
    if text.len() as u64 > limit {
        return Err(wrong(format!("unpacks to more than {limit} bytes")));
    }
    Ok(text)
}

pub(super) fn parse(text: &str) -> Result<roxmltree::Document<'_>, Wrong> {
    roxmltree::Document::parse(text).map_err(|e| Wrong { line: Some(e.pos().row as usize), message: e.to_string() })
}

/// Where a node stands.
pub(super) fn line(node: Node<'_, '_>) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

/// Children of a local name, whatever their namespace.
pub(super) fn named<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == name)
}

/// A finite number.
pub(super) fn number(text: Option<&str>, node: Node<'_, '_>) -> Result<f64, Wrong> {
    let text = text.unwrap_or_default().trim();
    let found = text.parse().ok().filter(|x: &f64| x.is_finite());
    found.ok_or_else(|| {
        let shown: String = text.chars().take(20).collect();
        Wrong::at(line(node), format!("`{shown}` of {} is no finite number", node.tag_name().name()))
    })
}

/// A vertex below `count`.
pub(super) fn index(text: Option<&str>, count: usize, node: Node<'_, '_>) -> Result<u32, Wrong> {
    let text = text.unwrap_or_default().trim();
    match text.parse::<u32>() {
        Ok(i) if (i as usize) < count => Ok(i),
        _ => {
            let shown: String = text.chars().take(20).collect();
            Err(Wrong::at(line(node), format!("vertex `{shown}` of {count}")))
        }
    }
}

/// Millimetres of a unit.
pub(super) fn millimetres(unit: &str, node: Node<'_, '_>) -> Result<f64, Wrong> {
    match unit {
        "micron" | "micrometer" => Ok(1e-3),
        "millimeter" | "" => Ok(1.0),
        "centimeter" => Ok(10.0),
        "inch" => Ok(25.4),
        "foot" | "feet" => Ok(304.8),
        "meter" => Ok(1000.0),
        other => Err(Wrong::at(line(node), format!("the unit `{other:.20}` is not known"))),
    }
}
