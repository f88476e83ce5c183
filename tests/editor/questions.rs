//! Dialogs: each question fits completely into every window, can be answered by keyboard, and is closed by Escape.

use crate::panels::{Bench, harness_of};
use dragonfly::panels::FileAction;
use dragonfly::panels::dialogs::{
    ChangedModelsQuestion, ChangedQuestion, CopyQuestion, ExistsQuestion, FindQuestion, MissingQuestion,
    OutdatedQuestion, PlaceQuestion, PlanQuestion, Question, RecoverQuestion, RewriteQuestion, UnfitQuestion,
    UnsavedQuestion,
};
use dragonfly::panels::dropped_files::{FileUse, JobScene, WantedFiles};
use dragonfly::panels::{Effect, Request};
use dragonfly_document::{
    Decision, DocumentMessage, FileView, HistoryView, MissingFile, Offer, OutdatedEdits, OutdatedEditsChoice,
    SaveOrder, SaveTo, SceneFile, SceneFileKind, SceneFiles, Source, Then,
};
use dragonfly_kit::document::fixture;
use dragonfly_store::{DocumentFileState, FileState, JournalOwner, OwnerStatus, Readability, Recoverable};
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

pub(crate) fn offer(
    name: &str,
    steps: usize,
    ago: u64,
    file: DocumentFileState,
    reading: Readability,
    owner_status: OwnerStatus,
) -> Offer {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as i64;
    let document = PathBuf::from(format!("/home/mara/models/animals/{name}"));
    Offer {
        title: name.to_owned(),
        source: Some(Source::File(document.clone())),
        steps,
        labels: ["Pose", "Move keys", "Rename take", "Pose", "Add keys"].map(str::to_owned).to_vec(),
        found: Recoverable {
            journal: format!("/home/mara/.local/state/dragonfly/journals/{name}.journal").into(),
            document: Some(document),
            when: now - ago as i64 * 1_000_000_000,
            work: steps as u64,
            unsaved: steps as u64,
            bytes: 4000,
            reading,
            file,
            stamp: None,
            saving: None,
            owner: Some(JournalOwner { process: 4242, host: "attic".to_owned() }),
            owner_status,
        },
    }
}

fn questions() -> Vec<(&'static str, Question)> {
    let fox = |file, reading, status| offer("Fox.glb", 12, 250, file, reading, status);
    let whole = || fox(DocumentFileState::Same, Readability::Whole, OwnerStatus::Exited);
    let lines = |count: usize| -> Arc<[String]> {
        let first = "take \"Survey\", \"b_Head_05\" (node 7), rotation: changed".to_owned();
        let more = (0..count).map(|at| format!("/animations/0/samplers/{at}/output: 21 → 93"));
        std::iter::once(first).chain(more).collect()
    };
    let recover = |offers, lost| -> Question { RecoverQuestion { offers, lost }.into() };
    let changed = |file, order| -> Question { ChangedQuestion { file, path: None, order }.into() };
    let plan = |lines, order| -> Question { PlanQuestion { lines, order }.into() };
    let place = |copy| -> Question { PlaceQuestion { copy, then: None }.into() };
    let unsaved = |then| -> Question { UnsavedQuestion { then }.into() };
    let bear = offer(
        "A bear with a rather long name that goes on.gltf",
        1,
        90_000,
        DocumentFileState::Same,
        Readability::Whole,
        OwnerStatus::Exited,
    );
    let own = || Some(SaveOrder::own(None));
    vec![
        (
            "find",
            FindQuestion {
                offer: Box::new(fox(DocumentFileState::Missing, Readability::Whole, OwnerStatus::Exited)),
                other: None,
            }
            .into(),
        ),
        (
            "find_another",
            FindQuestion { offer: Box::new(whole()), other: Some("/home/mara/models/Fox 2.glb".into()) }
                .into(),
        ),
        ("unsaved", unsaved(Then::Quit)),
        ("unsaved_open", unsaved(Then::Open(Source::File("/models/Bear.glb".into())))),
        ("changed_save", changed(FileState::Changed, own())),
        ("changed_focus", changed(FileState::Changed, None)),
        ("gone", changed(FileState::Missing, None)),
        (
            "exists",
            ExistsQuestion { path: "/home/mara/models/Fox 2.glb".into(), order: SaveOrder::own(None) }.into(),
        ),
        ("rewrite", RewriteQuestion { order: SaveOrder::own(None) }.into()),
        ("plan", plan(lines(6), own())),
        ("plan_long", plan(lines(100_000), None)),
        ("plan_nothing", plan(Arc::from(["nothing changes".to_owned()]), own())),
        ("recover", recover(vec![whole()], false)),
        ("recover_lost", recover(vec![whole()], true)),
        ("recover_several", recover(vec![whole(), bear], false)),
        (
            "recover_warned",
            recover(
                vec![fox(DocumentFileState::Changed, Readability::Cut(17), OwnerStatus::OnOtherHost)],
                false,
            ),
        ),
        (
            "recover_missing",
            recover(vec![fox(DocumentFileState::Missing, Readability::Whole, OwnerStatus::Exited)], false),
        ),
        ("where", place(false)),
        ("where_copy", place(true)),
        ("unfit", UnfitQuestion { lines: lines(2) }.into()),
        ("outdated", OutdatedQuestion { edits: outdated() }.into()),
        ("changed_models", ChangedModelsQuestion { edits: vec![outdated(), outdated()] }.into()),
        ("copy", CopyQuestion { wanted: wanted(&["knight.gltf"]) }.into()),
        ("copy_many", CopyQuestion { wanted: wanted(&["knight.gltf"; 40]) }.into()),
        ("missing", MissingQuestion { missing: missing() }.into()),
    ]
}

