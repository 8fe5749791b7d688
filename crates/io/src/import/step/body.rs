//! Bodies: drawable items of a representation.
//!
//! ```text
//!   MANIFOLD_SOLID_BREP, FACETED_BREP('',shell)                    closed
//!   BREP_WITH_VOIDS('',shell,(oriented shells of the voids))       closed; void shells are turned so
//!                                                                  that normals leave the material
//!   SHELL_BASED_SURFACE_MODEL('',(shells))                         closed if every shell is
//!   FACE_BASED_SURFACE_MODEL, GEOMETRIC_SET, a shell or a face     open
//!   TESSELLATED_SOLID, TESSELLATED_SHELL, sets of triangles        meshes
//!   EXTRUDED_AREA_SOLID, SWEPT_DISK_SOLID and similar              closed: see `swept`, `disk`
//!   CSG_SOLID and similar                                          not here: see `csg`
//! ```
//!
//! A face that cannot be mapped is left out with a note; the body stays.

use super::colour::Colours;
use super::csg;
use super::entity::{Entity, Fault};
use super::face::EdgeTable;
use super::geometry::{FACE_LOST, Geometry};
use super::presentation::Presentation;
use super::spline;
use super::swept::SWEPT;
use super::tessellated::{self, Coordinates};
use crate::brep::{Edge, FaceGeometry, SurfaceGeometry};
use crate::model::{Colour, EdgeSource, Mesh};
use glam::DAffine3;
use std::collections::HashSet;

/// A body in the terms of `brep`.
#[derive(Debug, Default)]
pub(super) struct Body {
    /// The faces bound a volume, as the file states it.
    pub closed: bool,
    /// A face, shell or mesh of it is lost or hidden: what is left bounds nothing.
    pub incomplete: bool,
    /// Shared edges.
    pub edges: Vec<Edge>,
    /// Their numbers in the file, where they have one.
    pub stated_edges: Vec<Option<EdgeSource>>,
    /// Faces and their colours.
    pub faces: Vec<(FaceGeometry, Option<Colour>)>,
    /// Triangles that the file states.
    pub meshes: Vec<Mesh>,
    /// Faces that could not be mapped, and why.
    pub lost: Vec<(u32, String)>,
}

pub(super) const SOLIDS: [&str; 3] = ["MANIFOLD_SOLID_BREP", "FACETED_BREP", "BREP_WITH_VOIDS"];
pub(super) const MODELS: [&str; 2] = ["SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL"];
pub(super) const SETS: [&str; 2] = ["GEOMETRIC_SET", "GEOMETRIC_CURVE_SET"];
pub(super) const SHELLS: [&str; 7] = [
    "CLOSED_SHELL",
    "OPEN_SHELL",
    "ORIENTED_CLOSED_SHELL",
    "ORIENTED_OPEN_SHELL",
    "CONNECTED_FACE_SET",
    "CONNECTED_FACE_SUB_SET",
    "VERTEX_SHELL",
];
pub(super) const FACES: [&str; 5] = ["ADVANCED_FACE", "FACE_SURFACE", "FACE", "ORIENTED_FACE", "CURVE_BOUNDED_SURFACE"];

/// Geometry that is drawn by other programs but not by this one, by the end of its name.
const UNSUPPORTED: [&str; 5] = ["_SOLID", "_BREP", "_SURFACE_MODEL", "_SHELL", "TRIANGULATED_FACE"];

/// Surfaces that are faces without loops where a set or a representation lists them.
fn is_bare(entity: Entity<'_>) -> bool {
    const BOUNDED: [&str; 4] =
        ["RECTANGULAR_TRIMMED_SURFACE", "SPHERICAL_SURFACE", "TOROIDAL_SURFACE", "DEGENERATE_TOROIDAL_SURFACE"];
    entity.kinds().any(|k| spline::is_surface(k) || BOUNDED.contains(&k))
}

/// How the importer treats an item of a representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Drawn.
    Body,
    /// A shape that this program does not support.
    Unsupported,
    /// Curves and points: never drawn.
    Ignored,
    /// Of no kind that is known.
    Unknown,
    /// Placements, and annotation, which is counted elsewhere.
    Beside,
}

