//! Editing state that outlives a frame but not the program: the open document, the selection, the undo history, the
//! flight. Panels read this state and push [`Action`]s, which [`Editor::apply`] carries out; methods of [`Editor`]
//! open and save documents. No dependency on widgets.

mod item;

mod selection;

mod names;

mod arrange;

mod adding;

mod clipboard;

mod edit;

mod fly;

mod timeline;

mod history;

mod action;

mod animation_state;

mod own_file;

mod document;

mod messages;

mod outside;

mod flight;

pub use action::{Action, Message, Mode};
pub use adding::marker_radius;
pub use arrange::Arrangement;
pub use clipboard::{excerpt, read};
pub use document::Editor;
pub use edit::{Edit, EditError};
pub use fly::{Motion, set_orthographic_height};
pub use item::{Item, ItemKind};
pub use messages::replaced_flight;
pub use names::{free_bookmark_name, free_group_name};
pub use own_file::OwnFile;
pub use selection::Selection;
pub use timeline::{Repeat, Time, Timeline};

#[cfg(test)]
mod tests;
