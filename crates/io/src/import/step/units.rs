//! Units and tolerance of a representation context.
//!
//! ```text
//!   (GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#l,#a,#s))
//!    GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#u)) REPRESENTATION_CONTEXT('',''))
//!
//!   #l = (LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))                  1 mm
//!   #l = (CONVERSION_BASED_UNIT('INCH',#m) LENGTH_UNIT() NAMED_UNIT(#d))         #m: 25.4 × #mm
//!   #a = (CONVERSION_BASED_UNIT('DEGREE',#n) NAMED_UNIT(#d) PLANE_ANGLE_UNIT())  #n: 0.01745… × #rad
//! ```
//!
//! Every instance may be simple or complex: `SI_UNIT(*,.MILLI.,.METRE.)`, `LENGTH_MEASURE_WITH_UNIT(25.4,#mm)`, or as
//! CATIA V4 writes it
//!
//! ```text
//!   #u = (LENGTH_MEASURE_WITH_UNIT() MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-5),#l)
//!         UNCERTAINTY_MEASURE_WITH_UNIT('distance_accuracy_value',''))
//! ```
//!
//! Each representation has its own context; two parts of one assembly may differ. An unreadable entry has a warning,
//! and only its value is missing: the length unit, the angle unit or the tolerance.
//!
//! Source: ISO 10303-41, measure schema; ISO 10303-43, 4.4.

use super::entity::{Entity, Fault, Fields};
use super::part21::{File, Value};
use crate::import::guard::Endless;

/// The units of a representation's numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Units {
    /// Millimetres in one unit of length.
    pub length: f64,
    /// Radians in one unit of plane angle.
    pub angle: f64,
    /// Millimetres: points this close are meant to coincide.
    pub tolerance: f64,
    /// Name of the length unit.
    pub name: String,
}

/// Tolerance of a file that states none, in millimetres: what Open CASCADE assumes.
const DEFAULT_TOLERANCE: f64 = 1e-4;

/// Largest tolerance that is accepted, in millimetres; larger ones would merge features.
const MAX_TOLERANCE: f64 = 0.1;

/// Longest chain of conversions.
const MAX_DEPTH: usize = 8;

impl Default for Units {
    fn default() -> Self {
        Self { length: 1.0, angle: 1.0, tolerance: DEFAULT_TOLERANCE, name: "mm".into() }
    }
}

/// The quantity of a unit, among those read here.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Length,
    Angle,
}

impl Units {
    /// Units of the context `#id`. Missing units are millimetres and radians; `note` receives the fault of an
    /// unreadable one, which names the entity.
    pub fn of_context(file: &File<'_>, id: u32, mut note: impl FnMut(&'static str, Fault)) -> Self {
        let mut units = Self::default();
        let context = match Entity::find(file, id) {
            Ok(context) => context,
            Err(fault) => {
                note("units taken as millimetres", fault);
                return units;
            }
        };
        // a list that is no list, and members that are no references
        let members = |kind: &'static str, what: &'static str, note: &mut dyn FnMut(&'static str, Fault)| {
            let Ok(fields) = context.fields(kind, 2) else { return Vec::new() };
            let list = fields.references(0).map_err(|fault| note(what, fault)).into_iter().flatten();
            let found = list.map(|id| Entity::find(file, id?));
            found.filter_map(|entity| entity.map_err(|fault| note(what, fault)).ok()).collect::<Vec<_>>()
        };
        for unit in members("GLOBAL_UNIT_ASSIGNED_CONTEXT", "unit ignored", &mut note) {
            match kind_of(file, unit, 0) {
                Some(Kind::Length) => match length(file, unit) {
                    Ok(length) => (units.length, units.name) = length,
                    Err(fault) => note("lengths taken as millimetres", fault),
                },
                Some(Kind::Angle) => match factor(file, unit, 0) {
                    Ok(angle) => units.angle = angle,
                    Err(fault) => note("angles taken as radians", fault),
                },
                None => {}
            }
        }
        for measure in members("GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", "tolerance ignored", &mut note) {
            match tolerance(file, measure) {
                Ok(Some(tolerance)) => {
                    units.tolerance = tolerance.min(MAX_TOLERANCE);
                    break;
                }
                Ok(None) => {}
                Err(fault) => note("tolerance ignored", fault),
            }
        }
        units
    }
}

/// Millimetres of a length measure above 0; `None` for other measures.
fn tolerance(file: &File<'_>, measure: Entity<'_>) -> Result<Option<f64>, Fault> {
    let fields = value_and_unit(measure)?;
    let unit = Entity::find(file, fields.reference(1)?)?;
    if kind_of(file, unit, 0) != Some(Kind::Length) {
        return Ok(None);
    }
    Ok(Some(fields.real(0)? * length(file, unit)?.0).filter(|t| *t > 0.0))
}

