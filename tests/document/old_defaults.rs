//! Edits in journals of earlier versions that leave out a unit or a rate do what they did then.

use super::fox_edits::{apply, edit, fox_takes};
use dragonfly_anim::data::Take;
use dragonfly_anim::layers::flatten;
use dragonfly_document::adapter::{LayerVersions, ModelAdapter, stored_contacts};

const LEFT: &str = "b_LeftFoot01_017";

/// Returns the fox with a survey in which a foot moves slowly: too fast for a contact in meters, slow enough in centimeters.
fn slow() -> ModelAdapter {
    let mut model = fox_takes();
    for (time, x) in [(0, 0), (3, 4)] {
        let pose = format!(r#"{{"bone":"b_Root_00","translation":[{x},0,0]}}"#);
        let line = format!(r#"{{"edit":"set","take":"Survey","time":{time},"poses":[{pose}]}}"#);
        apply(&mut model, &line);
    }
    model
}

/// Returns all takes and the contacts of the first one after an edit; `None` where it is refused.
fn after(line: &str, model: &ModelAdapter) -> Option<(Vec<Take>, String)> {
    let mut model = model.clone();
    model.apply(&edit(line)).ok()?;
    let takes = model.results().map(|take| Take::clone(take)).collect();
    let contacts = stored_contacts(&model.slots()[0].original.extras, model.skeleton());
    Some((takes, format!("{contacts:?}")))
}

#[test]
fn an_edit_without_a_unit_takes_the_model_to_be_in_meters() {
    let model = slow();
    let detect =
        |unit: &str| format!(r#"{{"edit":"detect_contacts","take":"Survey","bones":["{LEFT}"]{unit}}}"#);
    let lock = |unit: &str| format!(r#"{{"edit":"lock_contacts","take":"Survey","ease":2{unit}}}"#);
    let reduce =
        |unit: &str| format!(r#"{{"edit":"reduce_keys","take":"Walk","keys":[{{}}],"tolerance":20{unit}}}"#);
    let meters = r#","meters_per_unit":1"#;
    let centimeters = r#","meters_per_unit":0.01"#;
    for (absent, stated, other) in [
        (detect(""), detect(meters), detect(centimeters)),
        (lock(""), lock(meters), lock(centimeters)),
        (reduce(""), reduce(r#","unit":1000"#), reduce(r#","unit":10"#)),
    ] {
        assert_eq!(after(&absent, &model), after(&stated, &model), "{absent}");
        assert_ne!(after(&absent, &model), after(&other, &model), "{absent}: the model is in centimeters");
    }
}

#[test]
fn a_merge_without_a_rate_adds_keys_halfway_between_others() {
    let mut model = fox_takes();
    apply(&mut model, r#"{"edit":"add_layer","take":"Walk","name":"Nod","kind":"additive"}"#);
    for (time, turn) in [(0.07, "[0.6,0,0,0.8]"), (0.33, "[0,0.6,0,0.8]"), (0.64, "[0,0,0.96,0.28]")] {
        let pose = format!(r#"{{"bone":"b_Head_05","rotation":{turn}}}"#);
        let take = r#"{"take":"Walk","layer":"Nod"}"#;
        apply(&mut model, &format!(r#"{{"edit":"set","take":{take},"time":{time},"poses":[{pose}]}}"#));
    }
    let slot = &model.slots()[1];
    let layers: Vec<_> = slot.layers().iter().map(LayerVersions::flat).collect();
    let wanted = flatten(&slot.result, &layers, model.skeleton());
    let head = model.skeleton().find("b_Head_05").expect("a head") as usize;
    apply(&mut model, r#"{"edit":"merge_layers","take":"Walk"}"#);
    let got = &model.slots()[1].result.tracks[head].rotation;
    assert_eq!(got.times, wanted.tracks[head].rotation.times);
}
