//! The global section: delimiters, units, the program that wrote the file.
//!
//! ```text
//!   1H,,1H;,7Hproduct,8Hpart.igs,6Hsystem,4Hpre1,32,38,6,308,15,7Hproduct,1.0,2,2HMM,1,0.1,
//!    1   2      3         4         5      6     7  8 9 10  11     12      13 14 15  16 17
//!   13H260616.222820,0.0004,37770.,4HName,3HOrg,11,0;
//!          18          19     20     21    22   23 24
//! ```

use super::value::{Delimiters, Value, record};
use crate::import::text::Encoding;
use crate::import::{Place, Warnings};

/// What the section says, with the standard's defaults.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Global {
    pub delimiters: Delimiters,
    /// Millimetres per unit of the model space.
    pub unit: f64,
    /// Name of the unit.
    pub unit_name: String,
    /// Shortest distance in millimetres that counts.
    pub resolution: f64,
    /// Product, as the sender calls it.
    pub product: String,
    /// System and preprocessor.
    pub system: String,
    /// `5.3` for 11.
    pub version: &'static str,
}

/// Units by number and name: millimetres each (parameters 14 and 15).
const UNITS: [(u32, &[&str], f64); 10] = [
    (1, &["INCH", "IN"], 25.4),
    (2, &["MM"], 1.0),
    (4, &["FT"], 304.8),
    (5, &["MI"], 1_609_344.0),
    (6, &["M"], 1e3),
    (7, &["KM"], 1e6),
    (8, &["MIL"], 0.0254),
    (9, &["UM"], 1e-3),
    (10, &["CM"], 10.0),
    (11, &["UIN"], 25.4e-6),
];

const VERSIONS: [&str; 12] = ["", "1.0", "2.0", "2.0", "2.0", "3.0", "3.0", "4.0", "4.0", "5.1", "5.2", "5.3"];

impl Global {
    /// Reads the text of the section's cards, 72 columns each.
    pub fn read(text: &[u8], encoding: Encoding, line: usize, warnings: &mut Warnings) -> Self {
        let warn = |warnings: &mut Warnings, message: String| {
            warnings.push("global section", || Place::Line(line), || message);
        };
        let (delimiters, start, given) = delimiters(text);
        let mut values = vec![Value::Empty; given];
        if record(text, (start, text.len()), delimiters, &mut values).is_none() {
            warn(warnings, "it does not end with a record delimiter".into());
        }
        let value = |index: usize| values.get(index - 1).copied().unwrap_or(Value::Empty);
        let string = |index: usize| match value(index) {
            Value::Text(a, b) => encoding.decode(&text[a as usize..b as usize]).trim().to_owned(),
            _ => String::new(),
        };
        let real = |index: usize| match value(index) {
            Value::Number(x) if x.is_finite() => Some(x),
            _ => None,
        };
        let flag = real(14).unwrap_or(1.0);
        let name = string(15).to_ascii_uppercase();
        let by_flag = UNITS.iter().find(|u| f64::from(u.0) == flag);
        let by_name = UNITS.iter().find(|u| u.1.contains(&name.as_str()));
        let unit = match (by_flag, by_name) {
            (Some(flag), _) => flag,
            (None, Some(name)) => name,
            (None, None) => {
                warn(warnings, format!("unit {flag} {name:?} is not known, millimetres are assumed"));
                &UNITS[1]
            }
        };
        if let (Some(flag), Some(name)) = (by_flag, by_name)
            && flag != name
        {
            warn(warnings, format!("unit {} and name {} disagree, the number counts", flag.0, name.1[0]));
        }
        let mut scale = real(13).unwrap_or(1.0);
        if !(scale > 0.0 && (1.0 / scale).is_finite()) {
            warn(warnings, format!("the scale {scale} is not positive, 1 is assumed"));
            scale = 1.0;
        }
        // a scale of 0.125: one unit of the model is eight units of the real object
        let millimetres = unit.2 / scale;
        let version = real(23).filter(|v| (0.0..12.0).contains(v)).map_or("", |v| VERSIONS[v as usize]);
        let resolution = real(19).filter(|r| *r > 0.0).unwrap_or(0.0) * unit.2;
        let system = [string(5), string(6)].join(" ").trim().to_owned();
        let unit_name = unit.1[0].to_ascii_lowercase();
        Self { delimiters, unit: millimetres, unit_name, resolution, product: string(3), system, version }
    }
}

/// The two delimiters, where the third parameter starts, and how many were given.
fn delimiters(text: &[u8]) -> (Delimiters, usize, usize) {
    let mut found = Delimiters::default();
    let mut at = text.iter().position(|b| *b != b' ').unwrap_or(text.len());
    let usable = |b: u8| b.is_ascii_graphic() && !b.is_ascii_alphanumeric() && !b"+-.".contains(&b);
    if let [b'1', b'H', chosen, ..] = text[at..]
        && usable(chosen)
    {
        found.parameter = chosen;
        at += 3;
    }
    if text.get(at) != Some(&found.parameter) {
        return (found, at, 0);
    }
    at += 1;
    at += text[at..].iter().take_while(|b| **b == b' ').count();
    if let [b'1', b'H', chosen, ..] = text[at..]
        && usable(chosen)
    {
        found.record = chosen;
        at += 3;
    }
    if text.get(at) != Some(&found.parameter) {
        return (found, at, 1);
    }
    (found, at + 1, 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::ImportReport;

    fn read(text: &str) -> (Global, Vec<String>) {
        let mut warnings = Warnings::new("g.igs");
        let global = Global::read(text.as_bytes(), Encoding::default(), 2, &mut warnings);
        (global, warnings.finish(&mut ImportReport::default()).iter().map(ToString::to_string).collect())
    }

    #[test]
    fn defaults_and_choices() {
        let (g, w) = read(",,4Hpart,1Hf,3Hsys,3Hpre,32,38,6,308,15,1Hp,1.,1,4HINCH,1,0.01,1Hd,1.E-4,9.,1Ha,1Ho,11,0;");
        assert!(w.is_empty(), "{w:?}");
        assert_eq!((g.delimiters, g.unit, g.version), (Delimiters::default(), 25.4, "5.3"));
        assert_eq!((g.product.as_str(), g.system.as_str()), ("part", "sys pre"));
        assert!((g.resolution - 25.4e-4).abs() < 1e-18, "{}", g.resolution);
        let (g, w) = read("1H|| 1H#|4Hpart||||||||||0.125|6|1HM#");
        assert!(w.is_empty(), "{w:?}");
        assert_eq!((g.delimiters, g.unit), (Delimiters { parameter: b'|', record: b'#' }, 8e3));
    }

    #[test]
    fn impossible_values_are_reported() {
        let says = |text: &str, what: &str| {
            let (_, w) = read(text);
            assert!(w.len() == 1 && w[0].starts_with("g.igs:2: global section: ") && w[0].contains(what), "{w:?}");
        };
        says(",,,,,,,,,,,,1.,3,5HCUBIT;", "unit 3 \"CUBIT\" is not known, millimetres are assumed");
        says(",,,,,,,,,,,,1.,1,2HMM;", "unit 1 and name MM disagree, the number counts");
        says(",,,,,,,,,,,,-2.,2,2HMM;", "the scale -2 is not positive");
        says(",,,,,,,,,,,,1.,2,2HMM", "does not end with a record delimiter");
    }
}
