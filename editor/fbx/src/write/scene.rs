//! A file that is being written: its objects, their connections, and the sections around them.

use super::node::{FbxNode, encode, file_id, setting};
use super::preset::ExportSettings;
use dragonfly_anim::format::{ExportError, UpAxis};
use std::collections::BTreeMap;

/// Parts of a second in which the format counts time.
pub(super) const TICKS_PER_SECOND: f64 = 46_186_158_000.0;

/// Identifier of every file; belongs to [`CREATED`].
pub(super) const FILE_ID: [u8; 16] =
    [0x28, 0xb3, 0x2a, 0xeb, 0xb6, 0x24, 0xcc, 0xc2, 0xbf, 0xc8, 0xb0, 0x2a, 0xa9, 0x2b, 0xfc, 0xf1];

/// Time of creation of every file: the same model gives the same bytes.
const CREATED: &str = "1970-01-01 10:00:00:000";

/// Name of the program in the file.
pub(crate) const CREATOR: &str = "Dragonfly";

/// Number of the first object; smaller numbers are reserved by some programs.
const FIRST_OBJECT: i64 = 1_000_000;

/// Number of an object.
pub(super) type ObjectId = i64;

/// The scene itself, to which objects without a parent are connected.
pub(super) const SCENE: ObjectId = 0;

/// The name of a take and its first and last tick.
pub(super) struct WrittenTake {
    pub(super) name: String,
    pub(super) start: i64,
    pub(super) stop: i64,
}

/// Objects and connections so far.
#[derive(Default)]
pub(super) struct SceneWriter {
    objects: Vec<FbxNode>,
    connections: Vec<FbxNode>,
    /// Number of objects of each kind.
    counts: BTreeMap<&'static str, i32>,
    /// The takes in the order of the model.
    pub(super) takes: Vec<WrittenTake>,
}

/// Returns the number of ticks at a time in seconds.
pub(super) fn ticks(seconds: f64) -> i64 {
    (seconds * TICKS_PER_SECOND).round() as i64
}

/// Returns a name without the characters that separate it from the class of its object.
fn plain(name: &str) -> String {
    name.chars().map(|character| if matches!(character, '\0' | '\u{1}') { '_' } else { character }).collect()
}

impl SceneWriter {
    /// Adds an object: `kind` is the name of its node, `class` and `subclass` are its further names. The objects are numbered in
    /// this order.
    pub(super) fn object(
        &mut self,
        kind: &'static str,
        name: &str,
        (class, subclass): (&str, &str),
        children: impl IntoIterator<Item = FbxNode>,
    ) -> ObjectId {
        let id = FIRST_OBJECT + self.objects.len() as i64;
        let name = format!("{}\0\u{1}{class}", plain(name));
        self.objects.push(FbxNode::new(kind).with(id).with(name).with(subclass).containing(children));
        *self.counts.entry(kind).or_default() += 1;
        id
    }

    /// Connects an object to another one that uses it.
    pub(super) fn connect(&mut self, from: ObjectId, to: ObjectId) {
        self.connections.push(FbxNode::new("C").with("OO").with(from).with(to));
    }

    /// Connects an object to a property of another one.
    pub(super) fn connect_property(&mut self, from: ObjectId, to: ObjectId, property: &str) {
        self.connections.push(FbxNode::new("C").with("OP").with(from).with(to).with(property));
    }

    /// Returns the bytes of the file.
    pub(super) fn finish(
        self,
        title: &str,
        rate: f32,
        settings: &ExportSettings,
    ) -> Result<Vec<u8>, ExportError> {
        let Self { objects, connections, counts, takes } = self;
        let kinds = counts.iter().map(|(&kind, &count)| (kind, count)).chain([("GlobalSettings", 1)]);
        let kinds: Vec<FbxNode> =
            kinds.map(|(kind, count)| FbxNode::new("ObjectType").with(kind).value("Count", count)).collect();
        let total: i32 = counts.values().sum::<i32>() + 1;
        let definitions = FbxNode::new("Definitions").value("Version", 100).value("Count", total);
        encode(&[
            header(title),
            file_id(),
            FbxNode::new("CreationTime").with(CREATED),
            FbxNode::new("Creator").with(CREATOR),
            global_settings(&takes, rate, settings),
            documents(&takes),
            FbxNode::new("References"),
            definitions.containing(kinds),
            FbxNode::new("Objects").containing(objects),
            FbxNode::new("Connections").containing(connections),
            list_of_takes(&takes),
        ])
    }
}

