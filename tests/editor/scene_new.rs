//! New scenes and projects: they list their models with the hashes of their files, have no errors, and no file is overwritten.

use crate::program::run;
use crate::scene_sounds::forwarding;
use dragonfly::app::scene_maker::{SceneAnswer, make, make_demo, make_project};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_kit::folder::{Folder, data};
use dragonfly_runtime::Address;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Returns what a job has made.
fn made(begin: impl FnOnce(&Address<SceneAnswer>) -> std::io::Result<()>) -> PathBuf {
    let (_thread, address, answers) = forwarding();
    begin(&address).expect("a job");
    let answer = answers.recv_timeout(Duration::from_secs(60)).expect("an answer");
    answer.unwrap_or_else(|reason| panic!("{reason}"))
}

/// Checks a project, and returns id, file and hash of its models.
fn models(project: &Path) -> Vec<(String, String, String)> {
    run(["check", project.to_str().expect("UTF-8")]).expect(0);
    let text = fs::read_to_string(project).expect("a project");
    let read = StageProject::read(text).expect("a project");
    let value = |element: &dragonfly_anim::stage::script::ScriptElement, name: &str| {
        element.value(name).unwrap_or_default().to_owned()
    };
    let models = read.elements_called("model");
    models.map(|model| (value(model, "id"), value(model, "src"), value(model, "hash"))).collect()
}

fn hash(path: &Path) -> String {
    format!("{:016x}", dragonfly_store::hash(&fs::read(path).expect("a file")))
}

#[test]
fn a_new_scene_is_a_project_of_two_different_models_with_their_hashes() {
    let folder = Folder::new("new-demo");
    let path = made(|address| make_demo(folder.join(""), address));
    assert_eq!(path.file_name().and_then(|name| name.to_str()), Some("scene.meproj"));
    let listed = models(&path);
    let names: Vec<[&str; 2]> = listed.iter().map(|(id, file, _)| [id.as_str(), file.as_str()]).collect();
    assert_eq!(names, [["rogue", "figures/rogue.gltf"], ["rival", "figures/rival.gltf"]]);
    for (_, file, kept) in &listed {
        assert_eq!(*kept, hash(&folder.join(file)));
    }
    let script = fs::read_to_string(folder.join("scene.xml")).expect("a script");
    assert!(script.contains("model=\"rogue\"") && script.contains("model=\"rival\""), "{script}");
    // Again: another project in the folder, with the same figures; one that was changed is not overwritten.
    let second = made(|address| make_demo(folder.join(""), address));
    assert_eq!(second.file_name().and_then(|name| name.to_str()), Some("scene-2.meproj"));
    assert_eq!(models(&second), listed);
    fs::write(folder.join("figures/rogue.png"), "mine").expect("a file");
    let third = made(|address| make_demo(folder.join(""), address));
    assert!(models(&third).iter().all(|(_, file, _)| file.starts_with("figures-2/")));
    assert_eq!(fs::read_to_string(folder.join("figures/rogue.png")).expect("a file"), "mine");
}

#[test]
fn a_new_scene_with_a_model_lists_it_once_and_both_roles_play_it() {
    let folder = Folder::new("new-model");
    let model = folder.join("The Fox.glb");
    fs::copy(data("gltf/Fox.glb"), &model).expect("a copy");
    fs::write(folder.join("scene.lines.xml"), "mine").expect("a file");
    let path = made(|address| make(model.clone(), address));
    assert_eq!(
        path.file_name().and_then(|name| name.to_str()),
        Some("scene-2.meproj"),
        "no file is overwritten"
    );
    assert_eq!(models(&path), [("the_fox".to_owned(), "The Fox.glb".to_owned(), hash(&model))]);
    let script = fs::read_to_string(folder.join("scene-2.xml")).expect("a script");
    assert_eq!(script.matches("model=\"the_fox\"").count(), 2);
    assert!(script.contains("look=\"ben.b_Head_05\""), "the close shot shows a face: {script}");
}

#[test]
fn a_project_of_a_scene_lists_the_models_that_the_scene_names() {
    let folder = Folder::new("new-project");
    for name in ["a.glb", "b.glb"] {
        fs::copy(data("gltf/Fox.glb"), folder.join(name)).expect("a copy");
    }
    let role = |id: &str, model: &str| format!("<role id=\"{id}\" model=\"{model}\" scale=\"0.01\"/>");
    let roles = [role("ann", "a.glb"), role("ben", "b.glb"), role("cat", "a.glb")].concat();
    let text = format!("<script version=\"1\">\n  <cast>{roles}</cast>\n  <wait dur=\"1\"/>\n</script>\n");
    let script = folder.join("foxes.xml");
    fs::write(&script, &text).expect("a file");
    let path = made(|address| make_project(script.clone(), address));
    let fox = hash(&folder.join("a.glb"));
    let row = |id: &str, file: &str| (id.to_owned(), file.to_owned(), fox.clone());
    assert_eq!(models(&path), [row("a", "a.glb"), row("b", "b.glb")]);
    assert_eq!(fs::read_to_string(&script).expect("a script"), text, "the script is as it was");
}
