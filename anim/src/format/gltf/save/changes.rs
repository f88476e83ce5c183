//! Description of what a save will change.

use crate::format::one_line;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fmt;

/// Change of a take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TakeChange {
    /// The take is new.
    Added,
    /// The take is deleted.
    Deleted,
    /// The take gets another name.
    Renamed,
    /// The take gets another position in the list.
    Moved,
    /// The extras of the take change: layers, contacts, events.
    Extras,
}

/// Change of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelChange {
    /// The channel is new.
    Added,
    /// The channel is removed.
    Removed,
    /// The channel gets other keys.
    Changed,
}

/// A channel that a save changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedChannel {
    /// Name of the take.
    pub take: String,
    /// Number of the node in the file.
    pub node: u32,
    /// Name of the bone; `mesh 3` for the weights of a mesh instance.
    pub bone: String,
    /// Property: `translation`, `rotation`, `scale` or `weights`.
    pub path: &'static str,
    /// How the channel changes.
    pub change: ChannelChange,
}

/// An accessor that a save writes, with its buffer view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenAccessor {
    /// Number of the accessor in `/accessors`.
    pub accessor: usize,
    /// Number of its view in `/bufferViews`.
    pub view: usize,
    /// Type of its elements, made of floats: `SCALAR`, `VEC3` or `VEC4`.
    pub shape: &'static str,
    /// Number of elements.
    pub count: usize,
    /// Number of bytes.
    pub bytes: usize,
    /// Whether an earlier save appended the accessor and its view; otherwise both are new.
    pub is_reused: bool,
}

/// A replaced range of bytes of the JSON text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedToken {
    /// Place as a JSON pointer into the file as it was opened: the value that changes, or the list or object that
    /// something is inserted into or removed from.
    pub pointer: String,
    /// Offset of the first replaced byte in the file as it was opened.
    pub offset: usize,
    /// Number of replaced bytes.
    pub length: usize,
    /// The replaced bytes, shortened if there are many; empty for an insertion.
    pub old: String,
    /// The new text, shortened if it is long; empty for a removal.
    pub new: String,
    /// Number of new bytes.
    pub new_length: usize,
}

/// All changes of a save. Everything that is not listed here keeps its bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Changed takes, by name (the new one if it changes).
    pub takes: Vec<(String, TakeChange)>,
    /// Changed channels.
    pub channels: Vec<ChangedChannel>,
    /// Nodes whose matrix is written as translation, rotation and scale, since glTF animates no matrices.
    pub nodes: Vec<u32>,
    /// New nodes, with their names: root bones that edits added.
    pub bones_added: Vec<(u32, String)>,
    /// Nodes, with their names, of root bones that an earlier save added and that are gone.
    pub bones_removed: Vec<(u32, String)>,
    /// Nodes of these that stay in the file, without children and in no scene, because other nodes come after them.
    pub nodes_left: Vec<u32>,
    /// Nodes, with their names, that no take animates any more and that are no joint of a skin. They stay in the file
    /// and are shown at rest; a file that is opened again has no bone for them.
    pub bones_lost: Vec<(u32, String)>,
    /// Takes whose extras cannot be kept: another program uses the `extras` of the animation for a text or
    /// a number.
    pub extras_lost: Vec<String>,
    /// Written accessors.
    pub accessors: Vec<WrittenAccessor>,
    /// Changed tokens of the JSON text, in the order of the text.
    pub tokens: Vec<ChangedToken>,
    /// Number of bytes by which the buffer grows.
    pub bytes_appended: usize,
    /// Number of bytes that earlier saves appended to the buffer and that this save overwrites.
    pub bytes_reused: usize,
    /// Number of bytes by which the buffer shrinks; only [`super::compact`] does that.
    pub bytes_removed: usize,
    /// Names of the files that will be written, relative to the folder, in order.
    pub files: Vec<String>,
    /// Names of files that earlier saves wrote and that this file no longer needs. Another file may still need them.
    pub files_left: Vec<String>,
}

/// Number of characters of a token that are shown.
const SHOWN: usize = 60;

