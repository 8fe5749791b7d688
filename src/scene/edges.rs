//! Lines along edges as arrays. Control points are relative to the part's centre, like those of patches.
//!
//! ```text
//!   Part::edges ─▶ EdgeLine, one an edge that is drawn ─▶ own faces: numbers of the scene's, or triangles
//!              └─▶ EdgePiece, one a rational Bézier piece ─▶ control points
//!   Part::smooth_sides ─▶ one EdgeLine, an EdgePiece a side: drawn where the mesh turns away there
//!   placed parts ─▶ PieceInstance: a piece, its view, its instance
//! ```
//!
//! A pixel belongs to an edge's own face if it has the face's key, here its number in the scene, and the same instance
//! of the model.

use super::data::SceneData;
use super::deep_zoom::KnownEdges;
use super::fold_seeds::{PartFaces, seeds};
use super::parts::Told;
use crate::abi;
use crate::model::{Edge, EdgeKind, EdgeLimits, Edges, Model, Part, SmoothSide};
use crate::picture::{EdgeChoice, EdgeSettings, LineStyle};
use glam::{DAffine3, DVec3, DVec4};
use rayon::prelude::*;

/// The arrays from which lines are drawn.
#[derive(Clone, Debug)]
pub(crate) struct EdgeData {
    pub settings: EdgeSettings,
    pub pieces: Vec<abi::EdgePiece>,
    /// Homogeneous control points.
    pub points: Vec<[f32; 4]>,
    pub lines: Vec<abi::EdgeLine>,
    pub own_faces: Vec<u32>,
    pub piece_instances: Vec<abi::PieceInstance>,
    /// A key for each face of the scene.
    pub face_keys: Vec<u32>,
    /// The edges of each part of the model.
    pub(super) found: KnownEdges,
}

/// The places of a model's parts, instances and meshes in the scene's arrays.
pub(crate) struct Placing<'a> {
    pub model: &'a Model,
    /// The origin of each part, and the scene's number of its first face.
    pub parts: &'a [(DVec3, usize)],
    /// The scene's instance for each instance of the model; `None` if it is not drawn as faces.
    pub placed: &'a [Option<u32>],
    /// The first triangle, in the scene, of each mesh of each part.
    pub first_triangles: &'a [Vec<u32>],
    /// The scene's.
    pub faces: &'a [abi::Face],
    pub patches: &'a [abi::Patch],
}

impl SceneData {
    /// Finds the edges of the scene's model.
    pub(crate) fn find_edges(
        &mut self,
        model: &Model,
        settings: EdgeSettings,
        told: Told<'_>,
    ) -> Result<(), UndrawnEdges> {
        let edges = KnownEdges::found(edges_of(model, told)?);
        let mut placed = vec![None; model.instances.len()];
        for (nth, [_, instance]) in (0..).zip(&self.sources).filter(|(_, source)| source[1] > 0) {
            placed[*instance as usize - 1] = Some(nth);
        }
        let of = Placing {
            model,
            parts: &self.parts,
            placed: &placed,
            first_triangles: &self.meshes.first_triangles,
            faces: &self.faces,
            patches: &self.patches,
        };
        self.edges = Some(EdgeData::of(settings, &of, &edges, &mut self.placements));
        Ok(())
    }

    /// Some line is drawn along an edge or a silhouette, or on a Boolean solid.
    pub(crate) fn has_lines(&self) -> bool {
        let has_solids = self.solids.kinds().is_some();
        let has = |edges: &EdgeData| {
            let EdgeSettings { which, silhouettes, .. } = edges.settings;
            !edges.piece_instances.is_empty()
                || silhouettes && (self.has_patches || has_solids)
                || which != EdgeChoice::None && has_solids
        };
        self.edges.as_ref().is_some_and(has)
    }
}

/// The pieces of one part.
type Drawn = std::ops::Range<usize>;

impl EdgeData {
    /// No lines, in a scene of `faces` faces, whose keys are their numbers.
    pub(super) fn new(settings: EdgeSettings, faces: usize, found: KnownEdges) -> Self {
        Self {
            settings,
            pieces: Vec::new(),
            points: Vec::new(),
            lines: Vec::new(),
            own_faces: Vec::new(),
            piece_instances: Vec::new(),
            face_keys: (0..faces as u32).collect(),
            found,
        }
    }

    /// How many placed pieces are curved.
    pub(crate) fn curved_piece_instances(&self) -> usize {
        self.piece_instances.iter().filter(|placed| self.pieces[placed.piece as usize].degree > 1).count()
    }

    /// The lines of all placed parts. Instances that the scene does not draw as faces get placements of their own, at
    /// the end of `placements`. `found` has the edges of each part of the model.
    pub(super) fn of(
        settings: EdgeSettings,
        of: &Placing<'_>,
        found: &KnownEdges,
        placements: &mut Vec<DAffine3>,
    ) -> Self {
        let edges = found.get().unwrap_or_default();
        let mut data = Self::new(settings, of.faces.len(), found.clone());
        let mut number = 1;
        let drawn: Vec<Drawn> = (0..of.model.parts.len())
            .map(|part| {
                let first = data.pieces.len();
                data.push_part(of, part, &edges[part], number);
                number += (edges[part].edges.len() + edges[part].of_meshes.len()) as u32;
                first..data.pieces.len()
            })
            .collect();
        for ((nth, instance), placed) in of.model.instances.iter().enumerate().zip(of.placed) {
            let key = nth as u32 + 1;
            let placement = placed.unwrap_or_else(|| {
                placements.push(instance.transform * DAffine3::from_translation(of.parts[instance.part].0));
                placements.len() as u32 - 1
            });
            let pieces = drawn[instance.part].clone();
            data.piece_instances.extend(pieces.map(|piece| abi::PieceInstance {
                piece: piece as u32,
                placement,
                instance: key,
            }));
        }
        data
    }

