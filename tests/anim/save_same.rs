//! Saving without an edit gives the same file, byte for byte, however it is formatted.

use crate::doors::{MemoryFs, model_files};
use crate::fixture::{Fixture, chunk, container, glb};
use crate::save_support::OpenedFile;
use dragonfly_anim::format::{AssetFs, NoFiles};

#[track_caller]
fn stays(name: &str, bytes: &[u8], door: &dyn AssetFs) -> OpenedFile {
    let opened = OpenedFile::new(name, bytes, door).unwrap_or_else(|error| panic!("{name}: {error}"));
    let saved = opened.saved(&opened.takes(), door);
    assert!(saved.bytes() == bytes, "{name}");
    assert!(saved.changes.is_empty() && saved.changes.files.is_empty(), "{name}: {}", saved.changes);
    assert_eq!(saved.files.len(), 1);
    opened
}

/// Checks that the file stays the same, and that an edit changes nothing else in it.
#[track_caller]
fn stays_and_can_be_edited(name: &str, bytes: &[u8], door: &dyn AssetFs) {
    let opened = stays(name, bytes, door);
    let mut takes = opened.takes();
    crate::save_edits::shift(&mut takes, 0);
    let saved = opened.saved(&takes, door);
    assert!(!saved.changes.is_empty(), "{name}");
    let again =
        saved.opened.saved(&saved.opened.takes(), &crate::save_support::Over::new(&saved.files, door));
    assert!(again.bytes() == saved.bytes(), "{name}");
}

#[test]
fn every_file_of_the_test_data_stays_the_same() {
    let all = model_files();
    for path in &all {
        let (opened, door) = OpenedFile::file(path);
        let saved = opened.saved(&opened.takes(), &door);
        assert!(saved.bytes() == &**opened.source.bytes(), "{}", path.display());
    }
    println!("{} files stay the same", all.len());
    assert!(all.len() >= 40);
}

/// Returns the fixture as text, with its buffer as a data URI.
fn text(pretty: bool) -> String {
    let text = String::from_utf8(Fixture::new().gltf()).unwrap();
    if pretty {
        serde_json::to_string_pretty(&serde_json::from_str::<serde_json::Value>(&text).unwrap()).unwrap()
    } else {
        text
    }
}

#[test]
fn unusual_spellings_of_json_keep_their_bytes() {
    let plain = text(false);
    let pretty = text(true);
    let odd = [
        ("a byte order mark", format!("\u{feff}{plain}")),
        ("carriage returns", pretty.replace('\n', "\r\n")),
        ("tabs", pretty.replace("  ", "\t")),
        ("spaces around", format!("\n\n  {pretty} \t\r\n")),
        (
            "spaces before colons and commas",
            pretty
                .replace(':', " :\t")
                .replace("data :\t", "data:")
                .replace(',', " ,\n")
                .replace("base64 ,\n", "base64,"),
        ),
        (
            "numbers",
            pretty
                .replace("0.5", "5e-1")
                .replace("\"rotation\": [", "\"rotation\": [ ")
                .replace("1.0", "1.000E+0"),
        ),
        (
            "escaped names",
            plain
                .replace("\"animations\"", "\"\\u0061nimations\"")
                .replace("\"samplers\"", "\"sampl\\u0065rs\"")
                .replace("\"path\"", "\"\\u0070ath\""),
        ),
        ("unknown members", plain.replacen('{', "{\"one\":{\"two\":[{},[],null,-0.0,true]},", 1)),
        (
            "extras",
            plain.replace("\"channels\"", "\"extras\":{\"animations\":[{\"a\":1,\"a\":2}]},\"channels\""),
        ),
        ("duplicates in what is not read", plain.replacen('{', "{\"extras\":{\"a\":1,\"a\":{\"b\":1}},", 1)),
        ("slashes escaped", plain.replace("application/octet-stream", "application\\/octet-stream")),
    ];
    for (what, text) in odd {
        println!("{what}");
        assert!(what == "spaces around" || text != plain && text != pretty, "{what} is not there");
        stays_and_can_be_edited("odd.gltf", text.as_bytes(), &NoFiles);
        let fixture = Fixture::new();
        let text = text.as_bytes();
        // The same text in a container, with its buffer still a data URI.
        stays_and_can_be_edited("odd.glb", &glb(text, None), &NoFiles);
        // The binary chunk belongs to no buffer then.
        stays_and_can_be_edited("odd.glb", &glb(text, Some(&fixture.bin)), &NoFiles);
    }
}

