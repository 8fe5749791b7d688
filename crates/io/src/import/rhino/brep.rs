//! Bodies that the decoder refuses as a whole: each face is read from the archive's own record.
//!
//! ```text
//!   lists of  curves in (u, v) | curves in space | surfaces | (vertices) | edges | trims | loops | faces
//!
//!   face ─▶ surface, turned or not      trim ─▶ its part of a curve in (u, v), edge
//!        └▶ loops ─▶ trims              edge ─▶ its part of a curve in space
//! ```
//!
//! A face that cannot be read, or that refers to a missing item, is lost; the other faces stay. Source:
//! `opennurbs_brep_io.cpp`.

use super::archive::{Class, Lost, Reader, version};
use super::face::{Beside, Built, Outline, Ring, built};
use super::shape::{Carrier, curve, surface};
use crate::model::{Colour, Face};
use crate::spline::{BSpline, Control};
use glam::{DVec3, DVec4};

/// First bytes of the ids of the class: openNURBS' own, two of older archives, and that of Rhino's modeller.
const IDS: [u32; 4] = [0x60B5_DBC5, 0x0705_FDEF, 0x2D4C_FEDB, 0xF06F_C243];
/// Loops outside and inside.
const OUTER: i32 = 1;
const INNER: i32 = 2;

/// Part of a curve, run backwards or not.
struct Use {
    curve: i32,
    range: [f64; 2],
    backwards: bool,
}

struct Trim {
    part: Use,
    edge: i32,
}

struct Loop {
    trims: Vec<i32>,
    kind: i32,
}

struct Stated {
    loops: Vec<i32>,
    surface: i32,
    backwards: bool,
    colour: Option<Colour>,
}

/// A body's lists. Indices in them may be out of range.
pub(super) struct Brep<'b> {
    flat: Vec<Option<Class<'b>>>,
    space: Vec<Option<Class<'b>>>,
    surfaces: Vec<Option<Class<'b>>>,
    edges: Vec<Use>,
    trims: Vec<Trim>,
    loops: Vec<Loop>,
    faces: Vec<Stated>,
    /// Every edge has two trims.
    pub closed: bool,
    /// Normals point into the solid.
    inwards: bool,
    scale: f64,
}

impl<'b> Brep<'b> {
    /// Whether an object of this class is a body.
    pub fn is(class: &Class<'_>) -> bool {
        IDS.contains(&class.id)
    }

    /// The lists of a body; lengths times `scale`.
    ///
    /// # Errors
    /// Where its lists end.
    pub fn read(archive: &[u8], class: Class<'b>, scale: f64) -> Lost<Self> {
        let mut r = class.data;
        let (major, minor) = r.version()?;
        if major != 3 {
            return Err(format!("a body of version {major}.{minor}"));
        }
        let [flat, space, surfaces] = [classes(&mut r)?, classes(&mut r)?, classes(&mut r)?];
        r.anonymous()?; // vertices
        let edge_list = r.anonymous()?;
        // later archives repeat the parameter's range
        let later = version(archive).is_some_and(|v| v >= 4);
        let (edges, uses) = match list(edge_list, |r| edge(r, true)) {
            Err(_) if !later => list(edge_list, |r| edge(r, false))?,
            all => all?,
        }
        .into_iter()
        .unzip::<_, _, Vec<_>, Vec<_>>();
        let trims = list(r.anonymous()?, trim)?;
        let loops = list(r.anonymous()?, |r| {
            r.skip(4)?;
            let all = Loop { trims: r.ints()?, kind: r.int()? };
            r.skip(4).map(|()| all)
        })?;
        let faces = faces(r.anonymous()?)?;
        let solid = solid(&mut r, minor).unwrap_or(0);
        let closed = match solid {
            1 | 2 => true,
            3 => false,
            _ => !uses.is_empty() && uses.iter().all(|trims: &usize| *trims == 2),
        };
        let inwards = solid == 2;
        Ok(Self { flat, space, surfaces, edges, trims, loops, faces, closed, inwards, scale })
    }

    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// A face, numbered `id`.
    ///
    /// # Errors
    /// What the face lacks, or which part of it is invalid.
    pub fn face(&self, at: usize, id: u32) -> Result<Built, String> {
        let face = &self.faces[at];
        let carrier = surface(class(&self.surfaces, face.surface, "surface")?, self.scale)?;
        let mut notes = Vec::new();
        let mut rings = Vec::new();
        for ring in &face.loops {
            let ring = place(&self.loops, *ring, "loop")?;
            if ring.kind != OUTER && ring.kind != INNER {
                notes.push("a loop that bounds no area was left out".to_owned());
                continue;
            }
            let mut all: Outline = Vec::new();
            for trim in &ring.trims {
                let trim = place(&self.trims, *trim, "trim")?;
                all.push((self.trim(trim, &carrier)?, self.beside(trim)));
            }
            if all.is_empty() {
                return Err("a loop without curves in (u, v)".to_owned());
            }
            rings.push(Ring { curves: all, hole: ring.kind == INNER });
        }
        let Carrier { surface, kind, .. } = carrier;
        let same_sense = face.backwards == self.inwards;
        let face = Face { id, kind, surface, loops: Vec::new(), same_sense, colour: face.colour };
        built(face, &rings, notes)
    }

