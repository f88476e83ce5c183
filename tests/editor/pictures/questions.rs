//! Every question to the user.

use super::series::{self, Crop, PictureCase};
use super::states::Fullness;
use crate::questions::{missing as missing_file, offer, wanted};
use crate::workbench::Workbench;
use dragonfly::panels::dialogs::{
    ChangedModelsQuestion, ChangedQuestion, CopyQuestion, ExistsQuestion, FindQuestion, MissingQuestion,
    OutdatedQuestion, PlaceQuestion, PlanQuestion, Question, RecoverQuestion, RewriteQuestion, UnfitQuestion,
    UnsavedQuestion,
};
use dragonfly_document::edit::{Edit, ReverseTake, TakeRef};
use dragonfly_document::{Change, FileView, MissingFile, Offer, OutdatedEdits, SaveOrder, Source, Then};
use dragonfly_store::DocumentFileState::{Changed, Missing, Same, Unsaved};
use dragonfly_store::FileState;
use dragonfly_store::OwnerStatus::{Exited, OnOtherHost};
use dragonfly_store::Readability::{Cut, Whole};
use egui::vec2;
use std::sync::Arc;

/// The kind of a question in lower case, the name of its state, and a function that returns it.
type QuestionRow = (&'static str, &'static str, fn() -> Question);

/// Every question is about a model or a file, so none has a state `empty`.
const STATES: [&str; 2] = ["typical", "crowded"];

/// Each question in its states; made when it is drawn, because it contains times.
const TABLE: &[QuestionRow] = &[
    ("unsaved", "typical", || UnsavedQuestion { then: Then::Quit }.into()),
    ("unsaved", "crowded", || {
        UnsavedQuestion { then: Then::Open(Source::File(long("another file").into())) }.into()
    }),
    ("changed", "typical", || ChangedQuestion { file: FileState::Changed, path: None, order: None }.into()),
    ("changed", "crowded", || {
        ChangedQuestion { file: FileState::Changed, path: None, order: Some(SaveOrder::own(None)) }.into()
    }),
    ("changed", "gone", || ChangedQuestion { file: FileState::Missing, path: None, order: None }.into()),
    ("exists", "typical", || exists("/home/mara/models/Fox 2.glb")),
    ("exists", "crowded", || exists(&long("another file"))),
    ("plan", "typical", || plan(lines(4), Some(SaveOrder::own(None)))),
    ("plan", "crowded", || plan(lines(100_000), None)),
    ("plan", "nothing", || plan(Arc::from(["nothing changes".to_owned()]), Some(SaveOrder::own(None)))),
    ("recover", "typical", || RecoverQuestion { offers: vec![fox()], lost: false }.into()),
    ("recover", "crowded", || RecoverQuestion { offers: many(), lost: true }.into()),
    ("recover", "warned", || {
        RecoverQuestion {
            offers: vec![offer("Fox.glb", 12, 250, Changed, Cut(17), OnOtherHost)],
            lost: false,
        }
        .into()
    }),
    ("recover", "missing", || RecoverQuestion { offers: vec![missing("Fox.glb")], lost: false }.into()),
    ("find", "typical", || FindQuestion { offer: Box::new(missing("Fox.glb")), other: None }.into()),
    ("find", "crowded", || {
        let (offer, other) = (Box::new(missing(&long("a bear"))), Some(long("another file").into()));
        FindQuestion { offer, other }.into()
    }),
    ("unfit", "typical", || {
        let reasons = [
            r#"Rotate (b_Head_05, Survey, at 0.5 s): the new version has no bone "b_Head_05""#,
            r#"Reverse take (Sprint): the new version has no take "Sprint""#,
            r#"Move keys (3 bones, Walk), applied in part: "b_Neck_04" has no rotation key at 1.25 s in the new version"#,
        ];
        UnfitQuestion { lines: reasons.map(str::to_owned).into() }.into()
    }),
    ("unfit", "crowded", || UnfitQuestion { lines: lines(100_000) }.into()),
    ("rewrite", "typical", || RewriteQuestion { order: SaveOrder::own(None) }.into()),
    ("rewrite", "crowded", || RewriteQuestion { order: SaveOrder::own(Some(Then::Quit)) }.into()),
    ("outdated", "typical", || outdated("Fox.glb")),
    ("outdated", "crowded", || outdated(&long("A fox"))),
    ("changedmodels", "typical", || changed_models(3)),
    ("changedmodels", "crowded", || changed_models(400)),
    ("copy", "typical", || CopyQuestion { wanted: wanted(&["knight.gltf"]) }.into()),
    ("copy", "crowded", || CopyQuestion { wanted: wanted(&["knight.gltf"; 60]) }.into()),
    ("missing", "typical", || MissingQuestion { missing: missing_file() }.into()),
    ("missing", "crowded", || {
        MissingQuestion { missing: MissingFile { file: long("a knight"), ..missing_file() } }.into()
    }),
    ("place", "typical", || PlaceQuestion { copy: false, then: None }.into()),
    ("place", "crowded", || PlaceQuestion { copy: true, then: Some(Then::Quit) }.into()),
];

