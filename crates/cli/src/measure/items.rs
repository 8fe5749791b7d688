//! From names to items of the model.

use super::name::{Name, Number};
use anyhow::{Result, bail};
use glam::{DVec2, DVec3};
use selvedge::model::{Edge, EdgeSource, Edges, Face, Instance, Model, Part};
use selvedge_geometry::measure::Item;
use serde::Serialize;
use std::collections::HashSet;

/// The items of a model.
pub struct Items<'a> {
    model: &'a Model,
    /// Of each part; empty where no edge is named.
    edges: Vec<Edges>,
}

/// A face or an edge of a placed part.
#[derive(Debug, Serialize)]
pub struct Listed {
    /// Its name on the command line.
    pub item: String,
    /// Of the surface, or of the edge.
    pub kind: String,
    /// The name of its placed part.
    pub part: String,
    /// A point of it, where its border or its curve begins: model coordinates.
    pub at: [f64; 3],
}

/// Where the first loop of a face begins, or the corner of a whole surface: part coordinates.
fn begin(face: &Face) -> DVec3 {
    let ((u, _), (v, _)) = face.surface.domain();
    let first = face.loops.first().and_then(|trim_loop| trim_loop.curves().next());
    let uv = first.map_or(DVec2::new(u, v), |curve| curve.point(0.0));
    face.surface.point(uv.x, uv.y)
}

impl<'a> Items<'a> {
    /// Finds the edges too, where an edge is named.
    pub fn new(model: &'a Model, has_edges: bool) -> Self {
        let of = |part: &Part| {
            part.edges().unwrap_or_else(|error| {
                tracing::warn!("edges of {:?}: {error}", part.name);
                Edges::default()
            })
        };
        let edges = if has_edges { model.parts.iter().map(of).collect() } else { Vec::new() };
        Self { model, edges }
    }

    /// Placed parts with their numbers.
    fn placed(&self) -> impl Iterator<Item = (usize, &'a Instance)> + use<'a> {
        self.model.instances.iter().enumerate().map(|(nth, instance)| (nth + 1, instance))
    }

    /// The names of the placed parts that have faces.
    pub fn parts(&self) -> Vec<Name> {
        let has_faces = |instance: &Instance| !self.model.parts[instance.part].faces.is_empty();
        self.placed().filter(|(_, instance)| has_faces(instance)).map(|(placed, _)| Name::Part(placed)).collect()
    }

    /// The item of a name, and its name with the placed part.
    pub fn find(&self, name: Name) -> Result<(Name, Item<'_>)> {
        let number = match name {
            Name::Face(number) | Name::Edge(number) => number,
            Name::Part(placed) => {
                let instance = self.instance(name, placed)?;
                return Ok((name, Item::Part(&self.model.parts[instance.part], instance.transform)));
            }
        };
        if let Some(placed) = number.placed {
            self.instance(name, placed)?;
        }
        let wanted = self.placed().filter(|(placed, _)| number.placed.is_none_or(|own| own == *placed));
        let mut found = wanted.filter_map(|(placed, instance)| Some((placed, self.item(name, instance)?)));
        let Some((placed, item)) = found.next() else {
            bail!("there is no {name} in the model: --list names what there is");
        };
        let full = name.of_placed(placed);
        match found.count() {
            0 => Ok((full, item)),
            others => bail!("{name} is in {} placed parts: say in which, as in {full}", others + 1),
        }
    }

    fn instance(&self, name: Name, placed: usize) -> Result<&'a Instance> {
        let Some(instance) = self.model.instances.get(placed - 1) else {
            bail!("{name}: placed parts have numbers from 1 to {}", self.model.instances.len());
        };
        Ok(instance)
    }

    /// The face or edge of this name in a placed part; the first one of several faces with the number.
    fn item(&self, name: Name, instance: &Instance) -> Option<Item<'_>> {
        match name {
            Name::Face(Number { number, .. }) => {
                let face = self.model.parts[instance.part].faces.iter().find(|face| face.id == number)?;
                Some(Item::Face(face, instance.transform))
            }
            Name::Edge(number) => {
                let edges = self.edges_of(instance.part, number);
                (!edges.is_empty()).then_some(Item::Edge(edges, instance.transform))
            }
            Name::Part(_) => None,
        }
    }

    /// The edges of a part that are one edge of the source, or the one at a place.
    fn edges_of(&self, part: usize, number: Number) -> Vec<&Edge> {
        let Some(Edges { edges, .. }) = self.edges.get(part) else { return Vec::new() };
        let source = EdgeSource { entity: number.number, item: number.item };
        let stated: Vec<&Edge> = edges.iter().filter(|edge| edge.source == Some(source)).collect();
        if !stated.is_empty() || number.item.is_some() {
            return stated;
        }
        let at_place = edges.get(number.number as usize - 1).filter(|edge| edge.source.is_none());
        at_place.into_iter().collect()
    }

    /// All faces and edges of the placed parts.
    pub fn list(&self) -> Vec<Listed> {
        let mut all = Vec::new();
        for (placed, instance) in self.placed() {
            let part = &self.model.parts[instance.part];
            let called = if instance.name.is_empty() { &part.name } else { &instance.name };
            let mut add = |name: Name, kind: String, at: DVec3| {
                let at = instance.transform.transform_point3(at).to_array();
                all.push(Listed { item: name.to_string(), kind, part: called.clone(), at });
            };
            for face in &part.faces {
                let number = Number { number: face.id, item: None, placed: Some(placed) };
                add(Name::Face(number), format!("{:?}", face.kind), begin(face));
            }
            let mut listed = HashSet::new();
            let edges = self.edges.get(instance.part).map_or(&[][..], |edges| edges.edges.as_slice());
            for (nth, edge) in edges.iter().enumerate() {
                let source = edge.source.unwrap_or(EdgeSource { entity: nth as u32 + 1, item: None });
                let name = Name::Edge(Number { number: source.entity, item: source.item, placed: Some(placed) });
                if let Some(first) = edge.curve.first().filter(|_| listed.insert(name)) {
                    add(name, format!("{:?}", edge.kind), first.piece.point(0.0));
                }
            }
        }
        all
    }
}
