//! Tessellated items (AP242): triangles stated by the file.
//!
//! ```text
//!   TESSELLATED_SOLID('',(items),link)   TESSELLATED_SHELL('',(items),link)   TESSELLATED_GEOMETRIC_SET('',(items))
//!     └▶ TRIANGULATED_FACE('',coordinates,n,(normals),link,(pnindex),(triangles))
//!        COMPLEX_TRIANGULATED_FACE      … (pnindex),(strips),(fans))
//!        TRIANGULATED_SURFACE_SET, COMPLEX_TRIANGULATED_SURFACE_SET: without link
//!          └▶ COORDINATES_LIST('',n,((x,y,z),…))
//!
//!   strip 1 2 3 4 5: (1 2 3) (3 2 4) (3 4 5)        fan 1 2 3 4: (1 2 3) (1 3 4)
//! ```
//!
//! Numbers count from 1 and name entries of `pnindex`, which name coordinates; without `pnindex` they name coordinates.
//! A single normal serves all points; else each point has its own, or none has one.
//!
//! An item that is linked to an exact solid, shell or face repeats it; it is counted, not drawn.
//!
//! Source: ISO 10303-42, 9 (tessellated shape representation); CAx-IF Recommended Practices for 3D
//! Tessellated Geometry.

use super::body::{FACES, SHELLS, SOLIDS};
use super::entity::{Entity, Fault, Fields};
use super::geometry::Geometry;
use super::part21::{Value, Values};
use crate::model::Mesh;
use glam::{DAffine3, DVec3};
use std::collections::HashMap;
use std::rc::Rc;

/// Items that hold others.
const GROUPS: [&str; 3] = ["TESSELLATED_SOLID", "TESSELLATED_SHELL", "TESSELLATED_GEOMETRIC_SET"];

/// Triangles: the name, the part of a complex instance that holds the points, a link stands behind the
/// normals, strips and fans stand in place of triangles.
const MESHES: [(&str, &str, bool, bool); 4] = [
    ("TRIANGULATED_FACE", "TESSELLATED_FACE", true, false),
    ("COMPLEX_TRIANGULATED_FACE", "TESSELLATED_FACE", true, true),
    ("TRIANGULATED_SURFACE_SET", "TESSELLATED_SURFACE_SET", false, false),
    ("COMPLEX_TRIANGULATED_SURFACE_SET", "TESSELLATED_SURFACE_SET", false, true),
];

/// Coordinates that several faces share, read once.
pub(super) type Coordinates = HashMap<u32, Rc<Vec<DVec3>>>;

/// The item holds triangles, or items that do.
pub(super) fn is_tessellated(entity: Entity<'_>) -> bool {
    is_mesh(entity) || members(entity).is_some()
}

fn is_mesh(entity: Entity<'_>) -> bool {
    MESHES.iter().any(|m| entity.is(m.0))
}

/// The items of a solid, shell or set.
pub(super) fn members<'a>(entity: Entity<'a>) -> Option<Fields<'a>> {
    GROUPS.iter().find_map(|g| entity.fields(g, 1).ok())
}

impl<'a> Geometry<'a> {
    /// The item repeats an exact one: its link names a solid, a shell or a face.
    pub fn doubles_exact(&self, entity: Entity<'a>) -> bool {
        let link = match MESHES.iter().find(|m| entity.is(m.0)) {
            Some((name, base, true, _)) => entity.fields(base, 1).or_else(|_| entity.fields(name, 1)).ok(),
            Some(_) => return false,
            None => None,
        };
        let link = match link {
            Some(fields) => fields.optional(3),
            None => GROUPS[..2].iter().find_map(|g| entity.fields(g, 1).ok()?.optional(1)),
        };
        let exact = |k: &str| SOLIDS.contains(&k) || SHELLS.contains(&k) || FACES.contains(&k);
        link.and_then(|id| self.entity(id).ok()).is_some_and(|e| e.kinds().any(exact))
    }

    /// Where a repositioned item stands.
    pub fn repositioned(&self, entity: Entity<'a>) -> Result<DAffine3, Fault> {
        match entity.fields("REPOSITIONED_TESSELLATED_ITEM", 1) {
            Ok(fields) => self.transform(fields.reference(0)?),
            Err(_) => Ok(DAffine3::IDENTITY),
        }
    }