/// The value and the unit of a measure with unit, whatever its other types are.
fn value_and_unit(measure: Entity<'_>) -> Result<Fields<'_>, Fault> {
    // a complex instance has them in the part MEASURE_WITH_UNIT, a simple one in front
    let simple = || {
        let mut kinds = measure.kinds();
        let alone = kinds.next().is_some_and(|k| k.ends_with("MEASURE_WITH_UNIT")) && kinds.next().is_none();
        alone.then(|| measure.all())
    };
    let fields = measure.fields("MEASURE_WITH_UNIT", 0).ok().or_else(simple);
    fields.ok_or_else(|| measure.not("a measure with unit"))
}

/// The quantity of a unit: by its own types, else by the SI unit's name, else by the unit that it is converted from.
fn kind_of(file: &File<'_>, unit: Entity<'_>, depth: usize) -> Option<Kind> {
    if unit.is("LENGTH_UNIT") {
        return Some(Kind::Length);
    }
    if unit.is("PLANE_ANGLE_UNIT") {
        return Some(Kind::Angle);
    }
    if let Ok(si) = unit.fields("SI_UNIT", 1) {
        return match si.value(1) {
            Some(Value::Enumeration("METRE")) => Some(Kind::Length),
            Some(Value::Enumeration("RADIAN")) => Some(Kind::Angle),
            _ => None,
        };
    }
    let conversion = unit.fields("CONVERSION_BASED_UNIT", 1).ok().filter(|_| depth < MAX_DEPTH)?;
    let measure = Entity::find(file, conversion.optional(1)?).ok()?;
    match measure.kinds().find_map(|k| k.strip_suffix("_MEASURE_WITH_UNIT")) {
        Some("LENGTH") => Some(Kind::Length),
        Some("PLANE_ANGLE") => Some(Kind::Angle),
        _ => kind_of(file, Entity::find(file, value_and_unit(measure).ok()?.optional(1)?).ok()?, depth + 1),
    }
}

/// Millimetres and the unit's name.
fn length(file: &File<'_>, unit: Entity<'_>) -> Result<(f64, String), Fault> {
    let millimetres = factor(file, unit, 0)? * 1000.0;
    let known = [(1000.0, "m"), (100.0, "dm"), (10.0, "cm"), (1.0, "mm"), (1e-3, "µm"), (1e-6, "nm"), (1e6, "km")];
    let known = known.iter().find(|(f, _)| (f - millimetres).abs() < 1e-9 * f).map(|(_, name)| (*name).to_owned());
    let own = || unit.fields("CONVERSION_BASED_UNIT", 1).map_or("SI unit".into(), |f| f.text(0).to_ascii_lowercase());
    Ok((millimetres, known.unwrap_or_else(own)))
}

/// SI base units (metre, radian) in one unit; conversions of conversions are followed a few steps.
fn factor(file: &File<'_>, unit: Entity<'_>, depth: usize) -> Result<f64, Fault> {
    let id = unit.id();
    if depth > MAX_DEPTH {
        return Err(Fault::Endless(Endless::Cycle(id)));
    }
    let value = if let Ok(si) = unit.fields("SI_UNIT", 1) {
        prefix(si.value(0)).ok_or(Fault::Attribute { id, index: 1, wanted: "an SI prefix" })?
    } else {
        let conversion = unit.fields("CONVERSION_BASED_UNIT", 1)?;
        let fields = value_and_unit(Entity::find(file, conversion.reference(1)?)?)?;
        fields.real(0)? * factor(file, Entity::find(file, fields.reference(1)?)?, depth + 1)?
    };
    let sane = value.is_finite() && value > 1e-30 && value < 1e30;
    if sane { Ok(value) } else { Err(Fault::Value { id, what: "the conversion factor is not a positive number" }) }
}

fn prefix(value: Option<Value<'_>>) -> Option<f64> {
    Some(match value? {
        Value::Omitted | Value::Derived => 1.0,
        Value::Enumeration(name) => match name {
            "EXA" => 1e18,
            "PETA" => 1e15,
            "TERA" => 1e12,
            "GIGA" => 1e9,
            "MEGA" => 1e6,
            "KILO" => 1e3,
            "HECTO" => 1e2,
            "DECA" => 1e1,
            "DECI" => 1e-1,
            "CENTI" => 1e-2,
            "MILLI" => 1e-3,
            "MICRO" => 1e-6,
            "NANO" => 1e-9,
            "PICO" => 1e-12,
            "FEMTO" => 1e-15,
            "ATTO" => 1e-18,
            _ => return None,
        },
        _ => return None,
    })
}
