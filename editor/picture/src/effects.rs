//! The effects of the scene that the user switches. One that is off costs nothing: no pass, no memory, no other shader.

use serde::{Deserialize, Serialize};

/// Which effects are on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct EffectLook {
    /// Whether the lights of a scene cast shadows, except those whose script turns them off.
    pub shadows: bool,
    /// Whether the key light of the studio casts shadows, where a model is shown without lights of its own.
    pub studio_shadows: bool,
}

impl Default for EffectLook {
    /// Shadows as scripts ask for them; none in the studio, whose lights follow the viewer.
    fn default() -> Self {
        Self { shadows: true, studio_shadows: false }
    }
}
