//! The whole window with the scene: the panels, the messages to the graphics thread and all passes, as in the program, but
//! into a texture.

use super::compare::SCENES;
use super::drawing;
use super::reference::{self, HOW_TO_UPDATE};
use super::states::{self, Fullness};
use crate::scene_bench;
use crate::workbench::Workbench;
use dragonfly::app::graphics_sync::GraphicsSync;
use dragonfly::panels::commands::Id;
use dragonfly::panels::compared::CompareWith;
use dragonfly::panels::dialog_preview::DialogPreview;
use dragonfly::panels::prompts::Overlay;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Request, style};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{Edit, TakeRef, TrimTake};
use dragonfly_document::{Change, Source};
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::picture::complaints::NoComplaints;
use dragonfly_kit::skip::{TestNeed, skip};
use dragonfly_picture::{DeviceParameters, Graphics, GraphicsHandle, GraphicsReply, PanelsFrame};
use dragonfly_runtime::{Captured, Context, Next, Receiver, Thread};
use egui::{Pos2, RawInput, Rect, Theme, ViewportId, vec2};
use image::RgbaImage;
use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// Size of the window, points and pixels.
const SIZE: [u32; 2] = [1120, 700];

/// A window: its name, and the state of the panels.
type WindowRow = (&'static str, fn() -> Workbench);

const WINDOWS: &[WindowRow] =
    &[("built-in", built_in), ("fox", fox), ("scene", scene), ("scene-camera", through_camera)];

const THEMES: [(Theme, &str); 2] = [(Theme::Dark, "dark"), (Theme::Light, "light")];

/// Returns the built-in model with a selected bone, its path, and ghosts of the frames around.
fn built_in() -> Workbench {
    let mut bench = Fullness::Typical.bench();
    let state = bench.state.read();
    let wing = (0..50).find(|&bone| state.bone_name(bone) == "wing_fore_left_1");
    bench.state.execute(Request::Select(Some(wing.expect("a bone of the built-in model"))));
    for id in [Id::ToggleGhosts, Id::TogglePath] {
        bench.state.execute(Request::Command(id));
    }
    bench
}

/// Returns the fox at a time of its second take.
fn fox() -> Workbench {
    let mut bench = Workbench::new(Some(states::view_of(&Source::File(data("gltf/Fox.glb")))));
    bench.state.window_mut().set_frame_time(4.2);
    bench.state.execute(Request::ShowTake(Some(1)));
    bench.state.execute(Request::Seek(0.3));
    bench.state.pause();
    bench.state.execute(Request::Select(Some(7)));
    bench
}

/// Returns two foxes with a path that is selected, next to the shot of their camera.
fn scene() -> Workbench {
    let mut bench = Fullness::Typical.scene();
    bench.state.window_mut().set_frame_time(4.2);
    let path = SceneRequest::SelectThings(vec!["aisle".into()], Choice::Replace);
    bench.state.execute(Request::Scene(path));
    bench.state.execute(Request::Command(Id::ToggleSecondView));
    bench.state.pause();
    bench
}

/// Returns two foxes and a title through the camera of the shot, with thirds and safe areas.
fn through_camera() -> Workbench {
    through_camera_of(scene_bench::FOXES)
}

fn through_camera_of(script: &str) -> Workbench {
    let mut bench = scene_bench::scene(script);
    bench.state.window_mut().set_frame_time(4.2);
    bench.state.execute(Request::Command(Id::LookThroughShot));
    bench.state.execute(Request::Seek(4.75));
    bench.state.pause();
    bench
}

/// Returns the names of all pictures of this file.
pub(super) fn names() -> Vec<String> {
    let drawn = |(name, _): &WindowRow| {
        let name: &'static str = name;
        themes_of(name).iter().map(move |(_, theme)| file_name(name, theme))
    };
    WINDOWS.iter().flat_map(drawn).collect()
}

/// Returns the themes in which a window is drawn: what is over an image is the same in both.
fn themes_of(window: &str) -> &'static [(Theme, &'static str)] {
    if window == "scene-camera" { &THEMES[..1] } else { &THEMES }
}

fn file_name(window: &str, theme: &str) -> String {
    format!("windows/{window}-{theme}-1x")
}

