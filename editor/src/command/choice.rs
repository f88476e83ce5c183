//! Arguments that several commands share, and their parsers: a file, a take, times, a size, a color.

use super::import_options::ImportArguments;
use super::{Failure, progress::Teller};
use dragonfly_anim::data::{ModelData, Take};
use dragonfly_document::{Cancel, LoadedModel, Source, formats, is_scene, load_model};
use std::path::PathBuf;
use std::str::FromStr;

/// Name of the built-in model where a file is expected.
pub(super) const BUILT_IN: &str = "demo:";

/// Returns the help text of a model argument, with the extensions of all formats.
pub(super) fn model_help() -> String {
    format!("A model ({}), or `demo:` for the built-in dragonfly", formats().extension_list())
}

/// Returns the help text of an argument of several models, with the extensions of all formats.
pub(super) fn models_help() -> String {
    format!("Models ({}), or `demo:` for the built-in dragonfly", formats().extension_list())
}

/// The model argument.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct File {
    #[arg(value_name = "FILE", help = model_help())]
    path: PathBuf,
    #[command(flatten)]
    import: ImportArguments,
}

impl File {
    /// Creates the argument of a command in which it may be missing.
    pub(super) fn new(path: PathBuf, import: ImportArguments) -> Self {
        Self { path, import }
    }

    /// Returns the source that it names.
    pub(super) fn source(&self) -> Source {
        source_as(&self.path, &self.import)
    }

    /// Returns the path if it is that of a scene: of its script or its project.
    ///
    /// # Errors
    ///
    /// The options that were given although only models have them.
    pub(super) fn scene(&self, take: &TakeChoice) -> Result<Option<&std::path::Path>, Failure> {
        if !is_scene(&self.path) {
            return Ok(None);
        }
        if take.take.is_some() {
            return Err(Failure::input("--take", "a scene has no takes; its script says what plays"));
        }
        // Each option is followed by its value.
        let given: Vec<String> = self.import.to_arguments().into_iter().step_by(2).collect();
        if !given.is_empty() {
            let reason = "these options are for a model file; a scene does not use them";
            return Err(Failure::input(given.join(", "), reason));
        }
        Ok(Some(&self.path))
    }

    /// Loads the model, with progress on stderr if that takes long.
    pub(super) fn load(&self) -> Result<LoadedModel, Failure> {
        load(&self.source())
    }

    /// Does the same as [`Self::load`], with warnings about images that cannot be decoded.
    pub(super) fn load_checked(&self) -> Result<LoadedModel, Failure> {
        load_checked(&self.source())
    }
}

/// Returns the source that `path` names.
pub(super) fn source(path: &std::path::Path) -> Source {
    if path == std::path::Path::new(BUILT_IN) { Source::BuiltIn } else { Source::File(path.to_path_buf()) }
}

/// Returns the source that `path` names, read with these options.
pub(super) fn source_as(path: &std::path::Path, import: &ImportArguments) -> Source {
    match source(path) {
        Source::File(path) => Source::of(path, import.conventions()),
        other @ (Source::BuiltIn | Source::FileAs(..)) => other,
    }
}

/// Loads `source`, with progress on stderr if that takes long.
pub(super) fn load(source: &Source) -> Result<LoadedModel, Failure> {
    let mut teller = Teller::new(source.title());
    Ok(load_model(source, &mut |progress| teller.tell(progress), &Cancel::default())?)
}

/// Does the same as [`load`], with warnings about images that cannot be decoded, which otherwise are found when the model is
/// drawn.
pub(super) fn load_checked(source: &Source) -> Result<LoadedModel, Failure> {
    let mut loaded = load(source)?;
    loaded.warnings.extend(loaded.images.damage(&loaded.model.images));
    Ok(loaded)
}

/// The take argument.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct TakeChoice {
    /// Take, by name or by index from 0; a name has priority over an index [default: the first]
    #[arg(long, value_name = "TAKE", allow_hyphen_values = true)]
    take: Option<String>,
}

