//! The command line: output, exit codes and error messages, for scripts and for users.

use crate::program::{dragonfly, outcome, run};
use dragonfly_kit::folder::{Folder, data};
use serde_json::Value;
use std::io::Read;
use std::process::Stdio;

const FOX: &str = "gltf/Fox.glb";

fn fox() -> String {
    data(FOX).display().to_string()
}

#[test]
fn info_lists_the_contents_of_a_file() {
    let info = run(["info", &fox(), "--json"]).expect(0).json();
    assert_eq!(info["file"], "Fox.glb");
    assert_eq!(info["format"], "glb");
    let takes: Vec<&str> =
        info["takes"].as_array().expect("takes").iter().filter_map(|take| take["name"].as_str()).collect();
    assert_eq!(takes, ["Survey", "Walk", "Run"]);
    assert_eq!(info["takes"][0]["start"], 0.0);
    assert_eq!(info["meshes"][0]["vertices"], 1728);
    assert_eq!(info["meshes"][0]["triangles"], 576);
    assert_eq!(info["meshes"][0]["skin"], 0);
    assert_eq!(info["meshes"][0]["influences"], 4);
    assert_eq!(info["skins"][0]["bones"].as_array().expect("joints").len(), 24);
    let keys: u64 =
        info["takes"].as_array().expect("takes").iter().filter_map(|take| take["keys"].as_u64()).sum();
    assert_eq!(keys, 2646);
    for (index, bone) in info["bones"].as_array().expect("bones").iter().enumerate() {
        assert_eq!(bone["index"], index);
        assert!(bone["node"].is_u64());
        assert!(bone["parent"].is_null() || bone["parent"].as_u64() < Some(index as u64), "{bone}");
    }
    for place in ["/bounds/min/0", "/bounds/max/2", "/bounds/sphere/center/1", "/bounds/sphere/radius"] {
        assert!(info.pointer(place).is_some_and(Value::is_number), "{place}");
    }
    assert!(info["warnings"].is_array());
}

#[test]
fn info_as_text_lists_everything() {
    let outcome = run(["info", &fox()]).expect(0);
    for word in ["Fox.glb", "3 takes", "Survey", "Run", "1728", "25 bones", "b_Hip_01"] {
        assert!(outcome.text().contains(word), "{word} is missing in\n{}", outcome.text());
    }
    assert_eq!(outcome.stderr, "");
    assert!(outcome.text().lines().all(|line| line == line.trim_end()), "blanks at the end of a line");
}

#[test]
fn a_pose_agrees_with_reference_values() {
    let text = std::fs::read(data("expected/gltf__SimpleSkin_embedded.gltf.unitquat.json"))
        .expect("the expected values");
    let expected: Value = serde_json::from_slice(&text).expect("JSON");
    let samples = expected["clips"][0]["samples"].as_array().expect("samples");
    let mut arguments = vec!["pose".to_owned(), data("gltf/SimpleSkin_embedded.gltf").display().to_string()];
    for sample in samples {
        arguments.extend(["--time".to_owned(), sample["t"].to_string()]);
    }
    arguments.extend(["--vertices", "8", "--json"].map(str::to_owned));
    let poses = run(arguments).expect(0).json();
    let mut compared = 0;
    for (pose, sample) in poses["poses"].as_array().expect("poses").iter().zip(samples) {
        for bone in pose["bones"].as_array().expect("bones") {
            compared += agree(&bone["to_root"], &sample["world"][bone["node"].to_string()]);
        }
        for skin in pose["skins"].as_array().expect("skins") {
            let index = skin["index"].as_u64().expect("an index") as usize;
            compared += agree(&skin["final"], &sample["skin"][index]);
        }
        for mesh in pose["meshes"].as_array().expect("meshes") {
            let key = format!("{}/{}", mesh["node"], mesh["primitive"]);
            compared += agree(&mesh["positions"], &sample["verts"][key]);
        }
    }
    assert!(compared > 400, "only {compared} numbers were compared");
}

