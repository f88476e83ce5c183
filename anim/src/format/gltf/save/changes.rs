//! What a save will change, before it is written.

use crate::format::one_line;
use serde_json::json;
use std::collections::BTreeSet;
use std::fmt;

/// What happens to a take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TakeChange {
    /// It is new.
    Added,
    /// It goes.
    Deleted,
    /// It gets another name.
    Renamed,
    /// It gets another place in the list.
    Moved,
}

/// What happens to a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelChange {
    /// It is new.
    Added,
    /// It goes.
    Removed,
    /// It gets other keys.
    Changed,
}

/// A channel that a save touches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedChannel {
    /// Name of the take.
    pub take: String,
    /// Number of the node in the file.
    pub node: u32,
    /// Name of the bone; `mesh 3` for the weights of a mesh instance.
    pub bone: String,
    /// `translation`, `rotation`, `scale`, `weights`.
    pub path: &'static str,
    /// What happens to it.
    pub change: ChannelChange,
}

/// An accessor that a save writes, with its buffer view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenAccessor {
    /// Its number in `/accessors`.
    pub accessor: usize,
    /// The number of its view in `/bufferViews`.
    pub view: usize,
    /// Its elements: `SCALAR`, `VEC3`, `VEC4`, of floats.
    pub shape: &'static str,
    /// How many there are.
    pub count: usize,
    /// Bytes that they take.
    pub bytes: usize,
    /// Is it one that an earlier save appended, used again? Else both are new.
    pub is_reused: bool,
}

/// Bytes of the JSON text that are exchanged for others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChangedToken {
    /// Where, as a JSON pointer into the file as it was opened: to the value that changes, or to the list or object
    /// that something is put into or taken from.
    pub pointer: String,
    /// The first byte in the file as it was opened.
    pub offset: usize,
    /// How many bytes there give way.
    pub length: usize,
    /// Those bytes, shortened when there are many; empty when something is only put in.
    pub old: String,
    /// What comes in their place, shortened when it is long; empty when something is only taken away.
    pub new: String,
    /// How many bytes come.
    pub new_length: usize,
}

/// What a save will change. Everything that is not named here keeps its bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Takes, by name (the new one where it changes), with what happens to them.
    pub takes: Vec<(String, TakeChange)>,
    /// Channels.
    pub channels: Vec<ChangedChannel>,
    /// Nodes whose matrix is written as translation, rotation and scale, since glTF animates no matrices.
    pub nodes: Vec<u32>,
    /// Nodes that nothing will move any more, no joint of a skin among them, with their names. They stay in the file and
    /// are shown at rest; a file that is opened again has no bone for them.
    pub bones_lost: Vec<(u32, String)>,
    /// Accessors.
    pub accessors: Vec<WrittenAccessor>,
    /// Tokens of the JSON text, in its order.
    pub tokens: Vec<ChangedToken>,
    /// Bytes by which the buffer grows.
    pub bytes_appended: usize,
    /// Bytes of the buffer that earlier saves appended and that are written over.
    pub bytes_reused: usize,
    /// Bytes by which the buffer shrinks; only [`super::compact`] does that.
    pub bytes_removed: usize,
    /// Names of the files that will be written, relative to the folder, in order.
    pub files: Vec<String>,
    /// Names of files that earlier saves wrote and that this file will not need any more. Another file may.
    pub files_left: Vec<String>,
}

/// Characters of a token that are shown.
const SHOWN: usize = 60;

/// The first characters of a token, on one line.
pub(super) fn shortened(token: &str) -> String {
    let short: String = token.chars().take(SHOWN).collect();
    let more = token.chars().nth(SHOWN).is_some();
    one_line(&short) + if more { "…" } else { "" }
}

impl Changes {
    /// Will the file be the same, byte for byte?
    pub fn is_empty(&self) -> bool {
        self.tokens.is_empty()
            && self.bytes_appended == 0
            && self.bytes_reused == 0
            && self.bytes_removed == 0
    }

    /// How much it is, in one line for people.
    pub fn summary(&self) -> String {
        let takes: BTreeSet<&str> = self.channels.iter().map(|channel| channel.take.as_str()).collect();
        let bones: BTreeSet<u32> = self.channels.iter().map(|channel| channel.node).collect();
        let channels = (!self.channels.is_empty()).then(|| {
            let of = format!("{} in {}", count(bones.len(), "bone"), count(takes.len(), "take"));
            format!("{} of {of}", count(self.channels.len(), "channel"))
        });
        let some = |number: usize, what: &str| (number > 0).then(|| count(number, what));
        let parts = [
            channels,
            some(self.accessors.len(), "accessor"),
            some(self.tokens.len(), "place").map(|places| places + " in the JSON text"),
            some(self.bytes_appended, "byte").map(|bytes| bytes + " more"),
            some(self.bytes_removed, "byte").map(|bytes| bytes + " fewer"),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// The same as JSON text, in one line.
    pub fn to_json(&self) -> String {
        let takes: Vec<_> =
            self.takes.iter().map(|(name, c)| json!({"name": name, "change": word(c)})).collect();
        let channels: Vec<_> = self
            .channels
            .iter()
            .map(|c| {
                json!({"take": c.take, "node": c.node, "bone": c.bone, "path": c.path, "change": word(&c.change)})
            })
            .collect();
        let accessors: Vec<_> = self
            .accessors
            .iter()
            .map(|a| {
                json!({"accessor": a.accessor, "bufferView": a.view, "type": a.shape, "count": a.count,
                       "bytes": a.bytes, "reused": a.is_reused})
            })
            .collect();
        let tokens: Vec<_> = self
            .tokens
            .iter()
            .map(|t| {
                json!({"pointer": t.pointer, "offset": t.offset, "length": t.length, "old": t.old, "new": t.new,
                       "newLength": t.new_length})
            })
            .collect();
        let lost: Vec<_> =
            self.bones_lost.iter().map(|(node, name)| json!({"node": node, "bone": name})).collect();
        json!({
            "bonesLost": lost, "takes": takes, "channels": channels, "nodes": self.nodes, "accessors": accessors, "tokens": tokens,
            "bytesAppended": self.bytes_appended, "bytesReused": self.bytes_reused,
            "bytesRemoved": self.bytes_removed, "files": self.files, "filesLeft": self.files_left,
        })
        .to_string()
    }
}

/// `1 channel`, `2 channels`.
fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn word(change: &impl fmt::Debug) -> String {
    format!("{change:?}").to_lowercase()
}

impl fmt::Display for Changes {
    /// For people: how much it is, then a line a thing; what happens alike to several channels of a bone is one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return writeln!(f, "nothing changes");
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
        for node in &self.nodes {
            writeln!(f, "node {node}: its matrix becomes translation, rotation and scale")?;
        }
        for (node, name) in &self.bones_lost {
            let name = one_line(name);
            writeln!(
                f,
                "\"{name}\" (node {node}): nothing moves it any more; opened again, the file has no bone for it"
            )?;
        }
        for a in &self.accessors {
            let how = if a.is_reused { "written over" } else { "new" };
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
            (self.bytes_reused, "of earlier saves written over"),
            (self.bytes_removed, "of earlier saves taken away"),
        ] {
            if bytes > 0 {
                writeln!(f, "{bytes} bytes {what}")?;
            }
        }
        for file in &self.files {
            writeln!(f, "file {} will be written", one_line(file))?;
        }
        for file in &self.files_left {
            writeln!(f, "file {} is not needed any more", one_line(file))?;
        }
        Ok(())
    }
}
