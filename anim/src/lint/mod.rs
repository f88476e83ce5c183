//! Lint of takes: measures of the defects that animators look for, compared with thresholds.
//!
//! [`crate::check`] finds data that is wrong; the lint finds motion that looks wrong. Each [`LintRule`] measures one defect in
//! one unit, bone by bone, and reports the worst frame of each bone where it exceeds its threshold. A rule without a
//! threshold is not applied.
//!
//! | rule | measure |
//! |---|---|
//! | jitter | acceleration that changes its direction from frame to frame, mm per frame² |
//! | foot_slide | mean speed of a foot in its contacts, mm/s |
//! | floor | depth below the floor, mm |
//! | pop | step of one frame, beyond twice the steps before and after, mm |
//! | flip | rotation of a bone within one frame, degrees |
//! | stretch | difference of the length of a bone from its rest length, % |
//! | joint_limit | angle by which a bone is turned beyond the limits of its joint, degrees |
//! | loop_gap | distance between the last and the first position, mm |
//! | spare_keys | share of the keys of a channel with a key on each frame that the others predict, % |
//! | outside | time by which a key is outside of the range of the take, ms |
//!
//! Lengths are of the origins of bones in scene space.

mod keys;
mod motion;
mod thresholds;

pub use thresholds::{LintRule, LintThresholds};

use crate::data::{BoneIndex, Skeleton, Take};
use crate::frames::{FramesError, TakeFrames};

/// A defect of a take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LintFinding {
    /// The rule that found it.
    pub rule: LintRule,
    /// The bone.
    pub bone: BoneIndex,
    /// The worst frame, from 0 at the start of the take; negative before it.
    pub frame: i64,
    /// Time of the worst frame in seconds.
    pub time: f32,
    /// Amount in the unit of the rule.
    pub amount: f32,
}

/// Returns the defects of `take` that exceed the thresholds, in the order of [`LintRule::ALL`], then of bones. The take is
/// sampled at `rate` frames per second.
///
/// # Errors
///
/// The take cannot be sampled at this rate.
pub fn lint_take(
    take: &Take,
    skeleton: &Skeleton,
    rate: f32,
    thresholds: &LintThresholds,
) -> Result<Vec<LintFinding>, FramesError> {
    let frames = TakeFrames::of(take, skeleton, rate)?;
    let mut findings = Vec::new();
    for rule in LintRule::ALL {
        let Some(limit) = thresholds.limit(rule) else { continue };
        let mut add = |bone: BoneIndex, time: f32, amount: f32| {
            if amount > limit {
                let frame = ((f64::from(time) - f64::from(take.start)) * f64::from(rate)).round() as i64;
                findings.push(LintFinding { rule, bone, frame, time, amount });
            }
        };
        match rule {
            LintRule::Jitter => motion::jitter(&frames, thresholds, &mut add),
            LintRule::FootSlide => motion::foot_slide(&frames, skeleton, thresholds, &mut add),
            LintRule::Floor => motion::floor(&frames, thresholds, &mut add),
            LintRule::Pop => motion::pop(&frames, thresholds, &mut add),
            LintRule::Flip => motion::flip(&frames, &mut add),
            LintRule::Stretch => motion::stretch(&frames, skeleton, &mut add),
            LintRule::JointLimit => motion::joint_limit(&frames, skeleton, thresholds, &mut add),
            LintRule::LoopGap => motion::loop_gap(&frames, thresholds, &mut add),
            LintRule::SpareKeys => keys::spare(take, rate, thresholds, &mut add),
            LintRule::Outside => keys::outside(take, &mut add),
        }
    }
    Ok(findings)
}

/// Receives the bone, the time of the worst frame, and the amount.
type LintReport<'a> = &'a mut dyn FnMut(BoneIndex, f32, f32);
