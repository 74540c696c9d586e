//! Handles of the selection: arrows and squares to move it, rings to rotate it and to change its radius, a knob to
//! scale what has no radius, dots to move corners.

use std::f64::consts::TAU;

use egui::{Color32, FontId, Painter, Pos2, Stroke, StrokeKind, TextStyle, vec2};
use glam::DVec3;

use super::screen::Screen;
use super::subject::Movable;
use crate::editor::{Editor, Selection};
use crate::scene::{Scene, Shape, unit};
use crate::ui::theme::{GRID, palette};

/// Length of the arrows, in points.
pub const ARROW_LENGTH: f64 = 76.0;
/// Start of the arrows, and extent of the squares between them, in units of [`ARROW_LENGTH`].
const GAP: f64 = 0.16;
const SQUARE: (f64, f64) = (0.3, 0.5);
/// Radius of the rotation rings, in units of [`ARROW_LENGTH`].
pub const RING_RADIUS: f64 = 1.2;
/// The scaling knob's stem, in units of [`ARROW_LENGTH`]: it starts at the rings.
const KNOB_STEM: (f32, f32) = (RING_RADIUS as f32, 1.5);
/// Half the side of the knob, in points.
const KNOB_HALF_SIDE: f32 = 5.0;
/// Maximum distance of the pointer from a handle that it grabs, in points.
const GRAB_DISTANCE: f32 = 7.0;
/// Length of an arrow head, in points.
const HEAD_LENGTH: f32 = 9.0;
/// Minimum length of an arrow that is shown, in points: shorter ones point towards the eye.
const MIN_ARROW_LENGTH: f32 = 14.0;
/// Number of corners of a drawn ring.
const RING_SEGMENTS: usize = 72;
/// The axes and their names.
pub const AXES: [(DVec3, &str); 3] = [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")];

/// A handle that can be grabbed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// Moves along this axis.
    Along(usize),
    /// Moves in the plane perpendicular to this axis.
    Across(usize),
    /// Moves parallel to the picture, or horizontally while Shift is held.
    Free,
    /// Changes the radius.
    Radius,
    /// Scales an item without radius, or several items, about the middle.
    Size,
    /// Moves a corner of a triangle parallel to the picture.
    Corner(usize),
    /// Changes the normal of a plane or a disc.
    Normal,
    /// Rotates about this axis.
    Turn(usize),
}

/// A handle as it is drawn: a dot, a line between two points, or the outline of an area.
struct DrawnHandle {
    handle: Handle,
    line: Vec<Pos2>,
}

impl DrawnHandle {
    fn distance(&self, at: Pos2) -> f32 {
        let nearest = sides(&self.line)
            .map(|(a, b)| {
                let along = b - a;
                let share = (at - a).dot(along) / along.length_sq().max(f32::EPSILON);
                (a + along * share.clamp(0.0, 1.0) - at).length()
            })
            .fold(f32::INFINITY, f32::min);
        match (self.handle, self.line.first()) {
            (Handle::Across(_), _) if is_inside(&self.line, at) => 0.0,
            // Dots take precedence over the lines that end in them.
            (Handle::Free | Handle::Corner(_), Some(dot)) => ((*dot - at).length() - 2.0).max(0.0),
            // So do arrow heads, which are drawn over what passes through them.
            (Handle::Along(_) | Handle::Size | Handle::Normal, _) => {
                let head = self
                    .line
                    .last()
                    .map_or(f32::INFINITY, |tip| (*tip - at).length());
                // The arrow of an axis in the same line is drawn over a normal.
                let is_below = self.handle == Handle::Normal;
                let nearest = nearest + if is_below { 0.5 } else { 0.0 };
                nearest.min(head - HEAD_LENGTH)
            }
            _ => nearest,
        }
    }
}

/// The segments of a closed polygon.
fn sides(line: &[Pos2]) -> impl Iterator<Item = (Pos2, Pos2)> {
    let next = line.iter().cycle().skip(1);
    line.iter().zip(next).map(|(from, to)| (*from, *to))
}

fn is_inside(corners: &[Pos2], at: Pos2) -> bool {
    let mut sides = sides(corners).map(|(from, to)| {
        let (along, arm) = (to - from, at - from);
        along.x * arm.y - along.y * arm.x > 0.0
    });
    let first = sides.next();
    sides.all(|side| Some(side) == first)
}

/// A circle around an axis of unit length, on the screen.
fn ring(screen: &Screen, middle: DVec3, axis: DVec3, radius: f64) -> Vec<Pos2> {
    let (u, v) = axis.any_orthonormal_pair();
    let at = |n: usize| {
        let (sine, cosine) = (n as f64 / RING_SEGMENTS as f64 * TAU).sin_cos();
        screen.place(middle + (u * cosine + v * sine) * radius)
    };
    let all: Option<Vec<Pos2>> = (0..RING_SEGMENTS).map(at).collect();
    all.unwrap_or_default()
}

