//! Injects rare driver failures: a device lost at any call, failed allocations, surfaces that change while in use, no driver
//! at all. A Vulkan layer between the program and the real driver injects them (`fault_layer/`).

use crate::fixture_layer::{Layer, lines};
use crate::program::{dragonfly, outcome};
use crate::screen::Screen;
use crate::window::{Editor, SOON, alone, rest, same};
use dragonfly_document::{Cancel, LoadedModel, Source, load_model};
use dragonfly_kit::folder::{Folder, data, takes_long};
use dragonfly_kit::picture::studio;
use dragonfly_picture::{PictureSettings, Studio};
use image::RgbaImage;
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};

const DEVICE_LOST: i32 = -4;
const OUT_OF_HOST_MEMORY: i32 = -1;
const OUT_OF_DEVICE_MEMORY: i32 = -2;
const INITIALIZATION_FAILED: i32 = -3;
const SURFACE_LOST: i32 = -1_000_000_000;
const OUT_OF_DATE: i32 = -1_000_001_004;
const SUBOPTIMAL: i32 = 1_000_001_003;

/// Environment variable with the file of the expected image. It is set in a child process, which runs the same test.
const CHILD: &str = "DRAGONFLY_FAULT_CHILD";

fn fox() -> Arc<LoadedModel> {
    let source = Source::File(data("gltf/Fox.glb"));
    Arc::new(load_model(&source, &mut |_| (), &Cancel::default()).expect("a good model"))
}

fn settings() -> PictureSettings {
    PictureSettings { size: [160, 120], time: 1.0, ..PictureSettings::default() }
}

