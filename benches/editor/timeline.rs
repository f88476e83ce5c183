//! A frame of the timeline and the curves, and of all other panels around them, with 200 bones × 10 minutes × 120
//! frames per second: about 43 million keys. Measures the CPU time of the window's thread: building the frame,
//! tessellating it, and processing its requests, edits included.
//!
//! `DRAGONFLY_BENCH_KEYS` reduces the ten minutes to a fraction, 0 to 1, for a machine with little memory.

use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{ChannelId, KeyDragOp, KeysRequest, TimeWindow};
use dragonfly::panels::{Desk, Effect, Request, Settings, State, style};
use dragonfly_anim::bounds::Bounds;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform,
};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::history::Edited;
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{Change, LoadedModel, View};
use dragonfly_kit::figures::FigureBench;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

const BONES: u32 = 200;
const RATE: f32 = 120.0;
const SECONDS: f32 = 600.0;
const FRAMES: usize = 400;
/// Part of the ten minutes in which keys are dragged.
const DRAGGED_PART: f32 = 0.2;
/// Number of views that are received while keys are dragged.
const VIEWS: usize = 20;
/// Largest number of frames of a drag.
const MOST_FRAMES: usize = 20_000;

/// Measures every case.
pub(crate) fn all(bench: &mut FigureBench) {
    let view = view(1.0);
    let keys: usize = view.takes.iter().map(|take| take.keys()).sum();
    bench.value("take", "", "keys", "count", keys as f64);
    let length = f64::from(view.takes[0].length);
    let whole = TimeWindow { start: 0.0, length };
    let middle = TimeWindow { start: length * 0.4, length: length / 60.0 };
    for (name, bones) in
        [("nothing selected", vec![]), ("one bone", vec![7]), ("eight bones", (3..11).collect())]
    {
        let mut window = PanelsWindow::new(&view, &bones);
        window.measure(bench, "whole take", name, |_, _| {});
        window.measure(bench, "zooming", name, |at, state| {
            let part = 1.0 - 0.5 * (at as f64 / FRAMES as f64);
            show(state, TimeWindow { start: 0.0, length: whole.length * part });
        });
        window.measure(bench, "panning", name, |at, state| {
            show(state, middle.panned(at as f64 * 0.01));
        });
        show(&mut window.state, whole);
        window.state.execute(Request::Command(Id::PlayPause));
        window.measure(bench, "playing", name, |_, _| {});
        window.state.execute(Request::Command(Id::PlayPause));
    }
    drop(view);
    // The document answers an edit of the whole take after more frames than are measured.
    let view = self::view(DRAGGED_PART);
    let length = f64::from(view.takes[0].length);
    for (name, start, length) in
        [("the take", 0.0, length), ("a sixtieth of the take", length * 0.4, length / 60.0)]
    {
        drag(bench, &view, TimeWindow { start, length }, name);
    }
}

/// Drags 100,000 selected keys, while the document answers from a thread of its own.
fn drag(bench: &mut FigureBench, view: &View, zoom: TimeWindow, name: &str) {
    let (ask, asked) = channel::<(u64, Change)>();
    let (answer, answers) = channel::<View>();
    let first = view.clone();
    std::thread::scope(|scope| {
        scope.spawn(move || document(first, &asked, &answer));
        drag_keys(bench, view, zoom, name, ask, &answers);
    });
}

