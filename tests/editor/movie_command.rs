//! `dragonfly movie`: the files of every format, progress, resuming, and orders that cannot be right.

use crate::movie_fixture::{MovieScene, SIZE, contains, progress_lines};
use crate::program::{dragonfly, outcome, run, wait};
use dragonfly_kit::folder::{data, takes_long};
use dragonfly_kit::random::{Random, seed};
use dragonfly_movie::part_frames;
use dragonfly_store::RealFiles;
use image::AnimationDecoder;
use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::webp::WebPDecoder;
use std::fs;
use std::io::{BufRead, BufReader, Cursor};
use std::process::Stdio;
use std::time::Duration;

const LIMIT: Duration = Duration::from_secs(60);

/// Returns the sizes of the frames of an animation.
fn sizes<'a>(decoder: impl AnimationDecoder<'a>) -> Vec<(u32, u32)> {
    let frames = decoder.into_frames().collect_frames().expect("frames");
    frames.iter().map(|frame| frame.buffer().dimensions()).collect()
}

#[test]
fn images_that_move_have_each_frame_of_the_scene() {
    let scene = MovieScene::new("movie-images", 5);
    for format in ["gif", "apng", "webp"] {
        let file = format!("out.{format}");
        let written = scene.run(&format!("movie scene.xml -o {file}")).expect(0);
        assert!(written.stderr.contains(&format!("wrote {file} (5 frames)")), "{}", written.stderr);
        assert!(written.stderr.contains("only an MP4 has sound"), "{}", written.stderr);
        let bytes = Cursor::new(scene.read(&file));
        let found = match format {
            "gif" => sizes(GifDecoder::new(bytes).expect("a GIF")),
            "apng" => {
                let decoder = PngDecoder::new(bytes).expect("a PNG");
                sizes(decoder.apng().expect("an animated PNG"))
            }
            _ => sizes(WebPDecoder::new(bytes).expect("a WebP")),
        };
        assert_eq!(found, [(SIZE[0], SIZE[1]); 5], "{format}");
    }
    assert_eq!(scene.names(), ["out.apng", "out.gif", "out.webp"]);
}

#[test]
fn files_of_frames_are_the_images_that_render_makes() {
    let scene = MovieScene::new("movie-frames", 9);
    scene.run("movie scene.xml --frames 5-8 -o frames/f.##.png").expect(0);
    scene.run("render scene.xml --frames 5..8 -o image.png").expect(0);
    let pixels = |name: &str| image::open(scene.path(name)).expect("an image").into_rgba8();
    for number in 5..9 {
        let (frame, image) =
            (pixels(&format!("frames/f.0{number}.png")), pixels(&format!("image-000{number}.png")));
        assert_eq!(frame.dimensions(), (SIZE[0], SIZE[1]));
        assert!(frame == image, "frame {number}");
    }
    // The camera of the second shot, from frame 7 on.
    assert!(pixels("frames/f.06.png") != pixels("frames/f.07.png"));
    scene.run("movie scene.xml --shot close --frames 7-8 -o shot.exr").expect(0);
    let exr = scene.read("shot.0008.exr");
    assert!(exr.starts_with(b"\x76\x2f\x31\x01") && !scene.path("shot.0009.exr").exists());
    let refused = scene.run("movie scene.xml --shot 0 --frames 7-8 -o shot.exr").expect(2);
    assert!(refused.stderr.contains("there is no frame 7; there are frames 0 to 6"), "{}", refused.stderr);
}

#[test]
fn a_stream_has_every_pixel_of_every_frame_and_an_mp4_the_sound_too() {
    let scene = MovieScene::new("movie-stream", 4);
    let stream = scene.run("movie scene.xml -o - --fps 12").expect(0);
    let header = stream.stdout.iter().position(|&byte| byte == b'\n').expect("a line") + 1;
    assert!(stream.stdout.starts_with(b"YUV4MPEG2 W64 H36 F12:1 "));
    // Four frames at 24 per second are two at 12.
    assert_eq!(stream.stdout.len() - header, 2 * (6 + 64 * 36 * 3 / 2));
    let written = scene.run("movie scene.xml -o out/deep/it.mp4 --size 63x35").expect(0);
    assert!(
        written.stderr.contains("63 × 35 pixels became 64 × 36: MP4 has even sizes"),
        "{}",
        written.stderr
    );
    let movie = scene.read("out/deep/it.mp4");
    assert!(contains(&movie, b"avc1") && contains(&movie, b"fLaC"));
    // A part has no sound: it is added when parts are joined.
    scene.run("movie scene.xml --frames 0+48 -o part.mp4").expect(0);
    assert!(!contains(&scene.read("part.mp4"), b"fLaC"));
    assert_eq!(part_frames(&RealFiles, &scene.path("part.mp4")).expect("a part"), 0..4);
    assert_eq!(scene.names(), ["out", "part.mp4"]);
}

