//! Way `blister`: peels layer after layer until every pixel is decided.
//!
//! ```text
//!   if the camera may be inside:         layer = the near plane ─test─▶ pixels outside are found
//!                                        peel exits, test, …            the others where they get outside
//!                                           │ found
//!                                           ▼
//!   layer before = found, or the near plane; peel entries, test, lock, …      ──▶ found ──▶ visibility, depth
//! ```
//!
//! Records as many layers as the previous frame needed, and one that must find nothing. If the frame needs more, it is
//! recorded again.

use super::SolidParts;
use super::buffers::LayerImages;
use crate::frame::Frame;
use crate::frame::solids::blister::{Bindings, Blister, Layer, MeshBindings, Peel};
use crate::gpu::{Access, Attachment, Commands, Image, ImageAccess, Load, barrier};
use crate::scene::{self, Asked};
use std::ops::Range;

/// The inputs of a layer.
struct Parts<'a> {
    pass: &'a Blister,
    scene: &'a scene::Blister,
    bindings: Bindings<'a>,
    images: &'a LayerImages,
    /// Instance and corners of each mesh, by operand.
    boundary_operands: Vec<Vec<(u32, Range<u32>)>>,
}

/// The kind of face that is searched.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Search {
    /// The exit of rays that start inside the solid.
    Outside,
    /// The entry of rays into the solid.
    Inside,
}

const DRAWN: Access = Access::COLOUR_WRITE;
const READ: Access = Access::FRAGMENT_READ;
const NOTHING: Load = Load::ColourU32([0; 4]);

impl SolidParts<'_> {
    /// Draws the faces of the solids into the visibility image and depth.
    pub(super) fn peel(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (pass, images): (&Blister, &LayerImages),
        (colour, depth): (Attachment<'_>, Attachment<'_>),
    ) {
        let Some(parts) = self.peeled(frame, pass, images) else { return };
        let tested = |image| (image, Access::DEPTH_WRITE.discarded(), Access::DEPTH_WRITE);
        barrier::images(cmd, &[tested(&images.depth), tested(&images.stencil)]);
        cmd.after(Access::COMPUTE_WRITE, Access::FRAGMENT_WRITE);
        let near = &images.layers[1];
        clear(cmd, near, Load::ColourU32([1, frame.near.depth.to_bits(), 0, 0]));
        clear(cmd, &images.found, NOTHING);
        if frame.near.may_cut {
            parts.ask(cmd, near, Search::Outside, 0);
            parts.search(frame, cmd, near, Search::Outside);
            parts.search(frame, cmd, &images.found, Search::Inside);
        } else {
            parts.search(frame, cmd, near, Search::Inside);
        }
        parts.pass.show(cmd, &parts.bindings, &images.found, (colour, depth));
        cmd.after(Access::FRAGMENT_WRITE, Access::COMPUTE_WRITE);
    }

    /// `None` if the scene uses another way.
    fn peeled<'b>(&'b self, frame: &'b Frame<'_>, pass: &'b Blister, images: &'b LayerImages) -> Option<Parts<'b>> {
        let s = self.scene;
        let (scene, order) = s.blister.as_ref()?;
        let mut boundary_operands: Vec<Vec<(u32, Range<u32>)>> = Vec::new();
        for (instance, mesh) in (0..).zip(&scene.meshes) {
            let operand = mesh.operand as usize;
            boundary_operands.resize(boundary_operands.len().max(operand + 1), Vec::new());
            boundary_operands[operand].push((instance, mesh.corners.clone()));
        }
        let bindings = Bindings {
            frame: frame.constants,
            primitives: s.primitives(self.centres.surfaces),
            rects: &self.stage.rect_buffer,
            order,
            counters: &frame.stages.common.counters,
            meshes: s.boundary_operands.as_ref().map(|m| MeshBindings {
                views: frame.views,
                meshes: &m.meshes,
                triangles: &m.triangles,
                positions: &m.positions,
                planes: &m.planes,
            }),
            tiles: self.stage.tiles().map(|t| (&t.tile_starts, &t.tile_leaves, &t.tile_entries)),
        };
        Some(Parts { pass, scene, bindings, images, boundary_operands })
    }
}