/// Whether an item is a body. A geometric set is one if it holds a surface.
pub(super) fn role(geometry: &Geometry<'_>, item: Entity<'_>) -> Role {
    let any = |names: &[&str]| item.kinds().any(|k| names.contains(&k));
    if any(&SOLIDS) || any(&MODELS) || any(&SHELLS) || any(&FACES) || is_bare(item) {
        return Role::Body;
    }
    if tessellated::is_tessellated(item) || csg::is_boolean(item) || any(&SWEPT) {
        return Role::Body;
    }
    if any(&SETS) {
        let surface = |id: u32| {
            let entity = geometry.entity(id);
            entity.is_ok_and(|e| e.is("CURVE_BOUNDED_SURFACE") || is_bare(e))
        };
        return if item.references().any(surface) { Role::Body } else { Role::Ignored };
    }
    let wire = |k: &str| k.ends_with("WIREFRAME_MODEL") || k.ends_with("CURVE") || k == "CARTESIAN_POINT";
    let unsupported = |k: &str| UNSUPPORTED.iter().any(|end| k.ends_with(end));
    let beside = |k: &str| ["PLACEMENT", "TRANSFORMATION", "ANNOTATION", "CALLOUT"].iter().any(|part| k.contains(part));
    match item.kinds().any(unsupported) {
        true => Role::Unsupported,
        false if item.kinds().any(wire) => Role::Ignored,
        false if item.kinds().any(beside) => Role::Beside,
        false => Role::Unknown,
    }
}

/// Maps the body `#id`; `outer` are items whose colour it inherits, innermost first.
pub(super) fn body(geometry: &Geometry<'_>, id: u32, looks: Looks<'_>, outer: &[u32]) -> Body {
    let mut builder = Builder::new(geometry, looks);
    let trail: Vec<u32> = std::iter::once(id).chain(outer.iter().copied()).collect();
    if let Err(fault) = builder.item(id, &trail) {
        geometry.ledger.note("body left out", id, fault.to_string());
        builder.body.incomplete = true;
    }
    Body { stated_edges: builder.table.sources(), edges: builder.table.edges, ..builder.body }
}

/// Faces that no shell holds, as one open body.
pub(super) fn loose(geometry: &Geometry<'_>, faces: &[u32], looks: Looks<'_>) -> Body {
    let mut builder = Builder::new(geometry, looks);
    for &face in faces {
        if let Err(fault) = builder.face(face, true, &[]) {
            geometry.ledger.note("body left out", face, fault.to_string());
            break;
        }
    }
    Body { stated_edges: builder.table.sources(), edges: builder.table.edges, ..builder.body }
}

struct Builder<'g, 'a> {
    geometry: &'g Geometry<'a>,
    looks: Looks<'g>,
    body: Body,
    table: EdgeTable,
    /// Faces already taken: a face listed twice would coincide with itself.
    seen: HashSet<u32>,
    coordinates: Coordinates,
}

/// How items look: their colours, and which are hidden.
#[derive(Clone, Copy, Debug)]
pub(super) struct Looks<'g> {
    pub colours: &'g Colours,
    pub presentation: &'g Presentation,
}

impl<'g, 'a> Builder<'g, 'a> {
    fn new(geometry: &'g Geometry<'a>, looks: Looks<'g>) -> Self {
        Self {
            geometry,
            looks,
            body: Body::default(),
            table: EdgeTable::default(),
            seen: HashSet::new(),
            coordinates: Coordinates::new(),
        }
    }

    /// Counts `#id` if it is hidden.
    fn hidden(&mut self, id: u32, kind: &str) -> bool {
        let hidden = self.looks.presentation.hides(id);
        if hidden {
            self.geometry.ledger.ignore(kind, 1);
            self.body.incomplete = true;
        }
        hidden
    }

