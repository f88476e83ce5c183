//! Movies that other programs render or encode: farms by job files, and ffmpeg.

use crate::movie_fixture::MovieScene;
use crate::program::{Outcome, outcome};
use serde_json::json;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Writes a program of the shell into the folder `bin` of a scene.
#[cfg(unix)]
fn program(scene: &MovieScene, name: &str, script: &str) {
    use std::os::unix::fs::PermissionsExt;
    fs::create_dir_all(scene.path("bin")).expect("a folder");
    let path = scene.path(&format!("bin/{name}"));
    fs::write(&path, script).expect("a file");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("an own file");
}

/// Runs a command in the folder of a scene, where the programs of its folder `bin` and ours are found.
#[track_caller]
fn run_there(scene: &MovieScene, program: &str, arguments: &[&str]) -> Outcome {
    let own = Path::new(env!("CARGO_BIN_EXE_dragonfly")).parent().expect("a folder");
    let others = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{}:{others}", scene.path("bin").display(), own.display());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(scene.folder()).env("PATH", path);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    outcome(&mut command)
}

/// Runs the tasks of an array job one after the other, as a cluster does on many machines.
#[cfg(unix)]
const SBATCH: &str = r#"#!/bin/sh
first=0; last=0
for word in "$@"; do
    case $word in
        --array=*) range=${word#--array=}; first=${range%-*}; last=${range#*-};;
        --dependency=afterok:17) ;;
        --dependency=*) echo "depends on nothing: $word" >&2; exit 1;;
    esac
done
script=$(cat)
task=$first
while [ "$task" -le "$last" ]; do
    SLURM_ARRAY_TASK_ID=$task sh -c "$script" >&2 || exit 1
    task=$((task + 1))
done
echo 17
"#;

#[cfg(unix)]
#[test]
fn the_tasks_of_a_cluster_render_the_movie_of_one_machine() {
    let scene = MovieScene::new("movie-slurm", 60);
    program(&scene, "sbatch", SBATCH);
    scene.run("movie scene.xml --frames 40-59 -o one.mp4").expect(0);
    let order = "movie scene.xml --frames 40-59 --job slurm --chunk 48 --movie film.mp4 -o job.sh";
    let written = scene.run(order).expect(0);
    assert!(written.stderr.contains("wrote job.sh (2 parts of film.mp4)"), "{}", written.stderr);
    run_there(&scene, "sh", &["job.sh"]).expect(0);
    assert!(scene.read("film.mp4") == scene.read("one.mp4"));
    assert!(scene.path("film-parts/0.mp4").exists() && scene.path("film-parts/48.mp4").exists());
}

#[test]
fn a_job_has_a_task_for_each_part_and_one_that_joins_them() {
    let scene = MovieScene::new("movie-openjd", 240);
    let job = scene.run("movie scene.xml --job openjd --chunk 96 --yaw 10 -o -").expect(0).json();
    let steps = &job["steps"];
    assert_eq!(steps[0]["parameterSpace"]["taskParameterDefinitions"][0]["range"], "0-192:96");
    let render = &steps[0]["script"]["actions"]["onRun"];
    let part = "{{Task.Param.Part}}";
    let wanted = json!([
        "movie",
        "scene.xml",
        "--yaw",
        "10",
        "--resume",
        "--frames",
        format!("{part}+96"),
        "-o",
        format!("scene-parts/{part}.mp4")
    ]);
    assert_eq!((&render["command"], &render["args"]), (&json!("dragonfly"), &wanted));
    assert_eq!(steps[1]["dependencies"], json!([{"dependsOn": steps[0]["name"]}]));
    let join = &steps[1]["script"]["actions"]["onRun"]["args"];
    assert_eq!(join, &json!(["movie", "scene.xml", "--join", "scene-parts", "-o", "scene.mp4"]));
    // Frames in files of their own need no join.
    let order = "movie scene.xml --job openjd --frames 0-99 --movie f/it.####.png -o job.yaml";
    scene.run(order).expect(0);
    let job: serde_json::Value = serde_json::from_slice(&scene.read("job.yaml")).expect("JSON");
    assert_eq!(job["steps"].as_array().map(Vec::len), Some(1));
    let args = &job["steps"][0]["script"]["actions"]["onRun"]["args"];
    let frames = format!("{part}+48");
    let wanted = json!([
        "movie",
        "scene.xml",
        "--frames",
        "0-99x1",
        "--resume",
        "--frames",
        frames,
        "-o",
        "f/it.####.png"
    ]);
    assert_eq!(args, &wanted);
    for engine in ["opencue", "flamenco"] {
        let job = scene.run(&format!("movie scene.xml --job {engine} -o -")).expect(0);
        assert!(job.text().contains("scene-parts") && job.text().contains("--join"), "{}", job.text());
    }
}

