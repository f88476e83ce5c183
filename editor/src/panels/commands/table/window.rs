//! The window itself.

use super::*;
use crate::panels::actions::look;
use crate::panels::settings::ThemeChoice;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ThemeSystem, When::Always, "Theme of the system", &[], "Light or dark, as the desktop is set", |w| { w.settings.theme = ThemeChoice::System; None }),
    command(Id::ThemeDark, When::Always, "Dark theme", &[], "For dim rooms", |w| { w.settings.theme = ThemeChoice::Dark; None }),
    command(Id::ThemeLight, When::Always, "Light theme", &[], "For bright rooms", |w| { w.settings.theme = ThemeChoice::Light; None }),
    command(Id::ScaleUp, When::Always, "Larger", &[key(CTRL, Key::Plus), key(CTRL, Key::Equals), key(CTRL.plus(SHIFT), Key::Plus), key(CTRL.plus(SHIFT), Key::Equals)], "Everything in the window larger", |w| { look::scale_by(w, 0.1); None }),
    command(Id::ScaleDown, When::Always, "Smaller", &[key(CTRL, Key::Minus)], "Everything in the window smaller", |w| { look::scale_by(w, -0.1); None }),
    command(Id::ScaleReset, When::Always, "Usual size", &[key(CTRL, Key::Num0)], "Everything in the window as large as usual", |w| { look::set_scale(w, 1.0); None }),
    command(Id::FullScreen, When::Always, "Full screen", &[key(NONE, Key::F11)], "Uses the whole screen, or a window again", |_| Some(Effect::FullScreen)),
    command(Id::ResetLayout, When::Always, "Usual panels", &[], "Puts every panel where it was at first", |_| Some(Effect::ResetLayout)),
    command(Id::RetryDevice, When::Paused, "Try the viewport again", &[], "Draws again after the graphics device failed several times", |_| Some(Effect::RetryDevice)),
];
