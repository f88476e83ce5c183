//! `dragonfly movie FILE -o out.mp4`: renders a scene or a take to a movie, without a window; in parts, on farms, and joined.

mod arguments;
mod content;
mod failure;
mod ffmpeg;
mod ffmpeg_sound;
mod frames_argument;
mod interrupt;
mod job;
mod join;
mod output_choice;
mod printer;
mod rate;
mod run;
mod shot;
mod words;

pub(super) use arguments::MovieArguments;

use super::run_command::RunCommand;
use super::{Failure, quiet};

impl RunCommand for MovieArguments {
    fn run(self) -> Result<(), Failure> {
        quiet::about_wayland();
        if !self.join.is_empty() {
            return join::join(&self);
        }
        match self.job {
            Some(engine) => job::write(&self, engine),
            None => run::run(&self),
        }
    }
}