    fn trim(&self, trim: &Trim, on: &Carrier) -> Lost<BSpline<DVec3>> {
        let part = self.part(&self.flat, &trim.part, "curve in (u, v)")?;
        on.map.curve(&part)
    }

    fn part(&self, of: &[Option<Class<'b>>], part: &Use, what: &str) -> Lost<BSpline<DVec4>> {
        let found = curve(class(of, part.curve, what)?, Some(part.range))?;
        Ok(if part.backwards { found.reversed() } else { found })
    }

    /// The curve in space, where there is one.
    fn beside(&self, trim: &Trim) -> Beside {
        if trim.edge < 0 {
            return Beside::Nothing;
        }
        let found = place(&self.edges, trim.edge, "edge").and_then(|e| self.part(&self.space, e, "curve"));
        let Ok(found) = found else { return Beside::Unknown };
        let points = found.points().iter().map(|p| DVec4::from_point(p.point() * self.scale, p.w)).collect();
        BSpline::new(found.degree(), found.knots().to_vec(), points).map_or(Beside::Unknown, Beside::Curve)
    }
}

fn place<'l, T>(all: &'l [T], at: i32, what: &str) -> Lost<&'l T> {
    usize::try_from(at).ok().and_then(|i| all.get(i)).ok_or_else(|| format!("there is no {what} {at}"))
}

fn class<'b>(all: &[Option<Class<'b>>], at: i32, what: &str) -> Lost<Class<'b>> {
    let found = place(all, at, what)?.as_ref().ok_or_else(|| format!("there is no {what} {at}"))?;
    Ok(Class { id: found.id, data: found.data })
}

/// A list of classes, some of which may be missing.
fn classes<'b>(r: &mut Reader<'b>) -> Lost<Vec<Option<Class<'b>>>> {
    list(r.anonymous()?, |r| if r.int()? == 1 { r.class().map(Some) } else { Ok(None) })
}

/// A list of things that fill their chunk.
fn list<'b, T>(mut r: Reader<'b>, mut one: impl FnMut(&mut Reader<'b>) -> Lost<T>) -> Lost<Vec<T>> {
    let (major, _) = r.version()?;
    if major != 1 {
        return Err(format!("a list of version {major}"));
    }
    let all = (0..r.count(4)?).map(|_| one(&mut r)).collect::<Lost<Vec<T>>>()?;
    if r.is_empty() { Ok(all) } else { Err("a list that is longer than it says".to_owned()) }
}

/// An edge's part of its curve, and how many trims it has.
fn edge(r: &mut Reader<'_>, again: bool) -> Lost<(Use, usize)> {
    r.skip(4)?;
    let (curve, backwards, range) = (r.int()?, r.int()? != 0, r.pair()?);
    r.skip(8)?;
    let trims = r.ints()?.len();
    r.skip(if again { 8 + 16 } else { 8 })?;
    Ok((Use { curve, range, backwards }, trims))
}

fn trim(r: &mut Reader<'_>) -> Lost<Trim> {
    r.skip(4)?;
    let (curve, range, edge) = (r.int()?, r.pair()?, r.int()?);
    // vertices, direction along the edge, kind, isoparametric side, loop, tolerances
    r.skip(8 + 4 + 4 + 4 + 4 + 16)?;
    // the parameter's range again; whether the curve is run backwards; reserved. Or two points, in older archives
    r.skip(16)?;
    let backwards = r.byte()? == 1;
    r.skip(7 + 24 + 16)?;
    Ok(Trim { part: Use { curve, range, backwards }, edge })
}

fn faces(mut r: Reader<'_>) -> Lost<Vec<Stated>> {
    let (major, minor) = r.version()?;
    if major != 1 {
        return Err(format!("a list of faces of version {major}"));
    }
    let mut all = Vec::new();
    for _ in 0..r.count(20)? {
        r.skip(4)?;
        let (loops, surface, backwards) = (r.ints()?, r.int()?, r.int()? != 0);
        r.skip(4)?;
        all.push(Stated { loops, surface, backwards, colour: None });
    }
    if minor >= 2 {
        r.skip(16 * all.len())?;
        if r.byte()? != 0 {
            for face in &mut all {
                let [red, green, blue, clear] = r.int()?.to_le_bytes().map(|b| f64::from(b) / 255.0);
                face.colour = Some(crate::import::colour::linear([red, green, blue], 1.0 - clear));
            }
        }
    }
    Ok(all)
}

/// The body's own statement: 1 a solid, 2 one inside out, 3 none.
fn solid(r: &mut Reader<'_>, minor: u8) -> Lost<i32> {
    r.skip(48)?;
    if minor < 2 {
        return Ok(0);
    }
    r.anonymous()?; // meshes to draw
    r.anonymous()?; // meshes to analyse
    r.int()
}
