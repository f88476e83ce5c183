//! The file as it was opened.

use super::super::buffer;
use super::container::Container;
use super::json::tree::{Json, Tree};
use super::mark::is_ours;
use crate::format::definition::check_file_size;
use crate::format::{AssetFs, ImportContext, ImportError, Place, ReadOptions};
use std::collections::HashMap;
use std::sync::Arc;

/// A `.gltf` or `.glb` file as it was opened: its bytes, and the range of every value of its JSON. Immutable; clones
/// share everything.
#[derive(Clone)]
pub struct SourceFile {
    pub(super) name: String,
    pub(super) bytes: Arc<[u8]>,
    pub(super) container: Container,
    tree: Arc<Tree>,
    /// Buffers in referenced files, as far as a save reads them.
    pub(super) beside: Arc<HashMap<usize, Arc<[u8]>>>,
}

impl SourceFile {
    /// Opens the bytes of a file called `name` (from which a new buffer file gets its name). Reads through `door` those
    /// referenced buffers that a save needs: those with key times, and those that an earlier save wrote. A buffer that
    /// cannot be read is skipped.
    ///
    /// Needs about 25 bytes of memory per JSON value in addition to the file. Errors: the container or the JSON text is
    /// invalid; the file is larger than [`FILE_BYTES`](crate::limits::FILE_BYTES). The content of the JSON is not
    /// checked here; [`crate::format::read`] does that.
    pub fn open(
        name: &str,
        bytes: impl Into<Arc<[u8]>>,
        door: &dyn AssetFs,
        options: &ReadOptions<'_>,
    ) -> Result<Self, ImportError> {
        let bytes: Arc<[u8]> = bytes.into();
        check_file_size(bytes.len())?;
        options.budget.input(bytes.len());
        Self::parse(name, bytes, &ImportContext::new(door, options))
    }

    /// Finds the values of the JSON text and reads the buffers that a save needs.
    pub(super) fn parse(
        name: &str,
        bytes: Arc<[u8]>,
        context: &ImportContext<'_>,
    ) -> Result<Self, ImportError> {
        let container = Container::of(&bytes, context)?;
        let broken = |at: usize, reason: &str| ImportError::Invalid {
            place: Place::Byte(at as u64),
            code: super::super::check::INVALID_JSON,
            reason: reason.to_owned(),
        };
        if let Err(error) = std::str::from_utf8(&bytes[container.text.clone()]) {
            return Err(broken(container.text.start + error.valid_up_to(), "the text is not UTF-8"));
        }
        let tree = Tree::read(&bytes, container.text.clone()).map_err(|e| broken(e.at, e.reason))?;
        let mut source =
            Self { name: name.to_owned(), bytes, container, tree: Arc::new(tree), beside: Arc::default() };
        source.beside = Arc::new(source.fetched(context));
        Ok(source)
    }

    /// Returns the bytes of the file.
    pub fn bytes(&self) -> &Arc<[u8]> {
        &self.bytes
    }

    /// Returns the name under which the file was opened.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn json(&self) -> Json<'_> {
        Json::new(&self.bytes, &self.tree)
    }

    /// Returns whether the file is a binary container.
    pub fn is_glb(&self) -> bool {
        self.container.glb.is_some()
    }

    /// Reads the referenced buffers that a save needs.
    fn fetched(&self, context: &ImportContext<'_>) -> HashMap<usize, Arc<[u8]>> {
        let json = self.json();
        let mut wanted = buffers_of_key_times(json);
        let mut fetched = HashMap::new();
        let buffers = json.list(0, "buffers");
        wanted.extend((0..buffers.len()).filter(|&index| is_ours(json, buffers[index])));
        wanted.sort_unstable();
        wanted.dedup();
        for index in wanted {
            let Some(&buffer) = buffers.get(index) else { continue };
            let uri = json.string_member(buffer, "uri").filter(|uri| !is_data(uri));
            let place = Place::Pointer(format!("/buffers/{index}/uri"));
            if let Some(Ok(file)) = uri.map(|uri| buffer::fetch(&uri, &place, context)) {
                fetched.insert(index, file.bytes);
            }
        }
        fetched
    }
}

/// Returns whether the URI contains its data.
pub(super) fn is_data(uri: &str) -> bool {
    uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"))
}

/// Returns the buffers with the key times of animation samplers.
fn buffers_of_key_times(json: Json<'_>) -> Vec<usize> {
    let (accessors, views) = (json.list(0, "accessors"), json.list(0, "bufferViews"));
    let mut found = Vec::new();
    for animation in json.list(0, "animations") {
        for sampler in json.list(animation, "samplers") {
            let buffer = || {
                let accessor = *accessors.get(json.index_member(sampler, "input")?)?;
                let view = *views.get(json.index_member(accessor, "bufferView")?)?;
                json.index_member(view, "buffer")
            };
            found.extend(buffer());
        }
    }
    found
}
