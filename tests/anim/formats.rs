//! Properties of every format of the list, and of formats that other crates define.
//!
//! The tests walk the list, so a new format is tested without a change here. It needs a file in `tests/data`, unless
//! models can be written in it.

use crate::doors::{MemoryFs, TestFolder, data, model_files, model_folders};
use crate::fixture::Fixture;
use crate::soundness::faults;
use dragonfly_anim::data::{AnimationData, ModelData, Skeleton, Take};
use dragonfly_anim::format::{
    BUILTIN, EditedTake, ExportError, Format, Formats, ImportContext, ImportError, NoFiles, Place,
    ReadOptions, SavePlan, Warning, WholeFile, WriteSupport, gltf, read,
};
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::seed;
use serde_json::json;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;

/// A valid file of a format.
struct SampleFile {
    name: String,
    bytes: Vec<u8>,
    folder: PathBuf,
}

/// Returns the files of `tests/data` with a model extension that can be read, sorted.
fn stored_files() -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), Vec::from(model_folders()));
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
            if path.is_dir() {
                folders.push(path);
            } else if Formats::builtin().by_extension(extension).is_some() {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Returns valid files of a format: those in `tests/data`, and for a format that is written as a whole the models of
/// all files there, written in this format.
fn samples(format: &Format) -> Vec<SampleFile> {
    let mut samples = Vec::new();
    for path in stored_files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let folder = path.parent().unwrap().to_owned();
        let bytes = std::fs::read(&path).unwrap();
        if format.has_extension(path.extension().unwrap().to_str().unwrap()) {
            samples.push(SampleFile { name, bytes, folder });
        } else if let WriteSupport::Whole(write) = format.write {
            let model =
                read(&name, &bytes, &TestFolder(folder.clone()), &ReadOptions::default()).unwrap().model;
            let name = format!("{name}.{}", format.extension());
            samples.push(SampleFile { name, bytes: write(&model).unwrap().bytes, folder });
        }
    }
    assert!(!samples.is_empty(), "put a small file of the format {} into tests/data", format.name);
    samples
}

/// Returns the bytes of the main file of a plan.
fn main_file(plan: &SavePlan) -> &[u8] {
    &plan.files.last().unwrap().bytes
}

#[test]
fn every_format_has_a_unique_name_a_title_and_lower_case_extensions() {
    for (index, format) in BUILTIN.iter().enumerate() {
        assert!(BUILTIN[..index].iter().all(|other| other.name != format.name), "{}", format.name);
        assert!(!format.title.is_empty() && !format.extensions.is_empty(), "{}", format.name);
        for extension in format.extensions {
            assert_eq!(*extension, extension.to_ascii_lowercase());
            assert!(!extension.starts_with('.'));
            assert_eq!(Formats::builtin().by_extension(extension), Some(format));
        }
        assert_eq!(Formats::builtin().by_name(format.name), Some(format));
    }
}

#[test]
fn every_format_is_recognized_by_its_content_under_any_name() {
    for format in BUILTIN {
        for sample in samples(format) {
            for name in [sample.name.as_str(), "file", "file.txt", "file.glb", "file.gltf", "file.dfm"] {
                let found = Formats::builtin().detect(name, &sample.bytes).copied();
                assert_eq!(found, Some(*format), "{} as {name}", sample.name);
            }
        }
    }
}

#[test]
fn every_format_reads_its_files_into_sound_models() {
    for format in BUILTIN {
        for sample in samples(format) {
            let files = TestFolder(sample.folder.clone());
            let imported = format.import(&sample.bytes, &files, &ReadOptions::default()).unwrap();
            assert_eq!(imported.format, *format);
            assert_eq!(faults(&imported.model), [""; 0], "{}", sample.name);
        }
    }
}

