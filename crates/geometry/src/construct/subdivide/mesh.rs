//! Control meshes: polygons that share vertices, checked, cut at their creases, and walked from vertex to vertex.
//!
//! ```text
//!            ╲ face i+1 ╱              half-edge h runs from its vertex to the next one of its face;
//!        ray i+1 ╲     ╱               its twin runs back in the face across
//!                 ╲   ╱
//!   prev(h) ▶      v ──h──▶ ray i      the fan of v: half-edges out of it, counter-clockwise
//! ```

use super::super::ConstructError;
use glam::DVec3;
use std::collections::HashMap;

/// No half-edge: a border or a crease.
const NONE: u32 = u32::MAX;
/// Corners of all polygons, at most.
const MOST_CORNERS: usize = 1 << 26;

/// Polygons over shared vertices, counter-clockwise from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlMesh {
    /// One point a vertex.
    pub positions: Vec<DVec3>,
    /// Vertices of each polygon.
    pub faces: Vec<Vec<u32>>,
    /// Edges that stay sharp, as pairs of vertices. A crease may branch, close, or end at a border.
    pub creases: Vec<[u32; 2]>,
}

/// The same with its neighbourhoods. Both sides of a crease are borders, each with vertices of its own.
pub(super) struct Topology {
    pub positions: Vec<DVec3>,
    /// Vertices that stay where they are: corners.
    pub sharp: Vec<bool>,
    /// Of each half-edge, the vertex that it leaves.
    vertex: Vec<u32>,
    /// Of each half-edge, its face.
    face: Vec<u32>,
    twin: Vec<u32>,
    /// First half-edge of each face, and the end of the last.
    starts: Vec<u32>,
    /// Of each vertex, the first half-edge of its fan; `NONE` for one that no face uses.
    first: Vec<u32>,
}

/// The half-edges out of a vertex, counter-clockwise.
pub(super) struct Fan {
    pub out: Vec<usize>,
    /// The last face meets the first one.
    pub closed: bool,
}

impl Fan {
    /// Whether the vertex has as many faces as a regular one, inside or on a border; a corner has one.
    pub fn is_regular(&self, sharp: bool, [inside, border]: [usize; 2]) -> bool {
        let regular = match (self.closed, sharp) {
            (true, _) => inside,
            (false, false) => border,
            (false, true) => 1,
        };
        self.out.len() == regular
    }
}

impl Topology {
    /// Checks the mesh and cuts it at its creases; true when it has no border.
    pub fn new(mesh: &ControlMesh) -> Result<(Self, bool), ConstructError> {
        let count = mesh.positions.len();
        if let Some(vertex) = mesh.positions.iter().position(|p| !p.is_finite()) {
            return Err(ConstructError::Vertex { vertex, what: "is not a finite point" });
        }
        if mesh.faces.is_empty() {
            return Err(ConstructError::TooFew { what: "faces of a control mesh", got: 0, needed: 1 });
        }
        let corners: usize = mesh.faces.iter().map(Vec::len).sum();
        if corners > MOST_CORNERS {
            return Err(ConstructError::TooMany { what: "corners of faces", got: corners, most: MOST_CORNERS });
        }
        for (face, f) in mesh.faces.iter().enumerate() {
            let what = match () {
                () if f.len() < 3 => "has fewer than 3 corners",
                () if f.iter().any(|v| *v as usize >= count) => "names a vertex that is not there",
                () if {
                    let mut s = f.clone();
                    s.sort_unstable();
                    s.windows(2).any(|w| w[0] == w[1])
                } =>
                {
                    "names a vertex twice"
                }
                () => continue,
            };
            return Err(ConstructError::Polygon { face, what });
        }
        let mut all = Self::unlinked(mesh.positions.clone(), vec![false; count], &mesh.faces);
        all.link()?;
        let closed = all.twin.iter().all(|t| *t != NONE);
        all.fans()?;
        if !mesh.creases.is_empty() {
            all.cut(&mesh.creases)?;
        }
        // a border's vertex with one face is a corner, unless it lies on a crease
        let creased: std::collections::HashSet<u32> = mesh.creases.iter().flatten().copied().collect();
        for v in 0..count {
            if all.first[v] != NONE && !creased.contains(&(v as u32)) {
                let fan = all.fan(v);
                all.sharp[v] = !fan.closed && fan.out.len() == 1;
            }
        }
        Ok((all, closed))
    }

