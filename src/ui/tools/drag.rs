//! Drags in the picture.

use egui::{CursorIcon, Event, Key, Painter, Pos2, Rect, Response, Stroke, StrokeKind, Ui};
use glam::DVec3;

use super::gizmo::{Handle, label};
use super::grip::{Grip, Pull};
use super::navigate::{orbit_angles, panned};
use super::screen::Screen;
use super::seen_objects::{SeenObjects, is_finite, item_of};
use super::subject::Movable;
use crate::editor::{Action, Edit, Editor, Selection};
use crate::image::Thing;
use crate::scene::Shape;
use crate::ui::commands::take_escape;
use crate::ui::flying::drag_of;
use crate::ui::requests::UiRequests;
use crate::ui::theme::palette;
use crate::ui::viewport::Place;
use crate::words::counted;

/// Assumed distance where nothing is known of what is seen, in world units.
const DEFAULT_DISTANCE: f64 = 100.0;

/// A drag in progress.
pub enum Drag {
    /// Orbits the camera around a point.
    Orbit(DVec3),
    /// Pans the camera so that a point follows the pointer.
    Pan(DVec3),
    /// Draws a selection rectangle from this position; what it finds is added to this selection.
    Marquee(Pos2, Selection),
    /// Moves a handle of the selection.
    Grip(Box<Grip>),
    /// Started at this position, with Shift or not, and waits to learn what is there.
    Undecided(Pos2, bool),
}

/// The picture, with what is needed to interact with it.
pub struct Pane<'a> {
    /// The document.
    pub editor: &'a Editor,
    /// Position and size of the picture.
    pub place: Place,
    /// The mapping between picture and scene.
    pub screen: Screen,
    /// Draws on top of the picture.
    pub painter: Painter,
}

impl Pane<'_> {
    /// The point of the scene at a position in the picture; if nothing is there, a point at the depth of the
    /// scene's middle.
    pub fn point_at(&self, seen_objects: &SeenObjects, at: Pos2) -> DVec3 {
        let scene = self.editor.shown();
        let seen = seen_objects.at(self.editor, self.place.rect, at);
        let shape = match seen {
            Some(Thing::Object(index)) => scene.objects.get(index).map(|object| &object.shape),
            _ => None,
        };
        let middle = match seen {
            Some(Thing::Light(index)) => scene.lights.get(index).map(|light| light.position),
            _ => scene.middle(),
        };
        let on_shape = shape.and_then(|shape| self.screen.on_shape(at, shape));
        let forward = self.screen.forward();
        let at_middle_depth = || self.screen.on_plane(at, middle?, forward);
        on_shape.or_else(at_middle_depth).unwrap_or_else(|| {
            let (origin, direction) = self.screen.ray(at);
            origin + direction * DEFAULT_DISTANCE
        })
    }

    /// The point to orbit around: the middle of the selection, if it is finite and in the picture, otherwise the
    /// point at a position.
    fn pivot(&self, seen_objects: &SeenObjects, at: Pos2) -> DVec3 {
        let (selection, scene) = (self.editor.selection(), self.editor.shown());
        let mut selected = Movable::of(selection, scene).into_iter();
        let are_finite = selected.all(|subject| subject.bounds().is_some());
        let middle = selection.middle(scene).filter(|middle| {
            let place = self.screen.place(*middle);
            are_finite && place.is_some_and(|place| self.place.rect.contains(place))
        });
        middle.unwrap_or_else(|| self.point_at(seen_objects, at))
    }

    /// The thing seen at a position, if it can be grabbed.
    fn grabbable_at(&self, seen_objects: &SeenObjects, at: Pos2) -> Option<Thing> {
        let seen = seen_objects.at(self.editor, self.place.rect, at)?;
        // A sphere around the camera surrounds it on all sides, as the sky does, and is no more grabbed than that.
        let eye = self.editor.shown().camera.position;
        let surrounds = match seen {
            Thing::Object(index) => match &self.editor.shown().objects.get(index)?.shape {
                Shape::Sphere(ball) => ball.center.distance(eye) < ball.radius,
                _ => false,
            },
            Thing::Light(_) => false,
        };
        (is_finite(self.editor.shown(), seen) && !surrounds).then_some(seen)
    }
}

