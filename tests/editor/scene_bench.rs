//! A scene in the user interface without a real window: two foxes, two cameras, a script.

use crate::workbench::{Window, Workbench};
use dragonfly::panels::Effect;
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptContext;
use dragonfly_anim::stage::{LiveStage, StageAssets, StageModel};
use dragonfly_document::adapter::{ModelAdapter, TextFile, TextFiles};
use dragonfly_document::history::Edited;
use dragonfly_document::{FileView, LoadedModel, SceneModel, SceneView, View};
use dragonfly_kit::document::fixture;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// A scene of two foxes: one looks around and runs, the other one walks.
pub(crate) const FOXES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<script version="1" fps="24" size="1280x720">
  <!-- Two foxes meet. -->
  <cast>
    <role   id="anna"  model="Fox.glb" at="-1 0 0" facing="90" scale="0.01"/>
    <role   id="ben"   model="Fox.glb" at="1 0 0" facing="-90" scale="0.01"/>
    <camera id="wide"  at="0 1 5" look="0 0.5 0" lens="35mm"/>
    <camera id="close" at="-2 0.6 2" look="ben" lens="85mm"/>
    <light  id="sun"   kind="sun" direction="-1 -2 -1"/>
    <path   id="aisle" points="-1 0 0  0 0 0.6  1 0 0" curve="smooth"/>
    <mark   id="door"  at="0.6 0 0.8"/>
  </cast>

  <par id="scene-1">
    <shot who="wide" begin="0"/>
    <shot who="close" begin="looks.end" blend="0.5"/>
    <seq>
      <play id="looks" who="anna" take="Survey" to="2"><at name="sees" time="1.25"/></play>
      <play who="anna" take="Run" begin="-0.5" fade-in="0.5" repeat="3"/>
    </seq>
    <move who="ben" path="aisle" take="Walk" begin="1"/>
    <look who="ben" at="anna" bones="b_Head_05" begin="looks.sees" dur="2" fade-in="0.25" fade-out="0.25"/>
    <change who="sun" property="strength" to="0.4" begin="2" dur="1.5"/>
    <title text="The End" begin="4" dur="1" fade-in="0.5"/>
  </par>
</script>
"#;

/// The models of a scene on the bench, and the plan of its newest text.
pub(crate) struct SceneStage {
    assets: StageAssets,
    models: Arc<BTreeMap<String, SceneModel>>,
    live: LiveStage,
    project: Option<StageProject>,
}

fn fox() -> (Arc<LoadedModel>, Arc<StageModel>) {
    static FOX: OnceLock<(Arc<LoadedModel>, Arc<StageModel>)> = OnceLock::new();
    FOX.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb");
        let bytes = std::fs::read(path).unwrap();
        let model = Arc::new(read("Fox.glb", &bytes, &NoFiles, &ReadOptions::default()).unwrap().model);
        let loaded = fixture::view("Fox.glb", model.animation.skeleton.as_ref().clone(), &[]).loaded;
        let loaded = LoadedModel { model: Arc::clone(&model), ..LoadedModel::clone(&loaded) };
        (Arc::new(loaded), Arc::new(StageModel::new(model)))
    })
    .clone()
}

impl SceneStage {
    fn new() -> Self {
        let (loaded, model) = fox();
        let mut assets = StageAssets::default();
        assets.add_model("Fox.glb", model);
        let models = BTreeMap::from([("Fox.glb".to_owned(), SceneModel::Loaded(loaded))]);
        Self { assets, models: Arc::new(models), live: LiveStage::default(), project: None }
    }

    /// Makes models missing, by the names with which scripts mean them.
    fn miss(&mut self, names: &[&str]) {
        self.assets.allow_missing_models();
        let missing = |name: &&str| ((*name).to_owned(), SceneModel::Missing("does not exist".to_owned()));
        Arc::make_mut(&mut self.models).extend(names.iter().map(missing));
    }

