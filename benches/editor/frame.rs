//! A frame of the editor with models of growing size: milliseconds and allocations of each thread, and draw calls.
//!
//! One thread does the work of all three, so that the time and the allocations of each can be measured: the main
//! thread builds and tessellates the panels, the document applies an edit and publishes a view, the graphics thread
//! computes the scene and records the frame. The time of the driver is measured separately, because without a GPU the
//! driver draws.

use super::timeline::cpu;
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Desk, Effect, Request, Settings, State, style};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::bones::Choice;
use dragonfly_document::history::Edited;
use dragonfly_document::{Change, LoadedModel, View};
use dragonfly_kit::counting;
use dragonfly_kit::document::large;
use dragonfly_kit::figures::{FigureBench, percentile};
use dragonfly_picture::pick::pick;
use dragonfly_picture::stage::{FrameOpening, RenderStage};
use dragonfly_picture::{DeviceParameters, Look};
use egui::{Event, MouseWheelSource, MouseWheelUnit, Pos2, TouchPhase, pos2, vec2};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Measured frames of each case.
const FRAMES: usize = 120;
/// One frame in this number is presented.
const PRESENTED: u64 = 15;
/// Size of the drawn scene: small, because a software adapter draws it.
const SIZE: [u32; 2] = [320, 200];

/// What the user does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Action {
    Orbiting,
    Playing,
    Hovering,
    Scrolling,
    DraggingOne,
    DraggingAll,
}

const ACTIONS: [(Action, &str); 6] = [
    (Action::Orbiting, "orbiting"),
    (Action::Playing, "playing"),
    (Action::Hovering, "hovering"),
    (Action::Scrolling, "scrolling the skeleton"),
    (Action::DraggingOne, "dragging a bone"),
    (Action::DraggingAll, "dragging all bones"),
];

/// Parts of a frame that are measured apart.
const PARTS: [&str; 4] = ["main", "document", "graphics", "driver"];

type MakeModel = fn() -> Arc<LoadedModel>;

/// Measures every case.
pub(crate) fn all(bench: &mut FigureBench) {
    let made: [(&str, MakeModel); 4] = [
        ("200 bones", || large::tree(200)),
        ("2000 bones", || large::tree(2_000)),
        ("20000 bones", || large::tree(20_000)),
        ("1000 meshes", || large::meshes(1_000)),
    ];
    for (model, make) in made {
        for (action, doing) in ACTIONS {
            let task = format!("{model}/{doing}");
            if bench.wants(&task) {
                measure(bench, &task, make(), action);
            }
        }
    }
}

/// Time and allocations of one part in each frame.
#[derive(Default)]
struct Costs {
    milliseconds: Vec<f64>,
    allocations: Vec<f64>,
    bytes: Vec<f64>,
}

impl Costs {
    fn add<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let begin = cpu();
        let (count, result) = counting::count(work);
        self.milliseconds.push((cpu() - begin).as_secs_f64() * 1e3);
        self.allocations.push(count.allocations as f64);
        self.bytes.push(count.bytes as f64);
        result
    }
}

fn measure(bench: &mut FigureBench, task: &str, loaded: Arc<LoadedModel>, action: Action) {
    let Some(mut program) = Program::new(loaded, action) else {
        eprintln!("{task}: no graphics adapter");
        return;
    };
    for _ in 0..20 {
        program.frame(&mut Default::default());
    }
    let mut parts: [Costs; 4] = Default::default();
    for _ in 0..FRAMES {
        program.frame(&mut parts);
    }
    for (part, costs) in PARTS.into_iter().zip(&parts) {
        if !costs.milliseconds.is_empty() {
            bench.times(task, part, &costs.milliseconds);
            bench.value(task, part, "allocations", "count", percentile(&costs.allocations, 50));
            bench.value(task, part, "allocated", "bytes", percentile(&costs.bytes, 50));
        }
    }
    bench.value(task, "driver", "draws", "count", program.stage.draw_calls() as f64);
}

/// The parts of the program, without a window.
struct Program {
    action: Action,
    context: egui::Context,
    desk: Desk,
    state: State,
    edited: Edited,
    view: View,
    stage: RenderStage,
    begin: Instant,
    frame: u64,
}

impl Program {
    /// Returns `None` where there is no adapter.
    fn new(loaded: Arc<LoadedModel>, action: Action) -> Option<Self> {
        let begin = Instant::now();
        let mut stage = RenderStage::new(DeviceParameters::default(), begin).ok()?;
        let view = View::opened(1, Arc::clone(&loaded));
        let context = egui::Context::default();
        style::install(&context);
        let mut state = State::new(Settings::default(), begin);
        state.show(view.clone());
        stage.resize(SIZE);
        stage.scene.show(&view);
        let edited = Edited::new(ModelAdapter::new(&loaded.model.animation));
        let mut program =
            Self { action, context, desk: Desk::new(""), state, edited, view, stage, begin, frame: 0 };
        let bones = loaded.model.animation.skeleton.len() as u32;
        if action != Action::Playing {
            program.state.pause();
        }
        let selected = match action {
            Action::DraggingAll => (0..bones).collect(),
            Action::Playing | Action::DraggingOne | Action::Scrolling => vec![bones / 2],
            Action::Orbiting | Action::Hovering => Vec::new(),
        };
        program.state.execute(Request::SelectBones(selected, Choice::Replace));
        // Loads fonts and lays out the panels, which takes several frames.
        for _ in 0..10 {
            program.draw_panels();
        }
        if matches!(action, Action::DraggingOne | Action::DraggingAll) {
            program.state.execute(Request::Command(Id::RotateNow));
        }
        Some(program)
    }

