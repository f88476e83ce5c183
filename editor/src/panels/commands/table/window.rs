//! The window itself.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ThemeSystem, When::Always, "Theme of the system", &[], "Light or dark, as the desktop says"),
    command(Id::ThemeDark, When::Always, "Dark theme", &[], "For dim rooms"),
    command(Id::ThemeLight, When::Always, "Light theme", &[], "For bright rooms"),
    command(Id::ScaleUp, When::Always, "Larger", &[key(CTRL, Key::Plus), key(CTRL, Key::Equals), key(CTRL.plus(SHIFT), Key::Plus), key(CTRL.plus(SHIFT), Key::Equals)], "Everything in the window larger"),
    command(Id::ScaleDown, When::Always, "Smaller", &[key(CTRL, Key::Minus)], "Everything in the window smaller"),
    command(Id::ScaleReset, When::Always, "Usual size", &[key(CTRL, Key::Num0)], "Everything in the window as large as usual"),
    command(Id::FullScreen, When::Always, "Full screen", &[key(NONE, Key::F11)], "Uses the whole screen, or a window again"),
    command(Id::ResetLayout, When::Always, "Usual panels", &[], "Puts every panel where it was at first"),
    command(Id::RetryDevice, When::Paused, "Try the viewport again", &[], "Draws again after the graphics device failed several times"),
];
