//! Turns held keys and mouse moves into steps of a flight. Speeds are per second, whatever the frame rate.

use egui::{Context, Event, Key, PointerButton, Response, Ui, Vec2, vec2};

use super::flight_keys::{FLIGHT, FlightKey};
use crate::editor::Motion;
use crate::scene::Scene;
use crate::ui::commands::take_escape;

/// Turning speed of an arrow key, in radians per second.
const TURN_SPEED: f64 = 0.9;
/// Rate at which a key enlarges an orthographic picture, as a logarithm per second: its height halves in a second.
const ZOOM_SPEED: f64 = std::f64::consts::LN_2;
/// Radians per point of mouse movement.
const MOUSE_TURN: f64 = 0.004;
/// Flying speed in scene extents per second: it takes four seconds to cross the scene.
const EXTENTS_PER_SECOND: f64 = 0.25;
/// Flying speed in a scene without extent, in world units per second.
const DEFAULT_SPEED: f64 = 50.0;
/// Factor on the speed while Shift is held.
const SHIFT_FACTOR: f64 = 4.0;
/// Points of the wheel that double the flying speed.
const WHEEL_POINTS_PER_DOUBLING: f64 = 100.0;
/// Least factor on the flying speed.
pub const MIN_FACTOR: f64 = 0.01;
/// Greatest factor on the flying speed.
pub const MAX_FACTOR: f64 = 100.0;
/// Seconds for which a new speed is shown.
const SPEED_SHOWN_SECONDS: f64 = 1.2;
/// Longest frame that counts, in seconds: after a stall the camera does not leap.
const MAX_FRAME_SECONDS: f64 = 0.1;
/// Seconds for which the control key must be held alone before it flies down: it also begins shortcuts.
const CTRL_DELAY: f64 = 0.4;
/// Relative change of the distance per point of wheel movement.
pub const DOLLY: f64 = 0.003;
/// Seconds without the wheel after which its next turn is an undo step of its own.
const WHEEL_QUIET: f64 = 0.4;

/// The state of flying between frames.
#[derive(Debug, Default)]
pub struct Flying {
    ctrl: Ctrl,
    /// Keys pressed for a shortcut and still held: they fly only after being pressed again.
    shortcut_keys: Vec<Key>,
    /// Whether keys moved the camera in the last frame.
    keys_fly: bool,
    /// When the wheel last turned.
    wheel_at: Option<f64>,
    /// When the speed was last changed.
    changed_at: Option<f64>,
    look: Look,
}

/// The state of the secondary mouse button.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Look {
    /// It is not held, or not for looking around.
    #[default]
    Inactive,
    /// Looking around begins in this frame.
    Begins,
    /// Looking around.
    Active,
    /// Looking around was cancelled with Escape; the button is still held.
    Cancelled,
}

/// Returns whether the secondary button is dragging over the picture.
fn is_secondary_drag(picture: &Response) -> bool {
    picture.dragged_by(PointerButton::Secondary)
}

/// The use of the control key that is being held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Ctrl {
    /// It is not held.
    #[default]
    Released,
    /// Held alone since this time: it may become a flight key or part of a shortcut.
    Waiting(f64),
    /// Flying down together with other keys.
    Flying,
    /// Flying down alone after other keys were let go: the next key pressed belongs to a shortcut.
    FlyingAlone,
    /// Flying down since it was held by itself for a while, which a shortcut takes back.
    Sinking,
    /// Part of a shortcut.
    Shortcut,
}

impl Ctrl {
    fn is_flying(self) -> bool {
        matches!(self, Self::Flying) || self.is_alone()
    }

    fn is_alone(self) -> bool {
        matches!(self, Self::FlyingAlone | Self::Sinking)
    }
}

