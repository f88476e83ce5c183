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

/// Returns whether the programs of the authors of WebP can run; skips otherwise.
pub(crate) fn webp_programs() -> bool {
    let runs =
        |program| Command::new(program).arg("-version").output().is_ok_and(|output| output.status.success());
    let runs = ["webpinfo", "webpmux", "dwebp"].into_iter().all(runs);
    if !runs {
        skip(TestNeed::Evaluators, "there are no webpinfo, webpmux and dwebp");
    }
    runs
}

/// Runs a program, which must succeed. Returns what it prints.
fn output(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A frame of an animated WebP as the programs of its authors find it.
pub(crate) struct WebpFrame {
    pub(crate) place: [usize; 2],
    pub(crate) size: [usize; 2],
    pub(crate) milliseconds: u32,
    /// Both are `none` and `no` for a frame that replaces its part of the picture before.
    pub(crate) disposal: String,
    pub(crate) blending: String,
    /// Red, green, blue and alpha.
    pub(crate) pixels: Vec<u8>,
}

/// Returns the frames of an animated WebP, which has no errors; `folder` is for files.
pub(crate) fn webp_frames(path: &Path, folder: &Path) -> Vec<WebpFrame> {
    let info = output(Command::new("webpinfo").arg("-diag").arg(path));
    assert!(!info.to_lowercase().contains("error") && !info.contains("Warning"), "{info}");
    let list = output(Command::new("webpmux").arg("-info").arg(path));
    let [one, pixels] = ["one.webp", "pixels.pam"].map(|name| folder.join(name));
    let mut frames = Vec::new();
    for line in list.lines().skip_while(|line| !line.starts_with("No.:")).skip(1) {
        let (number, rest) = line.split_once(':').unwrap_or_else(|| panic!("{list}"));
        // Width, height, alpha, both offsets, duration, disposal and blending.
        let columns: Vec<&str> = rest.split_whitespace().collect();
        let value = |at: usize| columns[at].parse::<usize>().unwrap_or_else(|_| panic!("{list}"));
        let get = ["-get", "frame", number.trim()];
        output(Command::new("webpmux").args(get).arg(path).arg("-o").arg(&one));
        output(Command::new("dwebp").arg("-quiet").arg(&one).args(["-pam", "-o"]).arg(&pixels));
        let pam = std::fs::read(&pixels).unwrap();
        let header = pam.windows(7).position(|end| end == b"ENDHDR\n").unwrap() + 7;
        frames.push(WebpFrame {
            place: [value(3), value(4)],
            size: [value(0), value(1)],
            milliseconds: value(5) as u32,
            disposal: columns[6].to_owned(),
            blending: columns[7].to_owned(),
            pixels: pam[header..].to_vec(),
        });
    }
    frames
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
