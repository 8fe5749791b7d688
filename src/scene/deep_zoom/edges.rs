//! Edges of a cut: halved in `f64` until each piece is no larger than a window, and stored relative to its own centre.
//!
//! ```text
//!   edge of the whole model ─▶ outside the view? left out ─▶ wider than a window? halved ─▶ a piece with its own placement
//! ```
//! Edges refer to faces by their numbers in the whole model, so all windows of a face count as that face. Folds beside
//! a piece of a smooth edge or a seam are looked for from the windows that its middle lies in, as `scene/fold_seeds.rs`
//! has it.

use super::{Cut, MOST_DEPTH, Sight, WINDOW_PX};
use crate::abi;
use crate::model::{Bounds, Edges, Model};
use crate::picture::{EdgeSettings, LineStyle};
use crate::scene::SceneData;
use crate::scene::edges::{EdgeData, UndrawnEdges, edges_of, goes_on};
use crate::scene::fold_seeds::{ShownFace, seeds_of_cut};
use crate::spline::{Bezier, Control};
use glam::{DAffine3, DVec4};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// The edges of a model's parts, found at the first request.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct KnownEdges(Arc<OnceLock<Result<Vec<Edges>, UndrawnEdges>>>);

impl PartialEq for KnownEdges {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl KnownEdges {
    /// Edges that are known already, one entry a part.
    pub(in crate::scene) fn found(edges: Vec<Edges>) -> Self {
        Self(Arc::new(OnceLock::from(Ok(edges))))
    }

    /// The edges of each part; `None` if they were not found.
    pub(in crate::scene) fn get(&self) -> Option<&[Edges]> {
        self.0.get()?.as_deref().ok()
    }

    fn of(&self, model: &Model) -> Result<&[Edges], UndrawnEdges> {
        self.0.get_or_init(|| edges_of(model, &|_| ())).as_deref().map_err(Clone::clone)
    }
}

/// How many faces the folds beside a piece are looked for on, and their texels.
type Seeds = (u32, Vec<[f32; 4]>);

/// The sums of all earlier numbers, starting at `first`.
fn sums(numbers: impl Iterator<Item = usize>, first: usize) -> Vec<usize> {
    let before = |sum: &mut usize, n: usize| Some(std::mem::replace(sum, *sum + n));
    numbers.scan(first, before).collect()
}

/// The pieces of a curve in the view, none larger than a window.
fn halve(piece: &Bezier<DVec4>, sight: &Sight, depth: u32, pieces: &mut Vec<Bezier<DVec4>>) {
    let bounds = piece.points.iter().fold(Bounds::EMPTY, |all, p| all.with(p.point()));
    let Some(pixels) = sight.of_box((bounds.min, bounds.max)) else { return };
    if pixels * bounds.diagonal() <= WINDOW_PX || depth == 0 {
        return pieces.push(piece.clone());
    }
    let (a, b) = piece.split(0.5);
    halve(&a, sight, depth - 1, pieces);
    halve(&b, sight, depth - 1, pieces);
}

impl Cut {
    /// Part and instance of the whole model, from 1 on, to which an instance of the cut belongs.
    pub(in crate::scene) fn source_of(&self, instance: usize, whole: &Model) -> [u32; 2] {
        let instance = self.sources[instance].instance;
        [whole.instances[instance].part as u32 + 1, instance as u32 + 1]
    }