/// Compares the numbers of two nested JSON arrays. Returns the number of values compared.
#[track_caller]
fn agree(ours: &Value, theirs: &Value) -> usize {
    match (ours, theirs) {
        (Value::Array(ours), Value::Array(theirs)) => {
            assert_eq!(ours.len(), theirs.len());
            ours.iter().zip(theirs).map(|(ours, theirs)| agree(ours, theirs)).sum()
        }
        (Value::Number(ours), Value::Number(theirs)) => {
            let (ours, theirs) = (ours.as_f64().expect("a number"), theirs.as_f64().expect("a number"));
            assert!((ours - theirs).abs() <= 1e-5 + 1e-4 * theirs.abs(), "{ours} is not {theirs}");
            1
        }
        _ => panic!("{ours} is not of the kind of {theirs}"),
    }
}

#[test]
fn numbers_in_json_read_back_exactly() {
    let outcome = run(["pose", "demo:", "--time", "0.1", "--json"]).expect(0);
    let text = outcome.text();
    let mut numbers = 0;
    for word in text.split([',', '[', ']', ':', '{', '}']).filter(|word| word.contains('.')) {
        let Ok(single) = word.parse::<f32>() else { continue };
        // The text is the shortest that parses to this number, also for readers that parse in double precision.
        assert_eq!(serde_json::to_string(&single).expect("a number"), word);
        assert_eq!(word.parse::<f64>().expect("a number") as f32, single);
        numbers += 1;
    }
    assert!(numbers > 10_000, "only {numbers} numbers");
    assert!(!text.contains("NaN") && !text.contains("null,\"to_root\":null"));
}

#[test]
fn a_take_is_found_by_name_or_number_and_a_name_wins() {
    for (wanted, found) in [("Walk", 1), ("2", 2), ("0", 0)] {
        let pose = run(["pose", &fox(), "--take", wanted, "--time", "0", "--vertices", "0", "--json"])
            .expect(0)
            .json();
        assert_eq!(pose["take"]["index"], found, "{wanted}");
    }
    let first = run(["pose", &fox(), "--time", "0", "--vertices", "0", "--json"]).expect(0).json();
    assert_eq!(first["take"]["name"], "Survey");
    let unknown = run(["pose", &fox(), "--take", "Swim", "--time", "0"]).expect(2);
    assert!(unknown.stderr.contains("Swim") && unknown.stderr.contains("Survey"), "{}", unknown.stderr);
    // Three takes that are called by each other's numbers.
    let folder = Folder::new("takes");
    let text = std::fs::read_to_string(data("gltf/SimpleSkin_embedded.gltf")).expect("a model");
    let mut model: Value = serde_json::from_str(&text).expect("JSON");
    let animation = model["animations"][0].clone();
    for name in ["1", "0"] {
        let mut copy = animation.clone();
        copy["name"] = name.into();
        model["animations"].as_array_mut().expect("animations").push(copy);
    }
    model["animations"].as_array_mut().expect("animations").remove(0);
    let file = folder.join("named.gltf");
    std::fs::write(&file, model.to_string()).expect("a file");
    let file = file.display().to_string();
    let pose = run(["pose", &file, "--take", "0", "--time", "0", "--json"]).expect(0).json();
    assert_eq!(pose["take"]["index"], 1, "the take that is called 0 is number 1");
}

#[test]
fn times_outside_a_take_are_clamped_to_it() {
    let pose = |time: &str| {
        run(["pose", &fox(), "--take", "Run", "--time", time, "--vertices", "4", "--json"]).expect(0).json()
    };
    let (before, first, last, after) = (pose("-5"), pose("0"), pose("1000"), pose("1e30"));
    assert_eq!(before["poses"], first["poses"]);
    assert_eq!(last["poses"], after["poses"]);
    assert_ne!(first["poses"], last["poses"]);
}

