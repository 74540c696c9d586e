//! Glint: a scene editor whose viewport is a CPU ray tracer.
//!
//! ```text
//!      ui (egui; panels read state, push actions)          cli
//!       │ Action ▼        ▲ Arc<Scene>, revision            │
//!     editor (document, history, flight)                    │  same calls, no thread
//!       │ submit(revision, scene, request)                  │
//!     worker (render threads; newest wins) ◄ · · · · · · ·  ┘
//!       │
//!  scene ─► animate ─► plan ─► trace ─► image ─► export ─► lab (methods ► time, error, failures)
//!    ▲                  ▲        ▲
//!  files, mesh  primitive, simd ─┘
//! ```
//!
//! The modules stand in the order of their dependence, in this file and in the `mod.rs` of every room: a
//! file imports from those above its own, and `ui` and `cli` never meet. A test reads the order and keeps
//! it. Geometry is spoken in `glam`; only kernels compute with vectors of the processor ([`simd`]).
//!
//! A primitive is its description in [`scene`] (what the file and the inspector show) and its kernels in
//! [`primitive`] (how rays meet it), with a line in the list of each, and a symbol in `ui/icons.rs`.
//!
//! A slider is dragged: its panel clones the object, the widgets change the clone, and the panel
//! pushes an [`editor::Action`]. When all panels are drawn, [`editor::Editor::apply`] checks what the new
//! scene does not share with the old one, notes the old one in the history (one drag is one step) and
//! raises the revision. The [`worker::Worker`] gets the scene in its mailbox, where it replaces any that
//! waits. A render thread makes a [`plan::Plan`], the [`trace::Tracer`] traces tiles into an
//! [`image::Image`], coarse first, and each finished picture wakes the window. A picture of an older
//! revision is never shown over a newer one.

// The blank lines keep the formatter from sorting what is in order of dependence.

pub mod words;

pub mod files;

pub mod mesh;

pub mod scene;

pub mod animate;

pub mod simd;

pub mod primitive;

pub mod plan;

pub mod trace;

pub mod image;

pub mod export;

pub mod lab;

pub mod machine;

pub mod worker;

pub mod editor;

pub mod ui;

pub mod cli;