#[test]
fn unusual_containers_keep_their_bytes() {
    let fixture = Fixture::new();
    let json = serde_json::to_vec(&fixture.json).unwrap();
    let pad = |json: &[u8], with: &[u8]| {
        let mut json = json.to_vec();
        json.extend(with);
        json
    };
    let chunks = |json: &[u8], bin: &[u8], more: &[u8]| {
        container(&[chunk(b"JSON", json), chunk(b"BIN\0", bin), more.to_vec()].concat())
    };
    let bin = &fixture.bin;
    let longer = pad(bin, &[7; 40]);
    let odd = [
        ("no padding", chunks(&json, bin, b"")),
        ("ten spaces", chunks(&pad(&json, &[b' '; 10]), bin, b"")),
        ("a newline", chunks(&pad(&json, b"\n"), bin, b"")),
        ("zeros", chunks(&pad(&json, b"\0\0\0"), bin, b"")),
        ("spaces and zeros", chunks(&pad(&json, b"  \0"), bin, b"")),
        ("a byte order mark", chunks(&pad(b"\xef\xbb\xbf", &json), bin, b"")),
        ("a chunk more", chunks(&json, bin, &chunk(b"what", b"abcdefgh"))),
        ("two chunks more", chunks(&json, bin, &[chunk(b"what", b"abc"), chunk(b"BIN\0", b"defg")].concat())),
        ("bytes behind", pad(&chunks(&json, bin, b""), b"trailing")),
        ("a longer chunk", chunks(&json, &longer, b"")),
        ("a chunk of odd length", chunks(&json, &longer[..longer.len() - 3], b"")),
    ];
    for (what, bytes) in odd {
        println!("{what}");
        stays_and_can_be_edited("odd.glb", &bytes, &NoFiles);
    }
}

#[test]
fn files_with_several_buffers_keep_their_bytes() {
    let fixture = Fixture::new();
    let beside = fixture.gltf_with_file();
    let name = fixture_bin_name(&beside);
    let door = MemoryFs::with(&[(&name, &fixture.bin), ("other.bin", &[1, 2, 3, 4])]);
    stays_and_can_be_edited("beside.gltf", &beside, &door);
    // Buffer 0 of a container in a separate file.
    stays_and_can_be_edited("beside.glb", &glb(&beside, None), &door);
    stays_and_can_be_edited("beside.glb", &glb(&beside, Some(b"????")), &door);
    let mut several = Fixture::new();
    let buffers = several.json["buffers"].as_array_mut().unwrap();
    buffers.push(serde_json::json!({"byteLength": 4, "uri": "other.bin"}));
    buffers
        .push(serde_json::json!({"byteLength": 3, "uri": "data:application/octet-stream;base64,AQIDBA=="}));
    stays_and_can_be_edited("several.glb", &several.glb(), &door);
    stays_and_can_be_edited("several.gltf", &several.gltf(), &door);
}

fn fixture_bin_name(gltf: &[u8]) -> String {
    let json: serde_json::Value = serde_json::from_slice(gltf).unwrap();
    json["buffers"][0]["uri"].as_str().unwrap().to_owned()
}

#[test]
fn animations_can_be_added_to_a_file_without_any() {
    for (name, text) in [
        (
            "bare.gltf",
            "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"name\":\"a\"}],\"skins\":[{\"joints\":[0]}]}",
        ),
        (
            "bare.gltf",
            "{\n  \"asset\": {\n    \"version\": \"2.0\"\n  },\n  \"nodes\": [\n    {\"name\": \"a\"}\n  ],\n  \"skins\": [\n    {\"joints\": [0]}\n  ]\n}\n",
        ),
    ] {
        for bytes in [text.as_bytes().to_vec(), glb(text.as_bytes(), None)] {
            let opened = stays(name, &bytes, &NoFiles);
            let mut take = crate::support::take(vec![crate::save_edits::moving_track()]);
            take.name = "new".to_owned();
            let now = [dragonfly_anim::format::EditedTake { origin: None, take: take.into() }];
            let saved = opened.saved(&now, &NoFiles);
            println!("{}", String::from_utf8_lossy(saved.bytes()));
            assert_eq!(saved.json()["animations"].as_array().unwrap().len(), 1);
        }
    }
}

#[test]
fn new_values_are_formatted_like_their_neighbors() {
    let opened = OpenedFile::alone("pretty.gltf", text(true).as_bytes());
    let mut takes = opened.takes();
    crate::save_edits::shift(&mut takes, 0);
    let bones = opened.model.animation.skeleton.len() as u32;
    let track = |bone| dragonfly_anim::data::Track { bone, ..crate::save_edits::moving_track() };
    let take = crate::support::take((0..bones).map(track).collect());
    takes.push(dragonfly_anim::format::EditedTake { origin: None, take: take.into() });
    takes.push(takes[0].clone());
    // The same lines in any order of members, whose commas may differ too.
    let lines = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(|line| line.trim_end_matches(',').to_owned()).collect();
        lines.sort();
        lines
    };
    let plain = opened.saved(&takes, &NoFiles);
    let plain = String::from_utf8(plain.bytes().to_vec()).unwrap();
    let json: serde_json::Value = serde_json::from_str(&plain).unwrap();
    let expected = lines(&serde_json::to_string_pretty(&json).unwrap());
    for (got, expected) in lines(&plain).iter().zip(&expected) {
        assert_eq!(got, expected);
    }
    for (from, to) in [("\n", "\r\n"), ("  ", "\t"), ("  ", "    "), (": ", " : ")] {
        let source = text(true).replace(from, to);
        let saved = OpenedFile::alone("pretty.gltf", source.as_bytes()).saved(&takes, &NoFiles);
        assert_eq!(String::from_utf8(saved.bytes().to_vec()).unwrap(), plain.replace(from, to), "{to:?}");
    }
    let minified = OpenedFile::alone("small.gltf", text(false).as_bytes()).saved(&takes, &NoFiles);
    assert!(!minified.bytes().contains(&b'\n') && !minified.bytes().contains(&b' '));
}
