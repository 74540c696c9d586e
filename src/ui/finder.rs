//! The finder: looks up commands, things of the scene and settings by name.

use std::path::PathBuf;

use egui::{
    Align2, AtomExt as _, Button, Context, Frame, Id, Key, Modal, Modifiers, ScrollArea, TextEdit,
    Ui, vec2,
};
use indexmap::IndexSet;

use super::add::Addition;
use super::commands::{self, Command, Next, Zoom, key_name};
use super::dialogs::Ask;
use super::hint::Hinted as _;
use super::layout::WindowPart;
use super::obstacles::obstacle;
use super::requests::UiRequests;
use super::theme::{GRID, ROW};
use crate::animate::{Preset, Retime};
use crate::editor::{Editor, Item, Selection};
use crate::scene::{Aspect, EXAMPLES};

/// Width of the window in points.
const WIDTH: f32 = 460.0;
/// Greatest height of the list, in points.
const HEIGHT: f32 = 12.0 * ROW;
/// Distance of the finder from the upper border of the window, in points.
const TOP: f32 = 5.0 * ROW;
/// Most matches that are listed.
const MAX_MATCHES: usize = 200;

/// The state of the finder.
#[derive(Debug, Default)]
pub struct Finder {
    /// Whether the finder is shown.
    pub is_open: bool,
    text: String,
    /// What matches the text, found in this revision of the document; `None` until it is looked for.
    found: Option<(u64, Vec<Match>)>,
    /// Index of the marked match.
    marked: usize,
}

/// A match.
#[derive(Debug)]
struct Match {
    name: String,
    /// Text on the right: its keys, its kind, or why it is not possible.
    right_text: String,
    target: Target,
    is_enabled: bool,
}

impl Match {
    /// Creates a match that is possible.
    fn of(name: String, right_text: &str, target: Target) -> Self {
        Self {
            name,
            right_text: right_text.to_owned(),
            target,
            is_enabled: true,
        }
    }
}

#[derive(Clone, Debug)]
enum Target {
    Command(Command),
    Selection(Selection),
    Group(String),
    Addition(Addition),
}

/// Other names of commands in menus and buttons, or other words for them, in lower case.
const ALIASES: [(Command, &str); 24] = [
    (Command::Ask(Ask::SaveScene), "save as"),
    (Command::Ask(Ask::SaveImage), "save image render"),
    (Command::HighRes, "render"),
    (Command::Export, "render frames video mp4 gif png"),
    (Command::PutDown, "put down drop on the floor"),
    (Command::Ask(Ask::ExportJob), "export farm job"),
    (Command::AddKey, "add key"),
    (Command::AddBookmark, "add this view"),
    (Command::FrameSelected, "frame what is selected zoom to"),
    (Command::FrameAll, "frame everything zoom out"),
    (Command::Timeline, "panel frames per second fps"),
    (Command::Delete, "remove delete key"),
    (Command::Lab, "panel measure stability chart"),
    (Command::PictureAlone, "picture only alone fullscreen"),
    (Command::ViewFront, "look from the front"),
    (Command::ViewRight, "look from the right"),
    (Command::ViewTop, "look from the top"),
    (Command::MoveUp, "move up in the list"),
    (Command::MoveDown, "move down in the list"),
    (Command::SelectSamePack, "select all with this pack"),
    (Command::Shortcuts, "help keys shortcuts"),
    (Command::Zoom(Zoom::In), "zoom in"),
    (Command::Zoom(Zoom::Out), "zoom out"),
    (Command::Zoom(Zoom::Default), "reset zoom"),
];

/// Other words for what can be added, in lower case.
const ADDITION_ALIASES: [(&str, &str); 6] = [
    ("Add Sphere", "ball"),
    ("Add Plane", "floor ground wall"),
    ("Add Disc", "circle coin"),
    ("Add Box", "cube"),
    ("Add Light", "lamp sun"),
    ("Add ColorPack", "material colour"),
];

impl Finder {
    /// Opens the finder with an empty field.
    pub fn open(&mut self) {
        *self = Self {
            is_open: true,
            ..Self::default()
        };
    }