#[test]
fn a_take_is_shown_from_its_first_to_its_last_frame_by_a_camera_that_stands_still() {
    let model = data("gltf/Fox.glb");
    let scene = MovieScene::new("movie-take", 1);
    let order = ["movie".as_ref(), model.as_os_str()].into_iter().chain(
        ["--take", "Run", "--size", "64x36", "-o", "f.png", "--background", "000000"].map(AsRef::as_ref),
    );
    outcome(dragonfly(order).current_dir(scene.folder())).expect(0);
    // 1.16 seconds at 24 frames per second.
    let info = run(["info".as_ref(), model.as_os_str(), "--json".as_ref()]).expect(0).json();
    let takes = info["takes"].as_array().expect("takes").clone();
    let end =
        takes.iter().find(|take| take["name"] == "Run").expect("a take")["end"].as_f64().expect("a time");
    assert_eq!(scene.names().len(), (end * 24.0 + 0.02) as usize + 1);
    // All frames show the same fox in the same view: a similar number of pixels, and none at the edge.
    let black = |pixel: &image::Rgba<u8>| pixel.0[..3].iter().all(|value| *value < 8);
    for name in scene.names() {
        let frame = image::open(scene.path(&name)).expect("an image").into_rgba8();
        let solid = frame.pixels().filter(|pixel| !black(pixel)).count();
        let edge = frame.enumerate_pixels().filter(|(x, y, _)| *x == 0 || *y == 0 || *x == 63 || *y == 35);
        assert!((60..1200).contains(&solid), "{name}: {solid} pixels");
        assert!(edge.map(|(_, _, pixel)| pixel).all(black), "{name}");
    }
    fs::copy(data("obj/cube_with_vertexcolors.obj"), scene.path("cube.obj")).expect("a copy");
    let still = scene.run("movie cube.obj -o x.mp4").expect(2);
    assert!(still.stderr.contains("cube.obj: it has no takes"), "{}", still.stderr);
}

