//! A handle that is being dragged, and the edits that result.

use std::cell::Cell;

use egui::{Painter, Pos2};
use glam::DVec3;

use super::gizmo::{ARROW_LENGTH, AXES, Handle, RING_RADIUS, label};
use super::screen::Screen;
use super::subject::Movable;
use crate::editor::Edit;
use crate::scene::{Disc, Plane, Shape, format_number, unit};
use crate::ui::number::parse_number;

/// Angle to which rotations snap, in degrees.
const SNAP_DEGREES: f64 = 15.0;
/// Movement along an axis below this fraction of the whole movement counts as none.
const NEGLIGIBLE_SHARE: f64 = 1e-9;

/// A handle that is being dragged.
#[derive(Clone, Debug)]
pub struct Grip {
    /// The handle.
    pub handle: Handle,
    /// The items as they were at the start.
    before: Vec<Movable>,
    /// The centre of rotation and scaling.
    middle: DVec3,
    /// Where it was grabbed: on the screen, and in the scene.
    grabbed_at: (Pos2, DVec3),
    /// A number typed instead of moving the pointer.
    pub typed: String,
    /// Last rotation in degrees, counting full turns.
    turned_degrees: Cell<f64>,
}

/// The pointer's input to a drag.
#[derive(Clone, Copy, Debug)]
pub struct Pull {
    /// Position on the screen.
    pub at: Pos2,
    /// Whether values snap to round ones.
    pub snaps: bool,
    /// Whether a free move stays horizontal.
    pub is_level: bool,
}

impl Grip {
    /// Grabs a handle of these items, with this centre of rotation, at a screen position.
    pub fn new(
        screen: &Screen,
        (before, middle): (Vec<Movable>, DVec3),
        handle: Handle,
        at: Pos2,
    ) -> Option<Self> {
        let mut grip = Self {
            handle,
            ..Self::free((before, middle), at, middle)
        };
        grip.grabbed_at.1 = grip.pointed_at(screen, at)?;
        Some(grip)
    }

    /// Grabs the items themselves, with this centre of rotation, at a point of one of them.
    pub fn free((before, middle): (Vec<Movable>, DVec3), at: Pos2, point: DVec3) -> Self {
        Self {
            handle: Handle::Free,
            before,
            middle,
            grabbed_at: (at, point),
            typed: String::new(),
            turned_degrees: Cell::default(),
        }
    }

    /// Returns whether a number can be typed instead.
    pub fn takes_numbers(&self) -> bool {
        matches!(
            self.handle,
            Handle::Along(_) | Handle::Radius | Handle::Size | Handle::Turn(_)
        )
    }

    /// Describes what is wrong with the typed text, if anything.
    pub fn typing_error(&self) -> Option<String> {
        let is_size = matches!(self.handle, Handle::Radius | Handle::Size);
        match parse_number(&self.typed) {
            None => Some(format!("{} is not a number yet", self.typed)),
            Some(number) if is_size && number <= 0.0 => {
                Some(format!("{} is not greater than 0", self.typed))
            }
            Some(_) => None,
        }
    }

    /// The point in the scene that a screen position means for this handle.
    fn pointed_at(&self, screen: &Screen, at: Pos2) -> Option<DVec3> {
        let grab_point = self.grabbed_at.1;
        match self.handle {
            Handle::Along(axis) => {
                let direction = AXES[axis].0;
                Some(self.middle + direction * screen.along(at, self.middle, direction)?)
            }
            Handle::Across(axis) | Handle::Turn(axis) => {
                screen.on_plane(at, self.middle, AXES[axis].0)
            }
            Handle::Free | Handle::Normal => screen.on_plane(at, grab_point, screen.forward()),
            Handle::Corner(corner) => screen.on_plane(at, self.corner(corner)?, screen.forward()),
            Handle::Radius | Handle::Size => Some(grab_point),
        }
    }

