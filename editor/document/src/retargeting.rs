//! Takes of another model for the open one: the model is read in a job, and so is each take computed.

use super::bone_map::BoneMap;
use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use super::{Change, LoadedModel, Loader, Source};
use crate::adapter::ModelAdapter;
use crate::edit::{AddTake, Edit};
use crate::text::sentence;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::retarget::{FigureOptions, SkeletonBinding, retarget_figure};
use dragonfly_runtime::Job;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// The largest bone map that is read, bytes.
const MAP_BYTES: u64 = 16 << 20;

/// A take of the source for the open model.
#[derive(Clone, Debug, PartialEq)]
pub struct RetargetOrder {
    /// Index of the take in the source.
    pub take: usize,
    /// Bones of the source and of the open model.
    pub pairs: Vec<(BoneIndex, BoneIndex)>,
    /// Options for the figure.
    pub options: FigureOptions,
}

/// An action with a file of a bone map.
#[derive(Clone, Debug, PartialEq)]
pub enum MapFile {
    /// Reads it.
    Read(PathBuf),
    /// Writes it; a file of the name is replaced.
    Write(PathBuf, BoneMap),
}

/// The source of takes, and the jobs for it.
#[derive(Default)]
pub(super) struct Retargeting {
    source: Option<Arc<LoadedModel>>,
    /// The last job; dropping it cancels it.
    job: Option<Job>,
}

/// The result of a job.
#[derive(Debug)]
pub(super) enum RetargetNews {
    /// The source was read.
    Source(Result<Arc<LoadedModel>, String>),
    /// A take was computed, with a sentence about it.
    Take(Result<(Box<AddTake>, String), String>),
    /// A map was read.
    Map(Result<BoneMap, String>),
    /// A map was written.
    Written(Result<PathBuf, String>),
}

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
        let adapter = open.edited.adapter().clone();
        self.retarget_job(
            "retarget",
            move |_| RetargetNews::Take(computed(&source, &adapter, &order)),
            |panic| RetargetNews::Take(Err(format!("the take could not be computed: {panic}"))),
        );
    }

    /// Reads or writes a bone map.
    pub(super) fn map_file(&mut self, file: MapFile) {
        self.retarget_job(
            "bone map",
            move |_| match file {
                MapFile::Read(path) => RetargetNews::Map(read_map(&path)),
                MapFile::Write(path, map) => {
                    let written = dragonfly_store::replace(&path, map.to_text().as_bytes());
                    RetargetNews::Written(match written {
                        Ok(_) => Ok(path),
                        Err(error) => Err(format!("{}: {error}", path.display())),
                    })
                }
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
                self.change(Change::Edit(Edit::AddTake(*add), None), None, now);
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

fn read_map(path: &std::path::Path) -> Result<BoneMap, String> {
    let told = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = super::read_file(path, MAP_BYTES).map_err(|error| told(&error))?;
    let text = String::from_utf8(bytes).map_err(|error| told(&error))?;
    BoneMap::parse(&text).map_err(|error| told(&error))
}

/// Returns the edit that adds the take, and a sentence about it.
fn computed(
    source: &LoadedModel,
    adapter: &ModelAdapter,
    order: &RetargetOrder,
) -> Result<(Box<AddTake>, String), String> {
    let animation = &source.model.animation;
    let take = animation.takes.get(order.take).ok_or("the source has no such take")?;
    let (from, to) = (&*animation.skeleton, &**adapter.skeleton());
    let binding = SkeletonBinding::from_map(from, to, &order.pairs).map_err(|error| error.to_string())?;
    let done =
        retarget_figure(take, from, to, &binding, &order.options).map_err(|error| error.to_string())?;
    let is_used = |name: &str| adapter.slots().iter().any(|slot| slot.original.name == name);
    let base = if take.name.trim().is_empty() { "Take" } else { &take.name };
    let numbered = |number: usize| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
    let name = (1..=adapter.slots().len() + 1).map(numbered).find(|name| !is_used(name)).unwrap_or_default();
    let feet = match done.contacts.len() {
        0 => String::new(),
        count => format!(", {count} contacts of feet within {:.1} mm", done.slide_after),
    };
    let text = format!("Added {name}: {} bones move{feet}", binding.bound());
    Ok((Box::new(AddTake::of(name, &done.take)), text))
}
