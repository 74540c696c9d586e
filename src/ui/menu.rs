//! The bar at the top: the menus, and the most frequently used switches.

use std::path::PathBuf;

use egui::containers::menu::{MenuConfig, SubMenuButton};
use egui::{Button, MenuBar, PopupCloseBehavior, Theme, Ui};

use super::add::add_menu;
use super::commands::{Command, Next, Zoom};
use super::dialogs::Ask;
use super::examples::Examples;
use super::flying::{MAX_FACTOR, MIN_FACTOR};
use super::hint::Hinted as _;
use super::icons;
use super::layout::{Below, Layout, WindowPart};
use super::menu_entry::{ITEM_COMMANDS, entry, offer, on_click, ticked};
use super::number::{Field, drag_unlabelled};
use super::obstacles::obstacle;
use super::requests::UiRequests;
use crate::animate::{Preset, Retime};
use crate::editor::{Editor, Mode, Selection};
use crate::scene::{Aspect, Projection};
use crate::words::capitalised;

/// Shows the bar.
pub fn show(
    ui: &mut Ui,
    editor: &Editor,
    (recent, examples): (&[PathBuf], &mut Examples),
    layout: &mut Layout,
    out: &mut UiRequests,
) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file_menu(ui, (recent, examples), out));
        ui.menu_button("Edit", |ui| edit_menu(ui, editor, out));
        ui.menu_button("Add", |ui| add_menu(ui, editor.shown(), out));
        ui.menu_button("View", |ui| view_menu(ui, editor, layout, out));
        ui.menu_button("Render", |ui| {
            entry(ui, "High-res picture", Command::HighRes, out);
            entry(ui, "High-res at actual size", Command::ActualSize, out);
            entry(ui, "Save image…", Command::Ask(Ask::SaveImage), out);
            entry(ui, "Export animation…", Command::Export, out);
            ui.separator();
            if ui.button("Picture settings").clicked() {
                out.select(Selection::Render);
            }
        });
        ui.menu_button("Animate", |ui| animate_menu(ui, editor, out));
        ui.menu_button("Help", |ui| {
            entry(ui, "Find by name…", Command::Find, out);
            entry(ui, "Shortcuts", Command::Shortcuts, out);
            ui.separator();
            ui.weak(concat!("Glint ", env!("CARGO_PKG_VERSION")));
        });
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            switches(ui, editor, out);
        });
    });
}

fn file_menu(ui: &mut Ui, (recent, examples): (&[PathBuf], &mut Examples), out: &mut UiRequests) {
    entry(ui, "New", Command::Leave(Next::New), out);
    entry(ui, "Open…", Command::Leave(Next::Choose), out);
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        let menu = ui.menu_button("Open recent", |ui| {
            for path in recent {
                let name = path
                    .file_name()
                    .unwrap_or(path.as_os_str())
                    .to_string_lossy();
                let (button, hint) = (ui.button(name), path.display().to_string());
                let open = Command::Leave(Next::Open(path.clone()));
                on_click(ui, button, (&hint, open), out);
            }
        });
        if recent.is_empty() {
            menu.response.hint("No scene was opened or saved yet");
        }
    });
    ui.menu_button("Open example", |ui| examples.menu(ui, out));
    entry(ui, "Import mesh…", Command::Ask(Ask::ImportMesh), out);
    ui.separator();
    entry(ui, "Save", Command::Save, out);
    entry(ui, "Save as…", Command::Ask(Ask::SaveScene), out);
    entry(ui, "Save image…", Command::Ask(Ask::SaveImage), out);
    entry(ui, "Export animation…", Command::Export, out);
    entry(ui, "Export farm job…", Command::Ask(Ask::ExportJob), out);
    entry(
        ui,
        "Export for POV-Ray…",
        Command::Ask(Ask::ExportPovray),
        out,
    );
    ui.separator();
    entry(ui, "Quit", Command::Leave(Next::Quit), out);
}

