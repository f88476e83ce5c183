//! A document has limits while it is edited, as a file has when it is read.

use crate::save_and_open::open;
use dragonfly_document::adapter::{EditError, KEY_BYTES, ModelAdapter};
use dragonfly_document::edit::{DuplicateKeys, Edit, KeySet, TakeRef};
use dragonfly_document::history::Edited;
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::data;

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
fn an_error_of_a_limit_names_the_limit() {
    let channel = EditError::TooManyKeys { keys: 20_000_000 }.to_string();
    assert_eq!(channel, "a channel would have 20000000 keys; at most 16000000 can be saved and opened again");
    let all = EditError::TooLarge { bytes: 600 << 20 }.to_string();
    assert_eq!(all, "the takes would have 600 MiB of keys; at most 512 MiB can be saved and opened again");
}
