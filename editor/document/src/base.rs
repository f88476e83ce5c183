//! Takes as bytes, exact to the bit, for the journal: after a save the file no longer has the takes with which the
//! history started.
//!
//! Numbers are little-endian; a list is its length (4 bytes) and its elements. Data that is read is validated as far
//! as the rest of the program relies on it. After the takes come the extras of those that have some: the index of the
//! take, and its names and texts.

use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Take, TakeExtras, Track};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Writes all takes.
pub(super) fn write(takes: &[Arc<Take>]) -> Vec<u8> {
    let mut out = Vec::new();
    length(&mut out, takes.len());
    for take in takes {
        length(&mut out, take.name.len());
        out.extend(take.name.as_bytes());
        floats(&mut out, [take.start, take.length]);
        length(&mut out, take.tracks.len());
        for track in &take.tracks {
            out.extend(track.bone.to_le_bytes());
            channel(&mut out, &track.translation, |value| value.to_array());
            channel(&mut out, &track.rotation, |value| value.to_array());
            channel(&mut out, &track.scale, |value| value.to_array());
        }
        length(&mut out, take.morphs.len());
        for morph in &take.morphs {
            out.extend(morph.instance.to_le_bytes());
            out.extend(morph.targets.to_le_bytes());
            out.push(kind(morph.interpolation));
            length(&mut out, morph.times.len());
            floats(&mut out, morph.times.iter().copied());
            floats(&mut out, morph.weights.iter().copied());
        }
    }
    let extras = takes.iter().enumerate().filter(|(_, take)| !take.extras.is_empty());
    for (index, take) in extras {
        length(&mut out, index);
        length(&mut out, take.extras.iter().count());
        for text in take.extras.iter().flat_map(|(name, text)| [name, text]) {
            length(&mut out, text.len());
            out.extend(text.as_bytes());
        }
    }
    out
}

/// Reads takes; `None` where these are not the bytes of takes of `bones` bones.
pub(super) fn read(bytes: &[u8], bones: usize) -> Option<Vec<Arc<Take>>> {
    let mut from = TakesReader(bytes);
    let mut takes = (0..from.length()?).map(|_| take(&mut from, bones)).collect::<Option<Vec<Take>>>()?;
    while !from.0.is_empty() {
        let extras = &mut takes.get_mut(from.number()? as usize)?.extras;
        for _ in 0..from.length()? {
            let name = from.text()?;
            extras.set(name, Some(Arc::from(from.text()?)));
        }
    }
    Some(takes.into_iter().map(Arc::new).collect())
}

fn take(from: &mut TakesReader<'_>, bones: usize) -> Option<Take> {
    let name = from.text()?.to_owned();
    let [start, length] = [from.float()?, from.float()?];
    let tracks = (0..from.length()?)
        .map(|_| {
            Some(Track {
                bone: from.number()?,
                translation: from.channel(Vec3::from_array)?,
                rotation: from.channel(Quat::from_array)?,
                scale: from.channel(Vec3::from_array)?,
            })
        })
        .collect::<Option<Vec<_>>>()?;
    let in_order = tracks.iter().enumerate().all(|(place, track)| track.bone as usize == place);
    let morphs = (0..from.length()?).map(|_| from.morph()).collect::<Option<_>>()?;
    let fits = in_order && tracks.len() == bones && start.is_finite() && length.is_finite();
    fits.then_some(Take { name, start, length, tracks, morphs, extras: TakeExtras::default() })
}

fn length(out: &mut Vec<u8>, length: usize) {
    // A record of a journal is never long enough to be truncated here.
    out.extend(u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes());
}

fn floats(out: &mut Vec<u8>, values: impl IntoIterator<Item = f32>) {
    values.into_iter().for_each(|value| out.extend(value.to_le_bytes()));
}

fn channel<T: Copy, const N: usize>(out: &mut Vec<u8>, channel: &Channel<T>, numbers: fn(T) -> [f32; N]) {
    out.push(kind(channel.interpolation));
    length(out, channel.times.len());
    floats(out, channel.times.iter().copied());
    floats(out, channel.values.iter().copied().flat_map(numbers));
}

const KINDS: [Interpolation; 4] =
    [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];

fn kind(interpolation: Interpolation) -> u8 {
    KINDS.iter().position(|kind| *kind == interpolation).unwrap_or(0) as u8
}

struct TakesReader<'a>(&'a [u8]);

