//! Time from a mouse move until the graphics thread has the new pose: `cargo bench -p dragonfly --bench drag`.
//!
//! The three threads are those of the program and do the same work: the main thread handles the event of the window,
//! computes the pose and makes an edit of it; the document applies the edit and publishes its state; the scene receives
//! the state and is computed for it. Drawing would follow. The end time comes from the runtime's trace of the graphics
//! thread. `-- --record` writes `results/drag.csv` and the tables of `README.md`.

mod report;

use dragonfly::panels::commands::Id;
use dragonfly::panels::inbetween::{ChosenKeys, InBetweenTool};
use dragonfly::panels::keys::{KeyDragOp, KeysRequest};
use dragonfly::panels::{Effect, Request, Settings, State};
use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform,
};
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{
    Cancel, Change, Document, DocumentReply, LoadError, LoadedModel, OpenedModel, Progress, Setup, Source,
    View, open_model,
};
use dragonfly_kit::figures::FigureBench;
use dragonfly_picture::Look;
use dragonfly_picture::scene::Scene;
use dragonfly_runtime::{Address, Context, Next, Receiver, Thread, TraceEvent, TraceRecord, TraceSnapshot};
use dragonfly_store::{Autosave, RealFiles};
use glam::{Mat4, Quat, Vec3};
use std::cell::RefCell;
use std::path::Path;
use std::process::ExitCode;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Number of measured mouse moves.
const MOVES: usize = 2000;
/// Time between two moves: that of a common mouse.
const PAUSE: Duration = Duration::from_millis(4);
/// Allowed time at the 99th percentile.
const LIMIT: Duration = Duration::from_millis(4);
/// Allowed time where every key of a bone gets an offset: a frame at 60 frames per second.
const FRAME: Duration = Duration::from_millis(16);

/// A layer with three keys over ten minutes.
const LAYER: &[&str] = &[
    r#"{"edit":"add_layer","take":0,"name":"Turn"}"#,
    r#"{"edit":"set","take":{"take":0,"layer":0},"time":200,"poses":[{"bone":"bone 50","rotation":[0.6,0,0,0.8]}]}"#,
    r#"{"edit":"set","take":{"take":0,"layer":0},"time":400,"poses":[{"bone":"bone 50","rotation":[0,0.6,0,0.8]}]}"#,
];

/// The thing that the mouse drags.
#[derive(Clone, Copy)]
enum Dragged {
    /// A bone by its gizmo, with this scope of edits.
    Bone(Id),
    /// The slider of a tool, with all keys of the bone selected.
    Slider(InBetweenTool),
}

/// Name, model, bone, what is dragged, edits before the drag, and allowed time.
type DragCase = (&'static str, LoadFn, &'static str, Dragged, &'static [&'static str], Duration);

/// Fails if the 99th percentile of a model is above its limit.
fn main() -> ExitCode {
    let frame = Dragged::Bone(Id::EditFrame);
    let whole_take = Dragged::Bone(Id::EditWholeTake);
    let [smooth, push] = [InBetweenTool::Gaussian, InBetweenTool::Push].map(Dragged::Slider);
    let cases: [DragCase; 8] = [
        ("fox", fox, "b_Head_05", frame, &[], LIMIT),
        ("thousand_bones", thousand, "bone 500", frame, &[], LIMIT),
        ("whole_take_30", ten_minutes::<30>, "bone 50", whole_take, &[], FRAME),
        ("whole_take_120", ten_minutes::<120>, "bone 50", whole_take, &[], FRAME),
        ("layer_30", ten_minutes::<30>, "bone 50", frame, LAYER, FRAME),
        ("layer_120", ten_minutes::<120>, "bone 50", frame, LAYER, FRAME),
        ("push_30", ten_minutes::<30>, "bone 50", push, &[], FRAME),
        ("smooth_30", ten_minutes::<30>, "bone 50", smooth, &[], FRAME),
    ];
    FigureBench::run(&report::PAGE, "editor", "cargo bench -p dragonfly --bench drag", |bench| {
        bench.file("drag", |bench| {
            for (name, load, bone, dragged, edits, limit) in cases {
                if bench.wants(name) {
                    bench.times(name, "move", &measure(load, bone, dragged, edits));
                    bench.goal(name, "move", "p99", "ms", milliseconds(limit));
                }
            }
        });
    })
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

type LoadFn = fn(&Source, &mut dyn FnMut(Progress), &Cancel) -> Result<OpenedModel, LoadError>;

fn fox(_: &Source, tell: &mut dyn FnMut(Progress), cancel: &Cancel) -> Result<OpenedModel, LoadError> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb");
    open_model(&Source::File(path), tell, cancel)
}

/// Returns a tree of a thousand bones, each with two keys per frame for two seconds.
fn thousand(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(tree(1000, 2, 60).into())
}

