//! Looks where files are that a scene is to get, and copies those outside of its folder into it, in jobs.

use super::interface::Interface;
use crate::panels::dropped_files::WantedFiles;
use crate::panels::status::MessageSeverity;
use dragonfly_runtime::{Address, Job, JobContext};

/// The files as they are known now, with the number of files that were copied; or the reason why they are not used.
pub type SceneFilesAnswer = Result<(Box<WantedFiles>, usize), String>;

/// Jobs about files of a scene that have not ended. Dropping them cancels them.
#[derive(Default)]
pub(super) struct FileJobs(Vec<Job>);

impl FileJobs {
    /// Keeps a job until it has ended.
    pub(super) fn keep(&mut self, job: std::io::Result<Job>) -> std::io::Result<()> {
        self.0.retain(|job| !job.is_finished());
        self.0.push(job?);
        Ok(())
    }
}

/// Starts to look where the files are. Dropping the job cancels it.
pub fn look(wanted: Box<WantedFiles>, to: &Address<SceneFilesAnswer>) -> std::io::Result<Job> {
    let work = move |job: &JobContext<SceneFilesAnswer>| {
        let mut wanted = wanted;
        let others = std::mem::take(&mut wanted.others);
        wanted.files.look(others, job.cancel_flag()).map(|()| (wanted, 0))
    };
    start("files of a scene", work, to)
}

/// Starts to copy the files that are outside of the folder of the scene. Dropping the job cancels it: it stops between two files.
pub fn copy(wanted: Box<WantedFiles>, to: &Address<SceneFilesAnswer>) -> std::io::Result<Job> {
    let work = move |job: &JobContext<SceneFilesAnswer>| {
        let mut wanted = wanted;
        wanted.files.copy(job.cancel_flag()).map(|copied| (wanted, copied))
    };
    start("copies for a scene", work, to)
}

fn start(
    name: &'static str,
    work: impl FnOnce(&JobContext<SceneFilesAnswer>) -> SceneFilesAnswer + Send + 'static,
    to: &Address<SceneFilesAnswer>,
) -> std::io::Result<Job> {
    let failed = |reason: &str| -> SceneFilesAnswer { Err(format!("The scene was not changed: {reason}")) };
    let work = move |job: &JobContext<SceneFilesAnswer>| work(job).or_else(|reason| failed(&reason));
    Job::start(to, name, work, failed)
}

/// Uses the files in the scene, or asks about those outside.
pub(super) fn answered(interface: &mut Interface, answer: SceneFilesAnswer) {
    match answer {
        Ok((wanted, copied)) => {
            let effect = interface.state.files_answered(wanted, copied);
            interface.effects.extend(effect);
        }
        Err(reason) => interface.state.say(MessageSeverity::Error, reason),
    }
}