    /// Shows the field and its matches while the finder is open.
    pub fn show(
        &mut self,
        ctx: &Context,
        editor: &Editor,
        recent: &[PathBuf],
        out: &mut UiRequests,
    ) {
        if !self.is_open {
            return;
        }
        let frame = Frame::popup(&ctx.global_style()).inner_margin(GRID);
        // The field stays in place, however many matches there are.
        let id = Id::unique("finder");
        let area = Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, TOP));
        let modal = Modal::new(id).area(area).frame(frame);
        let shown = modal.show(ctx, |ui| {
            ui.set_width(WIDTH);
            self.show_search(ui, (editor, recent))
        });
        if shown.inner.is_some() || shown.should_close() {
            self.is_open = false;
            // Otherwise, a later paste would go to the field.
            ctx.memory_mut(egui::Memory::stop_text_input);
        }
        if let Some(target) = shown.inner {
            match target {
                Target::Command(command) => out.commands.push(command),
                Target::Selection(selection) => out.select(selection),
                Target::Group(name) => out.select(Selection::of_group(editor.scene(), &name)),
                Target::Addition(addition) => out.edit(addition.edit(editor.shown())),
            }
        }
    }

    fn show_search(&mut self, ui: &mut Ui, sources: (&Editor, &[PathBuf])) -> Option<Target> {
        let step = |ui: &mut Ui, key: Key| {
            ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key))
        };
        let (down, up) = (step(ui, Key::ArrowDown), step(ui, Key::ArrowUp));
        let field = TextEdit::singleline(&mut self.text)
            .hint_text("Command, object, light, color pack or setting")
            .desired_width(f32::INFINITY)
            .align(Align2::LEFT_CENTER);
        let field = ui.add(field).hint("Enter runs the highlighted entry");
        field.request_focus();
        if field.changed() {
            (self.marked, self.found) = (0, None);
            // The first frame after typing into an empty field shows nothing.
            ui.request_repaint();
        }
        // A scene may have very many things.
        let revision = sources.0.revision();
        let found = self.found.take().filter(|(of, _)| *of == revision);
        let found = found.unwrap_or_else(|| (revision, find_matches(ui, sources, &self.text)));
        let matches = &self.found.insert(found).1;
        let last = matches.len().saturating_sub(1);
        self.marked = (self.marked + down).saturating_sub(up).min(last);
        let is_entered = ui.input(|input| input.key_pressed(Key::Enter));
        let mut chosen = is_entered.then_some(self.marked);
        ui.add_space(GRID / 2.0);
        ScrollArea::vertical()
            .max_height(HEIGHT)
            // Without this, the list would stay as small as in the last frame, which may have had few matches.
            .min_scrolled_height(HEIGHT)
            .auto_shrink([false, true])
            .show(ui, |ui| {
                for (index, entry) in matches.iter().enumerate() {
                    let name = egui::RichText::new(&entry.name).atom_shrink(true);
                    let button = Button::selectable(index == self.marked, name)
                        .truncate()
                        .right_text(&entry.right_text)
                        .min_size(vec2(ui.available_width(), ROW));
                    let shown = ui.add_enabled(entry.is_enabled, button);
                    if index == self.marked && (down > 0 || up > 0) {
                        shown.scroll_to_me(None);
                    }
                    if shown.accessible_name(&entry.name).clicked() {
                        chosen = Some(index);
                    }
                }
            });
        if matches.is_empty() {
            ui.weak("Nothing found");
        }
        let entry = matches.get(chosen?)?;
        entry.is_enabled.then(|| entry.target.clone())
    }
}

/// Returns everything whose name contains all the words: possible things first, then those that begin with the text,
/// then those in which words begin with all of its words, the shortest first.
fn find_matches(ui: &Ui, (editor, recent): (&Editor, &[PathBuf]), text: &str) -> Vec<Match> {
    let text = text.trim().to_lowercase();
    let words: Vec<&str> = text.split_whitespace().collect();
    let matches_query = |name: &str| {
        let name = name.to_lowercase();
        words.iter().all(|word| name.contains(word))
    };
    let named = commands(ui, editor, recent).chain(additions());
    let mut matches: Vec<Match> = named
        .filter(|entry| matches_query(&format!("{} {}", entry.name, aliases_of(entry))))
        .collect();
    matches.extend(settings(editor).filter_map(|(entry, aliases)| {
        matches_query(&format!("{} {} {aliases}", entry.name, entry.right_text)).then_some(entry)
    }));
    // A scene may have very many things: those are left out that would come last.
    let room = MAX_MATCHES.saturating_sub(matches.len());
    let begins = |name: &str| name.to_lowercase().starts_with(&text);
    let first = scene_items(editor, |name| matches_query(name) && begins(name));
    let others = scene_items(editor, |name| matches_query(name) && !begins(name));
    matches.extend(first.chain(others).take(room));
    matches.sort_by_cached_key(|entry| {
        let rank = rank((&entry.name, aliases_of(entry)), &text);
        (!entry.is_enabled, rank)
    });
    matches
}

