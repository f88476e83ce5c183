//! How the numbers of a bone are shown.

use super::turn;
use dragonfly_anim::joint::EulerOrder;
use serde::{Deserialize, Serialize};

/// How the numbers of a bone are shown; saved in the settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct PropertiesLook {
    /// Order of the three rotations.
    #[serde(with = "turn::by_name")]
    pub euler: EulerOrder,
    /// Whether the quaternion is shown as well.
    pub quaternion: bool,
    /// Whether there are sliders for translation, rotation and scale.
    pub sliders: [bool; 3],
}

impl Default for PropertiesLook {
    fn default() -> Self {
        Self { euler: EulerOrder::default(), quaternion: false, sliders: [false, true, false] }
    }
}
