//! Text of the largest difference between two states of a take: how far an edit moves bones.

use dragonfly_anim::compare::compare_takes_within;
use dragonfly_anim::data::{Skeleton, Take};

/// Largest number of keys times bones of a take that is compared in a frame.
const MOST: usize = 1_000_000;
/// Largest number of bones times samples of a comparison: about 20 ms.
const SAMPLES: usize = 200_000;

/// The units in which times and distances are shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShownScale {
    /// Frames per second.
    pub(super) frame_rate: u32,
    /// Millimeters in one unit of the model.
    pub(super) millimeters: f32,
}

/// Returns the largest distance and angle with their bones and frames: `12.30 mm Head frame 7 · 4.10° Neck frame 9`. What is zero
/// is left out. `None` where the take is too long to be compared in a frame.
pub(super) fn difference_text(
    (before, now): (&Take, &Take),
    skeleton: &Skeleton,
    scale: ShownScale,
) -> Option<String> {
    if before.keys().max(now.keys()).saturating_mul(skeleton.len()) > MOST {
        return None;
    }
    let difference = compare_takes_within((skeleton, before), (skeleton, now), SAMPLES);
    let (far, turned) = (difference.farthest()?, difference.most_turned()?);
    let frame = |time: f32| (f64::from(time) * f64::from(scale.frame_rate)).round();
    let name = |bone: u32| skeleton.bones.get(bone as usize).map_or("", |bone| bone.name.as_str());
    let largest = |amount: f32, unit: &str, bone: u32, time: f32| {
        let amount = format!("{amount:.2}");
        (amount != "0.00").then(|| format!("{amount}{unit} {} frame {}", name(bone), frame(time)))
    };
    let parts = [
        largest(far.distance.value * scale.millimeters, " mm", far.first, far.distance.time),
        largest(turned.angle.value.to_degrees(), "°", turned.first, turned.angle.time),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    Some(if parts.is_empty() { "no bone moves".to_owned() } else { parts.join(" · ") })
}