fn exists(path: &str) -> Question {
    ExistsQuestion { path: path.into(), order: SaveOrder::own(None) }.into()
}

fn outdated(title: &str) -> Question {
    let edits = OutdatedEdits { model: "fox".to_owned(), title: title.to_owned(), hash: 7 };
    OutdatedQuestion { edits }.into()
}

fn changed_models(count: u64) -> Question {
    let edits =
        |hash: u64| OutdatedEdits { model: format!("fox-{hash}"), title: format!("Fox {hash}.glb"), hash };
    ChangedModelsQuestion { edits: (1..=count).map(edits).collect() }.into()
}

fn plan(lines: Arc<[String]>, order: Option<SaveOrder>) -> Question {
    PlanQuestion { lines, order }.into()
}

fn long(name: &str) -> String {
    format!(
        "/home/mara/models/animals/{name} with a name that is so long that it hardly fits into a line of text.glb"
    )
}

fn fox() -> Offer {
    offer("Fox.glb", 12, 250, Same, Whole, Exited)
}

fn missing(name: &str) -> Offer {
    offer(name, 12, 250, Missing, Whole, Exited)
}

fn many() -> Vec<Offer> {
    let bear = |number: u64| {
        let name =
            format!("{number} A bear with a rather long name that continues until it has to be cut.gltf");
        let file = if number.is_multiple_of(2) { Same } else { Unsaved };
        offer(&name, 1_000, 5_000 * number + 90, file, Whole, Exited)
    };
    (0..12).map(bear).collect()
}

fn lines(count: usize) -> Arc<[String]> {
    let first = "take \"Survey\", \"b_Head_05\" (node 7), rotation: changed".to_owned();
    let more = (0..count).map(|at| format!("/animations/0/samplers/{at}/output: 21 → 93"));
    std::iter::once(first).chain(more).collect()
}

/// Returns a document with unsaved work and without panels around the question.
fn bench(question: &str, state: &str) -> Workbench {
    let mut bench = match state {
        "crowded" => Fullness::Crowded.bench(),
        _ => Workbench::full(),
    };
    bench.change(Change::Edit(Edit::ReverseTake(ReverseTake { take: TakeRef::Index(0) }), None));
    for panel in dragonfly::panels::all() {
        bench.desk.toggle_panel(panel.id());
    }
    let mut view = bench.state.read().view.cloned().expect("a model");
    // A relative path would be completed with the folder in which the tests run.
    // A glTF file is never written as a whole.
    let ending = if question == "rewrite" { "fbx" } else { "glb" };
    let path = Some(format!("/home/mara/models/Fox.{ending}").into());
    view.file = Arc::new(FileView { path, ending: ending.into(), ..(*view.file).clone() });
    bench.state.show(view);
    bench
}

pub(super) fn cases() -> Vec<PictureCase> {
    let case = |&(name, state, question): &QuestionRow| PictureCase {
        name: format!("questions/{name}-{state}"),
        size: vec2(720.0, 520.0),
        crop: Crop::Above,
        bench: Box::new(move || {
            let mut bench = bench(name, state);
            bench.state.ask(question());
            bench
        }),
        act: Box::new(|_| {}),
        twice: STATES.contains(&state),
    };
    TABLE.iter().map(case).collect()
}

#[test]
fn the_questions_look_as_stored() {
    series::compare(cases());
}

#[test]
fn every_kind_of_question_is_drawn_in_its_usual_state_and_in_a_crowded_one() {
    for (row, state, question) in TABLE {
        let text = format!("{:?}", question()).to_lowercase();
        assert!(text.starts_with(&format!("{row}(")), "the picture {row}-{state} is of another question");
    }
    for kind in Question::KINDS {
        for state in STATES {
            let kind = kind.to_lowercase();
            let drawn = TABLE.iter().any(|(row, other, _)| *row == kind && *other == state);
            assert!(drawn, "{kind} has no {state} picture: add a row to the table in this file");
        }
    }
}
