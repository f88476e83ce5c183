//! A document in a separate process, edited by a script that both processes know. Each action is printed when it is
//! done. The process is killed or has its power cut. It runs the same test of this program again.

use dragonfly_document::edit::{AddKeys, BonePose, BoneRef, Edit, NewKey, ReverseTake, SetPending, TakeRef};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_document::{Change, Decision, DocumentMessage, DocumentReply, SaveTo};
use dragonfly_kit::document::test_document::{TestDocument, fox_at, rename, turn};
use dragonfly_kit::random::Random;
use dragonfly_kit::writer::{Writer, nanoseconds};
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

/// Environment variable with the folder in which the started process works.
const CHILD: &str = "DRAGONFLY_DOCUMENT_CHILD";

/// Environment variable with the number of the first action to perform.
const FIRST: &str = "DRAGONFLY_DOCUMENT_CHILD_FIRST";

/// Time after which the process ends by itself, so that it does not outlive the test.
const LIMIT: Duration = Duration::from_secs(30);

/// An action performed on a document.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DocumentAction {
    Change(Change),
    Save,
}

/// Returns action number `number` of the script: edits, undo, saves, and drags of several edits.
pub(crate) fn action(number: u32) -> DocumentAction {
    // Some groups of five consecutive actions are one drag.
    let gesture = Gesture(u64::from(number / 5));
    if Random::new(u64::from(number / 5)).below(3) == 0 {
        let end = number % 5 == 4;
        return DocumentAction::Change(if end {
            Change::Release(gesture)
        } else {
            Change::Edit(turn(number as f32 * 0.01), Some(gesture))
        });
    }
    let mut random = Random::new(u64::from(number) + 1_000_000);
    let take = || TakeRef::Index(1);
    let bone = || BoneRef::Name("b_Neck_04".to_owned());
    let pose = || BonePose {
        bone: bone(),
        translation: None,
        rotation: Some([0.0, 0.1, 0.0, 1.0]),
        scale: Some([1.0, 1.0, 1.0 + number as f32 * 1e-4]),
    };
    DocumentAction::Change(match random.below(16) {
        0 => Change::Undo,
        1 => Change::Redo,
        2 => Change::GoTo(random.below(8)),
        3 => return DocumentAction::Save,
        4 => Change::Cancel(gesture),
        5 | 6 => Change::Edit(rename(&format!("take {number}")), None),
        7 => {
            let (time, bones, properties) = (0.01 + random.unit() * 0.5, vec![bone()], Vec::new());
            let value = NewKey::default();
            Change::Edit(
                Edit::AddKeys(AddKeys { take: take(), time, bones, properties, value, keyed_only: false }),
                None,
            )
        }
        8 => Change::Edit(
            Edit::SetPending(SetPending { take: take(), time: random.unit() * 0.5, poses: vec![pose()] }),
            None,
        ),
        9 => Change::Edit(Edit::ReverseTake(ReverseTake { take: TakeRef::Index(2) }), None),
        _ => Change::Edit(turn(random.unit() * 3.0), None),
    })
}

/// Applies an action to takes in memory, in the same way as the document thread does.
pub(crate) fn apply_action(edited: &mut Edited, action: &DocumentAction) {
    match action {
        DocumentAction::Save => edited.mark_saved(),
        DocumentAction::Change(Change::Edit(edit, gesture)) => drop(edited.apply(edit.clone(), *gesture)),
        DocumentAction::Change(Change::Release(_)) => {}
        DocumentAction::Change(Change::Cancel(gesture)) => drop(edited.cancel(*gesture)),
        DocumentAction::Change(Change::Undo) => drop(edited.undo()),
        DocumentAction::Change(Change::Redo) => drop(edited.redo()),
        DocumentAction::Change(Change::GoTo(steps)) => drop(edited.go_to(*steps)),
    }
}

/// Edits the document if this process is the one to be killed. Returns whether it was; if so, the calling test must
/// return.
pub(crate) fn is_writer() -> bool {
    let Some(folder) = std::env::var_os(CHILD) else { return false };
    let number = std::env::var(FIRST).ok().and_then(|first| first.parse().ok());
    edit_on(Path::new(&folder), number);
    true
}

fn edit_on(folder: &Path, first: Option<u32>) {
    let mut out = std::io::stdout();
    // Printed with the time at which it was done, because the time of reading is later.
    let mut say = |what: &str| {
        let line = format!("{what} {}\n", nanoseconds(SystemTime::now()));
        out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_ok()
    };
    say("\nstarted");
    let (mut document, names) = recover(folder);
    let mut number = first.unwrap_or(names);
    let began = Instant::now();
    while began.elapsed() < LIMIT {
        // Without a script, the name of the take contains the number of actions.
        let done = if first.is_some() { action(number) } else { named(number + 1) };
        match &done {
            DocumentAction::Save => drop(document.save(SaveTo::Own)),
            DocumentAction::Change(change) => {
                document.change(change.clone());
                // The reply to this message comes after the change was applied and recorded.
                document.send(DocumentMessage::Quit);
                document.wait_for_reply(|reply| {
                    matches!(reply, DocumentReply::Unsaved(_) | DocumentReply::MayQuit).then_some(())
                });
            }
        }
        number += 1;
        if !say(&format!("e {number}")) {
            break;
        }
    }
}

/// Returns an action whose number is the new name of the take.
fn named(number: u32) -> DocumentAction {
    DocumentAction::Change(Change::Edit(rename(&number.to_string()), None))
}

/// Opens the document in `folder` and restores its unsaved work. Also returns the number in the name of its first
/// take.
pub(crate) fn recover(folder: &Path) -> (TestDocument, u32) {
    let mut document = TestDocument::new(&folder.join("autosave"));
    let mut view = document.open(&fox_at(&folder.join("Fox.glb")));
    // Offers are sent before the model is shown.
    if let Some(offer) = document.offers_so_far().into_iter().next() {
        document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
        let generation = view.generation;
        view = document.wait_for_view(|view| view.generation > generation);
    }
    let number = view.takes[0].name.parse().unwrap_or(0);
    (document, number)
}

/// Starts `test`, which calls [`is_writer`] first, with the script from action `first` on.
pub(crate) fn start(test: &str, folder: &Path, first: u32) -> Writer {
    Writer::of(test, &[(CHILD, folder.as_os_str()), (FIRST, first.to_string().as_ref())])
}

/// Starts `test`, which calls [`is_writer`] first, with actions that are numbered by the name of the take.
pub(crate) fn start_counting(test: &str, folder: &Path) -> Writer {
    Writer::of(test, &[(CHILD, folder.as_os_str())])
}
