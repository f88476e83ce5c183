//! Projects on disks that fail: at any call of a save, where the disk is full, where the power is cut. The files of a project are each whole,
//! and no confirmed edit is lost.

use super::projects::{END, LINES, MAIN, PROJECT, replaced_in, text_of};
use super::save_and_open::open;
use super::scenes::replaced;
use dragonfly_document::edit::Edit;
use dragonfly_document::history::Edited;
use dragonfly_document::{Decision, DocumentMessage, DocumentReply, NotSaved, SaveOrder, SaveTo, View};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::mounted::{Mounted, may_mount, quick_folder};
use dragonfly_kit::power::{cut, once_in_three, times};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_kit::writer::{Found, Writer, WriterReport, nanoseconds};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

/// The texts of the project, with what they have been edited to.
fn edited_texts() -> [(&'static str, &'static str, String); 3] {
    [
        ("foxes.meproj", PROJECT, PROJECT.replace("Two foxes", "Foxes")),
        ("main.xml", MAIN, MAIN.replace("speed=\"1\"", "speed=\"2\"")),
        ("end.xml", END, END.replace("The End", "Fin")),
    ]
}

fn edits() -> [Edit; 3] {
    [
        replaced(PROJECT, "Two foxes", "Foxes"),
        replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""),
        replaced_in("end.xml", END, "The End", "Fin"),
    ]
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Returns how many of the texts are the edited ones. Each is either that or the old one.
fn written(folder: &Path, place: &str) -> usize {
    let is_new = |(name, old, new): &(&str, &str, String)| {
        let text = fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{place}: {error}"));
        assert!(text == *old || text == *new, "{place}: {name} is torn: {text}");
        text == *new
    };
    edited_texts().iter().filter(|text| is_new(text)).count()
}

#[test]
fn a_failure_of_any_call_in_the_save_of_a_project_leaves_whole_texts_and_the_next_save_completes_it() {
    let all = quick_folder("project-calls");
    let (mut runs, mut partly) = (0, 0);
    for fault in Fault::ALL {
        for number in 1.. {
            let folder = all.join("documents");
            let _ = fs::remove_dir_all(&folder);
            fs::create_dir_all(folder.join("models")).expect("a folder");
            fs::copy(data("gltf/Fox.glb"), folder.join("models/Fox.glb")).expect("a copy");
            for (name, text) in
                [("foxes.meproj", PROJECT), ("main.xml", MAIN), ("end.xml", END), ("foxes.lines.xml", LINES)]
            {
                fs::write(folder.join(name), text).expect("a file");
            }
            let path = folder.join("foxes.meproj");
            let before = names(&folder);
            let mut editable = open(&path);
            let mut edited = Edited::new(editable.adapter());
            edits().into_iter().for_each(|edit| edited.apply(edit, None).expect("it fits"));
            let plan = editable.plan(edited.adapter()).expect("a plan");
            let files = FaultyFiles::once(number, fault);
            let saved = editable.save_through(&files, edited.adapter(), &plan, &path);
            let place = format!("call {number}, {fault:?}: {saved:?}");
            assert_eq!(names(&folder), before, "{place}");
            let new = written(&folder, &place);
            match &saved {
                Ok(_) => assert_eq!(new, 3, "{place}"),
                Err(reason) => {
                    assert!(reason.contains("documents/"), "{place}: the file is named");
                    partly += usize::from((1..3).contains(&new));
                }
            }
            if files.calls() < number {
                assert!(saved.is_ok(), "{place}");
                break;
            }
            runs += 1;
            // The next save writes what is missing, and takes nothing for a change of another program.
            let plan = editable.plan(edited.adapter()).expect("a plan");
            editable
                .save(edited.adapter(), &plan, &path)
                .unwrap_or_else(|reason| panic!("{place}: {reason}"));
            assert_eq!(written(&folder, &place), 3, "{place}");
        }
    }
    println!("{runs} failures, {partly} of them between two texts");
    assert!(runs > 150 && partly > 20, "{runs}, {partly}");
}

