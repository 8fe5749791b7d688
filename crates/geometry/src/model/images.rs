//! The images of a rendered picture: depth, face and (u, v) of each pixel.

/// Images of a model through a [`Camera`](super::Camera), as a renderer made them. Row 0 is on top; each value is that
/// at the pixel's centre. An image that the renderer did not make is empty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Images<'a> {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Distance along the view axis, model units, `+inf` for background.
    pub depth: &'a [f32],
    /// [`Face::id`](super::Face::id) or [`Mesh::id`](super::Mesh::id), 0 for background.
    pub face: &'a [u32],
    /// Unit outward normal in model space, 0 for background.
    pub normal: &'a [[f32; 3]],
    /// Whether the sun reaches the point; false for background.
    pub sunlit: &'a [bool],
    /// Where there is a sun: how far the surfaces that cast its shadows are from the true ones, model units.
    pub shadow_deviation: f64,
}
