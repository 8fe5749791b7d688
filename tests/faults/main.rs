//! A driver that fails: every call that may return an error does so once, by a double of the driver (`driver`).
//!
//! Under the null driver no picture is drawn, so that each call of the script has its turn. Pictures after a failure are
//! compared on the system's driver.

mod driver;
mod host;
mod memory;
mod pictures;
mod script;
#[path = "../shapes/mod.rs"]
mod shapes;
