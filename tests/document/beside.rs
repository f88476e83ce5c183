//! The files next to a model: a change by another program is noticed before a save, what earlier saves left is removed on request, and
//! nothing that another model needs is ever removed.

use crate::save_and_open::open;
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_document::history::Edited;
use dragonfly_document::{DocumentMessage, DocumentReply, NotSaved, SaveOrder, SaveTo};
use dragonfly_kit::document::test_document::{TestDocument, rename};
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_store::SaveOptions;
use std::fs;
use std::path::{Path, PathBuf};

/// Copies a model with a buffer in another file. Returns the paths of the model and of the buffer.
fn cube(folder: &Folder) -> (PathBuf, PathBuf) {
    let from = data("gltf/AnimatedMorphCube_Quantized");
    let [model, buffer] = ["AnimatedMorphCube.gltf", "AnimatedMorphCube.bin"].map(|name| {
        fs::copy(from.join(name), folder.join(name)).expect("a copy");
        folder.join(name)
    });
    (model, buffer)
}

/// Returns an edit of keys, after which a save writes a new buffer file.
fn slower(length: f32) -> Edit {
    let line = format!(r#"{{"edit":"retime_take","take":0,"length":{length}}}"#);
    serde_json::from_str(&line).expect("an edit")
}

/// Returns the buffer files that saves wrote in a folder.
fn buffers(folder: &Path) -> Vec<PathBuf> {
    let names = fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path());
    let ours = |path: &PathBuf| path.to_string_lossy().contains(".dragonfly-");
    let mut found: Vec<_> = names.filter(ours).collect();
    found.sort();
    found
}

/// Opens the model, makes some saves with other keys, and returns the notices of the last one.
fn save_often(document: &mut TestDocument, saves: u32) -> Vec<String> {
    let mut notices = Vec::new();
    for save in 1..=saves {
        document.edit(slower(1.0 + save as f32 * 0.1));
        notices = document.save(SaveTo::Own).notices;
    }
    notices
}

fn not_saved(document: &mut TestDocument) -> NotSaved {
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    })
}

#[test]
fn a_buffer_file_that_another_program_changed_is_noticed_before_a_save() {
    let folder = Folder::new("beside-changed");
    let (model, buffer) = cube(&folder);
    let before = fs::read(&model).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&model);
    document.edit(slower(2.0));
    let mut bytes = fs::read(&buffer).expect("a file");
    bytes[7] ^= 1;
    fs::write(&buffer, bytes).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::FileChanged(_)).then_some(()));
    assert!(matches!(not_saved(&mut document), NotSaved::Changed(_)));
    assert!(fs::read(&model).expect("a file") == before);
    assert_eq!(buffers(folder.path()), [] as [PathBuf; 0]);
    // The user may decide.
    document.send(DocumentMessage::Save(SaveOrder { anyway: true, ..SaveOrder::own(None) }));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Saved(_)).then_some(()));
}

#[test]
fn a_buffer_file_that_a_save_wrote_is_watched_as_well() {
    let folder = Folder::new("beside-written");
    let (model, _) = cube(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&model);
    save_often(&mut document, 3);
    let newest = fs::read_to_string(&model).expect("text");
    let used = buffers(folder.path()).into_iter();
    let used: Vec<_> =
        used.filter(|path| newest.contains(&*path.file_name().expect("a name").to_string_lossy())).collect();
    assert_eq!(used.len(), 1, "{used:?}");
    fs::write(&used[0], b"of another program").expect("a file");
    document.edit(rename("Slowly"));
    assert!(matches!(not_saved(&mut document), NotSaved::Changed(_)));
}

#[test]
fn buffer_files_of_earlier_saves_are_offered_for_removal_and_removed_on_request() {
    let folder = Folder::new("beside-unused");
    let (model, buffer) = cube(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&model);
    let notices = save_often(&mut document, 5);
    assert_eq!(buffers(folder.path()).len(), 5);
    assert!(notices.iter().any(|notice| notice.contains("4 buffer files")), "{notices:?}");
    document.end();
    let editable = open(&model);
    assert_eq!(editable.remove_unused().len(), 4);
    assert_eq!(buffers(folder.path()).len(), 1);
    assert!(buffer.exists());
    let again = open(&model);
    assert!(again.warnings.iter().all(|warning| !warning.contains("missing")), "{:?}", again.warnings);
    assert_eq!(again.model.animation.takes, editable.model.animation.takes);
    assert_eq!(again.remove_unused(), [] as [PathBuf; 0]);
}

