//! The rows of the dope sheet, and the channels of each.

use crate::panels::context::PanelContext;
use crate::panels::keys::{ChannelId, channel};
use crate::panels::shown_skeleton::{ShownSkeleton, SkeletonChange};
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::edit::Property;
use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

/// What a row shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum RowKind {
    /// All listed bones.
    Summary,
    /// A bone.
    Bone(BoneIndex),
    /// One channel of a bone.
    Channel(BoneIndex, Property),
    /// Weights of morph targets, whose keys can be selected and deleted.
    Morphs,
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DopeRow {
    /// What it shows.
    pub(super) kind: RowKind,
    /// Its name.
    pub(super) name: String,
    /// Whether the channels of the bone are listed.
    pub(super) open: bool,
}

/// The rows, rebuilt only when something that they depend on changed.
#[derive(Debug, Default)]
pub(super) struct DopeRows {
    list: Arc<[DopeRow]>,
    /// Channels of the listed bones, in the order of the bones.
    channels: Arc<[ChannelId]>,
    /// Bones that the user opened or closed.
    toggled: HashSet<BoneIndex>,
    of: ShownSkeleton,
    made_of: Option<RowsKey>,
    looked_at: Option<(Arc<Take>, u64)>,
}

#[derive(PartialEq)]
struct RowsKey {
    model: usize,
    signature: u64,
    selected: Vec<BoneIndex>,
    only_selected: bool,
    changed: Option<Vec<BoneIndex>>,
    filter: String,
    toggled: usize,
}

impl std::fmt::Debug for RowsKey {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "MadeOf({:x})", self.signature)
    }
}

impl DopeRows {
    /// Rebuilds the rows if they are not those of `take`.
    pub(super) fn update(&mut self, context: &PanelContext<'_>, take: &Arc<Take>) {
        let signature = match &self.looked_at {
            Some((looked_at, signature)) if Arc::ptr_eq(looked_at, take) => *signature,
            _ => signature(take),
        };
        self.looked_at = Some((Arc::clone(take), signature));
        let model = context.view.map_or(0, |view| Arc::as_ptr(&view.loaded) as usize);
        match self.of.follow(context.view) {
            SkeletonChange::Same => {}
            SkeletonChange::Shifted(shift) => {
                let toggled = std::mem::take(&mut self.toggled).into_iter();
                self.toggled = toggled.filter_map(|bone| shift.bone(bone)).collect();
            }
            SkeletonChange::Replaced => self.toggled.clear(),
        }
        let changed = context.changed_bones();
        let same = self.made_of.as_ref().is_some_and(|made_of| {
            made_of.model == model
                && made_of.signature == signature
                && made_of.selected == context.selection.bones()
                && made_of.only_selected == context.keys.only_selected()
                && made_of.changed == changed
                && made_of.filter == context.keys.filter()
                && made_of.toggled == self.toggled.len()
        });
        if same {
            return;
        }
        self.made_of = Some(RowsKey {
            model,
            signature,
            selected: context.selection.bones().to_vec(),
            only_selected: context.keys.only_selected(),
            changed,
            filter: context.keys.filter().to_owned(),
            toggled: self.toggled.len(),
        });
        self.make(context, take);
    }

    fn make(&mut self, context: &PanelContext<'_>, take: &Take) {
        let bones = context.listed_bones();
        let channels: Vec<ChannelId> = bones.iter().flat_map(|&bone| channel::channels(take, bone)).collect();
        let mut list = Vec::new();
        let row = |kind, name: &str, open| DopeRow { kind, name: name.to_owned(), open };
        if !bones.is_empty() {
            let name = match bones.len() {
                1 => "1 bone".to_owned(),
                count => format!("{count} bones"),
            };
            list.push(row(RowKind::Summary, &name, false));
        }
        // One or two bones are open by default; `toggled` inverts that.
        let usually = bones.len() <= 2;
        for &bone in &bones {
            let open = usually != self.toggled.contains(&bone);
            list.push(row(RowKind::Bone(bone), &context.bone_name(bone), open));
            if open {
                for (bone, property) in channel::channels(take, bone) {
                    let name = match property {
                        Property::Translation => "Translation",
                        Property::Rotation => "Rotation",
                        Property::Scale => "Scale",
                    };
                    list.push(row(RowKind::Channel(bone, property), name, false));
                }
            }
        }
        if context.lists_shapes() {
            list.push(row(RowKind::Morphs, "Shapes", false));
        }
        (self.list, self.channels) = (list.into(), channels.into());
    }

    /// Returns the rows from top to bottom.
    pub(super) fn list(&self) -> &Arc<[DopeRow]> {
        &self.list
    }

    /// Whether there are no rows.
    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the channels of all listed bones.
    pub(super) fn channels(&self) -> &Arc<[ChannelId]> {
        &self.channels
    }

    /// Returns the channels of a row.
    pub(super) fn of(&self, kind: RowKind) -> &[ChannelId] {
        match kind {
            RowKind::Summary => &self.channels,
            RowKind::Bone(bone) => &self.channels[self.range(bone)],
            RowKind::Channel(bone, property) => {
                let range = self.range(bone);
                let at = self.channels[range.clone()].iter().position(|channel| *channel == (bone, property));
                at.map_or(&[], |at| std::slice::from_ref(&self.channels[range.start + at]))
            }
            RowKind::Morphs => &[],
        }
    }

    fn range(&self, bone: BoneIndex) -> Range<usize> {
        let Some(first) = self.channels.iter().position(|channel| channel.0 == bone) else { return 0..0 };
        let count = self.channels[first..].iter().take_while(|channel| channel.0 == bone).count();
        first..first + count
    }

    /// Opens or closes a bone.
    pub(super) fn toggle(&mut self, bone: BoneIndex) {
        if !self.toggled.remove(&bone) {
            self.toggled.insert(bone);
        }
        self.made_of = None;
    }
}

/// Returns a hash of which channels of a take have keys.
fn signature(take: &Take) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64 ^ u64::from(take.morphs.is_empty());
    for track in &take.tracks {
        let has = [track.translation.is_empty(), track.rotation.is_empty(), track.scale.is_empty()];
        let bits = has.iter().fold(u64::from(track.bone) + 1, |bits, &empty| bits << 1 | u64::from(empty));
        hash = (hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3);
    }
    hash
}
