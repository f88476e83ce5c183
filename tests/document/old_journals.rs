//! Work recorded by earlier versions of the program can always be recovered. The records are stored as text, and
//! encoded in the format of their version by separate code in the tests.
//!
//! There is one file for each released version of the vocabulary of edits; it is never changed again.

use dragonfly_document::edit::{EDITS, Edit, RenameTake, TakeRef};
use dragonfly_document::{Change, Decision, DocumentMessage, DocumentReply, View};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::store::forged::forged_with;
use dragonfly_store::{FileStamp, RealFiles};
use std::fs;
use std::path::Path;

/// Returns every type of edit in the first vocabulary. Each of them changes something in Fox.
fn first_edits() -> Vec<String> {
    let text = fs::read_to_string(data("journals/edits-1.jsonl")).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Returns the edits of shape keys in the first vocabulary. Each of them changes something in AnimatedMorphCube.
fn first_shape_edits() -> Vec<String> {
    let text = fs::read_to_string(data("journals/shape-edits-1.jsonl")).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// Returns the edits of a scene's script in the first vocabulary. Each of them changes something in [`SCENE`].
fn first_script_edits() -> Vec<String> {
    let text = fs::read_to_string(data("journals/script-edits-1.jsonl")).unwrap();
    text.lines().map(str::to_owned).collect()
}

fn all_first_edits() -> Vec<String> {
    [first_edits(), first_shape_edits(), first_script_edits()].concat()
}

/// A script to which the edits of scripts apply.
const SCENE: &str = "<script version=\"1\">\n  <title text=\"The End\" dur=\"2\"/>\n</script>\n";

/// Opens Fox with a journal that contains these records, and recovers the given number of steps.
fn recovered(name: &str, records: &[(u8, &[u8])], steps: usize) -> (TestDocument, View) {
    let folder = Folder::new(name);
    let path = fox(&folder);
    recovered_for(folder, path, records, steps)
}

fn recovered_for(
    folder: Folder,
    path: std::path::PathBuf,
    records: &[(u8, &[u8])],
    steps: usize,
) -> (TestDocument, View) {
    let autosave = folder.join("autosave");
    fs::create_dir_all(autosave.join("journals")).unwrap();
    fs::write(autosave.join("journals/old.journal"), forged_with(&header(&path), 1, records)).unwrap();
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    let offer = document.wait_for_offers().remove(0);
    assert_eq!(offer.warnings(), [""; 0]);
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let view = document.wait_for_view(|view| view.history.done == steps);
    (document, view)
}

fn header(path: &Path) -> String {
    let stamp = serde_json::to_value(FileStamp::take(&RealFiles, path).unwrap()).unwrap();
    let path = fs::canonicalize(path).unwrap();
    serde_json::json!({"number": 77, "document": path, "stamp": stamp}).to_string()
}

/// Returns names of takes, lengths in milliseconds and numbers of keys, which `dragonfly info` printed when the
/// records were stored.
fn takes(view: &View) -> Vec<(String, i32, usize)> {
    let keys = |take: &dragonfly_anim::data::Take| {
        let of = |track: &dragonfly_anim::data::Track| {
            track.translation.times.len() + track.rotation.times.len() + track.scale.times.len()
        };
        take.tracks.iter().map(of).sum()
    };
    let told = |take: &std::sync::Arc<dragonfly_anim::data::Take>| {
        (take.name.clone(), (take.length * 1000.0).round() as i32, keys(take))
    };
    view.takes.iter().map(told).collect()
}

fn first_takes() -> Vec<(String, i32, usize)> {
    let takes = [
        ("Walk", 967, 378),
        ("Walk slowly", 2000, 444),
        ("Look around", 1000, 525),
        ("Look around, end", 600, 357),
        ("Run", 1983, 842),
        ("Nod", 500, 2),
        ("Shake", 500, 2),
        ("Bend", 0, 1),
    ];
    takes.map(|(name, length, keys)| (name.to_owned(), length, keys)).into()
}

fn recorded(edit: &str) -> Vec<u8> {
    format!(r#"{{"do":"edit","edit":{edit}}}"#).into_bytes()
}

#[test]
fn names_that_are_now_invalid_are_still_read_from_old_journals() {
    let rename = |take: u32, name: &str| {
        recorded(&format!(r#"{{"edit":"rename_take","take":{take},"name":"{name}"}}"#))
    };
    let [nameless, same] = [rename(0, ""), rename(1, "Run")];
    let (mut document, view) = recovered("old-names", &[(2, &nameless), (2, &same)], 2);
    let names: Vec<_> = takes(&view).into_iter().map(|take| take.0).collect();
    assert_eq!(names, ["", "Run", "Run"]);
    let again = Edit::RenameTake(RenameTake { take: TakeRef::Index(2), name: String::new() });
    document.change(Change::Edit(again, None));
    let refused = document.wait_for_reply(|reply| match reply {
        DocumentReply::Refused(reason) => Some(reason.clone()),
        _ => None,
    });
    assert_eq!(refused, "A take needs a name");
}

#[test]
fn edits_of_every_version_are_replayed() {
    let begin = br#"{"do":"begin","version":1}"#.to_vec();
    let edits = first_edits().into_iter().map(|edit| recorded(&edit));
    let records: Vec<Vec<u8>> = std::iter::once(begin).chain(edits).collect();
    let records: Vec<(u8, &[u8])> = records.iter().map(|record| (2, &record[..])).collect();
    let (mut document, view) = recovered("old-edits", &records, records.len() - 1);
    assert_eq!(takes(&view), first_takes());
    document.change(Change::GoTo(0));
    let names: Vec<_> = takes(&document.view()).into_iter().map(|take| take.0).collect();
    assert_eq!(names, ["Survey", "Walk", "Run"], "and undone");
}

#[test]
fn edits_of_shape_keys_of_every_version_are_replayed() {
    let folder = Folder::new("old-shape-edits");
    let path = folder.join("AnimatedMorphCube.glb");
    fs::copy(data("gltf/AnimatedMorphCube.glb"), &path).unwrap();
    let records: Vec<Vec<u8>> = first_shape_edits().iter().map(|edit| recorded(edit)).collect();
    let records: Vec<(u8, &[u8])> = records.iter().map(|record| (2, &record[..])).collect();
    let (_, view) = recovered_for(folder, path, &records, records.len());
    let track = &view.takes[0].morphs[0];
    // Keys at 0.05 s and 6 s are set, that at 6 s goes to 7 s and is copied to 8 s. Both are set again, that at 8 s gets an offset, a
    // pending weight is keyed at 8.5 s, and a key is pasted at 9 s.
    assert_eq!(track.times.len(), 127 + 5);
    assert_eq!(track.times[128..], [7.0, 8.0, 8.5, 9.0]);
    assert_eq!(track.weights[2 * 2..2 * 2 + 2], [0.75, 0.25]);
    assert_eq!(track.weights[2 * 128..], [0.125, 1.0, 0.5, 0.75, 0.5, 0.75, 0.5, 0.0]);
}

#[test]
fn edits_of_scripts_of_every_version_are_replayed() {
    let folder = Folder::new("old-script-edits");
    let path = folder.join("scene.xml");
    fs::write(&path, SCENE).unwrap();
    let records: Vec<Vec<u8>> = first_script_edits().iter().map(|edit| recorded(edit)).collect();
    let records: Vec<(u8, &[u8])> = records.iter().map(|record| (2, &record[..])).collect();
    let (_, view) = recovered_for(folder, path, &records, records.len());
    let text = "<script version=\"1\">\n  <title text=\"Fin\" dur=\"3\"/>\n  <wait dur=\"1\"/>\n</script>\n";
    assert_eq!(&*view.scene.expect("a scene").text, text);
}

#[test]
fn a_snapshot_of_every_version_is_restored() {
    let (edits, all) = (first_edits().join(","), first_edits().len());
    let about = r#"{"version":1}"#;
    let text = format!(r#"{{"about":{about},"steps":[{edits}],"done":{all},"saved":null,"has_base":false}}"#);
    let mut snapshot = (text.len() as u32).to_le_bytes().to_vec();
    snapshot.extend(text.bytes());
    let (_, view) = recovered("old-snapshot", &[(1, &snapshot)], all);
    assert_eq!(takes(&view), first_takes());
}

/// Before a release, new types of edits are added to this file; after the release, to a new file.
#[test]
fn every_edit_type_occurs_in_the_stored_records() {
    let kind = |json: &str| {
        serde_json::from_str::<serde_json::Value>(json).unwrap()["edit"].as_str().unwrap().to_owned()
    };
    let kept: Vec<String> = all_first_edits().iter().map(|edit| kind(edit)).collect();
    for kind in EDITS {
        assert!(kept.contains(&kind.name.to_owned()), "{} is not in edits-1.jsonl", kind.name);
    }
    for edit in all_first_edits() {
        let value: serde_json::Value = serde_json::from_str(&edit).unwrap();
        let again = serde_json::to_value(serde_json::from_value::<Edit>(value.clone()).unwrap()).unwrap();
        for (field, was) in value.as_object().unwrap() {
            assert!(alike(&again[field], was), "{field} of {edit} is {}", again[field]);
        }
    }
}

/// Returns whether two values are equal, where a number may have been rounded to 32 bits.
fn alike(now: &serde_json::Value, was: &serde_json::Value) -> bool {
    use serde_json::Value::{Array, Number, Object};
    match (now, was) {
        (Number(now), Number(was)) => {
            let [now, was] = [now, was].map(|number| number.as_f64().unwrap_or(f64::NAN));
            (now - was).abs() <= 1e-6 * was.abs().max(1.0)
        }
        (Array(now), Array(was)) => {
            now.len() == was.len() && now.iter().zip(was).all(|(now, was)| alike(now, was))
        }
        (Object(now), Object(was)) => {
            was.iter().all(|(field, was)| now.get(field).is_some_and(|now| alike(now, was)))
        }
        _ => now == was,
    }
}
