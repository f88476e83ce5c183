//! Opens, saves and reopens files, and compares the result with the edits.

use crate::doors::TestFolder;
use dragonfly_anim::data::{Channel, ModelData, MorphTrack, Take, Track};
use dragonfly_anim::format::gltf::save::{Changes, MARK, SaveError, SourceFile, plan};
use dragonfly_anim::format::{
    AssetError, AssetFs, EditedTake, ImportError, NoFiles, OutputFile, ReadOptions, read,
};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Access to saved files, and for all others to those in `under`.
pub(crate) struct Over<'a> {
    pub(crate) files: HashMap<String, Vec<u8>>,
    pub(crate) under: &'a dyn AssetFs,
}

impl<'a> Over<'a> {
    pub(crate) fn new(files: &[OutputFile], under: &'a dyn AssetFs) -> Self {
        Self { files: files.iter().map(|file| (file.name.clone(), file.bytes.clone())).collect(), under }
    }
}

impl AssetFs for Over<'_> {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        match self.files.get(path) {
            Some(bytes) => Ok(bytes.clone()),
            None => self.under.read(path, limit),
        }
    }
}

/// A file with its model.
pub(crate) struct OpenedFile {
    pub(crate) source: SourceFile,
    pub(crate) model: ModelData,
}

impl OpenedFile {
    pub(crate) fn new(name: &str, bytes: &[u8], door: &dyn AssetFs) -> Result<Self, ImportError> {
        let model = read(name, bytes, door, &ReadOptions::default())?.model;
        let source = SourceFile::open(name, bytes, door, &ReadOptions::default())?;
        Ok(Self { source, model })
    }

    /// Opens a file without referenced files.
    pub(crate) fn alone(name: &str, bytes: &[u8]) -> Self {
        Self::new(name, bytes, &NoFiles).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Opens a file together with those in its folder.
    pub(crate) fn file(path: &Path) -> (Self, TestFolder) {
        let door = TestFolder(path.parent().unwrap().to_owned());
        let name = path.file_name().unwrap().to_str().unwrap();
        let opened = Self::new(name, &std::fs::read(path).unwrap(), &door);
        (opened.unwrap_or_else(|error| panic!("{}: {error}", path.display())), door)
    }

    /// Returns the takes unchanged, in their order.
    pub(crate) fn takes(&self) -> Vec<EditedTake> {
        let takes = self.model.animation.takes.iter().enumerate();
        takes.map(|(index, take)| EditedTake { origin: Some(index), take: take.clone() }).collect()
    }

    /// Saves, checks that the rest stays, reopens the file and checks that it has the edits.
    #[track_caller]
    pub(crate) fn saved(&self, now: &[EditedTake], door: &dyn AssetFs) -> ReopenedFile {
        self.try_saved(now, door).unwrap_or_else(|error| panic!("{}: {error}", self.source.name()))
    }

    #[track_caller]
    pub(crate) fn try_saved(
        &self,
        now: &[EditedTake],
        door: &dyn AssetFs,
    ) -> Result<ReopenedFile, SaveError> {
        let plan = plan(&self.source, &self.model, now)?;
        let files = plan.write();
        let changes = plan.changes().clone();
        rest_stays(self.source.bytes(), &files.last().unwrap().bytes, &changes);
        assert_eq!(files.last().unwrap().name, self.source.name());
        let over = Over::new(&files, door);
        let bytes = &files.last().unwrap().bytes;
        let opened = OpenedFile::new(self.source.name(), bytes, &over);
        let opened = opened.unwrap_or_else(|error| {
            panic!("{}: the saved file cannot be opened: {error}\n{changes}", self.source.name())
        });
        bounds_are_exact(bytes);
        same_scene(&self.model, &opened.model);
        same_takes(&self.model, now, &opened.model);
        Ok(ReopenedFile { opened, files, changes })
    }
}

/// A file that was saved and reopened.
pub(crate) struct ReopenedFile {
    pub(crate) opened: OpenedFile,
    pub(crate) files: Vec<OutputFile>,
    pub(crate) changes: Changes,
}

impl ReopenedFile {
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.files.last().unwrap().bytes
    }

    /// Returns the JSON of the file.
    pub(crate) fn json(&self) -> serde_json::Value {
        json_of(self.bytes())
    }
}

