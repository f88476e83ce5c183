//! A file's format is told by what it holds, then by its name; every message is one line that begins with a place.

use crate::doors::{MemoryFs, model_files};
use crate::fixture::Fixture;
use dragonfly_anim::format::{FORMATS, ImportError, NoFiles, ReadOptions, format_of, read};
use serde_json::json;

#[test]
fn content_tells_the_format_before_the_name_does() {
    let name = |name: &str, bytes: &[u8]| format_of(name, bytes).map(|format| format.name);
    assert_eq!(name("a.gltf", b"glTF\x02"), Some("glb"));
    assert_eq!(name("a.glb", b" \n{\"asset\""), Some("gltf"));
    assert_eq!(name("a.GLB", b"PK"), Some("glb"));
    assert_eq!(name("a.gltf", b""), Some("gltf"));
    assert_eq!(name("a.txt", b"hello"), None);
    assert_eq!(name("glb", b"hello"), None);
    for (index, format) in FORMATS.iter().enumerate() {
        assert!(FORMATS[..index].iter().all(|other| other.name != format.name));
        assert!(!format.extensions.is_empty());
    }
    let error = read("a.txt", b"hello", &NoFiles, &ReadOptions::default()).unwrap_err();
    assert_eq!(error, ImportError::UnknownFormat { name: "a.txt".to_owned() });
    assert_eq!(error.to_string(), "file: \"a.txt\" is of no known format");
}

#[test]
fn words_of_a_file_never_break_a_message() {
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
fn files_of_the_collection_are_read_without_a_warning_that_matters() {
    // Images are left out of the collection on purpose; a few files contain what is worth a warning.
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
