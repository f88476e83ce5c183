//! The graphics thread, with iterations run by the test: it draws when something changed, answers requests, and is
//! idle otherwise.

use crate::image_loading::{damaged, plain, sheets};
use crate::scenes;
use dragonfly_anim::data::{ModelData, Take};
use dragonfly_document::{Document, DocumentReply, FaultInjection, FaultPlan, Source, View};
use dragonfly_kit::document::arm;
use dragonfly_kit::document::received::Received;
use dragonfly_kit::eventually;
use dragonfly_kit::picture::complaints::NoComplaints;
use dragonfly_kit::skip::{TestNeed, skip};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::OwnedRegion;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{
    DeviceParameters, Graphics, GraphicsHandle, GraphicsReply, Look, PanelsFrame, PickedThing, Thumbnail,
    ThumbnailOrder,
};
use dragonfly_runtime::{Captured, Context, Next, Receiver, Thread};
use glam::{Vec2, Vec3};
use image::RgbaImage;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [320, 200];

/// Records the messages to the main thread.
#[derive(Default)]
struct Replies(Vec<GraphicsReply>);

impl Receiver for Replies {
    type Message = GraphicsReply;

    fn receive(&mut self, message: GraphicsReply, _: &mut Context) {
        self.0.push(message);
    }
}

/// Loses the device when a test sets it.
#[derive(Debug, Default)]
struct LoseDevice(AtomicBool);

impl FaultPlan for LoseDevice {
    fn loses_device(&self, _: u64, _: bool) -> bool {
        self.0.swap(false, Ordering::Relaxed)
    }
}

/// The main thread and the graphics thread, run by one OS thread.
struct GraphicsBench {
    main: Captured,
    thread: Captured,
    graphics: GraphicsHandle,
    replies: Rc<RefCell<Replies>>,
    losses: Arc<LoseDevice>,
    // Dropped last, when the device is gone.
    _watch: NoComplaints,
}

impl GraphicsBench {
    /// Creates both threads, before the first iteration of the graphics thread.
    fn begin(parameters: DeviceParameters) -> Self {
        let losses = Arc::new(LoseDevice::default());
        let parameters =
            DeviceParameters { faults: FaultInjection::new(Arc::clone(&losses) as _), ..parameters };
        let watch = NoComplaints::expect();
        let mut main = Thread::capture("main", || {});
        let thread = Thread::capture("graphics", || {});
        let replies = Rc::new(RefCell::new(Replies::default()));
        let address = main.context().register_receiver(Rc::clone(&replies));
        let graphics = Graphics::start_in(thread.handle(), parameters, SIZE, address);
        Self { main, thread, graphics, replies, losses, _watch: watch }
    }

    /// Creates both threads; skips the test where there is no adapter.
    fn new() -> Option<Self> {
        let mut bench = Self::begin(DeviceParameters::default());
        bench.settle();
        match &bench.take()[..] {
            [GraphicsReply::Fatal(reason), ..] => {
                skip(TestNeed::Adapter, reason);
                None
            }
            [GraphicsReply::Ready { .. }, ..] => Some(bench),
            other => panic!("{other:?}"),
        }
    }

    /// Creates both threads and shows the model of the arm.
    fn with_arm() -> Option<Self> {
        let mut bench = Self::new()?;
        bench.graphics.show(View::opened(1, arm::loaded()));
        bench.graphics.set_camera(Camera { target: Vec3::Y * 1.5, distance: 8.0, ..Camera::default() });
        bench.graphics.set_look(Look { viewport: [20, 10, 280, 180], skeleton: true, ..Look::default() });
        bench.settle();
        Some(bench)
    }

    /// Runs iterations of the graphics thread until it is idle, for a short time at most.
    fn settle(&mut self) {
        let end = Instant::now() + Duration::from_secs(20);
        while self.turn() != Next::OnMessage {
            assert!(Instant::now() < end, "the graphics thread finds no rest");
        }
    }

    /// Runs one iteration when it is due.
    fn turn(&mut self) -> Next {
        let next = self.thread.iterate();
        if let Next::At(when) = next {
            std::thread::park_timeout(when.saturating_duration_since(Instant::now()));
        }
        next
    }

    fn take(&mut self) -> Vec<GraphicsReply> {
        self.main.iterate();
        std::mem::take(&mut self.replies.borrow_mut().0)
    }