fn edit_menu(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let step = |verb: &str, label: Option<&str>| match label {
        Some(label) => format!("{verb} “{label}”"),
        None => verb.to_owned(),
    };
    let undo = step("Undo", editor.undo_label());
    offer(ui, editor, &undo, Command::Undo, out);
    let redo = step("Redo", editor.redo_label());
    offer(ui, editor, &redo, Command::Redo, out);
    ui.separator();
    for (text, command) in ITEM_COMMANDS {
        let is_copy = command == Command::Copy;
        offer(ui, editor, text, command, out);
        if is_copy {
            entry(ui, "Paste", Command::RequestPaste, out);
        }
    }
    entry(ui, "Select all", Command::SelectAll, out);
    offer(ui, editor, "Merge equal packs", Command::MergePacks, out);
}

fn bookmark_entries(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    entry(ui, "Add this view", Command::AddBookmark, out);
    let bookmarks = &editor.scene().bookmarks;
    if !bookmarks.is_empty() {
        ui.separator();
    }
    for (index, bookmark) in bookmarks.iter().enumerate() {
        entry(ui, &bookmark.name, Command::GoToBookmark(index), out);
    }
}

fn view_menu(ui: &mut Ui, editor: &Editor, layout: &mut Layout, out: &mut UiRequests) {
    mode_entries(ui, editor, out);
    ui.separator();
    let projection = editor.shown().camera.projection;
    for kind in [Projection::Perspective, Projection::Orthographic] {
        let command = Command::Projection(kind);
        ticked(ui, projection == kind, &format!("{kind:?}"), command, out);
    }
    ui.separator();
    entry(ui, "Frame selection", Command::FrameSelected, out);
    entry(ui, "Frame everything", Command::FrameAll, out);
    ui.menu_button("Look from", |ui| {
        entry(ui, "The front", Command::ViewFront, out);
        entry(ui, "The right", Command::ViewRight, out);
        entry(ui, "Above", Command::ViewTop, out);
    });
    ui.menu_button("Bookmarked views", |ui| bookmark_entries(ui, editor, out));
    ui.separator();
    ui.menu_button("Show", |ui| {
        for (aspect, name, hint) in Aspect::EACH {
            let radio = ui.radio(layout.aspect == aspect, name);
            on_click(ui, radio, (hint, Command::Aspect(aspect)), out);
        }
    });
    ui.menu_button("Panels", |ui| panel_entries(ui, layout, out));
    ui.separator();
    part_entries(ui, layout, &WindowPart::OVER_PICTURE, out);
    let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    SubMenuButton::new("Flying speed")
        .config(stays)
        .ui(ui, |ui| {
            let field = Field {
                name: "flying speed",
                hint: "The wheel changes it while the camera flies or looks around",
                unit: "×",
                default: 1.0,
                range: MIN_FACTOR..=MAX_FACTOR,
                speed: Some(0.02),
            };
            drag_unlabelled(ui, &field, &mut layout.fly_speed);
        });
    ui.menu_button("Text and buttons", |ui| {
        entry(ui, "Larger", Command::Zoom(Zoom::In), out);
        entry(ui, "Smaller", Command::Zoom(Zoom::Out), out);
        entry(ui, "Default size", Command::Zoom(Zoom::Default), out);
    });
    ui.separator();
    theme_choice(ui, out);
}

fn part_entries(
    ui: &mut Ui,
    layout: &mut Layout,
    parts: &[(WindowPart, &str)],
    out: &mut UiRequests,
) {
    for &(part, name) in parts {
        ticked(ui, *layout.part(part), name, Command::Part(part), out);
    }
}

fn panel_entries(ui: &mut Ui, layout: &mut Layout, out: &mut UiRequests) {
    part_entries(ui, layout, &WindowPart::PANELS, out);
    for (is_on, name, command) in [
        (
            layout.below == Below::Timeline,
            "Timeline",
            Command::Timeline,
        ),
        (layout.below == Below::Lab, "Lab", Command::Lab),
        (layout.is_alone, "Picture only", Command::PictureAlone),
    ] {
        ticked(ui, is_on, name, command, out);
    }
}

