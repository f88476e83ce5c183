//! Includes replaced by what they bring: the elements of other files, after those of the text.
//!
//! Every `include` has elements of its own, also where several name the same file, because each of them plays at its own time. Bytes and
//! nodes of all of them together have the limits of one script, so that a file of a thousand includes of a large file is an error.

use super::included::{IncludeFault, MOST_INCLUDES, beside, source, too_large};
use super::origin::{ElementOrigin, IncludedPart, IncludedPlace};
use super::{
    ErrorList, MOST_BYTES, MOST_ERRORS, MOST_NODES, ScriptContext, ScriptElement, ScriptError, ScriptTree,
    suggestion,
};
use crate::stage::project::StageProject;
use crate::stage::time::StageRate;
use std::ops::Range;
use std::sync::Arc;

/// Adds the elements that the includes of a tree bring. Returns what is wrong with the files: with the XML and the tables; what the references in them mean
/// is checked with all others.
pub(super) fn merge(tree: &mut ScriptTree, context: &ScriptContext) -> Vec<ScriptError> {
    if !tree.elements.iter().any(|element| source(element).is_some()) {
        return Vec::new();
    }
    let own = tree.elements.iter().take_while(|element| element.is_own()).count();
    let mut merging = Merging {
        context,
        chain: vec![Arc::clone(&context.name)],
        parts: Vec::new(),
        base: tree.text.len() + 1,
        bytes: tree.text.len(),
        nodes: tree.nodes,
        is_full: false,
        faults: Vec::new(),
    };
    merging.includes(&mut tree.elements, 0..own, None);
    let Merging { parts, faults, .. } = merging;
    tree.parts = parts.into();
    let mut errors = ErrorList::with_parts(&tree.lines, &tree.parts);
    for fault in faults {
        match fault {
            MergeFault::Include { range, message, help } => errors.add(range, message, help),
            MergeFault::File { name, file, errors: list } => {
                let place = tree.lines.place(name.start);
                for error in &*list {
                    let (range, inside) = (error.range.clone(), error.place);
                    let inside = IncludedPlace { file: Arc::clone(&file), range, place: inside };
                    let (range, inside) = (name.clone(), Some(Box::new(inside)));
                    errors.push(ScriptError { range, place, inside, ..error.clone() });
                }
            }
        }
    }
    errors.sorted()
}

/// Something that is wrong.
enum MergeFault {
    /// With an `include`, at these bytes.
    Include { range: Range<usize>, message: String, help: String },
    /// With the text of a file, which an `include` with this name in the text of the script brings.
    File { name: Range<usize>, file: Arc<str>, errors: Arc<[ScriptError]> },
}

/// The elements, while they are put together.
struct Merging<'a> {
    context: &'a ScriptContext,
    /// The files around the includes that are next, the script first.
    chain: Vec<Arc<str>>,
    parts: Vec<IncludedPart>,
    /// The first byte that no file has yet.
    base: usize,
    bytes: usize,
    nodes: usize,
    /// Whether no more is included.
    is_full: bool,
    faults: Vec<MergeFault>,
}

