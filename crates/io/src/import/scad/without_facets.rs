//! The substitute for `facets` in a library built without the feature `scad-facets`: nodes that need them are
//! left out by name.

use super::args::Args;
use super::flat::{Lift, Plate};
use super::frame::Made;
use super::{Context, Fault, Reader};
use crate::csg::Op;
use glam::{DAffine3, DVec2, DVec3};

/// None is ever made.
#[derive(Clone, Debug)]
pub(super) enum Shape {}

/// None is ever made.
#[derive(Debug)]
pub(super) struct Gather(Shape);

#[derive(Debug)]
pub(super) struct Budget;

impl Budget {
    pub fn whole() -> Self {
        Self
    }
}

const NEEDED: &str = "such a node needs the feature `scad-facets`, which is not built in";

impl Gather {
    pub fn needs(node: &str) -> bool {
        ["hull", "minkowski", "fill", "resize", "offset", "projection"].contains(&node)
    }

    pub fn new(args: &Args<'_>, _: Op, _: Option<DAffine3>, _: Option<Lift>) -> Result<Self, Fault> {
        Err(args.fault(NEEDED))
    }

    pub fn add(&mut self, _: Made<Shape>) {
        match self.0 {}
    }

    pub fn finish(self, _: &mut Budget) -> Result<Made<Shape>, String> {
        match self.0 {}
    }

    pub fn scale(&self) -> Option<DVec3> {
        match self.0 {}
    }

    pub fn strangers(&self) -> usize {
        match self.0 {}
    }
}

impl Reader<'_> {
    pub(super) fn facet_leaf(&mut self, args: &Args<'_>) -> Result<Made<Shape>, Fault> {
        let place =
            self.files.folder.map(|f| format!(" (files would be those of {})", f.display())).unwrap_or_default();
        Err(args.fault(format!("{NEEDED}{place}")))
    }

    pub(super) fn placed(&mut self, _: &Args<'_>, _: &Context, shape: Made<Shape>) -> Result<Made<u32>, Fault> {
        Ok(match shape {
            Made::Is(shape) => match shape {},
            Made::Empty => Made::Empty,
            Made::Lost => Made::Lost,
        })
    }
}

impl Plate<'_> {
    pub(super) fn crossed(&mut self, _: &Args<'_>, _: &[Vec<DVec2>], fault: Fault) -> Result<u32, Fault> {
        Err(fault)
    }
}
