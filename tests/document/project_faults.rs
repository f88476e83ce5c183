//! Projects on bad disks: a damaged journal, links, rights, files that cannot be written. No answer is lost, and nothing is written to the wrong place.

use super::projects::{END, MAIN, PROJECT, project, replaced_in, text_of};
use super::scenes::replaced;
use dragonfly_document::{Decision, DocumentMessage, DocumentReply, NotSaved, SaveOrder, SaveTo};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns all files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// The speeds that the steps write, one after the other.
const SPEEDS: [&str; 6] = ["1", "1.5", "2", "2.5", "3", "3.5"];

#[test]
fn a_journal_of_several_texts_that_is_cut_anywhere_brings_the_steps_before_the_cut_back() {
    let folder = Folder::new("project-cut");
    let path = project(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    // In turn a step of the script and one of the project.
    for (index, pair) in SPEEDS.windows(2).enumerate() {
        let [old, new] = [pair[0], pair[1]].map(|speed| format!("speed=\"{speed}\""));
        document.edit(replaced_in("main.xml", &MAIN.replace("speed=\"1\"", &old), &old, &new));
        let name = |index: usize| if index == 0 { "Two foxes".to_owned() } else { format!("Foxes {index}") };
        let (old, new) = (name(index), name(index + 1));
        document.edit(replaced(&PROJECT.replace("Two foxes", &old), &old, &new));
    }
    document.wait_for_view(|view| view.history.done == 10);
    copy_after_kill(&autosave, &folder.join("killed"));
    let killed = files(&folder.join("killed"));
    let journal = killed.iter().max_by_key(|file| fs::metadata(file).map_or(0, |data| data.len()));
    let bytes = fs::read(journal.expect("a journal")).expect("a journal");
    let mut brought = Vec::new();
    for part in 1..=8 {
        let cut = folder.join(&format!("cut-{part}"));
        copy_after_kill(&folder.join("killed"), &cut);
        let name = journal.expect("a journal").strip_prefix(folder.join("killed")).expect("inside");
        fs::write(cut.join(name), &bytes[..bytes.len() * part / 8]).expect("a file");
        let mut again = TestDocument::new(&cut);
        again.open(&path);
        again.send(DocumentMessage::Search);
        let offers = again.wait_for_reply(|reply| match reply {
            DocumentReply::Offers(offers) => Some(offers.clone()),
            DocumentReply::NothingToOffer => Some(Vec::new()),
            _ => None,
        });
        let Some(offer) = offers.into_iter().next() else {
            brought.push(0);
            continue;
        };
        again.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
        let view = again.wait_for_view(|view| view.history.done > 0);
        let done = view.history.done;
        let speed = format!("speed=\"{}\"", SPEEDS[done.div_ceil(2)]);
        assert_eq!(text_of(&view, "main.xml"), MAIN.replace("speed=\"1\"", &speed), "{done} steps");
        let name = if done < 2 { "Two foxes".to_owned() } else { format!("Foxes {}", done / 2) };
        assert_eq!(text_of(&view, "foxes.meproj"), PROJECT.replace("Two foxes", &name), "{done} steps");
        assert_eq!(text_of(&view, "end.xml"), END);
        brought.push(done);
    }
    assert!(brought.is_sorted() && brought.last() == Some(&10), "{brought:?}");
}

#[cfg(unix)]
#[test]
fn a_save_of_a_project_keeps_links_and_rights_of_its_texts() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::new("project-links");
    let path = project(&folder);
    fs::create_dir(folder.join("real")).expect("a folder");
    fs::rename(folder.join("main.xml"), folder.join("real/main.xml")).expect("a file");
    symlink("real/main.xml", folder.join("main.xml")).expect("a link");
    for (name, mode) in [("foxes.meproj", 0o640), ("end.xml", 0o600)] {
        fs::set_permissions(folder.join(name), fs::Permissions::from_mode(mode)).expect("rights");
    }
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    document.save(SaveTo::Own);
    assert!(folder.join("main.xml").symlink_metadata().expect("a link").is_symlink());
    let real = fs::read_to_string(folder.join("real/main.xml")).expect("a file");
    assert_eq!(real, MAIN.replace("speed=\"1\"", "speed=\"2\""));
    for (name, mode) in [("foxes.meproj", 0o640), ("end.xml", 0o600)] {
        let rights = fs::metadata(folder.join(name)).expect("a file").permissions().mode();
        assert_eq!(rights & 0o777, mode, "{name}");
    }
    assert!(document.view().history.saved);
}

#[test]
fn a_text_that_cannot_be_written_is_reported_and_the_work_is_offered_after_a_kill() {
    let folder = Folder::new("project-unwritable");
    let path = project(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    // A folder in the place of the file: no one can write it, whatever the rights.
    fs::remove_file(folder.join("end.xml")).expect("a file");
    fs::create_dir(folder.join("end.xml")).expect("a folder");
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, NotSaved::Failed(_) | NotSaved::Changed(_)) => Some(()),
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    });
    copy_after_kill(&autosave, &folder.join("killed"));
    fs::remove_dir(folder.join("end.xml")).expect("a folder");
    fs::write(folder.join("end.xml"), END).expect("a file");
    let mut again = super::projects::restored(&path, &folder.join("killed"));
    let view = again.wait_for_view(|view| view.history.done == 2);
    assert_eq!(text_of(&view, "main.xml"), MAIN.replace("speed=\"1\"", "speed=\"2\""));
    assert_eq!(text_of(&view, "end.xml"), END.replace("The End", "Fin"));
}
