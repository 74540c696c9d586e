//! Twenty thousand random events: nothing panics, and undoing everything restores the first scene.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::mpsc::{Sender, channel};

use egui::{
    Context, Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, pos2, vec2,
};
use glint::ui::{Ask, Dialogs};
use glint::worker::Background;

use crate::harness::{CTRL, EditorHarness};

/// Events before everything is undone: fewer than the number of undo steps kept.
const ROUND: usize = 400;
const ROUNDS: usize = 50;
/// Events per frame.
const AT_ONCE: usize = 8;

/// Dialogs that stay open, so that no file is written where it could do harm.
#[derive(Clone, Default)]
pub struct Unanswered(Rc<RefCell<Vec<Sender<Option<PathBuf>>>>>);

impl Unanswered {
    /// Answers the last open dialog.
    pub fn answer(&self, path: &Path) {
        let asked = self.0.borrow_mut().pop().expect("a dialog");
        asked.send(Some(path.to_owned())).expect("it is waited for");
    }

    /// Closes all open dialogs.
    pub fn close(&self, harness: &mut EditorHarness) {
        self.0.borrow_mut().clear();
        harness.window.step();
        harness.window.step();
        leave_everything(harness);
    }
}

impl Dialogs for Unanswered {
    fn ask(&mut self, _: &Context, _: &Ask, _: PathBuf) -> Background<Option<PathBuf>> {
        let (sender, receiver) = channel();
        self.0.borrow_mut().push(sender);
        receiver.into()
    }
}

/// The multiplicative generator of Steele and Vigna, "Computationally easy, spectrally good multipliers", 2021.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(0xD134_2543_DE82_EF95).wrapping_add(1);
        (self.0 >> 33) as usize % count
    }

    pub fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

const KEYS: [Key; 36] = [
    Key::A,
    Key::C,
    Key::D,
    Key::F,
    Key::G,
    Key::H,
    Key::I,
    Key::K,
    Key::L,
    Key::O,
    Key::P,
    Key::R,
    Key::S,
    Key::T,
    Key::U,
    Key::V,
    Key::W,
    Key::X,
    Key::Y,
    Key::Z,
    Key::Num1,
    Key::Num3,
    Key::Num7,
    Key::Delete,
    Key::Escape,
    Key::Enter,
    Key::Tab,
    Key::Space,
    Key::Home,
    Key::End,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::OpenBracket,
    Key::Comma,
    Key::F2,
];

/// A source of random input, which remembers what is held down.
pub struct Monkey {
    pub random: Random,
    at: Pos2,
    down: Option<(PointerButton, Modifiers)>,
    keys: Vec<(Key, Modifiers)>,
}

impl Monkey {
    /// Creates a monkey whose pointer starts in the middle of the picture.
    pub fn new(seed: u64) -> Self {
        Self {
            random: Random(seed),
            at: pos2(600.0, 400.0),
            down: None,
            keys: Vec::new(),
        }
    }

    /// Performs this many actions, and then releases everything.
    pub fn play(&mut self, harness: &mut EditorHarness, things: usize) {
        for thing in 0..things {
            for event in self.events() {
                harness.window.event(event);
            }
            if thing % AT_ONCE == 0 {
                harness.window.step();
            }
        }
        for event in self.rest() {
            harness.window.event(event);
        }
        leave_everything(harness);
    }

