//! Times of reading large files, compared with other programs in turns.

use crate::assimp::Assimp;
use crate::reading::{TimedWork, in_turns, read_ours, timed};
use crate::{blender, inputs};
use dragonfly_anim::format::{
    EditedTake, Format, ImportContext, NoFiles, ReadOptions, bvh, gltf, m3d, obj, x,
};
use dragonfly_fbx::{FbxParser, read_in_process};
use dragonfly_kit::figures::{FigureBench, percentile, root};
use dragonfly_kit::folder::Folder;
use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;

/// Number of turns.
const ROUNDS: usize = 7;

/// Number of bytes per millisecond that text is read with at least: 150 MB/s.
const TEXT_BYTES: f64 = 150_000.0;

/// Milliseconds that the process of the FBX parser may add.
const PROCESS: f64 = 5.0;

/// Measures all formats.
pub(crate) fn all(bench: &mut FigureBench) {
    let folder = Folder::new("formats");
    let assimp = RefCell::new(Assimp::start(folder.path()));
    if bench.wants("bvh") {
        text(bench, bvh::BVH, inputs::bvh(), &folder, &assimp);
    }
    let written = |format: Format, name: &str, repeated: usize| {
        let export = format.export.expect("a format that is written");
        export(&inputs::rig(repeated), name).expect("the rig").files.pop().expect("a file").bytes
    };
    if bench.wants("m3d") {
        text(bench, m3d::M3D, written(m3d::M3D, "rig.m3d", 12), &folder, &assimp);
    }
    if bench.wants("x") {
        against(bench, x::X, written(x::X, "rig.x", 1), &folder, &assimp);
    }
    if bench.wants("obj") {
        against(bench, obj::OBJ, inputs::obj(), &folder, &assimp);
    }
    if bench.wants("fbx") {
        fbx(bench);
    }
    if bench.wants("gltf") {
        glb(bench, &folder);
    }
}

/// Keeps the times, and the ratios of the first work to the others; `goal` is the largest ratio to one of them.
fn keep(bench: &mut FigureBench, task: &str, measured: &[(&str, Vec<f64>)], goal: Option<(&str, f64)>) {
    let Some((first, own)) = measured.first() else { return };
    for (variant, times) in measured {
        bench.times(task, variant, times);
    }
    for (rival, theirs) in &measured[1..] {
        let ratios: Vec<f64> = own.iter().zip(theirs).map(|(a, b)| a / b).collect();
        let metric = format!("ratio to {rival}");
        bench.value(task, first, &metric, "ratio", percentile(&ratios, 50));
        if let Some((_, goal)) = goal.filter(|(name, _)| name == rival) {
            bench.goal(task, first, &metric, "ratio", goal);
        }
    }
}

/// Writes the file that assimp reads. Returns the name of the task, and the works of this library and of assimp.
fn works<'a>(
    format: Format,
    bytes: &'a [u8],
    folder: &Folder,
    assimp: &'a RefCell<Option<Assimp>>,
) -> (String, Vec<TimedWork<'a>>) {
    let task = format!("read {} of {} MB", format.extension(), bytes.len() / 1_000_000);
    let path = folder.join(&format!("large.{}", format.extension()));
    std::fs::write(&path, bytes).expect("a folder of this bench");
    let works: Vec<TimedWork<'a>> = vec![
        ("ours", Box::new(move || read_ours(format, bytes))),
        ("assimp", Box::new(move || assimp.borrow_mut().as_mut()?.read(&path))),
    ];
    (task, works)
}

/// Measures a text whose goal is a number of bytes per second, in turns with assimp.
fn text(
    bench: &mut FigureBench,
    format: Format,
    bytes: Vec<u8>,
    folder: &Folder,
    assimp: &RefCell<Option<Assimp>>,
) {
    let (task, mut works) = works(format, &bytes, folder, assimp);
    if format == m3d::M3D {
        // assimp knows another format of this name.
        works.truncate(1);
    }
    let measured = in_turns(ROUNDS, works);
    keep(bench, &task, &measured, None);
    let Some((name, own)) = measured.first() else { return };
    let allowed = bytes.len() as f64 / TEXT_BYTES;
    bench.value(&task, "150 MB/s", "median", "ms", allowed);
    bench.value(&task, name, "ratio to 150 MB/s", "ratio", percentile(own, 50) / allowed);
    bench.goal(&task, name, "ratio to 150 MB/s", "ratio", 1.0);
}