/// Models outside of the folder of a scene, each with two files.
pub(crate) fn wanted(names: &[&str]) -> Box<WantedFiles> {
    let file = |name: &&str| SceneFile {
        beside: vec!["knight.bin".to_owned(), "knight.png".to_owned()],
        ..SceneFile::new(SceneFileKind::Model, PathBuf::from("/home/mara/downloads").join(name))
    };
    let files = SceneFiles { folder: "/home/mara/duel".into(), files: names.iter().map(file).collect() };
    Box::new(WantedFiles { files, others: Vec::new(), used: FileUse::Role, target: JobScene::default() })
}

pub(crate) fn missing() -> MissingFile {
    let [name, file] = ["knight", "models/knight.glb"].map(str::to_owned);
    MissingFile { kind: SceneFileKind::Model, name, file }
}

fn outdated() -> OutdatedEdits {
    OutdatedEdits { model: "fox".to_owned(), title: "Fox.glb".to_owned(), hash: 7 }
}

fn bench(question: Question) -> Bench {
    let mut bench = Bench::new(Some(fixture::full()));
    bench.state.ask(question);
    bench
}

#[test]
fn every_kind_of_question_has_an_example_in_this_file() {
    let names: Vec<String> = questions().iter().map(|(_, question)| format!("{question:?}")).collect();
    for kind in Question::KINDS {
        assert!(names.iter().any(|name| name.starts_with(&format!("{kind}("))), "{kind} has no example");
    }
}

#[test]
fn the_file_question_stays_until_a_path_is_given() {
    let fox = Box::new(offer(
        "Fox.glb",
        12,
        250,
        DocumentFileState::Missing,
        Readability::Whole,
        OwnerStatus::Exited,
    ));
    let mut bench = bench(RecoverQuestion { offers: vec![(*fox).clone()], lost: false }.into());
    bench.state.ask_where_it_is(fox.clone(), Some("Fox 2.glb".into()));
    bench.state.execute(Request::Answer(FileAction::Find(fox.clone())));
    // The file dialog may be closed without an answer.
    assert!(
        matches!(bench.state.read().question(), Some(Question::Find(_))),
        "{:?}",
        bench.state.read().question()
    );
    bench.state.offer_is_answered(&fox);
    assert_eq!(bench.state.read().question(), None);
}

/// Returns the effects apart from looks at the folder of a path.
fn answers(bench: &Bench) -> Vec<Effect> {
    let is_look =
        |effect: &&Effect| matches!(effect, Effect::File(FileAction::Send(DocumentMessage::LookAtFolder(_))));
    bench.effects.iter().filter(|effect| !is_look(effect)).cloned().collect()
}