/// The part of the tests below that runs in a child process with the fault layer loaded.
fn draw_behind_the_layer(reference: &str) {
    let reference: RgbaImage = image::open(reference).expect("the picture without faults").into_rgba8();
    let loaded = fox();
    let mut studio = Studio::new().expect("a device, also behind the layer");
    let deadline = Instant::now() + 4 * SOON;
    let wanted: usize =
        std::env::var("FAULT_TIMES").ok().and_then(|times| times.parse().ok()).expect("how many faults");
    let log = std::env::var("FAULT_LOG").expect("where the faults are told");
    let (mut drawn, mut refused, mut slowest) = (0, 0, Duration::ZERO);
    let mut since_fault = Instant::now();
    // A few more images after the last fault must be right too.
    let mut after = 0;
    while after < 3 {
        assert!(Instant::now() < deadline, "{drawn} drawn, {refused} refused, {} faults", lines(&log));
        studio.stage().resume();
        match studio.render(&loaded, &settings()) {
            Ok(picture) => {
                assert!(picture == reference, "picture {drawn} is another than without faults");
                slowest = slowest.max(since_fault.elapsed());
                since_fault = Instant::now();
                drawn += 1;
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
        after = if lines(&log) >= wanted { after + 1 } else { 0 };
    }
    println!("{drawn} pictures, {refused} refused, longest wait for one {slowest:?}");
    assert!(slowest < Duration::from_secs(2) * slowness(), "a picture came back only after {slowest:?}");
}

/// Factor by which operations may be slower than on an idle machine: the tests share its two cores.
fn slowness() -> u32 {
    5
}

/// Draws in a child process while the layer makes `call` return `result`. The child runs `test`, which is the calling
/// test, and draws when it reaches this function.
#[track_caller]
fn draw_through(test: &str, call: &str, result: i32, times: usize, more: &[(&str, &str)]) {
    if let Ok(reference) = std::env::var(CHILD) {
        return draw_behind_the_layer(&reference);
    }
    let layer = Layer::new(call);
    let reference = layer.folder.join("reference.png");
    let mut studio = studio::studio().expect("a device");
    studio.render(&fox(), &settings()).expect("a picture").save(&reference).expect("a file");
    let output = Command::new(std::env::current_exe().expect("a running test has a file"))
        .args([&format!("faults::{test}"), "--exact", "--nocapture", "--test-threads=1"])
        .env(CHILD, &reference)
        .envs(layer.environment(call, result, times))
        .envs(more.iter().copied())
        .output()
        .expect("the test's own file can be started");
    let said =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(
        output.status.success() && said.contains("1 passed"),
        "{call} {result}: {}\n{said}",
        output.status
    );
    assert_eq!(layer.faults(), times, "{call}: as many faults as asked for\n{said}");
    println!("{call} {result}: {}", said.lines().find(|line| line.contains("pictures")).unwrap_or(""));
}

#[test]
fn after_a_device_loss_at_any_submit_the_same_image_is_drawn() {
    let _one = alone();
    let test = "after_a_device_loss_at_any_submit_the_same_image_is_drawn";
    draw_through(test, "submit", DEVICE_LOST, 50, &[("FAULT_CLIMB", "1")]);
}

#[test]
fn after_a_device_loss_at_any_wait_the_same_image_is_drawn() {
    let _one = alone();
    let test = "after_a_device_loss_at_any_wait_the_same_image_is_drawn";
    draw_through(test, "wait", DEVICE_LOST, 50, &[("FAULT_CLIMB", "1")]);
}

#[test]
fn out_of_memory_is_an_error_and_no_crash() {
    let _one = alone();
    // Fails the first allocation of a device, then the second, … up to the hundredth, as long as the program makes that many.
    let layer = Layer::new("memory");
    let mut finished = false;
    for (result, step) in [(OUT_OF_DEVICE_MEMORY, 1), (OUT_OF_HOST_MEMORY, 3)] {
        for at in (1..=100).step_by(step) {
            let file = layer.folder.join("picture.png");
            let mut command = dragonfly(["render", "demo:", "--size", "64x64", "-o"]);
            command.arg(&file).envs(layer.environment("allocate", result, 1)).env("FAULT_AT", at.to_string());
            let outcome = outcome(&mut command);
            assert!(
                matches!(outcome.code, Some(0 | 3)),
                "allocation {at}: {:?}\n{}",
                outcome.code,
                outcome.stderr
            );
            assert!(!outcome.stderr.contains("internal error"), "allocation {at}: {}", outcome.stderr);
            if outcome.code == Some(0) {
                image::open(&file).expect("what is written is a picture");
            }
            if layer.faults() == 0 {
                // No fault occurred: the program makes fewer allocations, so all of them were tried.
                finished = true;
                break;
            }
            layer.forget();
        }
    }
    assert!(finished, "more than a hundred allocations");
}

/// Runs the window program with the fault layer until all faults have occurred; then it must show the same image as without
/// the layer.
#[track_caller]
fn show_through(name: &str, cases: &[(&str, i32, usize, &str)]) {
    const SIZE: (u32, u32) = (640, 480);
    const PART: [u32; 4] = [250, 60, 180, 180];
    let mut screen = Screen::new(name, SIZE.0, SIZE.1);
    let whole = {
        let mut editor = Editor::open(&mut screen, &[], &[]);
        screen.resize(editor.window, SIZE.0, SIZE.1);
        let whole = rest(&mut screen, PART);
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0));
        whole
    };
    for &(call, result, times, climb) in cases {
        let layer = Layer::new(name);
        let mut environment = layer.environment(call, result, times);
        environment.push(("FAULT_CLIMB".to_owned(), climb.to_owned()));
        let environment: Vec<(&str, &str)> =
            environment.iter().map(|(name, value)| (&**name, &**value)).collect();
        let began = Instant::now();
        let mut editor = Editor::open(&mut screen, &["--never-pause"], &environment);
        screen.resize(editor.window, SIZE.0, SIZE.1);
        dragonfly_kit::eventually(5 * SOON, || layer.faults() >= times);
        let after = rest(&mut screen, PART);
        same(&screen, &after, &whole, &format!("{call} {result}, {times} times, changed the picture"));
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
        println!("{call} {result} × {times}: {:?}", began.elapsed());
    }
}

/// Number of devices that are lost one after the other, each one call later.
fn losses() -> usize {
    if takes_long() { 50 } else { 15 }
}

#[test]
fn a_device_lost_while_acquiring_an_image_of_the_window_is_recreated() {
    let _one = alone();
    show_through("acquire", &[("acquire", DEVICE_LOST, losses(), "1")]);
}

#[test]
fn a_device_lost_while_presenting_an_image_is_recreated() {
    let _one = alone();
    show_through("present", &[("present", DEVICE_LOST, losses(), "1")]);
}

