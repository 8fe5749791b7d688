//! The arguments that OpenSCAD knows of each node, and the order of values without a name.
//!
//! ```text
//!   cylinder(5, d = 3, bottom = 2)    ▶    h = 5, r = 1.5; `bottom` is not known
//! ```
//!
//! Source: *OpenSCAD User Manual*, 2021.01; the output of `openscad -o x.csg` of 2021.01 and later.

use super::args::Value;

/// A node; the arguments that may stand without their names, in order; its others.
type Signature = (&'static str, &'static [&'static str], &'static [&'static str]);

static SIGNATURES: [Signature; 19] = [
    ("cube", &["size", "center"], &[]),
    ("sphere", &["r"], &["d"]),
    ("cylinder", &["h", "r1", "r2", "center"], &["r", "d", "d1", "d2"]),
    ("polyhedron", &["points", "faces", "convexity"], &[]),
    ("square", &["size", "center"], &[]),
    ("circle", &["r"], &["d"]),
    ("polygon", &["points", "paths", "convexity"], &[]),
    (
        "linear_extrude",
        &["height"],
        &["center", "convexity", "twist", "slices", "segments", "scale", "file", "layer", "origin", "timestamp"],
    ),
    ("rotate_extrude", &["angle"], &["start", "convexity", "file", "layer", "origin", "scale", "timestamp"]),
    ("multmatrix", &["m"], &[]),
    ("color", &["c", "alpha"], &[]),
    ("resize", &["newsize", "auto"], &["convexity"]),
    ("offset", &["r"], &["delta", "chamfer"]),
    ("projection", &["cut"], &["convexity"]),
    (
        "text",
        &["text", "size", "font"],
        &["direction", "language", "script", "halign", "valign", "spacing", "convexity"],
    ),
    ("import", &["file"], &["layer", "origin", "scale", "convexity", "center", "dpi", "timestamp", "width", "height"]),
    ("surface", &["file", "center", "invert"], &["convexity", "timestamp"]),
    ("render", &["convexity"], &[]),
    ("minkowski", &["convexity"], &[]),
];

/// A diameter, and the radius of half its size.
const DIAMETERS: [(&str, &str); 3] = [("d", "r"), ("d1", "r1"), ("d2", "r2")];

/// Names the arguments of a node, and makes radii of diameters, which win over stated radii. The result is what cannot
/// be used; `undef`, 0 and an empty text count as absent there.
pub(super) fn settle(node: &str, all: &mut Vec<(Option<&str>, Value)>) -> Vec<String> {
    let Some((_, ordered, other)) = SIGNATURES.iter().find(|(name, ..)| *name == node) else { return Vec::new() };
    let mut unknown = Vec::new();
    let unnamed = all.iter_mut().filter(|(name, _)| name.is_none());
    for (place, (name, _)) in unnamed.enumerate() {
        *name = ordered.get(place).copied();
    }
    if all.iter().any(|(name, _)| name.is_none()) {
        unknown.push(format!("more than {} values without a name", ordered.len()));
    }
    for (diameter, radius) in DIAMETERS.into_iter().filter(|(d, _)| other.contains(d)) {
        let Some(at) = all.iter().position(|(name, v)| *name == Some(diameter) && *v != Value::Undefined) else {
            continue;
        };
        let (_, mut value) = all.remove(at);
        if let Value::Number(x) = &mut value {
            *x *= 0.5;
        }
        all.insert(0, (Some(radius), value));
    }
    let known = |name: &str| name.starts_with('$') || ordered.contains(&name) || other.contains(&name);
    let absent = [Value::Undefined, Value::Number(0.0), Value::Text(String::new())];
    let stated = all.iter().filter(|(_, value)| !absent.contains(value));
    let names = stated.filter_map(|(name, _)| *name).filter(|name| !known(name));
    unknown.extend(names.map(|name| format!("`{name}`, which is not known")));
    unknown
}