/// The JSON text of a file, the kinds and bytes of the chunks after it, and the bytes after the container.
struct FileParts<'a> {
    text: &'a [u8],
    chunks: Vec<[&'a [u8]; 2]>,
    rest: &'a [u8],
}

fn parts(file: &[u8]) -> FileParts<'_> {
    if !file.starts_with(b"glTF") {
        return FileParts { text: file, chunks: Vec::new(), rest: b"" };
    }
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let (mut at, end) = (12, word(8));
    let mut chunks = Vec::new();
    while at < end {
        chunks.push([&file[at + 4..at + 8], &file[at + 8..at + 8 + word(at)]]);
        at += 8 + word(at);
    }
    FileParts { text: chunks.remove(0)[1], chunks, rest: &file[end..] }
}

pub(crate) fn json_of(file: &[u8]) -> serde_json::Value {
    let text = parts(file).text;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let zeros = text.iter().rev().take_while(|&&byte| byte == 0).count();
    serde_json::from_slice(&text[..text.len() - zeros]).unwrap()
}

/// Returns the binary chunk.
pub(crate) fn bin_of(file: &[u8]) -> Vec<u8> {
    let chunks = parts(file).chunks;
    chunks.first().filter(|chunk| chunk[0] == b"BIN\0").map(|chunk| chunk[1].to_vec()).unwrap_or_default()
}

/// Checks that saved accessors have the first and the last key time as minimum and maximum, in both precisions.
#[track_caller]
fn bounds_are_exact(file: &[u8]) {
    let (json, bin) = (json_of(file), bin_of(file));
    let ours = json["accessors"].as_array().into_iter().flatten().filter(|accessor| accessor["name"] == MARK);
    for accessor in ours.filter(|accessor| accessor.get("min").is_some()) {
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        if bin.is_empty() || view["buffer"] != 0 {
            continue;
        }
        let from = view["byteOffset"].as_u64().unwrap() as usize;
        let count = accessor["count"].as_u64().unwrap() as usize;
        let float = |key: usize| f32::from_le_bytes(bin[from + 4 * key..][..4].try_into().unwrap());
        for (name, key) in [("min", 0), ("max", count - 1)] {
            let bound = accessor[name][0].as_f64().unwrap();
            assert_eq!(bound as f32, float(key), "{name}");
            // The JSON parser of the tests may round the last bit either way.
            assert!((bound - f64::from(float(key))).abs() <= bound.abs() * 1e-15, "{name}: {bound}");
        }
    }
}

/// Removes the announced changes from both files and compares the rest, byte for byte.
#[track_caller]
pub(crate) fn rest_stays(old: &[u8], new: &[u8], changes: &Changes) {
    if changes.is_empty() {
        assert!(old == new, "the files differ although nothing changes");
        return;
    }
    let is_glb = old.starts_with(b"glTF");
    let base = if is_glb { 20 } else { 0 };
    let (old_parts, new_parts) = (parts(old), parts(new));
    let (old_text, new_text) = (old_parts.text, new_parts.text);
    let (mut from, mut at) = (0, 0);
    for token in &changes.tokens {
        let length = token.offset - base - from;
        assert!(old_text[from..][..length] == new_text[at..][..length], "before {}", token.pointer);
        from += length + token.length;
        at += length + token.new_length;
    }
    let (old_text, new_text) = (&old_text[from..], &new_text[at..]);
    if !is_glb {
        assert!(old_text == new_text, "after the last token");
        return;
    }
    let bare = |text: &[u8]| text.iter().copied().filter(|byte| *byte != b' ').collect::<Vec<u8>>();
    assert_eq!(bare(old_text), bare(new_text), "only spaces are padding");
    assert!(new_text.len().abs_diff(old_text.len()) < 4, "{} and {}", old_text.len(), new_text.len());
    assert!(old_parts.rest == new_parts.rest, "after the container");
    let others = |parts: &FileParts<'_>| {
        let is_bin = parts.chunks.first().is_some_and(|chunk| chunk[0] == b"BIN\0");
        parts.chunks[usize::from(is_bin)..].concat().concat()
    };
    assert!(others(&old_parts) == others(&new_parts), "chunks of other kinds");
    let (old_bin, new_bin) = (bin_of(old), bin_of(new));
    if changes.bytes_reused == 0 && changes.bytes_removed == 0 {
        assert!(new_bin.starts_with(&old_bin), "the bytes of the buffer");
        // The new numbers may be in another buffer.
        assert!([0, changes.bytes_appended].contains(&(new_bin.len() - old_bin.len())));
    }
}