#[test]
fn a_take_fills_the_image_as_far_as_it_moves() {
    let scene = MovieScene::new("movie-near", 1);
    scene
        .run("movie demo: --take hover --frames 0-47x4 --size 64x36 --background 000000 -o f.##.png")
        .expect(0);
    let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
    for name in scene.names() {
        let frame = image::open(scene.path(&name)).expect("an image").into_rgba8();
        let is_drawn = |pixel: &image::Rgba<u8>| pixel.0[..3].iter().any(|value| *value > 10);
        for (x, y, _) in frame.enumerate_pixels().filter(|(_, _, pixel)| is_drawn(pixel)) {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
    }
    let [width, height] = [0, 1].map(|axis| f64::from(high[axis] - low[axis] + 1));
    let share = (width / 64.0).max(height / 36.0);
    assert!((0.55..0.97).contains(&share), "{width} x {height} pixels of 64 x 36");
}

#[test]
fn parts_are_joined_to_the_bytes_of_one_pass() {
    let scene = MovieScene::new("movie-join", 60);
    scene.run("movie scene.xml -o one.mp4").expect(0);
    for start in [0, 48] {
        let order = format!("movie scene.xml --frames {start}+48 --resume -o parts/{start}.mp4");
        scene.run(&order).expect(0);
        // It is there already: nothing is rendered.
        let again = scene.run(&format!("{order} --progress json")).expect(0).stderr;
        assert!(progress_lines(&again).is_empty() && again.contains("of them kept"), "{again}");
    }
    let joined = scene.run("movie scene.xml --join parts -o joined.mp4").expect(0);
    assert!(joined.stderr.contains("wrote joined.mp4 (2 parts, 60 frames)"), "{}", joined.stderr);
    assert!(scene.read("joined.mp4") == scene.read("one.mp4"));
    // Without the scene there is no sound, and the frames are those of the parts.
    scene.run("movie --join parts/48.mp4 parts/0.mp4 -o silent.mp4").expect(0);
    assert!(!contains(&scene.read("silent.mp4"), b"fLaC"));
    let refused = scene.run("movie scene.xml --join parts/0.mp4 -o x.mp4").expect(2);
    assert!(refused.stderr.contains("parts/0.mp4: it ends before frame 48"), "{}", refused.stderr);
    let other = "movie scene.xml --frames 48+48 --yaw 3 -o parts/48.mp4";
    scene.run(other).expect(0);
    let refused = scene.run("movie --join parts -o x.mp4").expect(2);
    assert!(refused.stderr.contains("parts/48.mp4: it is a part of another movie"), "{}", refused.stderr);
    assert!(!scene.path("x.mp4").exists());
}

/// Starts a movie with progress in JSON, and kills the program as soon as `frames` frames are done.
fn kill_after(scene: &MovieScene, order: &str, frames: u64) {
    let mut command = dragonfly(order.split_whitespace());
    command.current_dir(scene.folder()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    for line in lines.map(|line| line.expect("text")) {
        if progress_lines(&line).first().is_some_and(|progress| progress.0 >= frames) {
            child.kill().expect("our own child");
            break;
        }
    }
    wait(&mut child, LIMIT);
}

#[test]
fn a_killed_movie_is_resumed_to_the_bytes_of_an_undisturbed_one() {
    let scene = MovieScene::new("movie-kill", 100);
    scene.run("movie scene.xml -o wanted.mp4").expect(0);
    let wanted = scene.read("wanted.mp4");
    let order = "movie scene.xml -o it.mp4 --resume --progress json";
    let seed = seed(60_221);
    let mut random = Random::new(seed);
    let rounds = if takes_long() { 12 } else { 1 };
    for round in 0..rounds {
        let first = if round == 0 { 55 } else { 1 + random.below(100) as u64 };
        kill_after(&scene, order, first);
        for _ in 0..random.below(rounds) {
            kill_after(&scene, order, 1 + random.below(100) as u64);
        }
        let resumed = scene.run(order).expect(0).stderr;
        let lines = progress_lines(&resumed);
        assert!(lines.iter().all(|line| line.1 == 100), "{resumed}");
        assert!(first < 50 || lines.first().is_none_or(|line| line.0 > 48), "seed {seed}: {resumed}");
        assert!(scene.read("it.mp4") == wanted, "seed {seed}, round {round}");
        assert_eq!(scene.names(), ["it.mp4", "wanted.mp4"], "seed {seed}, round {round}");
        // Complete: nothing is rendered. Then of other settings: everything is.
        assert!(progress_lines(&scene.run(order).expect(0).stderr).is_empty());
        fs::remove_file(scene.path("it.mp4")).expect("a file");
    }
}

#[test]
fn frames_that_are_there_are_kept_unless_they_show_something_else() {
    let scene = MovieScene::new("movie-sequence", 6);
    let order = "movie scene.xml --resume --progress json -o f.####.png";
    let frames = |order: &str| progress_lines(&scene.run(order).expect(0).stderr).len();
    assert_eq!(frames(order), 6);
    let wanted = scene.read("f.0003.png");
    fs::remove_file(scene.path("f.0003.png")).expect("a frame");
    fs::write(scene.path("f.0005.png"), b"not ours").expect("a file");
    assert_eq!(frames(order), 2);
    assert!(scene.read("f.0003.png") == wanted);
    assert_eq!(frames(order), 0);
    assert_eq!(frames(&order.replace(" -o", " --background 102030 -o")), 6);
    let text = fs::read_to_string(scene.path("scene.xml")).expect("a text");
    fs::write(scene.path("scene.xml"), text.replace("0.5 0", "0.6 0")).expect("a file");
    assert_eq!(frames(order), 6);
    assert_eq!(frames(&order.replace(" -o", " --frames 0-5x2 -o")), 0);
}

#[test]
fn each_frame_is_a_line_of_progress_for_other_programs() {
    let scene = MovieScene::new("movie-progress", 4);
    let lines = progress_lines(&scene.run("movie scene.xml -o it.y4m --progress json").expect(0).stderr);
    assert_eq!(
        lines.iter().map(|line| (line.0, line.1)).collect::<Vec<_>>(),
        [(1, 4), (2, 4), (3, 4), (4, 4)]
    );
    assert!(lines.iter().all(|line| line.2 >= 0.0) && lines[3].2 == 0.0);
}

#[cfg(unix)]
#[test]
fn a_movie_that_is_asked_to_end_stops_between_two_frames_and_keeps_complete_parts() {
    use rustix::process::{Pid, Signal, kill_process};
    use std::os::unix::process::ExitStatusExt;
    let scene = MovieScene::new("movie-interrupt", 400);
    fs::write(scene.path("it.mp4"), b"old").expect("a file");
    let order = "movie scene.xml -o it.mp4 --progress json";
    let mut command = dragonfly(order.split_whitespace());
    command.current_dir(scene.folder()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let mut said = String::new();
    for line in BufReader::new(child.stderr.take().expect("piped")).lines() {
        let line = line.expect("text");
        if progress_lines(&line).first().is_some_and(|progress| progress.0 == 50) {
            kill_process(Pid::from_child(&child), Signal::TERM).expect("it runs");
        }
        said += &(line + "\n");
    }
    assert_eq!(wait(&mut child, LIMIT).signal(), Some(Signal::TERM.as_raw()), "{said}");
    assert!(said.contains("cancelled; complete parts are kept in it.mp4.parts"), "{said}");
    assert_eq!(scene.names(), ["it.mp4", "it.mp4.parts"]);
    assert_eq!(scene.read("it.mp4"), b"old");
    assert!(scene.path("it.mp4.parts/0000-0047.mp4").exists());
}

#[test]
fn orders_that_cannot_be_right_are_refused_with_the_place_and_the_reason() {
    let scene = MovieScene::new("movie-refused", 60);
    for (order, words) in [
        ("scene.xml -o out.mov", "out.mov: no format has this extension; use .mp4"),
        ("scene.xml -o -  --format gif", "-o -: GIF cannot be streamed; use y4m"),
        ("scene.xml -o out.mp4 --frames 60-61", "--frames: there is no frame 60; there are frames 0 to 59"),
        ("scene.xml -o out.mp4 --frames 49+48", "--frames: parts of an MP4 begin and end at multiples of 48"),
        ("scene.xml -o out.mp4 --frames 0+50", "--frames: parts of an MP4 begin and end at multiples of 48"),
        ("scene.xml -o out.gif --frames 0+48", "--frames: GIF is written in one piece"),
        ("scene.xml -o out.mp4 --frames 0-9x2", "--frames: MP4 has every frame"),
        ("scene.xml -o out.mp4 --frames 9-2", "end before they begin"),
        (
            "scene.xml -o out.mp4 --shot far",
            "--shot: no shot is called \"far\"; there is 0 (wide), 1 \"close\"",
        ),
        ("scene.xml -o out.mp4 --camera far", "--camera: no camera is called \"far\""),
        ("scene.xml -o out.mp4 --take Run", "--take: a scene has no takes"),
        ("scene.xml -o out.mp4 --fps 0.5", "is no frame rate"),
        ("scene.xml -o out.mp4 --quality 5", "10..=45"),
        ("scene.xml -o out.mp4 --shutter 400", "from 0 to 360"),
        ("scene.xml -o out.mp4 --samples 5000", "--samples"),
        ("box.glb -o out.mp4 --shot 1", "--shot, --camera, --script: FILE has to be a scene"),
        ("none.xml -o out.mp4", "none.xml"),
        ("-o out.mp4", "FILE"),
        ("--join none.mp4 -o out.mp4", "none.mp4: "),
        ("--join scene.xml -o out.mp4", "scene.xml: it is no complete MP4"),
        ("scene.xml --job slurm --chunk 50 -o job.sh", "--chunk: 50 is no multiple of 48"),
        ("scene.xml --job slurm --movie a.gif -o job.sh", "--job: GIF is written in one piece"),
        ("scene.xml --job slurm --frames 0+48 -o job.sh", "--frames: a job is made for a whole movie"),
    ] {
        let refused = scene.run(&format!("movie {order}")).expect(2);
        assert!(refused.stderr.contains(words), "{order}: {}", refused.stderr);
        assert!(refused.stdout.is_empty());
    }
    assert_eq!(scene.names(), [""; 0]);
    let help = run(["movie", "--help"]).expect(0);
    assert!(help.text().contains("Examples") && help.text().contains("--resume"), "{}", help.text());
}

#[test]
fn openexr_files_have_light_that_is_brighter_than_white() {
    let scene = MovieScene::new("movie-light", 2);
    let script = String::from_utf8(scene.read("scene.xml")).expect("text");
    let lamp = "<light id=\"lamp\" kind=\"point\" at=\"-1 0 0.3\" strength=\"60\"/>\n  </cast>";
    fs::write(scene.path("scene.xml"), script.replace("</cast>", lamp)).expect("a file");
    scene.run("movie scene.xml -o f.##.exr").expect(0);
    let lit = exr::prelude::read_first_rgba_layer_from_file(
        scene.path("f.00.exr"),
        |size, _| (vec![[0.0_f32; 4]; size.area()], size.width()),
        |(pixels, width), at, (red, green, blue, alpha): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = [red, green, blue, alpha];
        },
    );
    let (pixels, _) = lit.expect("an image").layer_data.channel_data.pixels;
    let brightest = pixels.iter().flat_map(|pixel| pixel[..3].to_vec()).fold(0.0, f32::max);
    assert!(brightest > 2.0, "{brightest}");
    assert_eq!(pixels.len(), (SIZE[0] * SIZE[1]) as usize);
    // The files are kept, and those of other light are not.
    let again = scene.run("movie scene.xml -o f.##.exr --resume").expect(0);
    assert!(again.stderr.contains("2 of them kept"), "{}", again.stderr);
}
