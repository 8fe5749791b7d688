//! The surface that supports a face, in the parameters of ISO 10303-42 ("native" parameters).
//!
//! Everything before the carrier works in native `(u, v)`: evaluation, inversion, periods, poles.
//!
//! ```text
//!             u                  v          pole (a side of the domain that is one point)
//!   plane     length             length     -
//!   cylinder  angle, periodic    length     -
//!   cone      angle, periodic    length     tip: v = -r / tan a
//!   sphere    angle, periodic    angle      v = ±π/2
//!   torus     angle, periodic    angle, p.  self-touching: cos v = -R / r
//!   turned    angle, periodic    profile's  where the profile meets the axis
//!   extruded  profile's          length     -
//!   spline    its own; periodic where it closes; poles on collapsed sides
//! ```

use super::curve::{Curve, repeated};
use super::law::{Law, TURN};
use super::spline::SplineForm;
use super::{Frame, SurfaceGeometry};
use crate::model::SurfaceKind;
use crate::spline::Jet;
use crate::spline::arc::sin_cos;
use glam::{DVec2, DVec3};
use std::cell::Cell;
use std::f64::consts::FRAC_PI_2;

/// The kinds of surface, with the numbers that their formulas need.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub(super) enum Form {
    Plane,
    Cylinder { radius: f64 },
    Cone { radius: f64, slope: f64 },
    Sphere { radius: f64 },
    Torus { major: f64, minor: f64 },
    Revolution { profile: Curve },
    Extrusion { profile: Curve, direction: DVec3 },
    Spline(Box<SplineForm>),
}

/// A line of the domain that is a single point in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pole {
    /// The coordinate that is fixed along the line: 0 for `u`, 1 for `v`.
    pub axis: usize,
    /// Its value.
    pub value: f64,
    /// The point.
    pub point: DVec3,
    /// Distance in mm within which an edge meets it.
    pub reach: f64,
}

impl Pole {
    /// Reach in distances at which points are the same: vertices miss poles by more than curves do.
    pub const REACH: f64 = 4.0;
}

/// A surface ready to be trimmed.
#[derive(Clone, Debug)]
pub(super) struct Support {
    /// Formula.
    pub form: Form,
    /// Placement; the world frame for extrusions and splines.
    pub frame: Frame,
    /// Degenerate lines.
    pub poles: Vec<Pole>,
    /// After how much each parameter repeats.
    pub periods: [Option<f64>; 2],
    /// The range that covers the whole surface once, where it is finite.
    pub natural: [Option<(f64, f64)>; 2],
    /// The rectangle that a face without loops shows, if the source cut one out.
    pub window: Option<[(f64, f64); 2]>,
    /// Distance in mm below which two points are the same.
    pub eps: f64,
    /// Distance in mm by which a trim curve may leave the pre-image of its edge.
    pub target: f64,
    /// Distance in mm by which the end of a strand may be moved to meet the next one.
    pub pull: f64,
    /// The largest that `target` may grow to for an edge that does not lie on the surface: [`Support::target_of`].
    pub noise: f64,
    /// Evaluations spent on inversion.
    pub spent: Cell<u64>,
    /// Evaluations after which edges are followed loosely: [`Support::allow`].
    allowed: Cell<u64>,
}

/// Evaluations that inversion may take for any face; real faces take some thousands.
const FREE_WORK: u64 = 1 << 18;

/// Evaluations that inversion may take beyond that for each patch of the surface and each node of an edge; real faces
/// take some tens in all. An edge far from its surface, on which Newton's method creeps, would take a hundred for each
/// sample, and fits would halve to the end.
const WORK: u64 = 256;

/// Steps of Newton's method after that: enough where the edge is near its surface.
const LOOSE_STEPS: usize = 8;

