//! Units and tolerance, per representation.

use super::import;
use crate::import::Import;
use crate::import::Warnings;
use crate::import::step::part21::File;
use crate::import::step::units::Units;

const RADIAN: &str = "#90=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));";

/// Units of the context `#1`, and the warnings.
fn told(data: &str) -> (Units, Vec<String>) {
    let text = super::wrap(data);
    let file = File::parse(text.as_bytes(), "t", &mut Warnings::new("t")).unwrap();
    let mut notes = Vec::new();
    let units = Units::of_context(&file, 1, |what, fault| notes.push(format!("{what}: {fault}")));
    (units, notes)
}

/// Units of the context `#1`, in which nothing is wrong.
fn units(data: &str) -> Units {
    let (units, notes) = told(data);
    assert!(notes.is_empty(), "{notes:?}");
    units
}

fn context(length: &str, rest: &str) -> String {
    format!(
        "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3)) \
         GLOBAL_UNIT_ASSIGNED_CONTEXT((#2,#90)) REPRESENTATION_CONTEXT('',''));{RADIAN}\
         #2=({length});#3=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.E-3),#2,'distance_accuracy_value','');{rest}"
    )
}

#[test]
fn si_lengths() {
    for (prefix, millimetres, name) in
        [(".MILLI.", 1.0, "mm"), (".CENTI.", 10.0, "cm"), ("$", 1000.0, "m"), (".MICRO.", 1e-3, "µm")]
    {
        let units = units(&context(&format!("LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({prefix},.METRE.)"), ""));
        assert!((units.length - millimetres).abs() <= 1e-15 * millimetres, "{prefix}: {}", units.length);
        assert_eq!(units.name, name);
        assert!((units.tolerance - (2e-3 * millimetres).min(0.1)).abs() < 1e-15, "{}", units.tolerance);
    }
}

#[test]
fn inch_by_conversion_and_degrees() {
    let inch = "CONVERSION_BASED_UNIT('INCH',#4) LENGTH_UNIT() NAMED_UNIT(#5)";
    let rest = "#4=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#6);#5=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\
                #6=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));";
    let found = units(&context(inch, rest));
    assert!((found.length - 25.4).abs() < 1e-13);
    assert_eq!((found.name.as_str(), found.angle), ("inch", 1.0));
    assert!((found.tolerance - 0.0508).abs() < 1e-13);

    let degree = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#2)) REPRESENTATION_CONTEXT('',''));\
        #2=(CONVERSION_BASED_UNIT('DEGREE',#3) NAMED_UNIT(#5) PLANE_ANGLE_UNIT());\
        #3=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.017453292519943295),#90);#5=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);";
    let found = units(&format!("{degree}{RADIAN}"));
    assert!((found.angle.to_degrees() - 1.0).abs() < 1e-15);
    assert_eq!((found.length, found.tolerance), (1.0, 1e-4));
}

#[test]
fn conversions_that_never_end_are_refused() {
    let data = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#2)) REPRESENTATION_CONTEXT('',''));\
        #2=(CONVERSION_BASED_UNIT('LOOP',#3) LENGTH_UNIT() NAMED_UNIT(*));#3=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(2.),#2);";
    assert_eq!(told(data), (Units::default(), vec!["lengths taken as millimetres: #2 refers to itself".to_owned()]));
}

