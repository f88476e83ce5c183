//! The document thread opens models, reports errors, can be cancelled, and always sends a reply.

use dragonfly_anim::data::Image;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_document::images::{ImageSurvey, SurveyedImage};
use dragonfly_document::{
    Cancel, Change, Document, DocumentHandle, DocumentReply, LoadError, LoadedModel, OpenedModel, Progress,
    Setup, Source, View, load_model,
};
use dragonfly_kit::document::arm;
use dragonfly_kit::document::received::Received;
use dragonfly_kit::eventually;
use dragonfly_runtime::{Stage, Thread, ThreadHandle};
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[test]
fn the_built_in_model_opens_and_reports_progress() {
    let mut steps = Vec::new();
    let loaded =
        load_model(&Source::BuiltIn, &mut |progress| steps.push(progress.done), &Cancel::default()).unwrap();
    assert_eq!(loaded.title, "Dragonfly");
    assert!(loaded.path.is_none());
    assert!(loaded.model.animation.takes.len() >= 3);
    assert!((0..loaded.model.images.len() as u32).all(|index| loaded.images.get(index).is_some()));
    assert_eq!(loaded.warnings, [""; 0]);
    assert!(loaded.bounds.sphere.radius > 0.0);
    assert!(steps.windows(2).all(|pair| pair[0] <= pair[1]), "{steps:?}");
    assert_eq!(steps.last(), Some(&1.0));
}

#[test]
fn a_cancelled_load_returns_the_cancelled_error() {
    let cancel = Cancel::default();
    cancel.cancel();
    let result = load_model(&Source::BuiltIn, &mut |_| {}, &cancel);
    assert!(matches!(result, Err(LoadError::Cancelled)));
}

#[test]
fn a_file_that_does_not_exist_is_named_in_the_error() {
    let source = Source::File(PathBuf::from("/nowhere/fox.glb"));
    let error = load_model(&source, &mut |_| {}, &Cancel::default()).unwrap_err();
    assert!(error.to_string().starts_with("/nowhere/fox.glb: "), "{error}");
}

#[test]
fn the_open_model_stays_open_when_loading_another_file_fails() {
    let heard = Received::<DocumentReply>::default();
    let mut main = Thread::capture("main", || {});
    let replies = main.context().register_receiver(heard.clone());
    let picture = main.context().register_receiver(Received::<View>::default());
    let document = Document::start(replies, picture).unwrap();
    document.open(Source::BuiltIn);
    let mut wait = |what: fn(&DocumentReply) -> bool| {
        eventually(Duration::from_secs(30), || {
            main.iterate();
            heard.0.borrow().iter().any(what)
        });
    };
    wait(|reply| matches!(reply, DocumentReply::View(_)));
    wait(|reply| matches!(reply, DocumentReply::Loading { .. }));
    document.open(Source::File(PathBuf::from("/nowhere/fox.glb")));
    wait(|reply| matches!(reply, DocumentReply::Failed { .. }));
    let views = heard.0.borrow().iter().filter(|reply| matches!(reply, DocumentReply::View(_))).count();
    assert_eq!(views, 1, "nothing else was published");
    document.stop();
    Thread::wait_for(&[document.thread().clone()], Instant::now() + Duration::from_secs(5)).unwrap();
}

/// Returns the header of a PNG that declares this size.
fn claims(width: u32, height: u32) -> Image {
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    bytes.extend(width.to_be_bytes());
    bytes.extend(height.to_be_bytes());
    bytes.extend([8, 6, 0, 0, 0]);
    let checksum = crc(&bytes[12..]);
    bytes.extend(checksum.to_be_bytes());
    bytes.extend(b"\0\0\0\0IDAT");
    bytes.extend(crc(b"IDAT").to_be_bytes());
    Image { name: "huge".to_owned(), bytes: bytes.into(), ..Image::default() }
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| (sum >> 1) ^ (0xEDB8_8320 & (sum & 1).wrapping_neg()))
    })
}

#[test]
fn an_image_with_an_oversized_header_only_causes_a_warning() {
    for (width, height) in [(60_000, 60_000), (16_385, 1), (12_000, 12_000), (u32::MAX, 1), (0, 0)] {
        let images = [claims(width, height)];
        let (survey, warnings) = ImageSurvey::new(&images, u64::MAX, &Cancel::default());
        assert_eq!(survey.get(0), None);
        assert!(survey.decode(&images, 0, 0).is_err());
        assert_eq!(warnings.len(), 1);
        assert!(warnings[0].starts_with("image 0 \"huge\" is not shown: "), "{}", warnings[0]);
    }
}

