//! The rules of the lint of takes, their units and their thresholds.

use crate::contact::{ContactThresholds, ContactTrack};
use crate::joint::JointLimits;

/// A defect that the lint of takes looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LintRule {
    /// A bone trembles.
    Jitter,
    /// A foot slides while it is in contact with the ground.
    FootSlide,
    /// A bone is below the floor.
    Floor,
    /// A bone jumps for one frame.
    Pop,
    /// A bone turns too far within one frame.
    Flip,
    /// A bone is longer or shorter than at rest.
    Stretch,
    /// A bone is turned beyond the limits of its joint.
    JointLimit,
    /// The end of the take is away from its start.
    LoopGap,
    /// A channel has a key on each frame that its neighbors predict.
    SpareKeys,
    /// A key is before the start or after the end of the take.
    Outside,
}

impl LintRule {
    /// All rules, in the order of reports.
    pub const ALL: [Self; 10] = [
        Self::Jitter,
        Self::FootSlide,
        Self::Floor,
        Self::Pop,
        Self::Flip,
        Self::Stretch,
        Self::JointLimit,
        Self::LoopGap,
        Self::SpareKeys,
        Self::Outside,
    ];

    /// Returns its name in files of thresholds and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Jitter => "jitter",
            Self::FootSlide => "foot_slide",
            Self::Floor => "floor",
            Self::Pop => "pop",
            Self::Flip => "flip",
            Self::Stretch => "stretch",
            Self::JointLimit => "joint_limit",
            Self::LoopGap => "loop_gap",
            Self::SpareKeys => "spare_keys",
            Self::Outside => "outside",
        }
    }

    /// Returns the unit of its amounts and of its threshold.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Jitter => "mm/frame²",
            Self::FootSlide => "mm/s",
            Self::Floor | Self::Pop | Self::LoopGap => "mm",
            Self::Flip | Self::JointLimit => "°",
            Self::Stretch | Self::SpareKeys => "%",
            Self::Outside => "ms",
        }
    }
}

/// The thresholds of the lint of takes.
#[derive(Clone, Debug, PartialEq)]
pub struct LintThresholds {
    limits: [Option<f32>; LintRule::ALL.len()],
    /// Thresholds of contacts, for foot slide; its `meters_per_unit` and its axis hold for all rules.
    pub contacts: ContactThresholds,
    /// The contacts of the take, for foot slide. Where there are none, those of bones called feet are found.
    pub given: ContactTrack,
    /// The limits of joints. A bone without one turns freely.
    pub joints: JointLimits,
    /// Height of the floor in the model's unit.
    pub floor: f32,
    /// Tolerance within which a key is predicted by its neighbors: meters for translations, about half the angle in radians for
    /// rotations.
    pub key_tolerance: f32,
}

impl Default for LintThresholds {
    /// Returns thresholds for a figure of human size in meters. The gap of loops is off: most takes are not meant to repeat.
    fn default() -> Self {
        let limits = LintRule::ALL.map(|rule| match rule {
            LintRule::Jitter => Some(2.0),
            LintRule::FootSlide => Some(50.0),
            LintRule::Floor => Some(20.0),
            LintRule::Pop => Some(60.0),
            LintRule::Flip => Some(120.0),
            LintRule::Stretch => Some(5.0),
            LintRule::JointLimit => Some(1.0),
            LintRule::LoopGap => None,
            LintRule::SpareKeys => Some(50.0),
            LintRule::Outside => Some(1.0),
        });
        Self {
            limits,
            contacts: ContactThresholds::default(),
            given: ContactTrack::default(),
            joints: JointLimits::new(),
            floor: 0.0,
            key_tolerance: 1e-5,
        }
    }
}

impl LintThresholds {
    /// Returns the threshold of a rule in its unit; `None` where the rule is off.
    pub fn limit(&self, rule: LintRule) -> Option<f32> {
        self.limits[rule as usize]
    }

    /// Returns the thresholds with another one for `rule`; `None` switches it off.
    #[must_use]
    pub fn with(mut self, rule: LintRule, limit: Option<f32>) -> Self {
        self.limits[rule as usize] = limit;
        self
    }
}