/// The visible contour of a sphere.
fn sphere_outline(screen: &Screen, center: DVec3, radius: f64) -> Vec<Pos2> {
    let Some(at) = screen.place(center) else {
        return Vec::new();
    };
    let (origin, axis) = screen.ray(at);
    let arm = center - origin;
    let distance = arm.length();
    // Parallel rays may start anywhere along the axis; the contour is the circle around the centre.
    let is_parallel =
        axis.dot(screen.forward()) > 1.0 - 1e-12 && screen.ray(screen.view.min).1 == axis;
    if is_parallel {
        return ring(screen, center, axis, radius);
    }
    if distance <= radius {
        return Vec::new();
    }
    let offset = radius * radius / distance;
    let outline_radius = radius * (1.0 - (radius / distance).powi(2)).sqrt();
    ring(screen, center - axis * offset, axis, outline_radius)
}

/// All handles of the selection.
fn handles(screen: &Screen, selected: &Selection, scene: &Scene) -> Vec<DrawnHandle> {
    let Some(middle) = selected.pivot(scene) else {
        return Vec::new();
    };
    // With many items selected, none is cloned, as this runs in every frame.
    let only = selected
        .only_placed()
        .and_then(|item| Movable::new(scene, item));
    let Some(place) = screen.place(middle) else {
        return Vec::new();
    };
    let length = screen.unit_at(middle) * ARROW_LENGTH;
    let mut drawn = Vec::new();
    let mut add = |handle: Handle, line: Option<Vec<Pos2>>| {
        if let Some(line) = line.filter(|line| !line.is_empty()) {
            drawn.push(DrawnHandle { handle, line });
        }
    };
    let at = |point: DVec3| screen.place(point);
    if let Some(subject) = &only {
        shape_handles(screen, subject, length, &mut add);
    }
    for (axis, (direction, _)) in AXES.iter().enumerate() {
        let line = at(middle + *direction * length * GAP).zip(at(middle + *direction * length));
        let line = line.filter(|(from, to)| (*to - *from).length() >= MIN_ARROW_LENGTH);
        add(Handle::Along(axis), line.map(|(from, to)| vec![from, to]));
        let (u, v) = (AXES[(axis + 1) % 3].0, AXES[(axis + 2) % 3].0);
        let corner = |a: f64, b: f64| at(middle + (u * a + v * b) * length);
        let (near, far) = SQUARE;
        let square: Option<Vec<Pos2>> = [
            corner(near, near),
            corner(far, near),
            corner(far, far),
            corner(near, far),
        ]
        .into_iter()
        .collect();
        let is_edge_on = |line: &Vec<Pos2>| {
            let (a, b) = (line[1] - line[0], line[3] - line[0]);
            (a.x * b.y - a.y * b.x).abs() < MIN_ARROW_LENGTH
        };
        add(
            Handle::Across(axis),
            square.filter(|line| !is_edge_on(line)),
        );
        if only.as_ref().is_none_or(is_mesh) {
            let line = ring(screen, middle, *direction, length * RING_RADIUS);
            add(Handle::Turn(axis), Some(line));
        }
    }
    if only.as_ref().is_none_or(has_size) {
        let diagonal = vec2(
            std::f32::consts::FRAC_1_SQRT_2,
            -std::f32::consts::FRAC_1_SQRT_2,
        );
        let (from, to) = KNOB_STEM;
        let line = vec![
            place + diagonal * from * ARROW_LENGTH as f32,
            place + diagonal * to * ARROW_LENGTH as f32,
        ];
        add(Handle::Size, Some(line));
    }
    add(Handle::Free, Some(vec![place]));
    drawn
}

/// Returns whether a single item can be scaled and has no radius.
fn has_size(subject: &Movable) -> bool {
    matches!(subject.shape(), Some(Shape::Mesh(_) | Shape::Triangle(_)))
}

/// Returns whether a single item can be rotated about its middle; several items can always be rotated about a
/// common one.
fn is_mesh(subject: &Movable) -> bool {
    matches!(subject.shape(), Some(Shape::Mesh(_)))
}

/// Adds the handles that only this kind of item has.
fn shape_handles(
    screen: &Screen,
    subject: &Movable,
    length: f64,
    add: &mut impl FnMut(Handle, Option<Vec<Pos2>>),
) {
    let normal = |from: DVec3, normal: DVec3| {
        let tip = from + unit(normal)? * length * RING_RADIUS;
        Some(vec![screen.place(from)?, screen.place(tip)?])
    };
    match subject {
        Movable::Light(_, light) => {
            let radius = light.marker.as_ref().map(|marker| marker.radius);
            let line = radius.map(|radius| sphere_outline(screen, light.position, radius));
            add(Handle::Radius, line);
        }
        Movable::Object(_, object) => match &object.shape {
            Shape::Sphere(ball) => {
                add(
                    Handle::Radius,
                    Some(sphere_outline(screen, ball.center, ball.radius)),
                );
            }
            Shape::Disc(disc) => {
                let axis = unit(disc.normal).unwrap_or(DVec3::Y);
                let rim = ring(screen, disc.center, axis, disc.radius);
                add(Handle::Radius, Some(rim));
                add(Handle::Normal, normal(disc.center, disc.normal));
            }
            Shape::Plane(plane) => add(Handle::Normal, normal(plane.point, plane.normal)),
            Shape::Triangle(triangle) => {
                for (corner, point) in triangle.corners().into_iter().enumerate() {
                    let dot = screen.place(point).map(|dot| vec![dot]);
                    add(Handle::Corner(corner), dot);
                }
            }
            Shape::Mesh(_) => {}
        },
    }
}

