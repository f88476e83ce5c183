//! A program that is killed at any moment loses no edit and no save that it reported as done.

use crate::journal::autosave;
use crate::journal_writer::{check, is_writer, start};
use dragonfly_kit::folder::takes_long;
use dragonfly_kit::mounted::quick_folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_store::{JournalError, JournalOwner, RealFiles, replace};
use std::fs;
use std::time::Duration;

#[test]
fn a_program_killed_at_any_instant_loses_no_edit_and_no_save() {
    if is_writer() {
        return;
    }
    let test = "journal_kill::a_program_killed_at_any_instant_loses_no_edit_and_no_save";
    let kills = if takes_long() { 5000 } else { 200 };
    let seed = seed(0x6b69_6c6c);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let folder = quick_folder("killed");
    let sound = autosave(&folder, RealFiles);
    let (mut recovered, mut met) = (0, 0);
    for kill in 0..kills {
        let mut writer = start(test, folder.path());
        // Some kills happen while the program starts, most while it works.
        let patience = if random.below(4) == 0 {
            Duration::from_millis(random.below(40) as u64)
        } else {
            writer.working();
            Duration::from_micros(random.below(20_000) as u64)
        };
        if kill % 20 == 1 {
            writer.working();
            // While the program runs, its document is in use.
            let error = sound.begin(Some(&folder.join("fox.glb")), None).expect_err("it is in use");
            let JournalError::Held { owner, .. } = &error else { panic!("{error}") };
            assert_eq!(*owner, Some(JournalOwner { process: writer.process(), ..JournalOwner::this() }));
            met += 1;
        }
        std::thread::park_timeout(patience);
        let said = writer.kill();
        assert_eq!(said.complaint, None, "kill {kill}");
        let found = check(&folder, &said, kill);
        assert!(found.edits >= said.edits, "kill {kill}: {found:?} {said:?}");
        assert!(found.edits <= said.edits.max(recovered) + 1, "kill {kill}: {found:?} {said:?}");
        assert!(found.saved >= said.saved, "kill {kill}: {found:?} {said:?}");
        assert!(found.edits >= recovered, "kill {kill}: an edit that was recovered before is gone");
        recovered = found.edits;
    }
    println!("{kills} kills, {recovered} edits");
    assert!(recovered > kills as u32, "it was always killed before it did anything");
    assert!(met >= kills / 20);
    replace(&folder.join("fox.glb"), b"the end").unwrap();
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "nothing half written stays: {left:?}");
}
