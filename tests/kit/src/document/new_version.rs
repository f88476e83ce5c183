//! New versions of a binary glTF file, as another program writes them.

use serde_json::Value;

/// Returns a binary glTF file with a changed JSON part; the binary part stays.
pub fn new_version(bytes: &[u8], change: impl FnOnce(&mut Value)) -> Vec<u8> {
    let size = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4 bytes")) as usize;
    let (text, rest) = bytes[20..].split_at(size(12));
    let mut json: Value = serde_json::from_slice(text).expect("JSON");
    change(&mut json);
    let mut text = serde_json::to_vec(&json).expect("JSON");
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut new = bytes[..8].to_vec();
    new.extend((20 + text.len() as u32 + rest.len() as u32).to_le_bytes());
    new.extend((text.len() as u32).to_le_bytes());
    new.extend(b"JSON");
    new.extend(text);
    new.extend(rest);
    new
}

/// Reverses the order of all nodes, of all children and of all animations.
pub fn reverse(json: &mut Value) {
    let count = json["nodes"].as_array().expect("nodes").len() as u64;
    let turn = |index: &mut Value| *index = (count - 1 - index.as_u64().expect("an index")).into();
    let each = |list: &mut Value| {
        if let Some(list) = list.as_array_mut() {
            list.iter_mut().for_each(turn);
            list.reverse();
        }
    };
    let list = |value: &mut Value| value.as_array_mut().map(std::mem::take).unwrap_or_default();
    let mut nodes = list(&mut json["nodes"]);
    nodes.reverse();
    nodes.iter_mut().filter_map(|node| node.get_mut("children")).for_each(each);
    json["nodes"] = nodes.into();
    let mut scenes = list(&mut json["scenes"]);
    scenes.iter_mut().for_each(|scene| each(&mut scene["nodes"]));
    json["scenes"] = scenes.into();
    let mut skins = list(&mut json["skins"]);
    for skin in &mut skins {
        skin["joints"].as_array_mut().expect("joints").iter_mut().for_each(turn);
        if let Some(skeleton) = skin.get_mut("skeleton") {
            turn(skeleton);
        }
    }
    json["skins"] = skins.into();
    let mut animations = list(&mut json["animations"]);
    animations.reverse();
    let channels =
        animations.iter_mut().flat_map(|animation| animation["channels"].as_array_mut().expect("channels"));
    channels.for_each(|channel| turn(&mut channel["target"]["node"]));
    json["animations"] = animations.into();
}

/// Renames the nodes of a name.
pub fn rename_nodes(json: &mut Value, from: &str, to: &str) {
    let nodes = json["nodes"].as_array_mut().expect("nodes").iter_mut();
    nodes.filter(|node| node["name"] == from).for_each(|node| node["name"] = to.into());
}
