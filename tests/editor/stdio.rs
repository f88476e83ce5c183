//! `dragonfly --stdio`: one request per input line, one answer per output line.

use crate::program::{dragonfly, run, wait};
use dragonfly_kit::folder::{Folder, data};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::time::Duration;

/// A running `dragonfly --stdio` process.
pub(crate) struct StdioSession {
    /// The folder of its journal, if it has one of its own; deleted with it.
    journals: Option<Folder>,
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl StdioSession {
    pub(crate) fn about(file: &Path) -> Self {
        let journals = Folder::new("stdio-journals");
        let mut session = Self::recording(file, journals.path());
        session.journals = Some(journals);
        session
    }

    /// Starts a session with its journal in the folder `journals`.
    pub(crate) fn recording(file: &Path, journals: &Path) -> Self {
        let mut command = dragonfly([Path::new("--stdio"), file, Path::new("--journal"), journals]);
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::inherit());
        let mut child = command.spawn().expect("the program starts");
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().expect("piped"));
        Self { journals: None, child, input, output }
    }

    /// Sends a line without waiting for its answer.
    pub(crate) fn send(&mut self, line: &str) {
        writeln!(self.input.as_mut().expect("open"), "{line}").expect("it listens");
    }

    /// Kills the process.
    pub(crate) fn kill(&mut self) {
        self.child.kill().expect("it runs");
        self.child.wait().expect("it was killed");
    }

    pub(crate) fn say(&mut self, line: &str) -> Value {
        writeln!(self.input.as_mut().expect("open"), "{line}").expect("it listens");
        let mut answer = String::new();
        self.output.read_line(&mut answer).expect("it answers");
        serde_json::from_str(&answer).unwrap_or_else(|error| panic!("{line} -> {answer}: {error}"))
    }

    #[track_caller]
    pub(crate) fn ask(&mut self, request: &Value) -> Value {
        let answer = self.say(&request.to_string());
        assert!(answer.get("error").is_none(), "{request} -> {answer}");
        answer["ok"].clone()
    }

    pub(crate) fn end(mut self) {
        drop(self.input.take());
        assert_eq!(wait(&mut self.child, Duration::from_secs(30)).code(), Some(0));
    }
}

impl Drop for StdioSession {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn fox(folder: &Folder) -> std::path::PathBuf {
    let file = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &file).expect("a file");
    file
}

fn turn(angle: f64) -> Value {
    let half = angle.to_radians() / 2.0;
    json!({"edit": "set", "take": "Run", "time": 0.25,
           "poses": [{"bone": "b_Head_05", "rotation": [0.0, half.sin(), 0.0, half.cos()]}]})
}

fn head() -> Value {
    json!({"query": "pose", "take": "Run", "time": 0.25, "bone": "b_Head_05"})
}

#[test]
fn a_session_edits_reads_undoes_and_saves() {
    let folder = Folder::new("stdio-talk");
    let file = fox(&folder);
    let before = std::fs::read(&file).unwrap();
    let mut talk = StdioSession::about(&file);
    let takes = talk.ask(&json!({"query": "takes"}));
    assert_eq!((takes.as_array().map(Vec::len), &takes[2]["name"]), (Some(3), &json!("Run")));
    let as_read = talk.ask(&head());
    assert_eq!(as_read["original"], as_read["result"]);
    assert_eq!(talk.ask(&turn(30.0)), json!({"steps": 1, "done": 1}));
    let turned = talk.ask(&head());
    assert_eq!(turned["original"], as_read["original"], "the original stays");
    assert!((turned["result"]["rotation"][1].as_f64().unwrap() - 0.258_819).abs() < 1e-6, "{turned}");
    assert_eq!(
        talk.ask(&json!({"query": "history"})),
        json!({"steps": ["Rotate"], "done": 1, "saved": false})
    );
    // A gesture is one undo step; a cancelled gesture leaves no step.
    for angle in [1.0, 2.0, 3.0] {
        talk.ask(&json!({"do": "edit", "gesture": 5, "edit": turn(angle)}));
    }
    assert_eq!(talk.ask(&json!({"do": "cancel", "gesture": 5})), json!({"steps": 1, "done": 1}));
    assert_eq!(talk.ask(&head()), turned);
    talk.ask(&json!({"do": "undo"}));
    assert_eq!(talk.ask(&head()), as_read);
    assert_eq!(talk.ask(&json!({"do": "plan"}))["bytesAppended"], 0);
    talk.ask(&json!({"do": "save"}));
    assert_eq!(std::fs::read(&file).unwrap(), before, "nothing is edited: the same file");
    talk.ask(&json!({"do": "redo"}));
    talk.ask(&json!({"do": "save"}));
    assert_eq!(talk.ask(&json!({"query": "history"}))["saved"], true);
    talk.end();
    let read = run([
        "explain",
        &file.display().to_string(),
        "--take",
        "Run",
        "--time",
        "0.25",
        "--bone",
        "b_Head_05",
        "--json",
    ]);
    let read = read.expect(0).json();
    let bones = read["bones"].as_array().unwrap();
    assert!((bones.last().unwrap()["rotation"]["value"][1].as_f64().unwrap() - 0.258_819).abs() < 1e-6);
}

