//! FLAC: samples of 16 bits without loss, each block in the best of five predictions and with Rice codes. Integers only, so that the same sound gives the
//! same bytes on every processor.

use super::bits::SoundBits;
use super::head::{ReadSamples, SoundHead, SoundPacket, SoundPackets};
use crc::{CRC_8_SMBUS, CRC_16_UMTS, Crc};
use shiguredo_mp4::boxes::{AudioSampleEntryFields, DflaBox, FlacBox, FlacMetadataBlock, SampleEntry};
use shiguredo_mp4::{FixedPointNumber, Uint};
use std::num::{NonZeroU16, NonZeroU32};

/// Number of samples of a block in each channel.
const BLOCK: usize = 4096;
/// Bits of a sample.
const DEPTH: u32 = 16;
/// Highest order of a prediction.
const ORDERS: usize = 4;
/// Largest parameter of a Rice code.
const LARGEST_RICE: u32 = 14;
/// Largest exponent of the number of partitions.
const PARTITIONS: u32 = 6;
/// Number of times in a row that a source may give no sample before its end.
const MOST_IDLE: u32 = 1_000;
/// Most channels, and most samples per second, that the format has.
const MOST_CHANNELS: usize = 8;
const HIGHEST_RATE: u32 = 655_350;

pub(super) const HEADER_CRC: Crc<u8> = Crc::<u8>::new(&CRC_8_SMBUS);
pub(super) const FRAME_CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_UMTS);

/// Samples that are encoded block by block.
pub(super) struct FlacEncoder {
    rate: NonZeroU32,
    channels: usize,
    read: ReadSamples,
    /// Samples that were read, of all channels one after the other, and how many of them are encoded.
    waiting: Vec<f32>,
    encoded: usize,
    is_over: bool,
    block: u32,
}

impl FlacEncoder {
    pub(super) fn new(rate: u32, channels: usize, read: ReadSamples) -> Result<Self, String> {
        let rate = NonZeroU32::new(rate)
            .filter(|rate| rate.get() <= HIGHEST_RATE && (1..=MOST_CHANNELS).contains(&channels));
        let rate = rate.ok_or("from 1 to 8 channels with at most 655,350 samples per second are possible")?;
        Ok(Self { rate, channels, read, waiting: Vec::new(), encoded: 0, is_over: false, block: 0 })
    }
}

impl SoundPackets for FlacEncoder {
    fn head(&self) -> SoundHead {
        let mut info = SoundBits::default();
        // Smallest and largest block, sizes of frames that are not known.
        info.put(BLOCK as u32, 16);
        info.put(BLOCK as u32, 16);
        info.put(0, 24);
        info.put(0, 24);
        info.put(self.rate.get(), 20);
        info.put(self.channels as u32 - 1, 3);
        info.put(DEPTH - 1, 5);
        // The number of samples and their checksum are not known.
        (0..36 / 4 + 128 / 4).for_each(|_| info.put(0, 4));
        SoundHead {
            entry: flac_entry(info.aligned().clone(), self.rate, self.channels as u16, DEPTH as u16),
            timescale: self.rate,
            longest: BLOCK as u32,
            skip: 0,
            played: None,
            roll: 0,
        }
    }

    fn next(&mut self, most: u32) -> Result<Option<SoundPacket>, String> {
        if self.waiting.len() - self.encoded < BLOCK * self.channels {
            // Moved once for all the blocks that were there.
            self.waiting.drain(..std::mem::take(&mut self.encoded));
        }
        let mut idle = 0;
        while self.waiting.len() - self.encoded < BLOCK * self.channels && !self.is_over {
            let before = self.waiting.len();
            self.is_over = !(self.read)(&mut self.waiting)?;
            idle = if self.waiting.len() > before { 0 } else { idle + 1 };
            if idle == MOST_IDLE {
                return Err("it gives no more samples, and does not end".to_owned());
            }
        }
        let waiting = &self.waiting[self.encoded..];
        let length = (waiting.len() / self.channels).min(BLOCK).min(most as usize);
        if length == 0 {
            return Ok(None);
        }
        let taken = &waiting[..length * self.channels];
        self.encoded += taken.len();
        let channel = |channel: usize| {
            let samples = taken.iter().skip(channel).step_by(self.channels);
            samples.map(|sample| level(*sample)).collect()
        };
        let channels: Vec<Vec<i32>> = (0..self.channels).map(channel).collect();
        let bytes = encode(&channels, self.block);
        self.block += 1;
        Ok(Some(SoundPacket { bytes, duration: length as u32 }))
    }
}

