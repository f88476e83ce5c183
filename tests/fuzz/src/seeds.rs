//! Seeds: the files of `tests/data`, and files made from them in formats of which none is stored.

use super::Target;
use dragonfly_anim::compressed::{CompressionSettings, Exactness, compress};
use dragonfly_anim::format::{Formats, NoFiles, ReadOptions, WriteSupport};
use dragonfly_kit::folder::data;
use std::fs;
use std::path::PathBuf;

/// Valid or nearly valid input of a target.
#[derive(Clone, Debug)]
pub struct Seed {
    /// Name of the file that it comes from.
    pub name: String,
    /// The input.
    pub bytes: Vec<u8>,
}

/// Returns the seeds of a target: stored files, the smallest first, then made ones.
pub fn seeds(target: &Target) -> Vec<Seed> {
    let mut seeds: Vec<Seed> = stored(target.extensions);
    seeds.extend(made(target.name));
    seeds.sort_by_key(|seed| seed.bytes.len());
    seeds
}

fn stored(extensions: &[&str]) -> Vec<Seed> {
    let (mut found, mut folders) = (Vec::new(), vec![data("")]);
    while let Some(folder) = folders.pop() {
        let mut paths: Vec<PathBuf> =
            fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().and_then(|it| it.to_str()).is_some_and(|it| extensions.contains(&it)) {
                let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
                found
                    .extend(fs::read(&path).ok().map(|bytes| Seed { name: name.unwrap_or_default(), bytes }));
            }
        }
    }
    found
}

/// Makes seeds of a target whose format is not stored in `tests/data`.
fn made(target: &str) -> Vec<Seed> {
    let made = |name: &str, bytes: Vec<u8>| vec![Seed { name: name.to_owned(), bytes }];
    let Ok(bytes) = fs::read(data("gltf/Fox.glb")) else { return Vec::new() };
    let Ok(fox) = Formats::builtin().read("Fox.glb", &bytes, &NoFiles, &ReadOptions::default()) else {
        return Vec::new();
    };
    match target {
        "dfm" => match Formats::builtin().by_name("dfm").map(|format| format.write) {
            Some(WriteSupport::Whole(write)) => {
                write(&fox.model).map_or(Vec::new(), |file| made("Fox.dfm", file.bytes))
            }
            _ => Vec::new(),
        },
        "compressed" => {
            let animation = &fox.model.animation;
            // The fox is a hundred units long.
            let everywhere = Exactness { tolerance: 0.01, shell: 3.0 };
            let settings = CompressionSettings { everywhere, ..CompressionSettings::default() };
            let takes =
                animation.takes.iter().filter_map(|take| compress(take, &animation.skeleton, &settings).ok());
            takes
                .map(|(take, _)| Seed { name: "Fox.dfc".to_owned(), bytes: take.as_bytes().to_vec() })
                .collect()
        }
        "image" => fox
            .model
            .images
            .iter()
            .map(|image| Seed { name: image.name.clone(), bytes: image.bytes.to_vec() })
            .collect(),
        "journal" => made("empty.journal", b"\x89DFJ\r\n\x1a\n\x01\0\0\0\x02\0\0\0{}".to_vec()),
        _ => Vec::new(),
    }
}