impl Flying {
    /// Returns the motion of this frame, if the camera moves. Keys count only while `keys_are_free`, the mouse only
    /// over `picture`, which is `None` if the picture cannot be flown through. Must be called in every frame, so that a
    /// key released elsewhere is not missed.
    pub fn step(
        &mut self,
        ui: &Ui,
        picture: Option<&Response>,
        keys_are_free: bool,
        (scene, factor): (&Scene, f64),
    ) -> Option<Motion> {
        self.note_shortcut_keys(ui);
        let held = if let Some(picture) = picture.filter(|_| keys_are_free) {
            self.held_motion(ui, picture)
        } else {
            // A key that is held for something else flies only after being pressed again.
            let is_held = ui.input(|input| input.modifiers.ctrl);
            self.ctrl = if is_held {
                Ctrl::Shortcut
            } else {
                Ctrl::Released
            };
            Motion::default()
        };
        self.keys_fly = held != Motion::default();
        let mut motion = Motion::default();
        if self.keys_fly {
            ui.request_repaint();
            let fast = if ui.input(|input| input.modifiers.shift) {
                SHIFT_FACTOR
            } else {
                1.0
            };
            let speed = speed(scene) * fast * factor;
            let seconds = f64::from(ui.input(|input| input.stable_dt)).min(MAX_FRAME_SECONDS);
            motion = held.times(speed * seconds, TURN_SPEED * seconds);
            motion.zoom = held.forward * ZOOM_SPEED * fast * seconds;
        }
        self.look = match self.look {
            _ if !ui.input(|input| input.pointer.secondary_down()) => Look::Inactive,
            Look::Inactive if picture.is_some_and(is_secondary_drag) => Look::Begins,
            Look::Begins => Look::Active,
            current => current,
        };
        let is_looking = matches!(self.look, Look::Begins | Look::Active);
        if let Some(picture) = picture.filter(|picture| is_looking && is_secondary_drag(picture)) {
            let moved = drag_of(picture);
            motion.yaw += f64::from(moved.x) * MOUSE_TURN;
            motion.pitch -= f64::from(moved.y) * MOUSE_TURN;
        }
        (motion != Motion::default()).then_some(motion)
    }

    /// Whether looking around begins in this frame: it is an undo step of its own, even during a flight.
    pub fn begins_looking(&self) -> bool {
        self.look == Look::Begins
    }

    /// Consumes Escape while looking around, and returns whether it undoes the camera's motion since that began.
    pub fn cancels_look(&mut self, ui: &Ui) -> bool {
        let cancels_look = matches!(self.look, Look::Begins | Look::Active) && take_escape(ui);
        if cancels_look {
            self.look = Look::Cancelled;
            // Keys that flew in the meantime fly only after being pressed again.
            ui.input(|input| self.shortcut_keys.extend(&input.keys_down));
        }
        cancels_look
    }

    /// Returns the points that the wheel turned over the picture. While the camera flies or looks around, the wheel
    /// changes `factor`, the factor on the flying speed, instead.
    pub fn wheel(&mut self, ui: &Ui, picture: &Response, factor: &mut f64) -> f64 {
        let is_down = ui.input(|input| input.pointer.secondary_down());
        let is_looking = is_down && picture.is_pointer_button_down_on();
        if !picture.hovered() && !is_looking {
            return 0.0;
        }
        // With Shift, which flies faster, egui reports the wheel as scrolling to the side.
        let (turned, zoom) = ui.input(|input| {
            let delta = input.smooth_scroll_delta();
            let across = if input.modifiers.shift { delta.x } else { 0.0 };
            // With Ctrl, it reports a zoom, as it does for two fingers that move apart.
            (delta.y + across, input.zoom_delta())
        });
        let wheel = f64::from(turned) + f64::from(zoom).ln() / DOLLY;
        if wheel == 0.0 {
            return 0.0;
        }
        let now = ui.input(|input| input.time);
        // The rest of a turn that changed the speed must not zoom.
        let was_changed = self.changed_at.is_some_and(|at| now - at < WHEEL_QUIET);
        if is_looking || self.keys_fly {
            *factor = (*factor * (wheel / WHEEL_POINTS_PER_DOUBLING).exp2())
                .clamp(MIN_FACTOR, MAX_FACTOR);
            self.changed_at = Some(now);
            return 0.0;
        }
        if was_changed {
            return 0.0;
        }
        self.wheel_at = Some(now);
        wheel
    }

    /// Whether the speed was changed a moment ago and is to be shown.
    pub fn is_speed_shown(&self, ctx: &Context) -> bool {
        is_recent(ctx, self.changed_at, SPEED_SHOWN_SECONDS)
    }

    /// Whether keys move the camera, in which case they are not shortcuts.
    pub fn is_flying(&self) -> bool {
        self.keys_fly && !self.ctrl.is_alone()
    }

    /// Whether the camera flies down only because the control key, with which a shortcut may begin, is held.
    pub fn is_sinking(&self) -> bool {
        self.ctrl == Ctrl::Sinking
    }

    /// Whether a flight or a turn of the wheel goes on, which is one undo step.
    pub fn is_gesture(&self, ctx: &Context) -> bool {
        let is_turned = is_recent(ctx, self.wheel_at, WHEEL_QUIET);
        let any_down = FLIGHT.iter().any(|flight| is_down(ctx, flight));
        is_turned || self.ctrl.is_flying() || any_down
    }