#[test]
fn what_every_writable_format_writes_reads_back() {
    for format in BUILTIN.iter().filter(|format| format.is_writable()) {
        for sample in samples(format) {
            let (name, files) = (sample.name.as_str(), TestFolder(sample.folder.clone()));
            let options = ReadOptions::default();
            let opened = format.import(&sample.bytes, &files, &options).unwrap().model;
            let file = format.edit(name, sample.bytes.clone(), &files, &options).unwrap();
            assert_eq!((file.name(), file.format()), (name, *format));
            let mut takes: Vec<EditedTake> = opened
                .animation
                .takes
                .iter()
                .enumerate()
                .map(|(index, take)| EditedTake { origin: Some(index), take: Arc::clone(take) })
                .collect();
            // Without an edit the file keeps its bytes.
            let plan = file.plan(&opened, &takes).unwrap();
            assert!(main_file(&plan) == sample.bytes, "{name}: nothing was edited");
            let Some(first) = takes.first_mut() else { continue };
            Arc::make_mut(&mut first.take).name = "renamed".to_owned();
            takes.push(takes[0].clone());
            Arc::make_mut(&mut takes.last_mut().unwrap().take).name = "copy".to_owned();
            let plan = match file.plan(&opened, &takes) {
                Ok(plan) => plan,
                Err(error) => {
                    // Not every kind of file can be edited; then another format is proposed.
                    assert!(error.to_string().contains(".glb"), "{name}: {error}");
                    continue;
                }
            };
            // A format may have room for one take, or for none of the names: then it lists what is lost.
            let is_lost =
                |pointer: String| plan.lost.iter().any(|lost| lost.place == Place::Pointer(pointer.clone()));
            let lost_take = |index: usize| is_lost(format!("/animation/takes/{index}"));
            let lost_name = |index: usize| is_lost(format!("/animation/takes/{index}/name"));
            let listed =
                (0..takes.len()).map(|index| usize::from(lost_take(index)) + usize::from(lost_name(index)));
            assert_eq!(plan.lost.len(), listed.sum::<usize>(), "{name}: {:?}", plan.lost);
            assert_eq!(plan.changes.is_some(), format.is_surgical(), "{name}");
            let again = format.import(main_file(&plan), &files, &options).unwrap().model;
            let kept: Vec<usize> = (0..takes.len()).filter(|&index| !lost_take(index)).collect();
            assert!(!kept.is_empty() && again.animation.takes.len() == kept.len(), "{name}");
            for (got, index) in again.animation.takes.iter().zip(kept) {
                let asked = &takes[index].take;
                assert!(got.name == asked.name || lost_name(index), "{name}, take {}", got.name);
                assert!(got.tracks == asked.tracks, "{name}, take {}", got.name);
            }
            assert!(again.meshes == opened.meshes && again.skins == opened.skins, "{name}");
            assert!(file.compact(&opened).is_ok(), "{name}");
        }
    }
}

#[test]
fn no_damaged_file_of_any_format_panics() {
    const MUTANTS: usize = 400;
    let first = seed(71_004);
    println!("DRAGONFLY_SEED={first}");
    for format in BUILTIN {
        let small = samples(format).into_iter().map(|sample| sample.bytes);
        let mut files: Vec<Vec<u8>> = small.collect();
        files.sort_by_key(Vec::len);
        files.truncate(4);
        let mut mutator = Mutator::new(first, &[b"\xff\xff\xff\xff", b"{}", b"-1", b"\0\0\0\0"]);
        let cuts = (0..64).map(|cut| files[0][..files[0].len() * cut / 64].to_vec()).collect::<Vec<_>>();
        for bytes in (0..MUTANTS).map(|_| mutator.mutant(&files)).chain(cuts) {
            let (door, options) = (MemoryFs::default(), ReadOptions::default());
            let work = || {
                if let Ok(imported) = format.import(&bytes, &door, &options) {
                    assert_eq!(faults(&imported.model), [""; 0]);
                }
                let _ = (format.sniff)(&bytes);
                let _ = format.edit("a", bytes.clone(), &door, &ReadOptions::default());
            };
            let result = catch_unwind(AssertUnwindSafe(work));
            assert!(result.is_ok(), "{}: {} bytes with seed {first}", format.name, bytes.len());
        }
    }
}

#[test]
fn the_content_of_a_file_decides_about_its_format_before_its_name() {
    let formats = Formats::builtin();
    let name = |name: &str, bytes: &[u8]| formats.detect(name, bytes).map(|format| format.name);
    assert_eq!(name("a.gltf", b"glTF\x02"), Some("glb"));
    assert_eq!(name("a.glb", b" \n{\"asset\""), Some("gltf"));
    assert_eq!(name("a.GLB", b"PK"), Some("glb"));
    assert_eq!(name("a.gltf", b""), Some("gltf"));
    assert_eq!(name("a.txt", b"hello"), None);
    assert_eq!(name("glb", b"hello"), None);
    let error = read("a.txt", b"hello", &NoFiles, &ReadOptions::default()).unwrap_err();
    assert_eq!(error, ImportError::UnknownFormat { name: "a.txt".to_owned() });
    assert_eq!(error.to_string(), "file: \"a.txt\" has no known format");
}