/// Records the messages to the main thread.
#[derive(Default)]
struct WindowReplies(Vec<GraphicsReply>);

impl Receiver for WindowReplies {
    type Message = GraphicsReply;

    fn receive(&mut self, message: GraphicsReply, _: &mut Context) {
        self.0.push(message);
    }
}

/// The main thread and the graphics thread, run by the test.
struct DrawnWindow {
    main: Captured,
    thread: Captured,
    graphics: GraphicsHandle,
    sync: GraphicsSync,
    replies: Rc<RefCell<WindowReplies>>,
    folder: Folder,
    // Dropped last, when the device is gone.
    _watch: NoComplaints,
}

impl DrawnWindow {
    fn open() -> Self {
        let watch = NoComplaints::expect();
        let mut main = Thread::capture("main", || {});
        let thread = Thread::capture("graphics", || {});
        let replies = Rc::new(RefCell::new(WindowReplies::default()));
        let address = main.context().register_receiver(Rc::clone(&replies));
        let graphics = Graphics::start_in(thread.handle(), DeviceParameters::default(), SIZE, address);
        let (sync, folder) = (GraphicsSync::default(), Folder::new("windows"));
        Self { main, thread, graphics, sync, replies, folder, _watch: watch }
    }

    /// Draws the panels and the scene of a workbench.
    fn draw(&mut self, bench: Workbench, theme: Theme) -> RgbaImage {
        self.draw_after(bench, theme, |_| {})
    }

    /// Draws as [`Self::draw`]; `act` changes the state after each frame of the panels.
    fn draw_after(
        &mut self,
        mut bench: Workbench,
        theme: Theme,
        mut act: impl FnMut(&mut Workbench),
    ) -> RgbaImage {
        let context = egui::Context::default();
        style::install(&context);
        context.set_theme(theme);
        context.all_styles_mut(|style| {
            style.animation_time = 0.0;
            style.visuals.text_cursor.blink = false;
        });
        self.graphics.show(bench.state.read().view.expect("a model").clone());
        for step in 0..6 {
            let mut input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(SIZE[0] as f32, SIZE[1] as f32))),
                time: Some(f64::from(step) * 0.25),
                focused: true,
                ..RawInput::default()
            };
            input.viewports.entry(ViewportId::ROOT).or_default().native_pixels_per_point = Some(1.0);
            let output = context.run_ui(input, |ui| bench.frame(ui));
            let jobs = context.tessellate(output.shapes, output.pixels_per_point);
            let frame =
                PanelsFrame { size: SIZE, pixels_per_point: 1.0, jobs, textures: output.textures_delta };
            self.graphics.show_panels(frame);
            act(&mut bench);
            self.sync.update(&self.graphics, &bench.state.read(), 1.0, theme == Theme::Dark);
        }
        self.settle();
        self.capture(self.folder.join("window.png"))
    }

    /// Runs iterations of the graphics thread until it is idle.
    fn settle(&mut self) {
        let end = Instant::now() + Duration::from_secs(60);
        loop {
            match self.thread.iterate() {
                Next::OnMessage => return,
                Next::At(when) => std::thread::park_timeout(when.saturating_duration_since(Instant::now())),
                Next::Now | Next::Stopped => {}
            }
            assert!(Instant::now() < end, "the graphics thread finds no rest");
        }
    }

    fn capture(&mut self, path: PathBuf) -> RgbaImage {
        self.graphics.capture(path);
        self.settle();
        self.main.iterate();
        let replies = std::mem::take(&mut self.replies.borrow_mut().0);
        let captured = replies.into_iter().find_map(|reply| match reply {
            GraphicsReply::Captured(written) => Some(written),
            _ => None,
        });
        image::open(captured.expect("a reply").expect("a picture")).expect("a PNG file").into_rgba8()
    }
}

#[test]
fn the_whole_window_looks_as_stored() {
    match drawing::program_draws_on_processor() {
        Some(true) => {}
        Some(false) => {
            return skip(TestNeed::Adapter, "the stored scenes are those of a driver on the processor");
        }
        None => return,
    }
    let mut window = DrawnWindow::open();
    let mut complaints = Vec::new();
    for (name, bench) in WINDOWS {
        for &(theme, word) in themes_of(name) {
            let picture = window.draw(bench(), theme);
            complaints.extend(reference::compare(&file_name(name, word), &picture, SCENES));
        }
    }
    assert!(complaints.is_empty(), "\n  {}\n{HOW_TO_UPDATE}", complaints.join("\n  "));
}

