//! Contacts that are found in three captures agree with labels that were set by hand, from the heights and speeds of heel and toes.

use super::support::{bone, take};
use dragonfly_anim::contact::{ContactThresholds, ContactTrack, detect_contacts};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Track};
use dragonfly_anim::frames::TakeFrames;
use glam::Vec3;
use serde_json::Value;

/// Frames of one foot that are labelled and found, labelled but not found, found but not labelled.
#[derive(Debug, Default)]
pub(crate) struct Agreement {
    pub(crate) both: usize,
    pub(crate) missed: usize,
    pub(crate) extra: usize,
    /// Numbers of contacts labelled and found.
    pub(crate) spans: [usize; 2],
}

fn agreement(foot: &Value, rate: f32) -> Agreement {
    let numbers = |value: &Value| -> Vec<f32> {
        value
            .as_array()
            .expect("a list")
            .iter()
            .map(|number| number.as_f64().expect("a number") as f32)
            .collect()
    };
    let places: Vec<Vec3> = foot["positions"]
        .as_array()
        .expect("positions")
        .iter()
        .map(|place| Vec3::from_slice(&numbers(place)))
        .collect();
    let count = places.len();
    let times: Vec<f32> = (0..count).map(|frame| frame as f32 / rate).collect();
    let track = Track { translation: Channel::new(times, places, Interpolation::Linear), ..Track::default() };
    let skeleton = Skeleton { bones: vec![bone("Foot", None, Vec3::ZERO)] };
    let frames = TakeFrames::of(&take(vec![track]), &skeleton, rate).expect("frames");
    let found = ContactTrack::of(detect_contacts(&frames, &[0], &ContactThresholds::default()));
    let mut agreement = Agreement::default();
    let labels: Vec<Vec<f32>> = foot["labels"].as_array().expect("labels").iter().map(numbers).collect();
    agreement.spans = [labels.len(), found.contacts().len()];
    for frame in 0..count {
        let time = frame as f32 / rate;
        let is_labelled = labels.iter().any(|span| (span[0]..=span[1]).contains(&(frame as f32)));
        let is_found = found.contacts().iter().any(|span| time >= span.from - 1e-3 && time <= span.to + 1e-3);
        match (is_labelled, is_found) {
            (true, true) => agreement.both += 1,
            (true, false) => agreement.missed += 1,
            (false, true) => agreement.extra += 1,
            (false, false) => {}
        }
    }
    agreement
}

/// Each file, and for its feet the largest numbers of frames that are missed and that are extra. The dancer taps the floor for three
/// to five frames at a time, which is too short for a contact.
const CAPTURES: [(&str, [[usize; 2]; 2]); 3] = [
    (include_str!("../data/contacts/cmu_01_01.json"), [[1, 1], [2, 4]]),
    (include_str!("../data/contacts/fair1_dab.json"), [[11, 2], [12, 0]]),
    (include_str!("../data/contacts/pybvh_example.json"), [[0, 2], [0, 2]]),
];

/// Returns the feet of all captures: file and bone, the agreement, and the largest numbers of frames missed and extra.
pub(crate) fn labelled_feet() -> Vec<(String, Agreement, [usize; 2])> {
    let mut feet = Vec::new();
    for (text, allowed) in CAPTURES {
        let capture: Value = serde_json::from_str(text).expect("a capture");
        let rate = capture["rate"].as_f64().expect("a rate") as f32;
        for (foot, allowed) in capture["feet"].as_array().expect("feet").iter().zip(allowed) {
            let [file, bone] = [&capture["source"], &foot["bone"]].map(|name| name.as_str().expect("a name"));
            feet.push((format!("{file} {bone}"), agreement(foot, rate), allowed));
        }
    }
    feet
}

#[test]
fn contacts_found_in_captures_agree_with_labels_set_manually() {
    for (name, found, [missed, extra]) in labelled_feet() {
        assert!(found.both > 30 && found.missed <= missed && found.extra <= extra, "{name}: {found:?}");
    }
}