    /// The events of the next action.
    fn events(&mut self) -> Vec<Event> {
        let random = &mut self.random;
        match random.below(10) {
            0..=3 => {
                // Mostly small movements; never in the menu, where windows of the desktop are opened.
                let far = random.below(3) == 0;
                let (x, y) = (random.below(1280) as f32, 40.0 + random.below(760) as f32);
                let near = self.at + vec2((x - 640.0) / 20.0, (y - 420.0) / 20.0);
                self.at = if far {
                    pos2(x, y)
                } else {
                    near.clamp(pos2(0.0, 40.0), pos2(1279.0, 799.0))
                };
                vec![Event::PointerMoved(self.at)]
            }
            4 | 5 => {
                let held = self.down.take();
                let (button, modifiers) = held.unwrap_or_else(|| {
                    let (left, middle) = (PointerButton::Primary, PointerButton::Middle);
                    let button = random.of(&[left, left, middle, PointerButton::Secondary]);
                    let (none, shift) = (Modifiers::NONE, Modifiers::SHIFT);
                    (
                        button,
                        random.of(&[none, none, shift, CTRL, Modifiers::ALT]),
                    )
                });
                let pressed = held.is_none();
                self.down = pressed.then_some((button, modifiers));
                vec![
                    Event::ModifiersChanged(modifiers),
                    Event::PointerButton {
                        pos: self.at,
                        button,
                        pressed,
                        modifiers,
                    },
                ]
            }
            6 | 7 => {
                if let Some((key, modifiers)) = self.keys.pop() {
                    return vec![
                        key_event(key, modifiers, false),
                        Event::ModifiersChanged(Modifiers::NONE),
                    ];
                }
                let key = random.of(&KEYS);
                let with = [Modifiers::NONE, Modifiers::NONE, CTRL, Modifiers::ALT];
                let mut modifiers = random.of(&with);
                if modifiers == CTRL && key == Key::K {
                    // The finder offers every command by name.
                    modifiers = Modifiers::NONE;
                }
                self.keys.push((key, modifiers));
                vec![
                    Event::ModifiersChanged(modifiers),
                    key_event(key, modifiers, true),
                ]
            }
            8 => vec![Event::MouseWheel {
                unit: MouseWheelUnit::Line,
                delta: vec2(0.0, random.below(5) as f32 - 2.0),
                phase: TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers: Modifiers::NONE,
            }],
            _ => vec![Event::Text(
                random
                    .of(&["1", "7", "-", ".", "e", "a", " ", "1e9"])
                    .to_owned(),
            )],
        }
    }

    /// Releases all keys and buttons.
    fn rest(&mut self) -> Vec<Event> {
        let mut events = Vec::new();
        if let Some((button, modifiers)) = self.down.take() {
            events.push(Event::PointerButton {
                pos: self.at,
                button,
                pressed: false,
                modifiers,
            });
        }
        for (key, modifiers) in self.keys.drain(..) {
            events.push(key_event(key, modifiers, false));
        }
        events.push(Event::ModifiersChanged(Modifiers::NONE));
        events
    }
}

fn key_event(key: Key, modifiers: Modifiers, pressed: bool) -> Event {
    Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    }
}

#[test]
fn a_monkey_breaks_nothing_that_undo_does_not_mend() {
    let text = std::fs::read_to_string("scenes/demo.ron").expect("the demo");
    let mut harness = EditorHarness::asked(|_| Box::new(Unanswered::default()), Some(&text));
    let first = harness.editor().to_text().expect("a text");
    let mut monkey = Monkey::new(20_261_122);
    let mut steps = 0;
    for round in 0..ROUNDS {
        monkey.play(&mut harness, ROUND);
        for _ in 0..=ROUND {
            if harness.editor().undo_label().is_none() {
                break;
            }
            steps += 1;
            tap(&mut harness, Key::Z, CTRL);
        }
        assert_eq!(harness.editor().undo_label(), None, "round {round}");
        assert!(
            harness.editor().to_text().expect("a text") == first,
            "round {round}"
        );
    }
    assert!(steps > 500, "{steps} steps: the monkey slept");
}

/// Leaves menus, questions, fields and recordings.
fn leave_everything(harness: &mut EditorHarness) {
    for _ in 0..8 {
        tap(harness, Key::Escape, Modifiers::NONE);
        let is_recording = harness.editor().timeline().recorded().is_some();
        if !is_recording && !harness.window.state().is_asking() {
            break;
        }
    }
    while harness.editor().is_making_keys() {
        harness.window.step();
    }
}

/// Presses and releases a key.
pub fn tap(harness: &mut EditorHarness, key: Key, modifiers: Modifiers) {
    harness.window.event(Event::ModifiersChanged(modifiers));
    harness.window.event(key_event(key, modifiers, true));
    harness.window.step();
    harness.window.event(key_event(key, modifiers, false));
    harness
        .window
        .event(Event::ModifiersChanged(Modifiers::NONE));
    harness.window.step();
}
