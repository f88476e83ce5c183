//! Time: what plays, and where it stands.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::PlayPause, When::Take, "Play / pause", &[key(NONE, Key::Space), key(ALT, Key::V)], "Starts or stops time"),
    command(Id::PlayBackwards, When::Take, "Play backwards", &[key(SHIFT, Key::Space)], "Lets time run backwards"),
    command(Id::PreviousFrame, When::Take, "Previous frame", &[key(NONE, Key::ArrowLeft), key(NONE, Key::Comma)], "One frame back"),
    command(Id::NextFrame, When::Take, "Next frame", &[key(NONE, Key::ArrowRight), key(NONE, Key::Period)], "One frame on"),
    command(Id::PreviousKey, When::Take, "Previous key", &[key(NONE, Key::ArrowUp), key(ALT, Key::Comma)], "To the key before, of the selected bone or of all"),
    command(Id::NextKey, When::Take, "Next key", &[key(NONE, Key::ArrowDown), key(ALT, Key::Period)], "To the next key, of the selected bone or of all"),
    command(Id::Start, When::Take, "To the start", &[key(NONE, Key::Home), key(SHIFT, Key::ArrowLeft)], "To the first frame of the take"),
    command(Id::End, When::Take, "To the end", &[key(NONE, Key::End), key(SHIFT, Key::ArrowRight)], "To the last frame of the take"),
    command(Id::BackOneSecond, When::Take, "One second back", &[key(CTRL, Key::ArrowLeft)], "One second back"),
    command(Id::ForwardOneSecond, When::Take, "One second on", &[key(CTRL, Key::ArrowRight)], "One second on"),
    command(Id::CycleRepeat, When::Always, "Loop, back and forth, once", &[key(NONE, Key::L)], "What happens at the end of the take"),
    command(Id::PreviousTake, When::Model, "Previous take", &[key(NONE, Key::PageUp)], "Shows the take before"),
    command(Id::NextTake, When::Model, "Next take", &[key(NONE, Key::PageDown)], "Shows the take after"),
    command(Id::RestPose, When::Model, "Rest pose", &[key(NONE, Key::Num0)], "Shows the model as it stands when nothing animates it"),
];