fn drag_keys(
    bench: &mut FigureBench,
    view: &View,
    zoom: TimeWindow,
    name: &str,
    ask: Sender<(u64, Change)>,
    answers: &Receiver<View>,
) {
    let mut window = PanelsWindow::new(view, &[3, 4, 5]);
    let take = Arc::clone(&view.takes[0]);
    show(&mut window.state, zoom);
    window.state.execute(Request::Timeline(KeysRequest::OnlySelected(false)));
    let channels: Arc<[ChannelId]> = take
        .tracks
        .iter()
        .flat_map(|track| dragonfly::panels::keys::channel::channels(&take, track.bone))
        .collect();
    // The number of frames in which all channels have 100,000 keys.
    let frames = 100_000 / channels.len() as u32;
    let from = (zoom.start + zoom.length * 0.3) as f32;
    let stretch = [from, from + frames as f32 / RATE];
    let choice = dragonfly_document::bones::Choice::Replace;
    window.state.execute(Request::Timeline(KeysRequest::Select { channels, shapes: false, stretch, choice }));
    let selected = window.state.read().keys.selection().count(&take);
    let mut shown = Vec::new();
    let mut edits = 0_u32;
    let (mut times, mut effects) = (Vec::new(), Vec::new());
    while times.len() < FRAMES || shown.len() < VIEWS && times.len() < MOST_FRAMES {
        for effect in effects.drain(..) {
            let mut passed = Vec::new();
            window.state.let_through(effect, &mut |effect| passed.push(effect));
            for effect in passed {
                let Effect::Send(number, change) = effect else { continue };
                edits += 1;
                // Does not fail: the document's thread runs until the bench ends.
                let _ = ask.send((number, change));
            }
        }
        if let Some(view) = newest(answers) {
            let begin = cpu();
            window.state.show(view);
            shown.push((cpu() - begin).as_secs_f64() * 1e3);
        }
        let at = times.len() as f32;
        let by = (at * 0.05).sin() * (zoom.length as f32 * 0.1) + at * 0.01;
        let request = Request::Timeline(KeysRequest::Drag(KeyDragOp::Move(by)));
        times.push(window.timed_frame(Some(request), &mut effects));
    }
    drop(ask);
    bench.times("dragging", name, &times);
    bench.times("receiving a view", name, &shown);
    bench.value("dragging", name, "keys", "count", selected as f64);
    bench.value("dragging", name, "edits", "count", f64::from(edits));
}

fn newest(answers: &Receiver<View>) -> Option<View> {
    answers.try_iter().last()
}

/// Answers edits until their sender is dropped.
fn document(first: View, asked: &Receiver<(u64, Change)>, answer: &Sender<View>) {
    let mut edited = Edited::new(ModelAdapter::new(&first.loaded.model.animation));
    let mut generation = first.generation;
    while let Ok((answered, change)) = asked.recv() {
        let done = match change {
            Change::Edit(edit, gesture) => edited.apply(edit, gesture).is_ok(),
            Change::Cancel(gesture) => edited.cancel(gesture),
            _ => false,
        };
        generation += u64::from(done);
        let view = View {
            generation,
            answered,
            takes: edited.adapter().results().cloned().collect(),
            slots: edited.adapter().slots().into(),
            ..first.clone()
        };
        if answer.send(view).is_err() {
            return;
        }
    }
}

fn show(state: &mut State, window: TimeWindow) {
    state.execute(Request::Timeline(KeysRequest::Window(Some(window))));
}

/// The panels without a window.
struct PanelsWindow {
    context: egui::Context,
    desk: Desk,
    state: State,
    begin: Instant,
    frame: u64,
}

impl PanelsWindow {
    fn new(view: &View, bones: &[u32]) -> Self {
        let context = egui::Context::default();
        style::install(&context);
        let mut state = State::new(Settings::default(), Instant::now());
        state.show(view.clone());
        state.pause();
        let choice = dragonfly_document::bones::Choice::Replace;
        state.execute(Request::SelectBones(bones.to_vec(), choice));
        let mut window = Self { context, desk: Desk::new(""), state, begin: Instant::now(), frame: 0 };
        // Loads fonts, lays out the panels, and computes curves, which takes several frames.
        for _ in 0..60 {
            window.frame(None);
        }
        window
    }