    fn frames(&mut self) -> u64 {
        let frames = self.take().into_iter().filter_map(|reply| match reply {
            GraphicsReply::Statistics { frames, .. } => Some(frames),
            _ => None,
        });
        frames.max().unwrap_or(0)
    }

    /// Returns the image of the whole window.
    fn capture(&mut self, path: &Path) -> RgbaImage {
        self.graphics.capture(path.to_owned());
        self.settle();
        let written = self.take().into_iter().find_map(|reply| match reply {
            GraphicsReply::Captured(written) => Some(written),
            _ => None,
        });
        image::open(written.unwrap().unwrap()).unwrap().into_rgba8()
    }
}

fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    folder.join(name)
}

/// Returns panels with a word on them, as egui paints them.
fn panels(context: &egui::Context, word: &str) -> PanelsFrame {
    let input = egui::RawInput {
        screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(320.0, 200.0))),
        ..egui::RawInput::default()
    };
    let output = context.run_ui(input, |ui| {
        ui.heading(word);
    });
    PanelsFrame {
        size: SIZE,
        pixels_per_point: 1.0,
        jobs: context.tessellate(output.shapes, 1.0),
        textures: output.textures_delta,
    }
}

#[test]
fn a_frame_is_drawn_only_when_something_changes() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    assert_eq!(bench.turn(), Next::OnMessage, "nothing moves, so nothing wakes the thread");
    let now = Instant::now();
    let playing =
        PlaybackClock { take: Some(0), length: arm::LENGTH, playing: true, ..PlaybackClock::rest(now) };
    bench.graphics.play(playing);
    let deadline = now + Duration::from_secs(60);
    while bench.frames() <= 5 {
        assert_ne!(bench.turn(), Next::OnMessage, "playing continues by itself");
        assert!(Instant::now() < deadline, "too few frames");
    }
    bench.graphics.play(playing.with(false, 1.0, playing.repeat, Instant::now()));
    bench.settle();
}

#[test]
fn a_minimized_window_draws_nothing() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    bench.graphics.resize([0, 0]);
    bench.graphics.play(PlaybackClock {
        take: Some(0),
        length: arm::LENGTH,
        playing: true,
        ..PlaybackClock::rest(Instant::now())
    });
    bench.settle();
    bench.graphics.resize(SIZE);
    assert_ne!(bench.turn(), Next::OnMessage, "it goes on where the window comes back");
}

#[test]
fn a_damaged_image_is_reported_once_with_the_title_of_its_model() {
    let Some(mut bench) = GraphicsBench::new() else { return };
    let view = View::opened(1, damaged(&sheets(1, vec![plain(64, [255; 4])]), 0));
    bench.graphics.show(view.clone());
    bench.graphics.set_look(Look { viewport: [20, 10, 280, 180], ..Look::default() });
    bench.settle();
    bench.graphics.show(View { generation: 2, ..view });
    bench.settle();
    let images = bench.take().into_iter().filter_map(|reply| match reply {
        GraphicsReply::Images { title, warnings } => Some((title, warnings)),
        _ => None,
    });
    let [(title, warnings)] = &images.collect::<Vec<_>>()[..] else { panic!("one report") };
    assert_eq!((title.as_str(), warnings.len()), ("Made", 1));
    assert!(warnings[0].starts_with("image 0 is not shown: "), "{}", warnings[0]);
}

#[test]
fn panels_are_restored_after_a_device_loss() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    let context = egui::Context::default();
    // The second frame has no textures, and the first is never drawn; its textures must not be lost.
    bench.graphics.show_panels(panels(&context, "first"));
    bench.graphics.show_panels(panels(&context, "second"));
    let before = bench.capture(&scratch("before-loss.png"));
    assert!(before.pixels().any(|pixel| pixel.0[..3].iter().all(|&value| value > 140)), "there is text");
    for _ in 0..3 {
        bench.losses.0.store(true, Ordering::Relaxed);
        bench.graphics.resize(SIZE);
        bench.settle();
        let recovered = |reply: &GraphicsReply| matches!(reply, GraphicsReply::Recovered { .. });
        assert!(bench.take().iter().any(recovered));
    }
    let after = bench.capture(&scratch("after-loss.png"));
    assert_eq!(dragonfly_kit::picture::images::difference(&before, &after), 0);
}

