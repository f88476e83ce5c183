//! The object `AnimationSet`: for each frame lists of keys.

use super::check as code;
use super::lexer::{Lexeme, XLexer, XToken};
use crate::format::{ImportContext, ImportError};
use crate::limits::{KEYS, KEYS_PER_CHANNEL};
use std::ops::Range;

/// Property of the keys of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum XKeyKind {
    /// w, x, y, z.
    Rotation,
    Scale,
    Position,
    /// 16 numbers.
    Matrix,
}

impl XKeyKind {
    /// Returns the number of values of a key.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Rotation => 4,
            Self::Scale | Self::Position => 3,
            Self::Matrix => 16,
        }
    }

    /// Returns the number in the file.
    pub(super) fn number(self) -> u32 {
        match self {
            Self::Rotation => 0,
            Self::Scale => 1,
            Self::Position => 2,
            Self::Matrix => 4,
        }
    }

    fn parse(number: u32) -> Option<Self> {
        match number {
            0 => Some(Self::Rotation),
            1 => Some(Self::Scale),
            2 => Some(Self::Position),
            3 | 4 => Some(Self::Matrix),
            _ => None,
        }
    }
}

/// A list of keys: the object `AnimationKey`.
pub(super) struct XKeys {
    pub(super) kind: XKeyKind,
    /// From the name of the type to the closing brace.
    pub(super) block: Range<usize>,
    /// Place of the number of keys.
    pub(super) count: Range<usize>,
    /// Ticks of each key, with the place from there to its last value.
    pub(super) rows: Vec<(f64, Range<usize>)>,
    /// Values of all keys.
    pub(super) values: Vec<f32>,
}

/// The keys of one frame: the object `Animation`.
pub(super) struct XAnimation {
    /// Name of the frame.
    pub(super) frame: Option<String>,
    pub(super) keys: Vec<XKeys>,
    /// From the name of the type to the closing brace.
    pub(super) block: Range<usize>,
}

/// A take.
pub(super) struct XSet {
    /// Place of the name, if there is one.
    pub(super) name: Option<Range<usize>>,
    /// End of the name of the type.
    pub(super) head: usize,
    pub(super) animations: Vec<XAnimation>,
    /// From the name of the type to the closing brace.
    pub(super) block: Range<usize>,
}

impl XAnimation {
    /// Returns the list of matrices, or else `None`.
    pub(super) fn of(&self, kind: XKeyKind) -> Option<&XKeys> {
        self.keys.iter().find(|keys| keys.kind == kind)
    }
}

/// Reads an animation set whose type is at `at`.
pub(super) fn animation_set(
    lexer: &mut XLexer<'_>,
    at: usize,
    context: &ImportContext<'_>,
) -> Result<XSet, ImportError> {
    let head = lexer.at();
    let name = lexer.open()?;
    context.charge(&lexer.place(at), 4 * size_of::<XSet>() as u64)?;
    let mut set = XSet { name, head, animations: Vec::new(), block: at..at };
    let mut keys = 0;
    loop {
        context.work(1)?;
        let found = lexer.need("the end of an animation set")?;
        match found.token {
            XToken::Close => {
                set.block.end = found.end;
                return Ok(set);
            }
            XToken::Word(b"Animation") => {
                let animation = animation(lexer, found, &mut keys, context)?;
                let bytes = 4 * size_of::<XAnimation>() + 4 * animation.keys.capacity() * size_of::<XKeys>();
                context.charge_at(|| lexer.place(found.at), bytes as u64)?;
                set.animations.push(animation);
            }
            XToken::Word(_) => {
                lexer.open()?;
                lexer.close(context)?;
            }
            XToken::Open => _ = lexer.reference(context)?,
            XToken::Number(_) | XToken::Text(_) | XToken::Other => {
                return Err(lexer.unexpected(found, "an animation"));
            }
        }
    }
}

fn animation(
    lexer: &mut XLexer<'_>,
    start: Lexeme<'_>,
    total: &mut usize,
    context: &ImportContext<'_>,
) -> Result<XAnimation, ImportError> {
    lexer.open()?;
    let mut animation = XAnimation { frame: None, keys: Vec::new(), block: start.range() };
    loop {
        context.work(1)?;
        let found = lexer.need("the end of an animation")?;
        match found.token {
            XToken::Close => {
                animation.block.end = found.end;
                return Ok(animation);
            }
            XToken::Open => {
                let name = lexer.reference(context)?;
                animation.frame = animation.frame.or(name);
            }
            XToken::Word(b"AnimationKey") => {
                if let Some(keys) = keys(lexer, found, total, context)? {
                    if animation.of(keys.kind).is_none() {
                        animation.keys.push(keys);
                    } else {
                        let text = "a second list of keys of the same type is left out";
                        context.warn(lexer.place(found.at), code::KEYS_TWICE, text);
                    }
                }
            }
            XToken::Word(_) => {
                lexer.open()?;
                lexer.close(context)?;
            }
            XToken::Number(_) | XToken::Text(_) | XToken::Other => {
                return Err(lexer.unexpected(found, "keys"));
            }
        }
    }
}

fn keys(
    lexer: &mut XLexer<'_>,
    start: Lexeme<'_>,
    total: &mut usize,
    context: &ImportContext<'_>,
) -> Result<Option<XKeys>, ImportError> {
    lexer.open()?;
    let number = lexer.whole("the type of keys", u32::MAX)?;
    let Some(kind) = XKeyKind::parse(number) else {
        let text = format!("keys of type {number} are left out");
        context.warn(lexer.place(start.at), code::KEY_TYPE_UNKNOWN, text);
        lexer.close(context)?;
        return Ok(None);
    };
    let before = lexer.at();
    let count = lexer.count("the number of keys", kind.width() + 2)?;
    let count_place = lexer.last_of(before);
    *total += count;
    let place = || lexer.place(start.at);
    if count > KEYS_PER_CHANNEL || *total > KEYS {
        let (size, limit) = (*total as u64, KEYS_PER_CHANNEL.min(KEYS) as u64);
        return Err(ImportError::TooLarge { place: place(), what: "keys", size, limit });
    }
    let mut keys = XKeys {
        kind,
        block: start.range(),
        count: count_place,
        rows: context.vec_at(place, count)?,
        values: context.vec_at(place, count * kind.width())?,
    };
    for _ in 0..count {
        context.work(kind.width())?;
        let start = lexer.next_at();
        let ticks = lexer.number("the time of a key")?;
        let width = lexer.whole("the number of values", u32::MAX)? as usize;
        if width != kind.width() {
            let reason = format!("a key of type {} has {width} values, not {}", kind.number(), kind.width());
            return Err(lexer.invalid(start, crate::format::text::NUMBER_INVALID, reason));
        }
        for _ in 0..width {
            keys.values.push(lexer.floats::<1>("a value of a key")?[0]);
        }
        keys.rows.push((ticks, start..lexer.at()));
    }
    let close = lexer.close(context)?;
    keys.block.end = close + 1;
    Ok(Some(keys))
}
