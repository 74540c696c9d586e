//! Where on the line of time the editor is: the playhead, playing, recording.

use std::sync::Arc;

use crate::animate::{Landmark, Worst};
use crate::scene::{Animation, Camera, MAX_KEYS, MAX_SECONDS, Orientation, Scene, Take};

/// The picture that a deviation is told for, in pixels.
pub const MEASURED_AT: f64 = 1024.0;

/// What happens at the ends of the timeline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repeat {
    /// It stops.
    Once,
    /// It starts again.
    #[default]
    Loop,
    /// It turns back.
    PingPong,
}

/// Something asked of the timeline.
#[derive(Clone, Debug)]
pub enum Time {
    /// Put the playhead at the frame nearest to so many seconds.
    Seek(f64),
    /// The flight from this time on takes so many times as long: the playhead stays where it is in it.
    Stretched(f64, f64),
    /// Put it so many frames further, or back.
    Step(i64),
    /// Play or pause.
    Play(bool),
    /// So many seconds have passed.
    Tick(f64),
    /// What happens at the ends.
    Repeat(Repeat),
    /// Playing speed, 1 is real time.
    Speed(f64),
    /// Show the picture of the shot camera, or the one of the view.
    LookThrough(bool),
    /// Start to record what the camera does.
    Record,
    /// The camera as it is, at this time of the clock in seconds, is part of the recording.
    Sample(f64),
    /// Make keys of what was recorded.
    Stop,
    /// What the samples of a take see, which was asked for, see `Editor::wanted_survey`.
    Surveyed(Arc<Take>, Vec<Vec<Landmark>>),
    /// Make keys of the take anew: off by so many pixels of a picture 1024 high at most.
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
    /// 1 is real time.
    pub speed: f64,
    /// Whether the picture is that of the shot camera, if there are keys.
    pub(super) wants_shot: bool,
    /// How far keys made of a take may be off, in pixels of a picture 1024 high.
    pub tolerance: f64,
    /// Where the keys are off the recording the most, in the same pixels; `None` without one.
    pub worst: Option<Worst>,
    /// How often the view jumped in the flight that was made into keys last.
    pub jumps: usize,
    /// Whether the keys are others than were made of the recording.
    pub is_edited: bool,
    /// Whether the user has chosen to see the shot camera from outside.
    pub(super) stays_outside: bool,
    /// Whether the view was flown by hand since it was that of the shot camera.
    pub(super) is_flown: bool,
    is_returning: bool,
    pub(super) recording: Option<Recording>,
}

/// What is looked at, and when.
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
    /// What the clock showed at the first sample.
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

    pub(super) fn look(&self) -> ViewState {
        ViewState {
            wants_shot: self.wants_shot,
            is_flown: self.is_flown,
            playhead: self.playhead,
        }
    }

    /// Looks at what was looked at before a step that is taken back, or done again, if that has moved the view, or the
    /// times of keys, from `here` to `there`.
    pub(super) fn look_again(&mut self, before: ViewState, here: &Scene, there: &Scene) {
        if here.camera != there.camera {
            (self.wants_shot, self.is_flown) = (before.wants_shot, before.is_flown);
        }
        let [here, there] = [here, there].map(|scene| &scene.animation.keys[..]);
        let is_same_way =
            here.len() == there.len() && here.iter().zip(there).all(|(a, b)| a.value == b.value);
        // As long or short as it was before, all but its start comes at other times.
        let mut later = here.iter().zip(there).skip(1);
        if is_same_way && here.len() > 1 && later.all(|(a, b)| a.time != b.time) {
            self.playhead = before.playhead;
        }
    }

    /// Samples recorded so far, and their seconds; `None` while nothing is recorded.
    pub fn recorded(&self) -> Option<(usize, f64)> {
        let take = &self.recording.as_ref()?.take;
        Some((
            take.samples.len(),
            take.samples.last().map_or(0.0, |last| last.0),
        ))
    }

    /// Whether what is recorded is as long as it can be.
    pub(super) fn is_full(&self) -> bool {
        let count = self.recorded().map_or(0, |(count, _)| count);
        count >= MAX_KEYS
    }

    /// The time that is on show: that of the frame that the playhead has reached.
    pub fn shown_time(&self, animation: &Animation) -> f64 {
        animation.time_of(animation.frame_at(self.playhead))
    }

    pub(super) fn seek(&mut self, animation: &Animation, seconds: f64) {
        self.playhead = animation.time_of(animation.nearest_frame(seconds));
        self.is_returning = false;
    }

    /// It is not on a frame then: to be drawn back and forth takes it nowhere else.
    pub(super) fn stretch(&mut self, from: f64, by: f64) {
        if self.playhead > from {
            self.playhead = (from + (self.playhead - from) * by).min(MAX_SECONDS);
        }
    }

    /// Whether the shot camera is on its way at the time that is on show.
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

    /// Time passes; at the ends, what was chosen happens.
    pub(super) fn tick(&mut self, seconds: f64, animation: &Animation) {
        if !self.is_playing {
            return;
        }
        if let Some((_, recorded)) = self.recorded() {
            // What is seen meanwhile is what is seen when that is played: it does not begin again.
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
                let round = animation.seconds_of_round();
                let is_in = self.playhead < round;
                let start = if is_in { self.playhead } else { 0.0 };
                self.playhead = (start + step).rem_euclid(round);
            }
            Repeat::PingPong => {
                // On a line whose second half is the way back; both have the last frame in common, which is on show as
                // long as others.
                let frame = 1.0 / animation.frames_per_second;
                let last = animation.time_of(animation.frame_count());
                let behind = last + frame;
                let there = if self.is_returning {
                    last + behind - self.playhead
                } else {
                    self.playhead
                };
                let there = (there + step).rem_euclid((2.0 * last).max(frame));
                self.is_returning = there >= behind;
                self.playhead = if self.is_returning {
                    last + behind - there
                } else {
                    there
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