#[test]
fn panels_without_a_device_are_dropped_without_an_error() {
    let none = DeviceParameters { backends: wgpu::Backends::empty(), ..DeviceParameters::default() };
    let mut bench = GraphicsBench::begin(none);
    let context = egui::Context::default();
    // Sent before the missing device is detected, and afterwards.
    bench.graphics.show_panels(panels(&context, "early"));
    bench.settle();
    assert!(matches!(&bench.take()[..], [GraphicsReply::Fatal(_)]), "the window must hear of it, to end");
    let context = egui::Context::default();
    bench.graphics.show_panels(panels(&context, "late"));
    bench.settle();
    // Also sent right before the thread ends, so that it is still in the queue.
    bench.graphics.show_panels(panels(&egui::Context::default(), "never"));
}

#[test]
fn a_request_is_answered_and_the_newest_camera_is_used() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    for distance in 1..50 {
        let camera = Camera {
            target: Vec3::Y * 1.5,
            distance: distance as f32,
            yaw: 0.0,
            pitch: 0.0,
            ..Camera::default()
        };
        bench.graphics.set_camera(camera);
    }
    bench.graphics.set_camera(Camera {
        target: Vec3::Y * 1.5,
        distance: 8.0,
        yaw: 0.0,
        pitch: 0.0,
        ..Camera::default()
    });
    // The middle of the viewport is the middle of the second bone.
    bench.graphics.pick([20.0 + 140.0, 10.0 + 90.0], 7);
    bench.settle();
    let picked = bench.take().into_iter().find_map(|reply| match reply {
        GraphicsReply::Picked { bone, ticket, .. } => Some((bone, ticket)),
        _ => None,
    });
    assert_eq!(picked, Some((Some(1), 7)));
}

#[test]
fn a_click_on_a_scene_is_answered_with_the_thing_and_its_bone() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    let scene = Some(scenes::view(&scenes::arms()));
    bench.graphics.show(View { scene, ..View::opened(1, arm::loaded()) });
    let camera = Camera {
        target: Vec3::new(-2.0, 1.5, 0.0),
        distance: 8.0,
        yaw: 0.0,
        pitch: 0.0,
        ..Camera::default()
    };
    bench.graphics.set_camera(camera);
    // The middle of the viewport is the middle of the second bone of the first arm.
    let middle = [20.0 + 140.0, 10.0 + 90.0];
    bench.graphics.pick(middle, 7);
    bench.graphics.pick_all(middle, 8);
    bench.graphics.catch(OwnedRegion::Box(Vec2::ZERO, Vec2::splat(1000.0)), 9);
    bench.settle();
    let thing = |id: &str, bone: Option<u32>| PickedThing { thing: id.into(), bone };
    let answers: Vec<_> = bench
        .take()
        .into_iter()
        .filter_map(|reply| match reply {
            GraphicsReply::Picked { bone, thing, ticket } => Some((bone, Vec::from_iter(thing), ticket)),
            GraphicsReply::PickedAll { bones, things, ticket } => {
                Some((bones.first().copied(), things, ticket))
            }
            _ => None,
        })
        .collect();
    let anna = || thing("anna", Some(1));
    let both = vec![thing("anna", None), thing("ben", None)];
    assert_eq!(answers, [(None, vec![anna()], 7), (None, vec![anna()], 8), (None, both, 9)]);
}

#[test]
fn pictures_of_shots_wait_while_something_moves_and_are_drawn_one_in_an_iteration() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    let view = scenes::view(&scenes::arms());
    let plan = view.plan.clone().unwrap();
    bench.graphics.show(View { scene: Some(view), ..View::opened(1, arm::loaded()) });
    let clock = PlaybackClock::of_scene(2.0, Instant::now());
    bench.graphics.play(PlaybackClock { playing: true, ..clock });
    for camera in ["wide", "close"] {
        let order = ThumbnailOrder { camera: camera.into(), time: 0.5, size: [48, 27] };
        bench.graphics.draw_thumbnail(order);
    }
    let thumbnails = |bench: &mut GraphicsBench| -> Vec<Thumbnail> {
        let drawn = bench.take().into_iter().filter_map(|reply| match reply {
            GraphicsReply::Thumbnail(thumbnail) => Some(thumbnail),
            _ => None,
        });
        drawn.collect()
    };
    for _ in 0..5 {
        bench.turn();
    }
    assert_eq!(thumbnails(&mut bench).len(), 0, "it plays");
    bench.graphics.play(clock);
    bench.turn();
    assert_eq!(thumbnails(&mut bench).len(), 1, "one, and then what else there is to do");
    bench.settle();
    let [thumbnail] = &thumbnails(&mut bench)[..] else { panic!("the other one") };
    assert_eq!(
        (&*thumbnail.order.camera, Arc::ptr_eq(thumbnail.plan.as_ref().unwrap(), &plan)),
        ("close", true)
    );
    assert_eq!(thumbnail.picture.as_ref().map(RgbaImage::dimensions), Some((48, 27)));
}