#[cfg(unix)]
#[test]
fn ffmpeg_gets_every_frame_and_its_failures_are_shown() {
    let scene = MovieScene::new("movie-ffmpeg", 3);
    let order = |arguments: &str| {
        let own = env!("CARGO_BIN_EXE_dragonfly");
        run_there(&scene, own, &["movie", "scene.xml", "--external-ffmpeg", arguments, "--output=-out.mkv"])
    };
    // It notes its arguments and keeps what it is given.
    program(
        &scene,
        "ffmpeg",
        "#!/bin/sh\nfor word in \"$@\"; do echo \"$word\"; case $word in file:*) cat < \"${word#file:}\" > given.f32; esac; done > words.txt\n\
         cat > given.y4m\n",
    );
    order("-c:v libx264 -vf 'scale=2 * iw'; $(touch bad)").expect(0);
    scene.run("movie scene.xml -o wanted.y4m").expect(0);
    assert!(scene.read("given.y4m") == scene.read("wanted.y4m"));
    let words = String::from_utf8(scene.read("words.txt")).expect("text");
    let words: Vec<&str> = words.lines().skip_while(|word| *word != "-f").collect();
    let (of_sound, words): (Vec<&str>, Vec<&str>) =
        words.into_iter().partition(|word| word.starts_with("file:"));
    assert!(of_sound.len() == 1 && of_sound[0].starts_with("file:-out.mkv.sound-"), "{of_sound:?}");
    let wanted = [
        "-f",
        "yuv4mpegpipe",
        "-i",
        "-",
        "-f",
        "f32le",
        "-ar",
        "48000",
        "-ac",
        "2",
        "-i",
        "-c:v",
        "libx264",
        "-vf",
        "scale=2 * iw;",
        "$(touch",
        "bad)",
        "./-out.mkv",
    ];
    assert_eq!(words, wanted);
    assert!(!scene.path("bad").exists());
    // An eighth of a second in two channels, silent for a tenth of a second.
    let given = scene.read("given.f32");
    let samples: Vec<f32> = given.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    assert_eq!((samples.len(), given.len()), (2 * 48_000 / 8, 4 * 2 * 48_000 / 8));
    let (silent, heard) = samples.split_at(2 * 4_800);
    assert!(silent.iter().all(|sample| *sample == 0.0) && heard.iter().any(|sample| sample.abs() > 1e-3));
    let is_kept = |name: &String| name.contains(".sound-");
    assert_eq!(scene.names().into_iter().find(is_kept), None, "the file of samples is removed");
    // It fails at once: the reason is that of ffmpeg, and not the closed pipe.
    program(&scene, "ffmpeg", "#!/bin/sh\necho 'Unknown encoder nothing' >&2\nexit 8\n");
    let failed = order("-c:v nothing").expect(2);
    let said = failed.stderr.lines().collect::<Vec<_>>();
    assert!(said.contains(&"dragonfly: ffmpeg: Unknown encoder nothing"), "{}", failed.stderr);
    assert!(
        failed.stderr.contains("--external-ffmpeg: ffmpeg failed (exit status: 8): Unknown encoder nothing")
    );
    let unquoted = order("-vf 'scale").expect(2);
    assert!(unquoted.stderr.contains("--external-ffmpeg: a quote ' has no end"), "{}", unquoted.stderr);
}

#[test]
fn a_missing_ffmpeg_is_a_failure_that_says_what_to_install() {
    let scene = MovieScene::new("movie-no-ffmpeg", 3);
    let mut command =
        crate::program::dragonfly("movie scene.xml -o x.mkv --external-ffmpeg".split_whitespace());
    let missing = outcome(command.arg("-c:v x").current_dir(scene.folder()).env("PATH", "")).expect(3);
    assert!(missing.stderr.contains("there is no ffmpeg in the path; install it"), "{}", missing.stderr);
    let refused = scene.run("movie scene.xml -o - --external-ffmpeg x").expect(2);
    assert!(refused.stderr.contains("-o -: ffmpeg needs the name of a file"), "{}", refused.stderr);
}
