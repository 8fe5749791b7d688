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
//! Each representation has its own context; two parts of one assembly may differ.
//!
//! Source: ISO 10303-41, measure schema; ISO 10303-43, 4.4.

use super::entity::{Entity, Fault};
use super::part21::File;

/// What the numbers of a representation mean.
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

/// Largest tolerance taken at its word, in millimetres; larger ones would merge features.
const MAX_TOLERANCE: f64 = 0.1;

impl Default for Units {
    fn default() -> Self {
        Self { length: 1.0, angle: 1.0, tolerance: DEFAULT_TOLERANCE, name: "mm".into() }
    }
}

impl Units {
    /// Units of the context `#id`; what it does not state is millimetres and radians.
    pub fn of_context(file: &File<'_>, id: u32) -> Result<Self, Fault> {
        let mut units = Self::default();
        let context = Entity::find(file, id)?;
        if let Ok(fields) = context.fields("GLOBAL_UNIT_ASSIGNED_CONTEXT", 2) {
            for unit in fields.references(0)? {
                let unit = Entity::find(file, unit?)?;
                if unit.is("LENGTH_UNIT") {
                    (units.length, units.name) = length(file, unit)?;
                } else if unit.is("PLANE_ANGLE_UNIT") {
                    units.angle = factor(file, unit, 0)?;
                }
            }
        }
        if let Ok(fields) = context.fields("GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", 2) {
            for measure in fields.references(0)? {
                let measure = Entity::find(file, measure?)?;
                let Ok(fields) = measure.fields("UNCERTAINTY_MEASURE_WITH_UNIT", 0) else { continue };
                let unit = Entity::find(file, fields.reference(1)?)?;
                if unit.is("LENGTH_UNIT") {
                    let tolerance = fields.real(0)? * length(file, unit)?.0;
                    units.tolerance = if tolerance > 0.0 { tolerance.min(MAX_TOLERANCE) } else { units.tolerance };
                    break;
                }
            }
        }
        Ok(units)
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
    const MAX_DEPTH: usize = 8;
    let id = unit.id();
    if depth > MAX_DEPTH {
        return Err(Fault::Cycle(id));
    }
    let value = if let Ok(si) = unit.fields("SI_UNIT", 1) {
        prefix(si.value(0)).ok_or(Fault::Attribute { id, index: 1, wanted: "an SI prefix" })?
    } else {
        let conversion = unit.fields("CONVERSION_BASED_UNIT", 1)?;
        let measure = Entity::find(file, conversion.reference(1)?)?;
        let kinds = ["LENGTH_MEASURE_WITH_UNIT", "PLANE_ANGLE_MEASURE_WITH_UNIT", "MEASURE_WITH_UNIT"];
        // in a complex instance the attributes stand in the part MEASURE_WITH_UNIT
        let fields = kinds.iter().rev().find_map(|k| measure.fields(k, 0).ok());
        let fields = fields.ok_or_else(|| measure.not("a measure with unit"))?;
        fields.real(0)? * factor(file, Entity::find(file, fields.reference(1)?)?, depth + 1)?
    };
    let sane = value.is_finite() && value > 1e-30 && value < 1e30;
    if sane { Ok(value) } else { Err(Fault::Value { id, what: "the conversion factor is not a positive number" }) }
}

fn prefix(value: Option<super::part21::Value<'_>>) -> Option<f64> {
    use super::part21::Value;
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