/// The handle under the pointer.
pub fn handle_at(screen: &Screen, selected: &Selection, scene: &Scene, at: Pos2) -> Option<Handle> {
    let drawn = handles(screen, selected, scene);
    let near = drawn.iter().map(|drawn| (drawn.distance(at), drawn.handle));
    let near = near.filter(|(distance, _)| *distance <= GRAB_DISTANCE);
    near.min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, handle)| handle)
}

/// Draws the handles, with the hovered or dragged one highlighted.
pub fn show(painter: &Painter, screen: &Screen, editor: &Editor, highlighted: Option<Handle>) {
    let colors = palette(painter.ctx());
    let (selected, scene) = (editor.selection(), editor.shown());
    for DrawnHandle { handle, line } in handles(screen, selected, scene) {
        let is_highlighted = highlighted == Some(handle);
        let color = match handle {
            _ if is_highlighted => colors.accent,
            Handle::Along(axis) | Handle::Across(axis) | Handle::Turn(axis) => colors.axes[axis],
            _ => colors.on_picture,
        };
        let width = if is_highlighted { 3.0 } else { 2.0 };
        draw(painter, (handle, &line), Stroke::new(width, color));
    }
}

fn draw(painter: &Painter, (handle, line): (Handle, &[Pos2]), stroke: Stroke) {
    let halo = Stroke::new(stroke.width + 2.0, palette(painter.ctx()).halo);
    match (handle, line) {
        (Handle::Free | Handle::Corner(_), [dot]) => {
            painter.circle(*dot, 5.0, stroke.color, Stroke::new(1.5, halo.color));
        }
        (Handle::Across(_), corners) => {
            let fill = stroke.color.gamma_multiply(0.35);
            let edge = Stroke::new(1.0, stroke.color);
            painter.add(egui::Shape::convex_polygon(corners.to_vec(), fill, edge));
        }
        (Handle::Along(_) | Handle::Normal, [from, to]) => {
            for stroke in [halo, stroke] {
                painter.line_segment([*from, *to], stroke);
            }
            arrow_head(painter, *from, *to, stroke.color, halo.color);
        }
        (Handle::Size, [from, to]) => {
            for stroke in [halo, stroke] {
                painter.line_segment([*from, *to], stroke);
            }
            let knob = egui::Rect::from_center_size(*to, egui::Vec2::splat(KNOB_HALF_SIDE * 2.0));
            let edge = Stroke::new(1.0, halo.color);
            painter.rect(knob, 1, stroke.color, edge, StrokeKind::Outside);
        }
        (_, points) => {
            // Separate segments, as the joins of a polyline that turns back on itself would form spikes.
            for stroke in [halo, stroke] {
                for (from, to) in sides(points) {
                    painter.line_segment([from, to], stroke);
                }
            }
        }
    }
}

fn arrow_head(painter: &Painter, from: Pos2, to: Pos2, color: Color32, halo: Color32) {
    let along = (to - from).normalized();
    let across = vec2(-along.y, along.x);
    let tip = vec![
        to + along * HEAD_LENGTH,
        to + across * 5.0,
        to - across * 5.0,
    ];
    painter.add(egui::Shape::convex_polygon(
        tip,
        color,
        Stroke::new(1.0, halo),
    ));
}

/// Draws a text box beside the pointer.
pub fn label(painter: &Painter, at: Pos2, words: &str) {
    let colors = palette(painter.ctx());
    let font: FontId = TextStyle::Monospace.resolve(&painter.ctx().global_style());
    let text = painter.layout_no_wrap(words.to_owned(), font, colors.text);
    let corner = at + vec2(2.0 * GRID, 2.0 * GRID);
    let rect = egui::Rect::from_min_size(corner, text.size()).expand2(vec2(6.0, 3.0));
    // Kept within the picture.
    let overflow = (painter.clip_rect().max - rect.max).min(egui::Vec2::ZERO);
    let rect = rect.translate(overflow);
    painter.rect(
        rect,
        4,
        colors.panel,
        Stroke::new(1.0, colors.line),
        StrokeKind::Inside,
    );
    painter.galley(rect.min + vec2(6.0, 3.0), text, colors.text);
}