    /// The point whose coordinates are rounded: that of a single item as it is stored in the file, otherwise the
    /// centre.
    fn snap_point(&self) -> DVec3 {
        match &self.before[..] {
            [only] => only.position(),
            _ => self.middle,
        }
    }

    fn corner(&self, corner: usize) -> Option<DVec3> {
        match self.before.first()?.shape()? {
            Shape::Triangle(triangle) => Some(triangle.corners()[corner]),
            _ => None,
        }
    }

    /// Returns the edit for a pointer position, and a description of the amount. `None` where the position has no
    /// meaning.
    pub fn pull(&self, screen: &Screen, pull: Pull) -> Option<(Option<Edit>, String)> {
        let unit = screen.unit_at(self.middle);
        let round = |value: f64| rounded(value, unit, pull.snaps);
        let typed = parse_number(&self.typed);
        match self.handle {
            Handle::Along(axis) => {
                let (direction, name) = AXES[axis];
                let to = self.pointed_at(screen, pull.at)?;
                let mut target = self.snap_point();
                let start = target[axis];
                let pulled = (to - self.grabbed_at.1).dot(direction);
                target[axis] = typed.map_or_else(|| round(start + pulled), |by| start + by);
                let by = typed.unwrap_or(target[axis] - start);
                // A typed distance is exact for each item.
                let edit = match typed {
                    Some(by) => self.move_by(direction * by),
                    None => self.move_to(target),
                };
                Some((edit, format!("{name} {}", format_signed(by))))
            }
            Handle::Across(_) | Handle::Free => {
                let to = if pull.is_level && self.handle == Handle::Free {
                    screen.on_plane(pull.at, self.grabbed_at.1, DVec3::Y)?
                } else {
                    self.pointed_at(screen, pull.at)?
                };
                let by = to - self.grabbed_at.1;
                let is_fixed = |axis: usize| match self.handle {
                    Handle::Across(across) => across == axis,
                    _ => pull.is_level && axis == 1,
                };
                let start = self.snap_point();
                let part = |axis: usize| {
                    // An axis that points towards the viewer is not moved along: its coordinate is not rounded.
                    if is_fixed(axis) || by[axis].abs() <= NEGLIGIBLE_SHARE * by.length() {
                        start[axis]
                    } else {
                        round(start[axis] + by[axis])
                    }
                };
                let target = DVec3::new(part(0), part(1), part(2));
                let words = (target - start).to_array().map(format_signed).join(", ");
                Some((self.move_to(target), words))
            }
            Handle::Radius => {
                let typed = typed.filter(|radius| *radius > 0.0);
                let radius = typed.or_else(|| self.radius(screen, pull.at).map(round))?;
                let subject = self.before.first()?;
                let edit = (radius > 0.0)
                    .then(|| subject.with_radius(radius))
                    .flatten();
                Some((edit, format!("radius {}", format_value(radius))))
            }
            Handle::Size => {
                let typed = typed.filter(|scale_factor| *scale_factor > 0.0);
                let scale_factor = typed.or_else(|| self.scale_factor(screen, pull))?;
                let words = format!("× {}", format_value(scale_factor));
                let scaled = |subject: &Movable| subject.scaled(self.middle, scale_factor);
                Some((self.edit_all("Resize", scaled), words))
            }
            Handle::Corner(corner) => {
                let to = self.pointed_at(screen, pull.at)?;
                let to = DVec3::new(round(to.x), round(to.y), round(to.z));
                let subject = self.before.first()?;
                let Shape::Triangle(mut triangle) = subject.shape()?.clone() else {
                    return None;
                };
                *[&mut triangle.a, &mut triangle.b, &mut triangle.c][corner] = to;
                let words = [to.x, to.y, to.z].map(format_value).join(", ");
                Some((Some(subject.reshaped(triangle.into(), "corner")), words))
            }
            Handle::Normal => self.turn_normal(screen, pull),
            Handle::Turn(axis) => {
                let degrees = typed.or_else(|| self.degrees(screen, axis, pull))?;
                let (direction, name) = AXES[axis];
                let words = format!("{name} {}°", format_signed(degrees));
                let turned = |subject: &Movable| subject.turned(self.middle, (direction, degrees));
                Some((self.edit_all("Rotate", turned), words))
            }
        }
    }