    /// Returns the view of a newer text, as the document's thread publishes it.
    pub(crate) fn view(&mut self, texts: &TextFiles) -> Arc<SceneView> {
        let script = texts.called("scene.xml").expect("a script");
        let project = texts.called("scene.meproj").map(|file| StageProject::read(Arc::clone(&file.text)));
        let project = match project {
            Some(Ok(project)) => {
                self.project = Some(project.clone());
                Some(project)
            }
            // While its text is broken, the last good project counts.
            Some(Err(_)) => self.project.clone(),
            None => None,
        };
        let lines =
            texts.called("scene.lines.xml").map(|file| DrawnLines::read(Arc::clone(&file.text)).unwrap());
        self.assets.clear_lines();
        for line in lines.iter().flat_map(DrawnLines::list) {
            self.assets.add_line(line.id.as_deref().unwrap(), line.samples().points());
        }
        let text = &script.text;
        let context = ScriptContext { project: project.clone(), ..ScriptContext::default() };
        self.live.update_in(Arc::clone(text), &context, &self.assets);
        let errors = self.live.errors().to_vec();
        let (errors, shared) = match &project {
            Some(project) => project.separated(errors),
            None => (errors, Vec::new()),
        };
        Arc::new(SceneView {
            text: Arc::clone(text),
            name: Arc::clone(&script.name),
            texts: texts.clone(),
            project: project.map(Arc::new),
            lines: lines.map(Arc::new),
            script: self.live.script().cloned(),
            plan: self.live.plan().cloned(),
            errors: errors.into(),
            shared_errors: shared.into(),
            models: Arc::clone(&self.models),
            ..SceneView::default()
        })
    }
}

/// Opens a script in the user interface.
pub(crate) fn scene(text: &str) -> Workbench {
    open(TextFiles::one("scene.xml", text))
}

/// Opens a project with a script and a file of lines in the user interface.
pub(crate) fn project(script: &str, lines: &str) -> Workbench {
    let main = r#"<project version="1">
  <lines src="scene.lines.xml"/>
  <script id="main" src="scene.xml"/>
</project>
"#;
    let files = [("scene.meproj", main), ("scene.xml", script), ("scene.lines.xml", lines)];
    open(files.map(|(name, text)| TextFile { name: name.into(), text: text.into() }).into_iter().collect())
}

/// Opens a project whose scripts `scene.xml` and `end.xml` share a cast.
pub(crate) fn shared(project: &str, script: &str, end: &str) -> Workbench {
    let files = [("scene.meproj", project), ("scene.xml", script), ("end.xml", end)];
    open(files.map(|(name, text)| TextFile { name: name.into(), text: text.into() }).into_iter().collect())
}

/// Opens a script in the user interface, some of whose models are missing.
pub(crate) fn scene_without(text: &str, missing: &[&str]) -> Workbench {
    open_without(TextFiles::one("scene.xml", text), missing)
}

fn open(texts: TextFiles) -> Workbench {
    open_without(texts, &[])
}

fn open_without(texts: TextFiles, missing: &[&str]) -> Workbench {
    let mut stage = SceneStage::new();
    if !missing.is_empty() {
        stage.miss(missing);
    }
    let skeleton = dragonfly_anim::data::Skeleton { bones: Vec::new() };
    let empty = fixture::view("scene.xml", skeleton, &[]);
    let adapter = ModelAdapter::of(&empty.loaded.model).with_texts(texts.clone());
    let file = FileView {
        title: "scene.xml".to_owned(),
        path: Some("/scenes/scene.xml".into()),
        ending: "xml".into(),
    };
    let view = View { scene: Some(stage.view(&texts)), file: Arc::new(file), ..empty };
    let mut bench = Workbench::new(Some(view));
    bench.edited = Some(Edited::new(adapter));
    bench.stage = Some(stage);
    bench
}

/// Answers a job that looks at files, for a folder that is not on the disk: files below it are in it. Returns the effect that follows; the same one
/// where a file is elsewhere.
pub(crate) fn looked(window: &mut Window, effect: Option<Effect>) -> Option<Effect> {
    let Some(Effect::LookAtFiles(mut wanted)) = effect else { return effect };
    let folder = wanted.files.folder.clone();
    for file in &mut wanted.files.files {
        let name = file.path.strip_prefix(&folder);
        file.name = name.ok().map(|name| name.to_string_lossy().into_owned());
    }
    if !wanted.files.are_inside() {
        return Some(Effect::LookAtFiles(wanted));
    }
    window.state_mut().state.files_answered(wanted, 0)
}

/// Returns the text of the script in the document.
pub(crate) fn text(window: &Window) -> String {
    named_text(window, "scene.xml")
}

/// Returns a text of the document.
pub(crate) fn named_text(window: &Window, name: &str) -> String {
    window.state().edited.as_ref().unwrap().adapter().texts().called(name).unwrap().text.to_string()
}

/// Returns the lines that only one of two texts has.
pub(crate) fn new_lines(old: &str, new: &str) -> Vec<String> {
    let old: Vec<&str> = old.lines().collect();
    new.lines().filter(|line| !old.contains(line)).map(|line| line.trim().to_owned()).collect()
}