/// Returns the first characters of a token, on one line.
pub(super) fn shortened(token: &str) -> String {
    let short: String = token.chars().take(SHOWN).collect();
    let more = token.chars().nth(SHOWN).is_some();
    one_line(&short) + if more { "…" } else { "" }
}

impl Changes {
    /// Returns whether the file stays the same, byte for byte.
    pub fn is_empty(&self) -> bool {
        self.tokens.is_empty()
            && self.bytes_appended == 0
            && self.bytes_reused == 0
            && self.bytes_removed == 0
    }

    /// Returns which takes change, as one line for users: `2 takes changed, 1 added`; empty if none does.
    pub fn takes_summary(&self) -> String {
        let of = |wanted: &[TakeChange]| -> BTreeSet<&str> {
            let takes = self.takes.iter().filter(|(_, change)| wanted.contains(change));
            takes.map(|(name, _)| name.as_str()).collect()
        };
        let (added, deleted) = (of(&[TakeChange::Added]), of(&[TakeChange::Deleted]));
        let channels = self.channels.iter().map(|channel| channel.take.as_str());
        let mut changed = of(&[TakeChange::Renamed, TakeChange::Moved, TakeChange::Extras]);
        changed.extend(channels.filter(|take| !added.contains(take) && !deleted.contains(take)));
        let mut parts = Vec::new();
        for (takes, what) in [(changed, "changed"), (added, "added"), (deleted, "deleted")] {
            match (takes.len(), parts.is_empty()) {
                (0, _) => {}
                (number, true) => parts.push(format!("{} {what}", count(number, "take"))),
                (number, false) => parts.push(format!("{number} {what}")),
            }
        }
        parts.join(", ")
    }