#[test]
fn a_buffer_file_that_another_model_needs_or_another_program_wrote_is_never_removed() {
    let folder = Folder::new("beside-needed");
    let place = folder.join("models");
    fs::create_dir(&place).expect("a folder");
    let (model, buffer) = cube(&folder);
    let [model, _] = [model, buffer].map(|path| {
        let to = place.join(path.file_name().expect("a name"));
        fs::rename(path, &to).expect("moved");
        to
    });
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&model);
    save_often(&mut document, 1);
    // A copy of the model refers to the first buffer, a model in the folder above to the second.
    fs::copy(&model, place.join("Copy.gltf")).expect("a copy");
    let first = buffers(&place).remove(0);
    save_often_from(&mut document, 2.0);
    let second = buffers(&place).into_iter().find(|path| *path != first).expect("two");
    let name = second.file_name().expect("a name").to_string_lossy().into_owned();
    fs::write(folder.join("above.gltf"), format!(r#"{{"buffers":[{{"uri":"models/{name}"}}]}}"#))
        .expect("a file");
    save_often_from(&mut document, 3.0);
    save_often_from(&mut document, 4.0);
    document.end();
    // Names of ours with content of others, and names of other models.
    let foreign = place.join("AnimatedMorphCube.dragonfly-0123456789abcdef.bin");
    fs::write(&foreign, b"not what its name says").expect("a file");
    let other = place.join("Other.dragonfly-af63bd4c8601b7df.bin");
    fs::write(&other, b"").expect("a file");
    let all = buffers(&place);
    assert_eq!(all.len(), 6, "{all:?}");
    // A model too large to be read may refer to any of them.
    let large = fs::File::create(place.join("large.glb")).expect("a file");
    large.set_len(FILE_BYTES + 1).expect("a file with a hole");
    assert!(open(&model).remove_unused().is_empty());
    fs::remove_file(place.join("large.glb")).expect("it is there");
    let removed = open(&model).remove_unused();
    assert_eq!(removed.len(), 1, "only the third buffer: {removed:?}");
    for kept in [&first, &second, &foreign, &other] {
        assert!(kept.exists(), "{}", kept.display());
    }
    assert_eq!(open(&place.join("Copy.gltf")).model.animation.takes.len(), 1);
}

fn save_often_from(document: &mut TestDocument, length: f32) {
    document.edit(slower(length));
    document.save(SaveTo::Own);
}

/// The number of a process that does not run: larger than any.
const DEAD: &str = "4194999";

/// Writes `name` on a disk that fails for good, and returns the name of the unfinished file that is left.
fn part_of(folder: &Folder, name: &str) -> String {
    let all = || fs::read_dir(folder.path()).expect("a folder").flatten().map(|entry| entry.file_name());
    for call in 1.. {
        let files = FaultyFiles::from(call, Fault::Io);
        let done = dragonfly_store::save(&files, &folder.join(name), b"whole", &SaveOptions::default());
        let part = all().find(|left| {
            let left = left.to_string_lossy();
            left.starts_with(&format!(".{name}.")) && left.ends_with(".part")
        });
        if let Some(part) = part {
            return part.to_string_lossy().into_owned();
        }
        assert!(done.is_err(), "no unfinished file was left");
    }
    unreachable!("a save makes a finite number of calls")
}

#[cfg(unix)]
#[test]
fn what_a_killed_save_left_of_a_buffer_file_is_removed_by_the_next_save() {
    let folder = Folder::new("beside-part");
    let (model, _) = cube(&folder);
    let mut editable = open(&model);
    let mut edited = Edited::new(ModelAdapter::new(&editable.model.animation));
    edited.apply(slower(2.0), None).expect("a take");
    let running = part_of(&folder, "AnimatedMorphCube.dragonfly-0123456789abcdef.bin");
    let foreign = part_of(&folder, "Notes.txt").replace(&std::process::id().to_string(), DEAD);
    let watched = running.replace(&std::process::id().to_string(), DEAD);
    for name in [&watched, &running, &foreign] {
        fs::write(folder.join(name), b"half").expect("a file");
    }
    let plan = editable.plan(edited.adapter()).expect("a plan");
    editable.save(edited.adapter(), &plan, &model).expect("saved");
    assert!(!folder.join(&watched).exists());
    assert!(folder.join(&running).exists() && folder.join(&foreign).exists());
    let named = Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: "Again".to_owned() });
    edited.apply(named, None).expect("a take");
    let plan = editable.plan(edited.adapter()).expect("a plan");
    editable.save(edited.adapter(), &plan, &model).expect("saved again");
}
