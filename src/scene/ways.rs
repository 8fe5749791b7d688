//! Ways to draw the same picture: one is chosen, the others are there to be compared with it.

/// How a scene is drawn where there is more than one way; the picture is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ways {
    /// Boolean solids.
    pub solids: SolidWay,
}

/// How Boolean solids are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SolidWay {
    /// One ray a pixel, followed from event to event until it enters the solid.
    #[default]
    Events,
    /// The faces of each primitive, trimmed by the Blist of the others: constructive solid trimming.
    Cst,
}
