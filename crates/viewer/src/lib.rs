//! A window for CAD files: look, pick, measure and cut exact surfaces, at every zoom.
//!
//! ```text
//!   files ─▶ session (open files and how they are shown) ─▶ engine ─▶ picture ─▶ window
//!               ▲                                                      │
//!               ╰── pick, describe, measure ◀── images of faces, edges ─╯      navigation: the hand moves the camera
//! ```
//!
//! | module | content |
//! |---|---|
//! | [`navigation`] | orbit, zoom, pan, presets of mice, standard views, view cube, transitions: pure functions |
//! | [`view`] | the camera that the mouse moves, and the next picture |
//! | [`pacing`] | fewer pixels and effects while the view moves |
//! | [`session`] | open files, visibility, colours, sections, selection, undo |
//! | [`pick`], [`describe`], [`measure`] | items and points under the cursor, their description, sizes and distances |
//! | [`panels`], [`commands`] | the panels around the picture, and the commands |
//! | [`settings`], [`watch`], [`desktop`] | stored settings; files that change on the disk; the desktop's settings |
//! | [`run`] | the window itself |
//!
//! The viewer uses the engine as any host does.
#![warn(missing_docs)]

pub mod commands;
pub mod describe;
pub mod desktop;
pub mod measure;
pub mod navigation;
pub mod pacing;
pub mod panels;
pub mod pick;
pub mod session;
pub mod settings;
pub mod view;
pub mod watch;
mod window;

pub use window::{Closed, Fault, Faults, ViewError, ViewOptions, run};