impl TakeChoice {
    /// Returns what was written; `None` where nothing was.
    pub(super) fn written(&self) -> Option<&str> {
        self.take.as_deref()
    }

    /// Returns the index of the take; `None` for the rest pose of a model without takes.
    pub(super) fn index(&self, title: &str, model: &ModelData) -> Result<Option<usize>, Failure> {
        let takes = &model.animation.takes;
        let Some(wanted) = &self.take else {
            return Ok(if takes.is_empty() { None } else { Some(0) });
        };
        takes
            .iter()
            .position(|take| take.name == *wanted)
            .or_else(|| wanted.parse().ok().filter(|&index| index < takes.len()))
            .map(Some)
            .ok_or_else(|| {
                Failure::input(
                    title,
                    format_args!("--take: no take is called \"{}\"; {}", plain(wanted), offer(takes)),
                )
            })
    }
}

/// Returns the list of available takes for an error message.
fn offer(takes: &[std::sync::Arc<Take>]) -> String {
    const SHOWN: usize = 12;
    if takes.is_empty() {
        return "the model has none".to_owned();
    }
    let names: Vec<String> = takes
        .iter()
        .take(SHOWN)
        .enumerate()
        .map(|(index, take)| format!("{index} \"{}\"", plain(&take.name)))
        .collect();
    let more = if takes.len() > SHOWN { format!(" and {} more", takes.len() - SHOWN) } else { String::new() };
    format!("there is {}{more}", names.join(", "))
}

/// Clamps `time` to take number `take`; unchanged for the rest pose, which is the same at all times.
pub(super) fn clamp_time(model: &ModelData, take: Option<usize>, time: f32) -> f32 {
    match take.and_then(|take| model.animation.takes.get(take)) {
        // `clamp` would panic if the start is after the end.
        Some(take) => time.min(take.end()).max(take.start),
        None => time,
    }
}

/// Parses a finite number; refuses "nan" and "inf".
pub(super) fn finite(text: &str) -> Result<f32, String> {
    match f32::from_str(text) {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err("must be a finite number".to_owned()),
        Err(_) => Err("is not a number".to_owned()),
    }
}

/// Longest side of an image, pixels: the texture size limit of current devices.
const LONGEST_SIDE: u32 = 16_384;

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let usage = || "is not a size; write for example 1280x720".to_owned();
        let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(usage)?;
        let side = |text: &str| text.trim().parse::<u32>().map_err(|_| usage());
        let (width, height) = (side(width)?, side(height)?);
        if [width, height].iter().any(|side| !(1..=LONGEST_SIDE).contains(side)) {
            return Err(format!("each side must be 1 to {LONGEST_SIDE} pixels"));
        }
        Ok(Self { width, height })
    }
}

/// A color in hexadecimal web notation: red, green, blue and optionally opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Color(pub [u8; 4]);

impl FromStr for Color {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let digits = text.strip_prefix('#').unwrap_or(text);
        let usage = "is not a color; write RRGGBB or RRGGBBAA, for example 202830ff";
        if !matches!(digits.len(), 6 | 8) || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(usage.to_owned());
        }
        let mut color = [0xff; 4];
        for (index, value) in color.iter_mut().take(digits.len() / 2).enumerate() {
            *value =
                u8::from_str_radix(&digits[2 * index..2 * index + 2], 16).map_err(|_| usage.to_owned())?;
        }
        Ok(Self(color))
    }
}

/// Returns `text` of a file with control characters escaped, so that it cannot move the cursor or break the line.
pub(super) fn plain(text: &str) -> String {
    text.chars()
        .flat_map(|character| {
            let shown = !character.is_control();
            let escaped = (!shown).then(|| character.escape_unicode());
            shown.then_some(character).into_iter().chain(escaped.into_iter().flatten())
        })
        .collect()
}
