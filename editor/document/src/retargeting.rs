//! The jobs for takes of another model: the model is read in a job, and so is each take computed.

use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use super::retarget_order::{MapFile, RetargetNews, RetargetOrder, computed, write_map};
use super::{BoneMap, Change, Loader, Source};
use crate::text::sentence;
use dragonfly_runtime::Job;
use std::sync::Arc;
use std::time::Instant;

impl Document {
    /// Reads the model whose takes are wanted.
    pub(super) fn read_source(&mut self, source: Source, load: Loader) {
        self.retarget_job(
            "retarget source",
            move |cancel| {
                let loaded = load(&source, &mut |_| {}, cancel);
                RetargetNews::Source(match loaded {
                    Ok(opened) => Ok(Arc::new(opened.loaded)),
                    Err(error) => Err(error.to_string()),
                })
            },
            |panic| RetargetNews::Source(Err(format!("the importer failed: {panic}"))),
        );
    }

    /// Computes a take for the open model and adds it.
    pub(super) fn retarget(&mut self, order: RetargetOrder) {
        let (Some(source), Some(open)) = (self.retargeting.source.clone(), &self.open) else {
            return self.reply(DocumentReply::Refused("No source is open".to_owned()));
        };
        let (adapter, target) = (open.edited.adapter().clone(), Arc::clone(&open.loaded.model));
        self.retarget_job(
            "retarget",
            move |_| RetargetNews::Take(computed(&source, &adapter, &target, &order)),
            |panic| RetargetNews::Take(Err(format!("the take could not be computed: {panic}"))),
        );
    }

    /// Reads or writes a bone map.
    pub(super) fn map_file(&mut self, file: MapFile) {
        self.retarget_job(
            "bone map",
            move |_| match file {
                MapFile::Read(path) => RetargetNews::Map(BoneMap::read(&path)),
                MapFile::Write(path, map) => RetargetNews::Written(write_map(&path, &map).map(|()| path)),
            },
            |panic| RetargetNews::Map(Err(panic.to_owned())),
        );
    }

    fn retarget_job(
        &mut self,
        name: &'static str,
        work: impl FnOnce(&super::Cancel) -> RetargetNews + Send + 'static,
        failed: impl FnOnce(&str) -> RetargetNews + Send + 'static,
    ) {
        let begun = Job::start(
            &self.own,
            name,
            move |job| JobNews::Retarget(work(job.cancel_flag())),
            move |panic| JobNews::Retarget(failed(panic)),
        );
        match begun {
            Ok(job) => self.retargeting.job = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Handles the result of a job.
    pub(super) fn retarget_news(&mut self, news: RetargetNews, now: Instant) {
        match news {
            RetargetNews::Source(Ok(source)) => {
                self.retargeting.source = Some(Arc::clone(&source));
                self.reply(DocumentReply::SourceRead(source));
            }
            RetargetNews::Take(Ok((add, text))) => {
                self.change(Change::Edit(*add, None), None, now);
                // The view goes first: the status line shows the last message.
                self.publish();
                self.reply(DocumentReply::Notice(text));
            }
            RetargetNews::Map(Ok(map)) => self.reply(DocumentReply::MapRead(map)),
            RetargetNews::Written(Ok(path)) => {
                self.reply(DocumentReply::Notice(format!("Wrote {}", path.display())));
            }
            RetargetNews::Source(Err(reason))
            | RetargetNews::Take(Err(reason))
            | RetargetNews::Map(Err(reason))
            | RetargetNews::Written(Err(reason)) => self.reply(DocumentReply::Refused(sentence(&reason))),
        }
    }
}
