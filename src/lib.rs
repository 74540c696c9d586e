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
//! The modules are listed in the order of their dependencies, here and in every `mod.rs`: a file imports only from
//! modules above its own, and `ui` and `cli` never import each other. A test checks this order. Geometry uses `glam`;
//! only kernels compute with SIMD vectors ([`simd`]).
//!
//! A primitive consists of its description in [`scene`] (what the file and the inspector show) and its kernels in
//! [`primitive`] (how rays hit it), with a line in the list of each, a symbol in `ui/icons.rs`, and what the compiler
//! then asks for.
//!
//! What happens when a slider is dragged: the panel clones the object, the widgets change the clone, and the panel
//! pushes an [`editor::Action`]. After all panels are drawn, [`editor::Editor::apply`] checks what the new scene does
//! not share with the old one, records the old one in the history (a drag is one undo step) and increments the
//! revision. The [`worker::Worker`] receives the scene in its mailbox, where it replaces any that is waiting. A
//! render thread makes a [`plan::Plan`], the [`trace::Tracer`] traces tiles into an [`image::Image`], coarse first,
//! and each finished picture wakes the window. A picture of an older revision never replaces a newer one.

// The blank lines keep rustfmt from sorting the modules, which are in the order of their dependencies.

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