#[test]
fn extensions_of_other_model_formats_are_known_as_such() {
    let formats = Formats::builtin();
    for extension in ["glb", "GLTF", "dfm", "fbx", "FBX", "obj", "dae", "bvh", "m3d", "x", "blend"] {
        assert!(formats.is_model_extension(extension), "{extension}");
    }
    for extension in ["txt", "v2", "", "glbx"] {
        assert!(!formats.is_model_extension(extension), "{extension}");
    }
    assert_eq!(formats.by_extension("fbx"), None);
    assert_eq!(formats.extensions(), ["dfm", "glb", "vrm", "gltf", "vrma", "bvh", "obj", "m3d", "x"]);
    assert_eq!(formats.extension_list(), ".dfm, .glb, .vrm, .gltf, .vrma, .bvh, .obj, .m3d, .x");
}

/// A format of another crate: a line `TAKES` and then the name of one take in each line. Meshes are not stored.
mod take_list {
    use super::*;

    pub(super) const TAKE_LIST: Format = Format {
        name: "takes",
        title: "List of takes",
        extensions: &["takes", "txt"],
        sniff: |bytes| bytes.starts_with(b"TAKES"),
        read: read_takes,
        write: WriteSupport::Whole(write_takes),
        export: Some(|model, name| Ok(write_takes(model)?.named(name))),
    };

    fn read_takes(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
        context.charge(&Place::File, bytes.len() as u64)?;
        let text = std::str::from_utf8(bytes).map_err(|error| ImportError::Invalid {
            place: Place::Byte(error.valid_up_to() as u64),
            code: "NOT_UTF_8",
            reason: "the text is not UTF-8".to_owned(),
        })?;
        let mut takes = Vec::new();
        for (line, name) in text.lines().enumerate().skip(1) {
            context.work(1)?;
            if name.is_empty() {
                context.warn(Place::Line(line as u32 + 1, 1), "EMPTY_LINE", "the line is ignored");
                continue;
            }
            let included = name.strip_prefix("include ");
            let name = match included {
                Some(uri) => {
                    let place = Place::Line(line as u32 + 1, 9);
                    String::from_utf8_lossy(&context.read_neighbor(uri, &place)?).into_owned()
                }
                None => name.to_owned(),
            };
            takes.push(Arc::new(Take { name, ..Take::default() }));
        }
        let animation = AnimationData { skeleton: Arc::new(Skeleton::default()), takes };
        Ok(ModelData { animation, ..ModelData::default() })
    }

    fn write_takes(model: &ModelData) -> Result<WholeFile, ExportError> {
        let mut text = "TAKES\n".to_owned();
        for take in &model.animation.takes {
            if take.name.contains('\n') {
                return Err(ExportError::new(format!(
                    "take \"{}\": a name is one line",
                    take.name.escape_debug()
                )));
            }
            text += &format!("{}\n", take.name);
        }
        let lost = model.meshes.iter().enumerate().map(|(index, _)| Warning {
            place: Place::Pointer(format!("/meshes/{index}")),
            code: "NOT_STORED",
            text: "meshes are not stored".to_owned(),
        });
        Ok(WholeFile { bytes: text.into_bytes(), lost: lost.collect() })
    }
}

use take_list::TAKE_LIST;

#[test]
fn a_format_of_another_crate_is_read_and_written_like_the_others() {
    let formats = Formats::builtin().with(TAKE_LIST);
    assert_eq!(formats.by_extension("TXT"), Some(&TAKE_LIST));
    assert_eq!(
        formats.extensions(),
        ["takes", "txt", "dfm", "glb", "vrm", "gltf", "vrma", "bvh", "obj", "m3d", "x"]
    );
    let bytes = b"TAKES\nwalk\n\ninclude run.name\n";
    let files = MemoryFs::with(&[("run.name", b"run")]);
    let options = ReadOptions::default();
    let imported = formats.read("fox", bytes, &files, &options).unwrap();
    assert_eq!((imported.format, imported.format.title), (TAKE_LIST, "List of takes"));
    assert_eq!(imported.warnings[0].to_string(), "line 3 column 1: the line is ignored");
    assert_eq!(files.asked(), ["run.name"]);

    let file = imported.format.edit("fox.takes", bytes.as_slice(), &files, &options).unwrap();
    let mut take = Take::clone(&imported.model.animation.takes[1]);
    take.name = "jump".to_owned();
    let edited = EditedTake { origin: None, take: Arc::new(take.clone()) };
    let plan = file.plan(&imported.model, &[edited]).unwrap();
    assert_eq!(plan.files[0].bytes, b"TAKES\njump\n");
    assert_eq!(plan.to_string(), "the whole file is written: 11 bytes\n");

    take.name = "two\nlines".to_owned();
    let error = file.plan(&imported.model, &[EditedTake { origin: None, take: Arc::new(take) }]).unwrap_err();
    assert_eq!(error.to_string(), "take \"two\\nlines\": a name is one line");
}

