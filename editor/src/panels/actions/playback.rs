//! Playback: which time of which take is shown.

use super::scene_time;
use crate::panels::change_summary;
use crate::panels::ruler;
use crate::panels::settings::SPEEDS;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::View;
use dragonfly_picture::playback::Repeat;

/// Shows a take from its start; playback keeps running or stays paused.
pub(in crate::panels) fn show_take(workspace: &mut Workspace, index: Option<usize>) {
    workspace.keys.before_take_change();
    workspace.given.forget();
    let take = index.and_then(|index| workspace.model.takes().get(index));
    let bounds = take.map(|take| (take.start, take.length));
    workspace.player.show(index, bounds);
}

/// Follows the take that is shown to its index in a newer view; if it is gone, shows its neighbor. Shows a take that
/// was just created by a command, and the first of those that were just added from files.
pub(in crate::panels) fn follow_take(workspace: &mut Workspace, before: Option<&View>) {
    let views = before.zip(workspace.model.view());
    if views.is_some_and(|(old, new)| {
        new.history.brings_takes && !change_summary::same_steps(&old.history, &new.history)
    }) {
        workspace.takes.show_next_new();
    }
    if workspace.read().scene().is_some() {
        return;
    }
    let before = before.map_or(&[][..], |view| &view.slots);
    if let Some(new) = workspace.takes.update(before, workspace.model.slots()) {
        let time = workspace.player.time();
        show_take(workspace, Some(new));
        let (start, length) = workspace.read().take_bounds();
        if (start..=start + length).contains(&time) {
            workspace.player.seek(time);
        }
        return;
    }
    let Some(index) = workspace.player.take() else { return };
    let slots = workspace.model.slots();
    let place = before.get(index).and_then(|old| slots.iter().position(|slot| slot.id == old.id));
    match place {
        Some(place) => workspace.player.follow(place),
        None => {
            let neighbor = index.min(slots.len().saturating_sub(1));
            show_take(workspace, Some(neighbor));
        }
    }
}

/// Adapts playback to the new bounds of the take that is shown, at the same time; shows the rest pose if the take is
/// gone.
pub(in crate::panels) fn keep_take(workspace: &mut Workspace) {
    let panels = workspace.read();
    let is_there = panels.take().is_some() || panels.scene_bounds().is_some();
    let bounds = || if panels.playback.playing { panels.play_bounds() } else { panels.take_bounds() };
    let bounds = is_there.then(bounds);
    workspace.player.keep(bounds);
}

/// Keeps the time within the play range while playing; while paused, any time of the take can be shown.
pub(in crate::panels) fn bound_playback(workspace: &mut Workspace) {
    let panels = workspace.read();
    let bounds = if panels.playback.playing { panels.play_bounds() } else { panels.take_bounds() };
    workspace.player.play_within(bounds);
}

/// Starts playback in `direction`, or pauses it if it already runs in that direction.
pub(in crate::panels) fn play(workspace: &mut Workspace, direction: f32) {
    let speed = workspace.settings.speed * direction;
    if workspace.player.is_playing() && workspace.player.playback().speed == speed {
        return pause(workspace);
    }
    let bounds = workspace.read().play_bounds();
    if bounds.1 <= 0.0 {
        let text = match workspace.read().scene().is_some() {
            true => "No action of the scene takes time: there is nothing to play",
            false => "All keys are at one time: there is nothing to play",
        };
        return workspace.say(MessageSeverity::Info, text);
    }
    workspace.player.play(bounds, speed);
}

/// Pauses playback at the time shown, if it is running; with snapping on at the nearest whole frame.
pub(in crate::panels) fn pause(workspace: &mut Workspace) {
    if workspace.player.is_playing() {
        let (time, rate) = (workspace.player.time(), workspace.read().frames_per_second());
        // New keys are added at the time where playback stops, and with snapping on keys are at whole frames.
        let frame = ruler::time_of(ruler::frame_of(time, rate), rate);
        stop_at(workspace, if workspace.keys.snap() { frame } else { time });
    }
}

