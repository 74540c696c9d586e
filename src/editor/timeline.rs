//! The state of the timeline: playhead, playback, recording.

use std::sync::Arc;

use crate::animate::{Landmark, WorstDeviation};
use crate::scene::{Animation, Camera, MAX_KEYS, MAX_SECONDS, Orientation, Scene, Take};

/// Height, in pixels, of the picture that deviations are given for.
pub const REFERENCE_HEIGHT: f64 = 1024.0;

/// What happens at the ends of the timeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repeat {
    /// Playback stops.
    Once,
    /// Playback starts again from the beginning.
    #[default]
    Loop,
    /// Playback reverses.
    PingPong,
}

/// A request to the timeline.
#[derive(Clone, Debug)]
pub enum Time {
    /// Put the playhead at the frame nearest to this time, in seconds.
    Seek(f64),
    /// The flight from this time on, in seconds, was stretched by this factor: the playhead keeps its place in the
    /// flight.
    Stretched(f64, f64),
    /// Move the playhead by this many frames.
    Step(i64),
    /// Play or pause.
    Play(bool),
    /// This many seconds have passed.
    Tick(f64),
    /// Choose what happens at the ends.
    Repeat(Repeat),
    /// Set the playback speed; 1 is real time.
    Speed(f64),
    /// Look through the shot camera, or else through the view's own camera.
    LookThrough(bool),
    /// Start to record the movement of the camera.
    Record,
    /// Add the current camera to the recording, at this clock time in seconds.
    Sample(f64),
    /// Stop recording and make keys of the recording.
    Stop,
    /// The survey of a take that was requested by `Editor::wanted_survey`: what its samples see.
    Surveyed(Arc<Take>, Vec<Vec<Landmark>>),
    /// Make keys of the take again, with this tolerance in pixels of a picture 1024 high.
    Simplify(f64),
}

/// The state of the timeline; changed by [`Time`] actions.
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
#[derive(Clone, Debug)]
pub struct Timeline {
    /// Seconds from the start.
    pub playhead: f64,
    /// Whether time passes.
    pub is_playing: bool,
    /// What happens at the ends.
    pub repeat: Repeat,
    /// Playback speed; 1 is real time.
    pub speed: f64,
    /// Whether to look through the shot camera, if there are keys.
    pub(super) wants_shot: bool,
    /// Largest deviation of keys from their take, in pixels of a picture 1024 high.
    pub tolerance: f64,
    /// Where the keys deviate from the recording the most, in the same pixels; `None` without a recording.
    pub worst: Option<WorstDeviation>,
    /// Number of jumps of the view in the flight that was last made into keys.
    pub jumps: usize,
    /// Whether the keys differ from those made of the recording.
    pub is_edited: bool,
    /// Whether the user has chosen not to look through the shot camera.
    pub(super) stays_outside: bool,
    /// Whether the view was flown by hand since it last was that of the shot camera.
    pub(super) is_flown: bool,
    is_returning: bool,
    pub(super) recording: Option<Recording>,
}

/// What is looked at, and at which time.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewState {
    wants_shot: bool,
    is_flown: bool,
    /// Seconds from the start.
    playhead: f64,
}

/// A flight that is being recorded.
#[derive(Clone, Debug)]
pub(super) struct Recording {
    pub take: Take,
    /// Clock time of the first sample, in seconds.
    start: Option<f64>,
}

impl Default for Timeline {
    fn default() -> Self {
        Self {
            playhead: 0.0,
            is_playing: false,
            repeat: Repeat::default(),
            speed: 1.0,
            wants_shot: false,
            tolerance: 1.0,
            worst: None,
            jumps: 0,
            is_edited: false,
            stays_outside: false,
            is_flown: false,
            is_returning: false,
            recording: None,
        }
    }
}

impl Timeline {
    /// Whether the picture is that of the shot camera.
    pub fn looks_through(&self, animation: &Animation) -> bool {
        self.wants_shot && !animation.keys.is_empty()
    }

    pub(super) fn view_state(&self) -> ViewState {
        ViewState {
            wants_shot: self.wants_shot,
            is_flown: self.is_flown,
            playhead: self.playhead,
        }
    }

    /// On undo or redo of a step that leads from the scene `from` to `to`: restores the view from `before` the
    /// step if the step moved the camera, and the playhead if the step changed the length of the flight.
    pub(super) fn restore_view(&mut self, before: ViewState, from: &Scene, to: &Scene) {
        if from.camera != to.camera {
            (self.wants_shot, self.is_flown) = (before.wants_shot, before.is_flown);
        }
        let [from, to] = [from, to].map(|scene| &scene.animation.keys[..]);
        let is_same_path =
            from.len() == to.len() && from.iter().zip(to).all(|(a, b)| a.value == b.value);
        // A step that stretches the flight changes the times of all keys but the first.
        let mut later_pairs = from.iter().zip(to).skip(1);
        if is_same_path && from.len() > 1 && later_pairs.all(|(a, b)| a.time != b.time) {
            self.playhead = before.playhead;
        }
    }

