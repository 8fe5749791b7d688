//! A window for CAD files: look, pick, measure and cut exact surfaces, at every zoom.
//!
//! ```text
//!   files ─▶ session (what is open and how it is shown) ─▶ engine ─▶ picture ─▶ window
//!               ▲                                                      │
//!               ╰── pick, describe, measure ◀── images of faces, edges ─╯      navigation: the hand moves the camera
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | [`navigation`] | orbit, zoom, pan, presets of mice, standard views, view cube, transitions: pure functions |
//! | [`view`] | the camera in the hand, and which picture is due |
//! | [`pacing`] | fewer pixels while the view moves |
//! | [`session`] | open files, visibility, colours, sections, selection, undo |
//! | [`pick`], [`describe`], [`measure`] | what lies under the cursor, what it is, how large and how far |
//! | [`panels`], [`commands`] | what a person sees and asks for |
//! | [`settings`], [`watch`] | what is remembered; files that change on the disk |
//! | [`run`] | the window itself |
//!
//! The viewer uses the engine as any host does.
#![warn(missing_docs)]

pub mod commands;
pub mod describe;
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

pub use window::{Closed, ViewError, ViewOptions, run};
