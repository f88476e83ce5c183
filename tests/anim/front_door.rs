//! The first page of the documentation: an example before everything else, and the words of the field lead to the items.

use std::fs;
use std::path::{Path, PathBuf};

/// A file in `src`, an alias, and the start of the item below it.
const ALIASES: &[(&str, &str, &str)] = &[
    ("data/take.rs", "clip", "pub struct Take"),
    ("data/bone.rs", "joint", "pub struct Bone"),
    ("data/bone.rs", "inverse bind matrix", "pub offset:"),
    ("data/bone.rs", "inverse bind matrices", "pub offsets:"),
    ("data/geometry.rs", "blend shape", "pub struct MorphTarget"),
    ("animation/formula.rs", "local space", "pub fn to_parent"),
    ("animation/formula.rs", "model space", "pub fn to_root"),
    ("animation/formula.rs", "global transform", "pub fn to_root"),
    ("animation/formula.rs", "skinning matrix", "pub fn final_pose"),
    ("additional/mod.rs", "local space", "pub enum Space"),
    ("attach/socket.rs", "attachment point", "pub struct Socket"),
    ("blend/additive.rs", "additive", "pub fn add"),
    ("blend/cross_fade.rs", "transition", "pub struct CrossFade"),
    ("hit/tree.rs", "BVH", "pub struct HitTree"),
    ("ik/two_bone.rs", "pole vector", "pub enum Pole"),
    ("level/chain.rs", "level of detail", "pub struct Lod"),
    ("motion/curve.rs", "root motion", "pub struct RootMotion"),
    ("sample/mod.rs", "pose", "pub fn sample_take"),
    ("lib.rs", "LOD", "pub mod level"),
    ("lib.rs", "root motion", "pub mod motion"),
    ("lib.rs", "inverse kinematics", "pub mod ik"),
];

fn text(path: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns whether an attribute directly above `item` has the alias.
fn has_alias(text: &str, alias: &str, item: &str) -> bool {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let starts =
        |line: &&str| line.strip_prefix(item).is_some_and(|rest| !rest.starts_with(char::is_alphabetic));
    let Some(at) = lines.iter().position(starts) else { return false };
    let above = lines[..at].iter().rev().take_while(|line| line.starts_with("#["));
    above.into_iter().any(|line| line.starts_with("#[doc(alias") && line.contains(&format!("\"{alias}\"")))
}

#[test]
fn the_words_of_the_field_are_aliases_of_the_items() {
    for (file, alias, item) in ALIASES {
        assert!(
            has_alias(&text(&format!("src/{file}")), alias, item),
            "{file}: {item} has no alias {alias:?}"
        );
    }
    let planted = "#[doc(alias = \"clip\")]\npub struct Track;\npub struct Take;";
    assert!(has_alias(planted, "clip", "pub struct Track"));
    assert!(!has_alias(planted, "clip", "pub struct Take") && !has_alias(planted, "clip", "pub struct T"));
}

#[test]
fn an_example_that_plays_a_clip_comes_before_the_map_of_modules() {
    for (file, fence, map) in
        [("README.md", "```rust", "## Modules"), ("src/lib.rs", "//! ```", "//! # Modules")]
    {
        let text = text(file);
        let line = |start: &str| text.lines().position(|line| line.starts_with(start));
        let (example, map) = (line(fence).unwrap(), line(map).unwrap());
        assert!(example < 5 && example < map, "{file}: the example starts in line {}", example + 1);
        assert!(text.contains("skin_poses(skin)"), "{file}");
    }
}

#[test]
fn the_map_names_every_public_module() {
    let library = text("src/lib.rs");
    let readme = text("README.md");
    let mut modules = 0;
    for module in library.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')) {
        assert!(library.contains(&format!("[`{module}`]")), "src/lib.rs does not name {module}");
        assert!(readme.contains(&format!("`{module}`")), "README.md does not name {module}");
        modules += 1;
    }
    assert!(modules > 20, "{modules}");
}