impl Parts<'_> {
    /// Peels from the layer `start` on. The search for entries starts where the search for exits left `found`.
    fn search(&self, frame: &Frame<'_>, cmd: &Commands<'_>, start: &Image, search: Search) {
        let images = self.images;
        for k in 0..frame.capacities.solids.layers {
            let [image, other] = if k % 2 == 0 { [0, 1] } else { [1, 0] }.map(|i| &images.layers[i]);
            let before = if k == 0 { start } else { other };
            let first = k == 0 && search == Search::Inside;
            let covers = first && !frame.near.may_cut && self.scene.covered;
            let again = first && frame.near.may_cut;
            self.peel(cmd, Layer { before, image, found: &images.found }, search, (again, covers));
            if again {
                clear(cmd, &images.found, NOTHING);
            }
            self.ask(cmd, image, search, k + 1);
        }
        // pixels that still wait need more layers than are recorded
        let last = &images.layers[(frame.capacities.solids.layers as usize + 1) % 2];
        let stencil = Attachment { image: &images.stencil, load: Load::Keep };
        barrier::images(cmd, &[(&images.stencil, Access::DEPTH_WRITE, Access::DEPTH_WRITE)]);
        cmd.rendering_stencil(last.size(), &[], stencil, || {
            self.pass.wait(cmd, &self.bindings, last, frame.capacities.solids.layers + 1);
        });
    }

    fn peel(&self, cmd: &Commands<'_>, layer: Layer<'_>, search: Search, (unlocks, covers): (bool, bool)) {
        let depth = &self.images.depth;
        let (drawn, tested) = (ImageAccess::from(DRAWN), ImageAccess::from(Access::DEPTH_WRITE));
        barrier::images(cmd, &[(layer.image, READ.discarded(), drawn), (depth, tested, tested)]);
        let peel = |adds, takes_away| {
            let (begins, ends) = if search == Search::Inside { (adds, takes_away) } else { (takes_away, adds) };
            Peel { entries: begins, exits: ends, unlocks }
        };
        let leaves = if covers { &self.scene.cover } else { &self.scene.all };
        let meshes = (0..).zip(&self.scene.meshes).filter(|(_, mesh)| mesh.covers || !covers);
        let meshes: Vec<_> =
            meshes.map(|(i, mesh)| (i, mesh.corners.clone(), peel(mesh.adds, mesh.takes_away))).collect();
        let attachments =
            (Attachment { image: layer.image, load: NOTHING }, Attachment { image: depth, load: Load::Depth(1.0) });
        let (colour, depth) = attachments;
        self.pass.peel(cmd, &self.bindings, (layer, colour, depth), (leaves.clone(), peel(true, false)), &meshes);
        barrier::images(cmd, &[(layer.image, DRAWN, READ)]);
    }

    /// Finds the layer's faces that the search needs. `nth` is the layer's number, from 1; 0 and a first layer start a
    /// walk and clear the stencil.
    fn ask(&self, cmd: &Commands<'_>, layer: &Image, search: Search, nth: u32) {
        let Parts { pass, scene, images, .. } = self;
        let stencil = &images.stencil;
        let again = (stencil, Access::DEPTH_WRITE, Access::DEPTH_WRITE);
        barrier::images(cmd, &[again]);
        let begins = nth == 0 || (nth == 1 && search == Search::Inside);
        let load = if begins { Load::Depth(0.0) } else { Load::Keep };
        cmd.rendering_stencil(layer.size(), &[], Attachment { image: stencil, load }, || {
            pass.wait(cmd, &self.bindings, layer, nth);
            for s in &scene.switches {
                match s.asked {
                    Asked::Leaf(place) => pass.within(cmd, &self.bindings, layer, place, s.name),
                    Asked::Operand(operand) => {
                        let meshes = self.boundary_operands.get(operand as usize).into_iter().flatten();
                        pass.within_meshes(cmd, &self.bindings, layer, meshes, s.name);
                    }
                }
                pass.turn(cmd, s.name, s.within, s.without);
            }
        });
        let Some(end) = (if search == Search::Inside { scene.inside } else { scene.outside }) else { return };
        let found = &images.found;
        barrier::images(cmd, &[again, (found, READ, DRAWN)]);
        let (colour, stencil) =
            (Attachment { image: found, load: Load::Keep }, Attachment { image: stencil, load: Load::Keep });
        cmd.rendering_stencil(layer.size(), &[colour], stencil, || pass.lock(cmd, layer, end));
        barrier::images(cmd, &[(found, DRAWN, READ)]);
    }
}

/// Fills an image that is read between draws.
fn clear(cmd: &Commands<'_>, image: &Image, load: Load) {
    barrier::images(cmd, &[(image, READ.discarded(), DRAWN)]);
    cmd.rendering(image.size(), &[Attachment { image, load }], None, || ());
    barrier::images(cmd, &[(image, DRAWN, READ)]);
}
