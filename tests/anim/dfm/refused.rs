//! The reader refuses invalid files with the byte offset; the writer refuses invalid models with their place.

use super::frame::{byte_of, fix_checksums, parts};
use super::golden::{file, model};
use dragonfly_anim::data::{ModelData, Take};
use dragonfly_anim::format::dfm::{self, WriteError};
use std::sync::Arc;

/// Returns the offset of a part's first element.
fn elements(tag: &[u8; 4]) -> usize {
    let parts = parts(&file()).unwrap();
    let index = parts.iter().position(|part| part.0 == *tag).unwrap();
    parts[index].1
        + match index {
            0..5 => 8,
            5 => 16,
            _ => 12,
        }
}

/// Checks that the file with `number` at byte `at` and correct checksums is refused with the code and the place.
#[track_caller]
fn refused(at: usize, number: u32, code: &str, place: usize, words: &str) {
    let mut bytes = file();
    bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
    fix_checksums(&mut bytes);
    let error = dfm::read(&bytes).unwrap_err();
    assert_eq!((error.code(), byte_of(&error)), (code, place), "{error}");
    assert!(error.to_string().contains(words), "{error}");
}

#[test]
fn an_index_out_of_range_is_refused_at_its_element() {
    let bones = elements(b"BONE");
    refused(bones, 0, "DFM_INDEX", bones, "parent 0 does not come before its child 0");
    refused(bones, 1, "DFM_INDEX", bones, "parent 1 does not come before its child 0");
    refused(bones + 184, 1, "DFM_INDEX", bones + 184, "parent 1 does not come before its child 1");
    refused(bones + 4, 1, "DFM_INDEX", bones, "bone 0 has the index 1");
    let indices = elements(b"INDX");
    refused(indices + 8, 3, "DFM_INDEX", indices + 8, "index 3 is out of the range of vertices 0..3");
    refused(elements(b"ATTR"), 1, "DFM_INDEX", elements(b"ATTR"), "material 1, its primitive 0");
    refused(elements(b"PRIM") + 8, 5, "DFM_INDEX", elements(b"PRIM"), "there is no material 5");
    refused(elements(b"VERT") + 40, 2, "DFM_INDEX", elements(b"VERT"), "there is no bone 2");
    refused(elements(b"JOIN"), 2, "DFM_INDEX", elements(b"JOIN"), "there is no bone 2");
    let instance = elements(b"INST");
    refused(instance, 1, "DFM_INDEX", instance, "there is no mesh 1");
    refused(instance + 12, 1, "DFM_INDEX", instance, "there is no skin 1");
    refused(instance + 16, 2, "DFM_INDEX", instance, "there is no bone 2");
    // The last vertex has joint 0 four times, the first one joint 1; a skin with three joints would be valid.
    refused(
        elements(b"VERT") + 76,
        2,
        "DFM_INDEX",
        instance,
        "a vertex refers to joint 2, skin 0 has 2 joints",
    );
    refused(
        elements(b"MATL") + 40,
        0,
        "DFM_VALUE",
        elements(b"MATL"),
        "the texture is not that of the base color",
    );
}

#[test]
fn an_invalid_number_is_refused_at_its_element() {
    let takes = elements(b"TAKE");
    refused(takes + 8, 1, "DFM_VALUE", takes, "1 tracks for 2 bones");
    refused(takes + 16, 1, "DFM_INDEX", takes + 16, "track 0 is for bone 1");
    refused(takes + 24, 4, "DFM_VALUE", takes + 16, "interpolation 4 is not below 4");
    refused(takes + 40 + 44, 8, "DFM_VALUE", takes + 40, "the key bits 0x8 of a key-frame are invalid");
    refused(takes + 40 + 44, 0, "DFM_VALUE", takes + 40, "the key bits 0x0 of a key-frame are invalid");
    refused(elements(b"PRIM") + 12, 64, "DFM_VALUE", elements(b"PRIM"), "unknown bits");
    refused(elements(b"PRIM") + 16, 9, "DFM_VALUE", elements(b"PRIM"), "9 influences per vertex, at most 8");
    refused(
        elements(b"PRIM") + 4,
        2,
        "DFM_VALUE",
        elements(b"PRIM"),
        "2 indices are not a whole number of triangles",
    );
    refused(elements(b"MATL") + 88, 3, "DFM_VALUE", elements(b"MATL"), "alpha mode 3");
    let text = elements(b"TEXT");
    refused(text + 4, 0xffff_ffff, "DFM_TEXT", text + 4, "not UTF-8");
}