#[test]
fn a_whole_file_writer_reports_what_is_lost() {
    let fox = std::fs::read(data().join("gltf/Fox.glb")).unwrap();
    let fox = read("Fox.glb", &fox, &NoFiles, &ReadOptions::default()).unwrap().model;
    let file = TAKE_LIST.edit("fox.takes", Vec::new(), &NoFiles, &ReadOptions::default()).unwrap();
    let plan = file.plan(&fox, &[]).unwrap();
    assert_eq!(
        plan.to_string(),
        "the whole file is written: 6 bytes\nnot saved: /meshes/0: meshes are not stored\n"
    );
}

#[test]
fn the_context_limits_formats_of_other_crates_too() {
    let formats = Formats::none().with(TAKE_LIST);
    let read = |bytes: &[u8], options: &ReadOptions<'_>| {
        formats.read("a.takes", bytes, &MemoryFs::default(), options).map(|imported| imported.warnings.len())
    };
    assert_eq!(read(b"{}", &ReadOptions::default()), Ok(0), "the extension decides");
    let cancelled = ReadOptions { is_cancelled: &|| true, ..ReadOptions::default() };
    assert_eq!(read(b"TAKES\n", &cancelled), Err(ImportError::Cancelled));
    let error = read(b"TAKES\ninclude ../secret\n", &ReadOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "line 2 column 9: \"../secret\": the path leaves the folder");
    let error = read(b"TAKES\ninclude other\n", &ReadOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "line 2 column 9: \"other\": there is no such file");
    let error = formats.read("a.glb", b"glTF", &NoFiles, &ReadOptions::default()).unwrap_err();
    assert_eq!(error.code(), "UNKNOWN_FORMAT", "the formats of this crate were not added");
}

#[test]
fn a_format_that_was_added_takes_precedence_and_replaces_one_of_the_same_name() {
    const STRICT: Format = Format { title: "glTF, strict", extensions: &["glb", "vrm"], ..gltf::GLB };
    let formats = Formats::builtin().with(STRICT);
    assert_eq!(formats.iter().count(), BUILTIN.len());
    assert_eq!(formats.detect("a", b"glTF").map(|format| format.title), Some("glTF, strict"));
    assert_eq!(formats.detect("a.VRM", b"").map(|format| format.title), Some("glTF, strict"));
}

#[test]
fn a_format_without_a_writer_cannot_be_edited() {
    const READ_ONLY: Format = Format { name: "bin", write: WriteSupport::None, ..gltf::GLB };
    assert!(!READ_ONLY.is_writable() && !READ_ONLY.is_surgical());
    let error = READ_ONLY.edit("a.bin", Vec::new(), &NoFiles, &ReadOptions::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "file: files of the format glTF 2.0, binary can only be read; save the model in another format"
    );
}

#[test]
fn text_from_a_file_never_spans_several_lines_of_a_message() {
    let mut fixture = Fixture::new();
    fixture.set("/extensionsRequired", json!(["EXT_\n\u{1b}[31m\u{202e}\u{2028}nasty"]));
    let error = read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "/extensionsRequired/0: needs the extension EXT_\\u{a}\\u{1b}[31m\\u{202e}\\u{2028}nasty, which is not supported"
    );
    let mut fixture = Fixture::new();
    fixture.set("/extensionsRequired", json!(["x".repeat(100_000)]));
    let error = read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().len() < 400);
}

#[test]
fn the_files_of_the_test_data_are_read_without_serious_warnings() {
    // Images are missing from the collection on purpose; a few files have these harmless defects.
    let usual = [
        "IMAGE_DATA_INVALID",
        "UNSUPPORTED_EXTENSION",
        "CAMERA_NOT_SHOWN",
        "ACCESSOR_WEIGHTS_NON_NORMALIZED",
    ];
    for path in model_files() {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !name.ends_with(".glb") {
            continue;
        }
        let bytes = std::fs::read(&path).unwrap();
        let imported = read(&name, &bytes, &MemoryFs::default(), &ReadOptions::default()).unwrap();
        for warning in imported.warnings {
            println!("{name}: {warning}");
            assert!(usual.contains(&warning.code), "{name}: {} {warning}", warning.code);
        }
    }
}
