//! The table of ARCHITECTURE.md, compared with what is planted, and the lists, compared with the files that they should name.

use super::list::{PLANTS, Plant};
use crate::tree::{File, files, none, one, root};

/// Rows of the table that are not planted, with the reason.
const NOT_PLANTED: &[(&str, &str)] = &[
    ("message", "the compiler names every match that lacks it"),
    (
        "test, benchmark",
        "tests are planted with the other things, and layout.rs finds a file that is not declared",
    ),
];

/// A row of the table.
struct MapRow {
    thing: String,
    /// All other cells.
    cells: Vec<String>,
}

fn rows(map: &str) -> Vec<MapRow> {
    let section = map.split("\n## ").find(|section| section.starts_with("Where a new thing goes"));
    let lines = section.unwrap_or_default().lines().filter(|line| line.starts_with('|'));
    let cells =
        lines.skip(2).map(|line| line.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()));
    cells
        .map(|mut cells| MapRow { thing: cells.next().unwrap_or_default(), cells: cells.collect() })
        .collect()
}

fn file_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// Compares each row of the table with what its plant needs.
fn wrong_rows(map: &str) -> Vec<String> {
    let rows = rows(map);
    let mut complaints = Vec::new();
    for MapRow { thing, cells } in &rows {
        let Some(plant) = PLANTS.iter().find(|plant| plant.thing == *thing) else {
            if !NOT_PLANTED.iter().any(|(other, _)| other == thing) {
                complaints.push(format!("{thing}: is in the table, but no test plants it"));
            }
            continue;
        };
        let cell = |number: usize| cells.get(number).map_or("", String::as_str);
        let (goes, named, also) = (cell(0), cell(1), cell(2));
        let path = plant.file.map_or(plant.list, |(path, _)| path);
        let folder = &path[..path.len() - file_name(path).len()];
        if !goes.contains(folder) {
            complaints.push(format!("{thing}: it was planted in {folder}, and the table says {goes}"));
        }
        let list = named.split('`').nth(1).unwrap_or_default();
        if plant.file.is_some() && (list.is_empty() || !plant.place[0].contains(list)) {
            complaints.push(format!("{thing}: its list is {}, and the table says {named}", plant.place[0]));
        }
        for (path, ..) in plant.also {
            let end = file_name(path);
            let (folder, name) = (&path[..path.len() - end.len()], end.split('.').next().unwrap_or_default());
            let named = also.contains(name) || also.contains(&format!("`{folder}`"));
            // The table itself is in ARCHITECTURE.md.
            if *path != "ARCHITECTURE.md" && !named {
                complaints.push(format!("{thing}: its row does not mention {path}, where it needs a line"));
            }
        }
    }
    let without = PLANTS.iter().filter(|plant| !rows.iter().any(|row| row.thing == plant.thing));
    complaints.extend(without.map(|plant| format!("{}: is planted, and not in the table", plant.thing)));
    complaints
}

#[test]
fn the_architecture_table_states_exactly_what_each_kind_of_addition_needs() {
    let map = std::fs::read_to_string(root().join("ARCHITECTURE.md")).expect("the map");
    none(wrong_rows(&map));
    assert_eq!(
        wrong_rows(&map.replace("| panel |", "| window |")).len(),
        2,
        "one not planted, one not in the table"
    );
    one(wrong_rows(&map.replace("`editor/src/panels/dialogs/`", "`editor/src/panels/questions/`")));
    one(wrong_rows(&map.replace("| `RULES` |", "| `ALL_RULES` |")));
    one(wrong_rows(&map.replace("`BREAKS` in `tests/anim/check.rs`", "")));
}

/// Returns the lines of the list from its first line to the one that closes it.
fn entries<'a>(text: &'a str, first: &str) -> Vec<&'a str> {
    let mut lines = text.lines().skip_while(|line| !line.contains(first));
    let Some(opens) = lines.next() else { return Vec::new() };
    let margin = opens.len() - opens.trim_start().len();
    let inside = |line: &&str| line.trim().is_empty() || line.len() - line.trim_start().len() > margin;
    lines.take_while(inside).collect()
}

/// Returns the name by which a list contains what `line` of the file at `path` defines.
fn listed_name(plant: &Plant, path: &str, line: &str) -> String {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let at = line.find(plant.mark).unwrap_or_default();
    if plant.mark.ends_with(" for ") {
        return word(&line[at + plant.mark.len()..]);
    }
    if plant.mark.starts_with(':') {
        return line[..at].rsplit(' ').next().unwrap_or_default().to_owned();
    }
    file_name(path).trim_end_matches(".rs").to_owned()
}

/// Returns the files whose definitions are missing in their list.
fn unlisted(files: &[File], plant: &Plant) -> Vec<String> {
    let Some((place, _)) = plant.file.filter(|_| !plant.mark.is_empty()) else { return Vec::new() };
    let source = &place[..place.find("/src/").map_or(0, |at| at + 5)];
    let list = files.iter().find(|file| file.path == plant.list).map_or("", |file| &file.text);
    let entries = entries(list, plant.place[0]);
    let mut complaints = Vec::new();
    for file in files.iter().filter(|file| file.path.starts_with(source) && file.path != plant.list) {
        for line in file.text.lines().filter(|line| !line.contains("//") && line.contains(plant.mark)) {
            let name = listed_name(plant, &file.path, line);
            let is = |word: &str| word == name;
            let contains = |entry: &&str| entry.split(|c: char| !c.is_alphanumeric() && c != '_').any(is);
            if !entries.iter().any(contains) {
                complaints.push(format!("{}: {name} is not in the list of {}", file.path, plant.list));
            }
        }
    }
    complaints
}

#[test]
fn every_list_names_all_files_of_its_kind() {
    let files = files();
    for plant in PLANTS {
        let list = files.iter().find(|file| file.path == plant.list).expect(plant.list);
        let count = entries(&list.text, plant.place[0]).len();
        assert!(count >= 2, "{}: {count} entries after {}", plant.list, plant.place[0]);
        assert!(list.text.contains(plant.place[1]), "{} does not contain {}", plant.list, plant.place[1]);
        none(unlisted(&files, plant));
    }
}

#[test]
fn a_file_that_its_list_does_not_name_is_reported() {
    for plant in PLANTS {
        let Some((path, text)) = plant.file else { continue };
        let list = files().into_iter().find(|file| file.path == plant.list).expect(plant.list);
        one(unlisted(&[list, File::planted(path, text)], plant));
    }
}