/// An inch context of a degree and a tolerance of a thousandth, every instance simple or complex.
#[test]
fn simple_and_complex_instances_say_the_same() {
    let simple = [
        "#2=SI_UNIT(*,.MILLI.,.METRE.);#90=SI_UNIT(*,$,.RADIAN.);",
        "#4=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#2);#5=CONVERSION_BASED_UNIT(#8,'INCH',#4);",
        "#6=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.017453292519943295),#90);#7=CONVERSION_BASED_UNIT(#8,'DEGREE',#6);",
        "#3=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-3),#5,'distance_accuracy_value','');",
    ];
    let complex = [
        "#2=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));#90=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));",
        "#4=(LENGTH_MEASURE_WITH_UNIT() MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#2));#5=(CONVERSION_BASED_UNIT('INCH',#4) LENGTH_UNIT() NAMED_UNIT(#8));",
        "#6=(MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.017453292519943295),#90) PLANE_ANGLE_MEASURE_WITH_UNIT());\
         #7=(CONVERSION_BASED_UNIT('DEGREE',#6) NAMED_UNIT(#8) PLANE_ANGLE_UNIT());",
        "#3=(LENGTH_MEASURE_WITH_UNIT() MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-3),#5) UNCERTAINTY_MEASURE_WITH_UNIT('distance_accuracy_value',''));",
    ];
    let context = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3)) \
        GLOBAL_UNIT_ASSIGNED_CONTEXT((#5,#7)) REPRESENTATION_CONTEXT('',''));#8=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);";
    for mask in 0..16 {
        let pick = |k: usize| if mask >> k & 1 == 0 { simple[k] } else { complex[k] };
        let found = units(&[context, pick(0), pick(1), pick(2), pick(3)].concat());
        // one rounding each: 25.4 mm is 0.0254 m times 1000
        assert!(
            (found.length - 25.4).abs() < 1e-13 && (found.tolerance - 0.0254).abs() < 1e-16,
            "{mask:04b}: {found:?}"
        );
        assert!((found.angle.to_degrees() - 1.0).abs() < 1e-15 && found.name == "inch", "{mask:04b}: {found:?}");
    }
}

#[test]
fn an_inch_box_with_a_complex_uncertainty_is_an_inch_wide() {
    let text = include_str!("cases/inch_complex_uncertainty.stp");
    let import = crate::import::step(text.as_bytes(), "case.stp").unwrap();
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    assert_eq!((import.report.units.as_slice(), import.report.faces), (&["inch".to_owned()][..], 6));
    let bounds = import.model.parts[0].bounds();
    assert!((bounds.max - bounds.min - glam::DVec3::splat(25.4)).length() < 1e-9, "{bounds:?}");
}

/// An unreadable unit costs itself alone.
#[test]
fn damage_in_a_context_costs_one_thing() {
    let good = format!(
        "{}#5=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT(.CENTI.,.RADIAN.));",
        context("LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.)", "")
    )
    .replace("(#2,#90)", "(#2,#5)");
    let (whole, notes) = told(&good);
    assert_eq!((whole.length, whole.angle, whole.tolerance, notes.len()), (10.0, 0.01, 0.02, 0));
    for (from, to, units, message) in [
        (
            "LENGTH_MEASURE(2.E-3)",
            "'?'",
            (10.0, 0.01, 1e-4),
            "tolerance ignored: #3: attribute 1 is not a finite number",
        ),
        ("((#3))", "((#77))", (10.0, 0.01, 1e-4), "tolerance ignored: #77 does not exist"),
        ("((#3))", "(#3)", (10.0, 0.01, 1e-4), "tolerance ignored: #1: attribute 1 is not a list"),
        ("2.E-3),#2", "2.E-3),#78", (10.0, 0.01, 1e-4), "tolerance ignored: #78 does not exist"),
        ("(#2,#5)", "(#2,#79)", (10.0, 1.0, 0.02), "unit ignored: #79 does not exist"),
        (
            ".CENTI.,.RADIAN.",
            ".BLURB.,.RADIAN.",
            (10.0, 1.0, 0.02),
            "angles taken as radians: #5: attribute 1 is not an SI prefix",
        ),
        ("(#2,#5)", "(#79,#5)", (1.0, 0.01, 0.02), "unit ignored: #79 does not exist"),
        ("#1=(GEO", "#99=(GEO", (1.0, 1.0, 1e-4), "units taken as millimetres: #1 does not exist"),
    ] {
        assert!(good.contains(from), "{from}");
        let (found, notes) = told(&good.replace(from, to));
        assert_eq!((found.length, found.angle, found.tolerance), units, "{from} -> {to}: {notes:?}");
        assert_eq!(notes, [message], "{from} -> {to}");
    }
}

/// Two parts of one file in centimetres and metres.
#[test]
fn each_representation_has_its_own() {
    let solid = |base: u32, unit: u32| {
        let at = |i: u32| base + i;
        format!(
            "#{}=CARTESIAN_POINT('',(1.,2.,3.));#{}=CARTESIAN_POINT('',(2.,2.,3.));#{}=CARTESIAN_POINT('',(1.,4.,3.));\
             #{}=POLY_LOOP('',(#{},#{},#{}));#{}=FACE_OUTER_BOUND('',#{},.T.);#{}=FACE('',(#{}));\
             #{}=OPEN_SHELL('',(#{}));#{}=SHELL_BASED_SURFACE_MODEL('',(#{}));\
             #{}=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#{}),#{unit});",
            at(1),
            at(2),
            at(3),
            at(4),
            at(1),
            at(2),
            at(3),
            at(5),
            at(4),
            at(6),
            at(5),
            at(7),
            at(6),
            at(8),
            at(7),
            at(9),
            at(8),
        )
    };
    let unit = |id: u32, prefix: &str| {
        format!(
            "#{id}=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#{})) REPRESENTATION_CONTEXT('',''));\
             #{}=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({prefix},.METRE.));",
            id + 1,
            id + 1
        )
    };
    let import: Import = import(&[solid(100, 10), solid(200, 20), unit(10, ".CENTI."), unit(20, "$")].concat());
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    assert_eq!(import.report.units, ["cm", "m"]);
    let bounds: Vec<_> = import.model.parts.iter().map(|p| p.bounds()).collect();
    // the triangle's plane carries it, so only coordinates across the plane are exact whatever the carrier
    assert!((bounds[0].max.z - 30.0).abs() < 1e-9 && (bounds[1].max.z - 3000.0).abs() < 1e-6, "{bounds:?}");
}