    /// The topology of a refinement, which is valid if the mesh was.
    pub fn refined(positions: Vec<DVec3>, sharp: Vec<bool>, faces: &[Vec<u32>]) -> Result<Self, ConstructError> {
        let mut all = Self::unlinked(positions, sharp, faces);
        all.link()?;
        all.fans()?;
        Ok(all)
    }

    fn unlinked(positions: Vec<DVec3>, sharp: Vec<bool>, faces: &[Vec<u32>]) -> Self {
        let vertex: Vec<u32> = faces.iter().flatten().copied().collect();
        let face = faces.iter().enumerate().flat_map(|(f, v)| std::iter::repeat_n(f as u32, v.len())).collect();
        let mut starts = vec![0];
        for f in faces {
            starts.push(starts[starts.len() - 1] + f.len() as u32);
        }
        let (twin, first) = (vec![NONE; vertex.len()], vec![NONE; positions.len()]);
        Self { positions, sharp, vertex, face, twin, starts, first }
    }

    /// Twins by their ends.
    fn link(&mut self) -> Result<(), ConstructError> {
        let mut by_ends: HashMap<(u32, u32), u32> = HashMap::with_capacity(self.vertex.len());
        for h in 0..self.vertex.len() {
            let ends = (self.vertex[h], self.vertex[self.next(h)]);
            if by_ends.insert(ends, h as u32).is_some() {
                let what = "has two faces that run along it the same way: no manifold, or a face is turned over";
                return Err(ConstructError::Edge { first: ends.0, second: ends.1, what });
            }
        }
        for h in 0..self.vertex.len() {
            let ends = (self.vertex[self.next(h)], self.vertex[h]);
            self.twin[h] = by_ends.get(&ends).copied().unwrap_or(NONE);
        }
        Ok(())
    }

    /// The first half-edge of each vertex; a vertex has one fan.
    fn fans(&mut self) -> Result<(), ConstructError> {
        let mut degree = vec![0usize; self.positions.len()];
        for v in &self.vertex {
            degree[*v as usize] += 1;
        }
        for h in 0..self.vertex.len() {
            let v = self.vertex[h] as usize;
            // a border begins the fan; a closed one begins anywhere
            if self.first[v] == NONE || self.twin[h] == NONE {
                self.first[v] = h as u32;
            }
        }
        let whole = |v: usize| self.first[v] == NONE || self.fan(v).out.len() == degree[v];
        if let Some(vertex) = (0..degree.len()).find(|v| !whole(*v)) {
            return Err(ConstructError::Vertex { vertex, what: "joins faces that share no edge there" });
        }
        Ok(())
    }

    /// Makes borders of creases; vertices on them get one copy a fan.
    fn cut(&mut self, creases: &[[u32; 2]]) -> Result<(), ConstructError> {
        let mut ends: HashMap<(u32, u32), u32> = HashMap::new();
        for h in 0..self.vertex.len() {
            ends.insert((self.vertex[h], self.vertex[self.next(h)]), h as u32);
        }
        let mut sharp_edges: HashMap<u32, u32> = HashMap::new();
        for &[a, b] in creases {
            let Some(&h) = ends.get(&(a, b)).or_else(|| ends.get(&(b, a))) else {
                return Err(ConstructError::Edge { first: a, second: b, what: "is a crease, but of no face" });
            };
            let twin = self.twin[h as usize];
            if twin == NONE {
                continue; // a border, or named twice
            }
            self.twin[h as usize] = NONE;
            self.twin[twin as usize] = NONE;
            *sharp_edges.entry(a).or_default() += 1;
            *sharp_edges.entry(b).or_default() += 1;
        }
        let mut borders: HashMap<u32, Vec<usize>> = HashMap::new();
        for h in (0..self.vertex.len()).filter(|h| self.twin[*h] == NONE) {
            borders.entry(self.vertex[h]).or_default().push(h);
        }
        let mut on: Vec<u32> = sharp_edges.keys().copied().collect();
        on.sort_unstable();
        for v in on {
            let (fans, creases) = (&borders[&v], sharp_edges[&v]);
            // as many fans as creases inside, one more at a border
            let at_border = fans.len() as u32 > creases;
            if creases == 1 && !at_border {
                return Err(ConstructError::Vertex { vertex: v as usize, what: "ends a crease inside the mesh" });
            }
            let corner = at_border || creases > 2;
            for (k, &h) in fans.clone().iter().enumerate() {
                let own = if k == 0 { v } else { self.positions.len() as u32 };
                if k > 0 {
                    self.positions.push(self.positions[v as usize]);
                    self.sharp.push(corner);
                    self.first.push(NONE);
                }
                self.sharp[own as usize] = corner;
                self.first[own as usize] = h as u32;
                for out in self.fan(own as usize).out {
                    self.vertex[out] = own;
                }
            }
        }
        Ok(())
    }