#[test]
fn images_of_one_source_are_one_image() {
    let mut png = Vec::new();
    let pixels = image::RgbaImage::from_pixel(3, 2, image::Rgba([1, 2, 3, 4]));
    pixels.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).unwrap();
    let image = Image { bytes: png.into(), ..Image::default() };
    let images = [image.clone(), image];
    let (survey, _) = ImageSurvey::new(&images, u64::MAX, &Cancel::default());
    assert_eq!(survey.get(0), survey.get(1));
    assert_eq!(survey.get(1).map(SurveyedImage::source), Some(0));
    let decoded = survey.decode(&images, 1, 0).unwrap();
    assert_eq!((decoded.width, decoded.height, decoded.pixels.len()), (3, 2, 24));
}

/// Importer that panics in one of three ways on every file, and opens the built-in model.
fn panics_on_files(
    source: &Source,
    progress: &mut dyn FnMut(Progress),
    cancel: &Cancel,
) -> Result<OpenedModel, LoadError> {
    match source {
        Source::BuiltIn => load_model(source, progress, cancel).map(OpenedModel::from),
        Source::File(path) | Source::FileAs(path, _) => match path.as_os_str().len() % 3 {
            0 => panic!("a text without numbers"),
            1 => panic!("a text about {}", path.display()),
            _ => std::panic::panic_any(path.clone()),
        },
    }
}

#[test]
fn a_hundred_importer_panics_are_reported_and_the_document_keeps_running() {
    let heard = Received::<DocumentReply>::default();
    let mut main = Thread::capture("main", || {});
    let replies = main.context().register_receiver(heard.clone());
    let picture = main.context().register_receiver(Received::<View>::default());
    let document =
        Document::start_with(Setup { load: panics_on_files, ..Setup::default() }, replies, picture).unwrap();
    let mut wait = |what: &dyn Fn(&[DocumentReply]) -> bool| {
        eventually(Duration::from_secs(30), || {
            main.iterate();
            what(&heard.0.borrow())
        });
    };
    let views = |heard: &[DocumentReply]| {
        heard.iter().filter(|reply| matches!(reply, DocumentReply::View(_))).count()
    };
    document.open(Source::BuiltIn);
    wait(&|heard| views(heard) == 1);
    for number in 1..=100 {
        document.open(Source::File("x".repeat(number).into()));
        wait(&|heard| {
            let failed = |reply: &&DocumentReply| matches!(reply, DocumentReply::Failed { reason, .. } if reason.contains("the importer failed"));
            heard.iter().filter(failed).count() == number
        });
    }
    // The document still opens valid files.
    document.open(Source::BuiltIn);
    wait(&|heard| views(heard) == 2);
    document.stop();
    Thread::wait_for(&[document.thread().clone()], Instant::now() + Duration::from_secs(5)).unwrap();
}

/// Importer that opens every file at once, as the same small model with the name of the file.
fn opens_anything(
    source: &Source,
    _: &mut dyn FnMut(Progress),
    _: &Cancel,
) -> Result<OpenedModel, LoadError> {
    let loaded = std::sync::Arc::into_inner(arm::loaded()).unwrap();
    Ok(LoadedModel { title: source.title(), ..loaded }.into())
}

/// The three threads, whose iterations are run by the test.
struct DocumentBench {
    stage: Stage,
    main: ThreadHandle,
    thread: ThreadHandle,
    graphics: ThreadHandle,
    document: DocumentHandle,
    heard: Received<DocumentReply>,
    picture: Received<View>,
}

impl DocumentBench {
    fn new() -> Self {
        let (mut stage, heard) = (Stage::default(), Received::<DocumentReply>::default());
        let [main, thread, graphics] = ["main", "document", "graphics"].map(|name| stage.start(name));
        let picture = Received::<View>::default();
        let shown = stage.context(&graphics).register_receiver(picture.clone());
        let replies = stage.context(&main).register_receiver(heard.clone());
        let setup = Setup { load: opens_anything, ..Setup::default() };
        let document = Document::start_in(&thread, setup, replies, shown);
        stage.iterate(&thread);
        Self { stage, main, thread, graphics, document, heard, picture }
    }

    /// Opens a file and delivers the messages until the document has changed; the iteration of its thread is not
    /// finished yet.
    fn change(&mut self, name: &str) {
        self.document.open(Source::File(name.into()));
        assert!(self.stage.deliver(&self.thread, 0), "what was asked for");
        // The job replies from its own thread.
        eventually(Duration::from_secs(30), || self.stage.deliver(&self.thread, 0));
    }

    /// Runs one iteration of the main thread. Returns the received views and the models reported as open.
    fn deliver(&mut self) -> (Vec<(u64, String)>, Vec<String>) {
        self.stage.iterate(&self.main);
        let (mut views, mut opened) = (Vec::new(), Vec::new());
        for reply in self.heard.0.borrow_mut().drain(..) {
            match reply {
                DocumentReply::View(view) => views.push((view.generation, view.loaded.title.clone())),
                DocumentReply::Opened(loaded) => opened.push(loaded.title.clone()),
                other => panic!("{other:?}"),
            }
        }
        (views, opened)
    }
}

