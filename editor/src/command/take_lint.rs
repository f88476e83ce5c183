//! `dragonfly check --takes`: the defects of takes, measured frame by frame.

use super::Failure;
use super::choice::plain;
use dragonfly_anim::data::AnimationData;
use dragonfly_anim::frames::frame_rate;
use dragonfly_document::TakeThresholds;
use serde::Serialize;
use std::io::{self, Write};

/// One defect of a take.
#[derive(Serialize)]
pub(super) struct TakeDefect {
    take: String,
    rule: &'static str,
    bone: String,
    frame: i64,
    time: f32,
    amount: f32,
    unit: &'static str,
}

impl TakeDefect {
    /// Writes it as one line.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let Self { take, rule, bone, frame, amount, unit, .. } = self;
        let (take, bone) = (plain(take), plain(bone));
        writeln!(out, "  {rule}: take {take}, bone {bone}, frame {frame}: {amount:.1} {unit}")
    }
}

/// Returns the defects of all takes, in their order.
pub(super) fn defects(
    animation: &AnimationData,
    thresholds: &TakeThresholds,
) -> Result<Vec<TakeDefect>, Failure> {
    let skeleton = &animation.skeleton;
    let mut defects = Vec::new();
    for take in &animation.takes {
        let found = thresholds.check(take, skeleton, frame_rate(take));
        let found =
            found.map_err(|reason| Failure::Input(format!("take {}: {reason}", plain(&take.name))))?;
        defects.extend(found.into_iter().map(|finding| TakeDefect {
            take: take.name.clone(),
            rule: finding.rule.name(),
            bone: skeleton.bones[finding.bone as usize].name.clone(),
            frame: finding.frame,
            time: finding.time,
            amount: finding.amount,
            unit: finding.rule.unit(),
        }));
    }
    Ok(defects)
}
