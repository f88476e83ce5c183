//! The flat result: what the child sends, and how the parent checks it.
//!
//! ```text
//! magic, 8 bytes │ length of the header, u32 │ header, JSON │ model, `.dfm`, to the end
//! ```
//!
//! The child may be under the control of whoever made the file, so its answer is read like a file of a stranger: the
//! header has a limit, codes and numbers are looked up in lists, and the model is read by the importer of `.dfm`.

use crate::code::{FBX_PARSER, known};
use crate::convert::{ConvertedScene, MEMORY, convert};
use crate::request::up_axis;
use crate::textures::{self, ExternalTexture};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{
    ConventionSource, Conversion, Found, Handedness, ImportContext, ImportError, Place, Warning, dfm,
};
use serde::{Deserialize, Serialize};

/// First bytes of an answer.
const MAGIC: &[u8; 8] = b"DFLYFBX!";

/// Largest header in bytes: a thousand warnings and texture names fit.
const HEADER_BYTES: u32 = 4 << 20;

/// Quantities that an error about limits can name.
const QUANTITIES: &[&str] = &["nodes", "joints", "vertices", "keys of one channel", MEMORY];

/// The protections of the child, as the child reports them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct CageReport {
    /// Protections that this system does not have, each with the reason.
    pub(crate) missing: Vec<String>,
}

#[derive(Serialize, Deserialize)]
struct AnswerHeader {
    cage: CageReport,
    outcome: ParseOutcome,
}

#[derive(Serialize, Deserialize)]
enum ParseOutcome {
    /// A model follows.
    Model { conversion: WireConversion, warnings: Vec<WireNote>, textures: Vec<ExternalTexture> },
    /// The file cannot be read.
    Invalid(WireNote),
    /// The file needs a feature.
    Unsupported { place: WirePlace, feature: String },
    /// The file exceeds a limit.
    TooLarge { place: WirePlace, what: String, size: u64, limit: u64 },
}

#[derive(Serialize, Deserialize)]
enum WirePlace {
    File,
    Pointer(String),
    Byte(u64),
    Line(u32, u32),
}

/// A warning, or the reason of an error.
#[derive(Serialize, Deserialize)]
struct WireNote {
    place: WirePlace,
    code: String,
    text: String,
}

/// Values with their sources: 0 format, 1 file, 2 guess, 3 user.
#[derive(Serialize, Deserialize)]
struct WireConversion {
    meters_per_unit: (f32, u8),
    up: (u8, u8),
    is_left: (bool, u8),
}

const SOURCES: [ConventionSource; 4] =
    [ConventionSource::Format, ConventionSource::File, ConventionSource::Guess, ConventionSource::User];

fn source_number(source: ConventionSource) -> u8 {
    SOURCES.iter().position(|known| *known == source).unwrap_or(0) as u8
}

impl From<&Place> for WirePlace {
    fn from(place: &Place) -> Self {
        match place {
            Place::File => Self::File,
            Place::Pointer(pointer) => Self::Pointer(pointer.clone()),
            Place::Byte(offset) => Self::Byte(*offset),
            Place::Line(line, column) => Self::Line(*line, *column),
        }
    }
}

impl From<WirePlace> for Place {
    fn from(place: WirePlace) -> Self {
        match place {
            WirePlace::File => Self::File,
            WirePlace::Pointer(pointer) => Self::Pointer(pointer),
            WirePlace::Byte(offset) => Self::Byte(offset),
            WirePlace::Line(line, column) => Self::Line(line, column),
        }
    }
}

impl WireNote {
    fn of(warning: Warning) -> Self {
        Self { place: (&warning.place).into(), code: warning.code.to_owned(), text: warning.text }
    }
}

impl WireConversion {
    fn of(conversion: &Conversion) -> Self {
        let Conversion { meters_per_unit, up, handedness, frame_rate: _ } = conversion;
        Self {
            meters_per_unit: (meters_per_unit.value, source_number(meters_per_unit.source)),
            up: (up.value as u8, source_number(up.source)),
            is_left: (handedness.value == Handedness::Left, source_number(handedness.source)),
        }
    }

    fn conversion(&self) -> Option<Conversion> {
        let source = |number: u8| SOURCES.get(usize::from(number)).copied();
        let meters = self.meters_per_unit.0;
        if !meters.is_finite() || meters <= 0.0 {
            return None;
        }
        Some(Conversion {
            meters_per_unit: Found { value: meters, source: source(self.meters_per_unit.1)? },
            up: Found { value: up_axis(self.up.0)?, source: source(self.up.1)? },
            handedness: Found { value: Handedness::of_left(self.is_left.0), source: source(self.is_left.1)? },
            frame_rate: None,
        })
    }
}

/// Returns `magic`, the length of `body` and `body`.
pub(crate) fn frame(magic: &[u8; 8], body: &[u8]) -> Vec<u8> {
    [&magic[..], &(body.len() as u32).to_le_bytes(), body].concat()
}

/// Returns the bytes after the first twelve, and the length that those state; `None` without `magic`.
pub(crate) fn unframe<'a>(magic: &[u8; 8], bytes: &'a [u8]) -> Option<(&'a [u8], u32)> {
    let rest = bytes.strip_prefix(magic)?;
    let (length, rest) = rest.split_first_chunk::<4>()?;
    Some((rest, u32::from_le_bytes(*length)))
}