    /// The triangles of a face or surface set.
    pub fn mesh(&self, entity: Entity<'a>, place: DAffine3, known: &mut Coordinates) -> Result<Mesh, Fault> {
        let id = entity.id();
        let kind = MESHES.iter().find(|m| entity.is(m.0)).ok_or_else(|| entity.not("a set of triangles"))?;
        let &(name, base, linked, strips) = kind;
        let own = entity.fields(name, 1)?;
        let (points, first) = match entity.fields(base, 1) {
            Ok(points) => (points, 0),
            Err(_) => (own, if linked { 4 } else { 3 }),
        };
        let coordinates = self.coordinates(points.reference(0)?, known)?;
        let normals = points.list(2).map_or_else(|_| Ok(Vec::new()), |list| triples(id, list))?;
        let chosen = own.list(first).map_or_else(|_| Ok(Vec::new()), |list| self.indices(id, list))?;
        let mut corners = Vec::new();
        if strips {
            for (at, split) in [(first + 1, strip as fn(&[usize]) -> Vec<[usize; 3]>), (first + 2, fan)] {
                for run in own.list(at)? {
                    corners.extend(split(&self.indices(id, run.list().ok_or_else(|| uneven(id))?)?));
                }
            }
        } else {
            for triangle in own.list(first + 1)? {
                let run = self.indices(id, triangle.list().ok_or_else(|| uneven(id))?)?;
                corners.push(run.try_into().map_err(|_| uneven(id))?);
            }
        }
        // only the points in use: many faces share one list
        let mut local: HashMap<usize, u32> = HashMap::new();
        let mut positions = Vec::new();
        let outside = Fault::Value { id, what: "a triangle names a point that is not there" };
        let (mut triangles, mut turned) = (Vec::new(), Vec::new());
        for corner in corners {
            let mut triangle = [0; 3];
            let mut normal = [DVec3::ZERO; 3];
            for (i, number) in corner.into_iter().enumerate() {
                let point = if chosen.is_empty() { Some(number) } else { chosen.get(number).copied() };
                let point = point.ok_or(outside.clone())?;
                let position = *coordinates.get(point).ok_or(outside.clone())?;
                triangle[i] = *local.entry(point).or_insert_with(|| {
                    positions.push(place.transform_point3(position));
                    positions.len() as u32 - 1
                });
                let all = if normals.len() == 1 { 0 } else { number };
                normal[i] = place.transform_vector3(normals.get(all).copied().unwrap_or_default());
            }
            triangles.push(triangle);
            turned.push(normal);
        }
        let count = if chosen.is_empty() { coordinates.len() } else { chosen.len() };
        if normals.len() > 1 && normals.len() < count {
            self.ledger.note("normals ignored", id, "they differ in number from the points");
        }
        if normals.is_empty() || (normals.len() > 1 && normals.len() < count) {
            turned.clear();
        }
        Mesh::new(id, positions, triangles, turned)
            .map_err(|_| Fault::Value { id, what: "a coordinate or normal is not finite" })
    }

    /// Numbers from 1 as numbers from 0; each costs work.
    fn indices(&self, id: u32, list: Values<'_>) -> Result<Vec<usize>, Fault> {
        let fault = || Fault::Value { id, what: "an index is not a number from 1" };
        let index = |value: Value<'_>| {
            self.ledger.spend(id, 1)?;
            value.count().and_then(|n| n.checked_sub(1)).ok_or_else(fault)
        };
        list.map(index).collect()
    }

    fn coordinates(&self, id: u32, known: &mut Coordinates) -> Result<Rc<Vec<DVec3>>, Fault> {
        if let Some(points) = known.get(&id) {
            return Ok(points.clone());
        }
        let fields = self.entity(id)?.fields("COORDINATES_LIST", 1)?;
        let mut points = triples(id, fields.list(1)?)?;
        self.ledger.spend(id, points.len())?;
        points.iter_mut().for_each(|p| *p *= self.units.length);
        let points = Rc::new(points);
        known.insert(id, points.clone());
        Ok(points)
    }
}

fn uneven(id: u32) -> Fault {
    Fault::Value { id, what: "its triangles are not lists of three numbers, nor strips or fans" }
}

fn triples(id: u32, list: Values<'_>) -> Result<Vec<DVec3>, Fault> {
    let fault = || Fault::Value { id, what: "a coordinate or normal is not three finite numbers" };
    let triple = |value: Value<'_>| {
        let mut numbers = value.list()?.map(|n| n.number().filter(|x| x.is_finite()));
        let xyz = DVec3::new(numbers.next()??, numbers.next()??, numbers.next()??);
        numbers.next().is_none().then_some(xyz)
    };
    list.map(|value| triple(value).ok_or_else(fault)).collect()
}

/// Every second triangle is turned, so that all run the same way around.
fn strip(run: &[usize]) -> Vec<[usize; 3]> {
    let turned = |(i, w): (usize, &[usize])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
    let triangles = run.windows(3).enumerate().map(turned);
    triangles.filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]).collect()
}

fn fan(run: &[usize]) -> Vec<[usize; 3]> {
    run.get(1..).unwrap_or_default().windows(2).map(|w| [run[0], w[0], w[1]]).collect()
}
