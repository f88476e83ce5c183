//! The hash of everything that a scene or model is made of.

use dragonfly_document::{Cancel, Source, content_hash};
use dragonfly_kit::folder::Folder;
use std::fs;

const SCENE: &str = "<script version=\"1\"><cast><prop id=\"a\" model=\"m/box.gltf\"/></cast>\
    <sound src=\"none.wav\"/></script>";

const MODEL: &str = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"b.bin","byteLength":4}],
    "scenes":[{"nodes":[0]}],"nodes":[{}]}"#;

#[test]
fn the_hash_changes_with_every_file_that_is_needed_and_with_nothing_else() {
    let folder = Folder::new("content-hash");
    fs::create_dir(folder.join("m")).expect("a folder");
    let scene = folder.join("scene.xml");
    fs::write(&scene, SCENE).expect("a file");
    fs::write(folder.join("m/box.gltf"), MODEL).expect("a file");
    fs::write(folder.join("m/b.bin"), [1, 2, 3, 4]).expect("a file");
    let hash = || content_hash(&Source::File(scene.clone()), &Cancel::default()).expect("a hash");
    let first = hash();
    assert_eq!(hash(), first);
    fs::write(folder.join("m/other.bin"), "other").expect("a file");
    assert_eq!(hash(), first);
    let mut seen = vec![first];
    let mut changed = |name: &str, bytes: &[u8]| {
        fs::write(folder.join(name), bytes).expect("a file");
        let now = hash();
        assert!(!seen.contains(&now), "{name}");
        seen.push(now);
    };
    changed("m/b.bin", &[1, 2, 3, 5]);
    changed("m/box.gltf", format!("{MODEL} ").as_bytes());
    changed("none.wav", b"a sound");
    changed("scene.xml", SCENE.replace("</cast>", "</cast> ").as_bytes());
    // The same content elsewhere has the same hash.
    let copy = Folder::new("content-hash-copy");
    fs::create_dir(copy.join("m")).expect("a folder");
    for name in ["m/b.bin", "m/box.gltf", "none.wav", "scene.xml"] {
        fs::copy(folder.join(name), copy.join(name)).expect("a copy");
    }
    let there = content_hash(&Source::File(copy.join("scene.xml")), &Cancel::default()).expect("a hash");
    assert_eq!(there, hash());
    // A model alone.
    let source = Source::File(copy.join("m/box.gltf"));
    let before = content_hash(&source, &Cancel::default()).expect("a hash");
    fs::write(copy.join("m/b.bin"), [9; 4]).expect("a file");
    assert_ne!(content_hash(&source, &Cancel::default()).expect("a hash"), before);
    content_hash(&Source::BuiltIn, &Cancel::default()).expect("a hash");
    content_hash(&Source::File(copy.join("none.glb")), &Cancel::default()).expect_err("it is missing");
}
