//! The reference picture from files to the screen: an image sequence follows the playhead.

use crate::screen::{Screen, key};
use crate::window::{Editor, SOON, alone, eventually_shows_something};
use dragonfly_kit::eventually;
use dragonfly_kit::folder::{Folder, data};
use image::{Rgba, RgbaImage};

/// The colors of the frames.
const COLORS: [[u8; 3]; 6] =
    [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0], [255, 0, 255], [0, 255, 255]];
/// A part of the viewport without the model.
const CORNER: [u32; 4] = [330, 110, 8, 8];

#[test]
fn every_frame_of_a_sequence_is_shown_at_its_frame_of_the_take() {
    let _one = alone();
    let folder = Folder::new("reference-window");
    let model = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &model).expect("a file");
    std::fs::create_dir(folder.join("film")).expect("a folder");
    for (at, [red, green, blue]) in COLORS.into_iter().enumerate() {
        let path = folder.join(&format!("film/frame_{:04}.png", at + 1));
        RgbaImage::from_pixel(16, 9, Rgba([red, green, blue, 255])).save(path).expect("a file");
    }
    // As the program stores it: relative to the folder of the model.
    let settings = Folder::new("reference-settings");
    let marks = serde_json::json!({ "files": [{
        "path": model.to_string_lossy(),
        "frame_rate": 10,
        "reference": { "file": "film/frame_0003.png", "opacity": 1.0, "scale": 4.0, "first": 1 },
    }]});
    std::fs::write(settings.join("marks.json"), marks.to_string()).expect("a file");
    let mut screen = Screen::new("reference", 1280, 800);
    let path = settings.path().to_string_lossy().into_owned();
    let mut editor = Editor::open_file(&mut screen, &model, &["--settings", &path], &[]);
    let window = screen.window("Fox.glb", SOON);
    screen.focus(window);
    eventually_shows_something(&screen);
    screen.press(key::SPACE);
    screen.press(key::HOME);
    let shows = |screen: &Screen, [red, green, blue]: [u8; 3]| {
        let part = screen.part(CORNER);
        part.pixels().all(|pixel| {
            let near = |shown: u8, wanted: u8| shown.abs_diff(wanted) <= 2;
            near(pixel[0], red) && near(pixel[1], green) && near(pixel[2], blue)
        })
    };
    // The first frame is at frame 1 of the take, and held before it.
    for frame in [0, 0, 1, 2, 3, 4, 5, 5] {
        eventually(SOON, || shows(&screen, COLORS[frame]));
        screen.press(key::RIGHT);
    }
    // Back to the start, where the frames are decoded already.
    screen.press(key::HOME);
    eventually(SOON, || shows(&screen, COLORS[0]));
    screen.close(window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
}