    /// Returns the amount of changes as one line for users.
    pub fn summary(&self) -> String {
        let takes: BTreeSet<&str> = self.channels.iter().map(|channel| channel.take.as_str()).collect();
        let bones: BTreeSet<u32> = self.channels.iter().map(|channel| channel.node).collect();
        let channels = (!self.channels.is_empty()).then(|| {
            let of = format!("{} in {}", count(bones.len(), "bone"), count(takes.len(), "take"));
            format!("{} of {of}", count(self.channels.len(), "channel"))
        });
        let some = |number: usize, what: &str| (number > 0).then(|| count(number, what));
        let bones = |bones: &[(u32, String)], what: &str| {
            some(bones.len(), "bone").map(|bones| format!("{bones} {what}"))
        };
        let parts = [
            bones(&self.bones_added, "added"),
            bones(&self.bones_removed, "removed"),
            channels,
            some(self.accessors.len(), "accessor"),
            some(self.tokens.len(), "change").map(|changes| changes + " of the JSON text"),
            some(self.bytes_appended, "byte").map(|bytes| bytes + " more"),
            some(self.bytes_removed, "byte").map(|bytes| bytes + " fewer"),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// Returns the changes as one line of JSON text.
    pub fn to_json(&self) -> String {
        let mut out = String::from("{");
        list(&mut out, "accessors", &self.accessors, |a| {
            json!({"accessor": a.accessor, "bufferView": a.view, "type": a.shape, "count": a.count,
                   "bytes": a.bytes, "reused": a.is_reused})
        });
        let bone = |(node, name): &(u32, String)| json!({"node": node, "bone": name});
        list(&mut out, "bonesAdded", &self.bones_added, bone);
        list(&mut out, "bonesLost", &self.bones_lost, bone);
        list(&mut out, "bonesRemoved", &self.bones_removed, bone);
        list(
            &mut out,
            "channels",
            &self.channels,
            |c| json!({"take": c.take, "node": c.node, "bone": c.bone, "path": c.path, "change": word(&c.change)}),
        );
        list(&mut out, "extrasLost", &self.extras_lost, |name| json!(name));
        list(&mut out, "files", &self.files, |name| json!(name));
        list(&mut out, "filesLeft", &self.files_left, |name| json!(name));
        list(&mut out, "nodes", &self.nodes, |node| json!(node));
        list(&mut out, "nodesLeft", &self.nodes_left, |node| json!(node));
        list(&mut out, "takes", &self.takes, |(name, c)| json!({"name": name, "change": word(c)}));
        list(&mut out, "tokens", &self.tokens, |t| {
            json!({"pointer": t.pointer, "offset": t.offset, "length": t.length, "old": t.old, "new": t.new,
                   "newLength": t.new_length})
        });
        let (more, reused, fewer) = (self.bytes_appended, self.bytes_reused, self.bytes_removed);
        out + &format!("\"bytesAppended\":{more},\"bytesRemoved\":{fewer},\"bytesReused\":{reused}}}")
    }
}

/// Appends a list as a member, and a comma. Each element is text before the next one is made.
fn list<T>(out: &mut String, name: &str, items: &[T], json: impl Fn(&T) -> Value) {
    *out += &format!("\"{name}\":[");
    for (number, item) in items.iter().enumerate() {
        *out += if number > 0 { "," } else { "" };
        *out += &json(item).to_string();
    }
    *out += "],";
}

/// Returns a number with its noun: `1 channel`, `2 channels`.
fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn word(change: &impl fmt::Debug) -> String {
    format!("{change:?}").to_lowercase()
}

impl fmt::Display for Changes {
    /// Writes the summary, then one line for each change; the same change of several channels of a bone is one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return writeln!(f, "nothing changes");
        }
        let takes = self.takes_summary();
        if !takes.is_empty() {
            writeln!(f, "{takes}")?;
        }
        writeln!(f, "{}", self.summary())?;
        for (name, change) in &self.takes {
            writeln!(f, "take \"{}\": {}", one_line(name), word(change))?;
        }
        let alike = |a: &ChangedChannel, b: &ChangedChannel| {
            (a.node, a.change) == (b.node, b.change) && (&a.take, &a.bone) == (&b.take, &b.bone)
        };
        for channels in self.channels.chunk_by(alike) {
            let Some(first) = channels.first() else { continue };
            let (take, bone) = (one_line(&first.take), one_line(&first.bone));
            let paths: Vec<_> = channels.iter().map(|channel| channel.path).collect();
            let paths = paths.join(", ");
            let change = word(&first.change);
            writeln!(f, "take \"{take}\", \"{bone}\" (node {}), {paths}: {change}", first.node)?;
        }
        for (bones, what) in [(&self.bones_added, "added"), (&self.bones_removed, "removed")] {
            for (node, name) in bones {
                writeln!(f, "bone \"{}\" (node {node}): {what}", one_line(name))?;
            }
        }
        for node in &self.nodes_left {
            writeln!(f, "node {node}: stays without children, because other nodes come after it")?;
        }
        for node in &self.nodes {
            writeln!(f, "node {node}: its matrix is replaced by translation, rotation and scale")?;
        }
        for (node, name) in &self.bones_lost {
            let name = one_line(name);
            writeln!(
                f,
                "\"{name}\" (node {node}): no take animates it any more; the saved file has no bone for it"
            )?;
        }
        for name in &self.extras_lost {
            writeln!(
                f,
                "take \"{}\": its extras are no object, so layers, contacts and events are not kept",
                one_line(name)
            )?;
        }
        for a in &self.accessors {
            let how = if a.is_reused { "overwritten" } else { "new" };
            writeln!(
                f,
                "accessor {}: {how}, {} {} of floats, {} bytes",
                a.accessor, a.count, a.shape, a.bytes
            )?;
        }
        for token in &self.tokens {
            match (token.old.is_empty(), token.new.is_empty()) {
                (true, _) => writeln!(f, "{}: + {}", token.pointer, token.new)?,
                (_, true) => writeln!(f, "{}: - {}", token.pointer, token.old)?,
                _ => writeln!(f, "{}: {} → {}", token.pointer, token.old, token.new)?,
            }
        }
        for (bytes, what) in [
            (self.bytes_appended, "appended to the buffer"),
            (self.bytes_reused, "of earlier saves overwritten"),
            (self.bytes_removed, "of earlier saves removed"),
        ] {
            if bytes > 0 {
                writeln!(f, "{bytes} bytes {what}")?;
            }
        }
        for file in &self.files {
            writeln!(f, "file {} will be written", one_line(file))?;
        }
        for file in &self.files_left {
            writeln!(f, "file {} is no longer needed", one_line(file))?;
        }
        Ok(())
    }
}
