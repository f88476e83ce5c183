//! The stage: a frame of a hundred roles, and a script of ten thousand actions.
//!
//! Goals: a frame in less than 1 ms and a script in less than 50 ms, each on one core.

use crate::Section;
use crate::case::BenchCase;
use dragonfly_anim::data::{Mesh, MeshInstance, ModelData, Primitive, Vertices};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::stage::schedule::resolve;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan};
use glam::{Mat4, Vec3};
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Number of roles of a frame.
const ROLES: usize = 100;

/// Number of actions of a large script.
const ACTIONS: usize = 10_000;

/// A ground that is a mesh.
const HILL: &str = "<prop id=\"hill\" model=\"hill.glb\" ground=\"yes\"/>";

/// A model, and how its roles act.
struct StageBench {
    model: Arc<StageModel>,
    /// A take for the roles to play, and one that walks.
    takes: [String; 2],
}

impl StageBench {
    /// Reads the rig of 67 bones.
    fn rig() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/bench/pab.glb");
        let bytes = std::fs::read(path).expect("the bench rig");
        let model = read("pab.glb", &bytes, &NoFiles, &ReadOptions::default()).expect("a model").model;
        let model = Arc::new(StageModel::new(Arc::new(model)));
        let walks = model.takes().iter().find(|take| take.stride_speed().is_some()).or(model.takes().first());
        let walks = walks.map_or(String::new(), |take| take.name().to_owned());
        let takes = [model.takes()[0].name().to_owned(), walks];
        Self { model, takes }
    }

    fn assets(&self) -> StageAssets {
        let mut assets = StageAssets::default();
        assets.add_model("hill.glb", Arc::new(StageModel::new(Arc::new(hill()))));
        assets.add_model("a.glb", Arc::clone(&self.model));
        assets
    }

    /// Returns a plan in which each role does `actions` of its own.
    fn plan(&self, actions: impl Fn(usize, &str) -> String) -> StagePlan {
        self.plan_on("", actions)
    }

    /// Returns such a plan with a ground among its cast.
    fn plan_on(&self, ground: &str, actions: impl Fn(usize, &str) -> String) -> StagePlan {
        let path = "<path id=\"p\" curve=\"smooth\" points=\"0 0 0  4 0 0  6 0 3  9 0 3\"/>";
        let mut text = format!("<script version=\"1\"><cast>{ground}{path}");
        for role in 0..ROLES {
            let _ = write!(text, "<role id=\"r{role}\" model=\"a.glb\" at=\"{role} 0 0\"/>");
        }
        text.push_str("</cast>");
        for role in 0..ROLES {
            text.push_str(&actions(role, &format!("who=\"r{role}\"")));
        }
        text.push_str("</script>");
        let script = StageScript::read(text).expect("a script");
        StagePlan::new(&script, &self.assets()).expect("a plan")
    }

    fn about(&self) -> String {
        let [plays, walks] = &self.takes;
        format!("stage: {ROLES} roles of {} bones; take {plays}, on paths {walks}", self.model.rig().bones())
    }
}

/// Returns the section of the stage.
pub(crate) fn section() -> Section {
    let later: &'static OnceLock<StageBench> = Box::leak(Box::default());
    let bench = move || later.get_or_init(StageBench::rig);
    let frame = |case: &str, plan: fn(&StageBench) -> StagePlan| {
        BenchCase::new("stage", format!("frame/pab/{ROLES}/{case}"), ROLES, "role", move || {
            let plan = plan(bench());
            let mut scene = plan.new_scene();
            let mut number = 0;
            move || {
                // Any frame costs the same; neighbors have no advantage.
                number = (number * 7 + 13) % 101;
                plan.frame(number, &mut scene);
                black_box(&scene);
            }
        })
    };
    let cases = vec![
        frame("play", |bench| {
            bench.plan(|role, who| {
                format!("<play {who} take=\"{}\" repeat=\"fill\" begin=\"-0.0{role}\"/>", bench.takes[0])
            })
        }),
        frame("fade", |bench| {
            bench.plan(|_, who| {
                let [plays, walks] = &bench.takes;
                format!("<play {who} take=\"{plays}\" repeat=\"fill\" begin=\"-1\"/><play {who} take=\"{walks}\" repeat=\"fill\" fade-in=\"9\"/>")
            })
        }),
        frame("walk", |bench| {
            bench.plan(|role, who| {
                format!(
                    "<move {who} path=\"p\" take=\"{}\" dur=\"5\" ground=\"plane\" begin=\"-0.0{role}\"/>",
                    bench.takes[1]
                )
            })
        }),
        frame("walk on 100,000 triangles", |bench| {
            bench.plan_on(HILL, |role, who| {
                let take = &bench.takes[1];
                format!(
                    "<move {who} path=\"p\" take=\"{take}\" dur=\"5\" ground=\"mesh\" begin=\"-0.0{role}\"/>"
                )
            })
        }),
        BenchCase::new("stage", format!("read/{ACTIONS}"), 1, "script", || {
            let text: Arc<str> = large_script().into();
            move || drop(black_box(StageScript::read(Arc::clone(&text))))
        }),
        BenchCase::new("stage", format!("resolve/{ACTIONS}"), 1, "script", || {
            let script = StageScript::read(large_script()).expect("a script");
            let lengths = vec![StageTime::from_seconds(1.5); script.actions().len()];
            move || drop(black_box(resolve(&script, &lengths)))
        }),
    ];
    Section { about: Box::new(move || bench().about()), cases }
}

/// Returns a hilly square of 30 m with 100,352 triangles.
fn hill() -> ModelData {
    let cells = 224_u32;
    let at = |index: u32| (index as f32 / cells as f32 - 0.5) * 30.0;
    let point = |index: u32| {
        let [x, z] = [index % (cells + 1), index / (cells + 1)].map(at);
        Vec3::new(x, 0.3 * x.sin() * z.cos(), z)
    };
    let corners = |cell: u32| {
        let first = cell / cells * (cells + 1) + cell % cells;
        let below = first + cells + 1;
        [first, below, first + 1, first + 1, below, below + 1]
    };
    let positions: Vec<Vec3> = (0..(cells + 1) * (cells + 1)).map(point).collect();
    let primitive = Primitive {
        vertices: Vertices { positions, ..Vertices::default() },
        indices: (0..cells * cells).flat_map(corners).collect(),
        ..Primitive::default()
    };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: Vec::new(),
    };
    let mesh = Mesh { primitives: vec![primitive], ..Mesh::default() };
    ModelData { meshes: vec![mesh], instances: vec![instance], ..ModelData::default() }
}

/// Returns a script whose sequences wait for each other.
fn large_script() -> String {
    let rows = 100;
    let mut text = String::from("<script version=\"1\"><cast><role id=\"a\" model=\"a.glb\"/></cast>\n");
    for row in 0..rows {
        text.push_str("<seq>\n");
        for at in 0..ACTIONS / rows {
            let begin = match (row, at % 7) {
                (1.., 0) => format!(" begin=\"p{}x{at}.begin+0.1\"", row - 1),
                _ => String::new(),
            };
            let _ =
                writeln!(text, "  <play id=\"p{row}x{at}\" who=\"a\" take=\"Walk\"{begin} fade-in=\"0.2\"/>");
        }
        text.push_str("</seq>\n");
    }
    text.push_str("</script>\n");
    text
}
