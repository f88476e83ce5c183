//! The window itself.

use super::*;
use crate::panels::actions::look;
use crate::panels::settings::ThemeChoice;

commands! {
    ThemeSystem => When::Always, "System theme", [], "Uses the light or dark theme of the desktop", |w| { w.settings.theme = ThemeChoice::System; None };
    ThemeDark => When::Always, "Dark theme", [], "Uses dark colors, for dim rooms", |w| { w.settings.theme = ThemeChoice::Dark; None };
    ThemeLight => When::Always, "Light theme", [], "Uses light colors, for bright rooms", |w| { w.settings.theme = ThemeChoice::Light; None };
    ScaleUp => When::Always, "Larger interface", [key(CTRL, Key::Plus), key(CTRL, Key::Equals), key(CTRL.plus(SHIFT), Key::Plus), key(CTRL.plus(SHIFT), Key::Equals)], "Enlarges the user interface", |w| { look::scale_by(w, 0.1); None }, repeats;
    ScaleDown => When::Always, "Smaller interface", [key(CTRL, Key::Minus)], "Shrinks the user interface", |w| { look::scale_by(w, -0.1); None }, repeats;
    ScaleReset => When::Always, "Default interface size", [key(CTRL, Key::Num0)], "Resets the size of the user interface", |w| { look::set_scale(w, 1.0); None };
    FullScreen => When::Always, "Full screen", [key(NONE, Key::F11)], "Switches between full screen and window", |_| Some(Effect::FullScreen);
    ResetLayout => When::Always, "Default panel layout", [], "Resets the arrangement of the panels", |_| Some(Effect::ResetLayout);
    RetryDevice => When::Paused, "Restart the viewport", [], "Restarts drawing after the graphics device failed several times", |_| Some(Effect::RetryDevice);
}
