//! Compares ways to choose tessellation factors, on random patches and on models: how often each exceeds half a pixel,
//! and how much finer than necessary it divides.
//!
//! `cargo bench --features baselines --bench factors -- [PATCHES [SEARCHED]] [MODEL ...]`

use glam::DVec3;
use selvedge::baselines::factors::{Spread, Way, Ways, of_model, of_random};
use selvedge::model::{Bounds, Camera};
use selvedge_io::import;
use std::path::Path;

const WAYS: [Way; 10] = [
    Way::Bound,
    Way::Homogeneous { cuts: 1 },
    Way::Homogeneous { cuts: 2 },
    Way::Corrected { segments: 3 },
    Way::Corrected { segments: 9 },
    Way::Ipass { segments: 3 },
    Way::Ipass { segments: 9 },
    Way::Fixed(4),
    Way::Fixed(16),
    Way::Fixed(64),
];

fn print(what: &str, all: &[Ways]) {
    println!("\n{what}: {} patches in the picture\n", all[0].patches);
    println!(
        "| way | > 0.5 px | worst px | clamped | quads | polynomial | rational | polynomial, depth too | rational |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    let spread = |s: Spread| if s.median.is_nan() { "-".into() } else { format!("{:.2}, {:.2}", s.median, s.most) };
    for w in all {
        println!(
            "| {:?} | {} | {:.3} | {} | {:.0} | {} | {} | {} | {} |",
            w.way,
            w.violations,
            w.worst / 2.0,
            w.unanswered,
            w.quads,
            spread(w.finer_polynomial),
            spread(w.finer_rational),
            spread(w.space_polynomial),
            spread(w.space_rational)
        );
    }
}

fn camera(bounds: Bounds, closer: f64) -> Camera {
    let mut camera = Camera::around(bounds, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 35f64.to_radians(), (1920, 1080));
    camera.eye = camera.target + (camera.eye - camera.target) / closer;
    camera.fit_depth(bounds);
    camera
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|w| w != "--bench").collect();
    let numbers: Vec<u64> = words.iter().map_while(|w| w.parse().ok()).collect();
    let count = numbers.first().copied().unwrap_or(2_000);
    let searched = numbers.get(1).copied().unwrap_or(count.min(2_000));
    if count > 0 {
        print("random, degrees 2 to 7, weights to 100 : 1", &of_random(count, searched, &WAYS));
    }
    for file in &words[numbers.len()..] {
        let import = import::open(Path::new(file)).expect("a model");
        for closer in [1.0, 8.0] {
            let camera = camera(import.model.bounds(), closer);
            print(&format!("\n{file}, {closer} x"), &of_model(&import.model, &camera, &WAYS));
        }
    }
}