impl<'a> TakesReader<'a> {
    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn number(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(*self.bytes(4)?.first_chunk()?))
    }

    /// Reads the length of a list; `None` where fewer bytes follow, because an element has at least one byte.
    fn length(&mut self) -> Option<usize> {
        let length = self.number()? as usize;
        (length <= self.0.len()).then_some(length)
    }

    fn text(&mut self) -> Option<&'a str> {
        let count = self.length()?;
        std::str::from_utf8(self.bytes(count)?).ok()
    }

    fn float(&mut self) -> Option<f32> {
        self.number().map(f32::from_bits)
    }

    fn floats<const N: usize>(
        &mut self,
        count: usize,
    ) -> Option<impl Iterator<Item = [f32; N]> + use<'a, N>> {
        let (chunks, _) = self.bytes(count.checked_mul(4 * N)?)?.as_chunks::<4>();
        let (groups, _) = chunks.as_chunks::<N>();
        Some(groups.iter().map(|group| group.map(f32::from_le_bytes)))
    }

    fn kind(&mut self) -> Option<Interpolation> {
        KINDS.get(usize::from(*self.bytes(1)?.first()?)).copied()
    }

    /// Reads times; `None` where they do not ascend strictly or are not finite.
    fn times(&mut self, count: usize) -> Option<Arc<[f32]>> {
        let times: Arc<[f32]> = self.floats::<1>(count)?.map(|[time]| time).collect();
        let rising =
            times.windows(2).all(|pair| pair[0] < pair[1]) && times.iter().all(|time| time.is_finite());
        rising.then_some(times)
    }

    fn channel<T, const N: usize>(&mut self, value: fn([f32; N]) -> T) -> Option<Channel<T>> {
        let interpolation = self.kind()?;
        let count = self.length()?;
        let times = self.times(count)?;
        let a_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let values = self.floats(count.checked_mul(a_key)?)?.map(value).collect();
        Some(Channel { times, values, interpolation })
    }

    fn morph(&mut self) -> Option<MorphTrack> {
        let (instance, targets, interpolation) = (self.number()?, self.number()?, self.kind()?);
        let count = self.length()?;
        let times = self.times(count)?;
        let a_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let weights = count.checked_mul(targets as usize)?.checked_mul(a_key)?;
        let weights = self.floats::<1>(weights)?.map(|[weight]| weight).collect();
        Some(MorphTrack { instance, targets, times, weights, interpolation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cancel, Source, load_model};

    fn takes() -> (Vec<Arc<Take>>, usize) {
        let loaded = load_model(&Source::BuiltIn, &mut |_| {}, &Cancel::default()).unwrap();
        let animation = &loaded.model.animation;
        (animation.takes.clone(), animation.skeleton.len())
    }

    #[test]
    fn takes_are_read_back_bit_for_bit() {
        let (mut takes, bones) = takes();
        let weights: Arc<[f32]> = Arc::from([0.0, -0.0, 1.0, f32::MIN_POSITIVE / 2.0, 0.5, 0.25]);
        let morph = |interpolation, weights: &Arc<[f32]>| MorphTrack {
            instance: 0,
            targets: 1,
            times: Arc::from([-1.0, 0.5]),
            weights: Arc::clone(weights),
            interpolation,
        };
        let first = Arc::make_mut(&mut takes[0]);
        first.name = "Gähnen 😴".to_owned();
        first.extras.set("layers", Some(Arc::from(r#"{"version": 1}"#)));
        first.extras.set("ä", Some(Arc::from("[]")));
        first.morphs.push(morph(Interpolation::CubicSpline, &weights));
        first.morphs.push(morph(Interpolation::Closest, &Arc::from([1.0, 2.0])));
        let back = read(&write(&takes), bones).unwrap();
        // Distinguishes -0 from 0.
        assert!(format!("{takes:?}") == format!("{back:?}"));
        assert!(read(&write(&[]), bones).unwrap().is_empty());
    }

    #[test]
    fn damaged_takes_are_refused_without_a_panic() {
        let (takes, bones) = takes();
        let bytes = write(&takes[..1]);
        for end in 0..bytes.len().min(2000) {
            assert!(read(&bytes[..end], bones).is_none(), "cut at {end}");
        }
        assert!(read(&bytes, bones + 1).is_none());
        assert!(read(&[0xff; 64], bones).is_none());
        for at in 0..bytes.len().min(2000) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x80;
            // It may fail, but must not panic or allocate too much.
            let _ = read(&damaged, bones);
        }
    }
}
