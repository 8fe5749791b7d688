//! The rules of a model that can be drawn: its fields are public, so a host or a file may violate each one.
//!
//! ```text
//!   memory, file ──▶ Model ──check──▶ upload
//!                      │ instances: parts that exist, transforms that place something, colours
//!                      │ parts: numbers of faces and meshes, colours, edges that exist
//!                      └ faces: loops that meet the domain of their surface
//! ```
//!
//! Surfaces, loops and meshes check themselves when they are made. Cost: one look at each control point of each loop.

use super::{Colour, Face, Instance, Model, Part, TrimLoop};
use glam::DVec2;

/// A loop may reach this far beyond its surface's domain, in widths of the domain. Files round loops, and a loop of a
/// closed surface may begin anywhere within one period; a loop farther off belongs to another surface.
const BEYOND: f64 = 1.0;
/// Least volume of a transformed unit cube, as a share of the product of its sides' lengths: `1e-12` is near the
/// rounding of a product of three `f64` matrices.
const FLAT: f64 = 1e-12;
/// Largest coordinates of a transform's axes, which are its factors of lengths: the engine has them in single precision,
/// whose numbers with all digits end at 1e-38 and 3e38.
const FACTORS: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Why a model cannot be drawn. Numbers are indices into the fields of [`Model`] and [`Part`].
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// An instance of nothing.
    #[error("instance {instance} is of part {part}, and there are {parts}")]
    Part { instance: usize, part: usize, parts: usize },
    /// A placement that is not finite.
    #[error("the transform of instance {instance} is not finite")]
    Transform { instance: usize },
    /// A placement that makes bodies too large or too small for single precision.
    #[error("the transform of instance {instance} makes lengths more than 1e30 times longer or shorter")]
    Scale { instance: usize },
    /// A placement that makes a body a plane, a line or a point.
    #[error("the transform of instance {instance} makes everything flat")]
    Flat { instance: usize },
    /// A face with the number of the background.
    #[error("face {face} of part {part} has number 0, which is the background's")]
    FaceNumber { part: usize, face: usize },
    /// A mesh with the number of the background.
    #[error("mesh {mesh} of part {part} has number 0, which is the background's")]
    MeshNumber { part: usize, mesh: usize },
    /// An invalid colour.
    #[error("the colour of {what} is not between 0 and 1")]
    Colour { what: Coloured },
    /// A trim curve of an edge that the part does not have.
    #[error("a trim curve of face {face} of part {part} is of edge {edge}, and the part has {edges}")]
    Edge { part: usize, face: usize, edge: u32, edges: usize },
    /// A loop that does not meet the domain of its surface, or goes far beyond it.
    #[error("trim loop {trim_loop} of face {face} of part {part} lies outside of the domain of its surface")]
    Loop { part: usize, face: usize, trim_loop: usize },
    /// [`Model::coincident`] is not a number.
    #[error("faces coincide within what is not a number")]
    Coincident,
}

/// What a colour belongs to, by indices: into [`Model::instances`], [`Model::parts`], the part's faces or meshes, and
/// the primitives of a solid.
#[allow(missing_docs)] // the fields are those indices
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Coloured {
    /// An instance.
    Instance(usize),
    /// A face of a part.
    Face { part: usize, face: usize },
    /// A mesh of a part.
    Mesh { part: usize, mesh: usize },
    /// A primitive of a solid; the solid's number is that of [`Model::solids`], and their count for [`Model::trim`].
    Primitive { solid: usize, primitive: usize },
}

impl std::fmt::Display for Coloured {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Instance(instance) => write!(f, "instance {instance}"),
            Self::Face { part, face } => write!(f, "face {face} of part {part}"),
            Self::Mesh { part, mesh } => write!(f, "mesh {mesh} of part {part}"),
            Self::Primitive { solid, primitive } => write!(f, "primitive {primitive} of solid {solid}"),
        }
    }
}

impl Model {
    /// Checks that the model can be drawn. `Renderer::upload` calls it.
    ///
    /// ```
    /// # use selvedge_geometry::model::*;
    /// let placed = Instance { part: 999, transform: glam::DAffine3::IDENTITY, colour: None, name: String::new() };
    /// let model = Model { instances: vec![placed], ..Model::default() };
    /// assert_eq!(model.check(), Err(ModelError::Part { instance: 0, part: 999, parts: 0 }));
    /// ```
    ///
    /// # Errors
    /// The first of [`ModelError`] that applies, and where.
    pub fn check(&self) -> Result<(), ModelError> {
        self.parts.iter().enumerate().try_for_each(|(number, part)| part.check(number))?;
        self.instances.iter().enumerate().try_for_each(|(n, placed)| placed.check(n, self.parts.len()))?;
        for (solid, s) in self.solids.iter().chain(&self.trim).enumerate() {
            for (primitive, p) in s.primitives().iter().enumerate() {
                check_colour(Some(p.colour), Coloured::Primitive { solid, primitive })?;
            }
        }
        if self.coincident.is_some_and(f64::is_nan) { Err(ModelError::Coincident) } else { Ok(()) }
    }
}

