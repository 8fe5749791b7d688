//! Memory of the process: alone in this file, since other tests of one process would take some of it.

use selvedge_jobs::{Bound, Limits, Work, resident};
use std::hint::black_box;

#[test]
fn memory_is_that_of_the_process() {
    let before = resident().expect("the system tells");
    assert!(before > 1 << 20, "{before} bytes");
    let most = before + (64 << 20);
    let limits = Limits::new("a.step", None, Some(most));
    assert_eq!(limits.begin(Work::Reading).test(), Ok(()));
    let large = black_box(vec![1_u8; 128 << 20]);
    let step = limits.begin(Work::Reading);
    let late = step.test().expect_err("twice as much");
    let Bound::Memory { most: told, held } = late.bound else { panic!("{late}") };
    assert!(told == most && held > most, "{late}");
    let [most, held] = [most, held].map(|bytes| bytes as f64 / f64::from(1 << 20));
    let text = format!("reading it takes more memory than the limit of {most:.1} MiB: {held:.1} MiB");
    assert_eq!(late.to_string(), format!("a.step: {text}"));
    drop(large);
    assert!(step.test().is_err(), "other threads see it, too");
}