#[test]
fn a_surface_that_is_lost_outdated_or_suboptimal_is_recreated() {
    let _one = alone();
    let kinds: Vec<(&str, i32, usize, &str)> = ["acquire", "present"]
        .into_iter()
        .flat_map(|call| [SURFACE_LOST, OUT_OF_DATE, SUBOPTIMAL].map(|result| (call, result, 20, "0")))
        .collect();
    show_through("surface", &kinds);
}

/// Each loss is followed by two devices that cannot be created. Only a new instance helps then, and the main thread makes
/// its surface.
#[test]
fn a_loss_that_needs_a_new_instance_and_surface_keeps_the_image() {
    let _one = alone();
    const PART: [u32; 4] = [250, 60, 180, 180];
    const LOSSES: usize = 10;
    let mut screen = Screen::new("new-surface", 640, 480);
    let whole = {
        let mut editor = Editor::open(&mut screen, &[], &[]);
        screen.resize(editor.window, 640, 480);
        let whole = rest(&mut screen, PART);
        screen.close(editor.window);
        assert_eq!(editor.ends(SOON).code(), Some(0));
        whole
    };
    let layer = Layer::new("new-surface");
    let mut environment = layer.environment("device", INITIALIZATION_FAILED, 2 * LOSSES);
    environment.extend(
        [("FAULT_EVERY", "1"), ("FAULT_SPARES", "3")]
            .map(|(name, value)| (name.to_owned(), value.to_owned())),
    );
    let environment: Vec<(&str, &str)> =
        environment.iter().map(|(name, value)| (&**name, &**value)).collect();
    let mut editor = Editor::open(&mut screen, &["--lose-device", "3", "--never-pause"], &environment);
    screen.resize(editor.window, 640, 480);
    // The first is that of the start.
    editor.wait_for_log("surface of the window made", LOSSES + 1, 2 * SOON);
    assert_eq!(layer.faults(), 2 * LOSSES);
    let after = rest(&mut screen, PART);
    same(&screen, &after, &whole, "new surfaces changed the picture");
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("panic"), "{}", editor.log());
}

#[test]
fn without_a_driver_there_is_a_message_and_other_commands_work() {
    let folder = Folder::new("driverless");
    let without = |arguments: &[&str]| {
        let mut command = dragonfly(arguments);
        command.current_dir(folder.path());
        for variable in ["VK_ICD_FILENAMES", "VK_DRIVER_FILES"] {
            command.env(variable, "/nonexistent");
        }
        outcome(&mut command)
    };
    for arguments in [&["render", "demo:", "-o", "x.png"][..], &[][..]] {
        let outcome = without(arguments).expect(3);
        assert!(outcome.took < Duration::from_secs(3) * slowness(), "{:?}", outcome.took);
        assert!(outcome.stderr.contains("mesa-vulkan-drivers"), "{}", outcome.stderr);
    }
    without(&["info", "demo:"]).expect(0);
    without(&["pose", "demo:", "--time", "0.5", "--vertices", "1"]).expect(0);
    without(&["demo", "-o", "model.glb"]).expect(0);
}

#[test]
fn a_window_without_a_driver_reports_it_and_exits() {
    let _one = alone();
    let screen = Screen::new("driverless-window", 640, 480);
    let mut command = dragonfly(["demo:"]);
    command
        .env("DISPLAY", screen.display())
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("VK_DRIVER_FILES", "/nonexistent");
    let outcome = outcome(&mut command).expect(3);
    assert!(outcome.stderr.contains("mesa-vulkan-drivers"), "{}", outcome.stderr);
    assert!(outcome.took < Duration::from_secs(3) * slowness(), "{:?}", outcome.took);
}

#[test]
fn a_display_that_does_not_respond_counts_as_missing() {
    let folder = Folder::new("deaf");
    let mut command = dragonfly::<&str>([]);
    command.env("DISPLAY", ":65432").current_dir(folder.path());
    let outcome = outcome(&mut command).expect(0);
    assert!(outcome.stderr.contains("no display"), "{}", outcome.stderr);
    assert!(folder.join("dragonfly.png").exists());
}