impl Instance {
    /// Checks that it can be drawn as the instance of this number, in a model of so many parts.
    ///
    /// # Errors
    /// [`ModelError::Part`], [`ModelError::Transform`], [`ModelError::Scale`], [`ModelError::Flat`],
    /// [`ModelError::Colour`].
    pub fn check(&self, instance: usize, parts: usize) -> Result<(), ModelError> {
        if self.part >= parts {
            return Err(ModelError::Part { instance, part: self.part, parts });
        }
        if !self.transform.is_finite() {
            return Err(ModelError::Transform { instance });
        }
        let m = self.transform.matrix3;
        let factor = m.x_axis.abs().max(m.y_axis.abs()).max(m.z_axis.abs()).max_element();
        if factor > 0.0 && !FACTORS.contains(&factor) {
            return Err(ModelError::Scale { instance });
        }
        let sides = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        if m.determinant().abs() <= FLAT * sides {
            return Err(ModelError::Flat { instance });
        }
        check_colour(self.colour, Coloured::Instance(instance))
    }
}

impl Part {
    fn check(&self, part: usize) -> Result<(), ModelError> {
        for (mesh, m) in self.meshes.iter().enumerate() {
            check_colour(m.colour, Coloured::Mesh { part, mesh })?;
            if m.id == 0 {
                return Err(ModelError::MeshNumber { part, mesh });
            }
        }
        let edges = self.stated_edges.len();
        for (face, f) in self.faces.iter().enumerate() {
            check_colour(f.colour, Coloured::Face { part, face })?;
            if f.id == 0 {
                return Err(ModelError::FaceNumber { part, face });
            }
            let mut named = f.loops.iter().flat_map(TrimLoop::edges).flatten();
            if let Some(e) = named.find(|e| e.edge as usize >= edges) {
                return Err(ModelError::Edge { part, face, edge: e.edge, edges });
            }
            if let Some(trim_loop) = f.loop_elsewhere() {
                return Err(ModelError::Loop { part, face, trim_loop });
            }
        }
        Ok(())
    }
}

impl Face {
    /// The first loop that does not meet the surface's domain, or reaches farther than [`BEYOND`] it.
    fn loop_elsewhere(&self) -> Option<usize> {
        let (u, v) = self.surface.domain();
        let (low, high) = (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1));
        let beyond = BEYOND * (high - low);
        self.loops.iter().position(|l| {
            let (min, max) = l.bounds();
            let meets = min.cmple(high).all() && max.cmpge(low).all();
            !meets || min.cmplt(low - beyond).any() || max.cmpgt(high + beyond).any()
        })
    }
}