#[test]
fn the_question_where_to_save_tells_which_folders_the_save_makes() {
    let bench = bench(PlaceQuestion { copy: false, then: None }.into());
    let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(4);
    for (folder, created, hint) in [
        ("/models/animals", Some("animals"), "A new folder animals will be made"),
        ("/models/a/b", Some("a/b"), "New folders a/b will be made"),
        ("/models", None, "will be made"),
    ] {
        harness.get_by_label("Path to save at").focus();
        harness.run_steps(1);
        harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        harness.event(egui::Event::Text(format!("{folder}/Fox.glb")));
        harness.run_steps(3);
        assert!(harness.query_by_label_contains("will be made").is_none(), "it is not known yet");
        let looks = |effect: &Effect| {
            let wanted = DocumentMessage::LookAtFolder(folder.into());
            *effect == Effect::File(FileAction::Send(wanted))
        };
        assert_eq!(harness.state().effects.iter().filter(|effect| looks(effect)).count(), 1, "asked once");
        harness.state_mut().state.set_new_folders(folder.into(), created.map(Into::into));
        harness.run_steps(2);
        assert_eq!(harness.query_by_label_contains(hint).is_some(), created.is_some(), "{folder}");
    }
}

#[test]
fn every_question_fits_every_window_and_escape_closes_it_without_an_action() {
    for (name, question) in questions() {
        for size in [egui::vec2(1280.0, 720.0), egui::vec2(480.0, 320.0), egui::vec2(40.0, 30.0)] {
            let mut harness = harness_of(bench(question.clone()), size, 1.0, egui::Theme::Dark);
            harness.run_steps(4);
            assert!(harness.state().state.read().question().is_some(), "{name}");
            harness.key_press(egui::Key::Escape);
            harness.run_steps(4);
            let bench = harness.state();
            assert!(bench.state.read().question().is_none() || name == "recover_several", "{name} at {size}");
            let later = |effect: &Effect| {
                matches!(effect, Effect::File(FileAction::Send(DocumentMessage::Decide(_, Decision::Later))))
            };
            let effects = answers(bench);
            assert!(effects.iter().all(later), "{name}: {effects:?}");
        }
    }
}

