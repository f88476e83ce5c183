//! `dragonfly convert`: single files and whole folders, in parts, again, and with broken files among them.

use crate::program::run;
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::skip::{TestNeed, skip};
#[cfg(unix)]
use dragonfly_kit::slurm::SlurmCluster;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// Returns a folder with models in two levels, and the paths of the models in it.
fn collection(name: &str) -> (Folder, Vec<&'static str>) {
    let folder = Folder::new(name);
    let files = ["Fox.glb", "AnimatedMorphCube.glb", "SimpleSkin_embedded.gltf", "box_sparse.glb"];
    fs::create_dir_all(folder.join("in/deep")).expect("a folder");
    for (index, file) in files.iter().enumerate() {
        let place = if index % 2 == 0 { format!("in/{file}") } else { format!("in/deep/{file}") };
        fs::copy(data(&format!("gltf/{file}")), folder.join(&place)).expect("a copy");
    }
    (folder, vec!["Fox.dfm", "SimpleSkin_embedded.dfm", "deep/AnimatedMorphCube.dfm", "deep/box_sparse.dfm"])
}

fn files_below(folder: &Path) -> BTreeSet<String> {
    let (mut found, mut folders) = (BTreeSet::new(), vec![folder.to_path_buf()]);
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).into_iter().flatten() {
            let path: PathBuf = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.insert(text(path.strip_prefix(folder).expect("below")).to_owned());
            }
        }
    }
    found
}

#[test]
fn a_file_converted_to_another_format_and_back_has_the_same_takes() {
    let folder = Folder::new("convert-one");
    let (dfm, glb) = (folder.join("Fox.dfm"), folder.join("Back.glb"));
    let fox = data("gltf/Fox.glb");
    let printed = run(["convert", text(&fox), "-o", text(&dfm)]).expect(0);
    assert!(printed.text().contains("glb: 1 unit = 1 m (format), Y up (format)"), "{}", printed.text());
    run(["convert", text(&dfm), "-o", text(&glb)]).expect(0);
    run(["diff", text(&fox), text(&glb), "--tolerance", "0.001"]).expect(0);
    let info = run(["info", text(&glb), "--json"]).expect(0).json();
    assert_eq!(info["meshes"][0]["vertices"], 1728);
    assert_eq!(info["takes"].as_array().map(Vec::len), Some(3));
}