fn header(title: &str) -> FbxNode {
    let date = [("Version", 1000), ("Year", 1970), ("Month", 1), ("Day", 1), ("Hour", 10)];
    let date = date.into_iter().chain([("Minute", 0), ("Second", 0), ("Millisecond", 0)]);
    let date = date.map(|(name, number)| FbxNode::new(name).with(number));
    let mut meta = FbxNode::new("MetaData").value("Version", 100).value("Title", plain(title));
    for name in ["Subject", "Author", "Keywords", "Revision", "Comment"] {
        meta = meta.value(name, "");
    }
    let text = |name: &str, value: &str| setting(name, "KString", "", "").with(value);
    let program = FbxNode::new("Properties70").containing([
        setting("Original", "Compound", "", ""),
        text("Original|ApplicationVendor", CREATOR),
        text("Original|ApplicationName", CREATOR),
        setting("LastSaved", "Compound", "", ""),
        text("LastSaved|ApplicationVendor", CREATOR),
        text("LastSaved|ApplicationName", CREATOR),
    ]);
    let info = FbxNode::new("SceneInfo").with("GlobalInfo\0\u{1}SceneInfo").with("UserData");
    FbxNode::new("FBXHeaderExtension")
        .value("FBXHeaderVersion", 1003)
        .value("FBXVersion", 7400)
        .value("EncryptionType", 0)
        .containing([FbxNode::new("CreationTimeStamp").containing(date)])
        .value("Creator", CREATOR)
        .containing([info.value("Type", "UserData").value("Version", 100).containing([meta, program])])
}

/// Returns the number by which the format knows a frame rate; 14 for one that it does not know.
fn time_mode(rate: f32) -> i32 {
    let modes = [(120.0, 1), (100.0, 2), (60.0, 3), (50.0, 4), (48.0, 5), (30.0, 6), (25.0, 10), (24.0, 11)];
    modes.into_iter().find(|(known, _)| *known == rate).map_or(14, |(_, mode)| mode)
}

fn global_settings(takes: &[WrittenTake], rate: f32, settings: &ExportSettings) -> FbxNode {
    let [up, front, side] = match settings.up {
        UpAxis::X => [(0, 1), (2, 1), (1, -1)],
        UpAxis::Y => [(1, 1), (2, 1), (0, 1)],
        UpAxis::Z => [(2, 1), (1, -1), (0, 1)],
    };
    let integer = |name: &str, value: i32| setting(name, "int", "Integer", "").with(value);
    let double = |name: &str, value: f64| setting(name, "double", "Number", "").with(value);
    let centimeters = settings.meters_per_unit * 100.0;
    let start = takes.iter().map(|take| take.start).min().unwrap_or(0);
    let stop = takes.iter().map(|take| take.stop).max().unwrap_or(0).max(start + ticks(1.0));
    let time = |name: &str, value: i64| setting(name, "KTime", "Time", "").with(value);
    FbxNode::new("GlobalSettings").value("Version", 1000).containing([FbxNode::new("Properties70")
        .containing([
            integer("UpAxis", up.0),
            integer("UpAxisSign", up.1),
            integer("FrontAxis", front.0),
            integer("FrontAxisSign", front.1),
            integer("CoordAxis", side.0),
            integer("CoordAxisSign", side.1),
            integer("OriginalUpAxis", -1),
            integer("OriginalUpAxisSign", 1),
            double("UnitScaleFactor", centimeters),
            double("OriginalUnitScaleFactor", centimeters),
            setting("AmbientColor", "ColorRGB", "Color", "").with(0.0).with(0.0).with(0.0),
            setting("DefaultCamera", "KString", "", "").with("Producer Perspective"),
            setting("TimeMode", "enum", "", "").with(time_mode(rate)),
            time("TimeSpanStart", start),
            time("TimeSpanStop", stop),
            double("CustomFrameRate", f64::from(rate)),
        ])])
}

fn documents(takes: &[WrittenTake]) -> FbxNode {
    let active = takes.first().map_or("", |take| &take.name);
    let settings = FbxNode::new("Properties70").containing([
        setting("SourceObject", "object", "", ""),
        setting("ActiveAnimStackName", "KString", "", "").with(plain(active)),
    ]);
    let document = FbxNode::new("Document").with(FIRST_OBJECT - 1).with("Scene").with("Scene");
    FbxNode::new("Documents")
        .value("Count", 1)
        .containing([document.containing([settings]).value("RootNode", SCENE)])
}

/// Returns the list of takes that older programs read.
fn list_of_takes(takes: &[WrittenTake]) -> FbxNode {
    let current = takes.first().map_or("", |take| &take.name);
    let mut list = FbxNode::new("Takes").value("Current", plain(current));
    for take in takes {
        let range = |name: &'static str| FbxNode::new(name).with(take.start).with(take.stop);
        let name = plain(&take.name);
        let file = format!("{}.tak", name.replace(' ', "_"));
        let node = FbxNode::new("Take").with(name).value("FileName", file);
        list.push(node.containing([range("LocalTime"), range("ReferenceTime")]));
    }
    list
}
