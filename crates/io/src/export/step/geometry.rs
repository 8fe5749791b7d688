//! Points, directions, curves and surfaces as entities.

use super::text::{Id, List, Real, Text, reals};
use crate::spline::{BSpline, Control, Surface};
use glam::{DVec2, DVec3, DVec4};
use std::io::{self, Write};

/// Distinct knots and how often each stands.
fn knots(all: &[f64]) -> (String, String) {
    let runs: Vec<&[f64]> = all.chunk_by(|a, b| a == b).collect();
    let counts: Vec<usize> = runs.iter().map(|r| r.len()).collect();
    (List(&counts).to_string(), reals(runs.iter().map(|r| r[0])))
}

impl<W: Write> Text<'_, W> {
    pub fn point(&mut self, p: DVec3) -> io::Result<Id> {
        self.add(format_args!("CARTESIAN_POINT('',{})", reals(p.to_array())))
    }

    fn flat_point(&mut self, p: DVec2) -> io::Result<Id> {
        self.add(format_args!("CARTESIAN_POINT('',{})", reals(p.to_array())))
    }

    fn direction(&mut self, d: DVec3) -> io::Result<Id> {
        self.add(format_args!("DIRECTION('',{})", reals(d.to_array())))
    }

    /// Origin, z and x axis.
    pub fn placement(&mut self, origin: DVec3, z: DVec3, x: DVec3) -> io::Result<Id> {
        let origin = self.point(origin)?;
        self.placement_at(origin, z, x)
    }

    /// The same at a point that is written already.
    pub fn placement_at(&mut self, origin: Id, z: DVec3, x: DVec3) -> io::Result<Id> {
        let (z, x) = (self.direction(z)?, self.direction(x)?);
        self.add(format_args!("AXIS2_PLACEMENT_3D('',{origin},{z},{x})"))
    }

    /// Origin and direction.
    pub fn axis(&mut self, origin: DVec3, z: DVec3) -> io::Result<Id> {
        let (origin, z) = (self.point(origin)?, self.direction(z)?);
        self.add(format_args!("AXIS1_PLACEMENT('',{origin},{z})"))
    }

    pub fn space_curve(&mut self, c: &BSpline<DVec4>) -> io::Result<Id> {
        let points: Vec<Id> = c.points().iter().map(|p| self.point(p.point())).collect::<Result<_, _>>()?;
        self.spline_curve(c, &points)
    }

    pub fn flat_curve(&mut self, c: &BSpline<DVec3>) -> io::Result<Id> {
        let points: Vec<Id> = c.points().iter().map(|p| self.flat_point(p.point())).collect::<Result<_, _>>()?;
        self.spline_curve(c, &points)
    }

    fn spline_curve<P: Control>(&mut self, c: &BSpline<P>, points: &[Id]) -> io::Result<Id> {
        let (counts, knots) = knots(c.knots());
        let (degree, points) = (c.degree(), List(points));
        if c.is_polynomial() {
            return self.add(format_args!(
                "B_SPLINE_CURVE_WITH_KNOTS('',{degree},{points},.UNSPECIFIED.,.F.,.F.,{counts},{knots},.UNSPECIFIED.)"
            ));
        }
        let weights = reals(c.points().iter().map(|p| p.weight()));
        self.add(format_args!(
            "(BOUNDED_CURVE()B_SPLINE_CURVE({degree},{points},.UNSPECIFIED.,.F.,.F.)\
             B_SPLINE_CURVE_WITH_KNOTS({counts},{knots},.UNSPECIFIED.)CURVE()GEOMETRIC_REPRESENTATION_ITEM()\
             RATIONAL_B_SPLINE_CURVE({weights})REPRESENTATION_ITEM(''))"
        ))
    }

    pub fn surface(&mut self, s: &Surface) -> io::Result<Id> {
        let (nu, nv) = s.counts();
        // the file runs along v fastest, the engine along u
        let column = |i: usize| (0..nv).map(move |j| j * nu + i);
        let mut rows = Vec::with_capacity(nu);
        for i in 0..nu {
            let ids: Vec<Id> = column(i).map(|k| self.point(s.points()[k].point())).collect::<Result<_, _>>()?;
            rows.push(List(&ids).to_string());
        }
        let ((pu, pv), net) = (s.degrees(), List(&rows));
        let ((counts_u, knots_u), (counts_v, knots_v)) = (knots(s.knots().0), knots(s.knots().1));
        let spacing = format!("{counts_u},{counts_v},{knots_u},{knots_v},.UNSPECIFIED.");
        if s.is_polynomial() {
            return self.add(format_args!(
                "B_SPLINE_SURFACE_WITH_KNOTS('',{pu},{pv},{net},.UNSPECIFIED.,.F.,.F.,.F.,{spacing})"
            ));
        }
        let weights: Vec<String> = (0..nu).map(|i| reals(column(i).map(|k| s.points()[k].w))).collect();
        self.add(format_args!(
            "(BOUNDED_SURFACE()B_SPLINE_SURFACE({pu},{pv},{net},.UNSPECIFIED.,.F.,.F.,.F.)\
             B_SPLINE_SURFACE_WITH_KNOTS({spacing})GEOMETRIC_REPRESENTATION_ITEM()\
             RATIONAL_B_SPLINE_SURFACE({})REPRESENTATION_ITEM('')SURFACE())",
            List(&weights)
        ))
    }

    /// The context of a representation: millimetres, radians, and how far curves may be off.
    pub fn context(&mut self, id: Id, uncertainty: f64) -> io::Result<()> {
        let length = self.add(format_args!("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"))?;
        let angle = self.add(format_args!("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"))?;
        let solid = self.add(format_args!("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())"))?;
        let u = self.add(format_args!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),{length},'distance_accuracy_value',\
             'largest distance between curves that are one edge')",
            Real(uncertainty)
        ))?;
        self.put(
            id,
            format_args!(
                "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({u}))\
                 GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('',''))"
            ),
        )
    }
}
