//! The playhead in real time.

use egui::Context;

use crate::editor::{Action, Editor, Time};

/// Advances the playhead by real time during playback, and requests a repaint for the next frame.
pub fn advance_playback(ctx: &Context, editor: &mut Editor) {
    if !editor.timeline().is_playing {
        return;
    }
    let passed = ctx.input(|input| input.unstable_dt);
    editor.apply(Action::Time(Time::Tick(f64::from(passed))));
    let timeline = editor.timeline();
    let animation = &editor.scene().animation;
    let frame = 1.0 / animation.frames_per_second;
    let remaining = timeline.time_to_next_frame(animation);
    ctx.request_repaint_after_secs(remaining.clamp(0.002, frame) as f32);
}

/// Pauses playback once a text is edited: what is typed into a field would be lost when its value changes.
pub fn pause_for_typing(ctx: &Context, editor: &mut Editor) {
    let timeline = editor.timeline();
    let is_playing = timeline.is_playing && timeline.recorded().is_none();
    if is_playing && ctx.text_edit_focused() {
        editor.apply(Action::Time(Time::Play(false)));
    }
}
