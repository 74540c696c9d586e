//! The keys that fly the camera, and the uses of the mouse, as Help lists them.

use egui::Key;

use crate::editor::Motion;

/// A key that flies the camera for as long as it is held.
#[derive(Clone, Copy, Debug)]
pub struct FlightKey {
    /// The key; `None` is the control key without another.
    pub key: Option<Key>,
    /// Direction of flight: 1 stands for the flying speed or the turning speed.
    pub motion: Motion,
    /// Description in Help.
    pub what: &'static str,
}

const STILL: Motion = Motion {
    forward: 0.0,
    right: 0.0,
    up: 0.0,
    yaw: 0.0,
    pitch: 0.0,
    zoom: 0.0,
};

/// Makes a table of keys, each with its direction of flight and its description in Help.
macro_rules! flight {
    ($($key:expr, $field:ident: $by:expr, $what:expr;)*) => {
        &[$(FlightKey { key: $key, motion: Motion { $field: $by, ..STILL }, what: $what }),*]
    };
}

/// Every flight key.
pub const FLIGHT: &[FlightKey] = flight! {
    Some(Key::W), forward: 1.0, "Fly forward";
    Some(Key::S), forward: -1.0, "Fly back";
    Some(Key::A), right: -1.0, "Fly left";
    Some(Key::D), right: 1.0, "Fly right";
    Some(Key::Space), up: 1.0, "Fly up";
    None, up: -1.0, "Fly down";
    Some(Key::ArrowLeft), yaw: -1.0, "Turn left";
    Some(Key::ArrowRight), yaw: 1.0, "Turn right";
    Some(Key::ArrowUp), pitch: 1.0, "Look up";
    Some(Key::ArrowDown), pitch: -1.0, "Look down";
};

/// Uses of the mouse and its modifiers, as listed in Help.
pub const MOUSE: &[(&str, &str)] = &[
    ("Click", "Select; with Shift, add to selection"),
    ("Alt, click", "Select what is behind"),
    ("Drag an object", "Move it; with Shift, horizontally"),
    ("Drag a handle", "Move, rotate, resize; type a value"),
    ("Ctrl, while dragging", "Snap to round values"),
    ("Esc, while dragging", "Cancel the drag"),
    ("Drag the background", "Orbit around the selection"),
    ("Shift, drag background", "Select with a frame"),
    ("Middle button, drag", "Pan"),
    ("Right button, drag", "Look around"),
    ("Right button", "Context menu; Why this colour"),
    ("Wheel", "Zoom to the pointer, or away"),
    ("High-res: wheel, drag", "Magnify, pan; double-click: all"),
    ("High-res: Shift, drag", "Trace only this part again"),
    ("Shift, held", "Fly four times as fast"),
    ("Wheel, while flying", "Fly faster or slower"),
    ("Timeline: drag beside keys", "Select keys with a frame"),
    ("Timeline: Ctrl, wheel", "Zoom"),
    ("Timeline: middle button", "Pan; Home shows all"),
    ("Lab: B, held", "Show the reference"),
];

impl FlightKey {
    /// The name of the key.
    pub fn name(&self) -> &'static str {
        self.key.map_or("Left Ctrl", Key::name)
    }
}
