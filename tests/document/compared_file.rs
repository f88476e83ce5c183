//! A file to compare with is read by the document, through the same door as one that is opened.

use dragonfly_document::{DocumentMessage, DocumentReply, Source};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::{Folder, data};
use std::sync::Arc;

#[test]
fn a_file_to_compare_with_is_read_and_the_open_model_stays() {
    let folder = Folder::new("compared-file");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let before = document.view();
    document.send(DocumentMessage::ReadCompared(Source::File(data("gltf/SimpleSkin_embedded.gltf"))));
    let file = document.wait_for_reply(|reply| match reply {
        DocumentReply::ComparedRead(file) => Some(Arc::clone(file)),
        _ => None,
    });
    assert_eq!((file.title.as_str(), file.model.animation.takes.len()), ("SimpleSkin_embedded.gltf", 1));
    assert!(Arc::ptr_eq(&document.view().loaded, &before.loaded));
    for (name, bytes, wanted) in [("gone.glb", None, "gone.glb"), ("text.glb", Some("no model"), "text.glb")]
    {
        let path = folder.join(name);
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).unwrap();
        }
        document.send(DocumentMessage::ReadCompared(Source::File(path)));
        let reason = document.wait_for_reply(|reply| match reply {
            DocumentReply::Warning(reason) => Some(reason.clone()),
            _ => None,
        });
        assert!(reason.starts_with("Nothing is compared: ") && reason.contains(wanted), "{reason}");
    }
}