    /// Moves all items so that [`Self::snap_point`] is at `target`.
    fn move_to(&self, target: DVec3) -> Option<Edit> {
        if let [only] = &self.before[..] {
            return Some(only.placed(target));
        }
        self.move_by(target - self.snap_point())
    }

    fn move_by(&self, by: DVec3) -> Option<Edit> {
        self.edit_all("Move", |subject| subject.moved(by))
    }

    /// Combines the edits of all items into one; the edit of a single item stays as it is.
    fn edit_all(&self, verb: &str, edit: impl Fn(&Movable) -> Edit) -> Option<Edit> {
        let mut edits: Vec<Edit> = self.before.iter().map(edit).collect();
        match edits.len() {
            0 | 1 => edits.pop(),
            count => Some(Edit::Each(edits, format!("{verb} {count} items"))),
        }
    }

    /// Ratio of the distances from the middle: of the current screen position to that of the grab.
    fn scale_factor(&self, screen: &Screen, pull: Pull) -> Option<f64> {
        let middle = screen.place(self.middle)?;
        let scale_factor =
            (pull.at - middle).length() / (self.grabbed_at.0 - middle).length().max(1.0);
        let parts = if pull.snaps { 10.0 } else { 100.0 };
        Some((f64::from(scale_factor) * parts).round().max(1.0) / parts)
    }

    /// Distance of the ray through a screen position from the middle; for a disc, distance of the intersection.
    fn radius(&self, screen: &Screen, at: Pos2) -> Option<f64> {
        if let Some(Shape::Disc(disc)) = self.before.first()?.shape() {
            let to = screen.on_plane(at, disc.center, disc.normal)?;
            return Some((to - disc.center).length());
        }
        let (origin, direction) = screen.ray(at);
        Some((self.middle - origin).cross(direction).length())
    }

    fn degrees(&self, screen: &Screen, axis: usize, pull: Pull) -> Option<f64> {
        let to = self.pointed_at(screen, pull.at)? - self.middle;
        let from = self.grabbed_at.1 - self.middle;
        let direction = AXES[axis].0;
        let degrees = direction
            .dot(from.cross(to))
            .atan2(from.dot(to))
            .to_degrees();
        // Past half a turn, the angle continues instead of jumping back.
        let full_turns = ((self.turned_degrees.get() - degrees) / 360.0).round();
        let degrees = degrees + full_turns * 360.0;
        self.turned_degrees.set(degrees);
        let step = if pull.snaps { SNAP_DEGREES } else { 0.5 };
        Some((degrees / step).round() * step)
    }

    /// Turns the normal towards the pointer's position on a sphere around its base.
    fn turn_normal(&self, screen: &Screen, pull: Pull) -> Option<(Option<Edit>, String)> {
        let subject = self.before.first()?;
        let mut shape = subject.shape()?.clone();
        let (Shape::Plane(Plane { point, normal })
        | Shape::Disc(Disc {
            center: point,
            normal,
            ..
        })) = &mut shape
        else {
            return None;
        };
        let length = screen.unit_at(*point) * ARROW_LENGTH * RING_RADIUS;
        // Wherever the arrow was grabbed, its tip moves as the pointer does.
        let tip = screen.place(*point + unit(*normal)? * length)?;
        let (origin, direction) = screen.ray(pull.at + (tip - self.grabbed_at.0));
        let arm = *point - origin;
        let along = arm.dot(direction);
        let off = (arm - direction * along).length();
        let depth = (length * length - off * off).max(0.0).sqrt();
        // On the same side of the sphere as before.
        let depth = if normal.dot(direction) > 0.0 {
            depth
        } else {
            -depth
        };
        let to = (origin + direction * (along + depth) - *point).try_normalize()?;
        let step = if pull.snaps { 0.1 } else { 0.001 };
        let to = DVec3::from_array(to.to_array().map(|part| (part / step).round() * step));
        *normal = to;
        let words = [to.x, to.y, to.z].map(format_value).join(", ");
        Some((Some(subject.reshaped(shape, "normal")), words))
    }