impl Drag {
    /// Starts the drag that begins at a position in the picture, on `handle` if there is one.
    pub fn start(
        view: &Pane,
        seen_objects: &SeenObjects,
        (at, handle, is_shifted): (Pos2, Option<Handle>, bool),
        out: &mut UiRequests,
    ) -> Option<Self> {
        let editor = view.editor;
        if let Some(handle) = handle {
            let before = Movable::of(editor.selection(), editor.shown());
            let grabbed = (before, editor.selection().pivot(editor.shown())?);
            let grip = Grip::new(&view.screen, grabbed, handle, at)?;
            return Some(Self::Grip(Box::new(grip)));
        }
        if editor.looks_through() || editor.timeline().is_playing {
            return Some(Self::Orbit(view.pivot(seen_objects, at)));
        }
        if seen_objects.map(editor).is_none() {
            return Some(Self::Undecided(at, is_shifted));
        }
        if let Some(thing) = view.grabbable_at(seen_objects, at) {
            let item = item_of(thing);
            let mut selected = editor.selection().clone();
            if !selected.has(item) {
                selected = selected.picked(editor.scene(), &[item]);
                out.select(selected.clone());
            }
            let before = Movable::of(&selected, editor.shown());
            let grabbed = (before, selected.pivot(editor.shown())?);
            let grip = Grip::free(grabbed, at, view.point_at(seen_objects, at));
            return Some(Self::Grip(Box::new(grip)));
        }
        Some(if is_shifted {
            Self::Marquee(at, editor.selection().clone())
        } else {
            Self::Orbit(view.pivot(seen_objects, at))
        })
    }

    /// The handle that is being dragged.
    pub fn handle(&self) -> Option<Handle> {
        match self {
            Self::Grip(grip) => Some(grip.handle),
            _ => None,
        }
    }

    /// Continues the drag by a frame; returns whether it goes on. Releasing the button ends it, Escape cancels it.
    pub fn advance(
        &mut self,
        ui: &Ui,
        view: &Pane,
        seen_objects: &SeenObjects,
        response: &Response,
        out: &mut UiRequests,
    ) -> bool {
        let is_cancelled = take_escape(ui);
        let pointer = ui.input(|input| input.pointer.interact_pos());
        if is_cancelled {
            out.actions.push(Action::CancelGesture);
            return false;
        }
        // Nothing moves while the pointer is outside the window.
        let Some(at) = pointer else {
            return ui.input(|input| input.pointer.any_down());
        };
        if let Self::Undecided(from, is_shifted) = *self {
            if seen_objects.map(view.editor).is_some() {
                match Self::start(view, seen_objects, (from, None, is_shifted), out) {
                    Some(drag) => *self = drag,
                    None => return false,
                }
            }
            return response.dragged();
        }
        let moved = drag_of(response);
        match self {
            Self::Orbit(about) if moved != egui::Vec2::ZERO => {
                out.actions.push(Action::Orbit(*about, orbit_angles(moved)));
            }
            Self::Pan(point) if moved != egui::Vec2::ZERO => {
                let camera = panned(&view.editor.shown().camera, &view.screen, *point, moved);
                out.edit(Edit::Camera(camera, "move"));
            }
            Self::Orbit(_) | Self::Pan(_) | Self::Undecided(..) => {}
            Self::Marquee(from, before) => {
                let marquee = Rect::from_two_pos(*from, at);
                let found = seen_objects.within(view.editor, view.place.rect, marquee);
                // Whole groups, as with a click: the next step could otherwise tear them apart.
                let found = before.picked(view.editor.scene(), &found);
                let found = found.items();
                if !response.dragged() {
                    // Like a Shift-click, it only adds.
                    if !found.is_empty() {
                        let items = before.items().iter().chain(found).copied();
                        out.select(Selection::all(items));
                    }
                    return false;
                }
                show_marquee(view, marquee, (at, found.len()));
            }
            Self::Grip(grip) => {
                ui.set_cursor_icon(CursorIcon::Grabbing);
                let is_entered = grip.takes_numbers() && type_into(ui, &mut grip.typed);
                let is_done = is_entered && grip.typing_error().is_none();
                let modifiers = ui.input(|input| input.modifiers);
                let pull = Pull {
                    at,
                    snaps: modifiers.command,
                    is_level: modifiers.shift,
                };
                if response.dragged() {
                    let (edit, words) = grip.pull(&view.screen, pull).unwrap_or_default();
                    out.actions.extend(edit.map(Action::Edit));
                    grip.label(&view.painter, at, &words);
                }
                if is_done {
                    return false;
                }
            }
        }
        response.dragged()
    }
}

fn show_marquee(view: &Pane, marquee: Rect, (at, count): (Pos2, usize)) {
    let colors = palette(view.painter.ctx());
    let fill = colors.accent.gamma_multiply(0.15);
    let line = Stroke::new(1.0, colors.accent);
    view.painter
        .rect(marquee, 0, fill, line, StrokeKind::Inside);
    label(&view.painter, at, &counted(count, "item"));
}

/// Appends typed digits; returns whether Enter was pressed.
fn type_into(ui: &Ui, typed: &mut String) -> bool {
    let events = ui.input(|input| input.filtered_events(&egui::EventFilter::default()));
    let mut is_done = false;
    for event in events {
        match event {
            Event::Text(text) => {
                typed.extend(
                    text.chars()
                        .filter(|c| c.is_ascii_digit() || ".,-+eE".contains(*c)),
                );
            }
            Event::Key {
                key: Key::Backspace,
                pressed: true,
                ..
            } => {
                typed.pop();
            }
            Event::Key {
                key: Key::Enter,
                pressed: true,
                ..
            } => is_done = true,
            _ => {}
        }
    }
    is_done
}