fn animate_menu(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let mut offered = |ui: &mut Ui, text, command| offer(ui, editor, text, command, out);
    offered(ui, "Play or pause", Command::Play);
    offered(ui, "Record flight", Command::Record);
    offered(ui, "Stop recording", Command::StopRecording);
    ui.separator();
    offered(ui, "Add camera key", Command::AddKey);
    offered(ui, "Select all keys", Command::SelectKeys);
    offered(ui, "Previous key", Command::PreviousKey);
    offered(ui, "Next key", Command::NextKey);
    offered(ui, "Look through the shot", Command::LookThrough);
    ui.separator();
    ui.menu_button("Ready-made flight", |ui| preset_entries(ui, out));
    let obstacle = obstacle(&Command::Retime(Retime::Smooth), editor);
    ui.add_enabled_ui(obstacle.is_none(), |ui| {
        let menu = ui.menu_button("Retime", |ui| retime_entries(ui, out));
        if let Some(why) = obstacle {
            menu.response.hint(capitalised(why));
        }
    });
    ui.separator();
    entry(ui, "Import path…", Command::Ask(Ask::ImportPath), out);
    offer(
        ui,
        editor,
        "Export path…",
        Command::Ask(Ask::ExportPath),
        out,
    );
}

fn preset_entries(ui: &mut Ui, out: &mut UiRequests) {
    for preset in Preset::ALL {
        let (name, hint) = preset.words();
        let hint = format!("{hint}. Replaces the camera's keys");
        let button = ui.button(name);
        on_click(ui, button, (&hint, Command::Preset(preset)), out);
    }
}

fn retime_entries(ui: &mut Ui, out: &mut UiRequests) {
    for retime in Retime::ALL {
        let (name, hint) = retime.words();
        let button = ui.button(name);
        on_click(ui, button, (hint, Command::Retime(retime)), out);
    }
}

fn theme_choice(ui: &mut Ui, out: &mut UiRequests) {
    let shown = ui.ctx().theme();
    for (theme, name) in [(Theme::Dark, "Dark theme"), (Theme::Light, "Light theme")] {
        ticked(ui, shown == theme, name, Command::Theme(theme), out);
    }
}

fn mode_entries(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    for (mode, text, command) in [
        (Mode::Live, "Live", Command::Live),
        (Mode::LowRes, "Low-res (64 pixels)", Command::LowRes),
        (Mode::HighRes, "High-res picture", Command::HighRes),
    ] {
        ticked(ui, editor.mode == mode, text, command, out);
    }
}

/// Shows the switches from right to left: lights, projection, picture, live view.
fn switches(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let markers = editor.scene().light_visualization;
    let is_still = editor.mode == Mode::HighRes;
    let (projection, other) = match editor.shown().camera.projection {
        Projection::Perspective => ("Perspective", Projection::Orthographic),
        Projection::Orthographic => ("Orthographic", Projection::Perspective),
    };
    for (is_on, icon, text, name, hint, command) in [
        (
            markers,
            icons::LIGHT,
            "Lights",
            "Lights",
            "Show light markers (I on, U off)",
            Command::Markers(!markers),
        ),
        (
            false,
            icons::CAMERA,
            projection,
            "Projection",
            "Projection (P perspective, O orthographic); click to change",
            Command::Projection(other),
        ),
        (
            is_still,
            icons::IMAGE,
            "High-res",
            "High-res",
            "Trace the picture at full resolution (H); Esc returns to the live view",
            if is_still {
                Command::Live
            } else {
                Command::HighRes
            },
        ),
    ] {
        let switch = ui.add(Button::selectable(is_on, (icons::text(icon), text)));
        if switch.accessible_name(name).hint(hint).clicked() {
            out.commands.push(command);
        }
    }
    let name = if editor.mode == Mode::LowRes {
        "Low-res"
    } else {
        "Live"
    };
    let live = ui.add(Button::selectable(
        !is_still,
        (name, icons::text(icons::MORE)),
    ));
    let live = live
        .accessible_name("Picture mode")
        .hint("What the picture area shows");
    egui::Popup::menu(&live).show(|ui| mode_entries(ui, editor, out));
}
