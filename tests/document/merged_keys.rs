//! Keys that merging a layer adds are on whole frames; all others were keys of the take, of the layer, or of its weight.

use crate::fox_edits::{apply, fox_takes};
use dragonfly_anim::data::{Take, Transform};
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::ModelAdapter;

const WALK: usize = 1;
const HEAD: &str = "b_Head_05";

/// A layer over the walk that turns the head between frames, with a weight that fades in.
fn faded(kind: &str) -> ModelAdapter {
    let mut model = fox_takes();
    apply(&mut model, &format!(r#"{{"edit":"add_layer","take":"Walk","name":"Nod","kind":"{kind}"}}"#));
    let layer = r#"{"take":"Walk","layer":"Nod"}"#;
    for (time, turn) in [(0.07, "[0.6,0,0,0.8]"), (0.33, "[0,0.6,0,0.8]"), (0.64, "[0,0,0.96,0.28]")] {
        apply(
            &mut model,
            &format!(
                r#"{{"edit":"set","take":{layer},"time":{time},"poses":[{{"bone":"{HEAD}","rotation":{turn}}}]}}"#
            ),
        );
    }
    for (time, weight) in [(0.11, 0.0), (0.5, 1.0)] {
        apply(
            &mut model,
            &format!(r#"{{"edit":"key_layer_weight","take":{layer},"time":{time},"weight":{weight}}}"#),
        );
    }
    model
}

fn head_times(model: &ModelAdapter, take: &Take) -> Vec<f32> {
    let head = model.skeleton().find(HEAD).expect("a head") as usize;
    take.tracks[head].rotation.times.to_vec()
}

fn pose(model: &ModelAdapter, time: f32) -> Transform {
    let mut poses = vec![Transform::IDENTITY; model.skeleton().len()];
    sample_take(Some(model.slots()[WALK].shown()), model.skeleton(), time, &mut poses);
    poses[model.skeleton().find(HEAD).expect("a head") as usize]
}

#[test]
fn a_merge_adds_keys_on_whole_frames_only_and_each_frame_looks_as_before() {
    for kind in ["additive", "override"] {
        for rate in [24.0_f32, 25.0] {
            let mut model = faded(kind);
            let slot = &model.slots()[WALK];
            let layer = &slot.layers()[0];
            let mut known = head_times(&model, &slot.result);
            known.extend(head_times(&model, &layer.keys.result));
            known.extend(layer.settings.weights.iter().map(|key| key.time));
            let frames: Vec<f32> = (0..(0.7 * rate) as usize).map(|frame| frame as f32 / rate).collect();
            let before: Vec<Transform> = frames.iter().map(|&time| pose(&model, time)).collect();
            apply(
                &mut model,
                &format!(r#"{{"edit":"merge_layers","take":{{"take":"Walk","layer":"Nod"}},"rate":{rate}}}"#),
            );
            let times = head_times(&model, &model.slots()[WALK].result);
            let is_new = |time: &&f32| !known.iter().any(|known| (*known - **time).abs() < 1e-6);
            let new: Vec<f32> = times.iter().filter(is_new).copied().collect();
            for time in &new {
                let frame = time * rate;
                assert!((frame - frame.round()).abs() < 1e-3, "{kind}: a key at {time} s, frame {frame}");
            }
            // On frames of 25 the keys of the walk are between frames, so that some are needed.
            assert!(rate == 24.0 || !new.is_empty(), "{kind}");
            assert!(known.iter().all(|known| times.iter().any(|time| (known - time).abs() < 1e-4)), "{kind}");
            for (time, before) in frames.iter().zip(before) {
                let off = pose(&model, *time).rotation.angle_between(before.rotation);
                assert!(off < 2e-3, "{kind}, {rate} fps, {time} s: off by {off}");
            }
        }
    }
    let mut model = faded("additive");
    // At the largest of these, several keys would be at one time.
    for rate in ["-5", "0", "1000.5", "3e38"] {
        let edit = format!(r#"{{"edit":"merge_layers","take":"Walk","rate":{rate}}}"#);
        let refused = model.apply(&serde_json::from_str(&edit).expect("an edit"));
        assert!(refused.is_err(), "{rate}");
    }
}