    /// Runs one frame of every thread.
    fn frame(&mut self, [main, document, graphics, driver]: &mut [Costs; 4]) {
        self.frame += 1;
        let changes = main.add(|| self.main());
        if !changes.is_empty() {
            let view = document.add(|| self.document(changes));
            main.add(|| self.state.show(view.clone()));
            // Both belong to one frame of the main thread.
            merge(main);
            self.view = view;
        }
        graphics.add(|| self.record());
        // Most frames are dropped when they are recorded: drawing without a GPU takes too long for every frame.
        if self.frame.is_multiple_of(PRESENTED) {
            driver.add(|| assert!(self.stage.present(), "the frame is whole"));
        }
    }

    fn now(&self) -> Instant {
        self.begin + Duration::from_micros(16_667 * self.frame)
    }

    /// Handles the input and draws the panels. Returns the changes for the document.
    fn main(&mut self) -> Vec<(u64, Change)> {
        let (sin, cos) = (self.frame as f32 * 0.1).sin_cos();
        let mut effects = Vec::new();
        match self.action {
            Action::Orbiting => {
                let mut camera = self.state.read().camera;
                camera.yaw += 0.01;
                self.state.execute(Request::Camera(camera));
            }
            Action::DraggingOne | Action::DraggingAll => {
                let at = self.state.read().viewport.center() + vec2(cos, sin) * 150.0;
                let mut input =
                    egui::RawInput { events: vec![Event::PointerMoved(at)], ..Default::default() };
                self.state.feed(&self.context, &mut input, 0, &mut effects);
            }
            Action::Playing | Action::Hovering | Action::Scrolling => {}
        }
        let mut changes = Vec::new();
        for effect in effects {
            self.state.let_through(effect, &mut |effect| {
                if let Effect::Send(number, change) = effect {
                    changes.push((number, change));
                }
            });
        }
        self.draw_panels();
        changes
    }

    fn draw_panels(&mut self) {
        let events = match self.action {
            Action::Scrolling => {
                let delta = vec2(0.0, if self.frame % 40 < 20 { -90.0 } else { 90.0 });
                let (unit, phase) = (MouseWheelUnit::Point, TouchPhase::Move);
                let source = MouseWheelSource::Unknown;
                let modifiers = egui::Modifiers::default();
                let wheel = Event::MouseWheel { unit, delta, phase, source, modifiers };
                vec![Event::PointerMoved(self.over_skeleton()), wheel]
            }
            Action::Orbiting
            | Action::Playing
            | Action::Hovering
            | Action::DraggingOne
            | Action::DraggingAll => Vec::new(),
        };
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(Pos2::ZERO, vec2(1920.0, 1080.0))),
            time: Some(self.frame as f64 / 60.0),
            events,
            ..egui::RawInput::default()
        };
        let now = self.now();
        let mut requests = Vec::new();
        self.state.begin_frame(now);
        let (desk, state) = (&mut self.desk, &self.state.read());
        let mut output = self.context.run_ui(input, |ui| desk.show(ui, state, &mut requests));
        let shapes = std::mem::take(&mut output.shapes);
        std::hint::black_box(self.context.tessellate(shapes, output.pixels_per_point));
        output.textures_delta.clear();
        self.state.end_frame();
        for request in requests {
            self.state.execute(request);
        }
    }

    /// Returns a position over the rows of the skeleton's tree.
    fn over_skeleton(&self) -> Pos2 {
        let viewport = self.state.read().viewport;
        pos2(viewport.left() / 2.0, viewport.center().y)
    }

    /// Applies the changes and returns the view after them.
    fn document(&mut self, changes: Vec<(u64, Change)>) -> View {
        let mut answered = 0;
        for (number, change) in changes {
            answered = number;
            if let Change::Edit(edit, gesture) = change {
                self.edited.apply(edit, gesture).expect("the panels make edits that fit");
            }
        }
        let adapter = self.edited.adapter();
        View {
            generation: self.view.generation + 1,
            answered,
            takes: adapter.results().cloned().collect(),
            slots: adapter.slots().into(),
            ..self.view.clone()
        }
    }

    /// Computes the scene and records the passes.
    fn record(&mut self) {
        let now = self.now();
        if !Arc::ptr_eq(&self.view.takes, &self.stage.scene.view().expect("shown").takes) {
            self.stage.scene.show(&self.view);
        }
        let panels = self.state.read();
        let scene = &mut self.stage.scene;
        scene.camera = panels.camera;
        scene.playback = panels.playback;
        scene.look = Look {
            viewport: [0, 0, SIZE[0], SIZE[1]],
            skeleton: true,
            selected: panels.selection.bones().to_vec(),
            ..Look::default()
        };
        if self.action == Action::Hovering {
            let (sin, cos) = (self.frame as f32 * 0.3).sin_cos();
            let [width, height] = SIZE.map(|side| side as f32 / 2.0);
            scene.prepare(now);
            let bone = pick(scene, [width + cos * width * 0.5, height + sin * height * 0.5]);
            scene.look.hovered = bone;
        }
        self.stage.touch_scene();
        assert!(matches!(self.stage.open(now), FrameOpening::Frame), "the device works");
        for pass in self.stage.passes().to_vec() {
            assert!(self.stage.draw(&mut *pass.borrow_mut()), "the device works");
        }
    }
}

/// Adds the last measurement to the one before it.
fn merge(costs: &mut Costs) {
    fn join(list: &mut Vec<f64>) {
        if let Some(last) = list.pop()
            && let Some(before) = list.last_mut()
        {
            *before += last;
        }
    }
    join(&mut costs.milliseconds);
    join(&mut costs.allocations);
    join(&mut costs.bytes);
}