#[test]
fn at_every_level_of_free_space_a_project_is_saved_or_stays_unsaved_with_whole_texts() {
    if !may_mount("project-full") {
        return;
    }
    const PAGE: usize = 4096;
    let folder = Folder::new("project-full");
    let mut outcomes = [0, 0];
    for free in 0..64 {
        let Some(disk) = Mounted::in_memory(&folder.join("disk"), 512 * PAGE) else { return };
        fs::create_dir(disk.path().join("models")).expect("a folder");
        fs::copy(data("gltf/Fox.glb"), disk.path().join("models/Fox.glb")).expect("a copy");
        for (name, text) in
            [("foxes.meproj", PROJECT), ("main.xml", MAIN), ("end.xml", END), ("foxes.lines.xml", LINES)]
        {
            fs::write(disk.path().join(name), text).expect("a file");
        }
        let path = disk.path().join("foxes.meproj");
        let autosave = folder.join(&format!("autosave-{free}"));
        let mut document = TestDocument::new(&autosave);
        document.open(&path);
        // Each text becomes larger by ten pages.
        let long = |text: &str| format!("{text}<!--{}-->\n", "x".repeat(10 * PAGE));
        let texts = [("main.xml", MAIN), ("end.xml", END)];
        for (name, text) in texts {
            document.edit(replaced_in(name, text, "</script>\n", &long("</script>\n")));
        }
        document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
        document.wait_for_view(|view| view.history.done == 3);
        let space = rustix::fs::statvfs(disk.path()).expect("a disk");
        let there = usize::try_from(space.f_bavail).expect("a number");
        fs::write(disk.path().join("filler"), vec![0xaa; (there - free) * PAGE]).expect("it fits");
        document.send(DocumentMessage::Save(SaveOrder::own(None)));
        let failed = document.wait_for_reply(|reply| match reply {
            DocumentReply::Saved(_) => Some(None),
            DocumentReply::NotSaved(_, NotSaved::Failed(reason)) => Some(Some(reason.clone())),
            DocumentReply::NotSaved(_, other) => panic!("{other:?}"),
            _ => None,
        });
        for (name, text) in texts {
            let found = fs::read_to_string(disk.path().join(name)).expect("a text");
            let long = text.replace("</script>\n", &long("</script>\n"));
            assert!(found == text || found == long, "{free} pages: {name} is torn");
            assert!(failed.is_some() || found == long, "{free} pages: {name}");
        }
        let main = fs::read_to_string(&path).expect("a text");
        let is_new = main == PROJECT.replace("Two foxes", "Foxes");
        assert!(is_new || (failed.is_some() && main == PROJECT), "{free} pages: {main}");
        let left: Vec<String> = names(disk.path());
        let known = ["end.xml", "filler", "foxes.lines.xml", "foxes.meproj", "main.xml", "models"];
        assert_eq!(left, known, "{free} pages");
        outcomes[usize::from(failed.is_none())] += 1;
        if let Some(reason) = failed {
            assert!(reason.contains("the disk is full"), "{reason}");
            assert!(!document.view().history.saved, "{free} pages: it still counts as unsaved");
            // Once there is room, the same save succeeds.
            fs::remove_file(disk.path().join("filler")).expect("a file");
            document.save(SaveTo::Own);
            assert!(document.view().history.saved);
            assert!(fs::read_to_string(disk.path().join("end.xml")).expect("a text").len() > 10 * PAGE);
        }
        document.end();
    }
    println!("{outcomes:?} saves failed and succeeded");
    assert!(outcomes[0] > 10 && outcomes[1] > 10, "{outcomes:?}");
}

/// Environment variable with the folder in which the started process works.
const CHILD: &str = "DRAGONFLY_PROJECT_CHILD";

/// The texts that are edited in turn, each with a counter.
const COUNTED: [&str; 3] = ["foxes.meproj", "main.xml", "end.xml"];

/// Returns the counter in a text.
fn counter(text: &str) -> u32 {
    let digits = text.split("<!-- ").nth(1).and_then(|rest| rest.split(" -->").next());
    digits.and_then(|digits| digits.parse().ok()).unwrap_or_else(|| panic!("no counter in {text}"))
}

/// Returns the number of edits after which the texts have these counters. They are edited in turn, so that no other counters are possible.
fn count(counters: [u32; 3]) -> u32 {
    let last = counters.into_iter().max().unwrap_or_default();
    for (text, counter) in (0_u32..).zip(counters) {
        let own = (0..=last).rev().find(|number| *number == 0 || number % 3 == text).unwrap_or_default();
        assert_eq!(counter, own, "{counters:?}: an edit is missing in {}", COUNTED[text as usize]);
    }
    last
}

