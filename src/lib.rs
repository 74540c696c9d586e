//! Glint: a scene editor whose viewport is a CPU ray tracer.
//!
//! ```text
//!      ui (egui; panels read state, push actions)          cli
//!       │ Action ▼        ▲ Arc<Scene>, revision            │
//!     editor (state, actions, history, playing)             │  same calls, no lane
//!       │ submit(revision, scene, picture)                  │
//!     worker (the background lane; newest wins) ◄ · · · · · ┘
//!       │
//!  scene ─► animate ─► plan ─► trace ─► image ─► export      lab (ways of tracing ► time, error)
//!                                 ▲
//!                           lanes ┘
//! ```
//!
//! The modules stand in the order of their dependence: a file imports from its own module and from
//! those above it, and `ui` and `cli` never meet. A test reads this file and keeps the order.
//!
//! A slider is dragged: its panel clones the object, the widgets change the clone, and the panel
//! pushes an [`editor::Action`]. When all panels are drawn, [`editor::Editor::apply`] checks the new
//! scene, notes the old one in the history (one drag is one step) and raises the revision. The
//! [`worker::Worker`] gets the scene in its mailbox, where it replaces any that waits. The lane
//! makes a [`plan::Plan`], the [`trace::Tracer`] traces tiles into an [`image::Image`], coarse
//! first, and each finished picture wakes the window. A picture of an older revision is never shown
//! over a newer one.

// The blank lines keep the formatter from sorting what is in order of dependence.

pub mod files;

pub mod scene;

pub mod animate;

pub mod simd;

pub mod primitive;

pub mod plan;

pub mod trace;

pub mod image;

pub mod lab;

pub mod export;

pub mod worker;

pub mod editor;

pub mod ui;

pub mod cli;