#[test]
fn enter_chooses_the_default_button() {
    let size = egui::vec2(1280.0, 720.0);
    for (name, question) in questions() {
        let mut harness = harness_of(bench(question), size, 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        harness.key_press(egui::Key::Enter);
        harness.run_steps(4);
        let effects = answers(harness.state());
        let expected = match name {
            "unsaved" => Some(FileAction::Send(DocumentMessage::Save(SaveOrder::own(Some(Then::Quit))))),
            "changed_save" => Some(FileAction::Where { copy: false, then: None }),
            "changed_focus" => Some(FileAction::Reload),
            "gone" => Some(FileAction::Send(DocumentMessage::Save(SaveOrder {
                anyway: true,
                ..SaveOrder::own(None)
            }))),
            "plan" => Some(FileAction::Send(DocumentMessage::Save(SaveOrder::own(None)))),
            "exists" | "plan_long" | "unfit" | "outdated" | "changed_models" => None,
            "copy" => {
                assert_eq!(effects, [Effect::CopyFiles(wanted(&["knight.gltf"]))]);
                continue;
            }
            "where_copy" => Some(FileAction::Send(DocumentMessage::Save(SaveOrder {
                // The fixture was opened by a relative path, and the field has a whole one.
                to: SaveTo::Copy(std::path::absolute("Fox copy.glb").unwrap()),
                ..SaveOrder::own(None)
            }))),
            _ => continue,
        };
        let expected: Vec<Effect> = expected.map(Effect::File).into_iter().collect();
        assert_eq!(effects, expected, "{name}");
        assert!(harness.state().state.read().question().is_none(), "{name}");
    }
}

#[test]
fn each_button_for_unsaved_work_applies_to_the_document_that_is_shown() {
    for (button, decision) in [
        ("Restore", Decision::Keep),
        ("Open as a copy", Decision::Beside),
        ("Later", Decision::Later),
        ("Discard", Decision::Discard),
    ] {
        let (_, question) = questions().into_iter().find(|(name, _)| *name == "recover_several").unwrap();
        let mut harness = harness_of(bench(question), egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        harness.get_by_label_contains("A bear").click();
        harness.run_steps(2);
        harness.get_by_label(button).click();
        harness.run_steps(4);
        let [Effect::File(FileAction::Send(DocumentMessage::Decide(offer, decided)))] =
            &harness.state().effects[..]
        else {
            panic!("{button}: {:?}", harness.state().effects)
        };
        assert!(offer.title.starts_with("A bear") && *decided == decision, "{button}");
        // If work is left or discarded, the question about the other document stays; otherwise a file is opened first.
        let left = match harness.state().state.read().question() {
            Some(Question::Recover(recover)) => recover.offers.len(),
            _ => 0,
        };
        let aside = matches!(decision, Decision::Later | Decision::Discard);
        assert_eq!(left, usize::from(aside), "{button}");
    }
}

#[test]
fn an_open_question_receives_all_keys_and_the_next_question_follows() {
    let mut state = bench(UnsavedQuestion { then: Then::Quit }.into()).state;
    state.ask(ChangedQuestion { file: FileState::Changed, path: None, order: None }.into());
    // The same question is not asked twice.
    state.ask(UnsavedQuestion { then: Then::Quit }.into());
    assert_eq!(state.read().prompts.questions().len(), 2);
    assert_eq!(state.execute(Request::Dismiss), None);
    assert_eq!(state.execute(Request::Dismiss), None);
    assert_eq!(state.read().question(), None);
    assert_eq!(state.execute(Request::Dismiss), None);
}

#[test]
fn a_file_that_changed_on_disk_can_be_loaded_with_the_unsaved_changes() {
    for order in [None, Some(SaveOrder::own(None))] {
        let mut bench = bench(ChangedQuestion { file: FileState::Changed, path: None, order }.into());
        let mut view = bench.state.read().view.cloned().expect("a model");
        view.history = Arc::new(HistoryView { saved: false, ..(*view.history).clone() });
        bench.state.show(view);
        let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        harness.get_by_label("Load and apply my changes").click();
        harness.run_steps(4);
        let reload = Effect::File(FileAction::Send(DocumentMessage::Reload));
        assert_eq!(harness.state().effects, [reload]);
        assert_eq!(harness.state().state.read().question(), None);
    }
}

#[test]
fn a_text_of_a_project_that_changed_on_disk_is_the_file_that_the_question_names() {
    for (path, name) in [("/foxes/main.xml", "main.xml"), ("/foxes/Fox.glb", "Fox.glb")] {
        let (path, order) = (Some(path.into()), Some(SaveOrder::own(None)));
        let mut bench = bench(ChangedQuestion { file: FileState::Changed, path, order }.into());
        let mut view = bench.state.read().view.cloned().expect("a model");
        view.file = Arc::new(FileView { title: "Fox.glb".to_owned(), ..(*view.file).clone() });
        bench.state.show(view);
        let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        assert!(harness.query_by_label(&format!("{name} was changed on disk")).is_some());
        assert_eq!(harness.query_by_label_contains("It belongs to Fox.glb").is_some(), name == "main.xml");
    }
}

#[test]
fn outdated_edits_of_a_model_are_applied_or_removed_as_the_user_chooses() {
    for (button, choice) in [
        ("Apply", Some(OutdatedEditsChoice::Apply)),
        ("Remove", Some(OutdatedEditsChoice::Remove)),
        ("Cancel", None),
    ] {
        let bench = bench(OutdatedQuestion { edits: outdated() }.into());
        let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        harness.get_by_label(button).click();
        harness.run_steps(4);
        let message = choice.map(|choice| DocumentMessage::DecideOutdated(outdated(), choice));
        let wanted: Vec<Effect> =
            message.into_iter().map(|message| Effect::File(FileAction::Send(message))).collect();
        assert_eq!(harness.state().effects, wanted, "{button}");
        assert_eq!(harness.state().state.read().question(), None);
    }
}

#[test]
fn edits_of_all_changed_models_are_applied_or_removed_as_the_user_chooses() {
    for (button, choice) in [
        ("Apply the edits again", Some(OutdatedEditsChoice::Apply)),
        ("Remove the edits", Some(OutdatedEditsChoice::Remove)),
        ("Later", None),
    ] {
        let edits = vec![outdated(), OutdatedEdits { model: "bear".to_owned(), ..outdated() }];
        let bench = bench(ChangedModelsQuestion { edits: edits.clone() }.into());
        let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        assert!(harness.query_by_label("2 models changed since their edits were made").is_some());
        harness.get_by_label(button).click();
        harness.run_steps(4);
        let message = choice.map(|choice| DocumentMessage::DecideAllOutdated(edits.clone(), choice));
        let wanted: Vec<Effect> =
            message.into_iter().map(|message| Effect::File(FileAction::Send(message))).collect();
        assert_eq!(harness.state().effects, wanted, "{button}");
        assert_eq!(harness.state().state.read().question(), None);
    }
}

#[test]
fn without_unsaved_changes_there_is_nothing_to_apply_to_a_changed_file() {
    let bench = bench(ChangedQuestion { file: FileState::Changed, path: None, order: None }.into());
    let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(4);
    assert!(harness.query_by_label("Load and apply my changes").is_none());
}