/// Returns the fox at the start of its walk, with an overlay.
fn fox_with(overlay: Option<Overlay>) -> Workbench {
    let mut bench = fox();
    // Without its end, the walk does not repeat.
    let trim = TrimTake { take: TakeRef::Index(1), from: 0.0, to: 0.4, to_start: false };
    bench.change(Change::Edit(Edit::TrimTake(trim), None));
    bench.state.execute(Request::Seek(0.0));
    bench.state.execute(Request::Select(None));
    bench.state.execute(Request::Overlay(overlay));
    bench
}

/// Returns the fox next to a figure whose takes are wanted.
fn with_source() -> Workbench {
    let mut bench = fox_with(Some(Overlay::Retarget));
    bench.state.source_read(states::view_of(&Source::File(data("bench/pab.glb"))).loaded);
    bench
}

/// Returns the fox compared with another take of the same file, opened as another file.
fn with_file() -> Workbench {
    let mut bench = fox_with(None);
    bench.state.compared_read(states::view_of(&Source::File(data("gltf/Fox.glb"))).loaded);
    bench.state.execute(Request::CompareWith(CompareWith::File(2)));
    bench
}

/// Name, window with the dialog, and the columns of the picture that it leaves free.
type DialogCase = (&'static str, fn() -> Workbench, std::ops::Range<u32>);

#[test]
fn the_second_skeleton_of_dialogs_and_comparisons_is_drawn_in_the_viewport() {
    match drawing::program_draws_on_processor() {
        Some(true) => {}
        Some(false) => return skip(TestNeed::Adapter, "the pictures are those of a driver on the processor"),
        None => return,
    }
    let mut window = DrawnWindow::open();
    // The columns of the picture that a dialog leaves free.
    let cases: [DialogCase; 3] = [
        ("loop", || fox_with(Some(Overlay::Loop)), 290..630),
        ("source", with_source, 290..550),
        ("file", with_file, 290..800),
    ];
    for (name, bench, columns) in cases {
        let with = window.draw(bench(), Theme::Dark);
        let without = window.draw_after(bench(), Theme::Dark, |bench| {
            bench.state.execute(Request::Preview(DialogPreview::Nothing));
            bench.state.execute(Request::CompareWith(CompareWith::Nothing));
        });
        if let Some(folder) = std::env::var_os("DRAGONFLY_LOOK") {
            with.save(PathBuf::from(folder).join(format!("second-{name}.png"))).expect("a folder");
        }
        // The pixels that differ there are those of the skeleton.
        let differ = columns
            .flat_map(|x| (80..440).map(move |y| (x, y)))
            .filter(|&(x, y)| with.get_pixel(x, y) != without.get_pixel(x, y))
            .count();
        assert!(differ > 300, "{name}: {differ} pixels");
    }
}

/// Returns where an image of 16 to 9 is in the viewport of a workbench.
fn image_of(bench: &Workbench) -> Rect {
    let viewport = bench.state.read().viewport;
    let width = viewport.width().min(viewport.height() * 16.0 / 9.0);
    Rect::from_center_size(viewport.center(), vec2(width, width * 9.0 / 16.0))
}

/// Draws a workbench twice, the second time after `change`. Returns both pictures and the place of the image.
fn twice(
    window: &mut DrawnWindow,
    bench: fn() -> Workbench,
    change: impl Fn(&mut Workbench),
) -> ([RgbaImage; 2], Rect) {
    let mut place = Rect::NOTHING;
    let first = window.draw_after(bench(), Theme::Dark, |bench| place = image_of(bench));
    let mut changed = bench();
    change(&mut changed);
    ([first, window.draw(changed, Theme::Dark)], place)
}

fn is_on_processor() -> bool {
    match drawing::program_draws_on_processor() {
        Some(true) => true,
        Some(false) => {
            skip(TestNeed::Adapter, "the pictures are those of a driver on the processor");
            false
        }
        None => false,
    }
}

#[test]
fn the_image_of_a_camera_has_lines_at_its_thirds_and_around_what_is_safe() {
    if !is_on_processor() {
        return;
    }
    let mut window = DrawnWindow::open();
    let ([with, without], image) = twice(&mut window, through_camera, |bench| {
        bench.state.execute(Request::Command(Id::ToggleImageGuides));
    });
    let differs = |x: f32, y: f32| {
        let near = |pixel: [i32; 2]| {
            let [x, y] = pixel.map(|side| side as u32);
            with.get_pixel(x, y) != without.get_pixel(x, y)
        };
        (-1..=1).any(|dx| (-1..=1).any(|dy| near([x.round() as i32 + dx, y.round() as i32 + dy])))
    };
    let at = |x: f32, y: f32| image.min + vec2(x, y) * image.size();
    let lines = [1.0 / 3.0, 2.0 / 3.0, 0.035, 0.05, 0.965, 0.95];
    for part in lines {
        // Between the caption and the toolbar, which cover the upper edge.
        for (x, y) in [(part, 0.42), (part, 0.6), (0.3, part)] {
            let at = at(x, y);
            assert!(differs(at.x, at.y), "no line at {x} {y}");
        }
    }
    for (x, y) in [(0.2, 0.45), (0.5, 0.6), (0.8, 0.45), (0.5, 0.2), (0.5, 0.8), (0.015, 0.45)] {
        let at = at(x, y);
        assert!(!differs(at.x, at.y), "something is drawn at {x} {y}");
    }
}

/// Returns the box around the pixels that differ inside a part of two pictures, as shares of that part.
fn changed_box(pictures: [&RgbaImage; 2], part: Rect) -> Rect {
    let mut around = Rect::NOTHING;
    for y in part.top().ceil() as u32..part.bottom().floor() as u32 {
        for x in part.left().ceil() as u32..part.right().floor() as u32 {
            let [one, other] = pictures.map(|picture| *picture.get_pixel(x, y));
            // The letters themselves are white.
            let is_letter = (0..3).all(|part| one[part] > 200) && one != other;
            if is_letter {
                around.extend_with(Pos2::new(x as f32 + 0.5, y as f32 + 0.5));
            }
        }
    }
    let share = |at: Pos2| ((at - part.min) / part.size()).to_pos2();
    Rect::from_min_max(share(around.min), share(around.max))
}

#[test]
fn titles_in_the_window_are_where_movies_have_them_and_as_large() {
    if !is_on_processor() {
        return;
    }
    let Some(mut studio) = dragonfly_kit::picture::studio::studio() else { return };
    let untitled = scene_bench::FOXES.replace("text=\"The End\"", "text=\" \"");
    let mut window = DrawnWindow::open();
    let mut image = Rect::NOTHING;
    let with = window.draw_after(through_camera(), Theme::Dark, |bench| image = image_of(bench));
    let without = window.draw(through_camera_of(&untitled), Theme::Dark);
    let shown = changed_box([&with, &without], image);
    let size = [image.width().round() as u32, image.height().round() as u32];
    let mut render = |script: &str| {
        let scene = scene_bench::scene(script).state.read().view.and_then(|view| view.scene.clone());
        let look = dragonfly_picture::Look {
            through: dragonfly_picture::ThroughCamera::Shot,
            ..dragonfly_picture::Look::default()
        };
        let settings = dragonfly_picture::PictureSettings {
            size,
            time: 4.75,
            look,
            ..dragonfly_picture::PictureSettings::default()
        };
        studio.render_scene(&scene.expect("a scene"), &settings).expect("a picture")
    };
    let (titled, plain) = (render(scene_bench::FOXES), render(&untitled));
    let whole = Rect::from_min_size(Pos2::ZERO, vec2(size[0] as f32, size[1] as f32));
    let rendered = changed_box([&titled, &plain], whole);
    println!("in the window {shown}, in a movie {rendered}");
    for (one, other) in [(shown.min, rendered.min), (shown.max, rendered.max)] {
        assert!((one - other).length() < 0.01, "in the window {shown}, in a movie {rendered}");
    }
}
