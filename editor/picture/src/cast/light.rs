//! The lights of a scene.

use crate::uniform::LightUniform;
use dragonfly_anim::stage::{StagePlan, StageScene};
use dragonfly_document::SceneView;
use glam::Vec3;
use std::collections::HashMap;
use std::f32::consts::PI;

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// Far away: the same direction everywhere.
    Sun,
    /// In all directions from its place.
    Point,
    /// In a cone from its place.
    Spot,
}

impl LightKind {
    fn of(name: &str) -> Self {
        match name {
            "point" => Self::Point,
            "spot" => Self::Spot,
            _ => Self::Sun,
        }
    }
}

/// A light of a scene at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneLight {
    /// The thing.
    pub thing: usize,
    /// Its kind.
    pub kind: LightKind,
    /// Direction in which it shines where its thing is not turned.
    own_direction: Vec3,
    /// Meters.
    pub position: Vec3,
    /// Direction in which it shines, unit length.
    pub direction: Vec3,
    /// Whether things cast shadows in it.
    pub casts_shadow: bool,
    /// Linear light, red, green and blue, with the strength. A white matte surface that faces a sun of strength π is as bright as white; one
    /// that faces a point or spot of that strength is at a distance of a meter.
    pub color: Vec3,
}

/// Returns the lights of a script that are not hidden, dark before the first [`update`].
pub(super) fn of_script(view: &SceneView, plan: &StagePlan, hidden: &[bool]) -> Vec<SceneLight> {
    let elements = view.script.iter().flat_map(|script| script.things());
    let elements: HashMap<&str, _> =
        elements.filter_map(|element| Some((element.value("id")?, element))).collect();
    let lights = plan.things().iter().enumerate().filter(|(_, thing)| thing.kind == "light");
    let light = |thing: usize| {
        let element = elements.get(&*plan.things()[thing].id);
        let value = |name: &str| element.and_then(|element| element.value(name));
        SceneLight {
            thing,
            kind: LightKind::of(value("kind").unwrap_or_default()),
            own_direction: value("direction").and_then(direction).unwrap_or(Vec3::NEG_Y),
            position: Vec3::ZERO,
            direction: Vec3::NEG_Y,
            casts_shadow: value("shadow") != Some("no"),
            color: Vec3::ZERO,
        }
    };
    let shining = lights.filter(|(thing, _)| !hidden.get(*thing).copied().unwrap_or(false));
    shining.map(|(thing, _)| light(thing)).collect()
}

/// Reads three numbers as a direction; `None` for anything else and for zero.
fn direction(text: &str) -> Option<Vec3> {
    let mut numbers = text.split_whitespace().map(|number| number.parse::<f32>().ok());
    let mut next = || numbers.next().flatten();
    Vec3::new(next()?, next()?, next()?).try_normalize()
}

/// Computes the lights of `state`.
pub(super) fn update(lights: &mut [SceneLight], state: &StageScene) {
    for light in lights {
        let Some(thing) = state.things.get(light.thing) else { continue };
        light.position = thing.transform.translation;
        light.direction = (thing.transform.rotation * light.own_direction).normalize_or(Vec3::NEG_Y);
        light.color = thing.light.map_or(Vec3::ZERO, |light| light.color * light.strength.max(0.0));
    }
}

/// Returns the lights that are not dark.
pub(crate) fn bright(lights: &[SceneLight]) -> impl Iterator<Item = &SceneLight> {
    lights.iter().filter(|light| light.color.max_element() > 0.0)
}

/// Writes the lights that are not dark for the device, up to the length of `out`. Returns their number.
pub(super) fn write(lights: &[SceneLight], out: &mut [LightUniform]) -> usize {
    let mut count = 0;
    for (light, out) in bright(lights).zip(out) {
        let kind = match light.kind {
            LightKind::Sun => 0.0,
            LightKind::Point => 1.0,
            LightKind::Spot => 2.0,
        };
        *out = LightUniform {
            position: light.position.extend(kind),
            direction: light.direction.extend(0.0),
            color: (light.color / PI).extend(0.0),
        };
        count += 1;
    }
    count
}