#[test]
fn keys_pasted_through_stdio_are_saved_exactly() {
    let folder = Folder::new("stdio-keys");
    let file = fox(&folder);
    let mut talk = StdioSession::about(&file);
    let value = [0.1, 0.2, 0.3, 0.927_361_8];
    let keys = json!([{"after": 0.0, "value": value}, {"after": 0.25, "value": [0.0, 0.0, 0.0, 1.0]}]);
    let channel =
        json!({"bone": "b_Head_05", "property": "rotation", "interpolation": "linear", "keys": keys});
    let edit = json!({"edit": "paste_keys", "take": "Run", "time": 0.5, "channels": [channel]});
    assert_eq!(talk.ask(&edit), json!({"steps": 1, "done": 1}));
    let at = |time: f64| json!({"query": "pose", "take": "Run", "time": time, "bone": "b_Head_05"});
    let shown = talk.ask(&at(0.5));
    for (axis, wanted) in value.iter().enumerate() {
        assert!((shown["result"]["rotation"][axis].as_f64().unwrap() - wanted).abs() < 1e-6, "{shown}");
    }
    assert_eq!(talk.ask(&json!({"query": "history"}))["steps"], json!(["Paste keys"]));
    let refused =
        talk.say(&json!({"edit": "paste_keys", "take": "Run", "time": 0.5, "channels": []}).to_string());
    assert!(refused["error"].to_string().contains("no key is given"), "{refused}");
    talk.ask(&json!({"do": "save"}));
    talk.end();
    let mut talk = StdioSession::about(&file);
    assert_eq!(talk.ask(&at(0.5))["original"]["rotation"], shown["result"]["rotation"]);
    talk.end();
}

#[test]
fn stdio_and_the_edit_command_write_the_same_file() {
    let folder = Folder::new("stdio-same");
    let file = fox(&folder);
    let edits = [
        turn(30.0),
        json!({"edit": "add_keys", "take": "Walk", "time": 0.1, "bones": ["b_Neck_04"], "value": "current"}),
        json!({"edit": "split_take", "take": "Survey", "time": 1.0, "name": "Rest of it"}),
        json!({"edit": "retime_take", "take": "Walk", "length": 1.5}),
    ];
    let mut talk = StdioSession::about(&file);
    for edit in &edits {
        talk.ask(edit);
    }
    let told = folder.join("told.glb");
    talk.ask(&json!({"do": "save", "to": told}));
    talk.end();
    let lines = folder.join("edits.jsonl");
    std::fs::write(&lines, edits.map(|edit| edit.to_string() + "\n").concat()).unwrap();
    let done = folder.join("done.glb");
    let path = |path: &Path| path.display().to_string();
    run(["edit", &path(&file), "--edits", &path(&lines), "-o", &path(&done)]).expect(0);
    assert_eq!(std::fs::read(told).unwrap(), std::fs::read(done).unwrap());
}

#[test]
fn saving_again_and_again_keeps_the_file_small_and_correct() {
    let folder = Folder::new("stdio-again");
    let file = fox(&folder);
    let mut talk = StdioSession::about(&file);
    let mut sizes = Vec::new();
    for angle in [10.0, 20.0, 30.0, 40.0] {
        talk.ask(&turn(angle));
        talk.ask(&json!({"do": "save"}));
        sizes.push(std::fs::metadata(&file).unwrap().len());
    }
    assert!(sizes.windows(2).all(|pair| pair[0] == pair[1]), "{sizes:?}");
    // Takes are reordered, and each keeps its own keys.
    talk.ask(&json!({"edit": "move_take", "take": "Run", "to": 0}));
    talk.ask(&json!({"do": "save"}));
    talk.ask(&turn(50.0));
    let changes = talk.ask(&json!({"do": "plan"}));
    assert_eq!(
        (&changes["bytesAppended"], changes["channels"].as_array().map(Vec::len)),
        (&json!(0), Some(1)),
        "{changes}"
    );
    talk.ask(&json!({"do": "save"}));
    talk.end();
    let mut talk = StdioSession::about(&file);
    let takes = talk.ask(&json!({"query": "takes"}));
    let names: Vec<&str> =
        takes.as_array().unwrap().iter().filter_map(|take| take["name"].as_str()).collect();
    assert_eq!(names, ["Run", "Survey", "Walk"]);
    let half = 25_f64.to_radians();
    assert!((talk.ask(&head())["result"]["rotation"][1].as_f64().unwrap() - half.sin()).abs() < 1e-6);
    talk.end();
}