/// Measures a format whose goal is half the time of assimp; OBJ in turns with tobj as well.
fn against(
    bench: &mut FigureBench,
    format: Format,
    bytes: Vec<u8>,
    folder: &Folder,
    assimp: &RefCell<Option<Assimp>>,
) {
    let (task, mut works) = works(format, &bytes, folder, assimp);
    if format == obj::OBJ {
        let text = &bytes;
        works.push(("tobj", Box::new(move || Some(timed(|| tobj_read(text))))));
    }
    keep(bench, &task, &in_turns(ROUNDS, works), Some(("assimp", 0.5)));
}

fn tobj_read(text: &[u8]) -> usize {
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut &text[..], &tobj::GPU_LOAD_OPTIONS, no_materials)
        .expect("a file made in code");
    models.len()
}

/// Measures the FBX parser in its process against the same work in this one.
fn fbx(bench: &mut FigureBench) {
    let models = crate::sources::models();
    let is_fbx = |path: &&PathBuf| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("fbx"));
    let size = |path: &PathBuf| std::fs::metadata(path).map_or(0, |data| data.len());
    let largest = models.iter().filter(is_fbx).max_by_key(|path| size(path));
    let path = largest.cloned().unwrap_or_else(|| root().join("tests/data/fbx"));
    let bytes = std::fs::read(&path).expect("an FBX file of the repository");
    let task = format!(
        "read {} of {} KB",
        path.file_name().unwrap_or_default().to_string_lossy(),
        bytes.len() / 1000
    );
    let parser = FbxParser::this_program().expect("this program");
    let here = |read: &dyn Fn(&ImportContext<'_>)| {
        let options = ReadOptions::default();
        options.budget.input(bytes.len());
        let context = ImportContext::new(&NoFiles, &options);
        Some(timed(|| read(&context)))
    };
    let works: Vec<TimedWork<'_>> = vec![
        ("ours", Box::new(|| here(&|context| drop(parser.read(&bytes, context).expect("a model"))))),
        (
            "in process",
            Box::new(|| here(&|context| drop(read_in_process(&bytes, context).expect("a model")))),
        ),
        (
            "ufbx alone",
            Box::new(|| Some(timed(|| ufbx::load_memory(&bytes, ufbx::LoadOpts::default()).is_ok()))),
        ),
    ];
    let measured = in_turns(3 * ROUNDS, works);
    let median = |at: usize| measured.get(at).map_or(f64::NAN, |(_, times)| percentile(times, 50));
    // The time of the process is allowed on top.
    let allowed = 1.3 + PROCESS / median(1);
    keep(bench, &task, &measured, Some(("in process", allowed)));
}

/// Measures opening a glTF file and saving an edit of one key against Blender.
fn glb(bench: &mut FigureBench, folder: &Folder) {
    let bytes: Arc<[u8]> = inputs::glb().into();
    let path = folder.join("keys.glb");
    std::fs::write(&path, &bytes).expect("a folder of this bench");
    let options = ReadOptions::default();
    let opened = gltf::GLB.import(&bytes, &NoFiles, &options).expect("a model");
    let mut take = (*opened.model.animation.takes[0]).clone();
    let mut values = take.tracks[0].translation.values.to_vec();
    values[0].x += 0.01;
    take.tracks[0].translation.values = values.into();
    let edited = vec![EditedTake { origin: Some(0), take: Arc::new(take) }];
    let saved = folder.join("saved.glb");
    let save = || {
        timed(|| {
            let options = ReadOptions::default();
            let file = gltf::GLB.edit("keys.glb", Arc::clone(&bytes), &NoFiles, &options).expect("a file");
            let plan = file.plan(&opened.model, &edited).expect("a plan");
            std::fs::write(&saved, &plan.files[0].bytes).expect("a folder of this bench");
        })
    };
    let open = || {
        timed(|| {
            let bytes = std::fs::read(&path).expect("the file");
            gltf::GLB.import(&bytes, &NoFiles, &ReadOptions::default()).expect("a model")
        })
    };
    let theirs = blender::times(&path);
    let (opens, saves) = theirs.map_or((Vec::new(), Vec::new()), |times| (times.open, times.save));
    let measured =
        in_turns(ROUNDS, vec![("ours", Box::new(|| Some(open()))), ("save", Box::new(|| Some(save())))]);
    for (task, own, theirs, goal) in [
        ("open a glTF of 90 000 keys", &measured[0].1, opens, 1.0 / 20.0),
        ("save an edit of a glTF of 90 000 keys", &measured[1].1, saves, 1.0 / 100.0),
    ] {
        let mut both = vec![("ours", own.clone())];
        if !theirs.is_empty() {
            both.push(("Blender", theirs));
        }
        keep(bench, task, &both, Some(("Blender", goal)));
    }
}
