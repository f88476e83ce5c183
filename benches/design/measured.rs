//! The editors work without the feature, and the counts are those that the README contains in words.

use super::before::{locks, messages, skeleton::Bone};
use super::count::{self, Cost};
use super::{costs, mistakes};
use dragonfly_runtime::Stage;

fn bones() -> Vec<Bone> {
    vec![Bone::new("hip", 0.0), Bone::new("knee", 0.0)]
}

#[test]
fn both_editors_are_complete_without_the_feature() {
    let mut stage = Stage::new();
    let [main, document, graphics] = ["main", "document", "graphics"].map(|name| stage.start(name));
    let panel = messages::open(stage.context(&main), &document, &graphics, bones(), |_| {});
    panel.borrow().drag_angle(1, 0.5);
    panel.borrow().click([0.5, 0.0]);
    assert!(stage.settle(10));
    assert_eq!(panel.borrow().rows(), ["hip 0.00", "knee 0.50"]);

    let (seen, pictures) = std::sync::mpsc::channel();
    let mut editor =
        locks::open(bones(), move |lines| _ = seen.send(lines.len())).expect("threads that start");
    editor.panel.drag_angle(1, 0.5);
    assert_eq!(editor.panel.rows(), ["hip 0.00", "knee 0.50"]);
    assert_eq!(pictures.recv_timeout(std::time::Duration::from_secs(10)), Ok(2));
    editor.panel.click([0.5, 0.0]);
    assert_eq!(editor.panel.selected(), Some(0));
}

#[test]
fn marked_lines_are_counted_and_left_out() {
    let text = "\
use a::B; // feature
struct Bone {
    angle: f32,
    // feature: begin
    /// Color of the line.
    color: u32,
    // feature: end
}

fn draw() {
    lines.extend(line); // feature, before: lines.push(line);
}

impl Panel {
    // feature: begin
    fn choose(&self) {
        self.send();
    }
    // feature: end
}

enum Edit {
    SetColor, // feature
}

#[cfg(test)]
mod tests {
    struct Uncounted; // feature
}
";
    let without = "\
struct Bone {
    angle: f32,
}

fn draw() {
lines.push(line);
}

impl Panel {
}

enum Edit {
}

#[cfg(test)]
mod tests {
}
";
    assert_eq!(count::before(text), without);
    let places = ["f: struct Bone", "f: fn draw()", "f: impl Panel", "f: enum Edit"];
    let expected = Cost {
        base: 10,
        added: 6,
        changed: 1,
        types: 1,
        functions: 1,
        places: places.map(str::to_owned).to_vec(),
        files: 1,
    };
    // The text lives as long as the program, like the sources.
    assert_eq!(count::cost(&[("f", text)]), expected);
}

#[test]
fn the_counts_agree_with_the_sentences_of_the_readme() {
    let costs = costs();
    assert!(costs.messages.added > 4 * costs.locks.added, "messages cost more than four times the lines");
    assert_eq!(
        (costs.locks.types, costs.locks.places.len()),
        (0, 1),
        "with one lock the panel alone is touched"
    );
    assert_eq!(costs.closures.added, costs.locks.added, "closures cost what the lock costs");
    assert_eq!(costs.messages.added - costs.raw.added, 7, "two methods and a `use`: that is the handle");
    assert!(2 * costs.edits.added > costs.messages.added, "most of it is the edit as a value");
    assert_eq!((costs.messages.places.len(), costs.messages.files), (5, 3));
    assert!(costs.messages.base < 2 * costs.locks.base, "the whole editor is not twice as long");
    assert!(costs.same.added > costs.locks.added, "the property itself costs more than the lock's part");
}

#[test]
fn handles_have_the_method_names_of_the_objects() {
    let sources = [include_str!("messages/document.rs"), include_str!("messages/viewport.rs")];
    let handles = include_str!("messages/handles.rs");
    for name in ["set_angle", "set_color", "toggle_visible", "show", "pick"] {
        let method = format!("pub fn {name}(");
        assert!(sources.iter().any(|source| source.contains(&method)), "no object has {name}");
        assert!(handles.contains(&method), "no handle has {name}");
    }
}

#[test]
fn the_mistakes_of_each_design_are_listed_from_its_files() {
    for (way, refused, compiling) in mistakes() {
        println!("{way}: {refused:#?} {compiling:#?}");
        assert_eq!(refused.len(), 6);
        assert!((7..=8).contains(&compiling.len()));
    }
}