/// Returns how well a name, and other words for it, match what is searched for, the best first: 0 if the name begins with
/// the text; the number of its words, if some words begin with all words of the text; the greatest number otherwise.
fn rank((name, aliases): (&str, &str), text: &str) -> usize {
    let name = name.to_lowercase();
    let words = |text: &str| -> Vec<String> {
        let words = text.split(|letter: char| !letter.is_alphanumeric());
        words
            .filter(|word| !word.is_empty())
            .map(str::to_owned)
            .collect()
    };
    let (own, others) = (words(&name), words(aliases));
    let begins_word = |word: &str| own.iter().chain(&others).any(|own| own.starts_with(word));
    if name.starts_with(text) {
        0
    } else if text.split_whitespace().all(begins_word) {
        own.len()
    } else {
        usize::MAX
    }
}

fn commands<'a>(
    ui: &'a Ui,
    editor: &'a Editor,
    recent: &'a [PathBuf],
) -> impl Iterator<Item = Match> + 'a {
    let all = commands::all();
    let all = all.filter(|(command, ..)| !matches!(command, Command::Find | Command::Escape));
    let all = all.map(|(command, what, keys)| {
        let keys = keys.map_or(String::new(), |keys| key_name(ui, keys));
        (command.clone(), what.to_owned(), keys)
    });
    all.chain(choices(editor, recent))
        .map(|(command, name, keys)| {
            let obstacle = obstacle(&command, editor);
            Match {
                name,
                right_text: obstacle.map_or(keys, str::to_owned),
                is_enabled: obstacle.is_none(),
                target: Target::Command(command),
            }
        })
}

/// Returns the other names of a match.
fn aliases_of(entry: &Match) -> &'static str {
    let words = match &entry.target {
        Target::Command(own) => {
            let mut aliases = ALIASES.iter();
            aliases.find_map(|(command, words)| (command == own).then_some(*words))
        }
        Target::Addition(_) | Target::Selection(_) | Target::Group(_) => {
            let mut aliases = ADDITION_ALIASES.iter();
            aliases.find_map(|(name, words)| (entry.name == *name).then_some(*words))
        }
    };
    words.unwrap_or_default()
}

/// Yields the entries of the menu *Add*.
fn additions() -> impl Iterator<Item = Match> {
    Addition::all().map(|(addition, _, name)| Match::of(name, "", Target::Addition(addition)))
}

/// Yields the entries of submenus, with their names and the text on the right.
fn choices<'a>(
    editor: &'a Editor,
    recent: &'a [PathBuf],
) -> impl Iterator<Item = (Command, String, String)> + 'a {
    let shown = Aspect::EACH.map(|(aspect, name, _)| ("Show", name, Command::Aspect(aspect)));
    let presets = Preset::ALL.map(|preset| {
        let name = preset.words().0;
        ("Ready-made flight", name, Command::Preset(preset))
    });
    let timings = Retime::ALL.map(|timing| ("Retime", timing.words().0, Command::Retime(timing)));
    let panels =
        WindowPart::PANELS.map(|(part, name)| ("Show or hide panel", name, Command::Part(part)));
    let parts =
        WindowPart::OVER_PICTURE.map(|(part, name)| ("Show or hide", name, Command::Part(part)));
    let fixed = shown
        .into_iter()
        .chain(presets)
        .chain(timings)
        .chain(panels)
        .chain(parts);
    let fixed =
        fixed.map(|(verb, name, command)| (command, format!("{verb}: {}", name.to_lowercase())));
    let examples = EXAMPLES.iter().enumerate().map(|(index, example)| {
        (
            Command::Leave(Next::Example(index)),
            format!("Open example: {}", example.name),
        )
    });
    let bookmarks = editor.scene().bookmarks.iter().enumerate();
    let bookmarks = bookmarks.map(|(index, bookmark)| {
        (
            Command::GoToBookmark(index),
            format!("Go to bookmark: {}", bookmark.name),
        )
    });
    let all = fixed.chain(examples).chain(bookmarks);
    let all = all.map(|(command, name)| (command, name, String::new()));
    let recent = recent.iter().map(|path| {
        let name = path.file_name().unwrap_or(path.as_os_str());
        let name = format!("Open recent: {}", name.to_string_lossy());
        let folder = path
            .parent()
            .map_or(String::new(), |it| it.display().to_string());
        (Command::Leave(Next::Open(path.clone())), name, folder)
    });
    all.chain(recent)
}