    /// The number of samples recorded so far, and their duration in seconds; `None` if nothing is being recorded.
    pub fn recorded(&self) -> Option<(usize, f64)> {
        let take = &self.recording.as_ref()?.take;
        Some((
            take.samples.len(),
            take.samples.last().map_or(0.0, |last| last.0),
        ))
    }

    /// Whether the recording has reached its greatest length.
    pub(super) fn is_full(&self) -> bool {
        let count = self.recorded().map_or(0, |(count, _)| count);
        count >= MAX_KEYS
    }

    /// The time that is shown: that of the frame that the playhead has reached.
    pub fn shown_time(&self, animation: &Animation) -> f64 {
        animation.time_of(animation.frame_at(self.playhead))
    }

    /// Seconds of playback until another frame is shown.
    pub fn time_to_next_frame(&self, animation: &Animation) -> f64 {
        let shown_for = self.playhead - self.shown_time(animation);
        if self.is_returning {
            shown_for / self.speed
        } else {
            (1.0 / animation.frames_per_second - shown_for) / self.speed
        }
    }

    pub(super) fn seek(&mut self, animation: &Animation, seconds: f64) {
        self.playhead = animation.time_of(animation.nearest_frame(seconds));
        self.is_returning = false;
    }

    /// Moves the playhead with a flight that is stretched by `by` from the time `from` on. The playhead is not
    /// rounded to a frame, so that stretching back and forth during a drag returns it to where it was.
    pub(super) fn stretch(&mut self, from: f64, by: f64) {
        if self.playhead > from {
            self.playhead = (from + (self.playhead - from) * by).min(MAX_SECONDS);
        }
    }

    /// Whether the shown time is within the flight of the shot camera.
    pub(super) fn is_in_flight(&self, animation: &Animation) -> bool {
        let time = self.shown_time(animation);
        match &animation.keys[..] {
            [first, .., last] => {
                // Keys may be between frames.
                (first.time..=last.time).contains(&time) || animation.key_at(time).is_some()
            }
            _ => false,
        }
    }

    /// Advances the playhead if it is playing; at the ends, follows [`Self::repeat`].
    pub(super) fn tick(&mut self, seconds: f64, animation: &Animation) {
        if !self.is_playing {
            return;
        }
        if let Some((_, recorded)) = self.recorded() {
            // Playing the recording later shows the scene at the same times as it was shown while recording: the
            // playhead does not wrap.
            self.playhead = recorded;
            return;
        }
        let step = seconds * self.speed;
        let duration = animation.duration();
        match self.repeat {
            _ if duration <= 0.0 => self.is_playing = false,
            Repeat::Once => {
                self.playhead += step;
                if self.playhead >= duration {
                    self.playhead = duration;
                    self.is_playing = false;
                }
            }
            Repeat::Loop => {
                let round = animation.loop_duration();
                let is_within = self.playhead < round;
                let start = if is_within { self.playhead } else { 0.0 };
                self.playhead = (start + step).rem_euclid(round);
            }
            Repeat::PingPong => {
                // Positions on a line whose second half is the way back. Both halves share the last frame, which is
                // shown as long as any other.
                let frame = 1.0 / animation.frames_per_second;
                let last = animation.time_of(animation.frame_count());
                let end = last + frame;
                let position = if self.is_returning {
                    last + end - self.playhead
                } else {
                    self.playhead
                };
                let position = (position + step).rem_euclid((2.0 * last).max(frame));
                self.is_returning = position >= end;
                self.playhead = if self.is_returning {
                    last + end - position
                } else {
                    position
                };
            }
        }
    }

    pub(super) fn play(&mut self, is_playing: bool, animation: &Animation) {
        self.is_playing = is_playing;
        if !is_playing {
            self.playhead = self.shown_time(animation);
        } else if let Some((_, seconds)) = self.recorded() {
            self.playhead = seconds;
        } else if self.repeat == Repeat::Once
            && animation.frame_at(self.playhead) >= animation.frame_count()
        {
            self.playhead = 0.0;
        }
    }

    pub(super) fn record(&mut self) {
        self.is_playing = false;
        self.recording = Some(Recording {
            take: Take::default(),
            start: None,
        });
    }

    pub(super) fn sample(&mut self, now: f64, camera: &Camera, angles: Orientation) {
        if let Some(recording) = &mut self.recording {
            let start = *recording.start.get_or_insert(now);
            recording.take.push(now - start, camera, angles);
        }
    }
}