impl Support {
    /// `eps`: distance in mm below which two points are the same; trim curves aim at a hundredth.
    ///
    /// # Errors
    /// Why its numbers define no surface.
    pub fn new(geometry: &SurfaceGeometry, eps: f64) -> Result<Self, &'static str> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let full = Some((0.0, TURN));
        let mut this = match geometry {
            SurfaceGeometry::Plane { frame } => Self::with(Form::Plane, *frame, [None; 2], eps),
            SurfaceGeometry::Cylinder { frame, radius } => {
                if !positive(*radius) {
                    return Err("the radius is not positive");
                }
                Self::with(Form::Cylinder { radius: *radius }, *frame, [full, None], eps)
            }
            SurfaceGeometry::Cone { frame, radius, half_angle } => {
                let slope = half_angle.tan();
                if !(radius.is_finite() && *radius >= 0.0) {
                    return Err("the radius is negative");
                }
                if !slope.is_finite() || slope.abs() < 1e-12 || slope.abs() > 1e12 {
                    return Err("the half angle is a multiple of a right angle");
                }
                Self::with(Form::Cone { radius: *radius, slope }, *frame, [full, None], eps)
            }
            SurfaceGeometry::Sphere { frame, radius } => {
                if !positive(*radius) {
                    return Err("the radius is not positive");
                }
                let v = Some((-FRAC_PI_2, FRAC_PI_2));
                Self::with(Form::Sphere { radius: *radius }, *frame, [full, v], eps)
            }
            SurfaceGeometry::Torus { frame, major, minor } => {
                if !(positive(*major) && positive(*minor)) {
                    return Err("a radius is not positive");
                }
                // the outer (apple) part of a torus that meets its axis ends at the axis
                let v = if major < minor {
                    let end = (-major / minor).acos();
                    Some((-end, end))
                } else {
                    full
                };
                Self::with(Form::Torus { major: *major, minor: *minor }, *frame, [full, v], eps)
            }
            SurfaceGeometry::Revolution { profile, origin, axis } => {
                let frame = Frame::new(*origin, *axis, DVec3::ZERO).ok_or("the axis has no direction")?;
                let profile = Curve::new(profile, eps)?;
                let v = profile.domain();
                Self::with(Form::Revolution { profile }, frame, [full, v], eps)
            }
            SurfaceGeometry::Extrusion { profile, direction } => {
                if !(direction.is_finite() && direction.length_squared() > 0.0) {
                    return Err("the extrusion has no direction");
                }
                let profile = Curve::new(profile, eps)?;
                let u = profile.domain();
                let form = Form::Extrusion { profile, direction: *direction };
                Self::with(form, Frame::WORLD, [u, None], eps)
            }
            SurfaceGeometry::Window { basis, u, v } => {
                let sound = |(a, b): &(f64, f64)| a.is_finite() && b.is_finite() && a < b;
                if !(sound(u) && sound(v)) {
                    return Err("its parameter range is empty");
                }
                return Ok(Self { window: Some([*u, *v]), ..Self::new(basis, eps)? });
            }
            SurfaceGeometry::BSpline(surface) => {
                // writers close their splines less exactly than they place their vertices
                let (lo, hi) = surface.bounds();
                let form = SplineForm::new(surface, eps.max(1e-7 * lo.distance(hi)));
                let natural = form.domain.map(Some);
                Self::with(Form::Spline(Box::new(form)), Frame::WORLD, natural, eps)
            }
        };
        if !this.frame.is_orthonormal() {
            return Err("its frame is not orthonormal");
        }
        this.periods = this.find_periods();
        this.poles = this.find_poles();
        if let (Form::Revolution { profile }, [a, b]) = (&this.form, &this.poles[..])
            && profile.period().is_some()
        {
            // a closed profile that crosses its axis: one side of it makes the surface already
            this.natural[1] = Some((a.value, b.value));
        }
        Ok(this)
    }

    fn with(form: Form, frame: Frame, natural: [Option<(f64, f64)>; 2], eps: f64) -> Self {
        Self {
            form,
            frame,
            poles: Vec::new(),
            periods: [None; 2],
            natural,
            window: None,
            eps,
            target: 1e-2 * eps,
            pull: 1e-1 * eps,
            noise: 0.0,
            spent: Cell::new(0),
            allowed: Cell::new(u64::MAX),
        }
    }

    /// Bounds the work of inversion by what there is to do: `nodes` of all edges.
    pub fn allow(&self, nodes: usize) {
        let pieces = match &self.form {
            Form::Spline(s) => s.patch_count(),
            Form::Revolution { profile } | Form::Extrusion { profile, .. } => match profile {
                Curve::Pieces(p) => p.spans.len(),
                _ => 1,
            },
            _ => 1,
        };
        self.allowed.set(self.spent.get() + FREE_WORK + WORK * (pieces + nodes) as u64);
    }

    /// Inversion is a search, not a formula.
    pub fn is_iterative(&self) -> bool {
        matches!(self.form, Form::Revolution { .. } | Form::Extrusion { .. } | Form::Spline(_))
    }

    /// Counts evaluations.
    pub fn spend(&self, evaluations: u64) {
        self.spent.set(self.spent.get().saturating_add(evaluations));
    }

    /// The allowed evaluations are spent. From now on inversion takes the first foot in few steps, traces are straight
    /// between their samples where a crease is looked for, and fits are not refined.
    pub fn exhausted(&self) -> bool {
        self.spent.get() >= self.allowed.get()
    }

    /// How many of `most` steps of Newton's method an inversion may take.
    pub fn steps(&self, most: usize) -> usize {
        if self.exhausted() { most.min(LOOSE_STEPS) } else { most }
    }

    fn find_periods(&self) -> [Option<f64>; 2] {
        let turn = Some(TURN);
        match &self.form {
            Form::Plane => [None, None],
            Form::Cylinder { .. } | Form::Cone { .. } | Form::Sphere { .. } => [turn, None],
            Form::Torus { .. } => [turn, turn],
            Form::Revolution { profile } => [turn, profile.period()],
            Form::Extrusion { profile, .. } => [profile.period(), None],
            Form::Spline(s) => [0, 1].map(|i| s.closed[i].then_some(s.domain[i].1 - s.domain[i].0)),
        }
    }

    fn find_poles(&self) -> Vec<Pole> {
        let reach = Pole::REACH * self.eps;
        let at = |value: f64| Pole { axis: 1, value, point: self.point(DVec2::new(0.0, value)), reach };
        match &self.form {
            Form::Cone { radius, slope } => {
                vec![Pole { point: self.frame.origin - self.frame.z * (radius / slope), ..at(-radius / slope) }]
            }
            Form::Sphere { .. } => vec![at(-FRAC_PI_2), at(FRAC_PI_2)],
            Form::Torus { major, minor } if major <= minor => {
                let end = (-major / minor).acos();
                let mut poles = vec![at(-end), at(end)];
                poles.truncate(if major == minor { 1 } else { 2 });
                poles
            }
            Form::Revolution { profile } => {
                super::invert::axis_crossings(profile, &self.frame, self.eps).into_iter().map(at).collect()
            }
            Form::Spline(s) => s.poles(self.eps),
            _ => Vec::new(),
        }
    }

    /// Where a turned profile passes its axis within `distance` mm, and is at no pole.
    pub fn near_axis(&self, distance: f64) -> Vec<Pole> {
        let Form::Revolution { profile } = &self.form else { return Vec::new() };
        let near = super::invert::axis_crossings(profile, &self.frame, distance).into_iter();
        let reach = Pole::REACH * self.eps;
        let pole = |value: f64| Pole { axis: 1, value, point: self.point(DVec2::new(0.0, value)), reach };
        near.map(pole).filter(|tip| self.pole_at(tip.point, distance).is_none()).collect()
    }

    /// The face's kind of surface.
    pub fn kind(&self) -> SurfaceKind {
        match self.form {
            Form::Plane => SurfaceKind::Plane,
            Form::Cylinder { .. } => SurfaceKind::Cylinder,
            Form::Cone { .. } => SurfaceKind::Cone,
            Form::Sphere { .. } => SurfaceKind::Sphere,
            Form::Torus { .. } => SurfaceKind::Torus,
            Form::Revolution { .. } => SurfaceKind::Revolution,
            Form::Extrusion { .. } => SurfaceKind::Extrusion,
            Form::Spline(_) => SurfaceKind::BSpline,
        }
    }

    /// How the native parameters map to the carrier's.
    pub fn laws(&self) -> [Law; 2] {
        match &self.form {
            Form::Plane | Form::Spline(_) => [Law::Linear; 2],
            Form::Cylinder { .. } | Form::Cone { .. } => [Law::Angle, Law::Linear],
            Form::Sphere { .. } | Form::Torus { .. } => [Law::Angle; 2],
            Form::Revolution { profile } => [Law::Angle, profile.law()],
            Form::Extrusion { profile, .. } => [profile.law(), Law::Linear],
        }
    }

    /// A point of the axis that the surface is round about, and its direction; a sphere has its centre and every direction.
    pub fn axis(&self) -> Option<(DVec3, Option<DVec3>)> {
        match self.form {
            Form::Sphere { .. } => Some((self.frame.origin, None)),
            Form::Cylinder { .. } | Form::Cone { .. } | Form::Torus { .. } | Form::Revolution { .. } => {
                Some((self.frame.origin, Some(self.frame.z)))
            }
            Form::Plane | Form::Extrusion { .. } | Form::Spline(_) => None,
        }
    }

    /// Point and derivatives at native `(u, v)`; any real parameters, wrapped where periodic.
    pub fn jet(&self, p: DVec2) -> Jet {
        match &self.form {
            Form::Plane => Jet { point: self.world(p.x, p.y, 0.0), du: self.frame.x, dv: self.frame.y },
            Form::Cylinder { radius } => self.turned(p.x, [*radius, p.y], [0.0, 1.0]),
            Form::Cone { radius, slope } => self.turned(p.x, [radius + p.y * slope, p.y], [*slope, 1.0]),
            Form::Sphere { radius: r } => {
                let (s, c) = sin_cos(p.y);
                self.turned(p.x, [r * c, r * s], [-r * s, r * c])
            }
            Form::Torus { major, minor: r } => {
                let (s, c) = sin_cos(p.y);
                self.turned(p.x, [major + r * c, r * s], [-r * s, r * c])
            }
            Form::Revolution { profile } => {
                let (q, d) = profile.jet(p.y);
                let arm = q - self.frame.origin;
                let point = self.frame.origin + self.spin(arm, p.x);
                let du = self.frame.z.cross(point - self.frame.origin);
                Jet { point, du, dv: self.spin(d, p.x) }
            }
            Form::Extrusion { profile, direction } => {
                let (q, du) = profile.jet(p.x);
                Jet { point: q + direction * p.y, du, dv: *direction }
            }
            Form::Spline(s) => s.jet(p),
        }
    }

    /// Point at native `(u, v)`.
    pub fn point(&self, p: DVec2) -> DVec3 {
        self.jet(p).point
    }

    /// By how much a trim curve may leave the pre-image of an edge that lies `gap` mm off the surface: a hundredth of
    /// `gap`, since the place of the edge is not known better.
    pub fn target_of(&self, gap: f64) -> f64 {
        self.target.max((1e-2 * gap).min(self.noise))
    }

    /// Lengths of the two derivatives: millimetres per unit of `u` and of `v`.
    pub fn speed(&self, p: DVec2) -> DVec2 {
        let jet = self.jet(p);
        DVec2::new(jet.du.length(), jet.dv.length())
    }

    fn world(&self, x: f64, y: f64, z: f64) -> DVec3 {
        self.frame.world(DVec3::new(x, y, z))
    }

    /// `v` turned by `angle` about the frame's z direction.
    pub fn spin(&self, v: DVec3, angle: f64) -> DVec3 {
        let (s, c) = sin_cos(angle);
        let axial = self.frame.z * v.dot(self.frame.z);
        axial + (v - axial) * c + self.frame.z.cross(v) * s
    }

    /// A meridian point `(ρ, z)` with derivative, turned by `u`.
    fn turned(&self, u: f64, [rho, z]: [f64; 2], [drho, dz]: [f64; 2]) -> Jet {
        let (s, c) = sin_cos(u);
        Jet {
            point: self.world(rho * c, rho * s, z),
            du: (self.frame.y * c - self.frame.x * s) * rho,
            dv: (self.frame.x * c + self.frame.y * s) * drho + self.frame.z * dz,
        }
    }

    /// `p` moved by whole periods to the copy nearest to `near`.
    pub fn unwrap(&self, p: DVec2, near: DVec2) -> DVec2 {
        let one = |i: usize| self.periods[i].map_or(p[i], |period| super::law::nearest(p[i], near[i], period));
        DVec2::new(one(0), one(1))
    }

    /// The pole at `p`.
    pub fn pole_of(&self, p: DVec3) -> Option<usize> {
        self.poles.iter().position(|pole| pole.point.distance(p) <= pole.reach)
    }

    /// The pole within `reach` mm of `p`.
    pub fn pole_at(&self, p: DVec3, reach: f64) -> Option<usize> {
        self.poles.iter().position(|pole| pole.point.distance(p) <= reach)
    }

    /// Nothing bounds the surface: each parameter is periodic, or ends at poles.
    pub fn is_closed(&self) -> bool {
        (0..2).all(|i| {
            let ends_at_pole = |x: f64| self.poles.iter().any(|p| p.axis == i && (p.value - x).abs() <= 1e-9);
            self.natural[i].is_some_and(|(a, b)| self.periods[i].is_some() || (ends_at_pole(a) && ends_at_pole(b)))
        })
    }

    /// Native parameters strictly inside `(a, b)` across which the surface may crease; they are
    /// where a fitted trim curve is cut. Knots of angular carriers are not among them.
    pub fn creases(&self, axis: usize, a: f64, b: f64) -> Vec<f64> {
        match &self.form {
            Form::Revolution { profile } if axis == 1 => profile.creases(a, b),
            Form::Extrusion { profile, .. } if axis == 0 => profile.creases(a, b),
            Form::Spline(s) => repeated(s.creases[axis].iter().copied(), self.periods[axis], a, b),
            _ => Vec::new(),
        }
    }
}