/// Moves the playhead to `time`; playback keeps running or stays paused.
pub(in crate::panels) fn seek(workspace: &mut Workspace, time: f32) {
    workspace.player.seek(time);
    bring_into_sight(workspace);
}

/// Moves the playhead to `time` and pauses there.
pub(in crate::panels) fn stop_at(workspace: &mut Workspace, time: f32) {
    workspace.player.stop_at(time);
    bring_into_sight(workspace);
}

/// Scrolls the timeline to the playhead if it is paused and out of sight.
fn bring_into_sight(workspace: &mut Workspace) {
    if workspace.read().scene().is_some() {
        return scene_time::bring_into_sight(workspace);
    }
    if let Some(take) = workspace.read().shared_take().cloned().filter(|_| !workspace.player.is_playing()) {
        workspace.keys.bring_into_sight(&take, workspace.player.time());
    }
}

/// Moves the playhead to the start of the play range, or of the take.
pub(in crate::panels) fn go_to_start(workspace: &mut Workspace) {
    let (start, _) = workspace.read().play_bounds();
    seek(workspace, start);
}

/// Moves the playhead to the end of the play range, or of the take.
pub(in crate::panels) fn go_to_end(workspace: &mut Workspace) {
    let (start, length) = workspace.read().play_bounds();
    seek(workspace, start + length);
}

/// Moves the playhead by this many seconds and pauses.
pub(in crate::panels) fn skip(workspace: &mut Workspace, seconds: f32) {
    let time = workspace.player.time() + seconds;
    stop_at(workspace, time);
}

/// Moves the playhead to the next or previous frame and pauses.
pub(in crate::panels) fn step_frame(workspace: &mut Workspace, direction: i64) {
    let rate = workspace.read().frames_per_second();
    let time = ruler::step_frame(workspace.player.time(), direction, rate);
    stop_at(workspace, time);
}

/// Moves the playhead to the next or previous key and pauses.
pub(in crate::panels) fn step_key(workspace: &mut Workspace, forward: bool) {
    if let Some(time) = workspace.read().next_key(forward) {
        stop_at(workspace, time);
    }
}

/// Moves the playhead to the next or previous marker and pauses.
pub(in crate::panels) fn step_marker(workspace: &mut Workspace, forward: bool) {
    match workspace.read().next_marker(forward) {
        Some(time) => stop_at(workspace, time),
        None => workspace.say(MessageSeverity::Info, "There is no marker on that side"),
    }
}

/// Shows the next or previous take.
pub(in crate::panels) fn step_take(workspace: &mut Workspace, direction: isize) {
    let count = workspace.model.digest().takes.len() as isize;
    if count > 0 {
        let none = if direction > 0 { -1 } else { count };
        let current = workspace.player.take().map_or(none, |take| take as isize);
        show_take(workspace, Some((current + direction).rem_euclid(count) as usize));
    }
}

/// Sets the speed, without its direction.
pub(in crate::panels) fn set_speed(workspace: &mut Workspace, speed: f32) {
    if speed.is_finite() {
        workspace.settings.speed = speed.clamp(*SPEEDS.start(), *SPEEDS.end());
        workspace.player.set_speed(workspace.settings.speed);
    }
}

/// Sets what happens at the end of the take.
pub(in crate::panels) fn set_repeat(workspace: &mut Workspace, repeat: Repeat) {
    workspace.settings.repeat = repeat;
    workspace.player.set_repeat(repeat);
}

/// Switches to the next repeat mode: loop, ping-pong, once.
pub(in crate::panels) fn cycle_repeat(workspace: &mut Workspace) {
    let repeat = match workspace.player.playback().repeat {
        Repeat::Loop => Repeat::PingPong,
        Repeat::PingPong => Repeat::Once,
        Repeat::Once => Repeat::Loop,
    };
    set_repeat(workspace, repeat);
}

/// Lets the sound start at the playhead.
pub(in crate::panels) fn sound_to_playhead(workspace: &mut Workspace) {
    let frame = crate::panels::ruler::frame_of(workspace.player.time(), workspace.frame_rate.get());
    let now = workspace.sound.settings().clone();
    workspace.sound.set(crate::panels::sound::SoundSettings { start: frame as i32, ..now });
}
