//! The weights of the shape keys of a role, from the takes that it plays.
//!
//! They follow the rules of bones ([`super::poses`]): the shares of the takes are the same, what a take does not animate is at rest, and a layer
//! with bones moves the shape keys that belong to these bones and to those below them ([`crate::stage::StageShapes::bones`]).

use super::places::PlaceLane;
use super::poses::{PoseLane, take_time};
use crate::fast::WHOLE;
use crate::stage::model::StageModel;
use crate::stage::time::StageTime;

/// Writes the weights of the shape keys of a role at `time`. `scratch` is not shorter than `out`. Allocates nothing.
pub(super) fn shape_role(
    model: &StageModel,
    lanes: &[PoseLane],
    places: &PlaceLane,
    time: StageTime,
    scratch: &mut [f32],
    out: &mut [f32],
) {
    let shapes = model.shapes();
    let scratch = &mut scratch[..out.len()];
    out.copy_from_slice(shapes.rest());
    for lane in lanes {
        let (shares, count) = lane.shares(time);
        let sample = |cue: usize, out: &mut [f32]| {
            let cue = &lane.cues[cue];
            let takes = (model.takes().get(cue.take), model.data().animation.takes.get(cue.take));
            if let (Some(own), Some(take)) = takes {
                shapes.sample(Some(take), own.clock(take_time(cue, places, time)), out);
            }
        };
        let masked =
            |shape: usize| lane.mask.as_ref().is_none_or(|mask| mask.shapes.get(shape) == Some(&true));
        match &shares[..count] {
            [] => {}
            [one] if one.share >= 1.0 && lane.mask.is_none() => sample(one.cue, out),
            some => {
                let sum: f32 = some.iter().map(|one| one.share).sum();
                let (left, whole) = (if sum >= WHOLE { 0.0 } else { 1.0 - sum }, sum.max(1.0));
                for (_, weight) in out.iter_mut().enumerate().filter(|(shape, _)| masked(*shape)) {
                    *weight = if left > 0.0 { *weight * left } else { 0.0 };
                }
                for one in some {
                    sample(one.cue, scratch);
                    let share = one.share / whole;
                    let weights = out.iter_mut().zip(&*scratch).enumerate();
                    for (_, (weight, own)) in weights.filter(|(shape, _)| masked(*shape)) {
                        *weight += share * own;
                    }
                }
            }
        }
    }
}
