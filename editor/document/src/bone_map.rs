//! Maps between the bones of two models, as JSON files that users keep and correct.
//!
//! ```json
//! {"bone_map": 1, "source": "walk.glb", "target": "Hero.glb", "bones": [["mixamorig:Hips", "hips"]]}
//! ```
//!
//! Each pair is a bone of the source and the bone of the target that it moves. The second bone of a name is `name #2`.

use super::folder::read_file;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::retarget::SkeletonBinding;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt::Display;
use std::path::Path;

/// Version of the format.
const VERSION: u32 = 1;

/// The largest file that is read, bytes.
const MOST_BYTES: u64 = 16 << 20;

/// A bone map as it is in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoneMap {
    /// Version of the format.
    pub bone_map: u32,
    /// Title of the source, for people.
    #[serde(default)]
    pub source: String,
    /// Title of the target, for people.
    #[serde(default)]
    pub target: String,
    /// Names of bones: source, target.
    pub bones: Vec<[String; 2]>,
}

impl BoneMap {
    /// Returns the map of a binding. Bones without a name are left out.
    pub fn of(titles: [&str; 2], source: &Skeleton, target: &Skeleton, binding: &SkeletonBinding) -> Self {
        let pair = |(bone, from): (usize, &Option<BoneIndex>)| {
            Some([written(source, (*from)?)?, written(target, bone as BoneIndex)?])
        };
        let bones = binding.source_of.iter().enumerate().filter_map(pair).collect();
        Self { bone_map: VERSION, source: titles[0].to_owned(), target: titles[1].to_owned(), bones }
    }

    /// Reads the map in a file.
    ///
    /// # Errors
    ///
    /// The path and the reason.
    pub fn read(path: &Path) -> Result<Self, String> {
        let told = |error: &dyn Display| format!("{}: {error}", path.display());
        let bytes = read_file(path, MOST_BYTES).map_err(|error| told(&error))?;
        let text = String::from_utf8(bytes).map_err(|_| told(&"this is not UTF-8 text"))?;
        Self::parse(&text).map_err(|error| told(&error))
    }

    /// Reads the text of a map.
    ///
    /// # Errors
    ///
    /// The reason, as text.
    pub fn parse(text: &str) -> Result<Self, String> {
        let map: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if map.bone_map > VERSION {
            return Err(format!("version {} of bone maps is newer than this program", map.bone_map));
        }
        Ok(map)
    }

    /// Gives each bone of a skeleton that is the first of a pair the name of the second. Returns the names that no bone has.
    ///
    /// # Errors
    ///
    /// Two bones would get the same name, or one that a bone outside of the map has.
    pub fn rename(&self, skeleton: &mut Skeleton) -> Result<Vec<String>, String> {
        let (mut renamed, mut missing) = (HashMap::new(), Vec::new());
        let mut bones = HashMap::new();
        for (bone, data) in skeleton.bones.iter().enumerate() {
            bones.entry(data.name.as_str()).or_insert(bone);
        }
        for [from, to] in &self.bones {
            let bone = bones.get(from.as_str()).copied();
            match bone.or_else(|| found(skeleton, from).map(|bone| bone as usize)) {
                Some(bone) => drop(renamed.insert(bone, to)),
                None => missing.push(from.clone()),
            }
        }
        let mut names = HashMap::new();
        for (bone, data) in skeleton.bones.iter().enumerate() {
            *names.entry(renamed.get(&bone).map_or(data.name.as_str(), |name| name)).or_insert(0) += 1;
        }
        if let Some(twice) =
            renamed.values().find(|name| names.get(name.as_str()).is_some_and(|&count| count > 1))
        {
            return Err(format!("the map gives two bones the name {twice:?}"));
        }
        for (bone, name) in renamed {
            skeleton.bones[bone].name.clone_from(name);
        }
        Ok(missing)
    }

    /// Returns the map as text, one pair a line.
    pub fn to_text(&self) -> String {
        let quoted = |text: &str| serde_json::Value::from(text).to_string();
        let pair = |[from, to]: &[String; 2]| format!("    [{}, {}]", quoted(from), quoted(to));
        let pairs: Vec<String> = self.bones.iter().map(pair).collect();
        format!(
            "{{\n  \"bone_map\": {},\n  \"source\": {},\n  \"target\": {},\n  \"bones\": [\n{}\n  ]\n}}\n",
            self.bone_map,
            quoted(&self.source),
            quoted(&self.target),
            pairs.join(",\n")
        )
    }

    /// Returns the binding, and the names that one of the skeletons does not have.
    ///
    /// # Errors
    ///
    /// A bone of the target is in two pairs.
    pub fn binding(
        &self,
        source: &Skeleton,
        target: &Skeleton,
    ) -> Result<(SkeletonBinding, Vec<String>), String> {
        let (mut pairs, mut missing) = (Vec::new(), Vec::new());
        for [from, to] in &self.bones {
            match (found(source, from), found(target, to)) {
                (Some(from), Some(to)) => pairs.push((from, to)),
                (found, _) => missing.push(if found.is_none() { from.clone() } else { to.clone() }),
            }
        }
        let binding = SkeletonBinding::from_map(source, target, &pairs).map_err(|error| error.to_string())?;
        Ok((binding, missing))
    }
}

/// Returns the name of a bone with its number among the bones of the name; `None` for one without a name.
fn written(skeleton: &Skeleton, bone: BoneIndex) -> Option<String> {
    let name = &skeleton.bones.get(bone as usize)?.name;
    let number = skeleton.bones[..=bone as usize].iter().filter(|other| other.name == *name).count();
    let text = if number > 1 { format!("{name} #{number}") } else { name.clone() };
    (!name.is_empty()).then_some(text)
}

/// Returns the bone of a written name.
fn found(skeleton: &Skeleton, text: &str) -> Option<BoneIndex> {
    let exact = skeleton.find(text);
    exact.or_else(|| {
        let (name, number) = text.rsplit_once(" #")?;
        let same = (0..).zip(&skeleton.bones).filter(|(_, bone)| bone.name == name);
        same.map(|(bone, _)| bone).nth(number.parse::<usize>().ok()?.checked_sub(1)?)
    })
}