#[test]
fn bones_get_the_names_of_a_map() {
    let folder = Folder::new("convert-map");
    let (glb, map) = (folder.join("Named.glb"), folder.join("names.json"));
    let fox = data("gltf/Fox.glb");
    let pairs = r#"["b_Hip_01","pelvis"],["b_Head_05","b_Neck_04"],["b_Neck_04","b_Head_05"],["Ear","ear"]"#;
    fs::write(&map, format!(r#"{{"bone_map":1,"bones":[{pairs}]}}"#)).expect("written");
    let convert = || run(["convert", text(&fox), "-o", text(&glb), "--map", text(&map), "--json"]);
    let report = convert().expect(0).text().to_owned();
    assert!(report.contains("the map names \\\"Ear\\\", which is no bone of it"), "{report}");
    let bones = |file: &Path| -> Vec<String> {
        let info = run(["info", text(file), "--json"]).expect(0).json();
        let rows = info["bones"].as_array().cloned().unwrap_or_default();
        rows.iter().map(|row| row["name"].as_str().unwrap_or_default().to_owned()).collect()
    };
    let renamed = |name: String| match &*name {
        "b_Hip_01" => "pelvis".to_owned(),
        "b_Head_05" => "b_Neck_04".to_owned(),
        "b_Neck_04" => "b_Head_05".to_owned(),
        _ => name,
    };
    let wanted: BTreeSet<String> = bones(&fox).into_iter().map(renamed).collect();
    assert!(wanted.len() > 20);
    assert_eq!(bones(&glb).into_iter().collect::<BTreeSet<_>>(), wanted);
    // A name for two bones would make their keys go to one of them.
    fs::write(&map, r#"{"bone_map":1,"bones":[["b_Hip_01","b_Head_05"]]}"#).expect("written");
    let refused = convert().expect(2).text().to_owned();
    assert!(refused.contains("the map gives two bones the name"), "{refused}");
    fs::write(&map, "[]").expect("written");
    assert!(convert().expect(2).stderr.contains("names.json"), "the file of the map is named");
}

#[test]
fn a_folder_is_converted_with_its_folders_and_a_broken_file_stops_no_other() {
    let (folder, outputs) = collection("convert-folder");
    fs::write(folder.join("in/deep/broken.glb"), b"glTF, but cut").expect("a file");
    let (input, output) = (folder.join("in"), folder.join("out"));
    let done = run(["convert", text(&input), "-o", text(&output), "--to", "dfm", "--json"]).expect(2);
    assert!(done.stderr.contains("broken.glb"), "{}", done.stderr);
    assert!(done.stderr.contains("4 converted, 0 skipped, 1 failed"), "{}", done.stderr);
    let report = done.json();
    assert_eq!((&report["converted"], &report["failed"]), (&4.into(), &1.into()));
    assert_eq!(files_below(&output), outputs.into_iter().map(str::to_owned).collect());
    run(["diff", text(&input.join("Fox.glb")), text(&output.join("Fox.dfm")), "--tolerance", "0.001"])
        .expect(0);
}

#[test]
fn parts_convert_each_file_once_and_a_second_run_skips_what_is_there() {
    let (folder, outputs) = collection("convert-parts");
    let (input, output) = (folder.join("in"), folder.join("out"));
    let mut found = BTreeSet::new();
    for part in 1..=3 {
        let part = format!("{part}/3");
        let target = folder.join(&format!("out-{}", part.replace('/', "-of-")));
        run(["convert", text(&input), "-o", text(&target), "--to", "dfm", "--shard", &part]).expect(0);
        for file in files_below(&target) {
            assert!(found.insert(file.clone()), "{file} is in two parts");
        }
    }
    assert_eq!(found, outputs.into_iter().map(str::to_owned).collect());
    let again = |jobs: &str| {
        let arguments =
            ["convert", text(&input), "-o", text(&output), "--to", "dfm", "--resume", "--jobs", jobs];
        run(arguments).expect(0).stderr
    };
    assert!(again("3").contains("4 converted, 0 skipped"));
    fs::remove_file(output.join("deep/box_sparse.dfm")).expect("an output");
    assert!(again("1").contains("1 converted, 3 skipped"));
}

#[test]
fn a_dry_run_lists_what_would_be_lost_and_writes_nothing() {
    let folder = Folder::new("convert-dry");
    let output = folder.join("Fox.glb");
    run(["convert", text(&data("gltf/Fox.glb")), "-o", text(&output), "--dry-run"]).expect(0);
    assert!(!output.exists());
}

#[test]
fn orders_that_cannot_be_right_are_errors_of_the_input_and_write_nothing() {
    let folder = Folder::new("convert-wrong");
    let fox = data("gltf/Fox.glb");
    let wrong = run(["convert", text(&fox), "-o", text(&folder.join("Fox.png"))]).expect(2);
    assert!(wrong.stderr.contains("cannot be written; use .fbx, .dfm, .glb, .gltf"), "{}", wrong.stderr);
    let cube = data("gltf/AnimatedMorphCube.glb");
    let two = ["convert", text(&fox), text(&cube), "-o", text(folder.path())];
    assert!(run(two).expect(2).stderr.contains("--to EXT must tell the format"));
    let twice = ["convert", text(&fox), text(&fox), "-o", text(folder.path()), "--to", "dfm"];
    assert!(run(twice).expect(2).stderr.contains("both are converted to"));
    for part in ["0/3", "4/3", "3", "a/b"] {
        run(["convert", text(&fox), "-o", text(folder.path()), "--to", "dfm", "--shard", part]).expect(2);
    }
    run(["convert", text(&fox), "-o", text(folder.path()), "--to", "dfm", "--scale", "-1"]).expect(2);
    assert_eq!(files_below(folder.path()), BTreeSet::new());
}

/// Runs a command of another program in `folder`, with our program in its path. `None` where the other one is not there.
fn other(program: &str, arguments: &[&str], folder: &Path) -> Option<std::process::Output> {
    let mut command = std::process::Command::new(program);
    command.args(arguments).current_dir(folder).env("PATH", path_with_program()).output().ok()
}

/// Returns the value of `PATH` with which our program is found.
fn path_with_program() -> String {
    let own = Path::new(env!("CARGO_BIN_EXE_dragonfly")).parent().expect("a folder");
    format!("{}:{}", own.display(), std::env::var("PATH").unwrap_or_default())
}

#[test]
fn the_parts_of_an_array_job_convert_each_file_once() {
    let (folder, outputs) = collection("convert-slurm");
    let order = ["convert", "in", "-o", "out", "--to", "dfm", "--job", "slurm", "--parts", "3"];
    fs::write(folder.join("job.sh"), run(order).expect(0).text()).expect("a file");
    // As a cluster does: the same script, with other numbers.
    for part in 1..=3 {
        let line = format!("SLURM_ARRAY_TASK_ID={part} exec sh job.sh");
        let done = other("sh", &["-c", &line], folder.path()).expect("a shell");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    }
    assert_eq!(files_below(&folder.join("out")), outputs.into_iter().map(str::to_owned).collect());
}

#[cfg(unix)]
#[test]
fn a_cluster_of_slurm_runs_the_parts_of_an_array_job_and_later_only_what_is_missing() {
    let Some(cluster) = SlurmCluster::start() else { return };
    let (folder, outputs) = collection("convert-cluster");
    let outputs: BTreeSet<String> = outputs.into_iter().map(str::to_owned).collect();
    let order = ["convert", "in", "-o", "out", "--to", "dfm", "--job", "slurm", "--parts", "3"];
    fs::write(folder.join("job.sh"), run(order).expect(0).text()).expect("a file");
    let submit = || {
        let mut command = cluster.command("sbatch");
        command.args(["--wait", "--output=log-%a.txt", "job.sh"]).current_dir(folder.path());
        let done = command.env("PATH", path_with_program()).output().expect("sbatch");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        assert_eq!(files_below(&folder.join("out")), outputs);
        let log = |part: u32| fs::read_to_string(folder.join(&format!("log-{part}.txt"))).expect("a log");
        [1, 2, 3].map(log).join("")
    };
    // A line for each file that is written.
    assert_eq!(submit().matches(" bytes)\n").count(), outputs.len());
    fs::remove_file(folder.join("out/Fox.dfm")).expect("an output");
    let again = submit();
    assert_eq!(again.matches(" bytes)\n").count(), 1, "{again}");
    assert!(again.contains("Fox.glb → out/Fox.dfm ("), "{again}");
}

#[test]
fn an_open_job_description_runs_in_its_reference_program() {
    let (folder, outputs) = collection("convert-openjd");
    let (input, output) = (folder.join("in"), folder.join("out"));
    let order =
        ["convert", text(&input), "-o", text(&output), "--to", "dfm", "--job", "openjd", "--parts", "2"];
    let job = run(order).expect(0).json();
    assert_eq!(job["specificationVersion"], "jobtemplate-2023-09");
    fs::write(folder.join("job.json"), job.to_string()).expect("a file");
    let Some(done) = other("openjd", &["run", "job.json"], folder.path()) else {
        return skip(TestNeed::Farm, "the command openjd is not installed");
    };
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout));
    assert_eq!(files_below(&output), outputs.into_iter().map(str::to_owned).collect());
}

#[test]
fn a_take_is_written_as_a_sequence_of_files_of_a_format_without_animation() {
    let folder = Folder::new("convert-sequence");
    let (fox, output) = (data("gltf/Fox.glb"), folder.join("Fox.obj"));
    let listed = run(["convert", text(&fox), "-o", text(&output), "--bake", "12", "--dry-run"]).expect(0);
    assert!(listed.text().contains("beside it: Fox_0041.obj"), "{}", listed.text());
    assert!(!output.exists());
    run(["convert", text(&fox), "-o", text(&output), "--bake", "12"]).expect(0);
    // The first take has 3.417 seconds: 41 frames after the one at its start.
    let is_frame = |name: &String| name.starts_with("Fox_0") && name.ends_with(".obj");
    assert_eq!(files_below(folder.path()).iter().filter(|name| is_frame(name)).count(), 42);
    let read = |name: &str| fs::read_to_string(folder.join(name)).expect("a file");
    assert_eq!(read("Fox_0000.obj"), read("Fox.obj"));
    assert_ne!(read("Fox_0001.obj"), read("Fox.obj"));
    assert!(read("Fox_0041.obj").contains("mtllib Fox.mtl"));
}

#[test]
fn curves_are_written_as_tables_and_takes_are_baked_at_a_rate() {
    let folder = Folder::new("convert-curves");
    let (csv, json) = (folder.join("Fox.csv"), folder.join("Fox.JSON"));
    let fox = data("gltf/Fox.glb");
    let printed = run(["convert", text(&fox), "-o", text(&csv)]).expect(0);
    assert!(printed.text().contains("only curves are stored"), "{}", printed.text());
    run(["convert", text(&fox), "-o", text(&json)]).expect(0);
    let info = run(["info", text(&fox), "--json"]).expect(0).json();
    let table = fs::read_to_string(&csv).expect("a table");
    let takes: BTreeSet<&str> = table.lines().skip(1).filter_map(|row| row.split(',').next()).collect();
    assert_eq!(takes, BTreeSet::from(["Run", "Survey", "Walk"]));
    let tree: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&json).expect("a tree")).expect("JSON");
    assert_eq!(tree["takes"].as_array().map(Vec::len), info["takes"].as_array().map(Vec::len));
    // A table is no model.
    let refused = run(["info", text(&csv)]).expect(2);
    assert!(refused.stderr.contains("has no known format"), "{}", refused.stderr);

    let [bvh, glb] = ["Fox.bvh", "Fox.glb"].map(|name| folder.join(name));
    for output in [&bvh, &glb] {
        run(["convert", text(&fox), "-o", text(output), "--bake", "48"]).expect(0);
    }
    let motion = fs::read_to_string(&bvh).expect("a motion");
    assert!(
        motion.contains("Frame Time: 0.02083333"),
        "{}",
        &motion[motion.find("Frame Time").unwrap_or(0)..][..30]
    );
    // Two takes have their keys at 24 frames a second; the keys of the third are between frames, which cut its corners.
    let difference = run(["diff", text(&fox), text(&glb), "--tolerance", "0.5"]).expect(1);
    let takes: Vec<&str> = difference.text().lines().filter(|line| line.starts_with("take ")).collect();
    assert!(takes.len() == 1 && takes[0].starts_with("take Run"), "{takes:?}");
    let refused = run(["convert", text(&fox), "-o", text(&glb), "--bake", "0"]).expect(2);
    assert!(refused.stderr.contains("greater than zero"), "{}", refused.stderr);
}
