//! Bodies: what a representation lists as one drawable thing.
//!
//! ```text
//!   MANIFOLD_SOLID_BREP, FACETED_BREP('',shell)                    closed
//!   BREP_WITH_VOIDS('',shell,(oriented shells of the voids))       closed; void shells are turned so
//!                                                                  that normals leave the material
//!   SHELL_BASED_SURFACE_MODEL('',(shells))                         closed if every shell is
//!   FACE_BASED_SURFACE_MODEL, GEOMETRIC_SET, a shell or a face     open
//! ```
//!
//! A face that cannot be mapped is left out with a note; the body stays.

use super::colour::Colours;
use super::entity::{Entity, Fault};
use super::face::EdgeTable;
use super::geometry::{FACE_LOST, Geometry};
use super::spline;
use crate::brep::{Edge, FaceGeometry};
use crate::model::Colour;
use std::collections::HashSet;

/// A body in the terms of `brep`.
#[derive(Debug, Default)]
pub(super) struct Body {
    /// The faces bound a volume.
    pub closed: bool,
    /// Shared edges.
    pub edges: Vec<Edge>,
    /// Faces and their colours.
    pub faces: Vec<(FaceGeometry, Option<Colour>)>,
    /// Faces in the file, those that failed included.
    pub face_count: usize,
    /// Faces that could not be mapped, and why.
    pub lost: Vec<(u32, String)>,
}

const SOLIDS: [&str; 3] = ["MANIFOLD_SOLID_BREP", "FACETED_BREP", "BREP_WITH_VOIDS"];
const MODELS: [&str; 2] = ["SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL"];
const SETS: [&str; 2] = ["GEOMETRIC_SET", "GEOMETRIC_CURVE_SET"];
const SHELLS: [&str; 6] = [
    "CLOSED_SHELL",
    "OPEN_SHELL",
    "ORIENTED_CLOSED_SHELL",
    "ORIENTED_OPEN_SHELL",
    "CONNECTED_FACE_SET",
    "VERTEX_SHELL",
];
const FACES: [&str; 5] = ["ADVANCED_FACE", "FACE_SURFACE", "FACE", "ORIENTED_FACE", "CURVE_BOUNDED_SURFACE"];

/// Solids and surface models: bodies even when no representation lists them.
pub(super) const MAIN_KINDS: [&str; 5] = [SOLIDS[0], SOLIDS[1], SOLIDS[2], MODELS[0], MODELS[1]];

/// Geometry that is drawn by other programs but not by this one.
const UNSUPPORTED: [&str; 12] = [
    "CSG_SOLID",
    "BOOLEAN_RESULT",
    "EXTRUDED_AREA_SOLID",
    "EXTRUDED_FACE_SOLID",
    "REVOLVED_AREA_SOLID",
    "REVOLVED_FACE_SOLID",
    "SWEPT_DISK_SOLID",
    "SOLID_REPLICA",
    "TESSELLATED_SOLID",
    "TESSELLATED_SHELL",
    "TRIANGULATED_FACE",
    "COMPLEX_TRIANGULATED_FACE",
];

/// What an item of a representation is to the importer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    Body,
    Unsupported,
    Other,
}

/// Whether an item is a body. A geometric set is one if it holds a surface.
pub(super) fn role(geometry: &Geometry<'_>, item: Entity<'_>) -> Role {
    let any = |names: &[&str]| item.kinds().any(|k| names.contains(&k));
    if any(&SOLIDS) || any(&MODELS) || any(&SHELLS) || any(&FACES) || item.kinds().any(spline::is_surface) {
        return Role::Body;
    }
    if any(&SETS) {
        let surface = |id: u32| {
            let entity = geometry.entity(id);
            entity.is_ok_and(|e| e.is("CURVE_BOUNDED_SURFACE") || e.kinds().any(spline::is_surface))
        };
        return if item.references().any(surface) { Role::Body } else { Role::Other };
    }
    if any(&UNSUPPORTED) { Role::Unsupported } else { Role::Other }
}

/// Maps the body `#id`; `outer` are items whose colour it inherits, innermost first.
pub(super) fn body(geometry: &Geometry<'_>, id: u32, colours: &Colours, outer: &[u32]) -> Body {
    let mut builder =
        Builder { geometry, colours, body: Body::default(), table: EdgeTable::default(), seen: HashSet::new() };
    let trail: Vec<u32> = std::iter::once(id).chain(outer.iter().copied()).collect();
    if let Err(fault) = builder.item(id, &trail) {
        geometry.ledger.note("body left out", id, fault.to_string());
    }
    Body { edges: builder.table.edges, ..builder.body }
}

struct Builder<'g, 'a> {
    geometry: &'g Geometry<'a>,
    colours: &'g Colours,
    body: Body,
    table: EdgeTable,
    /// Faces already taken: a face listed twice would coincide with itself.
    seen: HashSet<u32>,
}

