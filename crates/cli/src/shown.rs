//! Which occurrences are drawn, and in which colours: `--hide`, `--paint`.

use anyhow::{Context, Result, bail};
use clap::Args;
use selvedge::model::{Colour, Model};
use selvedge_jobs::colour;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// What differs from the file.
#[derive(Debug, Default, Args)]
pub struct ShownArgs {
    /// Leave out occurrences and Boolean solids by their numbers, as in 2,5-9: occurrences count from 1 as in the
    /// instance image of a call that hides and cuts nothing, and the file's solids come behind them; before any section
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',')]
    pub hide: Vec<Numbers>,
    /// Give an occurrence a CSS colour, by its number; an opacity below 1 makes it transparent. May be given several
    /// times
    #[arg(long, value_name = "NUMBER=COLOUR")]
    pub paint: Vec<Paint>,
}

/// Numbers from one to another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbers(RangeInclusive<usize>);

impl FromStr for Numbers {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        let numbers = first.parse::<usize>().ok().zip(last.parse::<usize>().ok());
        let numbers = numbers.filter(|(first, last)| (1..=*last).contains(first)).map(|(first, last)| first..=last);
        numbers.map(Self).ok_or_else(|| "wants numbers from 1 on, as in 2 or 5-9".into())
    }
}

/// An occurrence and its colour, linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    number: usize,
    colour: Colour,
}

impl FromStr for Paint {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (number, css) = text.split_once('=').ok_or("wants NUMBER=COLOUR, as in 3=#1e90ff")?;
        let number = number.parse().map_err(|_| "wants NUMBER=COLOUR, as in 3=#1e90ff")?;
        Ok(Self { number, colour: colour(css)? })
    }
}

impl ShownArgs {
    /// Paints and hides.
    pub fn apply(&self, model: &mut Model) -> Result<()> {
        let count = model.instances.len();
        for Paint { number, colour } in &self.paint {
            let placed = number.checked_sub(1).and_then(|nth| model.instances.get_mut(nth));
            let placed = placed.with_context(|| format!("--paint {number}: the file has {count} occurrences"))?;
            placed.colour = Some(*colour);
        }
        let all = count + model.solids.len();
        if let Some(Numbers(far)) = self.hide.iter().find(|numbers| *numbers.0.end() > all) {
            bail!("--hide {}: the file has {all} occurrences and solids", far.end());
        }
        let hidden: BTreeSet<usize> = self.hide.iter().flat_map(|numbers| numbers.0.clone()).collect();
        if all > 0 && hidden.len() == all {
            bail!("--hide leaves nothing of the file");
        }
        let mut number = 0;
        let mut stays = || {
            number += 1;
            !hidden.contains(&number)
        };
        model.instances.retain(|_| stays());
        model.solids.retain(|_| stays());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DVec3};
    use selvedge::model::{Instance, Primitive, Shape, Solid};

    #[test]
    fn numbers_and_paints() {
        assert_eq!(("7".parse(), "5-9".parse()), (Ok(Numbers(7..=7)), Ok(Numbers(5..=9))));
        for bad in ["", "0", "0-3", "5-4", "x", "1-", "-2"] {
            assert!(bad.parse::<Numbers>().is_err(), "{bad}");
        }
        assert_eq!("3=rgb(0 0 255 / 25%)".parse(), Ok(Paint { number: 3, colour: [0.0, 0.0, 1.0, 0.25] }));
        for bad in ["3", "x=red", "3=reddish"] {
            assert!(bad.parse::<Paint>().is_err(), "{bad}");
        }
    }

    /// Three occurrences of parts that are not there, and two blocks.
    #[test]
    fn numbers_count_occurrences_first_and_solids_behind_them() {
        let placed = |x: f64| {
            let transform = DAffine3::from_translation(DVec3::X * x);
            Instance { part: 0, transform, colour: None, name: String::new() }
        };
        let block = |id| {
            let shape = Shape::Block { min: DVec3::ZERO, max: DVec3::ONE };
            Solid::of(Primitive { shape, transform: DAffine3::IDENTITY, colour: [0.5; 4], id }).expect("a block")
        };
        let whole = || Model {
            instances: [1.0, 2.0, 3.0].map(placed).to_vec(),
            solids: [1, 2].map(block).to_vec(),
            ..Model::default()
        };
        let left = |hide: &[&str]| {
            let hide = hide.iter().map(|text| text.parse().expect("numbers")).collect();
            let mut model = whole();
            let args = ShownArgs { hide, paint: vec!["2=#ff0000".parse().expect("a paint")] };
            args.apply(&mut model).map_err(|error| error.to_string())?;
            let places = model.instances.iter().map(|i| (i.transform.translation.x, i.colour.is_some()));
            let ids = model.solids.iter().map(|solid| solid.primitives()[0].id);
            Ok::<_, String>((places.collect::<Vec<_>>(), ids.collect::<Vec<_>>()))
        };
        assert_eq!(left(&[]), Ok((vec![(1.0, false), (2.0, true), (3.0, false)], vec![1, 2])));
        assert_eq!(left(&["1", "3-4"]), Ok((vec![(2.0, true)], vec![2])));
        assert!(left(&["6"]).is_err_and(|why| why.contains("5 occurrences")));
        assert!(left(&["1-5"]).is_err_and(|why| why.contains("nothing")));
    }
}