#[test]
fn a_file_changed_by_another_program_is_not_overwritten() {
    let folder = Folder::new("stdio-changed");
    let file = fox(&folder);
    let mut talk = StdioSession::about(&file);
    talk.ask(&turn(30.0));
    std::fs::write(&file, b"somebody else's work").unwrap();
    let answer = talk.say(r#"{"do":"save"}"#);
    assert!(answer["error"].as_str().is_some_and(|reason| reason.contains("Fox.glb")), "{answer}");
    assert_eq!(std::fs::read(&file).unwrap(), b"somebody else's work");
    let beside = folder.join("mine.glb");
    talk.ask(&json!({"do": "save", "to": beside}));
    talk.end();
    assert!(beside.exists());
}

#[test]
fn an_invalid_request_is_answered_and_the_session_continues() {
    let mut talk = StdioSession::about(Path::new("demo:"));
    for (line, word) in [
        ("nonsense", "line 1"),
        ("[]", "object"),
        ("{}", "is needed"),
        (r#"{"edit":"fly"}"#, "fly"),
        (r#"{"do":"dance"}"#, "dance"),
        (r#"{"do":"edit","edit":{"edit":"delete_take","take":0,"twice":1}}"#, "twice"),
        (r#"{"do":"edit","edit":{"edit":"rename_take","take":0,"name":""}}"#, "needs a name"),
        (r#"{"do":"undo"}"#, "no such step"),
        (r#"{"do":"go_to","steps":7}"#, "no such step"),
        (r#"{"do":"save"}"#, "has no file"),
        (r#"{"query":"pose","take":"nobody","time":0,"bone":0}"#, "no take \"nobody\""),
        (r#"{"query":"keys","take":0,"bone":999}"#, "no bone 999"),
        ("\u{0}", "line 1"),
    ] {
        let answer = talk.say(line);
        assert!(answer["error"].as_str().is_some_and(|error| error.contains(word)), "{line} -> {answer}");
    }
    assert_eq!(talk.say(r#"{"query":"history","id":"seven"}"#)["id"], "seven");
    assert_eq!(talk.say(r#"{"do":"undo","id":[8]}"#)["id"], json!([8]));
    talk.end();
}

#[test]
fn a_save_to_a_folder_that_does_not_exist_is_refused_and_makes_no_folder() {
    let folder = Folder::new("stdio-no-folder");
    let file = fox(&folder);
    let mut talk = StdioSession::about(&file);
    talk.ask(&turn(30.0));
    let target = folder.join("missing").join("Fox.glb");
    let answer = talk.say(&json!({"do": "save", "to": target}).to_string());
    let error = answer["error"].as_str().expect("an error");
    assert!(error.contains("its folder does not exist") && error.contains("missing"), "{error}");
    assert!(!folder.join("missing").exists());
    talk.end();
    // The command line refuses it as well, also for a model of several files.
    let simple = dragonfly_kit::folder::data("gltf/SimpleSkin2");
    let model = std::fs::read_dir(&simple).expect("a folder").flatten().map(|entry| entry.path());
    let model = model.into_iter().find(|path| path.extension().is_some_and(|end| end == "gltf"));
    let edits = folder.join("edits.jsonl");
    std::fs::write(&edits, "").expect("a file");
    for model in [Some(file), model].into_iter().flatten() {
        let output = folder.join("missing").join(model.file_name().expect("a name"));
        let arguments = [Path::new("edit"), &model, Path::new("--edits"), &edits, Path::new("-o"), &output];
        let refused = run(arguments).expect(2);
        assert!(refused.stderr.contains("its folder does not exist"), "{}", refused.stderr);
        assert!(!folder.join("missing").exists(), "{}", model.display());
    }
}
