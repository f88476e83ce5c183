//! Whatever happens in the child stays there: crashes, endless loops, floods, and attempts to get out are errors of the file.

use crate::support::{parser, read_with};
use dragonfly_anim::data::Take;
use dragonfly_anim::format::{
    ByteBudget, Conventions, EditedTake, Format, ImportContext, ImportError, NoFiles, ReadOptions,
};
use dragonfly_fbx::code::FBX_PARSER;
use dragonfly_fbx::{FBX, FbxParser};
use std::cell::Cell;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest time that any of these may take.
const SOON: Duration = Duration::from_secs(20);

/// Reads a file with a planted fault and returns the error.
fn error_of(parser: &FbxParser, fault: &str) -> ImportError {
    let start = Instant::now();
    let bytes = format!("FAULT {fault}").into_bytes();
    let read = read_with(|context| parser.read(&bytes, context), &bytes, &NoFiles, Conventions::default());
    let error = read.err().unwrap_or_else(|| panic!("{fault}: was read"));
    println!("{fault}: {error} ({:?})", start.elapsed());
    assert!(start.elapsed() < SOON, "{fault} took {:?}", start.elapsed());
    error
}

#[test]
fn a_crash_of_the_parser_is_an_error_of_the_file() {
    for (fault, reason) in [("abort", "crashed"), ("overflow", "crashed"), ("panic", "crashed")] {
        let error = error_of(&parser(), fault);
        assert_eq!(error.code(), FBX_PARSER, "{error}");
        assert!(error.to_string().contains(reason), "{error}");
    }
}

#[test]
fn a_parser_that_hangs_is_ended_at_the_deadline() {
    let error = error_of(&parser().with_deadline(Duration::from_millis(300)), "hang");
    assert!(error.to_string().contains("longer than 0.3 s"), "{error}");
}

#[test]
fn a_cancelled_import_ends_its_parser() {
    let start = Instant::now();
    let asked = Cell::new(0);
    let is_cancelled = || {
        asked.set(asked.get() + 1);
        asked.get() > 20
    };
    let options = ReadOptions { is_cancelled: &is_cancelled, ..ReadOptions::default() };
    let context = ImportContext::new(&NoFiles, &options);
    let result = parser().read(b"FAULT hang", &context);
    assert_eq!(result, Err(ImportError::Cancelled));
    assert!(start.elapsed() < SOON);
}

#[test]
fn a_parser_gets_no_more_memory_than_the_import_has() {
    let error = error_of(&parser(), "memory");
    assert!(error.to_string().contains("crashed"), "{error}");
    let options = ReadOptions { budget: ByteBudget::at_most(80_000), ..ReadOptions::default() };
    let bytes = crate::support::file("max_transformed_skin_7500_binary.fbx");
    let error = parser()
        .read(&bytes, &ImportContext::new(&NoFiles, &options))
        .expect_err("one mebibyte is too little");
    assert!(matches!(error, ImportError::TooLarge { .. }), "{error}");
}

#[test]
fn a_flood_of_output_is_cut_off() {
    let error = error_of(&parser(), "flood");
    assert!(matches!(error, ImportError::TooLarge { .. }), "{error}");
}

#[test]
fn an_answer_that_is_none_is_an_error() {
    for fault in ["garbage", "silent"] {
        let error = error_of(&parser(), fault);
        assert_eq!(error.code(), FBX_PARSER);
        assert!(error.to_string().contains("damaged"), "{error}");
    }
}

#[test]
fn a_program_that_cannot_be_started_or_is_no_parser_is_an_error() {
    let error = error_of(&FbxParser::new("/no/such/program"), "silent");
    assert!(error.to_string().contains("cannot be started"), "{error}");
    // This test program does not know the arguments.
    let error = error_of(&FbxParser::this_program().expect("a running program"), "silent");
    assert_eq!(error.code(), FBX_PARSER);
}

#[cfg(target_os = "linux")]
#[test]
fn the_parser_can_touch_nothing_outside() {
    let folder = dragonfly_kit::folder::Folder::new("fbx-cage");
    let path = folder.path().join("precious");
    std::fs::write(&path, b"precious").expect("a file");
    let new = folder.path().join("new");
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    listener.set_nonblocking(true).expect("a listener that does not block");
    let port = listener.local_addr().expect("an address");
    for fault in [
        "cage".to_owned(),
        format!("open {}", path.display()),
        "open /proc/self/maps".to_owned(),
        format!("list {}", folder.path().display()),
        format!("write {}", new.display()),
        format!("write {}", path.display()),
        format!("delete {}", path.display()),
        format!("connect {port}"),
        "listen".to_owned(),
        "spawn".to_owned(),
        "thread".to_owned(),
        "kill".to_owned(),
        "limit".to_owned(),
    ] {
        let error = error_of(&parser(), &fault);
        // 40: the attempt was refused; 41: it succeeded.
        assert!(error.to_string().contains("exit status: 40"), "{fault}: {error}");
    }
    assert!(!new.exists());
    assert_eq!(std::fs::read(&path).expect("the file"), b"precious");
    assert!(listener.accept().is_err(), "a connection arrived");
}

#[test]
fn the_row_is_found_by_content_and_name() {
    let row: Format = FBX;
    assert!((row.sniff)(&crate::support::file("maya_blend_shape_cube_7700_binary.fbx")));
    assert!((row.sniff)(&crate::support::file("maya_interpolation_modes_7500_ascii.fbx")));
    assert!(!(row.sniff)(b"glTF") && !(row.sniff)(b"; a comment of another format"));
    assert!(row.is_rewritten() && row.is_writable() && row.export.is_some());
}

#[test]
fn a_file_without_edits_keeps_its_bytes_compacted_or_not() {
    let bytes = crate::support::file("maya_interpolation_modes_7500_ascii.fbx");
    let model = crate::support::read_here(&bytes).expect("a model").model;
    let file = FBX.edit("a.fbx", bytes.clone(), &NoFiles, &ReadOptions::default()).expect("a file");
    let takes = model.animation.takes.iter().enumerate();
    let takes: Vec<EditedTake> =
        takes.map(|(origin, take)| EditedTake { origin: Some(origin), take: Arc::clone(take) }).collect();
    for plan in [file.plan(&model, &takes), file.compact(&model)] {
        let plan = plan.expect("a plan");
        assert!(plan.files[0].bytes == bytes && plan.files.len() == 1 && plan.lost.is_empty());
    }
    // With another name, the whole file is written again.
    let mut edited = takes;
    edited[0].take = Arc::new(Take { name: "other".into(), ..Take::clone(&edited[0].take) });
    assert!(file.plan(&model, &edited).expect("a plan").files[0].bytes != bytes);
}
