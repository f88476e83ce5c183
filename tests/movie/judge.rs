//! Other programs that decode movies: ffmpeg and ffprobe.

use dragonfly_kit::skip::{TestNeed, skip};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// Returns whether ffmpeg and ffprobe can run; skips otherwise.
pub(crate) fn ffmpeg() -> bool {
    let runs =
        |program| Command::new(program).arg("-version").output().is_ok_and(|output| output.status.success());
    let runs = ["ffmpeg", "ffprobe"].into_iter().all(runs);
    if !runs {
        skip(TestNeed::Evaluators, "there is no ffmpeg with ffprobe");
    }
    runs
}

/// Runs a program that must have nothing to complain about. Returns its output.
fn run(program: &str, arguments: &[&str], path: &Path) -> Vec<u8> {
    let mut command = Command::new(program);
    command.args(["-v", "warning"]);
    if program == "ffmpeg" {
        command.args(["-nostdin", "-i"]).arg(path).args(arguments);
    } else {
        command.args(arguments).arg(path);
    }
    let output = command.output().unwrap();
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && complaints.is_empty(), "{}: {complaints}", path.display());
    output.stdout
}

/// Returns the properties that ffprobe finds in the stream `stream` (such as `v:0`) of a file; all its frames are decoded.
pub(crate) fn probe(path: &Path, stream: &str) -> BTreeMap<String, String> {
    let arguments = ["-count_frames", "-select_streams", stream, "-show_streams", "-show_format"];
    let text = run("ffprobe", &[&arguments[..], &["-of", "default=noprint_wrappers=1"]].concat(), path);
    let text = String::from_utf8(text).unwrap();
    let mut found = BTreeMap::new();
    for (key, value) in text.lines().filter_map(|line| line.split_once('=')) {
        // Those of the stream are before those of the file.
        found.entry(key.to_owned()).or_insert_with(|| value.to_owned());
    }
    found
}

/// Returns the frames of a movie decoded by ffmpeg, in one of its pixel formats with `bytes` bytes for each frame.
pub(crate) fn decode(path: &Path, format: &str, bytes: usize) -> Vec<Vec<u8>> {
    let all = run("ffmpeg", &["-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", format, "-"], path);
    assert_eq!(all.len() % bytes, 0);
    all.chunks(bytes).map(<[u8]>::to_vec).collect()
}

/// Returns the samples of the sound of a movie decoded by ffmpeg, those of all channels one after the other.
#[cfg(feature = "h264")]
pub(crate) fn samples(path: &Path) -> Vec<i16> {
    let bytes = run("ffmpeg", &["-map", "0:a", "-f", "s16le", "-c:a", "pcm_s16le", "-"], path);
    bytes.as_chunks::<2>().0.iter().map(|sample| i16::from_le_bytes(*sample)).collect()
}

/// Returns what ffmpeg reads of the headers of the pictures, a line each: names and numbers. It also complains there about bits that are wrong.
pub(crate) fn headers(path: &Path) -> String {
    let arguments = ["-c", "copy", "-bsf:v", "trace_headers", "-f", "null", "-"];
    let mut command = Command::new("ffmpeg");
    let output = command.arg("-i").arg(path).args(arguments).output().expect("ffmpeg runs");
    assert!(output.status.success());
    String::from_utf8_lossy(&output.stderr).into_owned()
}
