//! From held keys and mouse moves to steps of a flight. Speeds are per second, whatever the frame
//! rate.

use egui::{Context, Key, PointerButton, Response, Ui};

use super::commands::FLIGHT;
use crate::editor::Motion;
use crate::scene::Scene;

/// Radians per second of an arrow key.
const TURN_SPEED: f64 = 0.9;
/// Radians per point of mouse movement.
const MOUSE_TURN: f64 = 0.004;
/// Flying speed in scene extents per second: four seconds across.
const EXTENTS_PER_SECOND: f64 = 0.25;
/// Flying speed in a scene without extent, in world units per second.
const PLAIN_SPEED: f64 = 50.0;
/// How much faster shift is.
const FAST: f64 = 4.0;
/// Longest frame that counts, in seconds: after a stall the camera does not leap.
const LONGEST_FRAME: f64 = 0.1;
/// Seconds that the control key must be held by itself before it flies: it also starts shortcuts.
const CTRL_DELAY: f64 = 0.2;
/// Scene extents per point of wheel movement.
const WHEEL_EXTENTS: f64 = 0.0008;

/// What the flight keys need to remember.
#[derive(Debug, Default)]
pub struct Flying {
    /// When the control key was pressed; `None` if it is up or started a shortcut.
    ctrl_since: Option<f64>,
    ctrl_spent: bool,
}

impl Flying {
    /// The step of this frame, if the camera moves. `picture` is the response of the picture area;
    /// keys count only while `keys_are_free`.
    pub fn step(
        &mut self,
        ui: &Ui,
        picture: &Response,
        keys_are_free: bool,
        scene: &Scene,
    ) -> Option<Motion> {
        let speed = speed(scene);
        let held = if keys_are_free {
            self.held(ui)
        } else {
            Motion::default()
        };
        let seconds = f64::from(ui.input(|input| input.stable_dt)).min(LONGEST_FRAME);
        let fast = if ui.input(|input| input.modifiers.shift) {
            FAST
        } else {
            1.0
        };
        let mut motion = held.times(speed * fast * seconds, TURN_SPEED * seconds);
        if motion != Motion::default() {
            ui.request_repaint();
        }
        if picture.dragged_by(PointerButton::Secondary) {
            let moved = picture.drag_motion();
            motion.yaw += f64::from(moved.x) * MOUSE_TURN;
            motion.pitch -= f64::from(moved.y) * MOUSE_TURN;
        }
        if picture.hovered() {
            let wheel = f64::from(ui.input(|input| input.smooth_scroll_delta().y));
            motion.forward += wheel * WHEEL_EXTENTS / EXTENTS_PER_SECOND * speed * fast;
        }
        (motion != Motion::default()).then_some(motion)
    }

    /// Whether a flight key is down: the gesture goes on.
    pub fn is_any_key_down(&self, ctx: &Context) -> bool {
        let is_down = |key: Key| ctx.input(|input| input.key_down(key));
        self.ctrl_since.is_some() || FLIGHT.iter().filter_map(|flight| flight.key).any(is_down)
    }

    fn held(&mut self, ui: &Ui) -> Motion {
        let (ctrl, alt, now) =
            ui.input(|input| (input.modifiers.ctrl, input.modifiers.alt, input.time));
        let other_key = ui.input(|input| !input.keys_down.is_empty());
        self.ctrl_spent = ctrl && (self.ctrl_spent || (self.ctrl_since.is_none() && other_key));
        self.ctrl_since = if ctrl && !self.ctrl_spent {
            self.ctrl_since.or(Some(now))
        } else {
            None
        };
        let ctrl_flies = self
            .ctrl_since
            .is_some_and(|since| now - since >= CTRL_DELAY);
        if ctrl && !ctrl_flies {
            if other_key {
                self.ctrl_spent = true;
                self.ctrl_since = None;
            }
            ui.request_repaint();
            return Motion::default();
        }
        if alt {
            return Motion::default();
        }
        let is_held = |key: Option<Key>| match key {
            Some(key) => ui.input(|input| input.key_down(key)),
            None => ctrl_flies,
        };
        let held = FLIGHT.iter().filter(|flight| is_held(flight.key));
        held.fold(Motion::default(), |sum, flight| sum.plus(&flight.motion))
    }
}

/// Flying speed in world units per second.
fn speed(scene: &Scene) -> f64 {
    let extent = scene
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).length());
    if extent > 0.0 {
        extent * EXTENTS_PER_SECOND
    } else {
        PLAIN_SPEED
    }
}