#[test]
fn a_model_is_shown_while_the_main_thread_is_blocked() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    let path = scratch("stalled.png");
    let before = bench.capture(&path);
    let heard = Received::<DocumentReply>::default();
    let replies = bench.main.context().register_receiver(heard.clone());
    let document = Document::start(replies, bench.graphics.views().clone()).unwrap();
    document.open(Source::BuiltIn);
    // From here on the main thread runs no iteration.
    eventually(Duration::from_secs(30), || {
        bench.graphics.capture(path.clone());
        bench.settle();
        let now = image::open(&path).unwrap().into_rgba8();
        dragonfly_kit::picture::images::difference(&before, &now) > 100
    });
    assert!(heard.0.borrow().is_empty());
    bench.main.iterate();
    assert!(
        heard.0.borrow().iter().any(|reply| matches!(reply, DocumentReply::View(_))),
        "then it hears of it"
    );
    document.stop();
    Thread::wait_for(&[document.thread().clone()], Instant::now() + Duration::from_secs(5)).unwrap();
}

#[test]
fn an_edited_take_looks_like_the_same_take_loaded_from_a_file() {
    let Some(mut bench) = GraphicsBench::with_arm() else { return };
    let opened = View::opened(1, arm::loaded());
    let still = Take { tracks: Vec::new(), ..Take::clone(&opened.takes[0]) };
    let changed = View { generation: 2, takes: [Arc::new(still.clone())].into(), ..opened.clone() };
    let mut model = ModelData::clone(&opened.loaded.model);
    model.animation.takes = vec![Arc::new(still)];
    let mut reopened = Arc::into_inner(arm::loaded()).unwrap();
    reopened.model = Arc::new(model);
    let end = PlaybackClock { take: Some(0), length: arm::LENGTH, ..PlaybackClock::rest(Instant::now()) };
    bench.graphics.play(end.seek(arm::LENGTH, end.anchor));
    let [bent, straight, like_that, again] =
        [opened.clone(), changed, View::opened(3, Arc::new(reopened)), opened].map(|view| {
            bench.graphics.show(view);
            bench.capture(&scratch("takes.png"))
        });
    assert!(dragonfly_kit::picture::images::difference(&bent, &straight) > 100);
    assert_eq!(dragonfly_kit::picture::images::difference(&straight, &like_that), 0);
    assert_eq!(dragonfly_kit::picture::images::difference(&bent, &again), 0);
}

#[test]
fn an_edited_take_keeps_the_gpu_resources_of_the_model() {
    let opened = View::opened(1, arm::loaded());
    let mut scene = Scene::new(Instant::now());
    let mut shown = |view: &View| {
        scene.show(view);
        scene.playback =
            PlaybackClock { take: Some(0), length: arm::LENGTH, ..PlaybackClock::rest(Instant::now()) };
        scene.playback = scene.playback.seek(arm::LENGTH, Instant::now());
        scene.prepare(Instant::now());
        let model = scene.model().unwrap();
        (Arc::as_ptr(model.loaded()), model.items().as_ptr(), model.to_root().to_vec())
    };
    let (model, items, bent) = shown(&opened);
    let still = Arc::new(Take { tracks: Vec::new(), ..Take::clone(&opened.takes[0]) });
    // The same number of takes as before, one more, and none.
    for takes in [vec![Arc::clone(&still)], vec![still; 2], Vec::new()] {
        let changed = View { generation: 2, takes: takes.into(), ..opened.clone() };
        let (same, kept, straight) = shown(&changed);
        assert_eq!((same, kept), (model, items), "nothing was made again, so nothing is uploaded");
        assert_ne!(straight, bent);
        assert_eq!(shown(&opened).2, bent);
    }
}