/// Returns the selected color pack, or that of the selected object or marker.
fn pack_of_selected(editor: &Editor) -> Option<Item> {
    let (scene, item) = (editor.scene(), editor.selection().item()?);
    let name = item.color_pack(scene)?;
    scene.color_packs.get_index_of(name).map(Item::pack)
}

/// Yields the entries at the top of the outliner and the settings of the picture, each with its other names.
fn settings(editor: &Editor) -> impl Iterator<Item = (Match, &'static str)> {
    let mut names = vec![
        ("Camera".to_owned(), Selection::Camera, ""),
        (
            "World: background, ambient intensity".to_owned(),
            Selection::World,
            "",
        ),
        (
            "Picture: width, height, reflections".to_owned(),
            Selection::Render,
            "picture settings",
        ),
    ];
    let packs = Item::pack(0).name(editor.scene()).map(|_| Item::pack(0));
    if let Some(pack) = pack_of_selected(editor).or(packs) {
        let name = "Color pack: ambient, diffuse, specular, phong, reflective";
        names.push((name.to_owned(), Selection::from(pack), ""));
    }
    let chosen = editor.scene().render.chosen().into_iter();
    names.extend(chosen.map(|chosen| {
        let name = format!("Picture: {}", chosen.setting.label);
        (name, Selection::Render, chosen.setting.name)
    }));
    names.into_iter().map(|(name, selection, aliases)| {
        (
            Match::of(name, "setting", Target::Selection(selection)),
            aliases,
        )
    })
}

fn scene_items<'a>(
    editor: &'a Editor,
    matches_query: impl Fn(&str) -> bool + 'a,
) -> impl Iterator<Item = Match> + 'a {
    let scene = editor.scene();
    let lights = (0..scene.lights.len()).map(|index| (Item::light(index), "light"));
    let objects = scene.objects.iter().enumerate();
    let objects = objects.map(|(index, object)| (Item::object(index), object.shape.kind()));
    let packs = (0..scene.color_packs.len()).map(|index| (Item::pack(index), "color pack"));
    let all = lights.chain(objects).chain(packs);
    let all = all.map(|(item, kind)| (item.name(scene).unwrap_or_default(), kind, Some(item)));
    let groups: IndexSet<&str> = scene.objects.iter().map(|o| o.group.as_str()).collect();
    let groups = groups.into_iter().filter(|group| !group.is_empty());
    let groups = groups.map(|group| (group, "group", None));
    let all = groups
        .chain(all)
        .filter(move |(name, ..)| matches_query(name));
    all.map(|(name, kind, item)| {
        let target = match item {
            Some(item) => Target::Selection(item.into()),
            None => Target::Group(name.to_owned()),
        };
        Match::of(name.to_owned(), kind, target)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_other_words_too_can_be_added() {
        for (name, _) in ADDITION_ALIASES {
            assert!(additions().any(|entry| entry.name == name), "{name}");
        }
    }

    #[test]
    fn words_that_begin_so_come_before_words_that_hold_it() {
        let mut names = [
            "Record the flight",
            "Hide light markers",
            "Add Light",
            "Light 2",
        ];
        names.sort_by_key(|name| rank((name, ""), "light"));
        let sorted = [
            "Light 2",
            "Add Light",
            "Hide light markers",
            "Record the flight",
        ];
        assert_eq!(names, sorted);
        assert_eq!(rank(("Add Light", ""), "li add"), 2);
        assert_eq!(rank(("Show: histogram", "levels"), "levels"), 2);
    }
}