    fn item(&mut self, id: u32, colours: &[u32]) -> Result<(), Fault> {
        let entity = self.geometry.entity(id)?;
        if SOLIDS.iter().any(|k| entity.is(k)) {
            self.body.closed = true;
            return self.solid(entity, colours);
        }
        if SWEPT.iter().any(|k| entity.is(k)) {
            self.body.closed = true;
            let colour = colours.iter().find_map(|i| self.looks.colours.of_item(*i));
            let faces = self.geometry.swept(entity, &mut self.table)?;
            self.body.faces.extend(faces.into_iter().map(|face| (face, colour)));
            return Ok(());
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
                if found.is("CURVE_BOUNDED_SURFACE") || is_bare(found) {
                    self.face(element, true, colours)?;
                } else {
                    self.geometry.ledger.ignore(&found.name(), 1);
                }
            }
            return Ok(());
        }
        if tessellated::is_tessellated(entity) {
            self.body.closed = entity.is("TESSELLATED_SOLID");
            return self.tessellated(id, DAffine3::IDENTITY, colours);
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
            if self.hidden(id, "hidden shells") {
                return Ok(());
            }
            let entity = geometry.entity(id)?;
            let colours: Vec<u32> = std::iter::once(id).chain(colours.iter().copied()).collect();
            let oriented = ["ORIENTED_CLOSED_SHELL", "ORIENTED_OPEN_SHELL"];
            if let Some(fields) = oriented.iter().find_map(|k| entity.fields(k, 2).ok()) {
                return self.shell(fields.reference(0)?, sense == fields.flag(1), &colours);
            }
            let kinds = ["CONNECTED_FACE_SET", "CLOSED_SHELL", "OPEN_SHELL", "CONNECTED_FACE_SUB_SET"];
            let fields = kinds.iter().find_map(|k| entity.fields(k, 1).ok().filter(|f| f.list(0).is_ok()));
            for face in fields.ok_or_else(|| entity.not("a shell"))?.references(0)? {
                match face {
                    Ok(face) => self.face(face, sense, &colours)?,
                    Err(fault) => self.lose(id, &fault),
                }
            }
            Ok(())
        })
    }

    /// Adds a face, or a note on why it is left out. Fails only when the file's budget of work is spent.
    fn face(&mut self, id: u32, sense: bool, colours: &[u32]) -> Result<(), Fault> {
        self.geometry.ledger.spend(id, 1)?;
        if !self.seen.insert(id) {
            self.geometry.ledger.note("face listed twice", id, "the second one is left out");
            return Ok(());
        }
        if self.hidden(id, "hidden faces") {
            return Ok(());
        }
        let colour = std::iter::once(&id).chain(colours).find_map(|i| self.looks.colours.of_item(*i));
        match self.mapped(id) {
            Ok(faces) => {
                for mut face in faces {
                    face.same_sense = face.same_sense == sense;
                    self.body.faces.push((face, colour));
                }
            }
            Err(fault) => self.lose(id, &fault),
        }
        Ok(())
    }

    /// Meshes of a tessellated item and of its members.
    fn tessellated(&mut self, id: u32, place: DAffine3, colours: &[u32]) -> Result<(), Fault> {
        let geometry = self.geometry;
        geometry.ledger.nested(id, || {
            let entity = geometry.entity(id)?;
            if self.hidden(id, "hidden tessellated items") {
                return Ok(());
            }
            if geometry.doubles_exact(entity) {
                geometry.ledger.ignore("tessellated items that double exact ones", 1);
                return Ok(());
            }
            let place = place * geometry.repositioned(entity)?;
            let colours: Vec<u32> = std::iter::once(id).chain(colours.iter().copied()).collect();
            let Some(fields) = tessellated::members(entity) else {
                let colour = colours.iter().find_map(|i| self.looks.colours.of_item(*i));
                let mut mesh = geometry.mesh(entity, place, &mut self.coordinates)?;
                mesh.colour = colour;
                self.body.meshes.push(mesh);
                return Ok(());
            };
            for item in fields.references(0)? {
                let item = item?;
                let found = geometry.entity(item);
                if found.as_ref().is_ok_and(|e| !tessellated::is_tessellated(*e)) {
                    geometry.ledger.ignore(&found?.name(), 1);
                } else {
                    self.guarded("tessellated item left out", item, |s| s.tessellated(item, place, &colours));
                }
            }
            Ok(())
        })
    }

    fn lose(&mut self, id: u32, fault: &Fault) {
        self.geometry.ledger.note(FACE_LOST, id, fault.to_string());
        self.body.lost.push((id, fault.to_string()));
        self.body.incomplete = true;
    }

    /// One face, or the parts of a surface that breaks.
    fn mapped(&mut self, id: u32) -> Result<Vec<FaceGeometry>, Fault> {
        let entity = self.geometry.entity(id)?;
        if entity.is("CURVE_BOUNDED_SURFACE") {
            return Ok(vec![self.geometry.bounded_surface(entity, &mut self.table)?]);
        }
        let whole =
            |surface, same_sense| FaceGeometry { id, surface, bounds: Vec::new(), same_sense, ambiguous: false };
        if entity.kinds().any(spline::is_surface) {
            let parts = self.geometry.bspline_surface(entity)?.into_iter();
            return Ok(parts.map(|s| whole(SurfaceGeometry::BSpline(s), true)).collect());
        }
        if is_bare(entity) {
            let carrier = self.geometry.surface(id)?;
            return Ok(vec![whole(carrier.surface, !carrier.flipped)]);
        }
        Ok(vec![self.geometry.face(id, &mut self.table)?])
    }

    fn guarded(&mut self, kind: &'static str, id: u32, f: impl FnOnce(&mut Self) -> Result<(), Fault>) {
        if let Err(fault) = f(self) {
            self.geometry.ledger.note(kind, id, fault.to_string());
            self.body.incomplete = true;
        }
    }
}
