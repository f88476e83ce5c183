//! A file can refer to files of its own folder, and to nothing else.

use crate::doors::MemoryFs;
use crate::fixture::Fixture;
use dragonfly_anim::format::uri::{DataUri, relative_path};
use dragonfly_anim::format::{AssetError, AssetFs, ImportError, ReadOptions, read};
use serde_json::json;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// Names that lead elsewhere, or could on some system.
const HOSTILE: [&str; 40] = [
    "",
    "/etc/hostname",
    "//server/share/all.bin",
    "\\\\server\\share\\all.bin",
    "../all.bin",
    "textures/../../all.bin",
    "..",
    ".",
    "./",
    "%2e%2e/all.bin",
    "%2E%2E/all.bin",
    ".%2e/all.bin",
    "%2e%2e%2fall.bin",
    "..%5call.bin",
    "..\\all.bin",
    "C:\\all.bin",
    "C:/all.bin",
    "c:all.bin",
    "file:///etc/hostname",
    "FILE:/etc/hostname",
    "http://example.com/all.bin",
    "https://example.com/all.bin",
    "ftp:all.bin",
    "javascript:alert(1)",
    "all.bin%00.png",
    "all\u{0}.bin",
    "all.bin\n",
    "%",
    "%4",
    "%zz.bin",
    "%ff%fe.bin",
    "all.bin.",
    "all.bin ",
    "folder /all.bin",
    "folder//all.bin",
    "all.bin/",
    "NUL",
    "con.bin",
    "com1",
    "all.bin:stream",
];

fn with_uri(uri: &str) -> Vec<u8> {
    let mut fixture = Fixture::new();
    fixture.set("/buffers/0/uri", json!(uri));
    fixture.json.to_string().into_bytes()
}

#[test]
fn dangerous_uris_are_refused_before_anything_is_opened() {
    let long = "a/".repeat(600) + "all.bin";
    let longer = "a".repeat(300);
    let huge = "a".repeat(1 << 20);
    let all = HOSTILE.iter().copied().chain([long.as_str(), longer.as_str(), huge.as_str()]);
    let mut count = 0;
    for uri in all {
        let door = MemoryFs::default();
        let start = Instant::now();
        let error = read("a.gltf", &with_uri(uri), &door, &ReadOptions::default()).unwrap_err();
        assert!(start.elapsed() < Duration::from_secs(1));
        assert_eq!(door.asked(), [""; 0], "{uri:?}");
        assert!(matches!(error, ImportError::External { .. }), "{uri:?}: {error}");
        let message = error.to_string();
        assert!(
            message.starts_with("/buffers/0/uri: ") && message.len() < 500 && !message.contains('\n'),
            "{message}"
        );
        count += 1;
    }
    println!("{count} hostile URIs");
    assert!(count >= 24);
}

#[test]
fn an_image_with_a_dangerous_uri_is_left_out_and_not_opened() {
    for uri in HOSTILE {
        let mut fixture = Fixture::new();
        fixture.remove("/images/0/bufferView").set("/images/0/uri", json!(uri));
        let door = MemoryFs::default();
        let imported = read("a.glb", &fixture.glb(), &door, &ReadOptions::default()).unwrap();
        assert_eq!(door.asked(), [""; 0], "{uri:?}");
        assert_eq!(imported.warnings.len(), 1, "{uri:?}: {:?}", imported.warnings);
        assert!(imported.model.images[0].bytes.is_empty());
    }
}

#[test]
fn ordinary_names_are_decoded_once() {
    for (uri, path) in [
        ("all.bin", "all.bin"),
        ("./all.bin", "all.bin"),
        ("folder/./all.bin", "folder/all.bin"),
        ("with%20blank.bin", "with blank.bin"),
        ("%61ll.bin", "all.bin"),
        ("%2561ll.bin", "%61ll.bin"),
        ("%252e%252e", "%2e%2e"),
        ("sch%C3%B6n.bin", "schön.bin"),
        ("schön.bin", "schön.bin"),
        (".hidden", ".hidden"),
        ("..hidden", "..hidden"),
        ("a..b", "a..b"),
        ("console.bin", "console.bin"),
        ("com10", "com10"),
    ] {
        assert_eq!(relative_path(uri).as_deref(), Ok(path), "{uri}");
    }
}

#[test]
fn data_uris_are_decoded() {
    let decode = |uri: &str| {
        let mut bytes = Vec::new();
        DataUri::parse(uri)?.and_then(|data| data.decode(&mut bytes)).ok()?;
        Some(bytes)
    };
    assert_eq!(decode("data:;base64,AAEC").unwrap(), [0, 1, 2]);
    assert_eq!(decode("DATA:application/octet-stream;base64,AAE=").unwrap(), [0, 1]);
    assert_eq!(decode("data:;base64,/+8").unwrap(), [255, 239]);
    assert_eq!(decode("data:text/plain,a%20b").unwrap(), b"a b");
    assert_eq!(decode("data:,").unwrap(), b"");
    for bad in ["data:;base64,A", "data:;base64,AA*A", "data:;base64", "data:,%x", "all.bin", "dat"] {
        assert_eq!(decode(bad), None, "{bad}");
    }
    assert_eq!(DataUri::parse("data:image/png;base64,").unwrap().unwrap().mime, "image/png");
}

#[test]
fn each_external_file_is_read_once_and_their_number_is_limited() {
    let mut fixture = Fixture::new();
    let bin = fixture.bin.clone();
    fixture.set("/buffers/0/uri", json!("all.bin"));
    for number in 1..50 {
        fixture.set(&format!("/buffers/{number}"), json!({"byteLength": 4, "uri": "./all.bin"}));
    }
    let door = MemoryFs::with(&[("all.bin", &bin)]);
    read("a.gltf", fixture.json.to_string().as_bytes(), &door, &ReadOptions::default()).unwrap();
    assert_eq!(door.asked(), ["all.bin"]);

    /// Access to a file under every name.
    struct Endless(Cell<usize>);
    impl AssetFs for Endless {
        fn read(&self, _path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
            self.0.set(self.0.get() + 1);
            Ok(vec![0; 4])
        }
    }
    for number in 0..2_000 {
        fixture.set(&format!("/buffers/{number}"), json!({"byteLength": 4, "uri": format!("{number}.bin")}));
    }
    let door = Endless(Cell::new(0));
    let error =
        read("a.gltf", fixture.json.to_string().as_bytes(), &door, &ReadOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "/buffers/1024/uri: external files: 1025, at most 1024");
    assert_eq!(door.0.get(), 1_024);
}