#[test]
fn counts_that_contradict_each_other_are_refused() {
    // One key-frame fewer in the track: its bytes are not used then.
    let takes = elements(b"TAKE");
    refused(takes + 32, 1, "DFM_COUNT", takes + 88, "there are more takes than the file uses, from here on");
    refused(takes + 32, 3, "DFM_COUNT", takes + 40, "there are no more takes, but the file needs more");
    refused(elements(b"MESH"), 2, "DFM_COUNT", elements(b"PRIM"), "there are no more primitives");
    refused(elements(b"PRIM"), 2, "DFM_INDEX", elements(b"INDX") + 8, "out of the range of vertices 0..2");
    // The size of an index.
    refused(elements(b"INDX") - 4, 2, "DFM_SIZE", elements(b"INDX") - 8, "3 indices of 2 bytes in 12 bytes");
    refused(elements(b"TAKE") - 4, 44, "DFM_SIZE", elements(b"TAKE") - 16, "elements of [16, 12, 44] bytes");
}

/// Checks that writing the golden model after `change` is refused with the place in the model.
#[track_caller]
fn not_written(change: impl FnOnce(&mut ModelData), message: &str) {
    let mut model = model();
    change(&mut model);
    let error = dfm::write(&model).unwrap_err();
    assert!(error.to_string().starts_with(message), "{error}");
}

#[test]
fn a_model_that_breaks_the_invariants_of_its_types_is_not_written() {
    not_written(
        |model| model.meshes[0].primitives[0].vertices.normals.truncate(2),
        "/meshes/0/primitives/0: 2 normals for 3 vertices",
    );
    not_written(
        |model| model.meshes[0].primitives[0].vertices.influences.truncate(11),
        "/meshes/0/primitives/0: 11 influences for 3 vertices with 4 each",
    );
    not_written(
        |model| model.meshes[0].primitives[0].indices[1] = 3,
        "/meshes/0/primitives/0: index 3 is out of the range of 3 vertices",
    );
    not_written(|model| model.meshes[0].morph_weights.push(1.0), "/meshes/0/primitives/0: 0 morph targets");
    not_written(
        |model| model.instances[0].morph_weights.push(1.0),
        "/instances/0: there are 1 morph weights for",
    );
    not_written(|model| model.skins[0].offsets.truncate(1), "/skins/0: 1 offsets for 2 joints");
    let take = |model: &mut ModelData, change: fn(&mut Take)| {
        let mut take = Take::clone(&model.animation.takes[0]);
        change(&mut take);
        model.animation.takes[0] = Arc::new(take);
    };
    not_written(|model| take(model, |take| drop(take.tracks.pop())), "/takes/0: 1 tracks for 2 bones");
    not_written(
        |model| take(model, |take| take.tracks.swap(0, 1)),
        "/takes/0/tracks/0: the track is for bone 1",
    );
    not_written(
        |model| take(model, |take| take.tracks[1].rotation.times = [0.0].into()),
        "/takes/0/tracks/1: rotation: the number of values does not match the 1 keys",
    );
    // Errors that are only detected when the file is read again.
    not_written(|model| model.skins[0].bones[0] = 9, "the model cannot be read back: byte ");
    let mut cycle = model();
    let mut skeleton = (*cycle.animation.skeleton).clone();
    skeleton.bones[0].parent = Some(1);
    cycle.animation.skeleton = Arc::new(skeleton);
    assert!(matches!(dfm::write(&cycle), Err(WriteError::Refused(_))));
}
