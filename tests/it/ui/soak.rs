//! A long session of random input that also opens, flies, records, plays, imports, saves and exports: nothing
//! hangs, memory does not grow, and everything written can be read. `GLINT_SOAK=200000` sets the number of events.

use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glint::scene::Document;

use super::monkey::{Monkey, Unanswered, tap};
use crate::harness::{CTRL, EditorHarness};
use crate::scenes::files_in;

/// Number of events, unless the environment asks for more.
const FEW: usize = 8_000;
/// Events between two complete checks.
const ROUND: usize = 400;
/// Number of rounds at the beginning whose memory use is the reference for the later ones.
const WARM: usize = 8;
/// Size of the largest scene that is opened, in bytes.
const LARGEST: usize = 6_000;

/// The resident memory of this process in MiB; `None` if the system does not report it.
fn memory() -> Option<f64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let resident: f64 = pages.split(' ').nth(1)?.parse().ok()?;
    Some(resident * 4096.0 / f64::from(1 << 20))
}

/// Presses a button if it exists; returns whether it does.
fn press(harness: &mut EditorHarness, name: &str) -> bool {
    let is_there = match harness.window.query_all_by_label(name).next() {
        None => false,
        Some(button) => {
            button.click();
            true
        }
    };
    harness.window.step();
    harness.window.step();
    is_there
}

/// Drops a file onto the window, discarding unsaved changes.
fn drop_file(harness: &mut EditorHarness, path: &Path) {
    harness.drop_file(path.to_owned());
    press(harness, "Don't save");
    harness.settle();
}

/// Flies and turns for a while.
fn fly(harness: &mut EditorHarness) {
    for key in [Key::W, Key::ArrowRight] {
        harness.window.key_down(key);
        (0..15).for_each(|_| harness.window.step());
    }
    for key in [Key::W, Key::ArrowRight] {
        harness.window.key_up(key);
    }
    (0..5).for_each(|_| harness.window.step());
    harness.settle();
}

/// Records a flight and makes keys of it. Returns whether there are any.
fn record(harness: &mut EditorHarness) -> bool {
    tap(harness, Key::R, Modifiers::NONE);
    fly(harness);
    tap(harness, Key::T, Modifiers::NONE);
    harness.wait_for("keys", |harness| !harness.editor().is_making_keys());
    harness.settle();
    !harness.scene().animation.keys.is_empty()
}

/// Plays for a second.
fn play(harness: &mut EditorHarness) {
    tap(harness, Key::G, Modifiers::NONE);
    (0..60).for_each(|_| harness.window.step());
    tap(harness, Key::G, Modifiers::NONE);
    harness.settle();
}

/// Opens the export window.
fn show_exports(harness: &mut EditorHarness) {
    // The shortcut would close a window that the monkey has left open.
    let is_open = {
        let mut buttons = harness.window.query_all_by_label("Start export");
        buttons.next().is_some()
    };
    if !is_open {
        harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    }
}

/// Waits for the exports, including those that the monkey has paused.
fn end_exports(harness: &mut EditorHarness) {
    if harness.window.state().is_exporting() {
        show_exports(harness);
        while press(harness, "Resume") {}
    }
    harness.wait_for("the exports end", |harness| {
        !harness.window.state().is_exporting()
    });
}

/// Exports three small frames. Returns whether they exist.
fn export(harness: &mut EditorHarness, folder: &Path) -> bool {
    show_exports(harness);
    harness.type_name("folder", folder.to_str().expect("plain"));
    harness.type_name("frames", "1-3");
    harness.type_into("export width", "24");
    harness.type_into("export height", "24");
    harness.settle();
    press(harness, "Start export");
    harness.wait_for("frames", |harness| !harness.window.state().is_exporting());
    press(harness, "Remove");
    tap(harness, Key::Escape, Modifiers::NONE);
    let count = std::fs::read_dir(folder).map_or(0, Iterator::count);
    std::fs::remove_dir_all(folder).is_ok() && count > 3
}

/// Files to open: copies of small example scenes in the folder.
fn pool(folder: &Path) -> Vec<PathBuf> {
    let copied = files_in("scenes").into_iter().filter_map(|path| {
        let text = std::fs::read(&path).expect("readable");
        let copy = folder.join(path.file_name()?);
        (text.len() < LARGEST).then(|| {
            std::fs::write(&copy, text).expect("written");
            copy
        })
    });
    copied.collect()
}

/// Writes the document to a file, reads it back, and returns it as text.
fn keep(harness: &EditorHarness, path: &Path) -> String {
    std::fs::write(path, harness.editor().to_text().expect("a text")).expect("written");
    let read = Document::load(path).expect("what was written");
    read.to_text().expect("a text")
}

#[test]
#[ignore = "long, and asks how much memory the process takes"]
fn a_long_day_of_a_monkey_leaves_everything_in_order() {
    let events = std::env::var("GLINT_SOAK").ok();
    let events = events.map_or(FEW, |events| events.parse().expect("a number of events"));
    let dialogs = Unanswered::default();
    let mut harness = EditorHarness::asked(|_| Box::new(dialogs.clone()), None);
    let folder = harness.folder.path().to_owned();
    let pool = pool(&folder);
    let mesh = folder.join("ball.obj");
    std::fs::write(
        &mesh,
        "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 2 3\nf 1 3 4\n",
    )
    .expect("written");
    let mut monkey = Monkey::new(events as u64);
    let (mut recorded, mut exported, mut taken) = (0, 0, Vec::new());
    let rounds = events.div_ceil(ROUND).max(2 * WARM);
    for round in 0..rounds {
        // After the random input, the window still works, and its document can be written and read.
        monkey.play(&mut harness, ROUND);
        // While a dialog is open, nothing else can be opened.
        dialogs.close(&mut harness);
        press(&mut harness, "Cancel");
        end_exports(&mut harness);
        harness.settle();
        let text = keep(&harness, &folder.join("left.ron"));
        assert!(
            text == harness.editor().to_text().expect("a text"),
            "round {round}: {text}"
        );

        // Then deliberate actions, starting with a fresh scene.
        let next = monkey.random.below(pool.len());
        drop_file(&mut harness, &pool[next]);
        taken.extend(memory());
        fly(&mut harness);
        play(&mut harness);
        recorded += usize::from(record(&mut harness));
        drop_file(&mut harness, &mesh);
        exported += usize::from(export(&mut harness, &folder.join("frames")));
        let path = folder.join("kept.ron");
        keep(&harness, &path);
        drop_file(&mut harness, &path);
        assert_eq!(harness.editor().path(), Some(&*path), "round {round}");
    }
    // Not in all rounds: text that the monkey typed into the export settings remains there.
    assert!(recorded * 8 > rounds, "{recorded} of {rounds} recordings");
    assert!(exported * 8 > rounds, "{exported} of {rounds} exports");
    let largest = |taken: &[f64]| taken.iter().copied().fold(0.0, f64::max);
    if !taken.is_empty() {
        let (warm, later) = taken.split_at(WARM);
        let (first, last) = (largest(warm), largest(later));
        println!(
            "{rounds} rounds, {recorded} recorded, {exported} exported, {first:.0} to {last:.0} MiB"
        );
        assert!(
            last < first * 1.25 + 32.0,
            "{first:.0} to {last:.0} MiB: {taken:.0?}"
        );
    }
}
