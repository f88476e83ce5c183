//! The files that scripts include: their texts, which the caller reads, each once.

use super::read::read_tree;
use super::{MOST_BYTES, ScriptElement, ScriptError, ScriptTree};
use crate::stage::project::StageProject;
use crate::stage::table::SCRIPTS;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Largest number of files that are included one through another.
pub const MOST_INCLUDES: usize = 8;

/// The surroundings of a script, with which it is read.
#[derive(Clone, Debug, Default)]
pub struct ScriptContext {
    /// Its file, relative to the folder of the document; files that it includes are relative to this one. Empty for a text without a file.
    pub name: Arc<str>,
    /// The project that it belongs to.
    pub project: Option<StageProject>,
    /// The files that it includes, directly or through others.
    pub files: IncludedScripts,
}

/// The files that scripts include, by their names relative to the folder of the document. A clone is cheap.
///
/// ```
/// use dragonfly_anim::stage::script::{IncludedScripts, ScriptContext, StageScript};
///
/// let intro = r#"<script version="1"><title id="name" text="A Duel" dur="2"/></script>"#;
/// let duel = r#"<script version="1"><seq><include src="intro.xml"/><wait dur="1"/></seq></script>"#;
/// let files = IncludedScripts::default().collected("duel.xml", duel, |file| match file {
///     "intro.xml" => Ok(intro.into()),
///     _ => Err("there is no such file".into()),
/// });
/// let context = ScriptContext { name: "duel.xml".into(), files, ..ScriptContext::default() };
/// let script = StageScript::read_in(duel, &context).map_err(|errors| errors[0].in_file("duel.xml"))?;
/// assert_eq!(script.actions().len(), 5, "the script, seq, include, title, wait");
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct IncludedScripts(Arc<BTreeMap<Box<str>, IncludedFile>>);

/// A file that is included.
#[derive(Clone, Debug)]
enum IncludedFile {
    /// It was read.
    Read(Arc<str>, Result<Arc<ScriptTree>, Arc<[ScriptError]>>),
    /// It could not be.
    Missing(MissingScript),
}

/// The reason why a file cannot be included.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MissingScript {
    /// The reason, as the end of a sentence that begins with the name of the file: `is not there`.
    pub reason: String,
    /// Names of files that may be meant, relative to the folder of the document.
    pub beside: Vec<String>,
}

impl From<&str> for MissingScript {
    fn from(reason: &str) -> Self {
        Self { reason: reason.to_owned(), beside: Vec::new() }
    }
}

impl IncludedScripts {
    /// Returns the files that a script called `name` includes, directly or through others. `read` is called once for each; of those in `self`
    /// whose texts are the same, nothing is read again.
    ///
    /// A text that is no script includes nothing. At most [`MOST_INCLUDES`] files are read one through another, and as many bytes
    /// together as a script may have; the others are missing.
    #[must_use]
    pub fn collected(
        &self,
        name: &str,
        text: &str,
        mut read: impl FnMut(&str) -> Result<Arc<str>, MissingScript>,
    ) -> Self {
        let mut files: BTreeMap<Box<str>, IncludedFile> = BTreeMap::new();
        let mut bytes = text.len();
        let main = text.contains("<include").then(|| read_tree(&text.into(), &SCRIPTS).ok()).flatten();
        let mut level = main.map_or_else(Vec::new, |tree| names(&tree, name));
        for _ in 0..MOST_INCLUDES {
            let mut next = Vec::new();
            for file in std::mem::take(&mut level) {
                if files.contains_key(&*file) {
                    continue;
                }
                let found = match read(&file) {
                    Ok(text) if text.len() <= MOST_BYTES.saturating_sub(bytes) => {
                        bytes += text.len();
                        self.parsed(&file, text)
                    }
                    Ok(_) => IncludedFile::Missing(too_large().as_str().into()),
                    Err(missing) => IncludedFile::Missing(missing),
                };
                if let IncludedFile::Read(_, Ok(tree)) = &found {
                    next.extend(names(tree, &file));
                }
                files.insert(file, found);
            }
            level = next;
        }
        Self(Arc::new(files))
    }

    /// Returns a file with its elements: those that are known, if the text is the same.
    fn parsed(&self, file: &str, text: Arc<str>) -> IncludedFile {
        match self.0.get(file) {
            Some(IncludedFile::Read(known, tree)) if **known == *text => {
                IncludedFile::Read(Arc::clone(known), tree.clone())
            }
            Some(IncludedFile::Read(..) | IncludedFile::Missing(_)) | None => {
                let tree = read_tree(&text, &SCRIPTS).map(Arc::new).map_err(Arc::from);
                IncludedFile::Read(text, tree)
            }
        }
    }

    /// Returns the names and texts of the files that were read, in the order of the names.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &Arc<str>)> {
        self.0.iter().filter_map(|(name, file)| match file {
            IncludedFile::Read(text, _) => Some((&**name, text)),
            IncludedFile::Missing(_) => None,
        })
    }

    /// Returns the names of the files that are missing, with the reasons, in the order of the names.
    pub fn missing(&self) -> impl Iterator<Item = (&str, &MissingScript)> {
        self.0.iter().filter_map(|(name, file)| match file {
            IncludedFile::Missing(missing) => Some((&**name, missing)),
            IncludedFile::Read(..) => None,
        })
    }

    /// Returns the elements of a file.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub(super) fn tree(&self, name: &str) -> Result<Arc<ScriptTree>, IncludeFault> {
        match self.0.get(name) {
            Some(IncludedFile::Read(_, Ok(tree))) => Ok(Arc::clone(tree)),
            Some(IncludedFile::Read(_, Err(errors))) => Err(IncludeFault::Wrong(Arc::clone(errors))),
            Some(IncludedFile::Missing(missing)) => Err(IncludeFault::Missing(missing.clone())),
            None => Err(IncludeFault::Missing("was not read".into())),
        }
    }
}

/// The reason why an included file has no elements.
pub(super) enum IncludeFault {
    /// It is no script: its errors, with their places in it.
    Wrong(Arc<[ScriptError]>),
    /// It is not there.
    Missing(MissingScript),
}

/// Returns the reason why no more is included.
pub(super) fn too_large() -> String {
    format!("has, together with the others, more than the {MOST_BYTES} bytes that a script may have")
}

/// Returns the files that a script called `name` includes itself, in the order of its text.
fn names(tree: &ScriptTree, name: &str) -> Vec<Box<str>> {
    let includes = tree.elements.iter().filter_map(source);
    includes.map(|source| beside(name, source).into()).collect()
}

/// Returns the file that an element includes, as it is written.
pub(super) fn source(element: &ScriptElement) -> Option<&str> {
    element.value("src").filter(|_| element.row.name == "include")
}

/// Returns the name of a file that `source`, written in the file `name`, means. The tables allow no source above a folder.
pub(super) fn beside(name: &str, source: &str) -> String {
    let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
    let parts = folder.split('/').chain(source.split('/'));
    parts.filter(|part| !matches!(*part, "" | ".")).collect::<Vec<_>>().join("/")
}