    /// Notes keys held for shortcuts: the control key is often released before the other one.
    fn note_shortcut_keys(&mut self, ui: &Ui) {
        let may_take = self.ctrl != Ctrl::Flying && !self.is_flying();
        ui.input(|input| {
            // Only the raw events still contain the keys that commands have consumed.
            let pressed = input.raw.events.iter().filter_map(|event| match event {
                Event::Key {
                    key,
                    pressed: true,
                    modifiers,
                    ..
                } if may_take && (modifiers.command || modifiers.alt) => Some(*key),
                _ => None,
            });
            self.shortcut_keys.extend(pressed);
            self.shortcut_keys
                .retain(|key| input.keys_down.contains(key));
        });
    }

    fn held_motion(&mut self, ui: &Ui, picture: &Response) -> Motion {
        let (ctrl, alt, now) =
            ui.input(|input| (input.modifiers.ctrl, input.modifiers.alt, input.time));
        let has_others = ui.input(is_held_with_others);
        self.ctrl = match self.ctrl {
            _ if !ctrl => Ctrl::Released,
            Ctrl::Released if self.keys_fly => Ctrl::Flying,
            Ctrl::Released | Ctrl::Waiting(_) if has_others => Ctrl::Shortcut,
            current if current.is_alone() && has_others => Ctrl::Shortcut,
            // Outside the picture, it is held for a click that comes later.
            Ctrl::Released | Ctrl::Waiting(_) if !picture.contains_pointer() => Ctrl::Shortcut,
            Ctrl::Released => Ctrl::Waiting(now),
            Ctrl::Waiting(since) if now - since >= CTRL_DELAY => Ctrl::Sinking,
            current => current,
        };
        if matches!(self.ctrl, Ctrl::Waiting(_)) {
            ui.request_repaint();
        }
        if self.ctrl == Ctrl::Flying && !has_others {
            self.ctrl = Ctrl::FlyingAlone;
        }
        if alt || matches!(self.ctrl, Ctrl::Waiting(_) | Ctrl::Shortcut) {
            return Motion::default();
        }
        let held = FLIGHT.iter().filter(|flight| match flight.key {
            Some(key) => is_down(ui, flight) && !self.shortcut_keys.contains(&key),
            None => self.ctrl.is_flying(),
        });
        held.fold(Motion::default(), |sum, flight| sum.plus(&flight.motion))
    }
}

/// Keys that modify others.
const MODIFIERS: [Key; 8] = [
    Key::ControlLeft,
    Key::ControlRight,
    Key::ShiftLeft,
    Key::ShiftRight,
    Key::AltLeft,
    Key::AltRight,
    Key::SuperLeft,
    Key::SuperRight,
];

/// Returns whether the control key is held together with something else: a key, a button, the wheel, or an event that
/// the desktop made of a shortcut.
fn is_held_with_others(input: &egui::InputState) -> bool {
    let is_from_desktop =
        |event: &Event| matches!(event, Event::Copy | Event::Cut | Event::Paste(_));
    // Desktops report modifier keys as keys too.
    let is_other = |key: &Key| !MODIFIERS.contains(key);
    input.keys_down.iter().any(is_other)
        || input.pointer.any_down()
        || input.zoom_delta() != 1.0
        || input.events.iter().any(is_from_desktop)
}

/// Returns whether the key is held. The control key, which has two meanings, is handled elsewhere.
fn is_down(ctx: &Context, flight: &FlightKey) -> bool {
    flight
        .key
        .is_some_and(|key| ctx.input(|input| input.key_down(key)))
}

/// Returns the flying speed in world units per second, from the extent of the objects, however far away lights are.
fn speed(scene: &Scene) -> f64 {
    let extent = scene
        .surroundings()
        .map_or(0.0, |(low, high)| (high - low).length());
    if extent > 0.0 {
        extent * EXTENTS_PER_SECOND
    } else {
        DEFAULT_SPEED
    }
}

/// Returns how far the pointer was dragged over the picture, in points. At the edge of the screen the pointer stops,
/// and only the mouse's motion goes on; a pen, or the mouse of another machine, moves only the pointer.
pub fn drag_of(picture: &Response) -> Vec2 {
    let (moved, motion) = (picture.drag_delta(), picture.drag_motion());
    let along = |moved: f32, motion: f32| if moved == 0.0 { motion } else { moved };
    vec2(along(moved.x, motion.x), along(moved.y, motion.y))
}

/// Returns whether something happened less than `seconds` ago; if so, requests a frame for when that is over.
fn is_recent(ctx: &Context, at: Option<f64>, seconds: f64) -> bool {
    let now = ctx.input(|input| input.time);
    let is_recent = at.is_some_and(|at| now - at < seconds);
    if is_recent {
        ctx.request_repaint_after_secs(seconds as f32);
    }
    is_recent
}
