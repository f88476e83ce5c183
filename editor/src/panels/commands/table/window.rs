//! The window itself.

use super::*;
use crate::panels::actions::look;
use crate::panels::settings::ThemeChoice;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ThemeSystem, When::Always, "Theme of the system", &[], "Uses the light or dark theme of the desktop", |w| { w.settings.theme = ThemeChoice::System; None }),
    command(Id::ThemeDark, When::Always, "Dark theme", &[], "Uses dark colors, for dim rooms", |w| { w.settings.theme = ThemeChoice::Dark; None }),
    command(Id::ThemeLight, When::Always, "Light theme", &[], "Uses light colors, for bright rooms", |w| { w.settings.theme = ThemeChoice::Light; None }),
    command(Id::ScaleUp, When::Always, "Larger", &[key(CTRL, Key::Plus), key(CTRL, Key::Equals), key(CTRL.plus(SHIFT), Key::Plus), key(CTRL.plus(SHIFT), Key::Equals)], "Enlarges the user interface", |w| { look::scale_by(w, 0.1); None }),
    command(Id::ScaleDown, When::Always, "Smaller", &[key(CTRL, Key::Minus)], "Shrinks the user interface", |w| { look::scale_by(w, -0.1); None }),
    command(Id::ScaleReset, When::Always, "Default size", &[key(CTRL, Key::Num0)], "Resets the size of the user interface", |w| { look::set_scale(w, 1.0); None }),
    command(Id::FullScreen, When::Always, "Full screen", &[key(NONE, Key::F11)], "Switches between full screen and window", |_| Some(Effect::FullScreen)),
    command(Id::ResetLayout, When::Always, "Default panels", &[], "Resets the arrangement of the panels", |_| Some(Effect::ResetLayout)),
    command(Id::RetryDevice, When::Paused, "Try the viewport again", &[], "Restarts drawing after the graphics device failed several times", |_| Some(Effect::RetryDevice)),
];
