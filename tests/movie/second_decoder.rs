//! A second decoder of H.264, by Cisco, which shares no code with ffmpeg.

use crate::frames::{disc, luma, psnr, rate, write_disc};
use crate::tracks::tracks;
use dragonfly_kit::folder::Folder;
use dragonfly_movie::{GROUP, MovieSettings};
use openh264::decoder::{DecodedYUV, Decoder};
use openh264::formats::YUVSource;
use shiguredo_mp4::boxes::SampleEntry;
use std::path::Path;

const START_CODE: [u8; 4] = [0, 0, 0, 1];

/// A decoded picture: its size and its luma, row by row.
type DecodedLuma = ([usize; 2], Vec<u8>);

fn decoded(picture: &DecodedYUV<'_>) -> DecodedLuma {
    let (width, height) = picture.dimensions();
    let rows = picture.y().chunks(picture.strides().0).take(height);
    ([width, height], rows.flat_map(|row| &row[..width]).copied().collect())
}

/// Returns all pictures of an MP4, in the order in which the decoder returns them.
fn pictures(path: &Path) -> Vec<DecodedLuma> {
    let track = tracks(path).swap_remove(0);
    let SampleEntry::Avc1(entry) = &track.entry else { panic!("{:?} is no H.264", track.entry) };
    let mut decoder = Decoder::new().unwrap();
    let mut found = Vec::new();
    let sets = entry.avcc_box.sps_list.iter().chain(&entry.avcc_box.pps_list);
    let mut packet: Vec<u8> = sets.flat_map(|set| [&START_CODE[..], set].concat()).collect();
    for (sample, _) in &track.samples {
        let mut rest = sample.as_slice();
        while let Some((length, after)) = rest.split_first_chunk::<4>() {
            let (unit, next) = after.split_at(u32::from_be_bytes(*length) as usize);
            packet.extend(START_CODE);
            packet.extend(unit);
            rest = next;
        }
        found.extend(decoder.decode(&packet).unwrap().as_ref().map(decoded));
        packet.clear();
    }
    found.extend(decoder.flush_remaining().unwrap().iter().map(decoded));
    found
}

#[test]
fn another_decoder_finds_every_frame_in_its_size_and_quality() {
    let folder = Folder::new("second-decoder");
    let path = folder.join("it.mp4");
    // The second movie has blocks outside of its pictures.
    for (size, count) in [([320, 180], 2 * GROUP + 4), ([322, 182], 9)] {
        write_disc("mp4", &MovieSettings::new(size, rate("24")), &path, count, false);
        let found = pictures(&path);
        assert_eq!(found.len() as u64, count, "{size:?}");
        for (number, (found_size, found)) in found.iter().enumerate() {
            assert_eq!(found_size.map(|side| side as u32), size);
            let quality = psnr(found, &luma(&disc(size, number as u64, false)));
            assert!(quality >= 40.0, "{size:?}, frame {number}: {quality} dB");
        }
    }
}
