//! Graph of the camera's speed and turn rate per frame, with marks where they jump.

use egui::{Ui, Vec2b, vec2};
use egui_plot::{HoverPosition, Line, MarkerShape, Plot, PlotPoint, PlotPoints, Points};

use super::scale::Scale;
use crate::animate::{CameraChange, CameraPath, motion_between};
use crate::editor::Editor;
use crate::scene::{Animation, Camera, Interpolation, Key, SAME_TIME};
use crate::ui::hint::Hinted as _;
use crate::ui::theme::{GRAPH, palette};
use crate::words::counted;

/// Maximum number of steps; longer flights are sampled more coarsely.
const MAX_STEPS: u64 = 4000;
/// A step is a jump if it exceeds the mean and a neighbouring step by this factor.
const JUMP_FACTOR: f64 = 4.0;
/// Turns below this are no jumps, in degrees per step.
const MIN_JUMP_TURN: f64 = 0.25;
/// Steps below this fraction of the largest coordinate are rounding errors.
const NOISE: f64 = 1e-9;
/// Turns below this are rounding errors, in degrees per step.
const NOISE_TURN: f64 = 1e-6;
/// Faster turns are hard to watch, in degrees per second.
const MAX_WATCHABLE_TURN: f64 = 120.0;

/// The curves of the current flight.
#[derive(Default)]
pub struct Graph {
    made_for: Option<(Vec<Key<Camera>>, f64)>,
    steps: Vec<MotionStep>,
}

/// The motion from one sampled frame to the next.
#[derive(Clone, Copy, Debug)]
struct MotionStep {
    time: f64,
    /// World units per second.
    speed: f64,
    /// Degrees per second.
    turn: f64,
    /// Whether it is a jump, or turns too fast to watch.
    is_rough: bool,
}

impl Graph {
    /// Draws speed and turn rate, each relative to its maximum.
    pub fn show(&mut self, ui: &mut Ui, scale: &Scale, editor: &Editor) {
        self.update(editor);
        let colors = palette(ui.ctx());
        let highest = |of: fn(&MotionStep) -> f64| self.steps.iter().map(of).fold(0.0, f64::max);
        let (fastest, sharpest) = (highest(|step| step.speed), highest(|step| step.turn));
        let line = |of: fn(&MotionStep) -> f64, max: f64| {
            let at = |step: &MotionStep| [step.time, if max > 0.0 { of(step) / max } else { 0.0 }];
            self.steps.iter().map(at).collect::<Vec<[f64; 2]>>()
        };
        let rough = self.steps.iter().filter(|step| step.is_rough).count();
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let label = scale.left - ui.max_rect().left();
            ui.allocate_ui(vec2(label, GRAPH), |ui| {
                ui.vertical(|ui| {
                    ui.set_width(label);
                    ui.small(egui::RichText::new(format!("speed ≤ {fastest:.1}/s")).color(colors.curve));
                    ui.small(egui::RichText::new(format!("turn ≤ {sharpest:.0}°/s")).color(colors.muted));
                    if rough > 0 {
                        let text = egui::RichText::new(counted(rough, "abrupt change")).color(colors.accent);
                        ui.small(text).hint("Frames where speed or turn rate changes abruptly, or the view turns by more than 120° a second");
                    }
                });
            });
            Plot::new("speed of the flight")
                .width(scale.width)
                .height(GRAPH)
                .show_axes(Vec2b::FALSE)
                .show_grid(Vec2b::FALSE)
                .allow_drag(false)
                .allow_zoom(false)
                .allow_scroll(false)
                .allow_boxed_zoom(false)
                .allow_double_click_reset(false)
                .set_margin_fraction(vec2(0.0, 0.0))
                .auto_bounds(Vec2b::FALSE)
                .default_x_bounds(scale.start, scale.end)
                .default_y_bounds(-0.05, 1.1)
                .label_formatter(|hover| self.label(hover))
                .show(ui, |plot| {
                    plot.set_plot_bounds_x(scale.start..=scale.end);
                    let speed = line(|step| step.speed, fastest);
                    plot.line(Line::new("speed", speed).color(colors.curve));
                    let turn = line(|step| step.turn, sharpest);
                    plot.line(Line::new("turn", turn).color(colors.muted));
                    let at = |step: &MotionStep| [step.time, 1.0];
                    let rough = self.steps.iter().filter(|step| step.is_rough);
                    let rough: Vec<[f64; 2]> = rough.map(at).collect();
                    let marks = Points::new("jump", PlotPoints::from(rough));
                    plot.points(marks.shape(MarkerShape::Down).radius(4.0).color(colors.accent));
                    let now = editor.shown_time();
                    let playhead = vec![[now, -1.0], [now, 2.0]];
                    plot.line(Line::new("playhead", playhead).color(colors.accent).width(1.0));
                });
        });
    }

    fn label(&self, hover: &HoverPosition) -> Option<String> {
        let (HoverPosition::NearDataPoint { position, .. } | HoverPosition::Elsewhere { position }) =
            hover;
        let PlotPoint { x, .. } = *position;
        let nearest = self.steps.iter();
        let nearest = nearest.min_by(|a, b| (a.time - x).abs().total_cmp(&(b.time - x).abs()))?;
        Some(format!(
            "{:.2} s: {:.1}/s, {:.0}°/s",
            nearest.time, nearest.speed, nearest.turn
        ))
    }

    fn update(&mut self, editor: &Editor) {
        let Animation {
            keys,
            frames_per_second,
            ..
        } = &*editor.scene().animation;
        let is_same =
            |made: &(Vec<Key<Camera>>, f64)| made.0 == *keys && made.1 == *frames_per_second;
        if !self.made_for.as_ref().is_some_and(is_same) {
            self.made_for = Some((keys.clone(), *frames_per_second));
            self.steps = steps(&editor.scene().animation, editor.path_of_camera());
        }
    }
}

