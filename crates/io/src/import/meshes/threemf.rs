//! 3MF: an archive of XML.
//!
//! ```text
//!   _rels/.rels ──▶ 3D/3dmodel.model
//!     <model unit="millimeter">
//!       <resources>  <basematerials id> <base displaycolor/>      <m:colorgroup id> <m:color color/>
//!                    <object id pid pindex name> <mesh> <vertices/> <triangles/>      triangles: own pid, p1
//!                                                <components> <component objectid transform p:path/>
//!       <build>      <item objectid transform p:path/>
//! ```
//!
//! Triangles have one colour, that of their first corner. Textures and composite materials have none here, and beams
//! are not drawn. Warnings say so, and name extensions that a file calls required and that are not read.
//!
//! Source: 3MF Consortium, *3D Manufacturing Format core specification* 1.3; *materials extension* 1.2 (colour groups);
//! *production extension* 1.1 (paths).

use super::xml::{archive, index, line, millimetres, named, number, parse, unpacked};
use super::{Found, MOST_PLACED, Piece, Placement, Wrong};
use crate::import::colour::linear;
use crate::model::Colour;
use glam::{DAffine3, DVec3};
use roxmltree::Node;
use std::collections::HashMap;

/// Components within components.
const MOST_NESTED: usize = 64;

/// Namespaces that are read: the core, materials, and paths of the production extension.
const READ: [&str; 3] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
];

/// A number that is unique within one file of the archive.
type Key = (String, u32);

/// Part of an object: another one, and where.
type Component = (Key, DAffine3);

#[derive(Default)]
struct Reader {
    found: Found,
    /// Objects that hold a mesh, as pieces.
    meshes: HashMap<Key, usize>,
    components: HashMap<Key, Vec<Component>>,
    /// Colours of materials and groups.
    colours: HashMap<Key, Vec<Colour>>,
    items: Vec<Component>,
    names: HashMap<Key, String>,
    /// Triangles whose colour is none here, and those whose corners have different ones.
    colourless: [usize; 2],
}

pub(super) fn read(bytes: &[u8]) -> Result<Found, Wrong> {
    let mut archive = archive(bytes)?;
    let root = match unpacked(&mut archive, "_rels/.rels", bytes.len()) {
        Ok(text) => start(&text)?,
        Err(_) => "3D/3dmodel.model".to_owned(),
    };
    let mut reader = Reader::default();
    let (mut files, mut next) = (vec![root.clone()], 0);
    while let Some(file) = files.get(next).cloned() {
        next += 1;
        let text = unpacked(&mut archive, &file, bytes.len())?;
        let named_file = |w: Wrong| Wrong { line: w.line, message: format!("{file}: {}", w.message) };
        reader.model(&parse(&text).map_err(named_file)?, &file, file == root).map_err(named_file)?;
        let used = reader.components.values().flatten().chain(&reader.items).map(|((path, _), _)| path);
        let new: Vec<String> = used.filter(|p| !files.contains(p)).cloned().collect();
        for path in new {
            if !files.contains(&path) {
                files.push(path);
            }
        }
    }
    reader.place()
}

/// The model that the archive starts with.
fn start(text: &str) -> Result<String, Wrong> {
    let document = parse(text)?;
    let model = |n: &Node<'_, '_>| n.attribute("Type").is_some_and(|t| t.ends_with("/3dmodel"));
    let target = document.descendants().find(model).and_then(|n| n.attribute("Target"));
    Ok(target.unwrap_or("3D/3dmodel.model").trim_start_matches('/').to_owned())
}

impl Reader {
    fn model(&mut self, document: &roxmltree::Document<'_>, file: &str, first: bool) -> Result<(), Wrong> {
        let model = document.root_element();
        let unit = model.attribute("unit").unwrap_or("millimeter");
        let scale = millimetres(unit, model)?;
        if first {
            self.found.unit = unit.to_owned();
        }
        for prefix in model.attribute("requiredextensions").unwrap_or_default().split_whitespace() {
            let space = model.lookup_namespace_uri(Some(prefix)).unwrap_or(prefix);
            if !READ.contains(&space) {
                self.found.notes.push(("extension left out", space.to_owned()));
            }
        }
        for resources in named(model, "resources") {
            for group in resources.children().filter(Node::is_element) {
                let colours: Result<Vec<Colour>, Wrong> = match group.tag_name().name() {
                    "basematerials" => named(group, "base").map(|b| colour(b, "displaycolor")).collect(),
                    "colorgroup" => named(group, "color").map(|c| colour(c, "color")).collect(),
                    _ => continue,
                };
                self.colours.insert(key(group, "id", file)?, colours?);
            }
            for object in named(resources, "object") {
                self.object(object, file, scale)?;
            }
        }
        if first {
            for item in named(model, "build").flat_map(|b| named(b, "item")) {
                self.items.push(component(item, file, scale)?);
            }
        }
        Ok(())
    }