#[test]
fn a_hundred_changes_in_one_iteration_send_only_the_newest_view() {
    let mut bench = DocumentBench::new();
    let names: Vec<String> = (1..=100).map(|number| format!("{number}.glb")).collect();
    for name in &names {
        bench.change(name);
    }
    assert_eq!(bench.main.counters().replaced, 0);
    let (views, opened) = bench.deliver();
    assert!(views.is_empty(), "nothing half done is shown: {views:?}");
    assert_eq!(opened, names, "nothing is lost of what each one says");
    bench.stage.iterate(&bench.thread);
    assert_eq!(bench.deliver().0, [(100, "100.glb".to_owned())]);
    assert_eq!(bench.main.counters().replaced, 0, "one was sent");
    bench.stage.iterate(&bench.thread);
    assert!(bench.deliver().0.is_empty(), "without a change there is no other");
}

#[test]
fn views_do_not_accumulate_while_the_main_thread_is_busy() {
    let mut bench = DocumentBench::new();
    for number in 1..=10 {
        bench.change(&format!("{number}.glb"));
        bench.stage.iterate(&bench.thread);
    }
    let (views, opened) = bench.deliver();
    assert_eq!(views, [(10, "10.glb".to_owned())]);
    assert_eq!(opened.len(), 10);
    bench.change("last.glb");
    bench.stage.iterate(&bench.thread);
    assert_eq!(bench.deliver().0, [(11, "last.glb".to_owned())], "the next one comes as well");
}

#[test]
fn the_graphics_thread_receives_the_newest_view_while_the_main_thread_is_blocked() {
    let mut bench = DocumentBench::new();
    for number in 1..=10 {
        bench.change(&format!("{number}.glb"));
        bench.stage.iterate(&bench.thread);
    }
    bench.stage.iterate(&bench.graphics);
    let generations: Vec<u64> = bench.picture.0.borrow().iter().map(|view| view.generation).collect();
    assert_eq!(generations, [10], "one that falls behind finds the newest only");
    bench.change("last.glb");
    bench.stage.iterate(&bench.thread);
    bench.stage.iterate(&bench.graphics);
    assert_eq!(bench.picture.0.borrow()[1].loaded.title, "last.glb");
    assert!(bench.heard.0.borrow().is_empty(), "the main thread had no part in it");
}

#[test]
fn an_edit_reaches_panels_and_viewport_and_an_invalid_one_is_refused_with_a_reason() {
    let heard = Received::<DocumentReply>::default();
    let shown = Received::<View>::default();
    let mut main = Thread::capture("main", || {});
    let replies = main.context().register_receiver(heard.clone());
    let picture = main.context().register_receiver(shown.clone());
    let document = Document::start(replies, picture).unwrap();
    document.open(Source::BuiltIn);
    let newest = || shown.0.borrow().last().cloned();
    let mut wait = |what: &dyn Fn() -> bool| {
        eventually(Duration::from_secs(30), || {
            main.iterate();
            what()
        });
    };
    wait(&|| newest().is_some());
    let opened = newest().unwrap();
    assert!(opened.history.saved && opened.history.steps.is_empty());
    let rename = |take: usize| {
        Change::Edit(
            Edit::RenameTake(RenameTake { take: TakeRef::Index(take), name: "Stroll".to_owned() }),
            None,
        )
    };
    document.change(rename(0));
    wait(&|| newest().is_some_and(|view| view.generation == 2));
    let edited = newest().unwrap();
    assert_eq!(edited.takes[0].name, "Stroll");
    assert!(std::sync::Arc::ptr_eq(&edited.loaded, &opened.loaded), "the model is the same one");
    assert!(std::sync::Arc::ptr_eq(&edited.takes[1], &opened.takes[1]), "and so is what was not touched");
    assert_eq!(
        (edited.history.steps.as_slice(), edited.history.done, edited.history.saved),
        (&["Rename take"][..], 1, false)
    );
    document.change(rename(99));
    let refused = |reply: &DocumentReply| matches!(reply, DocumentReply::Refused(reason) if reason == "There is no take 99");
    wait(&|| heard.0.borrow().iter().any(refused));
    document.change(Change::Undo);
    wait(&|| newest().is_some_and(|view| view.generation == 3));
    let undone = newest().unwrap();
    assert_eq!(
        (undone.takes[0].name.as_str(), undone.history.done, undone.history.saved),
        (opened.takes[0].name.as_str(), 0, true)
    );
    document.stop();
    Thread::wait_for(&[document.thread().clone()], Instant::now() + Duration::from_secs(5)).unwrap();
}
