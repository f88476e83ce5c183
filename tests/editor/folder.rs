//! A model reads regular files of its own folder tree and nothing else, whatever it asks for, and never waits.

use crate::program::run;
use dragonfly_document::{Folder, read_file};
use dragonfly_kit::folder::Folder as Scratch;
use std::path::Path;
use std::time::{Duration, Instant};

/// Answers come at once, also about pipes and devices.
const AT_ONCE: Duration = Duration::from_secs(1);

const LIMIT: u64 = 1 << 20;

/// A model's folder, with a secret file outside it.
struct Place {
    scratch: Scratch,
}

impl Place {
    fn new(name: &str) -> Self {
        let scratch = Scratch::new(name);
        let model = scratch.join("model");
        std::fs::create_dir_all(model.join("textures")).expect("folders");
        std::fs::write(model.join("good.bin"), [7; 36]).expect("a file");
        std::fs::write(model.join("textures/good.bin"), [8; 36]).expect("a file");
        std::fs::write(scratch.join("secret.bin"), [9; 36]).expect("a file");
        Self { scratch }
    }

    fn model(&self) -> std::path::PathBuf {
        self.scratch.join("model")
    }

    fn folder(&self) -> Folder {
        Folder::new(&self.model()).expect("the folder is there")
    }
}

#[test]
fn files_in_the_folder_and_below_it_are_read() {
    let place = Place::new("inside");
    let folder = place.folder();
    assert_eq!(folder.read("good.bin", LIMIT).expect("a good file"), [7; 36]);
    assert_eq!(folder.read("textures/good.bin", LIMIT).expect("a good file"), [8; 36]);
    assert_eq!(folder.read("./textures/./good.bin", LIMIT).expect("a good file"), [8; 36]);
    assert_eq!(folder.read("good.bin", 36).expect("just small enough"), [7; 36]);
    let refused = folder.read("good.bin", 35).expect_err("too large").to_string();
    assert!(refused.contains("36 bytes"), "{refused}");
}

#[cfg(unix)]
#[test]
fn a_link_that_stays_inside_is_followed_and_one_that_leads_out_is_not() {
    use std::os::unix::fs::symlink;
    let place = Place::new("links");
    let model = place.model();
    symlink("textures/good.bin", model.join("inside.bin")).expect("a link");
    symlink("../secret.bin", model.join("outside.bin")).expect("a link");
    symlink("..", model.join("up")).expect("a link");
    symlink("loop.bin", model.join("loop.bin")).expect("a link");
    let folder = place.folder();
    assert_eq!(folder.read("inside.bin", LIMIT).expect("inside"), [8; 36]);
    for name in ["outside.bin", "up/secret.bin", "up/model/good.bin.", "loop.bin"] {
        assert!(folder.read(name, LIMIT).is_err(), "{name}");
    }
    // A path that leads out of the folder and in again ends inside, so no file outside is read.
    assert_eq!(folder.read("up/model/good.bin", LIMIT).expect("inside after all"), [7; 36]);
}

#[cfg(unix)]
#[test]
fn a_pipe_a_device_and_a_folder_are_refused_at_once() {
    use std::os::unix::fs::symlink;
    let place = Place::new("special");
    let model = place.model();
    pipe(&model.join("pipe.bin"));
    symlink("/dev/zero", model.join("zero.bin")).expect("a link");
    let socket = std::os::unix::net::UnixListener::bind(model.join("socket.bin"));
    let folder = place.folder();
    for name in ["pipe.bin", "zero.bin", "textures", "socket.bin"] {
        let began = Instant::now();
        assert!(folder.read(name, LIMIT).is_err(), "{name}");
        assert!(read_file(&model.join(name), LIMIT).is_err(), "{name} as the file that the user named");
        assert!(began.elapsed() < AT_ONCE, "{name} took {:?}", began.elapsed());
    }
    drop(socket);
}

/// The expected result for the name of a buffer.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Refused,
    Read,
}

