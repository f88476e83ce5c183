//! Texts of the user interface that name formats, menus, keys and files.

use crate::panels::{Bench, harness_of};
use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::scene_sounds::forwarding;
use crate::workbench::Workbench;
use dragonfly::app::scene_maker::make_demo;
use dragonfly::panels::FileChoice;
use dragonfly::panels::commands::{self, Id};
use dragonfly::panels::dialogs::RewriteQuestion;
use dragonfly_document::{FileView, SaveOrder, View, formats};
use dragonfly_kit::document::fixture;
use dragonfly_kit::folder::Folder;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;
use std::time::Duration;

#[test]
fn the_question_before_a_file_is_replaced_names_the_format_of_the_file() {
    for ending in ["fbx", "bvh"] {
        let view = fixture::full();
        let file = FileView { ending: ending.into(), ..FileView::clone(&view.file) };
        let mut bench = Bench::new(Some(View { file: Arc::new(file), ..view }));
        bench.state.ask(RewriteQuestion { order: SaveOrder::own(None) }.into());
        let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
        harness.run_steps(4);
        let title = formats().by_extension(ending).expect("a format").title;
        let sentence = format!("Edits cannot be put into a file of {title}:");
        assert!(harness.query_by_label_contains(&sentence).is_some(), "{sentence}");
        assert!(harness.query_by_label("Write whole file").is_some());
    }
}

#[test]
fn hints_name_the_menu_in_which_scenes_and_projects_are_made() {
    let mut found = 0;
    for panel in dragonfly::panels::all() {
        let draw =
            move |ui: &mut egui::Ui, (panel, bench): &mut (Box<dyn dragonfly::panels::Panel>, Workbench)| {
                panel.show(ui, &bench.state.read(), &mut Vec::new());
            };
        let mut harness = Harness::new_ui_state(draw, (panel, Workbench::new(None)));
        harness.run_steps(2);
        found +=
            harness.query_all_by_label_contains("\"New scene of two roles\" in the menu File > New").count();
    }
    assert_eq!(found, 3, "the list of things, the timeline and the script");
    let mut window = scene(FOXES).window();
    run(&mut window, Id::ToolLine);
    let read = window.state().state.read();
    let said = read.status.last().map(|message| message.text.clone()).unwrap_or_default();
    assert!(said.contains("\"New project from this scene\" in the menu File > New"), "{said}");
}

#[test]
fn the_dialogs_for_a_new_scene_say_what_is_chosen_and_what_is_written() {
    for (choice, chosen, written) in [
        (FileChoice::NewScene, "choose the model", "A project with the scene is written next to it"),
        (FileChoice::DemoScene, "choose a folder", "Two figures and a scene with them are written there"),
    ] {
        let title = choice.title();
        assert!(title.starts_with("New scene: ") && title.contains(chosen), "{title}");
        assert!(title.contains(written), "{title}");
    }
}

#[test]
fn the_help_of_the_pose_line_names_the_command_whose_keys_begin_it_whatever_they_are() {
    let help = commands::get(Id::PoseLine).help;
    let title = commands::get(Id::ToolLine).title;
    assert!(help.contains(&format!("the keys of \"{title}\"")) && !help.contains(" D "), "{help}");
}

#[test]
fn a_demo_scene_that_is_not_made_says_so_and_why() {
    let folder = Folder::new("demo-scene");
    // A folder where the model would be.
    std::fs::create_dir_all(folder.join("figures/rogue.gltf")).expect("a folder");
    let (_thread, address, answers) = forwarding();
    make_demo(folder.join("."), &address).expect("a job");
    let answer = answers.recv_timeout(Duration::from_secs(30)).expect("an answer");
    let reason = answer.expect_err("no scene");
    assert!(
        reason.starts_with("No scene was made: Cannot read ") && reason.contains("rogue.gltf"),
        "{reason}"
    );
}
