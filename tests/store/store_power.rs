//! Cost of a power cut: a real file system is stopped as if the machine had lost power, mounted again and checked.

use crate::journal_writer::{check_at, document_at, is_writer, start, start_saving};
use dragonfly_kit::power::{cut, once_in_three, times};
use dragonfly_kit::writer::{Found, WriterReport};
use std::path::Path;

#[test]
fn a_power_cut_tears_no_file_and_loses_no_save() {
    if is_writer() {
        return;
    }
    let start = |folder: &Path| {
        let test = "store_power::a_power_cut_tears_no_file_and_loses_no_save";
        start_saving(test, folder)
    };
    let only_saves = |folder: &Path, _: &WriterReport, _: usize| {
        let saved = document_at(&folder.join("fox.glb")).unwrap_or_default();
        Found { edits: 0, saved }
    };
    let cuts = || cut("power-saves", times(40), start, only_saves);
    once_in_three(cuts, "it hardly came to save anything", |all| all.with_saves * 2 > all.cuts);
}

#[test]
fn a_power_cut_costs_at_most_a_second_of_edits() {
    if is_writer() {
        return;
    }
    let start = |folder: &Path| start("store_power::a_power_cut_costs_at_most_a_second_of_edits", folder);
    let cuts = || cut("power-edits", times(38), start, check_at);
    once_in_three(cuts, "edits of more than a second were lost, or there were hardly any", |all| {
        let worked = all.with_saves * 10 > all.cuts && all.edits as usize > all.cuts;
        worked && all.oldest <= 1_000_000_000
    });
}