/// Checks that meshes, skins, materials, images and the skeleton are the same, with bones identified by their nodes.
#[track_caller]
pub(crate) fn same_scene(a: &ModelData, b: &ModelData) {
    assert_eq!(a.name, b.name);
    assert!(a.meshes == b.meshes, "meshes differ");
    assert!(a.materials == b.materials, "materials differ");
    assert!(a.images == b.images, "images differ");
    let node = |model: &ModelData, bone: u32| model.animation.skeleton.bones[bone as usize].node;
    assert_eq!(a.skins.len(), b.skins.len());
    for (a_skin, b_skin) in a.skins.iter().zip(&b.skins) {
        assert_eq!((&a_skin.name, &a_skin.offsets), (&b_skin.name, &b_skin.offsets));
        let nodes = |model, bones: &[u32]| bones.iter().map(|&bone| node(model, bone)).collect::<Vec<_>>();
        assert_eq!(nodes(a, &a_skin.bones), nodes(b, &b_skin.bones));
    }
    assert_eq!(a.instances.len(), b.instances.len());
    for (a, b) in a.instances.iter().zip(&b.instances) {
        assert_eq!((a.mesh, a.node, a.skin, &a.morph_weights), (b.mesh, b.node, b.skin, &b.morph_weights));
    }
    for bone in &b.animation.skeleton.bones {
        // A node that becomes animated becomes a bone.
        let before = a.animation.skeleton.bones.iter().find(|before| before.node == bone.node);
        let Some(before) = before else { continue };
        assert_eq!(
            (&before.name, before.rest, before.rest_matrix),
            (&bone.name, bone.rest, bone.rest_matrix)
        );
    }
}

/// Checks that the takes of `after` are the edited ones, to the last bit.
#[track_caller]
pub(crate) fn same_takes(before: &ModelData, asked: &[EditedTake], after: &ModelData) {
    assert_eq!(asked.len(), after.animation.takes.len());
    for (asked, got) in asked.iter().zip(&after.animation.takes) {
        let is_empty = asked.take.tracks.iter().all(Track::is_empty) && asked.take.morphs.is_empty();
        assert_eq!((&asked.take.name, &asked.take.extras), (&got.name, &got.extras));
        if !is_empty {
            same_take(before, &asked.take, after, got);
        }
    }
}

#[track_caller]
fn same_take(before: &ModelData, asked: &Take, after: &ModelData, got: &Take) {
    let place = |what: &str, node| format!("take {:?}, node {node:?}, {what}", asked.name);
    let nothing = Track::default();
    for (bone, asked) in before.animation.skeleton.bones.iter().zip(&asked.tracks) {
        let bones = &after.animation.skeleton.bones;
        let index = bones.iter().position(|other| other.node == bone.node);
        let got = index.map_or(&nothing, |index| &got.tracks[index]);
        assert!(same_channel(&asked.translation, &got.translation), "{}", place("translation", bone.node));
        assert!(same_channel(&asked.rotation, &got.rotation), "{}", place("rotation", bone.node));
        assert!(same_channel(&asked.scale, &got.scale), "{}", place("scale", bone.node));
    }
    let sorted = |take: &Take| {
        let mut morphs: Vec<MorphTrack> =
            take.morphs.iter().filter(|m| !m.times.is_empty()).cloned().collect();
        morphs.sort_by_key(|morph| morph.instance);
        morphs
    };
    assert!(sorted(asked) == sorted(got), "{}", place("weights", None));
    let times = asked.tracks.iter().flat_map(Track::key_times);
    let times = times.chain(asked.morphs.iter().flat_map(|morph| morph.times.to_vec()));
    let (start, end) = times.fold((f32::MAX, f32::MIN), |(a, b), time| (a.min(time), b.max(time)));
    if start <= end {
        assert_eq!((got.start, got.length), (start, end - start));
    }
}

fn same_channel<T: PartialEq + Copy>(a: &Channel<T>, b: &Channel<T>) -> bool {
    (a.times.is_empty() && b.times.is_empty()) || a == b
}

/// Returns the take `index` of `takes` for editing.
pub(crate) fn take_mut(takes: &mut [EditedTake], index: usize) -> &mut Take {
    Arc::make_mut(&mut takes[index].take)
}
