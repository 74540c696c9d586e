//! Glint: a scene editor whose viewport is a CPU ray tracer.

pub mod lanes;

pub mod scene;

pub mod plan;

pub mod trace;

pub mod image;

pub mod export;

pub mod worker;

pub mod editor;

pub mod ui;

pub mod cli;
