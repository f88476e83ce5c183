//! One pass over the JSON text before it is parsed: its depth, the memory that it needs, its version.
//!
//! The parser of the document model silently truncates indices to 32 bits and allocates hundreds of bytes for a `{}`,
//! so both are checked here first.

use super::check as code;
use super::pointer::ChannelPointers;
use super::target_path::POINTER_EXTENSION;
use super::walk::{Walk, WalkStep};
use super::whole::whole;
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::{JSON_DEPTH, NODES};
use gltf::json;

/// Facts that the parser needs.
#[derive(Debug, Default)]
pub(super) struct Survey {
    /// Upper bound of the memory of the document, in bytes.
    pub(super) memory: u64,
    /// `/asset/version` and `/asset/minVersion`, as in the file.
    pub(super) version: Option<String>,
    pub(super) min_version: Option<String>,
    /// Requirements of the document model that the specification does not have, in the order of the text.
    pub(super) patches: Vec<SurveyPatch>,
    /// Targets of channels that are JSON pointers.
    pub(super) pointers: ChannelPointers,
}

/// A change of the text before it is parsed.
#[derive(Clone, Copy, Debug)]
pub(super) enum SurveyPatch {
    /// A missing member, to be inserted.
    Member { at: usize, member: &'static str },
    /// A whole number that is written with a fraction or an exponent, from `at` to `end`.
    Whole { at: usize, end: usize, number: u64 },
}

impl SurveyPatch {
    /// Returns the largest number of bytes that the patch adds.
    pub(super) fn longest(&self) -> usize {
        match self {
            Self::Member { member, .. } => member.len(),
            Self::Whole { .. } => LONGEST_NUMBER,
        }
    }
}

/// Number of digits of the largest whole number.
const LONGEST_NUMBER: usize = 20;

/// Surveys `text`.
pub(super) fn survey(text: &[u8], context: &ImportContext<'_>) -> Result<Survey, ImportError> {
    let mut survey = Survey::default();
    let mut walk = Walk::new(text);
    // Depth of the enclosing member whose data is not used.
    let mut skipping: Option<usize> = None;
    while let Some(step) = walk.step() {
        context.work(1)?;
        let depth = walk.frames().len();
        if depth > JSON_DEPTH {
            let place = Place::Pointer(walk.pointer(1));
            let (size, limit) = (depth as u64, JSON_DEPTH as u64);
            return Err(ImportError::TooLarge { place, what: "levels of arrays and objects", size, limit });
        }
        if skipping.is_some_and(|outer| depth > outer) {
            continue;
        }
        skipping = None;
        match step {
            WalkStep::Key if matches!(walk.key(depth - 1), b"extras") => skipping = Some(depth),
            WalkStep::Key => {
                survey.memory += MEMBER;
                if asked_for(&mut walk, depth).is_some_and(|member| walk.key(depth - 1) == member.name) {
                    walk.frames()[depth - 1].note = 0;
                }
            }
            WalkStep::Open => survey.opened(&mut walk, depth)?,
            WalkStep::Close => survey.closed(&mut walk, depth),
            WalkStep::Scalar(from, to) => survey.scalar(&mut walk, &text[from..to], from)?,
        }
    }
    // A member is found at the end of its object, after the numbers in it.
    survey.patches.sort_by_key(|patch| match *patch {
        SurveyPatch::Member { at, .. } | SurveyPatch::Whole { at, .. } => at,
    });
    Ok(survey)
}

/// Bytes for a member of an object. The objects of the model are counted with their arrays; this is for maps.
const MEMBER: u64 = 40;
/// Overhead of a small allocation, in bytes.
const ALLOCATION: u64 = 32;

impl Survey {
    fn opened(&mut self, walk: &mut Walk<'_>, depth: usize) -> Result<(), ImportError> {
        let is_array = walk.frames()[depth - 1].is_array;
        if depth >= 2 && walk.frames()[depth - 2].is_array {
            self.element(walk, depth - 2)?;
        }
        if is_array && depth >= 2 {
            let bytes = element_bytes(walk.key(depth - 2), depth == 2);
            walk.frames()[depth - 1].note = bytes;
            self.memory += ALLOCATION + 4 * bytes as u64;
        } else if depth >= 2 && matches!(walk.key(depth - 2), b"attributes") {
            self.memory += 640;
        } else if asked_for(walk, depth).is_some() {
            walk.frames()[depth - 1].note = walk.at();
        }
        Ok(())
    }

