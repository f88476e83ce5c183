//! The jobs for the pose library: one order after the other, each in a job.

use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use super::pose_library::{PoseFolder, PoseOrder};
use crate::text::sentence;
use dragonfly_runtime::Job;

impl Document {
    /// Carries out an order after those before it.
    pub(super) fn pose_order(&mut self, order: PoseOrder) {
        self.pose_files.waiting.push_back(order);
        if self.pose_files.job.is_none() {
            self.next_pose_order();
        }
    }

    fn next_pose_order(&mut self) {
        let Some(order) = self.pose_files.waiting.pop_front() else { return };
        let begun = Job::start(
            &self.own,
            "pose library",
            move |_| JobNews::Poses(order.run()),
            |panic| JobNews::Poses(Err(panic.to_owned())),
        );
        match begun {
            Ok(job) => self.pose_files.job = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Handles the result of an order.
    pub(super) fn poses_news(&mut self, news: Result<PoseFolder, String>) {
        self.pose_files.job = None;
        match news {
            Ok(folder) => self.reply(DocumentReply::Poses(folder)),
            Err(reason) => self.reply(DocumentReply::Warning(sentence(&reason))),
        }
        self.next_pose_order();
    }
}
