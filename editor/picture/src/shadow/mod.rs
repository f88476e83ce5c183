//! The shadows of a frame: the maps of depth that are drawn of it, and the lamps that they belong to.
//!
//! ```text
//! SceneShadows   which maps a frame has, on the processor; allocates nothing
//!   ├ cascade    the maps of a sun, which cover the view in depth
//!   └ spot       the map of a spot light
//! frame          their input, and the data of a map
//! maps           the textures, the data of the shaders, and their bind group
//! ```
//!
//! The passes `skin`, `shadow` and `shadow_catcher` draw them; `shaders/common/shadowed.wgsl` reads them and names technique, sources and limits.

mod cascade;
mod frame;
mod maps;
mod spot;

pub(crate) use frame::ShadowedFrame;
pub use frame::{CASCADES, SPOT_SHADOWS, ShadowMap};
pub(crate) use maps::ShadowMaps;

use super::cast::{LightKind, SceneLight, bright};
use super::frustum::ViewFrustum;
use super::uniform::{LIGHTS, LightUniform};
use glam::{Vec2, Vec3};

/// Direction towards the key light of the studio, studio space. WGSL twin: `studio_light` in `shaders/common/studio.wgsl`.
const KEY_LIGHT: Vec3 = Vec3::new(-0.4830, 0.7043, 0.5202);

/// Tangent of half the angle that the sun takes in the sky, 0.53 degrees. The key light of the studio is as large.
const SUN_RADIUS: f32 = 0.004_625;

/// Returns the side of each map of a sun, texels: half as long where the processor draws.
pub(super) fn sun_side(is_software: bool) -> u32 {
    if is_software { 1024 } else { 2048 }
}

/// The maps of a frame: first those of the sun, from near to far, then those of spot lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneShadows {
    sun: [ShadowMap; CASCADES],
    cascades: usize,
    spot: [ShadowMap; SPOT_SHADOWS],
    spots: usize,
    /// For each light that is not dark the number that its shader gets: 0 without a shadow, 1 for the sun, 2 and more for spot lights.
    slots: [f32; LIGHTS],
    /// Whether the sun is the key light of the studio.
    is_studio: bool,
    side: u32,
}

impl SceneShadows {
    /// Returns the shadows of a frame. Allocates nothing.
    pub(super) fn of(frame: &ShadowedFrame<'_>) -> Self {
        let mut shadows = Self { side: frame.side, ..Self::default() };
        let radius = frame.casters.radius;
        if !(radius > 0.0 && radius.is_finite() && frame.casters.center.is_finite()) {
            return shadows;
        }
        if bright(frame.lights).next().is_none() {
            shadows.is_studio = frame.effects.studio_shadows;
            if shadows.is_studio {
                shadows.add_sun(frame, key_light(frame.camera.yaw));
            }
        } else if frame.effects.shadows {
            let lights = bright(frame.lights).take(LIGHTS).enumerate();
            lights.filter(|(_, light)| light.casts_shadow).for_each(|(index, light)| {
                shadows.add(index, light, frame);
            });
        }
        shadows
    }

    /// Adds the maps of a light, if there are some left for its kind.
    fn add(&mut self, index: usize, light: &SceneLight, frame: &ShadowedFrame<'_>) {
        match light.kind {
            LightKind::Sun if self.cascades == 0 => {
                self.slots[index] = 1.0;
                self.add_sun(frame, -light.direction);
            }
            LightKind::Spot if self.spots < SPOT_SHADOWS => {
                self.slots[index] = (2 + self.spots) as f32;
                self.spot[self.spots] = spot::map(light);
                self.spots += 1;
            }
            LightKind::Sun | LightKind::Spot | LightKind::Point => {}
        }
    }

    fn add_sun(&mut self, frame: &ShadowedFrame<'_>, towards: Vec3) {
        (self.sun, self.cascades) = cascade::maps(frame, towards_point(towards, frame.light_point));
    }

    /// Returns whether there are no shadows.
    pub fn is_empty(&self) -> bool {
        self.cascades + self.spots == 0
    }

    /// The maps of the sun, from near to far.
    pub fn cascades(&self) -> &[ShadowMap] {
        &self.sun[..self.cascades]
    }

    /// The maps of spot lights.
    pub fn spots(&self) -> &[ShadowMap] {
        &self.spot[..self.spots]
    }

    /// All maps: those of the sun, then those of spot lights.
    pub fn maps(&self) -> impl Iterator<Item = &ShadowMap> {
        self.cascades().iter().chain(self.spots())
    }

    /// Returns the part of the scene that each of the [`maps`](Self::maps) shows.
    pub(super) fn frusta(&self) -> impl Iterator<Item = ViewFrustum> + Clone {
        let maps = self.cascades().iter().chain(self.spots());
        maps.map(|map| ViewFrustum::new(&map.clip_from_world))
    }

    /// Side of each map of the sun, texels.
    pub fn side(&self) -> u32 {
        self.side
    }

    /// Returns whether the key light of the studio casts the shadows.
    pub fn is_studio(&self) -> bool {
        self.is_studio
    }

    /// Writes into the lights of a frame which of them cast shadows.
    pub(super) fn mark(&self, lights: &mut [LightUniform; LIGHTS]) {
        for (light, slot) in lights.iter_mut().zip(self.slots) {
            light.direction.w = slot;
        }
    }
}

/// Returns the direction towards a point of the sun whose middle is in direction `middle`. The point is within a circle of radius 1.
fn towards_point(middle: Vec3, point: Vec2) -> Vec3 {
    if point == Vec2::ZERO {
        return middle;
    }
    let (right, up) = middle.any_orthonormal_pair();
    (middle + (right * point.x + up * point.y) * SUN_RADIUS).normalize()
}

/// Returns the direction towards the key light of the studio for a viewer with this yaw, scene space.
fn key_light(yaw: f32) -> Vec3 {
    let (sin, cos) = yaw.sin_cos();
    let Vec3 { x, y, z } = KEY_LIGHT;
    Vec3::new(cos * x + sin * z, y, cos * z - sin * x)
}