impl Merging<'_> {
    /// Adds what the includes among some elements bring; `around` is the include of the text that has brought these.
    fn includes(&mut self, elements: &mut Vec<ScriptElement>, among: Range<usize>, around: Option<usize>) {
        for include in among {
            if self.is_full {
                return;
            }
            let Some(source) = elements.get(include).and_then(source) else { continue };
            let name = self.chain.last().map_or("", |name| name);
            let file: Arc<str> = beside(name, source).into();
            let outermost = around.unwrap_or(include);
            if let Err(fault) = self.include(elements, (include, outermost), &file) {
                self.faults.push(fault);
                self.is_full |= self.faults.len() >= MOST_ERRORS;
            }
        }
    }

    fn include(
        &mut self,
        elements: &mut Vec<ScriptElement>,
        (include, outermost): (usize, usize),
        file: &Arc<str>,
    ) -> Result<(), MergeFault> {
        let at = elements[include].value_range("src");
        let name = elements[outermost].name.clone();
        let fault =
            |message: String, help: String| Err(MergeFault::Include { range: at.clone(), message, help });
        if let Some(first) = self.chain.iter().position(|other| other == file) {
            let names: Vec<&str> = self.chain[first..].iter().chain([file]).map(|name| &**name).collect();
            return fault(format!("files include each other: {}", names.join(" → ")), String::new());
        }
        if self.chain.len() > MOST_INCLUDES {
            return fault(
                format!("files are included more than {MOST_INCLUDES} deep: {}", self.chain.join(" → ")),
                String::new(),
            );
        }
        let tree = match self.context.files.tree(file) {
            Ok(tree) => tree,
            Err(IncludeFault::Wrong(errors)) => {
                // Its errors are the same, however often it is included.
                let is_known = |fault: &MergeFault| match fault {
                    MergeFault::File { file: known, .. } => known == file,
                    MergeFault::Include { .. } => false,
                };
                return match self.faults.iter().any(is_known) {
                    true => Ok(()),
                    false => Err(MergeFault::File { name, file: Arc::clone(file), errors }),
                };
            }
            Err(IncludeFault::Missing(missing)) => {
                // As this include would write them.
                let folder =
                    self.chain.last().and_then(|name| name.rsplit_once('/')).map_or("", |(folder, _)| folder);
                let is_around = |name: &&String| self.chain.iter().any(|other| **other == ***name);
                let names =
                    missing.beside.iter().filter(|name| !is_around(name)).filter_map(|name| match folder {
                        "" => Some(name.as_str()),
                        folder => name.strip_prefix(folder)?.strip_prefix('/'),
                    });
                let help = match missing.beside.is_empty() {
                    true => String::new(),
                    false => suggestion(elements[include].value("src").unwrap_or_default(), "scripts", names),
                };
                return fault(format!("{file} {}", missing.reason), help);
            }
        };
        self.bytes += tree.text.len();
        self.nodes += tree.nodes;
        if self.bytes > MOST_BYTES || self.nodes > MOST_NODES as usize {
            self.is_full = true;
            let reason = match self.bytes > MOST_BYTES {
                true => too_large(),
                false => format!(
                    "has, together with the others, more than the {MOST_NODES} elements, texts and comments that a script may have"
                ),
            };
            return fault(format!("{file} {reason}"), "include less, or fewer times".to_owned());
        }
        let part = self.parts.len();
        let first = elements.len();
        let rate = self.rate(&tree);
        let added = first..first + tree.elements.len().saturating_sub(1);
        elements.extend(self.elements_of(&tree, file, include, first));
        self.parts.push(IncludedPart {
            file: Arc::clone(file),
            rate,
            include,
            outermost,
            name,
            elements: added.clone(),
            end: part + 1,
            base: self.base,
            lines: tree.lines.clone(),
        });
        self.base += tree.text.len() + 1;
        self.chain.push(Arc::clone(file));
        self.includes(elements, added, Some(outermost));
        self.chain.pop();
        self.parts[part].end = self.parts.len();
        Ok(())
    }

    /// Returns the frame rate of an included file: its own, else that of the project, as if it were read alone.
    fn rate(&self, tree: &ScriptTree) -> StageRate {
        let written = tree.elements.first().and_then(|root| root.attribute("fps")).map(|fps| &*fps.value);
        let project = || self.context.project.as_ref().map(StageProject::rate);
        written.and_then(StageRate::parse).or_else(project).unwrap_or_default()
    }

    /// Returns the elements of a file except its root, in the place of the `include`; the first one becomes the element `first`.
    fn elements_of(
        &self,
        tree: &ScriptTree,
        file: &str,
        include: usize,
        first: usize,
    ) -> impl Iterator<Item = ScriptElement> {
        let (part, base) = (self.parts.len(), self.base);
        // Without a project, what a script names is relative to its own folder.
        let folder = file.rsplit_once('/').filter(|_| self.context.project.is_none());
        let folder = folder.map(|(folder, _)| folder.to_owned());
        let moved = move |range: &Range<usize>| range.start + base..range.end + base;
        let elements: Vec<ScriptElement> = tree.elements.iter().skip(1).cloned().collect();
        elements.into_iter().map(move |mut element| {
            element.origin = ElementOrigin::Included(part);
            // The root of the file is the include.
            element.parent =
                element.parent.map(|parent| parent.checked_sub(1).map_or(include, |at| first + at));
            (element.range, element.name) = (moved(&element.range), moved(&element.name));
            let is_include = source(&element).is_some();
            for attribute in &mut element.attributes {
                (attribute.range, attribute.name) = (moved(&attribute.range), moved(&attribute.name));
                attribute.value_range = moved(&attribute.value_range);
                let is_file = matches!(attribute.row.name, "model" | "src") && !is_include;
                if let Some(folder) = folder.as_ref().filter(|_| is_file) {
                    attribute.value = format!("{folder}/{}", attribute.value).into();
                }
            }
            element
        })
    }
}