#[test]
fn wrong_input_exits_with_2_and_names_file_position_and_reason() {
    let folder = Folder::new("wrong");
    let cut = folder.join("cut.glb");
    let bytes = std::fs::read(data(FOX)).expect("a model");
    std::fs::write(&cut, &bytes[..1000]).expect("a file");
    let text = folder.join("notes.txt");
    std::fs::write(&text, "no model").expect("a file");
    for (file, word) in [
        (folder.join("missing.glb"), "does not exist"),
        (folder.path().to_path_buf(), "folder"),
        (cut, "cut.glb"),
        (text, "notes.txt"),
    ] {
        for command in [vec!["info"], vec!["pose", "--time", "0"]] {
            let mut arguments: Vec<String> = command.iter().map(|&word| word.to_owned()).collect();
            arguments.push(file.display().to_string());
            let outcome = run(arguments).expect(2);
            assert!(outcome.stderr.starts_with("dragonfly: "), "{}", outcome.stderr);
            assert!(outcome.stderr.contains(word), "{word}: {}", outcome.stderr);
            assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
            assert!(outcome.stdout.is_empty());
        }
    }
}

#[test]
fn wrong_arguments_exit_with_2_and_are_named() {
    for (arguments, word) in [
        (vec!["pose", "demo:"], "--time"),
        (vec!["pose", "demo:", "--time", "nan"], "finite"),
        (vec!["pose", "demo:", "--time", "soon"], "is no time"),
        (vec!["render", "demo:"], "--output"),
        (vec!["render", "demo:", "--size", "0x5", "-o", "x.png"], "1 to"),
        (vec!["render", "demo:", "--size", "large", "-o", "x.png"], "1280x720"),
        (vec!["render", "demo:", "--background", "blue", "-o", "x.png"], "RRGGBB"),
        (vec!["render", "demo:", "--samples", "0", "-o", "x.png"], "1..=1024"),
        (vec!["render", "demo:", "--shutter", "400", "-o", "x.png"], "0 to 360"),
        (vec!["info"], "FILE"),
        (vec!["info", "demo:", "--colour"], "--colour"),
    ] {
        let outcome = run(&arguments).expect(2);
        assert!(outcome.stderr.contains(word), "{arguments:?}: {}", outcome.stderr);
    }
}

#[test]
fn the_built_in_model_can_be_written_and_read_again() {
    let folder = Folder::new("demo");
    let file = folder.join("dragonfly.glb");
    run(["demo".as_ref(), "-o".as_ref(), file.as_os_str()]).expect(0);
    let (written, built_in) =
        (run(["info".as_ref(), file.as_os_str(), "--json".as_ref()]), run(["info", "demo:", "--json"]));
    let (written, built_in) = (written.expect(0).json(), built_in.expect(0).json());
    assert_eq!(written["bones"], built_in["bones"]);
    assert_eq!(written["takes"], built_in["takes"]);
    assert_eq!(built_in["warnings"].as_array().map(Vec::len), Some(0), "{}", built_in["warnings"]);
    // A second run overwrites the file and leaves no other file in the folder.
    run(["demo".as_ref(), "-o".as_ref(), file.as_os_str()]).expect(0);
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
    let impossible = folder.join("no/such/folder.glb");
    let outcome = run(["demo".as_ref(), "-o".as_ref(), impossible.as_os_str()]).expect(2);
    assert!(outcome.stderr.contains("folder.glb: cannot be written"), "{}", outcome.stderr);
}