    fn object(&mut self, object: Node<'_, '_>, file: &str, scale: f64) -> Result<(), Wrong> {
        let own = key(object, "id", file)?;
        let name = object.attribute("name").unwrap_or_default().to_owned();
        self.names.insert(own.clone(), name.clone());
        for components in named(object, "components") {
            let all: Result<Vec<Component>, Wrong> =
                named(components, "component").map(|c| component(c, file, scale)).collect();
            self.components.insert(own.clone(), all?);
        }
        let Some(mesh) = named(object, "mesh").next() else { return Ok(()) };
        for beams in named(mesh, "beamlattice").flat_map(|b| named(b, "beams")) {
            let count = named(beams, "beam").count();
            self.found.notes.push(("beams left out", format!("object {}: {count}", own.1)));
        }
        let mut piece = Piece { name, ..Piece::default() };
        for vertex in named(mesh, "vertices").flat_map(|v| named(v, "vertex")) {
            let at = |name: &str| number(vertex.attribute(name), vertex);
            piece.points.push(scale * DVec3::new(at("x")?, at("y")?, at("z")?));
        }
        let count = piece.points.len();
        for triangle in named(mesh, "triangles").flat_map(|t| named(t, "triangle")) {
            let at = |name: &str| index(triangle.attribute(name), count, triangle);
            piece.triangles.push([at("v1")?, at("v2")?, at("v3")?]);
            let chosen = match (triangle.attribute("pid"), triangle.attribute("p1")) {
                (pid, Some(p)) => pid.or(object.attribute("pid")).zip(Some(p)),
                _ => object.attribute("pid").zip(object.attribute("pindex")),
            };
            let place =
                chosen.and_then(|(pid, p)| Some(((file.to_owned(), pid.parse().ok()?), p.parse::<usize>().ok()?)));
            let colour = place.and_then(|(group, p)| self.colours.get(&group)?.get(p).copied());
            let first = triangle.attribute("p1");
            let differs = |name: &str| triangle.attribute(name).is_some_and(|p| Some(p) != first);
            self.colourless[0] += usize::from(chosen.is_some() && colour.is_none());
            self.colourless[1] += usize::from(colour.is_some() && first.is_some() && (differs("p2") || differs("p3")));
            piece.colours.push(colour);
        }
        self.meshes.insert(own, self.found.pieces.len());
        self.found.pieces.push(piece);
        Ok(())
    }

    /// Walks from the items to the meshes.
    fn place(mut self) -> Result<Found, Wrong> {
        self.found.format = "3MF";
        let what = ["triangles have a texture, a mixture or no such colour", "triangles have the first corner's alone"];
        for (count, what) in self.colourless.into_iter().zip(what).filter(|(count, _)| *count > 0) {
            self.found.notes.push(("colours left out", format!("{count} {what}")));
        }
        let mut waiting: Vec<(Key, DAffine3, usize)> =
            self.items.iter().rev().map(|(k, t)| (k.clone(), *t, 0)).collect();
        while let Some((key, transform, depth)) = waiting.pop() {
            if depth > MOST_NESTED {
                return Err(Wrong::new(format!("object {}: components nested more than {MOST_NESTED} deep", key.1)));
            }
            if self.found.placements.len() + waiting.len() > MOST_PLACED {
                return Err(Wrong::new(format!("more than {MOST_PLACED} objects are placed")));
            }
            if let Some(&piece) = self.meshes.get(&key) {
                let name = self.names.get(&key).cloned().unwrap_or_default();
                self.found.placements.push(Placement { piece, transform, name });
            } else if let Some(components) = self.components.get(&key) {
                waiting.extend(components.iter().rev().map(|(k, t)| (k.clone(), transform * *t, depth + 1)));
            } else {
                return Err(Wrong::new(format!("object {} is not there", key.1)));
            }
        }
        let unused = self.found.pieces.len();
        let used: std::collections::HashSet<usize> = self.found.placements.iter().map(|p| p.piece).collect();
        if used.is_empty() && unused > 0 {
            return Err(Wrong::new("nothing is built of the objects"));
        }
        Ok(self.found)
    }
}

fn key(node: Node<'_, '_>, name: &'static str, file: &str) -> Result<Key, Wrong> {
    let id = node.attribute(name).and_then(|id| id.parse().ok());
    let id = id.ok_or_else(|| Wrong::at(line(node), format!("{} without a {name}", node.tag_name().name())))?;
    Ok((file.to_owned(), id))
}

fn component(node: Node<'_, '_>, file: &str, scale: f64) -> Result<Component, Wrong> {
    let path = node.attributes().find(|a| a.name() == "path").map(|a| a.value().trim_start_matches('/'));
    let own = key(node, "objectid", path.unwrap_or(file))?;
    let Some(text) = node.attribute("transform") else { return Ok((own, DAffine3::IDENTITY)) };
    let m: Result<Vec<f64>, Wrong> = text.split_whitespace().map(|w| number(Some(w), node)).collect();
    let m = m?;
    if m.len() != 12 {
        return Err(Wrong::at(line(node), format!("a transform of {} numbers, not 12", m.len())));
    }
    let mut transform = DAffine3::from_cols_slice(&m);
    transform.translation *= scale;
    Ok((own, transform))
}

/// `#RRGGBB` or `#RRGGBBAA`.
fn colour(node: Node<'_, '_>, name: &'static str) -> Result<Colour, Wrong> {
    let text = node.attribute(name).unwrap_or_default();
    let digits = text.strip_prefix('#').filter(|d| d.is_ascii() && (d.len() == 6 || d.len() == 8));
    let part = |i: usize| digits.and_then(|d| u8::from_str_radix(d.get(2 * i..2 * i + 2).unwrap_or("FF"), 16).ok());
    let parts: Option<Vec<f64>> = (0..4).map(|i| part(i).map(|c| f64::from(c) / 255.0)).collect();
    match parts.as_deref() {
        Some(&[r, g, b, a]) => Ok(linear([r, g, b], a)),
        _ => Err(Wrong::at(line(node), format!("`{}` is no colour", text.chars().take(20).collect::<String>()))),
    }
}