/// Returns the description of FLAC in an MP4, with the parameters of the stream as the format writes them.
pub(super) fn flac_entry(parameters: Vec<u8>, rate: NonZeroU32, channels: u16, depth: u16) -> SampleEntry {
    let block = FlacMetadataBlock {
        last_metadata_block_flag: Uint::new(1),
        block_type: FlacMetadataBlock::BLOCK_TYPE_STREAMINFO,
        block_data: parameters,
    };
    SampleEntry::Flac(FlacBox {
        audio: AudioSampleEntryFields {
            data_reference_index: NonZeroU16::MIN,
            channelcount: channels,
            samplesize: depth,
            // A higher rate is only among the parameters.
            samplerate: FixedPointNumber::new(u16::try_from(rate.get()).unwrap_or(0), 0),
        },
        dfla_box: DflaBox { metadata_blocks: vec![block] },
        unknown_boxes: Vec::new(),
    })
}

/// Returns a sample as an integer; what is no number is silence.
fn level(sample: f32) -> i32 {
    let most = f32::from(i16::MAX);
    if sample.is_finite() { (sample.clamp(-1.0, 1.0) * most).round() as i32 } else { 0 }
}

/// Returns a frame with a block of samples.
fn encode(channels: &[Vec<i32>], number: u32) -> Vec<u8> {
    let mut bits = SoundBits::default();
    let length = channels.first().map_or(0, Vec::len);
    let plain: Vec<Subframe> = channels.iter().map(|samples| Subframe::best(samples, DEPTH)).collect();
    let mut assignment = channels.len() as u32 - 1;
    let mut chosen = plain;
    if let [left, right] = channels {
        // The difference of two channels that are alike is small.
        let side: Vec<i32> = left.iter().zip(right).map(|(left, right)| left - right).collect();
        let middle: Vec<i32> = left.iter().zip(right).map(|(left, right)| (left + right) >> 1).collect();
        let both = [Subframe::best(&middle, DEPTH), Subframe::best(&side, DEPTH + 1)];
        let cost = |frames: &[Subframe]| frames.iter().map(|frame| frame.cost).sum::<u64>();
        if cost(&both) < cost(&chosen) {
            assignment = 10;
            chosen = both.into();
        }
    }
    // A frame of a stream with blocks of one size.
    bits.put(0xFFF8, 16);
    // The size of the block follows in 16 bits; the rate is that of the stream.
    bits.put(0b0111_0000, 8);
    bits.put(assignment, 4);
    // 16 bits.
    bits.put(0b1000, 4);
    coded_number(&mut bits, number);
    bits.put(length as u32 - 1, 16);
    let header = HEADER_CRC.checksum(bits.aligned());
    bits.put(u32::from(header), 8);
    chosen.iter().for_each(|subframe| subframe.write(&mut bits));
    let bytes = bits.aligned();
    let checksum = FRAME_CRC.checksum(bytes);
    bytes.extend(checksum.to_be_bytes());
    std::mem::take(bytes)
}

/// Writes a number in the form of UTF-8, which the format extends to 31 bits.
fn coded_number(bits: &mut SoundBits, number: u32) {
    if number < 0x80 {
        return bits.put(number, 8);
    }
    let significant = 32 - number.leading_zeros();
    // Each byte after the first one has six bits, and the first one those that its length leaves.
    let after = (1..=5).find(|after| significant <= 6 * after + 6 - after).unwrap_or(5);
    bits.put(0xFF << (7 - after) & 0xFF | number >> (6 * after), 8);
    (0..after).rev().for_each(|at| bits.put(0x80 | number >> (6 * at) & 0x3F, 8));
}

/// One channel of a block, with the way to encode it and its number of bits.
struct Subframe {
    samples: Vec<i32>,
    depth: u32,
    kind: Prediction,
    cost: u64,
}