    fn closed(&mut self, walk: &mut Walk<'_>, depth: usize) {
        let frame = walk.frames()[depth - 1];
        if frame.note != 0
            && let Some(member) = asked_for(walk, depth)
        {
            self.memory += 64 + member.followed.len() as u64;
            let text = if frame.count == 0 { member.alone } else { member.followed };
            self.patches.push(SurveyPatch::Member { at: frame.note, member: text });
        }
    }

    fn scalar(&mut self, walk: &mut Walk<'_>, text: &[u8], at: usize) -> Result<(), ImportError> {
        let Some(last) = walk.frames().len().checked_sub(1) else { return Ok(()) };
        if walk.frames()[last].is_array {
            self.element(walk, last)?;
        }
        if text.starts_with(b"\"") {
            self.memory += ALLOCATION + text.len() as u64;
            if let Some(channel) = pointer_of(walk, last)
                && let Ok(pointer) = serde_json::from_slice(text)
            {
                self.memory += size_of::<((usize, usize), String)>() as u64;
                self.pointers.insert(channel, pointer);
            }
            if last == 1 && walk.key(0) == b"asset" {
                let word = || Some(String::from_utf8_lossy(&text[1..text.len() - 1]).into_owned());
                match walk.key(1) {
                    b"version" => self.version = word(),
                    b"minVersion" => self.min_version = word(),
                    _ => {}
                }
            }
            return Ok(());
        }
        let is_index = (text.len() > 9 || is_fraction(text)) && is_index(walk, last);
        if is_fraction(text)
            && (is_index || is_size(walk, last))
            && let Some(number) = std::str::from_utf8(text).ok().and_then(whole)
        {
            self.memory += 3 * size_of::<SurveyPatch>() as u64;
            if is_index && u32::try_from(number).is_err() {
                return Err(too_large_index(walk, text));
            }
            self.patches.push(SurveyPatch::Whole { at, end: at + text.len(), number });
        } else if is_index && too_long(text) {
            return Err(too_large_index(walk, text));
        }
        Ok(())
    }

