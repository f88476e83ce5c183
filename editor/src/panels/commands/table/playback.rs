//! Playback: play, step, and which take is shown.

use super::*;
use crate::panels::actions::playback;
use crate::panels::file_choice::FileChoice;
use crate::panels::sound::SoundSettings;

commands! {
    PlayPause => When::Playable, "Play / pause", [key(NONE, Key::Space), key(ALT, Key::V)], "Starts or pauses playback", |w| { playback::play(w, 1.0); None };
    PlayBackwards => When::Playable, "Play backwards", [key(SHIFT, Key::Space)], "Starts or pauses backward playback", |w| { playback::play(w, -1.0); None };
    PreviousFrame => When::Playable, "Previous frame", [key(NONE, Key::ArrowLeft), key(NONE, Key::Comma)], "Moves the playhead one frame back", |w| { playback::step_frame(w, -1); None }, repeats;
    NextFrame => When::Playable, "Next frame", [key(NONE, Key::ArrowRight), key(NONE, Key::Period)], "Moves the playhead one frame forward", |w| { playback::step_frame(w, 1); None }, repeats;
    PreviousKey => When::Playable, "Previous key", [key(NONE, Key::ArrowUp), key(ALT, Key::Comma)], "Moves the playhead to the previous key of the selected bones, or of all", |w| { playback::step_key(w, false); None }, repeats;
    NextKey => When::Playable, "Next key", [key(NONE, Key::ArrowDown), key(ALT, Key::Period)], "Moves the playhead to the next key of the selected bones, or of all", |w| { playback::step_key(w, true); None }, repeats;
    Start => When::Playable, "Go to start", [key(NONE, Key::Home), key(SHIFT, Key::ArrowLeft)], "Moves the playhead to the start of the play range, or of the take", |w| { playback::go_to_start(w); None };
    End => When::Playable, "Go to end", [key(NONE, Key::End), key(SHIFT, Key::ArrowRight)], "Moves the playhead to the end of the play range, or of the take", |w| { playback::go_to_end(w); None };
    BackOneSecond => When::Playable, "Back one second", [key(CTRL, Key::ArrowLeft)], "Moves the playhead one second back", |w| { playback::skip(w, -1.0); None }, repeats;
    ForwardOneSecond => When::Playable, "Forward one second", [key(CTRL, Key::ArrowRight)], "Moves the playhead one second forward", |w| { playback::skip(w, 1.0); None }, repeats;
    CycleRepeat => When::Always, "Next repeat mode", [key(NONE, Key::L)], "Switches between loop, ping-pong and play once", |w| { playback::cycle_repeat(w); None };
    PreviousTake => When::Model, "Previous take", [key(NONE, Key::PageUp)], "Shows the previous take", |w| { playback::step_take(w, -1); None };
    NextTake => When::Model, "Next take", [key(NONE, Key::PageDown)], "Shows the next take", |w| { playback::step_take(w, 1); None };
    RestPose => When::Model, "Rest pose", [key(NONE, Key::Num0)], "Shows the model without animation", |w| { playback::show_take(w, None); None };
    ToggleScrubSounds => When::Always, "Scrub sounds", [], "Plays a short piece of the sounds at each new time while the playhead is dragged (audio)", |w| { w.settings.scrub_sounds ^= true; None };
    ChooseSound => When::OwnModel, "Sound track…", [], "Shows the waveform of a sound file (WAV, FLAC, Ogg Vorbis) in the timeline; it is not played (audio)", |w| Some(Effect::Choose(FileChoice::Sound, w.read().model_folder()));
    SoundToPlayhead => When::Sound, "Move sound to playhead", [], "Lets the sound track start at the playhead", |w| { playback::sound_to_playhead(w); None };
    RemoveSound => When::Sound, "Remove sound track", [], "Removes the sound track from the timeline; its file stays", |w| { w.sound.set(SoundSettings::default()); None };
}
