//! A document has limits while it is edited, as a file has when it is read.

use crate::projects::is_read;
use crate::save_and_open::open;
use crate::scenes::replaced;
use dragonfly_document::adapter::{EditError, KEY_BYTES, ModelAdapter};
use dragonfly_document::edit::{DuplicateKeys, Edit, KeySet, TakeRef};
use dragonfly_document::history::Edited;
use dragonfly_kit::counting::peak;
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::{Folder, data};

#[test]
fn keys_that_are_doubled_again_and_again_are_refused_at_a_limit_that_is_named() {
    let editable = open(&data("gltf/AnimatedTriangle_embedded.gltf"));
    let mut edited = Edited::new(ModelAdapter::new(&editable.model.animation));
    let mut by = 0.000_37;
    for _ in 0..30 {
        let keys = vec![KeySet::default()];
        let edit =
            Edit::DuplicateKeys(DuplicateKeys { take: TakeRef::Index(0), keys, shapes: Vec::new(), by });
        let before = edited.adapter().slots()[0].original.keys();
        let (memory, done) = peak(|| edited.ask(edit, None));
        match done {
            Ok(()) => by *= 2.1,
            Err(error) => {
                // Nothing is allocated for the keys themselves.
                assert!(memory < KEY_BYTES / 2, "{memory} bytes before it is refused");
                assert_eq!(edited.adapter().slots()[0].original.keys(), before);
                let limits = ["at most 16000000 can be saved", &format!("at most {} MiB", KEY_BYTES >> 20)];
                assert!(limits.iter().any(|limit| error.to_string().contains(limit)), "{error}");
                assert!(before > 1_000_000, "{before}");
                return;
            }
        }
    }
    panic!("{} keys", edited.adapter().slots()[0].original.keys());
}

#[test]
fn a_project_of_a_hundred_thousand_models_is_opened_and_edited_as_soon_as_its_text_is_read() {
    const MODELS: usize = 100_000;
    let folder = Folder::new("limits-project");
    let models: String =
        (0..MODELS).map(|number| format!("<model id=\"m{number}\" src=\"m{number}.glb\"/>\n")).collect();
    let text = format!(
        "<project version=\"1\" name=\"Crowd\"><models>\n{models}</models><script id=\"main\" src=\"main.xml\"/></project>"
    );
    assert!(text.len() > 3 << 20 && text.len() < 8 << 20, "{} bytes", text.len());
    let script = "<script version=\"1\"><cast><role id=\"a\" model=\"m99999\"/></cast></script>";
    let path = folder.join("crowd.meproj");
    std::fs::write(&path, &text).expect("a file");
    std::fs::write(folder.join("main.xml"), script).expect("a file");
    std::fs::copy(data("gltf/Fox.glb"), folder.join("m99999.glb")).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    // A look at each model for each of them would take longer than the test document waits.
    document.open(&path);
    document.wait_for_view(is_read);
    document.edit(replaced(&text, "Crowd", "All"));
    document.wait_for_view(|view| view.history.done == 1 && is_read(view));
}

#[test]
fn an_error_of_a_limit_names_the_limit() {
    let channel = EditError::TooManyKeys { keys: 20_000_000 }.to_string();
    assert_eq!(channel, "a channel would have 20000000 keys; at most 16000000 can be saved and opened again");
    let all = EditError::TooLarge { bytes: 600 << 20 }.to_string();
    assert_eq!(all, "the takes would have 600 MiB of keys; at most 512 MiB can be saved and opened again");
}