fn check_colour(colour: Option<Colour>, what: Coloured) -> Result<(), ModelError> {
    let sane = colour.iter().flatten().all(|c| (0.0..=1.0).contains(c));
    if sane { Ok(()) } else { Err(ModelError::Colour { what }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csg::parse;
    use crate::model::{GREY, Mesh, Primitive, Shape, Solid, SurfaceKind};
    use crate::spline::{Bezier, Surface};
    use glam::{DAffine3, DMat3, DVec3, DVec4};

    fn square(low: f64, high: f64) -> TrimLoop {
        let corners = [(low, low), (high, low), (high, high), (low, high), (low, low)];
        let side = |ends: &[(f64, f64)]| Bezier { points: ends.iter().map(|p| DVec3::new(p.0, p.1, 1.0)).collect() };
        TrimLoop::new(corners.windows(2).map(side).collect(), DVec2::ZERO).unwrap()
    }

    /// One bilinear face over `[0, 1]²`, trimmed and placed.
    fn plate() -> Model {
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let points = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(x, y)| DVec4::new(x, y, 0.0, 1.0)).to_vec();
        let face = Face {
            id: 1,
            kind: SurfaceKind::Plane,
            surface: Surface::new((1, 1), knots.clone(), knots, points).unwrap(),
            loops: vec![square(0.1, 0.9)],
            same_sense: true,
            colour: None,
        };
        let mesh = Mesh::new(2, vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]], Vec::new()).unwrap();
        let part = Part { faces: vec![face], meshes: vec![mesh], ..Part::default() };
        let placed = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        Model { parts: vec![part], instances: vec![placed], ..Model::default() }
    }

    /// Two balls as one solid, the second with a colour of its own.
    fn balls(colour: Colour) -> Solid {
        let ball =
            |id, colour| Primitive { shape: Shape::Sphere { radius: 1.0 }, transform: DAffine3::IDENTITY, colour, id };
        Solid::new(vec![ball(3, GREY), ball(4, colour)], parse("A+B").unwrap().tree).unwrap()
    }

    /// Each fault, with the sentence that names it.
    #[test]
    fn each_fault_is_named_with_its_place() {
        assert_eq!(plate().check(), Ok(()));
        let nan = [f32::NAN, 0.0, 0.0, 1.0];
        let flat = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)));
        let scale = "the transform of instance 0 makes lengths more than 1e30 times longer or shorter";
        type Change = Box<dyn Fn(&mut Model)>;
        let faults: [(Change, &str); 17] = [
            (Box::new(|m| m.instances[0].part = 999), "instance 0 is of part 999, and there are 1"),
            (
                Box::new(|m| m.instances[0].transform.translation.x = f64::NAN),
                "the transform of instance 0 is not finite",
            ),
            (Box::new(move |m| m.instances[0].transform = flat), "the transform of instance 0 makes everything flat"),
            (
                Box::new(|m| m.instances[0].transform.matrix3 = DMat3::ZERO),
                "the transform of instance 0 makes everything flat",
            ),
            // the determinants of these overflow double precision, or are 0 there
            (Box::new(|m| m.instances[0].transform = DAffine3::from_scale(DVec3::splat(1e103))), scale),
            (Box::new(|m| m.instances[0].transform = DAffine3::from_scale(DVec3::splat(-1e-110))), scale),
            (Box::new(move |m| m.instances[0].colour = Some(nan)), "the colour of instance 0 is not between 0 and 1"),
            (Box::new(|m| m.parts[0].faces[0].id = 0), "face 0 of part 0 has number 0, which is the background's"),
            (Box::new(|m| m.parts[0].meshes[0].id = 0), "mesh 0 of part 0 has number 0, which is the background's"),
            (
                Box::new(|m| m.parts[0].faces[0].colour = Some([0.0, 1.5, 0.0, 1.0])),
                "the colour of face 0 of part 0 is not between 0 and 1",
            ),
            (
                Box::new(move |m| m.parts[0].meshes[0].colour = Some(nan)),
                "the colour of mesh 0 of part 0 is not between 0 and 1",
            ),
            (
                Box::new(move |m| m.solids = vec![balls(GREY), balls(nan)]),
                "the colour of primitive 1 of solid 1 is not between 0 and 1",
            ),
            // a volume that trims is counted behind the solids
            (
                Box::new(|m| (m.solids, m.trim) = (vec![balls(GREY)], Some(balls([0.0, 0.0, -0.5, 1.0])))),
                "the colour of primitive 1 of solid 1 is not between 0 and 1",
            ),
            (
                Box::new(|m| m.parts[0].faces[0].loops.push(square(1.5, 1.75))),
                "trim loop 1 of face 0 of part 0 lies outside of the domain of its surface",
            ),
            (
                Box::new(|m| m.parts[0].faces[0].loops = vec![square(-1.5, 0.5)]),
                "trim loop 0 of face 0 of part 0 lies outside of the domain of its surface",
            ),
            (
                Box::new(|m| {
                    let of = crate::model::EdgeRef { edge: 7, forward: true };
                    let edges = vec![Some(of); 4];
                    m.parts[0].faces[0].loops = vec![square(0.1, 0.9).with_edges(edges).unwrap()];
                }),
                "a trim curve of face 0 of part 0 is of edge 7, and the part has 0",
            ),
            (Box::new(|m| m.coincident = Some(f64::NAN)), "faces coincide within what is not a number"),
        ];
        for (change, sentence) in faults {
            let mut model = plate();
            change(&mut model);
            assert_eq!(model.check().map_err(|e| e.to_string()), Err(sentence.into()));
        }
    }

    /// Valid models from files: loops that end a little beyond the domain, mirrored, tiny and huge placements.
    #[test]
    fn what_files_hold_passes() {
        let mut model = plate();
        model.parts[0].faces[0].loops = vec![square(-1e-6, 1.0 + 1e-6)];
        for scale in [1e-6, 1e-30, 1e30] {
            model.instances[0].transform = DAffine3::from_scale(DVec3::new(-scale, scale, scale));
            assert_eq!(model.check(), Ok(()), "{scale:e}");
        }
    }
}
