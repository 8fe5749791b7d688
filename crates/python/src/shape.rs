//! Faces and edges of a model.

use numpy::ndarray::arr2;
use numpy::{PyArray, PyArray2};
use pyo3::prelude::*;
use selvedge::model::{self, Bounds, EdgeKind, Edges, SurfaceKind};
use selvedge_jobs::Loaded;
use std::sync::Arc;

/// (2, 3): smallest and largest coordinates.
pub fn corners(py: Python<'_>, bounds: Bounds) -> Bound<'_, PyArray2<f64>> {
    PyArray::from_owned_array(py, arr2(&[bounds.min.to_array(), bounds.max.to_array()]))
}

/// A face of a part. Measures are those of the part's own coordinates, millimetres.
#[pyclass(frozen, module = "selvedge")]
pub struct Face {
    pub loaded: Arc<Loaded>,
    pub part: usize,
    pub index: usize,
}

impl Face {
    fn inner(&self) -> &model::Face {
        &self.loaded.model.parts[self.part].faces[self.index]
    }
}

#[pymethods]
impl Face {
    /// Number in the file, which the image "face" holds: of STEP's #123 it is 123.
    #[getter]
    fn number(&self) -> u32 {
        self.inner().id
    }

    /// Its part, by its place in Model.parts.
    #[getter]
    fn part(&self) -> usize {
        self.part
    }

    /// What the surface is in the file: plane, cylinder, cone, sphere, torus, revolution, extrusion, offset or
    /// bspline.
    #[getter]
    fn kind(&self) -> &'static str {
        match self.inner().kind {
            SurfaceKind::Plane => "plane",
            SurfaceKind::Cylinder => "cylinder",
            SurfaceKind::Cone => "cone",
            SurfaceKind::Sphere => "sphere",
            SurfaceKind::Torus => "torus",
            SurfaceKind::Revolution => "revolution",
            SurfaceKind::Extrusion => "extrusion",
            SurfaceKind::Offset => "offset",
            SurfaceKind::BSpline => "bspline",
        }
    }

    /// Radius of a cylinder or sphere, and of the tube of a torus, millimetres; None of other faces.
    #[getter]
    fn radius(&self) -> Option<f64> {
        self.inner().radius()
    }

    /// Area within the trim loops, square millimetres: integrated when it is asked for, to about 1e-9 of itself.
    #[getter]
    fn area(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.inner().area())
    }

    /// Trim loops; 0 for a face that is its whole surface.
    #[getter]
    fn loops(&self) -> usize {
        self.inner().loops.len()
    }

    /// Degrees of the surface in u and v.
    #[getter]
    fn degrees(&self) -> (usize, usize) {
        self.inner().surface.degrees()
    }

    /// ((u0, u1), (v0, v1)): where the image "uv" of this face lies.
    #[getter]
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        self.inner().surface.domain()
    }

    /// Red, green, blue, opacity in linear light, if the face has a colour of its own.
    #[getter]
    fn colour(&self) -> Option<[f32; 4]> {
        self.inner().colour
    }

    /// float64 (2, 3): smallest and largest coordinates, in those of the part, millimetres.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        corners(py, self.inner().bounds())
    }

    fn __repr__(&self) -> String {
        format!("<selvedge.Face #{} {}>", self.inner().id, self.kind())
    }
}

/// Where faces of a part meet or end, or facets crease.
#[pyclass(frozen, module = "selvedge")]
pub struct Edge {
    pub loaded: Arc<Loaded>,
    pub found: Arc<Vec<Edges>>,
    pub part: usize,
    pub index: usize,
    pub number: usize,
}

/// An edge of faces, or a side of triangles.
enum Kept<'a> {
    Faces(&'a model::Edge),
    Mesh(&'a model::MeshEdge),
}

impl Edge {
    fn inner(&self) -> Kept<'_> {
        let edges = &self.found[self.part];
        match edges.edges.get(self.index) {
            Some(edge) => Kept::Faces(edge),
            None => Kept::Mesh(&edges.of_meshes[self.index - edges.edges.len()]),
        }
    }
}

#[pymethods]
impl Edge {
    /// Its place in Model.edges, plus 1: what the image "edge" holds.
    #[getter]
    fn number(&self) -> usize {
        self.number
    }

    /// Its part, by its place in Model.parts.
    #[getter]
    fn part(&self) -> usize {
        self.part
    }

    /// sharp, smooth, seam (a closed face meets itself) or border (one face ends).
    #[getter]
    fn kind(&self) -> &'static str {
        let kind = match self.inner() {
            Kept::Faces(edge) => edge.kind,
            Kept::Mesh(edge) => edge.kind,
        };
        match kind {
            EdgeKind::Sharp => "sharp",
            EdgeKind::Smooth => "smooth",
            EdgeKind::Seam => "seam",
            EdgeKind::Border => "border",
        }
    }

    /// Length of the curve, millimetres, in the part's coordinates.
    #[getter]
    fn length(&self) -> f64 {
        match self.inner() {
            Kept::Faces(edge) => edge.length(),
            Kept::Mesh(edge) => edge.ends[0].distance(edge.ends[1]),
        }
    }

    /// Numbers of the faces that end here, as Face.number; those of meshes for sides of triangles.
    #[getter]
    fn faces(&self) -> Vec<u32> {
        let part = &self.loaded.model.parts[self.part];
        match self.inner() {
            Kept::Faces(edge) => edge.uses.iter().map(|used| part.faces[used.face].id).collect(),
            Kept::Mesh(edge) => edge.triangles.iter().map(|(mesh, _)| part.meshes[*mesh].id).collect(),
        }
    }

    /// Number of the edge in the file, if it has one.
    #[getter]
    fn entity(&self) -> Option<u32> {
        match self.inner() {
            Kept::Faces(edge) => edge.source.map(|source| source.entity),
            Kept::Mesh(_) => None,
        }
    }

    /// float64 (2, 3): where it begins and ends, in the part's coordinates, millimetres.
    #[getter]
    fn ends<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        let vertices = &self.found[self.part].vertices;
        let ends = match self.inner() {
            Kept::Faces(edge) => edge.ends.map(|vertex| vertices[vertex]),
            Kept::Mesh(edge) => edge.ends,
        };
        PyArray::from_owned_array(py, arr2(&ends.map(|p| p.to_array())))
    }

    fn __repr__(&self) -> String {
        format!("<selvedge.Edge {} {}>", self.number, self.kind())
    }
}
