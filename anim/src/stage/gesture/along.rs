//! The times that move along while clips are dragged.

use super::begin::is_usual;
use super::scene::{Followers, GestureScene};
use crate::stage::schedule::{TimeNode, TimesAlong};

/// The part of clips that a drag moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovedPart {
    /// Begin and end.
    Whole,
    /// The begin; the end stays.
    Begin,
    /// The end; the begin stays.
    End,
    /// Neither: a fade.
    Neither,
}

/// Returns the begins and ends that may be at other times after a drag of these actions, with those that are dragged.
pub fn moved_along(
    scene: &GestureScene<'_>,
    actions: &[usize],
    part: MovedPart,
    followers: Followers,
) -> TimesAlong {
    let script = scene.script;
    let known = || actions.iter().copied().filter(|&action| action < script.actions().len());
    let begins = known().map(TimeNode::Begin);
    let ends = known().map(TimeNode::End);
    let (given, mut stays): (Vec<TimeNode>, Vec<TimeNode>) = match part {
        MovedPart::Whole => (begins.chain(ends).collect(), Vec::new()),
        MovedPart::Begin => (begins.collect(), ends.collect()),
        MovedPart::End => (ends.collect(), begins.collect()),
        MovedPart::Neither => {
            return TimesAlong::only(script, &begins.chain(ends).collect::<Vec<TimeNode>>());
        }
    };
    if followers == Followers::Stay {
        let next = known().filter_map(|action| script.next_in_seq(action));
        stays.extend(next.filter(|&next| is_usual(scene, next)).map(TimeNode::Begin));
    }
    TimesAlong::after(script, &given, &stays)
}