    /// Adds the edges of a part; the first has number `number`.
    fn push_part(&mut self, of: &Placing<'_>, part: usize, edges: &Edges, number: u32) {
        let (origin, first_face) = of.parts[part];
        let beside = PartFaces { part: &of.model.parts[part], first_face, faces: of.faces, patches: of.patches };
        for (edge, number) in edges.edges.iter().zip(number..) {
            let style = self.settings.style(edge.kind);
            let may_fold = self.settings.silhouettes && goes_on(edge);
            let (count, texels) = if may_fold { seeds(edge, edges.reach, &beside) } else { Default::default() };
            if style.is_none() && count == 0 {
                continue;
            }
            let own = edge.uses.iter().map(|u| (first_face + u.face) as u32).collect();
            let flags = count << abi::EDGE_SEEDS | if style.is_none() { abi::EDGE_UNDRAWN } else { 0 };
            self.push_line(number, style.unwrap_or(LineStyle::Full), own, edge.deviation, flags);
            for (nth, span) in edge.curve.iter().enumerate() {
                self.push_piece(&span.piece.points, origin);
                self.points.extend(texels.get(nth).into_iter().flatten());
            }
        }
        let first = number + edges.edges.len() as u32;
        for (edge, number) in edges.of_meshes.iter().zip(first..) {
            let Some(style) = self.settings.style(edge.kind) else { continue };
            let triangle =
                |&(mesh, nth): &(usize, usize)| abi::OWN_TRIANGLE | (of.first_triangles[part][mesh] + nth as u32);
            self.push_line(number, style, edge.triangles.iter().map(triangle).collect(), 0.0, 0);
            self.push_piece(&edge.ends.map(|p| p.extend(1.0)), origin);
        }
        if self.settings.silhouettes {
            self.push_outlines(&of.model.parts[part].smooth_sides(&EdgeLimits::default()), origin);
        }
    }

    /// Adds sides of triangles that are outlines in some views: pieces of one line.
    fn push_outlines(&mut self, sides: &[SmoothSide], origin: DVec3) {
        if sides.is_empty() {
            return;
        }
        self.push_line(abi::FOLD_NUMBER, LineStyle::Full, Vec::new(), 0.0, abi::EDGE_TURNS);
        for side in sides {
            self.push_piece(&side.ends.map(|p| p.extend(1.0)), origin);
            self.points.extend(side.beside.map(|p| (p - origin).extend(1.0).as_vec4().to_array()));
        }
    }

    /// Adds an edge with its own faces, as keys or triangles. It lies at most `off` from these faces, in units of the
    /// part. `flags`: bits of its style beside the width, `EDGE_*`.
    pub(super) fn push_line(&mut self, number: u32, style: LineStyle, own: Vec<u32>, off: f64, flags: u32) {
        let style = match style {
            LineStyle::Full => abi::EDGE_FULL,
            LineStyle::Thin => abi::EDGE_THIN,
            LineStyle::Bold => abi::EDGE_BOLD,
        };
        let first_own = self.own_faces.len() as u32;
        self.lines.push(abi::EdgeLine {
            number,
            style: style | flags,
            first_own,
            own_count: own.len() as u32,
            off: off as f32,
        });
        self.own_faces.extend(own);
    }

    /// Adds a piece to the last line; returns the piece's number.
    pub(super) fn push_piece(&mut self, points: &[DVec4], origin: DVec3) -> u32 {
        let (first, edge) = (self.points.len() as u32, self.lines.len() as u32 - 1);
        self.pieces.push(abi::EdgePiece { first, degree: points.len() as u32 - 1, edge });
        self.points.extend(points.iter().map(|p| (p.truncate() - origin * p.w).extend(p.w).as_vec4().to_array()));
        self.pieces.len() as u32 - 1
    }
}

/// A curved surface goes on across the edge, and its fold may lie so close to the edge that no pixel's centre sees the
/// face between them. Across the seam of a face without trims `edge_fold` itself goes on.
pub(super) fn goes_on(edge: &Edge) -> bool {
    match edge.kind {
        EdgeKind::Smooth => true,
        EdgeKind::Seam => edge.uses.iter().any(|used| used.trim_loop.is_some()),
        EdgeKind::Sharp | EdgeKind::Border => false,
    }
}

/// A part whose edges are not curves.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("part {part}: {source}")]
pub struct UndrawnEdges {
    /// Index into the model's parts.
    pub part: usize,
    /// What is wrong with it.
    pub source: crate::edges::EdgeError,
}

/// The edges of all parts. Calls `told` before each part.
pub(super) fn edges_of(model: &Model, told: Told<'_>) -> Result<Vec<Edges>, UndrawnEdges> {
    let edges = |(part, p): (usize, &Part)| {
        told(0);
        p.edges().map_err(|source| UndrawnEdges { part, source })
    };
    model.parts.par_iter().enumerate().map(edges).collect()
}