    /// Counts one more value in the array of frame `depth`. Vectors grow by doubling, so each value counts three times.
    fn element(&mut self, walk: &mut Walk<'_>, depth: usize) -> Result<(), ImportError> {
        let frame = walk.frames()[depth];
        if frame.count > 4 {
            self.memory += 3 * frame.note as u64;
        }
        if depth == 1 && frame.count > NODES && walk.key(0) == b"nodes" {
            let place = Place::Pointer("/nodes".to_owned());
            let (size, limit) = (frame.count as u64, NODES as u64);
            return Err(ImportError::TooLarge { place, what: "nodes", size, limit });
        }
        Ok(())
    }
}

/// Returns the animation and the channel whose target is the pointer here.
fn pointer_of(walk: &mut Walk<'_>, last: usize) -> Option<(usize, usize)> {
    let keys: [(usize, &[u8]); 6] = [
        (7, b"pointer"),
        (6, POINTER_EXTENSION.as_bytes()),
        (5, b"extensions"),
        (4, b"target"),
        (2, b"channels"),
        (0, b"animations"),
    ];
    if last != 7 || keys.iter().any(|(depth, key)| walk.key(*depth) != *key) {
        return None;
    }
    let frames = walk.frames();
    Some((frames[1].count.checked_sub(1)?, frames[3].count.checked_sub(1)?))
}

/// A member that the document model requires.
struct RequiredMember {
    name: &'static [u8],
    /// Text to insert into an empty object, and before other members.
    alone: &'static str,
    followed: &'static str,
}

/// Represents "no node"; an extension may specify what is animated.
const NODE: RequiredMember =
    RequiredMember { name: b"node", alone: "\"node\":4294967295", followed: "\"node\":4294967295," };
const NODES_OF_SCENE: RequiredMember =
    RequiredMember { name: b"nodes", alone: "\"nodes\":[]", followed: "\"nodes\":[]," };

/// Returns the member that the document model requires in the innermost object and the specification does not.
fn asked_for(walk: &mut Walk<'_>, depth: usize) -> Option<&'static RequiredMember> {
    if depth == 0 || walk.frames()[depth - 1].is_array {
        return None;
    }
    let is_target =
        depth == 6 && walk.key(4) == b"target" && walk.key(2) == b"channels" && walk.key(0) == b"animations";
    let is_scene = depth == 3 && walk.key(0) == b"scenes";
    match (is_target, is_scene) {
        (true, _) => Some(&NODE),
        (_, true) => Some(&NODES_OF_SCENE),
        _ => None,
    }
}

/// Returns the size of one element of the array called `key` in the document model, in bytes. `top`: the array is
/// directly in the root.
fn element_bytes(key: &[u8], top: bool) -> usize {
    match (key, top) {
        (b"accessors", true) => size_of::<json::Accessor>(),
        (b"animations", true) => size_of::<json::Animation>(),
        (b"buffers", true) => size_of::<json::Buffer>(),
        (b"bufferViews", true) => size_of::<json::buffer::View>(),
        (b"cameras", true) => size_of::<json::Camera>(),
        (b"images", true) => size_of::<json::Image>(),
        (b"materials", true) => size_of::<json::Material>(),
        (b"meshes", true) => size_of::<json::Mesh>(),
        (b"nodes", true) => size_of::<json::Node>(),
        (b"samplers", true) => size_of::<json::texture::Sampler>(),
        (b"scenes", true) => size_of::<json::Scene>(),
        (b"skins", true) => size_of::<json::Skin>(),
        (b"textures", true) => size_of::<json::Texture>(),
        (b"primitives", false) => size_of::<json::mesh::Primitive>(),
        (b"targets", false) => size_of::<json::mesh::MorphTarget>(),
        (b"channels", false) => size_of::<json::animation::Channel>(),
        (b"samplers", false) => size_of::<json::animation::Sampler>(),
        (b"min" | b"max", false) => size_of::<json::Value>(),
        (b"extensionsUsed" | b"extensionsRequired", true) => size_of::<String>(),
        _ => 8,
    }
}

fn too_large_index(walk: &Walk<'_>, text: &[u8]) -> ImportError {
    let reason = format!("{} does not fit 32 bits", String::from_utf8_lossy(text));
    ImportError::Invalid { place: Place::Pointer(walk.pointer(0)), code: code::INVALID_INDEX, reason }
}

/// Returns whether a number is written with a fraction or an exponent.
fn is_fraction(text: &[u8]) -> bool {
    text.first().is_some_and(|first| *first == b'-' || first.is_ascii_digit())
        && text.iter().any(|byte| matches!(byte, b'.' | b'e' | b'E'))
}

/// Returns whether the number here becomes a number of bytes or elements.
fn is_size(walk: &Walk<'_>, last: usize) -> bool {
    const NAMES: &[&[u8]] = &[b"byteLength", b"byteOffset", b"byteStride", b"count"];
    NAMES.contains(&walk.key(last))
}

/// Returns whether the number here becomes a 32-bit index or enumerated value.
fn is_index(walk: &Walk<'_>, last: usize) -> bool {
    const NAMES: &[&[u8]] = &[
        b"buffer",
        b"bufferView",
        b"camera",
        b"componentType",
        b"index",
        b"indices",
        b"input",
        b"inverseBindMatrices",
        b"magFilter",
        b"material",
        b"mesh",
        b"minFilter",
        b"mode",
        b"node",
        b"output",
        b"sampler",
        b"scene",
        b"skeleton",
        b"skin",
        b"source",
        b"target",
        b"texCoord",
        b"wrapS",
        b"wrapT",
    ];
    const LISTS: &[&[u8]] = &[b"attributes", b"children", b"joints", b"nodes"];
    let outer = last.checked_sub(1);
    NAMES.contains(&walk.key(last))
        || outer.is_some_and(|outer| LISTS.contains(&walk.key(outer)))
        || last.checked_sub(2).is_some_and(|outer| walk.key(outer) == b"targets")
}

/// Returns whether this is a whole number of more than 32 bits.
fn too_long(text: &[u8]) -> bool {
    let digits = text.strip_prefix(b"-").unwrap_or(text);
    let number = std::str::from_utf8(digits).ok().filter(|_| digits.iter().all(u8::is_ascii_digit));
    number.is_some_and(|number| number.parse::<u32>().is_err())
}