    pub fn face_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Half-edges of a face.
    pub fn corners(&self, face: usize) -> std::ops::Range<usize> {
        self.starts[face] as usize..self.starts[face + 1] as usize
    }

    pub fn half_edges(&self) -> usize {
        self.vertex.len()
    }

    pub fn face_of(&self, h: usize) -> usize {
        self.face[h] as usize
    }

    pub fn origin(&self, h: usize) -> usize {
        self.vertex[h] as usize
    }

    /// The point that a half-edge leaves.
    pub fn at(&self, h: usize) -> DVec3 {
        self.positions[self.origin(h)]
    }

    pub fn next(&self, h: usize) -> usize {
        let f = self.face[h] as usize;
        if h + 1 == self.starts[f + 1] as usize { self.starts[f] as usize } else { h + 1 }
    }

    pub fn prev(&self, h: usize) -> usize {
        let f = self.face[h] as usize;
        if h == self.starts[f] as usize { self.starts[f + 1] as usize - 1 } else { h - 1 }
    }

    pub fn twin(&self, h: usize) -> Option<usize> {
        Some(self.twin[h]).filter(|t| *t != NONE).map(|t| t as usize)
    }

    /// The half-edge out of the same vertex in the next face, counter-clockwise.
    pub fn turned(&self, h: usize) -> Option<usize> {
        self.twin(self.prev(h))
    }

    /// A vertex that a face uses.
    pub fn used(&self, v: usize) -> bool {
        self.first[v] != NONE
    }

    pub fn fan(&self, v: usize) -> Fan {
        let first = self.first[v] as usize;
        let mut out = vec![first];
        let mut at = first;
        loop {
            match self.turned(at) {
                None => return Fan { out, closed: false },
                Some(h) if h == first => return Fan { out, closed: true },
                Some(h) => {
                    out.push(h);
                    at = h;
                }
            }
        }
    }

    /// Of a fan's vertex: the neighbours along its rays, one more than faces where it is open.
    pub fn rays(&self, fan: &Fan) -> Vec<DVec3> {
        let mut rays: Vec<DVec3> = fan.out.iter().map(|h| self.at(self.next(*h))).collect();
        if !fan.closed {
            rays.push(self.at(self.prev(fan.out[fan.out.len() - 1])));
        }
        rays
    }

    /// The limit of a border's vertex; `None` inside the mesh.
    ///
    /// Both sides of a crease find the same numbers: sums are of two terms, in either order.
    pub fn border_point(&self, v: usize) -> Option<DVec3> {
        let fan = self.fan(v);
        let (c, rays) = (self.positions[v], self.rays(&fan));
        let point = if self.sharp[v] { c } else { (c * 4.0 + (rays[0] + rays[rays.len() - 1])) / 6.0 };
        (!fan.closed).then_some(point)
    }

    /// The border's cubic along a half-edge; `None` inside the mesh.
    pub fn border(&self, h: usize) -> Option<[DVec3; 4]> {
        if self.twin(h).is_some() {
            return None;
        }
        let (a, b) = (self.at(h), self.at(self.next(h)));
        let ends = [self.border_point(self.origin(h))?, self.border_point(self.origin(self.next(h)))?];
        Some([ends[0], (a * 2.0 + b) / 3.0, (a + b * 2.0) / 3.0, ends[1]])
    }

    /// A number for each edge, the same for both half-edges, and how many there are.
    pub fn edges(&self) -> (Vec<u32>, u32) {
        let mut number = vec![NONE; self.vertex.len()];
        let mut count = 0;
        for h in 0..self.vertex.len() {
            if number[h] == NONE {
                number[h] = count;
                if let Some(t) = self.twin(h) {
                    number[t] = count;
                }
                count += 1;
            }
        }
        (number, count)
    }
}
