//! `dragonfly takes list FILE`.

use super::super::Failure;
use super::super::choice::{File, plain};
use super::super::output::{print, print_json};
use super::super::table::{Side, Table};
use dragonfly_anim::frames::frame_rate;
use serde::Serialize;

/// List the takes of a model
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ListTakes {
    #[command(flatten)]
    file: File,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct ListedTake {
    index: usize,
    name: String,
    start: f32,
    end: f32,
    /// Frames per second on which the keys are.
    rate: f32,
    tracks: usize,
    keys: usize,
}

impl ListTakes {
    pub(super) fn run(self) -> Result<(), Failure> {
        let loaded = self.file.load()?;
        let takes: Vec<ListedTake> = loaded
            .model
            .animation
            .takes
            .iter()
            .enumerate()
            .map(|(index, take)| ListedTake {
                index,
                name: take.name.clone(),
                start: take.start,
                end: take.end(),
                rate: frame_rate(take),
                tracks: take.moving_tracks(),
                keys: take.keys(),
            })
            .collect();
        if self.json {
            return print_json(&takes);
        }
        let mut table = Table::new(&[
            ("", Side::Right),
            ("take", Side::Left),
            ("start", Side::Right),
            ("end", Side::Right),
            ("fps", Side::Right),
            ("tracks", Side::Right),
            ("keys", Side::Right),
        ]);
        for take in &takes {
            table.row([
                take.index.to_string(),
                plain(&take.name),
                format!("{:.3} s", take.start),
                format!("{:.3} s", take.end),
                take.rate.to_string(),
                take.tracks.to_string(),
                take.keys.to_string(),
            ]);
        }
        print(|out| table.write(out))
    }
}