/// Parses a file and returns the bytes of the answer. Runs in the child.
pub(crate) fn answer(bytes: &[u8], context: ImportContext<'_>, cage: CageReport) -> Vec<u8> {
    let outcome = convert(bytes, &context).and_then(|scene| {
        let bytes = dfm::write(&scene.model)
            .map_err(|error| broken(format!("the model is inconsistent: {error}")))?;
        Ok((scene, bytes))
    });
    let (outcome, model) = match outcome {
        Ok((ConvertedScene { textures, .. }, model)) => {
            let conversion = WireConversion::of(&context.conversion());
            let warnings = context.into_warnings().into_iter().map(WireNote::of).collect();
            (ParseOutcome::Model { conversion, warnings, textures }, model)
        }
        Err(error) => (of_error(error), Vec::new()),
    };
    let header = serde_json::to_vec(&AnswerHeader { cage, outcome }).unwrap_or_default();
    let mut answer = frame(MAGIC, &header);
    answer.extend(model);
    answer
}

fn of_error(error: ImportError) -> ParseOutcome {
    let place = WirePlace::from(error.place());
    match error {
        ImportError::Invalid { code, reason, .. } => {
            ParseOutcome::Invalid(WireNote { place, code: code.to_owned(), text: reason })
        }
        ImportError::Unsupported { feature, .. } => ParseOutcome::Unsupported { place, feature },
        ImportError::TooLarge { what, size, limit, .. } => {
            ParseOutcome::TooLarge { place, what: what.to_owned(), size, limit }
        }
        other @ (ImportError::External { .. }
        | ImportError::UnknownFormat { .. }
        | ImportError::ReadOnly { .. }
        | ImportError::Cancelled) => {
            ParseOutcome::Invalid(WireNote { place, code: FBX_PARSER.to_owned(), text: other.to_string() })
        }
    }
}

/// Returns the error of a parser that does not work as it should.
pub(crate) fn broken(reason: impl Into<String>) -> ImportError {
    ImportError::Invalid { place: Place::File, code: FBX_PARSER, reason: reason.into() }
}

/// Checks the answer of a child and returns its model. Warnings and conversion go to `context`; external textures are opened.
///
/// No bytes make it panic.
pub fn read_answer(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let damaged = |what: &str| broken(format!("the answer of the parser is damaged: {what}"));
    let (rest, length) = unframe(MAGIC, bytes).ok_or_else(|| damaged("it has no start"))?;
    if length > HEADER_BYTES {
        return Err(damaged("its header is too long"));
    }
    let (header, model) = rest.split_at_checked(length as usize).ok_or_else(|| damaged("it is too short"))?;
    context.charge(&Place::File, 8 * u64::from(length))?;
    let header: AnswerHeader =
        serde_json::from_slice(header).map_err(|_| damaged("its header is no header"))?;
    log_missing(&header.cage);
    let known = |code: &str| known(code).ok_or_else(|| damaged("it has an unknown code"));
    match header.outcome {
        ParseOutcome::Invalid(WireNote { place, code, text }) => {
            Err(ImportError::Invalid { place: place.into(), code: known(&code)?, reason: text })
        }
        ParseOutcome::Unsupported { place, feature } => {
            Err(ImportError::Unsupported { place: place.into(), feature })
        }
        ParseOutcome::TooLarge { place, what, size, limit } => {
            let what = QUANTITIES.iter().copied().find(|quantity| *quantity == what);
            let what = what.ok_or_else(|| damaged("it has an unknown quantity"))?;
            Err(ImportError::TooLarge { place: place.into(), what, size, limit })
        }
        ParseOutcome::Model { conversion, warnings, textures } => {
            let conversion = conversion.conversion().ok_or_else(|| damaged("its units are no units"))?;
            context.converted(conversion);
            for WireNote { place, code, text } in warnings {
                context.work(1)?;
                context.warn(place.into(), known(&code)?, text);
            }
            let mut model = (dfm::DFM.read)(model, context).map_err(|error| match error {
                ImportError::TooLarge { .. } | ImportError::Cancelled => error,
                other => damaged(&other.to_string()),
            })?;
            textures::open(&mut model.images, &textures, context)?;
            Ok(model)
        }
    }
}

/// Logs the protections that the child does not have.
fn log_missing(cage: &CageReport) {
    if cage.missing.is_empty() {
        tracing::debug!("the parser of FBX runs with every protection");
    } else {
        let missing: Vec<&str> = cage.missing.iter().take(16).map(String::as_str).collect();
        tracing::warn!(missing = missing.join("; "), "the parser of FBX runs with fewer protections");
    }
}

/// Parses a file in this process and returns the bytes that a child would send. Only for tests.
pub fn answer_in_process(bytes: &[u8], context: ImportContext<'_>) -> Vec<u8> {
    answer(bytes, context, CageReport::default())
}

/// Parses a file in this process. Only for tests: a file made to attack the parser attacks this process.
pub fn read_in_process(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let ConvertedScene { mut model, textures } = convert(bytes, context)?;
    textures::open(&mut model.images, &textures, context)?;
    Ok(model)
}
