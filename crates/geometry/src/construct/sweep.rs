//! A planar profile moved along a path.
//!
//! ```text
//!        y                     profile (x, y), in the plane across the path: z of the frame is the tangent
//!      ╭─┼─╮  ╭── path ──▶
//!   ───┼─●─┼──╯                u: the profile's parameter; v in [0, 1]: the path's
//!      ╰─┼─╯
//! ```
//!
//! The frame is the one of least turning along the path; a twist and a scale may be added, even by arc length. On a
//! closed path the frame comes back turned by an angle (its holonomy). This angle is removed evenly by arc length, so
//! the surface closes when the twist is a whole number of turns and the scales are equal.
//!
//! | path | surface |
//! |---|---|
//! | straight, no twist | exact, degree 1 in `v`; `v` is the share of the length |
//! | circular arc, no twist, constant scale | exact, a lathe's; `v` is the share of the angle at the ends of quarters |
//! | any other | cubic in `v`, C¹ where the path is |

use super::frame::{Path, across};
use super::motion::{Affine, Laws, Motion};
use super::{Built, ConstructError, lathe};
use crate::spline::{BSpline, Control, Surface};
use glam::{DAffine3, DMat3, DVec2, DVec3, DVec4};
use std::f64::consts::TAU;

/// A sweep: profile, path and motion.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'a> {
    /// Planar profile.
    pub profile: &'a BSpline<DVec3>,
    /// Path, without corners.
    pub path: &'a BSpline<DVec4>,
    /// Direction of the profile's `x` at the start, made perpendicular; any where it is `None` or along the path.
    pub up: Option<DVec3>,
    /// Turn of the profile about the path from start to end, radians, counter-clockwise looking against the path.
    pub twist: f64,
    /// Scale of the profile at the start and at the end.
    pub scale: (f64, f64),
    /// Largest deviation, model units.
    pub tolerance: f64,
}

impl<'a> Sweep<'a> {
    /// Without twist, at scale 1.
    pub fn new(profile: &'a BSpline<DVec3>, path: &'a BSpline<DVec4>, tolerance: f64) -> Self {
        Self { profile, path, up: None, twist: 0.0, scale: (1.0, 1.0), tolerance }
    }

    /// The surface; deviations are measured between points of equal profile parameter and path parameter.
    ///
    /// # Errors
    /// * Numbers out of range; a tolerance that is not reached.
    /// * A profile or path without length; a path with a corner or a stop.
    /// * A profile that reaches a centre of curvature of the path, where the surface would fold.
    pub fn build(&self) -> Result<Built, ConstructError> {
        self.check()?;
        let path = Path::new(self.path, "the path")?;
        let still = self.twist == 0.0;
        if still && let Some(surface) = self.straight(&path)? {
            return Ok(Built { surface, deviation: 0.0 });
        }
        if still
            && self.scale.0 == self.scale.1
            && let Some(surface) = self.circular(&path)?
        {
            return Ok(Built { surface, deviation: 0.0 });
        }
        let hull: Vec<DVec2> = self.profile.points().iter().map(|p| p.point()).collect();
        let reach = hull.iter().map(|p| p.length()).fold(0.0, f64::max) * self.scale.0.max(self.scale.1);
        // a twentieth for the frame, the rest for the fit
        let laws = Laws { up: self.up, twist: self.twist, scale: self.scale };
        let motion = Motion::new(&path, laws, 0.05 * self.tolerance / reach)?;
        if let Some(fold) = motion.fold(&samples(self.profile)) {
            return Err(fold);
        }
        let frame = motion.frame_error * reach;
        let (knots, mut frames, fitted) = motion.fit(&hull, self.tolerance - frame)?;
        let whole = |x: f64| (x / TAU - (x / TAU).round()).abs() < 1e-12;
        let last = frames.len() - 1;
        if path.closed() && whole(self.twist) && self.scale.0 == self.scale.1 {
            frames[last] = frames[0];
        }
        Ok(Built { surface: self.net(3, knots, &frames)?, deviation: fitted + frame })
    }