    /// Tells the faces of the cut at which of their sides the surface goes on.
    pub(in crate::scene) fn mark_ends(&self, data: &mut SceneData) {
        for (source, &(_, first)) in self.sources.iter().zip(&data.parts) {
            for (face, sides) in data.faces[first..].iter_mut().zip(&source.goes_on) {
                face.flags |= sides << abi::FACE_GOES_ON;
            }
        }
    }
}

impl SceneData {
    /// Finds the edges of the model from which the cut was made.
    pub(crate) fn find_edges_of_cut(
        &mut self,
        whole: &Model,
        cut: &Cut,
        settings: EdgeSettings,
    ) -> Result<(), UndrawnEdges> {
        let edges = cut.edges.of(whole)?;
        let first_faces = sums(whole.parts.iter().map(|part| part.faces.len()), 0);
        let numbers = sums(edges.iter().map(|e| e.edges.len() + e.of_meshes.len()), 1);
        let mut data = EdgeData::new(settings, self.faces.len(), cut.edges.clone());
        // for each visible instance: the part of the cut with its meshes
        let mut seen: BTreeMap<usize, Option<usize>> = BTreeMap::new();
        // of each face of an instance of the whole model
        let mut windows: BTreeMap<(usize, usize), Vec<ShownFace>> = BTreeMap::new();
        let mut placed = vec![None; self.faces.len()];
        self.face_instances.iter().for_each(|fi| placed[fi.face as usize] = Some(fi.instance));
        for (nth, (source, &(_, first))) in cut.sources.iter().zip(&self.parts).enumerate() {
            let part = whole.instances[source.instance].part;
            for (key, face) in data.face_keys[first..].iter_mut().zip(&source.faces) {
                *key = (first_faces[part] + face) as u32;
            }
            let faces = source.faces.iter().zip(&cut.model.parts[nth].faces);
            for (number, (face, shown)) in (first..).zip(faces) {
                let shown = ShownFace { number, domain: shown.surface.domain(), instance: placed[number] };
                windows.entry((source.instance, *face)).or_default().push(shown);
            }
            let meshes = seen.entry(source.instance).or_default();
            if !cut.model.parts[nth].meshes.is_empty() {
                *meshes = Some(nth);
            }
        }
        for (nth, meshes) in seen {
            let instance = &whole.instances[nth];
            let sight = Sight::new(&cut.camera, instance);
            let (first_face, first_number) = (first_faces[instance.part], numbers[instance.part] as u32);
            let Edges { edges, of_meshes, reach, .. } = &edges[instance.part];
            let key = nth as u32 + 1;
            let mut push = |number, kind, (own, off): (Vec<u32>, f64), pieces: Vec<Bezier<DVec4>>, seeds: &[Seeds]| {
                let style = settings.style(kind);
                let mut line = None;
                for (nth, piece) in pieces.iter().enumerate() {
                    let (count, texels) =
                        seeds.get(nth).map_or((0, &[] as &[_]), |(count, texels)| (*count, texels.as_slice()));
                    if style.is_none() && count == 0 {
                        continue;
                    }
                    let flags = count << abi::EDGE_SEEDS | if style.is_none() { abi::EDGE_UNDRAWN } else { 0 };
                    // the pieces of a line have as many seeds
                    if line.replace(flags) != Some(flags) {
                        data.push_line(number, style.unwrap_or(LineStyle::Full), own.clone(), off, flags);
                    }
                    let bounds = piece.points.iter().fold(Bounds::EMPTY, |all, p| all.with(p.point()));
                    let origin = bounds.centre();
                    self.placements.push(instance.transform * DAffine3::from_translation(origin));
                    let placement = self.placements.len() as u32 - 1;
                    let piece = data.push_piece(&piece.points, origin);
                    data.points.extend(texels);
                    data.piece_instances.push(abi::PieceInstance { piece, placement, instance: key });
                }
            };
            let shown = |face: usize| windows.get(&(nth, face)).map_or(&[] as &[_], Vec::as_slice);
            for (edge, number) in edges.iter().zip(first_number..) {
                let mut pieces = Vec::new();
                edge.curve.iter().for_each(|span| halve(&span.piece, &sight, MOST_DEPTH, &mut pieces));
                let may_fold = settings.silhouettes && goes_on(edge) && !pieces.is_empty();
                let of = (edge, &whole.parts[instance.part], *reach);
                let arrays = (self.faces.as_slice(), self.patches.as_slice());
                let seeds = if may_fold { seeds_of_cut(of, &pieces, shown, arrays) } else { Vec::new() };
                let own = edge.uses.iter().map(|u| (first_face + u.face) as u32).collect();
                push(number, edge.kind, (own, edge.deviation), pieces, &seeds);
            }
            let Some(first_triangles) = meshes.map(|part| &self.meshes.first_triangles[part]) else { continue };
            for (edge, number) in of_meshes.iter().zip(first_number + edges.len() as u32..) {
                let mut pieces = Vec::new();
                let points = edge.ends.map(|p| p.extend(1.0)).to_vec();
                halve(&Bezier { points }, &sight, MOST_DEPTH, &mut pieces);
                let own =
                    |&(mesh, triangle): &(usize, usize)| abi::OWN_TRIANGLE | (first_triangles[mesh] + triangle as u32);
                push(number, edge.kind, (edge.triangles.iter().map(own).collect(), 0.0), pieces, &[]);
            }
        }
        self.edges = Some(data);
        Ok(())
    }
}
