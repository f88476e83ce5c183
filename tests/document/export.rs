//! Exports: files of other formats from the open model as it is now, or from a part of it.

use dragonfly_anim::format::{NoFiles, ReadOptions};
use dragonfly_document::{
    DocumentMessage, DocumentReply, ExportContent, ExportOrder, ExportReport, LoadedModel, View, formats,
};
use dragonfly_kit::document::test_document::{TestDocument, fox, rename, turn};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::Path;

struct Exporter {
    folder: Folder,
    document: TestDocument,
}

impl Exporter {
    fn new(name: &str) -> (Self, View) {
        let folder = Folder::new(name);
        let mut document = TestDocument::new(&folder.join("autosave"));
        let view = document.open(&fox(&folder));
        (Self { folder, document }, view)
    }

    fn order(&self, name: &str) -> ExportOrder {
        ExportOrder { output: self.folder.join(name), is_written: true, ..ExportOrder::default() }
    }

    fn export(&mut self, order: ExportOrder) -> Result<ExportReport, String> {
        let expected = order.clone();
        self.document.send(DocumentMessage::Export(order));
        self.document.wait_for_reply(|reply| match reply {
            DocumentReply::Exported(order, done) if *order == expected => Some(done.clone()),
            _ => None,
        })
    }

    /// Reads a file that was exported.
    fn read(&self, name: &str) -> dragonfly_anim::data::ModelData {
        let bytes = fs::read(self.folder.join(name)).expect("the file");
        formats().read(name, &bytes, &NoFiles, &ReadOptions::default()).expect("a model").model
    }

    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.join("out")).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

fn names(report: &ExportReport) -> Vec<String> {
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    report.files.iter().map(|file| name(&file.path)).collect()
}

#[test]
fn an_export_contains_the_unsaved_edits_and_changes_neither_the_document_nor_its_file() {
    let (mut exporter, _) = Exporter::new("export-edited");
    let own = fs::read(exporter.folder.join("Fox.glb")).expect("the file");
    exporter.document.edit(rename("Look around"));
    exporter.document.edit(turn(0.5));
    let before = exporter.document.wait_for_view(|view| view.history.done == 2);
    let report = exporter.export(exporter.order("Copy.dfm")).expect("written");
    assert_eq!((names(&report), report.files[0].replaces), (vec!["Copy.dfm".to_owned()], false));
    let model = exporter.read("Copy.dfm");
    assert_eq!(model.animation.takes[0].name, "Look around");
    assert_eq!(model.animation.takes[0].tracks, before.takes[0].tracks);
    let after = exporter.document.view();
    assert_eq!((after.history.done, after.history.saved), (2, false));
    assert_eq!(after.file.title, "Fox.glb");
    assert!(fs::read(exporter.folder.join("Fox.glb")).expect("the file") == own);
}

#[test]
fn a_part_of_the_model_can_be_exported_and_each_take_as_a_file_of_its_own() {
    let (mut exporter, view) = Exporter::new("export-parts");
    let LoadedModel { model, .. } = &*view.loaded;
    exporter
        .export(ExportOrder { content: ExportContent::Model, ..exporter.order("Model.glb") })
        .expect("written");
    let written = exporter.read("Model.glb");
    assert_eq!((written.animation.takes.len(), written.meshes.len()), (0, model.meshes.len()));
    let takes = ExportOrder { content: ExportContent::Takes, ..exporter.order("out/Fox.glb") };
    let report = exporter.export(ExportOrder { each: true, ..takes.clone() }).expect("written");
    assert_eq!(names(&report), ["Fox@Survey.glb", "Fox@Walk.glb", "Fox@Run.glb"]);
    assert_eq!(exporter.files(), ["Fox@Run.glb", "Fox@Survey.glb", "Fox@Walk.glb"]);
    let walk = exporter.read("out/Fox@Walk.glb");
    assert_eq!((walk.meshes.len(), walk.animation.takes.len()), (0, 1));
    assert_eq!(walk.animation.takes[0].name, "Walk");
    let chosen = ExportOrder { takes: Some(vec![2, 0]), ..takes };
    exporter.export(chosen).expect("written");
    let names: Vec<String> =
        exporter.read("out/Fox.glb").animation.takes.iter().map(|take| take.name.clone()).collect();
    assert_eq!(names, ["Run", "Survey"]);
}