    fn check(&self) -> Result<(), ConstructError> {
        if !self.twist.is_finite() {
            return Err(ConstructError::NotFinite { what: "the twist of a sweep" });
        }
        if self.up.is_some_and(|up| !up.is_finite()) {
            return Err(ConstructError::NotFinite { what: "the direction of the profile's x" });
        }
        for (what, value) in [
            ("a scale of a sweep", self.scale.0),
            ("a scale of a sweep", self.scale.1),
            ("the tolerance", self.tolerance),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ConstructError::Range { what, value, must: "positive" });
            }
        }
        let first = self.profile.points()[0].point();
        if self.profile.points().iter().all(|p| p.point() == first) {
            return Err(ConstructError::ZeroLength { what: "the profile" });
        }
        Ok(())
    }

    /// The surface of control frames.
    fn net(&self, degree: usize, knots: Vec<f64>, frames: &[Affine]) -> Result<Surface, ConstructError> {
        let profile = self.profile.points();
        let place = |[x, y, c]: &Affine, p: &DVec3| (*x * p.x + *y * p.y + *c * p.z).extend(p.z);
        let net = frames.iter().flat_map(|f| profile.iter().map(|p| place(f, p))).collect();
        Ok(Surface::new((self.profile.degree(), degree), self.profile.knots().to_vec(), knots, net)?)
    }

    /// Between two scaled copies, when the path is straight.
    fn straight(&self, path: &Path) -> Result<Option<Surface>, ConstructError> {
        let points: Vec<DVec3> = self.path.clamped().points().iter().map(|p| p.point()).collect();
        let (start, end) = (points[0], points[points.len() - 1]);
        let Some(t) = (end - start).try_normalize() else { return Ok(None) };
        let size = super::compat::size([self.path]);
        let inside = |p: &DVec3| (*p - start).cross(t).length() <= 1e-14 * size;
        let forward =
            (0..path.spans().len()).all(|i| (0..=16).all(|k| path.local(i, f64::from(k) / 16.0).first.dot(t) > 0.0));
        if !(points.iter().all(inside) && forward) {
            return Ok(None);
        }
        let x = across(t, self.up);
        let frame = |c: DVec3, s: f64| [x * s, t.cross(x) * s, c];
        let frames = [frame(start, self.scale.0), frame(end, self.scale.1)];
        self.net(1, vec![0.0, 0.0, 1.0, 1.0], &frames).map(Some)
    }

    /// A lathe, when the path is an arc of a circle, run in one direction and at most once.
    fn circular(&self, path: &Path) -> Result<Option<Surface>, ConstructError> {
        let Some(circle) = Circle::through(path) else { return Ok(None) };
        let start = path.jet(0.0);
        let t = start.tangent();
        let x = across(t, self.up);
        let y = t.cross(x);
        let radial = (start.point - circle.centre).normalize();
        let axis = radial.cross(t);
        let s = self.scale.0;
        let turned = |p: &DVec3| {
            let d = (x * p.x + y * p.y) * s;
            DVec3::new(circle.radius * p.z + d.dot(radial), d.dot(axis), p.z)
        };
        // the centre of the path's circle is an axis that no profile crosses
        let inwards = samples(self.profile).into_iter().map(|p| -(x * p.x + y * p.y).dot(radial) * s);
        let reach = inwards.fold(0.0, f64::max);
        let folds = || ConstructError::Folds { parameter: 0.0, reach, radius: circle.radius };
        if reach > circle.radius * (1.0 + 1e-12) {
            return Err(folds());
        }
        let profile = self.profile.points().iter().map(turned).collect();
        let profile = BSpline::new(self.profile.degree(), self.profile.knots().to_vec(), profile)?;
        let place = DAffine3::from_mat3_translation(DMat3::from_cols(radial, t, axis), circle.centre);
        let turned = lathe(&profile, circle.angle).map_err(|e| match e {
            ConstructError::CrossesAxis { .. } | ConstructError::OnAxis => folds(),
            e => e,
        })?;
        let turned = turned.transformed(&place).transposed();
        let (ku, kv) = turned.knots();
        let kv = kv.iter().map(|k| if *k == circle.angle { 1.0 } else { k / circle.angle }).collect();
        Ok(Some(Surface::new(turned.degrees(), ku.to_vec(), kv, turned.points().to_vec())?))
    }
}

/// Points along the profile, for folds.
fn samples(profile: &BSpline<DVec3>) -> Vec<DVec2> {
    const EACH: u32 = 16;
    let spans = profile.beziers();
    spans.iter().flat_map(|s| (0..=EACH).map(|k| s.piece.point(f64::from(k) / f64::from(EACH)))).collect()
}

/// The circle that a path runs on.
struct Circle {
    centre: DVec3,
    radius: f64,
    angle: f64,
}

impl Circle {
    fn through(path: &Path) -> Option<Self> {
        let [a, b, c] = [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|t| path.jet(t).point);
        let (p, q) = (b - a, c - a);
        let n = p.cross(q);
        let square = n.length_squared();
        if square <= 1e-12 * (p.length_squared() * q.length_squared()) {
            return None;
        }
        let centre = a + (n.cross(p) * q.length_squared() + q.cross(n) * p.length_squared()) / (2.0 * square);
        let (radius, axis) = (centre.distance(a), n.normalize());
        let mut angle = 0.0;
        for (i, s) in path.spans().iter().enumerate() {
            // |c - centre|² - r² times the squared weight has degree 2 p: zero at more points, zero everywhere
            let count = 2 * s.piece.degree() + 4;
            let mut before = path.local(i, 0.0).point - centre;
            for k in 1..=count {
                let here = path.local(i, k as f64 / count as f64).point - centre;
                let step = axis.dot(before.cross(here)).atan2(before.dot(here));
                if (here.length() - radius).abs() > 1e-13 * radius
                    || here.dot(axis).abs() > 1e-13 * radius
                    || step <= 0.0
                {
                    return None;
                }
                angle += step;
                before = here;
            }
        }
        let angle = if path.closed() && (angle - TAU).abs() < 1e-6 { TAU } else { angle };
        (angle <= TAU).then_some(Self { centre, radius, angle })
    }
}