fn steps(animation: &Animation, path: &CameraPath) -> Vec<MotionStep> {
    let (count, fps) = (animation.frame_count(), animation.frames_per_second);
    let stride = count.div_ceil(MAX_STEPS).max(1);
    let frames: Vec<u64> = (1..=count).step_by(stride as usize).collect();
    let motion = |pair: &[u64]| {
        let [from, to] = [pair[0], pair[1]].map(|frame| path.at(animation.time_of(frame)));
        let still = CameraChange::default();
        from.zip(to)
            .map_or(still, |(from, to)| motion_between(&from, &to))
    };
    let motions: Vec<CameraChange> = frames.windows(2).map(motion).collect();
    let motion_count = motions.len().max(1) as f64;
    let mean = |of: fn(&CameraChange) -> f64| motions.iter().map(of).sum::<f64>() / motion_count;
    let (mean_distance, mean_turn) = (mean(|m| m.distance), mean(|m| m.turn));
    // Motion caused by rounding alone does not count.
    let reaches = animation
        .keys
        .iter()
        .map(|key| key.value.position.abs().max_element());
    let noise = reaches.fold(0.0, f64::max) * NOISE;
    let per_second = fps / stride as f64;
    let pairs = animation.keys.windows(2);
    let cuts = pairs.filter(|pair| pair[0].interpolation == Interpolation::Hold);
    let cuts: Vec<f64> = cuts.map(|pair| pair[1].time).collect();
    let step = |index: usize| {
        let (from, time) = (frames[index], animation.time_of(frames[index + 1]));
        let earlier = cuts.partition_point(|cut| *cut <= animation.time_of(from));
        let is_cut = cuts
            .get(earlier)
            .is_some_and(|cut| *cut <= time + SAME_TIME);
        let neighbours = [index.checked_sub(1), Some(index + 1)];
        let is_jump = |of: fn(&CameraChange) -> f64, mean: f64| {
            let value = of(&motions[index]);
            let neighbours = neighbours
                .into_iter()
                .flatten()
                .filter_map(|neighbour| motions.get(neighbour));
            value > JUMP_FACTOR * mean
                && neighbours
                    .map(of)
                    .any(|neighbour| value > JUMP_FACTOR * neighbour)
        };
        let CameraChange { distance, turn, .. } = motions[index];
        let distance = if distance > noise { distance } else { 0.0 };
        let turn = if turn > NOISE_TURN { turn } else { 0.0 };
        let is_jump = is_jump(|m| m.distance, mean_distance.max(noise))
            || is_jump(|m| m.turn, mean_turn.max(MIN_JUMP_TURN / JUMP_FACTOR));
        MotionStep {
            time,
            speed: if is_cut { 0.0 } else { distance * per_second },
            turn: if is_cut { 0.0 } else { turn * per_second },
            is_rough: !is_cut && (is_jump || turn * per_second > MAX_WATCHABLE_TURN),
        }
    };
    (0..motions.len()).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn flight(places: &[(f64, f64)]) -> Animation {
        let key = |&(time, x): &(f64, f64)| {
            let camera = Camera {
                position: DVec3::new(x, 0.0, 0.0),
                ..Camera::default()
            };
            let mut key = Key::new(time, camera);
            key.interpolation = Interpolation::Linear;
            key
        };
        Animation {
            frames_per_second: 10.0,
            keys: places.iter().map(key).collect(),
            ..Animation::default()
        }
    }

    fn rough(animation: &Animation) -> Vec<f64> {
        let steps = steps(animation, &CameraPath::new(&animation.keys));
        let rough = steps.iter().filter(|step| step.is_rough);
        rough.map(|step| step.time).collect()
    }

    #[test]
    fn a_jump_is_told_and_a_cut_is_not() {
        let even = flight(&[(0.0, 0.0), (2.0, 20.0), (4.0, 40.0)]);
        assert!(rough(&even).is_empty());
        // A still camera whose position varies in the last digit only.
        let still = flight(&[
            (0.0, 300.0),
            (1.0, 300.0),
            (1.1, 300.000_000_000_1),
            (4.0, 300.0),
        ]);
        assert!(rough(&still).is_empty());
        let mut jumpy = flight(&[(0.0, 0.0), (2.0, 20.0), (2.1, 90.0), (4.0, 109.0)]);
        assert_eq!(rough(&jumpy), [2.1]);
        jumpy.keys[1].interpolation = Interpolation::Hold;
        assert!(rough(&jumpy).is_empty());
    }
}