#[test]
fn a_reader_that_closes_the_pipe_early_causes_no_error() {
    let mut child = dragonfly(["pose", "demo:", "--time", "0", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // As `head` does: a little is read, then the pipe is closed.
    let mut some = [0; 10];
    let mut stdout = child.stdout.take().expect("piped");
    stdout.read_exact(&mut some).expect("there is output");
    drop(stdout);
    let output = child.wait_with_output().expect("our own child");
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_standard_output_is_reported() {
    let full =
        std::fs::OpenOptions::new().write(true).open("/dev/full").expect("the device that is always full");
    let mut child = dragonfly(["info", "demo:", "--json"])
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stderr = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut stderr).expect("text");
    assert_eq!(child.wait().expect("our own child").code(), Some(3));
    assert!(stderr.contains("standard output"), "{stderr}");
}

#[test]
fn the_table_of_commands_lists_every_command_with_its_keys() {
    let table = run(["--commands"]).expect(0);
    let lines: Vec<&str> = table.text().lines().collect();
    assert_eq!(lines.len(), dragonfly::panels::commands::all().count() + 1);
    for (command, line) in dragonfly::panels::commands::all().zip(&lines[1..]) {
        assert!(line.contains(command.id.name()) && line.contains(command.title), "{line}");
        let keys = command.shortcuts.first().map(dragonfly::panels::commands::text);
        assert!(keys.is_none_or(|keys| line.contains(&keys)), "{line}");
    }
    assert!(run(["--help"]).expect(0).text().contains("--commands"));
}

#[test]
fn help_lists_every_command_and_how_to_start() {
    let help = run(["--help"]).expect(0);
    for word in ["info", "check", "diff", "pose", "render", "demo", "Examples", "demo:", "Exit codes"] {
        assert!(help.text().contains(word), "{word} is missing in\n{}", help.text());
    }
    for switch in ["--lose-device", "--never-pause", "--fail", "--fail-at", "--edits"] {
        run([switch, "1"]).expect(2);
    }
    for command in ["info", "check", "diff", "pose", "render", "demo"] {
        let help = run([command, "--help"]).expect(0);
        assert!(help.text().contains("Example"), "{command} has no example");
    }
    assert!(run(["--version"]).expect(0).text().starts_with("dragonfly "));
}

#[test]
fn an_image_is_rendered_without_a_window() {
    let folder = Folder::new("render");
    let file = folder.join("fly.png");
    let arguments = [
        "render",
        "demo:",
        "--take",
        "cruise",
        "--time",
        "0.4",
        "--size",
        "320x200",
        "--background",
        "00000000",
        "-o",
    ];
    run(arguments.iter().map(std::ffi::OsStr::new).chain([file.as_os_str()])).expect(0);
    let picture = image::open(&file).expect("a PNG file").into_rgba8();
    assert_eq!(picture.dimensions(), (320, 200));
    let solid = picture.pixels().filter(|pixel| pixel.0[3] > 128).count();
    assert!((1000..50_000).contains(&solid), "{solid} pixels of {} show the model", 320 * 200);
    // The same question has the same answer, also on standard output.
    let again = run(arguments.iter().copied().chain(["-"])).expect(0);
    assert_eq!(std::fs::read(&file).expect("the file"), again.stdout);
}

#[test]
fn without_a_display_the_editor_renders_an_image_and_prints_its_path() {
    let folder = Folder::new("display");
    let mut names = Vec::new();
    for _ in 0..2 {
        let outcome = outcome(dragonfly::<&str>([]).current_dir(folder.path())).expect(0);
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("no display"), "{}", outcome.stderr);
        names.push(outcome.text().lines().next().expect("a name").to_owned());
        assert!(outcome.text().contains("dragonfly render --help"), "{}", outcome.text());
        let picture = image::open(folder.join(&names[names.len() - 1])).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (1280, 720));
    }
    assert_eq!(names, ["dragonfly.png", "dragonfly.png"], "the same picture needs no second file");
    // An existing file of the user is not overwritten.
    std::fs::write(folder.join("dragonfly.png"), "mine").expect("a file");
    let other = outcome(dragonfly::<&str>([]).current_dir(folder.path())).expect(0);
    assert!(other.text().starts_with("dragonfly-2.png"), "{}", other.text());
    assert_eq!(std::fs::read(folder.join("dragonfly.png")).expect("still there"), b"mine");
}