enum Prediction {
    /// All samples are equal.
    Constant,
    /// The samples as they are.
    Verbatim,
    /// The rest after a prediction of an order, and the Rice parameter of each partition of it.
    Fixed { order: usize, rest: Vec<i32>, rice: Vec<u32> },
}

impl Subframe {
    fn best(samples: &[i32], depth: u32) -> Self {
        let bits = u64::from(depth) * samples.len() as u64;
        let mut best = Self { samples: samples.to_vec(), depth, kind: Prediction::Verbatim, cost: bits };
        if samples.windows(2).all(|pair| pair[0] == pair[1]) {
            (best.kind, best.cost) = (Prediction::Constant, u64::from(depth));
            return best;
        }
        let mut rest = samples.to_vec();
        for order in 0..=ORDERS.min(samples.len().saturating_sub(1)) {
            if order > 0 {
                // The prediction of an order is the one before of the differences.
                rest = rest.windows(2).map(|pair| pair[1] - pair[0]).collect();
            }
            let (rice, cost) = partitions(&rest, order, samples.len());
            let cost = cost + u64::from(depth) * order as u64;
            if cost < best.cost {
                (best.kind, best.cost) = (Prediction::Fixed { order, rest: rest.clone(), rice }, cost);
            }
        }
        best
    }

    fn write(&self, bits: &mut SoundBits) {
        match &self.kind {
            Prediction::Constant => {
                bits.put(0, 8);
                bits.put(self.samples.first().copied().unwrap_or(0) as u32, self.depth);
            }
            Prediction::Verbatim => {
                bits.put(1 << 1, 8);
                self.samples.iter().for_each(|sample| bits.put(*sample as u32, self.depth));
            }
            Prediction::Fixed { order, rest, rice } => {
                bits.put((8 | *order as u32) << 1, 8);
                self.samples[..*order].iter().for_each(|sample| bits.put(*sample as u32, self.depth));
                bits.put(0, 2);
                bits.put(rice.len().ilog2(), 4);
                let mut values = rest.iter();
                for (at, parameter) in rice.iter().enumerate() {
                    bits.put(*parameter, 4);
                    let length = self.samples.len() / rice.len() - if at == 0 { *order } else { 0 };
                    for value in values.by_ref().take(length) {
                        let folded = folded(*value);
                        bits.unary(folded >> parameter);
                        bits.put(folded, *parameter);
                    }
                }
            }
        }
    }
}

/// Returns a number without a sign: 0, -1, 1, -2, …
fn folded(value: i32) -> u32 {
    (value << 1 ^ value >> 31) as u32
}

/// Returns the best Rice parameters of a rest, and their cost in bits.
fn partitions(rest: &[i32], order: usize, length: usize) -> (Vec<u32>, u64) {
    let mut best = (Vec::new(), u64::MAX);
    for exponent in 0..=PARTITIONS {
        let count = 1 << exponent;
        if !length.is_multiple_of(count) || length / count <= order {
            break;
        }
        let mut values = rest;
        let (mut rice, mut total) = (Vec::with_capacity(count), 6);
        for at in 0..count {
            let (now, after) = values.split_at(length / count - if at == 0 { order } else { 0 });
            values = after;
            let (parameter, cost) = parameter(now);
            rice.push(parameter);
            total += 4 + cost;
        }
        if total < best.1 {
            best = (rice, total);
        }
    }
    best
}

/// Returns the best Rice parameter for values, and the cost of the values in bits.
fn parameter(values: &[i32]) -> (u32, u64) {
    let sum: u64 = values.iter().map(|value| u64::from(folded(*value))).sum();
    let mean = sum / values.len().max(1) as u64;
    let near = mean.checked_ilog2().unwrap_or(0).min(LARGEST_RICE);
    let cost = |parameter: u32| {
        let coded = |value: &i32| u64::from(folded(*value) >> parameter) + 1 + u64::from(parameter);
        values.iter().map(coded).sum::<u64>()
    };
    let tried = near.saturating_sub(1)..=(near + 1).min(LARGEST_RICE);
    let costs = tried.map(|parameter| (parameter, cost(parameter)));
    costs.min_by_key(|(_, cost)| *cost).unwrap_or((0, u64::MAX))
}