/// Returns a tree of a hundred bones with ten minutes of keys.
fn ten_minutes<const PER_SECOND: u32>(
    _: &Source,
    _: &mut dyn FnMut(Progress),
    _: &Cancel,
) -> Result<OpenedModel, LoadError> {
    Ok(tree(100, 600, PER_SECOND).into())
}

fn tree(bones: u32, seconds: u32, keys_per_second: u32) -> LoadedModel {
    let bone = |index: u32| Bone {
        name: format!("bone {index}"),
        parent: index.checked_sub(1).map(|before| before / 2),
        rest: Transform { translation: Vec3::new((index % 2) as f32 - 0.5, 1.0, 0.1), ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    let keys = seconds * keys_per_second;
    let times: Arc<[f32]> = (0..=keys).map(|key| key as f32 / keys_per_second as f32).collect();
    let track = |bone: u32| {
        let turn = |time: &f32| Quat::from_rotation_z((time * 3.0 + bone as f32).sin() * 0.2);
        let values = times.iter().map(turn).collect::<Vec<_>>();
        Track {
            bone,
            rotation: Channel::new(Arc::clone(&times), values, Interpolation::Linear),
            ..Track::default()
        }
    };
    let tracks = (0..bones).map(track).collect();
    let take =
        Take { name: "Sway".to_owned(), start: 0.0, length: seconds as f32, tracks, ..Take::default() };
    let skeleton = Arc::new(Skeleton { bones: (0..bones).map(bone).collect() });
    let model = Arc::new(ModelData {
        animation: AnimationData { skeleton, takes: vec![Arc::new(take)] },
        ..ModelData::default()
    });
    LoadedModel {
        conversion: Default::default(),
        bounds: bounds_of_pose(&model, None, 0.0),
        title: "Tree".to_owned(),
        path: None,
        format: None,
        model,
        images: ImageSurvey::default(),
        warnings: Vec::new(),
        notes: Vec::new(),
    }
}

/// Does the work of the graphics thread before it draws, then sends [`ViewTaken`], so that the next move can follow.
struct SceneReceiver(Scene, Address<ViewTaken>);

/// Sent when a view was received.
struct ViewTaken;

impl Receiver for SceneReceiver {
    type Message = View;

    fn receive(&mut self, view: View, thread: &mut Context) {
        self.0.show(&view);
        self.0.prepare(thread.now());
        let _ = self.1.send(ViewTaken);
    }

    fn name(&self) -> &str {
        "picture"
    }
}

#[derive(Clone, Default)]
struct ReplyLog(Rc<RefCell<Vec<DocumentReply>>>);

impl Receiver for ReplyLog {
    type Message = DocumentReply;

    fn receive(&mut self, reply: DocumentReply, _: &mut Context) {
        self.0.borrow_mut().push(reply);
    }
}

/// Counts the received views.
#[derive(Clone, Default)]
struct Counted(Rc<RefCell<usize>>);

impl Receiver for Counted {
    type Message = ViewTaken;

    fn receive(&mut self, _: ViewTaken, _: &mut Context) {
        *self.0.borrow_mut() += 1;
    }
}

struct Traces(Rc<RefCell<Option<TraceSnapshot>>>);

impl Receiver for Traces {
    type Message = TraceSnapshot;

    fn receive(&mut self, trace: TraceSnapshot, _: &mut Context) {
        *self.0.borrow_mut() = Some(trace);
    }
}

/// Drags a bone or a slider, after some edits; in the lowest layer where there is one. Returns the milliseconds of each move.
fn measure(load: LoadFn, bone: &str, dragged: Dragged, edits: &[&str]) -> Vec<f64> {
    let heard = ReplyLog::default();
    let traced = Rc::new(RefCell::new(None));
    // As in the window, the main thread sleeps until it is woken, so it does not use a CPU core.
    let own_thread = std::thread::current();
    let mut main = Thread::capture("main", move || own_thread.unpark());
    let graphics = Thread::start("graphics").expect("a thread");
    let replies = main.context().register_receiver(heard.clone());
    let traces: Address<TraceSnapshot> = main.context().register_receiver(Traces(Rc::clone(&traced)));
    let count = Counted::default();
    let taken = main.context().register_receiver(count.clone());
    let pictures = graphics.handle().reserve_address();
    let own = pictures.clone();
    graphics
        .handle()
        .run(move |context: &mut Context| {
            let mut scene = Scene::new(Instant::now());
            scene.look = Look { viewport: [0, 0, 1280, 720], skeleton: true, ..Look::default() };
            context.register_receiver_at(&own, SceneReceiver(scene, taken));
            context.set_trace(MOVES * 8);
        })
        .expect("it runs");
    // The journal is written to a disk, as in the program.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("drag-{}", std::process::id()));
    let autosave = Autosave::new(Arc::new(RealFiles), Some(folder.clone())).expect("a folder is given");
    let setup = Setup { load, autosave: Some(autosave), ..Setup::default() };
    let document = Document::start_with(setup, replies, pictures).expect("a thread");
    let mut state = State::new(Settings::default(), Instant::now());
    let rect = egui::Rect::from_min_size(egui::pos2(240.0, 30.0), egui::vec2(800.0, 500.0));
    state.execute(Request::Viewport(rect));
    document.open(Source::BuiltIn);
    let mut turn = |state: &mut State| {
        while main.iterate() == Next::Now {}
        let mut came = 0;
        for reply in heard.0.take() {
            match reply {
                DocumentReply::View(view) => {
                    state.show(view);
                    came += 1;
                }
                DocumentReply::Refused(reason) | DocumentReply::Failed { reason, .. } => panic!("{reason}"),
                _ => {}
            }
        }
        came
    };
    while turn(&mut state) == 0 && state.read().view.is_none() || *count.0.borrow() == 0 {
        std::thread::park_timeout(Duration::from_millis(1));
    }
    let bones = &state.read().loaded().expect("open").model.animation.skeleton.bones;
    let bone = bones.iter().position(|other| other.name == bone).expect("there is such a bone");
    for edit in edits {
        document.change(Change::Edit(serde_json::from_str(edit).expect("an edit"), None));
        while turn(&mut state) == 0 {
            std::thread::park_timeout(Duration::from_millis(1));
        }
    }
    let layer = state.read().layers().first().map(|layer| layer.keys.id);
    state.execute(Request::ChooseLayer(layer));
    let views = *count.0.borrow();
    state.pause();
    state.execute(Request::Select(Some(bone as u32)));
    state.begin_frame(Instant::now());
    match dragged {
        Dragged::Bone(scope) => {
            state.execute(Request::Command(scope));
            state.execute(Request::Command(Id::RotateNow));
        }
        Dragged::Slider(_) => drop(state.execute(Request::Command(Id::SelectAllKeys))),
    }

    let context = egui::Context::default();
    let mut effects = Vec::new();
    let mut moved = Vec::with_capacity(MOVES);
    for index in 0..MOVES {
        let (sin, cos) = (index as f32 * 0.03).sin_cos();
        let at = rect.center() + egui::vec2(cos, sin) * 150.0;
        let mut input = egui::RawInput { events: vec![egui::Event::PointerMoved(at)], ..Default::default() };
        moved.push(Instant::now());
        match dragged {
            Dragged::Bone(_) => {
                state.feed(&context, &mut input, 0, &mut effects);
            }
            Dragged::Slider(tool) => {
                let keys = ChosenKeys::of(&state.read(), 1, None).expect("selected keys");
                let edit = tool.edit(5.0 + f64::from(sin), &keys).expect("an edit");
                let request = Request::Timeline(KeysRequest::Drag(KeyDragOp::Edit(edit)));
                effects.extend(state.execute(request));
            }
        }
        for effect in effects.drain(..) {
            state.let_through(effect, &mut |effect| {
                if let Effect::Send(number, change) = effect {
                    document.change_numbered(number, change);
                }
            });
        }
        // The next move is sent only after this one has arrived, so that each has a state of its own.
        let mut came = 0;
        loop {
            came += turn(&mut state);
            if came > 0 && *count.0.borrow() > index + views {
                break;
            }
            std::thread::park_timeout(Duration::from_secs(1));
        }
        // The program draws its panels here; the bench only lets the viewport tools find the bone.
        state.begin_frame(Instant::now());
        let end = moved[index] + PAUSE;
        while let Some(left) = end.checked_duration_since(Instant::now()) {
            std::thread::park_timeout(left);
        }
    }
    graphics.handle().request_trace(&traces);
    while traced.borrow().is_none() {
        turn(&mut state);
    }
    let trace = traced.borrow_mut().take().expect("told");
    let ends: Vec<Instant> = trace.records.iter().filter_map(arrived).collect();
    assert!(ends.len() >= MOVES, "{} views came for {MOVES} moves", ends.len());
    let ways = moved.iter().zip(&ends[ends.len() - MOVES..]);
    let took = ways.map(|(from, to)| milliseconds(to.saturating_duration_since(*from))).collect();
    document.stop();
    // The files are not needed any more; an error leaves them in a temporary folder.
    let _ = std::fs::remove_dir_all(folder);
    took
}

/// Returns the time at which a view was received and the scene was computed for it.
fn arrived(record: &TraceRecord) -> Option<Instant> {
    match &record.event {
        TraceEvent::Message { to, .. } if &**to == "picture" => Some(record.at + record.took),
        _ => None,
    }
}
