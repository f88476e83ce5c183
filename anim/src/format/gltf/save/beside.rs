//! What a file needs beside it.

use super::source::{SourceFile, is_data};
use crate::format::uri::relative_path;

impl SourceFile {
    /// Names of the files that this one refers to (buffers, images), relative to its folder, as files are called and
    /// each once; data URIs and what no file can be called are left out.
    pub fn files_beside(&self) -> Vec<String> {
        let json = self.json();
        let mut found = Vec::new();
        for list in ["buffers", "images"] {
            for item in json.list(0, list) {
                let uri = json.string_member(item, "uri").filter(|uri| !is_data(uri));
                let name = uri.and_then(|uri| relative_path(&uri).ok());
                found.extend(name.filter(|name| !found.contains(name)));
            }
        }
        found
    }
}