impl Builder<'_, '_> {
    fn item(&mut self, id: u32, colours: &[u32]) -> Result<(), Fault> {
        let entity = self.geometry.entity(id)?;
        if SOLIDS.iter().any(|k| entity.is(k)) {
            self.body.closed = true;
            return self.solid(entity, colours);
        }
        if let Some(fields) = MODELS.iter().find_map(|k| entity.fields(k, 1).ok()) {
            self.body.closed = true;
            for shell in fields.references(0)? {
                let shell = shell?;
                self.body.closed &= self.geometry.entity(shell).is_ok_and(|e| e.kinds().any(|k| k.contains("CLOSED")));
                self.guarded("shell left out", shell, |s| s.shell(shell, true, colours));
            }
            return Ok(());
        }
        if let Some(fields) = SETS.iter().find_map(|k| entity.fields(k, 1).ok()) {
            for element in fields.references(0)? {
                let element = element?;
                let found = self.geometry.entity(element)?;
                if found.is("CURVE_BOUNDED_SURFACE") || found.kinds().any(spline::is_surface) {
                    self.face(element, true, colours)?;
                }
            }
            return Ok(());
        }
        if SHELLS.iter().any(|k| entity.is(k)) {
            self.body.closed = entity.kinds().any(|k| k.contains("CLOSED"));
            return self.shell(id, true, colours);
        }
        self.face(id, true, colours)
    }

    fn solid(&mut self, entity: Entity<'_>, colours: &[u32]) -> Result<(), Fault> {
        let outer = SOLIDS.iter().find_map(|k| entity.fields(k, 1).ok()?.optional(0));
        let outer = outer.ok_or_else(|| entity.not("a solid with an outer shell"))?;
        self.shell(outer, true, colours)?;
        if let Ok(fields) = entity.fields("BREP_WITH_VOIDS", 1) {
            // simple: (name, outer, voids); complex: the part holds the voids alone
            let voids = fields.list(1).or_else(|_| fields.list(0))?;
            for void in voids.filter_map(|v| v.reference()) {
                self.guarded("shell left out", void, |s| s.shell(void, true, colours));
            }
        }
        Ok(())
    }

    fn shell(&mut self, id: u32, sense: bool, colours: &[u32]) -> Result<(), Fault> {
        let geometry = self.geometry;
        geometry.ledger.nested(id, || {
            let entity = geometry.entity(id)?;
            let colours: Vec<u32> = std::iter::once(id).chain(colours.iter().copied()).collect();
            let oriented = ["ORIENTED_CLOSED_SHELL", "ORIENTED_OPEN_SHELL"];
            if let Some(fields) = oriented.iter().find_map(|k| entity.fields(k, 2).ok()) {
                return self.shell(fields.reference(0)?, sense == fields.flag(1), &colours);
            }
            let kinds = ["CONNECTED_FACE_SET", "CLOSED_SHELL", "OPEN_SHELL"];
            let fields = kinds.iter().find_map(|k| entity.fields(k, 1).ok().filter(|f| f.list(0).is_ok()));
            for face in fields.ok_or_else(|| entity.not("a shell"))?.references(0)? {
                self.face(face?, sense, &colours)?;
            }
            Ok(())
        })
    }

    /// Adds a face, or a note why not. Fails only when the file's budget of work is spent.
    fn face(&mut self, id: u32, sense: bool, colours: &[u32]) -> Result<(), Fault> {
        self.geometry.ledger.spend(id, 1)?;
        if !self.seen.insert(id) {
            self.geometry.ledger.note("face listed twice", id, "the second one is left out");
            return Ok(());
        }
        self.body.face_count += 1;
        let colour = std::iter::once(&id).chain(colours).find_map(|i| self.colours.of_item(*i));
        match self.mapped(id) {
            Ok(mut face) => {
                face.same_sense = face.same_sense == sense;
                self.body.faces.push((face, colour));
            }
            Err(fault) => {
                self.geometry.ledger.note(FACE_LOST, id, fault.to_string());
                self.body.lost.push((id, fault.to_string()));
            }
        }
        Ok(())
    }

    fn mapped(&mut self, id: u32) -> Result<FaceGeometry, Fault> {
        let entity = self.geometry.entity(id)?;
        if entity.is("CURVE_BOUNDED_SURFACE") {
            return self.geometry.bounded_surface(entity, &mut self.table);
        }
        if entity.kinds().any(spline::is_surface) {
            let surface = self.geometry.surface(id)?.surface;
            return Ok(FaceGeometry { id, surface, bounds: Vec::new(), same_sense: true });
        }
        self.geometry.face(id, &mut self.table)
    }

    fn guarded(&mut self, kind: &'static str, id: u32, f: impl FnOnce(&mut Self) -> Result<(), Fault>) {
        if let Err(fault) = f(self) {
            self.geometry.ledger.note(kind, id, fault.to_string());
        }
    }
}
