//! The lab: dots, maps, and adopting a setting.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glint::scene::Method as _;
use glint::scene::{Sampling, Scene};

use crate::harness::{CTRL, EditorHarness};

#[test]
fn the_lab_measures_shows_a_dot_and_adopts_it_in_one_step() {
    // With jagged edges, so that the cheapest setting within 8 bits is another one, whichever it is today.
    let mut jagged = Scene::demo();
    jagged.render.antialias = Sampling::Centres;
    let mut harness = EditorHarness::on(jagged);
    let before = harness.scene().clone();
    harness.press(CTRL, Key::L);
    harness.click("Measure");
    harness.wait_for("the dots", |harness| !harness.sees("Cancel measuring"));
    assert!(
        harness.window.query_by_label("Use this").is_none(),
        "no dot is chosen"
    );
    harness.click("Fastest below");
    harness.window.get_by_label("Lab picture");
    assert!(
        harness
            .window
            .query_by_label("stale: measure again")
            .is_none()
    );
    // The details of the dot are laid out in a column, and fit into the window.
    let (button, faces) = ("Use this", "×64");
    let [button, faces] = [button, faces].map(|name| harness.window.get_by_label(name).rect());
    assert!(
        faces.bottom() < button.top() && button.right() < 1280.0,
        "{faces:?} {button:?}"
    );
    harness.click("×64");
    let steps = harness.editor().undo_label().map(str::to_owned);
    harness.click("Use this");
    assert_eq!(steps, None);
    assert_eq!(
        harness.editor().undo_label(),
        Some("Render: settings from the lab")
    );
    assert_ne!(harness.scene().render, before.render);
    assert!(
        harness.window.query_by_label("Lab picture").is_none(),
        "what is edited is looked at"
    );
    harness.click("Fastest below");
    harness.window.get_by_label("Lab picture");
    harness.assert_says("Leave Lab: ");
    assert!(
        harness
            .window
            .query_by_label("stale: measure again")
            .is_none(),
        "settings are what is compared"
    );
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.window.query_by_label("Lab picture").is_none());
    harness.press(CTRL, Key::Z);
    assert_eq!(*harness.scene(), before);
    harness.press(Modifiers::NONE, Key::O);
    harness.window.get_by_label("stale: measure again");
    harness.press(CTRL, Key::L);
    assert!(harness.window.query_by_label("Measure").is_none());
    // What was measured of one document is not shown for another.
    harness.press(CTRL, Key::Z);
    harness.press(CTRL, Key::L);
    harness.click("Fastest below");
    harness.window.get_by_label("Lab picture");
    harness.press(CTRL, Key::N);
    assert!(harness.window.query_by_label("Lab picture").is_none());
    harness.window.get_by_label("Measure the scene");
}

#[test]
fn the_lab_shows_where_formulas_break_and_warns_of_those_in_use() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron"));
    let text = text.expect("the demo").replace(
        "reflection_limit: 1",
        "reflection_limit: 1, triangle: \"edges\"",
    );
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&text));
    assert_eq!(harness.scene().render.triangle.id(), "edges");
    harness.press(CTRL, Key::L);
    harness.click("Stability");
    harness.wait_for("the maps", |harness| harness.sees("stable"));
    harness
        .window
        .get_by_label("The frame marks where your scene is.");
    let row = |harness: &EditorHarness, words: &str| {
        let rows = harness.window.query_all_by_label_contains(words);
        rows.last().map(|row| row.rect().center())
    };
    for (method, warned) in [("edges", true), ("watertight", false)] {
        let at = row(&harness, method).expect("a row");
        harness.click_at(at);
        let mut warnings = harness
            .window
            .query_all_by_label_contains("Your scene uses this");
        assert_eq!(warnings.next().is_some(), warned, "{method}");
    }
}