    /// Runs one frame, with a pointer that rests on the keys.
    fn frame(&mut self, more: Option<Request>) -> Vec<Effect> {
        self.frame += 1;
        let now = self.begin + Duration::from_micros(16_667 * self.frame);
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1920.0, 1080.0))),
            time: Some(self.frame as f64 / 60.0),
            events: vec![egui::Event::PointerMoved(egui::pos2(600.0 + (self.frame % 7) as f32, 900.0))],
            ..egui::RawInput::default()
        };
        let mut requests = Vec::from_iter(more);
        self.state.begin_frame(now);
        let (desk, state) = (&mut self.desk, &self.state.read());
        let mut output = self.context.run_ui(input, |ui| desk.show(ui, state, &mut requests));
        let shapes = std::mem::take(&mut output.shapes);
        std::hint::black_box(self.context.tessellate(shapes, output.pixels_per_point));
        output.textures_delta.clear();
        self.state.end_frame();
        requests.into_iter().filter_map(|request| self.state.execute(request)).collect()
    }

    fn measure(
        &mut self,
        bench: &mut FigureBench,
        task: &str,
        variant: &str,
        mut before: impl FnMut(usize, &mut State),
    ) {
        if !bench.wants(task) {
            return;
        }
        let mut times = Vec::with_capacity(FRAMES);
        for at in 0..FRAMES {
            before(at, &mut self.state);
            times.push(self.timed_frame(None, &mut Vec::new()));
        }
        bench.times(task, variant, &times);
    }

    /// Runs one frame and adds its effects. Returns its milliseconds.
    fn timed_frame(&mut self, request: Option<Request>, effects: &mut Vec<Effect>) -> f64 {
        let begin = cpu();
        effects.extend(self.frame(request));
        (cpu() - begin).as_secs_f64() * 1e3
    }
}

/// Returns the CPU time of this thread.
#[cfg(unix)]
pub(crate) fn cpu() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Returns the elapsed time, on systems without CPU times.
#[cfg(not(unix))]
pub(crate) fn cpu() -> Duration {
    static BEGIN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed()
}

/// Returns bones in a chain, with a column of times for every channel; `length` is a part of the ten minutes.
fn view(length: f32) -> View {
    let part = std::env::var("DRAGONFLY_BENCH_KEYS").ok().and_then(|part| part.parse::<f32>().ok());
    let keys = (SECONDS * RATE * length * part.unwrap_or(1.0).clamp(0.001, 1.0)) as usize;
    let bones = (0..BONES).map(|index| Bone {
        name: format!("bone_{index:03}"),
        parent: index.checked_sub(1),
        rest: Transform { translation: Vec3::Y * 0.1, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    });
    let times = || (0..keys).map(|key| key as f32 / RATE).collect::<Arc<[f32]>>();
    let wave = |key: usize, bone: u32| (key as f32 * 0.01 + bone as f32).sin();
    let tracks = (0..BONES).map(|bone| Track {
        bone,
        translation: Channel {
            times: times(),
            values: (0..keys).map(|key| Vec3::new(wave(key, bone), 0.1, 0.0)).collect(),
            interpolation: Interpolation::Linear,
        },
        rotation: Channel {
            times: times(),
            values: (0..keys).map(|key| Quat::from_rotation_x(wave(key, bone))).collect(),
            interpolation: Interpolation::Linear,
        },
        scale: Channel {
            times: times(),
            values: (0..keys).map(|key| Vec3::ONE + 0.1 * wave(key, bone)).collect(),
            interpolation: Interpolation::Linear,
        },
    });
    let length = (keys - 1) as f32 / RATE;
    let take = Take {
        name: "motion capture".to_owned(),
        start: 0.0,
        length,
        tracks: tracks.collect(),
        ..Take::default()
    };
    let animation = AnimationData {
        skeleton: Arc::new(Skeleton { bones: bones.collect() }),
        takes: vec![Arc::new(take)],
    };
    let model = Arc::new(ModelData { animation, ..ModelData::default() });
    let loaded = LoadedModel {
        conversion: Default::default(),
        title: "large.glb".to_owned(),
        path: None,
        format: Some(dragonfly_anim::format::gltf::GLB),
        bounds: Bounds { min: -Vec3::ONE, max: Vec3::ONE, ..Bounds::default() },
        model,
        images: ImageSurvey::default(),
        warnings: Vec::new(),
        notes: Vec::new(),
    };
    View::opened(1, Arc::new(loaded))
}
