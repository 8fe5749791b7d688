//! AMF (ISO/ASTM 52915): XML, in an archive or not.
//!
//! ```text
//!   <amf unit="millimeter">
//!     <material id> <color> <r/> <g/> <b/> <a/>
//!     <object id> <metadata type="name"/> <color/>
//!       <mesh> <vertices> <vertex> <coordinates> <x/> <y/> <z/>
//!              <volume materialid> <color/> <triangle> <v1/> <v2/> <v3/>
//!     <constellation id> <instance objectid> <deltax/> … <rx/> …       degrees, about x, then y, then z
//! ```
//!
//! Curved triangles are drawn flat. Colours that are formulas, textures or of vertices are left out. Warnings say so.

use super::xml::{archive, index, line, millimetres, named, number, parse, unpacked};
use super::{Found, MOST_PLACED, Note, Piece, Placement, Wrong};
use crate::import::colour::linear;
use crate::model::Colour;
use glam::{DAffine3, DMat3, DVec3};
use roxmltree::Node;
use std::collections::HashMap;

pub(super) fn read(bytes: &[u8]) -> Result<Found, Wrong> {
    let text = if bytes.starts_with(b"PK") {
        let mut archive = archive(bytes)?;
        let mut names = archive.file_names().filter_map(|n| Some(n.ok()?.into_owned()));
        let name = names.find(|n| n.to_ascii_lowercase().ends_with(".amf"));
        drop(names);
        let name = name.ok_or_else(|| Wrong::new("an archive without an AMF file"))?;
        unpacked(&mut archive, &name, bytes.len())?
    } else {
        std::str::from_utf8(bytes).map_err(|_| Wrong::new("neither an archive nor UTF-8 text"))?.to_owned()
    };
    let document = parse(&text)?;
    let root = document.root_element();
    let unit = root.attribute("unit").unwrap_or("millimeter");
    let scale = millimetres(unit, root)?;
    let mut found = Found { format: "AMF", unit: unit.to_owned(), ..Found::default() };
    let mut materials = HashMap::new();
    for material in named(root, "material") {
        materials.insert(material.attribute("id").unwrap_or_default(), colour(material));
    }
    let mut objects: HashMap<&str, usize> = HashMap::new();
    for object in named(root, "object") {
        objects.insert(object.attribute("id").unwrap_or_default(), found.pieces.len());
        found.pieces.push(self::object(object, &materials, scale)?);
    }
    for constellation in named(root, "constellation") {
        for instance in named(constellation, "instance") {
            let id = instance.attribute("objectid").unwrap_or_default();
            let piece = *objects.get(id).ok_or_else(|| {
                Wrong::at(line(instance), format!("the object `{id:.20}` is not there, or is a constellation"))
            })?;
            let at = |name: &'static str| text_of(instance, name).map_or(Ok(0.0), |t| number(Some(t), instance));
            let (x, y, z) = (at("rx")?.to_radians(), at("ry")?.to_radians(), at("rz")?.to_radians());
            let matrix3 = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
            let translation = scale * DVec3::new(at("deltax")?, at("deltay")?, at("deltaz")?);
            let name = found.pieces[piece].name.clone();
            found.placements.push(Placement { piece, transform: DAffine3 { matrix3, translation }, name });
        }
    }
    if found.placements.len() > MOST_PLACED {
        return Err(Wrong::new(format!("more than {MOST_PLACED} objects are placed")));
    }
    found.notes.extend(flattened(root));
    Ok(found)
}

/// What the model has in a simpler form.
fn flattened(root: Node<'_, '_>) -> Vec<Note> {
    let (mut colours, mut curved) = (0, 0);
    for node in root.descendants().filter(Node::is_element) {
        let within = |name: &str| node.parent().is_some_and(|p| p.tag_name().name() == name);
        match node.tag_name().name() {
            "color" if within("vertex") || node.parent().and_then(colour).is_none() => colours += 1,
            "texmap" | "composite" => colours += 1,
            "normal" if within("vertex") => curved += 1,
            "edge" if within("vertices") => curved += 1,
            _ => {}
        }
    }
    let mut notes = Vec::new();
    if colours > 0 {
        notes.push(("colours left out", format!("{colours} of vertices, of textures, or that are formulas")));
    }
    if curved > 0 {
        notes.push(("curved triangles drawn flat", format!("{curved} normals of vertices and curved edges")));
    }
    notes
}

fn object(object: Node<'_, '_>, materials: &HashMap<&str, Option<Colour>>, scale: f64) -> Result<Piece, Wrong> {
    let name = named(object, "metadata").find(|m| m.attribute("type") == Some("name")).and_then(|m| m.text());
    let mut piece = Piece { name: name.unwrap_or_default().trim().to_owned(), ..Piece::default() };
    for mesh in named(object, "mesh") {
        let first = piece.points.len() as u32;
        for vertex in named(mesh, "vertices").flat_map(|v| named(v, "vertex")) {
            let place = named(vertex, "coordinates").next().unwrap_or(vertex);
            let at = |name: &'static str| number(text_of(place, name), place);
            piece.points.push(scale * DVec3::new(at("x")?, at("y")?, at("z")?));
        }
        let count = piece.points.len() - first as usize;
        for volume in named(mesh, "volume") {
            let material = volume.attribute("materialid").and_then(|id| materials.get(id).copied().flatten());
            let whole = colour(volume).or(colour(object)).or(material);
            for triangle in named(volume, "triangle") {
                let at = |name: &'static str| index(text_of(triangle, name), count, triangle).map(|i| first + i);
                piece.triangles.push([at("v1")?, at("v2")?, at("v3")?]);
                piece.colours.push(colour(triangle).or(whole));
            }
        }
    }
    Ok(piece)
}

fn text_of<'a>(node: Node<'a, '_>, name: &'static str) -> Option<&'a str> {
    node.children().find(|n| n.tag_name().name() == name).and_then(|n| n.text())
}

fn colour(node: Node<'_, '_>) -> Option<Colour> {
    let own = named(node, "color").next()?;
    let part = |name: &'static str| text_of(own, name).and_then(|t| t.trim().parse::<f64>().ok());
    Some(linear([part("r")?, part("g")?, part("b")?], part("a").unwrap_or(1.0)))
}
