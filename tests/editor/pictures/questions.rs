//! Every question to the user.

use super::series::{self, Crop, PictureCase};
use super::states::Fullness;
use crate::questions::offer;
use crate::workbench::Workbench;
use dragonfly::panels::prompts::Question;
use dragonfly_document::edit::{Edit, ReverseTake, TakeRef};
use dragonfly_document::{Change, Offer, SaveOrder, Source, Then};
use dragonfly_store::DocumentFileState::{Changed, Missing, Same, Unsaved};
use dragonfly_store::FileState;
use dragonfly_store::OwnerStatus::{Exited, OnOtherHost};
use dragonfly_store::Readability::{Cut, Whole};
use egui::vec2;
use std::sync::Arc;

/// The questions: a name and a pattern, then the states in which the question is drawn. The patterns are one `match` over
/// all variants, so a new question does not compile without a row here.
macro_rules! questions {
    ($($name:literal, $pattern:pat => [$($state:literal, $question:expr;)*];)*) => {
        /// Returns the name that the pictures of a question begin with.
        fn name(question: &Question) -> &'static str {
            match question {
                $($pattern => $name,)*
            }
        }

        /// Each question with its name and the name of its state; made when it is drawn, because it contains times.
        const TABLE: &[QuestionRow] = &[$($(($name, $state, || $question),)*)*];
    };
}

/// The name of a question, its state, and a function that returns it.
type QuestionRow = (&'static str, &'static str, fn() -> Question);

/// Every question is about a model or a file, so none has a state `empty`.
const STATES: [&str; 2] = ["typical", "crowded"];

questions! {
    "unsaved", Question::Unsaved(_) => [
        "typical", Question::Unsaved(Then::Quit);
        "crowded", Question::Unsaved(Then::Open(Source::File(long("another file").into())));
    ];
    "changed", Question::Changed(..) => [
        "typical", Question::Changed(FileState::Changed, None);
        "crowded", Question::Changed(FileState::Changed, Some(SaveOrder::own(None)));
        "gone", Question::Changed(FileState::Missing, None);
    ];
    "exists", Question::Exists(..) => [
        "typical", Question::Exists("/home/mara/models/Fox 2.glb".into(), SaveOrder::own(None));
        "crowded", Question::Exists(long("another file").into(), SaveOrder::own(None));
    ];
    "plan", Question::Plan(..) => [
        "typical", Question::Plan(lines(4), Some(SaveOrder::own(None)));
        "crowded", Question::Plan(lines(100_000), None);
        "nothing", Question::Plan(Arc::from(["nothing changes".to_owned()]), Some(SaveOrder::own(None)));
    ];
    "recover", Question::Recover { .. } => [
        "typical", Question::Recover { offers: vec![fox()], lost: false };
        "crowded", Question::Recover { offers: many(), lost: true };
        "warned", Question::Recover {
            offers: vec![offer("Fox.glb", 12, 250, Changed, Cut(17), OnOtherHost)],
            lost: false,
        };
        "missing", Question::Recover { offers: vec![missing("Fox.glb")], lost: false };
    ];
    "find", Question::Find { .. } => [
        "typical", Question::Find { offer: Box::new(missing("Fox.glb")), other: None };
        "crowded", Question::Find {
            offer: Box::new(missing(&long("a bear"))),
            other: Some(long("another file").into()),
        };
    ];
    "where", Question::Where { .. } => [
        "typical", Question::Where { copy: false, then: None };
        "crowded", Question::Where { copy: true, then: Some(Then::Quit) };
    ];
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
fn bench(state: &str) -> Workbench {
    let mut bench = match state {
        "crowded" => Fullness::Crowded.bench(),
        _ => Workbench::full(),
    };
    bench.change(Change::Edit(Edit::ReverseTake(ReverseTake { take: TakeRef::Index(0) }), None));
    for panel in dragonfly::panels::all() {
        bench.desk.toggle_panel(panel.id());
    }
    bench
}

pub(super) fn cases() -> Vec<PictureCase> {
    let case = |&(name, state, question): &QuestionRow| PictureCase {
        name: format!("questions/{name}-{state}"),
        size: vec2(720.0, 520.0),
        crop: Crop::Above,
        bench: Box::new(move || {
            let mut bench = bench(state);
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
fn every_question_is_drawn_in_its_usual_state_and_in_a_crowded_one() {
    for (row, state, question) in TABLE {
        assert_eq!(name(&question()), *row, "the picture of {state} is of another question");
        for state in STATES {
            assert!(
                TABLE.iter().any(|(name, other, _)| name == row && *other == state),
                "{row} has no {state}"
            );
        }
    }
}