/// Buffer names from hostile files and, as a control group, from honest ones, each with the expected result.
fn names(place: &Place) -> Vec<(String, End)> {
    let outside = place.scratch.join("secret.bin").display().to_string();
    let mut names: Vec<(String, End)> = [
        "../secret.bin",
        "textures/../../secret.bin",
        "..%2fsecret.bin",
        "%2e%2e/secret.bin",
        "%2E%2E%2Fsecret.bin",
        "..\\\\secret.bin",
        "..%5csecret.bin",
        "\\\\\\\\host\\\\share\\\\secret.bin",
        "//host/share/secret.bin",
        "C:/secret.bin",
        "C%3A/secret.bin",
        "http://127.0.0.1:9/secret.bin",
        "good.bin%00.png",
        "pipe.bin",
        "zero.bin",
        "out.bin",
        "up/secret.bin",
        "textures",
        "good.bin.",
        "GOOD.BIN",
        "data:application/octet-stream;base64,AAAA",
        "%ff%fe.bin",
    ]
    .into_iter()
    .map(|name| (name.to_owned(), End::Refused))
    .collect();
    names.push((outside.clone(), End::Refused));
    names.push((format!("file://{outside}"), End::Refused));
    names.push((format!("FILE://{outside}"), End::Refused));
    names.push((format!("{}.bin", "x".repeat(5000)), End::Refused));
    for honest in ["good.bin", "./good.bin", "textures/good.bin", "%67ood.bin"] {
        names.push((honest.to_owned(), End::Read));
    }
    names
}

/// Returns a triangle whose buffer of 36 bytes has this name.
fn model(name: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}}],
"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"{name}"}}]}}"#
    )
}

#[cfg(unix)]
#[test]
fn hostile_names_of_files_are_refused_by_the_program_itself() {
    use std::os::unix::fs::symlink;
    let place = Place::new("hostile");
    let folder = place.model();
    pipe(&folder.join("pipe.bin"));
    symlink("/dev/zero", folder.join("zero.bin")).expect("a link");
    symlink("../secret.bin", folder.join("out.bin")).expect("a link");
    symlink("..", folder.join("up")).expect("a link");
    let names = names(&place);
    assert!(names.iter().filter(|(_, end)| *end == End::Refused).count() >= 24);
    for (name, end) in names {
        let file = folder.join("model.gltf");
        std::fs::write(&file, model(&name)).expect("a file");
        let outcome = run(["info".as_ref(), file.as_os_str()]);
        let shown: String = name.chars().take(60).collect();
        assert!(outcome.took < 10 * AT_ONCE, "{shown} took {:?}", outcome.took);
        match end {
            End::Read => drop(outcome.expect(0)),
            End::Refused => {
                let outcome = outcome.expect(2);
                assert!(outcome.stderr.starts_with("dragonfly: model.gltf: "), "{shown}: {}", outcome.stderr);
                assert_eq!(outcome.stderr.trim_end().lines().count(), 1, "{shown}: {}", outcome.stderr);
                assert!(outcome.stderr.len() < 700, "{shown}: {} bytes of message", outcome.stderr.len());
            }
        }
    }
}

#[test]
fn harmful_names_are_refused_before_any_disk_access() {
    let place = Place::new("names");
    let folder = place.folder();
    for name in [
        "",
        ".",
        "..",
        "/",
        "a//b",
        "../secret.bin",
        "a/../../secret.bin",
        "\0",
        "a\nb",
        "c:x",
        "x\\y",
        "good.bin.",
        "good.bin ",
    ] {
        assert!(folder.read(name, LIMIT).is_err(), "{name:?}");
    }
    let deep = vec!["d"; 100].join("/");
    assert!(folder.read(&deep, LIMIT).is_err());
    assert!(folder.read(&"x".repeat(5000), LIMIT).is_err());
}

/// Creates a named pipe that has no writer.
#[cfg(unix)]
fn pipe(path: &Path) {
    let status = std::process::Command::new("mkfifo").arg(path).status().expect("mkfifo");
    assert!(status.success());
}
