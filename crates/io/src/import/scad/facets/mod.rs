//! Nodes whose result depends on their children's facets, not on their surfaces.
//!
//! ```text
//!   hull minkowski projection offset resize fill text import surface
//!        │ children, evaluated here: circles, balls and cylinders of as many sides as OpenSCAD gives them
//!        ▼
//!   Shape: Region (i_overlay) or Body (convex cells, meshes) ──placed──▶ Assembly: half-spaces, meshes
//! ```
//!
//! Inside such a node every node is evaluated when its last child is complete; outside, solids stay exact.

mod cells;
mod dxf;
mod file;
mod gather;
mod hull;
mod leaf;
mod place;
mod region;
mod relief;
mod solid;
mod svg;
#[cfg(test)]
mod tests;
mod text;

pub(super) use gather::Gather;
pub(super) use region::Region;
pub(super) use solid::{Body, Sweep, Triangles};

/// The shape of a node.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    Flat(Region),
    Solid(Body),
}

/// How much work is left: facets that are cut, pairs of corners that are summed. One for a file.
#[derive(Debug)]
pub(super) struct Budget(usize);

impl Budget {
    pub fn whole() -> Self {
        Self(50_000_000)
    }

    /// Takes a share; fails when nothing is left.
    fn spend(&mut self, share: usize) -> Result<(), String> {
        self.0 = self.0.saturating_sub(share);
        if self.0 > 0 { Ok(()) } else { Err("more facets than can be put together".to_owned()) }
    }
}

impl Shape {
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Flat(region) => region.is_empty(),
            Self::Solid(body) => body.is_empty(),
        }
    }
}