fn counters(view: &View) -> [u32; 3] {
    COUNTED.map(|name| counter(&text_of(view, name)))
}

/// Opens the project in a folder, which is made if it is not there, and restores its unsaved work.
fn recover(folder: &Path) -> (TestDocument, View) {
    let path = made(folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    let mut view = document.open(&path);
    if let Some(offer) = document.offers_so_far().into_iter().next() {
        document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
        let generation = view.generation;
        view = document.wait_for_view(|view| view.generation > generation);
    }
    (document, view)
}

fn made(folder: &Path) -> PathBuf {
    let path = folder.join("foxes.meproj");
    if !path.exists() {
        fs::create_dir_all(folder.join("models")).expect("a folder");
        fs::copy(data("gltf/Fox.glb"), folder.join("models/Fox.glb")).expect("a copy");
        let counted = |text: &str| text.replacen('>', "><!-- 0 -->", 1);
        // A comment after the declaration of the project, and in the scripts.
        let project = PROJECT.replace("?>\n", "?>\n<!-- 0 -->\n");
        for (name, text) in [
            ("main.xml", counted(MAIN)),
            ("end.xml", counted(END)),
            ("foxes.lines.xml", LINES.to_owned()),
            ("foxes.meproj", project),
        ] {
            fs::write(folder.join(name), text).expect("a file");
        }
        rustix::fs::sync();
    }
    path
}

/// Edits the project until the process is ended.
fn edit_on(folder: &Path) {
    let mut out = std::io::stdout();
    let mut say = |what: &str| {
        let line = format!("{what} {}\n", nanoseconds(SystemTime::now()));
        out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_ok()
    };
    say("\nstarted");
    let (mut document, view) = recover(folder);
    let mut texts = COUNTED.map(|name| text_of(&view, name));
    let mut number = count(counters(&view));
    let began = Instant::now();
    while began.elapsed() < dragonfly_kit::writer::LIMIT {
        number += 1;
        let text = &mut texts[(number % 3) as usize];
        let [old, new] = [counter(text), number].map(|number| format!("<!-- {number} -->"));
        let name = COUNTED[(number % 3) as usize];
        document.edit(match name {
            "foxes.meproj" => replaced(text, &old, &new),
            other => replaced_in(other, text, &old, &new),
        });
        *text = text.replacen(&old, &new, 1);
        // The reply comes after the edit was applied and recorded.
        document.send(DocumentMessage::Quit);
        document.wait_for_reply(|reply| {
            matches!(reply, DocumentReply::Unsaved(_) | DocumentReply::MayQuit).then_some(())
        });
        if !say(&format!("e {number}")) {
            break;
        }
        if number.is_multiple_of(11) {
            document.save(SaveTo::Own);
            say(&format!("s {number}"));
        }
    }
}

#[test]
fn a_power_cut_tears_no_text_of_a_project_and_costs_at_most_a_second_of_edits_and_no_save() {
    if let Some(folder) = std::env::var_os(CHILD) {
        return edit_on(Path::new(&folder));
    }
    let start = |folder: &Path| {
        let test = "project_disks::a_power_cut_tears_no_text_of_a_project_and_costs_at_most_a_second_of_edits_and_no_save";
        Writer::of(test, &[(CHILD, folder.as_os_str())])
    };
    let look = |folder: &Path, said: &WriterReport, cut: usize| {
        // Each file is whole, and has at least what the last reported save wrote.
        let on_disk = COUNTED.map(|name| {
            let text =
                fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
            let end = if name == "foxes.meproj" { "</project>\n" } else { "</script>\n" };
            assert!(text.ends_with(end), "cut {cut}: {name} is torn");
            counter(&text)
        });
        let saved = on_disk.into_iter().max().unwrap_or_default();
        for (text, counter) in (0_u32..).zip(on_disk) {
            let least = (0..=said.saved).rev().find(|number| number % 3 == text || *number == 0);
            assert!(
                counter >= least.unwrap_or_default(),
                "cut {cut}: {on_disk:?} after the save of {}",
                said.saved
            );
        }
        let (document, view) = recover(folder);
        let found = Found { edits: count(counters(&view)), saved };
        document.end();
        found
    };
    let cuts = || cut("power-project", times(12), start, look);
    once_in_three(cuts, "edits of more than a second were lost, or there were hardly any", |all| {
        all.edits as usize > all.cuts && all.oldest <= 1_000_000_000
    });
}
