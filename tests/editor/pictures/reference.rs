//! The stored pictures: read, compared with new ones, and written as small as PNG allows.

use super::compare::{LEVELS, OneOf, PictureDifference, distance};
use image::{Rgba, RgbaImage};
use png::{BitDepth, ColorType, Compression, Filter};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fs;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// The command that replaces the stored pictures, for the text of failures.
pub(super) const HOW_TO_UPDATE: &str = "If the new pictures are right, `DRAGONFLY_UPDATE_PICTURES=1 ./test --workspace --test editor pictures` \
     replaces the stored ones.";

/// Returns whether pictures that differ are to be replaced.
pub(super) fn update() -> bool {
    std::env::var_os("DRAGONFLY_UPDATE_PICTURES").is_some_and(|value| value != "0")
}

/// The folder of the project.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// Returns the file of a stored picture.
pub(super) fn path(name: &str) -> PathBuf {
    root().join("tests/data/pictures").join(format!("{name}.png"))
}

/// Returns the file that a new picture is written to when it differs.
fn new_path(name: &str, kind: &str) -> PathBuf {
    root().join("target/pictures").join(format!("{name}.{kind}.png"))
}

/// Returns the names of all stored pictures.
pub(super) fn stored() -> Vec<String> {
    let mut names = Vec::new();
    let folders = fs::read_dir(root().join("tests/data/pictures")).into_iter().flatten().flatten();
    for folder in folders.filter(|entry| entry.path().is_dir()) {
        for file in fs::read_dir(folder.path()).unwrap().flatten() {
            let file = file.path();
            assert_eq!(file.extension().and_then(|extension| extension.to_str()), Some("png"), "{file:?}");
            let [folder, stem] = [folder.path().file_name(), file.file_stem()]
                .map(|name| name.unwrap().to_string_lossy().into_owned());
            names.push(format!("{folder}/{stem}"));
        }
    }
    names
}

/// Compares a picture with the stored one. Returns the complaint if they differ; an update replaces the stored one instead.
pub(super) fn compare(name: &str, new: &RgbaImage, tolerance: OneOf) -> Option<String> {
    let complaint = match image::open(path(name)) {
        Err(error) => Some((format!("there is no stored picture ({error})"), None)),
        Ok(stored) => {
            let stored = stored.into_rgba8();
            match PictureDifference::between(new, &stored, tolerance) {
                None => {
                    let [old, now] = [&stored, new].map(|picture| format!("{:?}", picture.dimensions()));
                    Some((format!("the size is {now}, was {old}"), None))
                }
                Some(difference) if difference.is_small() => None,
                Some(PictureDifference { pixels, allowed, most, shown }) => Some((
                    format!("{pixels} pixels differ, by up to {most} levels; {allowed} may"),
                    Some(shown),
                )),
            }
        }
    };
    let [new_file, difference_file] = [new_path(name, "new"), new_path(name, "difference")];
    for old in [&new_file, &difference_file] {
        let _ = fs::remove_file(old);
    }
    let (complaint, shown) = complaint?;
    if update() {
        write(&path(name), new);
        return None;
    }
    write(&new_file, new);
    if let Some(shown) = shown {
        write(&difference_file, &shown);
    }
    Some(format!("{name}: {complaint}; new picture: {}", new_file.display()))
}

/// Writes a picture in as few bytes as possible: with a palette if 256 colors come close enough to all that it has,
/// else with values that are multiples of three.
fn write(path: &Path, picture: &RgbaImage) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    let file = BufWriter::new(fs::File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, picture.width(), picture.height());
    encoder.set_compression(Compression::High);
    encoder.set_depth(BitDepth::Eight);
    let colors = picture.pixels().map(|&Rgba([red, green, blue, _])| [red, green, blue]);
    let data: Vec<u8> =
        if let Some(palette) = (0..=ROUNDING).find_map(|error| Palette::of(colors.clone(), error)) {
            encoder.set_color(ColorType::Indexed);
            encoder.set_palette(palette.colors.concat());
            encoder.set_filter(Filter::NoFilter);
            colors.map(|color| palette.places[&color]).collect()
        } else {
            encoder.set_color(ColorType::Rgb);
            encoder.set_filter(Filter::Adaptive);
            colors.flatten().map(|value| value.saturating_add(1) / 3 * 3).collect()
        };
    encoder.write_header().unwrap().write_image_data(&data).unwrap();
}

/// Largest difference of a channel between a color and the one that is stored for it. Less than what counts as equal; the
/// colors of areas are the most frequent ones, and stored exactly.
const ROUNDING: u8 = LEVELS - 2;

/// The colors of a picture, as few as needed.
struct Palette {
    colors: Vec<[u8; 3]>,
    /// Index of the stored color for each color of the picture.
    places: BTreeMap<[u8; 3], u8>,
}

impl Palette {
    /// Returns a palette in which every color has one that differs by at most `error` in each channel; `None` if 256 colors
    /// are not enough.
    fn of(all: impl Iterator<Item = [u8; 3]>, error: u8) -> Option<Self> {
        let mut counts: BTreeMap<[u8; 3], usize> = BTreeMap::new();
        all.for_each(|color| *counts.entry(color).or_default() += 1);
        let mut frequent: Vec<([u8; 3], usize)> = counts.into_iter().collect();
        frequent.sort_by_key(|&(color, count)| (Reverse(count), color));
        let (mut colors, mut places) = (Vec::new(), BTreeMap::new());
        for (color, _) in frequent {
            let distances = colors.iter().map(|other| distance(color, *other)).zip(0..=u8::MAX);
            let nearest = distances.min().filter(|(distance, _)| *distance <= error);
            let place = match nearest {
                Some((_, place)) => place,
                None => {
                    colors.push(color);
                    u8::try_from(colors.len() - 1).ok()?
                }
            };
            places.insert(color, place);
        }
        Some(Self { colors, places })
    }
}