    /// Writes the change beside the pointer.
    pub fn label(&self, painter: &Painter, at: Pos2, words: &str) {
        let words = if self.typed.is_empty() {
            words.to_owned()
        } else {
            let typing_error = self.typing_error();
            typing_error.unwrap_or_else(|| format!("{words} (Enter)"))
        };
        label(painter, at, &words);
    }
}

/// Rounds a value to the resolution of the screen, where a point is `unit` wide, or to a rounder step if it snaps.
fn rounded(value: f64, unit: f64, snaps: bool) -> f64 {
    let step = 10_f64.powf(if snaps {
        (unit * 8.0).log10().ceil()
    } else {
        unit.log10().floor()
    });
    if !step.is_finite() || step == 0.0 {
        return value;
    }
    // Dividing by an integer yields the floats nearest to decimal fractions.
    if step < 1.0 {
        let parts = (1.0 / step).round();
        (value * parts).round() / parts
    } else {
        (value / step).round() * step
    }
}

fn format_value(value: f64) -> String {
    format_number((value * 1e6).round() / 1e6)
}

fn format_signed(value: f64) -> String {
    let sign = if value >= 0.0 { "+" } else { "" };
    format!("{sign}{}", format_value(value))
}

#[cfg(test)]
mod tests {
    use egui::{Rect, pos2, vec2};

    use super::*;
    use crate::editor::{Item, Selection};
    use crate::scene::Scene;

    #[test]
    fn a_size_that_is_typed_is_above_0() {
        let scene = Scene::demo();
        let ball = Movable::new(&scene, Item::object(0)).expect("a ball");
        let mut grip = Grip {
            handle: Handle::Radius,
            ..Grip::free((vec![ball], DVec3::ZERO), Pos2::ZERO, DVec3::ZERO)
        };
        let mut typing_error = |typed: &str| {
            grip.typed = typed.to_owned();
            grip.typing_error()
        };
        assert_eq!(typing_error("2.5"), None);
        assert_eq!(
            typing_error("-5").as_deref(),
            Some("-5 is not greater than 0")
        );
        assert_eq!(
            typing_error("1e").as_deref(),
            Some("1e is not a number yet")
        );
        grip.handle = Handle::Along(0);
        grip.typed = "-5".to_owned();
        assert_eq!(grip.typing_error(), None);
    }

    #[test]
    fn a_ring_counts_the_rounds_it_is_pulled_around() {
        let scene = Scene::demo();
        let view = Rect::from_min_size(pos2(0.0, 0.0), vec2(1000.0, 1000.0));
        let screen = Screen::new(&scene.camera, view).expect("a view");
        let both = Selection::all([Item::object(0), Item::object(1)]);
        let centre = both.middle(&scene).expect("a middle");
        let (both, middle) = (Movable::of(&both, &scene), screen.place(centre));
        // Clockwise on the screen, seen from the tip of the axis.
        let at = |degrees: f32| {
            let angle = -degrees.to_radians();
            middle.expect("in front") + vec2(angle.cos(), angle.sin()) * 100.0
        };
        let grip = Grip::new(&screen, (both, centre), Handle::Turn(2), at(0.0)).expect("a ring");
        let pulled = |degrees: f32| {
            let pull = Pull {
                at: at(degrees),
                snaps: true,
                is_level: false,
            };
            grip.pull(&screen, pull).expect("a turn").1
        };
        // In steps, as a hand does, forwards and far back.
        for degrees in (0..600).chain((-600..=600).rev()).step_by(60) {
            let sign = if degrees < 0 { "" } else { "+" };
            assert_eq!(pulled(degrees as f32), format!("z {sign}{degrees}°"));
        }
    }
}
