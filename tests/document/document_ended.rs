//! A document whose program is killed in any way at any moment loses no edit that was reported as done; after a power
//! cut it loses at most the edits of the last second.

use crate::document_writer::{
    DocumentAction, action, apply_action, is_writer, recover, start, start_counting,
};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::history::{Edited, MAX_STEPS};
use dragonfly_document::{Cancel, Change, HistoryView, Source, View, load_model};
use dragonfly_kit::document::test_document::fox_at;
use dragonfly_kit::folder::{data, takes_long};
use dragonfly_kit::mounted::quick_folder;
use dragonfly_kit::power::{cut, once_in_three, times};
use dragonfly_kit::process::ignores;
use dragonfly_kit::random::{Random, seed};
use dragonfly_kit::writer::{Found, WriterReport};
use rustix::process::{Pid, Signal, kill_process};
use std::path::Path;
use std::time::{Duration, Instant};

/// Returns whether the view shows exactly the state of `edited`.
fn is_shown(edited: &Edited, view: &View) -> bool {
    let slots = edited.adapter().slots();
    let history = HistoryView::of(edited);
    slots.len() == view.slots.len()
        && slots.iter().zip(view.slots.iter()).all(|(one, other)| {
            one.result == other.result && one.original == other.original && one.pending() == other.pending()
        })
        && (history.done, &history.steps, history.saved)
            == (view.history.done, &view.history.steps, view.history.saved)
}

/// Describes action number `number` of the script in a few words.
fn describe_action(number: u32) -> String {
    let what = match action(number) {
        DocumentAction::Change(Change::Edit(edit, gesture)) => format!("{} {gesture:?}", edit.label()),
        other => format!("{other:?}"),
    };
    format!("{number}: {what}")
}

#[test]
fn a_document_killed_by_any_signal_at_any_moment_is_recovered_as_it_was() {
    if is_writer() {
        return;
    }
    let test = "document_ended::a_document_killed_by_any_signal_at_any_moment_is_recovered_as_it_was";
    let kills = if takes_long() { 5000 } else { 200 };
    let seed = seed(0x646f_6373);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let folder = quick_folder("document-killed");
    let path = fox_at(&folder.join("Fox.glb"));
    let loaded = load_model(&Source::File(data("gltf/Fox.glb")), &mut |_| (), &Cancel::default()).unwrap();
    assert!(path.is_file());
    // The document recovered last, and the number of actions that led to it.
    let (mut kept, mut number) = (Edited::new(ModelAdapter::new(&loaded.model.animation)), 0);
    let began = Instant::now();
    let signals = [Signal::KILL, Signal::TERM, Signal::HUP, Signal::INT];
    let signals: Vec<Signal> = signals.into_iter().filter(|signal| !ignores(*signal)).collect();
    let mut in_a_drag = 0;
    for kill in 0..kills {
        let mut writer = start(test, folder.path(), number);
        // Some kills happen while the program starts, most while it works.
        let patience = if random.below(6) == 0 {
            Duration::from_millis(random.below(150) as u64)
        } else {
            writer.working();
            Duration::from_micros(random.below(60_000) as u64)
        };
        std::thread::park_timeout(patience);
        let signal = random.choice(&signals);
        let process = Pid::from_raw(writer.process() as i32).expect("a number");
        kill_process(process, signal).expect("it runs");
        let said = writer.ended();
        let said = said.edits.max(number);
        // Every action that was reported must be recovered; the one in progress may or may not be.
        let mut candidates = Vec::new();
        let mut edited = kept.clone();
        for at in number..said {
            apply_action(&mut edited, &action(at));
        }
        in_a_drag += usize::from(edited.steps().0.back().is_some_and(|step| step.gesture.is_some()));
        candidates.push((said, edited.clone()));
        apply_action(&mut edited, &action(said));
        candidates.push((said + 1, edited));
        let (mut document, _) = recover(folder.path());
        let view = document.view();
        let said_now = document.unread_replies();
        document.end();
        let found = candidates.into_iter().find(|(_, edited)| is_shown(edited, &view));
        let Some((at, edited)) = found else {
            let actions: Vec<String> = (number.saturating_sub(8)..=said).map(describe_action).collect();
            panic!(
                "kill {kill} with {signal:?}, after {number} and up to {said}: {actions:#?}\nthere is {:?}, and was said {said_now:#?}",
                view.history
            );
        };
        (number, kept) = (at, edited);
        // A drag that was in progress at the kill is over.
        kept.end_gesture();
    }
    println!("{kills} kills, {number} actions, {in_a_drag} in the midst of a drag: {:?}", began.elapsed());
    assert!(number as usize > kills, "it was always killed before it did anything");
    assert!(in_a_drag > 0);
}

#[test]
fn a_power_cut_costs_a_document_at_most_a_second_of_edits() {
    if is_writer() {
        return;
    }
    let start = |folder: &Path| {
        start_counting("document_ended::a_power_cut_costs_a_document_at_most_a_second_of_edits", folder)
    };
    let look = |folder: &Path, said: &WriterReport, cut: usize| {
        let (mut document, number) = recover(folder);
        let view = document.view();
        // No step is missing, except that the history drops the oldest above its limit.
        let steps = (number as usize).min(MAX_STEPS);
        assert_eq!(view.history.done, steps, "cut {cut}, said {} edits", said.edits);
        Found { edits: number, saved: 0 }
    };
    let cuts = || cut("power-document", times(12), start, look);
    once_in_three(cuts, "edits of more than a second were lost, or there were hardly any", |all| {
        all.edits as usize > all.cuts && all.oldest <= 1_000_000_000
    });
}
