//! `dragonfly retarget`: the map as text and file, and the takes in the written file.

use crate::program::run;
use dragonfly_kit::folder::{Folder, data};
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

#[test]
fn takes_of_one_figure_are_written_into_the_file_of_another() {
    let folder = Folder::new("retarget");
    let (source, target) = (data("bench/pab.glb"), data("collection/quaternius_Character4skins.glb"));
    let (out, map) = (folder.join("out.glb"), folder.join("map.json"));
    let arguments = ["retarget", text(&source), text(&target), "--take", "walk", "--save-map", text(&map)];
    let printed = run(arguments.into_iter().chain(["-o", text(&out)])).expect(0);
    for words in ["Mixamo to Quaternius", "LeftForeArm", "LowerArm.L", "take walk as walk", "at rest:"] {
        assert!(printed.text().contains(words), "{words} is not in {}", printed.text());
    }
    let info = run(["info", text(&out), "--json"]).expect(0).json().to_string();
    assert!(info.contains("\"walk\"") && info.contains("CharacterArmature|Run"), "{info}");
    // Nothing else of the file has changed.
    run(["diff", text(&target), text(&out)]).expect(1);
    let maps = std::fs::read_to_string(&map).expect("a map");
    assert!(maps.contains("[\"LeftArm\", \"UpperArm.L\"]"), "{maps}");
    // A corrected map is followed.
    let corrected = maps.replace("    [\"Head\", \"Head\"]", "    [\"Horn\", \"Head\"]");
    assert_ne!(corrected, maps);
    std::fs::write(&map, corrected).expect("written");
    let again =
        run(["retarget", text(&source), text(&target), "--take", "walk", "--map", text(&map), "--json"]);
    let report = again.expect(0).json();
    assert_eq!(report["missing"][0], "Horn");
    assert!(report["resting"].as_array().expect("a list").contains(&"Head".into()), "{report}");
}

#[test]
fn a_take_that_is_not_there_and_a_broken_map_are_errors_of_the_input() {
    let folder = Folder::new("retarget-wrong");
    let (source, target) = (data("bench/pab.glb"), data("gltf/Fox.glb"));
    let wrong = run(["retarget", text(&source), text(&target), "--take", "swim"]).expect(2);
    assert!(wrong.stderr.contains("there is no take \"swim\""), "{}", wrong.stderr);
    let map = folder.join("map.json");
    std::fs::write(&map, "{\"bone_map\":1}").expect("written");
    let wrong = run(["retarget", text(&source), text(&target), "--map", text(&map)]).expect(2);
    assert!(wrong.stderr.contains("bones"), "{}", wrong.stderr);
}