#[test]
fn what_a_format_cannot_contain_is_listed_before_anything_is_written() {
    let (mut exporter, _) = Exporter::new("export-plan");
    fs::write(exporter.folder.join("there.bvh"), b"an older file").expect("a file");
    let plan = ExportOrder { is_written: false, ..exporter.order("there.bvh") };
    let report = exporter.export(plan.clone()).expect("a plan");
    assert!(report.files[0].replaces && report.files[0].bytes > 1000);
    assert!(report.lost.iter().any(|lost| lost.contains("only bones are stored")), "{:?}", report.lost);
    assert!(report.lost.iter().any(|lost| lost.contains("Walk")), "{:?}", report.lost);
    assert_eq!(fs::read(exporter.folder.join("there.bvh")).expect("a file"), b"an older file");
    let written = exporter.export(ExportOrder { is_written: true, ..plan }).expect("written");
    assert_eq!(written.lost, report.lost);
    assert!(fs::read(exporter.folder.join("there.bvh")).expect("a file").starts_with(b"HIERARCHY"));
}

#[test]
fn an_export_that_is_not_possible_names_the_reason_and_writes_nothing() {
    let (mut exporter, _) = Exporter::new("export-refused");
    let reason = exporter.export(exporter.order("Fox.step")).unwrap_err();
    assert!(reason.contains("Fox.step") && reason.contains(".glb"), "{reason}");
    let preset =
        |name: &str, preset: &str| ExportOrder { preset: Some(preset.to_owned()), ..exporter.order(name) };
    let (glb, fbx) = (preset("Fox2.glb", "unity"), preset("Fox2.fbx", "godot"));
    let reason = exporter.export(glb).unwrap_err();
    assert!(reason.contains("no presets"), "{reason}");
    let reason = exporter.export(fbx).unwrap_err();
    assert!(reason.contains("unity, unreal"), "{reason}");
    assert!(!exporter.folder.join("Fox2.glb").exists() && !exporter.folder.join("Fox2.fbx").exists());
    // A folder in place of the file.
    fs::create_dir(exporter.folder.join("Fox3.glb")).expect("a folder");
    assert!(exporter.export(exporter.order("Fox3.glb")).unwrap_err().contains("Fox3.glb"));
}

#[test]
fn of_many_questions_at_once_the_newest_one_is_answered_and_the_others_are_left_out() {
    let (mut exporter, _) = Exporter::new("export-questions");
    let question =
        |number: usize| ExportOrder { is_written: false, ..exporter.order(&format!("{number}.glb")) };
    let questions: Vec<ExportOrder> = (0..50).map(question).collect();
    for question in &questions {
        exporter.document.send(DocumentMessage::Export(question.clone()));
    }
    let mut answered = Vec::new();
    exporter.document.wait_for_reply(|reply| {
        if let DocumentReply::Exported(order, done) = reply {
            assert!(done.is_ok(), "{done:?}");
            answered.push(order.clone());
        }
        (answered.last() == questions.last()).then_some(())
    });
    assert_eq!(answered[0], questions[0]);
    assert!(answered.len() < questions.len(), "{} answers", answered.len());
    // The next question is answered again.
    assert!(exporter.export(questions[7].clone()).is_ok());
}

#[test]
fn frames_become_keys_or_files_of_one_pose_each() {
    let (mut exporter, view) = Exporter::new("export-frames");
    let bake = Some(12);
    exporter.export(ExportOrder { bake, ..exporter.order("Baked.glb") }).expect("written");
    let (baked, own) = (exporter.read("Baked.glb"), &view.takes[0]);
    let frames = (own.length * 12.0).round() as usize + 1;
    let most = baked.animation.takes[0].tracks.iter().map(|track| track.rotation.times.len()).max();
    assert_eq!(most, Some(frames));
    exporter.export(exporter.order("out/One.obj")).expect("written");
    assert_eq!(exporter.files().iter().filter(|name| name.ends_with(".obj")).count(), 1);
    exporter.export(ExportOrder { bake, ..exporter.order("out/Frames.obj") }).expect("written");
    let written = exporter.files();
    assert_eq!(
        written.iter().filter(|name| name.starts_with("Frames_") && name.ends_with(".obj")).count(),
        frames
    );
}
