//! Numbers and vectors of the command line, and the messages about bad ones.

use glam::DVec3;
use selvedge::picture::FrameSettings;

/// `X,Y,Z`.
pub fn vector(text: &str) -> Result<DVec3, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => Ok(DVec3::new(x, y, z)),
        _ => Err("wants three finite numbers, as in 1,-2,0.5".into()),
    }
}

/// `NEAR,FAR`.
pub fn near_far(text: &str) -> Result<(f64, f64), String> {
    let numbers = text
        .split_once(',')
        .and_then(|(near, far)| near.trim().parse::<f64>().ok().zip(far.trim().parse::<f64>().ok()));
    let numbers = numbers.filter(|(near, far)| 0.0 < *near && near < far && far.is_finite());
    numbers.ok_or_else(|| "wants two distances above 0, the larger one last, as in 0.1,50".into())
}

/// `X,Y,Z`, not all 0.
pub fn direction(text: &str) -> Result<DVec3, String> {
    let v = vector(text)?;
    // divided first: the square of a large vector's length overflows
    let largest = v.abs().max_element();
    if largest > 0.0 { Ok((v / largest).normalize()) } else { Err("wants a direction: not 0,0,0".into()) }
}

/// A tolerance that the renderer can keep: see [`selvedge::picture::FrameSettings::tolerance_px`].
pub fn tolerance(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|t| t.is_finite() && *t >= FrameSettings::LEAST_TOLERANCE_PX)
        .ok_or_else(|| format!("wants a number of pixels, at least {}", FrameSettings::LEAST_TOLERANCE_PX))
}

/// How many times closer.
pub fn times(text: &str) -> Result<f64, String> {
    let times = text.parse::<f64>().ok().filter(|t| (1.0..=1e9).contains(t));
    times.ok_or_else(|| "wants a number from 1 to 1e9".into())
}

pub fn length(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0).ok_or_else(|| "wants a length above 0".into())
}

/// A side of a sheet of paper.
pub fn millimetres(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|x| (1.0..=10_000.0).contains(x));
    good.ok_or_else(|| "wants millimetres, from 1 to 10000".into())
}

/// A scale of a drawing.
pub fn drawing_scale(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|x| (1e-9..=1e9).contains(x));
    good.ok_or_else(|| "wants a scale above 0, as in 1 or 0.5".into())
}

pub fn mebibytes(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0).ok_or_else(|| "wants a number of MiB above 0".into())
}

/// The end of a scale of curvature.
pub fn curvature(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|k| k.is_finite() && *k > 0.0);
    good.ok_or_else(|| "wants a curvature above 0, 1/mm, as in 0.05".into())
}

/// A time; longer ones mean no limit.
pub fn seconds(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|s| *s > 0.0 && *s <= 1e9);
    good.ok_or_else(|| "wants a number of seconds above 0".into())
}

/// A magnification.
pub fn zoom(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|z| (1.0..=1e6).contains(z));
    good.ok_or_else(|| "wants a magnification from 1 to 1000000".into())
}

pub fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|&n| n > 0).ok_or_else(|| "wants a whole number above 0".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors() {
        assert_eq!(vector("-1, 2.5,3e2"), Ok(DVec3::new(-1.0, 2.5, 300.0)));
        for bad in ["1,2", "1,2,3,4", "1,2,x", "1,2,nan", ""] {
            assert!(vector(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn planes_near_and_far() {
        assert_eq!(near_far("0.1, 5e1"), Ok((0.1, 50.0)));
        for bad in ["1", "0,1", "2,1", "1,1", "-1,1", "1,inf", "nan,1", "1,2,3"] {
            assert!(near_far(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn directions() {
        assert_eq!(direction("0,0,-2"), Ok(DVec3::NEG_Z));
        for bad in ["0,0,0", "1,2", "1,2,inf"] {
            assert!(direction(bad).is_err(), "{bad}");
        }
    }
}
