//! `dragonfly retarget SOURCE TARGET -o OUT`: puts takes of one figure on another.

use super::choice::{load, source};
use super::edit::save;
use super::info::named;
use super::output::{print, print_json, write_file};
use super::run_command::RunCommand;
use super::table::{Side, Table};
use super::{Failure, tell};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::retarget::{
    BindingGuess, FigureOptions, SkeletonBinding, retarget_expressions, retarget_figure,
};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{AddTake, Edit};
use dragonfly_document::{BoneMap, Cancel, Editable};
use serde::Serialize;
use std::path::PathBuf;

/// Put takes of one figure on another: bones are mapped by the parts of the body, feet stay where they touch the ground
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
The map is guessed from the names of bones (Mixamo, Unreal, VRM, Rigify, CMU, KayKit, Quaternius); --save-map writes it to a\n\
file, which can be corrected and given with --map. Without -o, only the map is printed.\n\n\
Examples:\n  dragonfly retarget Walk.glb Hero.glb --save-map map.json\n  \
dragonfly retarget Walk.glb Hero.glb --map map.json --take Walk -o Hero2.glb")]
pub(super) struct RetargetArguments {
    /// The model with the takes, or `demo:` for the built-in dragonfly
    #[arg(value_name = "SOURCE")]
    source: PathBuf,
    /// The model that gets them
    #[arg(value_name = "TARGET")]
    target: PathBuf,
    /// Take of the source, by name or by index from 0; repeatable [default: all]
    #[arg(long, value_name = "TAKE")]
    take: Vec<String>,
    /// File with the map of bones; guessed where absent
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// File to which the map is written
    #[arg(long, value_name = "FILE")]
    save_map: Option<PathBuf>,
    /// Let feet slide
    #[arg(long)]
    no_contacts: bool,
    /// File to write: the target with the new takes
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

impl RunCommand for RetargetArguments {
    fn run(self) -> Result<(), Failure> {
        let from = load(&source(&self.source))?;
        let editable = Editable::open(&source(&self.target), &Cancel::default())?;
        let (source, target) = (&from.model.animation.skeleton, &editable.model.animation.skeleton);
        let guess = BindingGuess::of_models(&from.model, &editable.model);
        let (binding, missing) = self.binding(source, target, &guess)?;
        if let Some(path) = &self.save_map {
            let map = BoneMap::of([&from.title, &editable.title], source, target, &binding);
            write_file(path, map.to_text().as_bytes())?;
        }
        let mut adapter = ModelAdapter::of(&editable.model);
        let mut takes = Vec::new();
        for take in self.chosen(&from.title, &from.model.animation.takes)? {
            let options = FigureOptions { contacts: !self.no_contacts, ..FigureOptions::default() };
            let done = retarget_figure(take, source, target, &binding, &options)
                .map_err(|error| Failure::input(&take.name, error))?;
            let shapes = retarget_expressions(take, &from.model.avatar, &editable.model);
            let name = unused_name(&adapter, &take.name);
            adapter
                .apply(&Edit::AddTake(AddTake::of(name.clone(), &done.take).with_shapes(&shapes)))
                .map_err(|error| Failure::input(&take.name, error))?;
            takes.push(RetargetedTake {
                take: take.name.clone(),
                name,
                keys: done.take.keys(),
                contacts: done.contacts.len(),
                slide_before_mm: done.slide_before,
                slide_after_mm: done.slide_after,
                size: done.ratio,
            });
        }
        let mut written = Vec::new();
        if let Some(output) = &self.output {
            let plan = editable.plan(&adapter).map_err(|error| Failure::input(&editable.title, error))?;
            written = save(&editable, &plan, output)?;
        }
        let report = RetargetReport::of(&guess, source, target, &binding, missing, takes);
        let to_stdout = self.output.as_deref() == Some(std::path::Path::new("-"));
        match (to_stdout, self.json) {
            (true, _) => {}
            (false, true) => print_json(&report)?,
            (false, false) => print(|out| report.write(out))?,
        }
        for file in written {
            tell(format_args!("wrote {} ({} bytes)", file.path, file.bytes));
        }
        Ok(())
    }
}

impl RetargetArguments {
    /// Returns the binding of the map, or the guessed one, and names of the map that no bone has.
    fn binding(
        &self,
        source: &Skeleton,
        target: &Skeleton,
        guess: &BindingGuess,
    ) -> Result<(SkeletonBinding, Vec<String>), Failure> {
        let Some(path) = &self.map else { return Ok((guess.binding.clone(), Vec::new())) };
        let map = BoneMap::read(path).map_err(Failure::Input)?;
        map.binding(source, target).map_err(|error| Failure::input(path.display(), error))
    }

    /// Returns the takes that were named; all where none was.
    fn chosen<'a>(&self, title: &str, takes: &'a [std::sync::Arc<Take>]) -> Result<Vec<&'a Take>, Failure> {
        let found = |wanted: &String| {
            let named = takes.iter().find(|take| take.name == *wanted);
            let numbered = || wanted.parse().ok().and_then(|index: usize| takes.get(index));
            named
                .or_else(numbered)
                .map(|take| &**take)
                .ok_or_else(|| Failure::input(title, format_args!("there is no take {wanted:?}")))
        };
        if self.take.is_empty() {
            return Ok(takes.iter().map(|take| &**take).collect());
        }
        self.take.iter().map(found).collect()
    }
}

/// Returns the name with the first number that makes it a name that no take has.
fn unused_name(adapter: &ModelAdapter, name: &str) -> String {
    let is_used = |name: &str| adapter.slots().iter().any(|slot| slot.original.name == name);
    let base = if name.is_empty() { "Take" } else { name };
    let numbered = |number: usize| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
    (1..=adapter.slots().len() + 1).map(numbered).find(|name| !is_used(name)).unwrap_or_default()
}

/// The mapped bones, and the new takes.
#[derive(Serialize)]
struct RetargetReport {
    conventions: [Option<&'static str>; 2],
    /// Names of bones: source, target.
    bones: Vec<[String; 2]>,
    /// Bones of the target that nothing moves.
    resting: Vec<String>,
    /// Names of the map that no bone has.
    missing: Vec<String>,
    takes: Vec<RetargetedTake>,
}

#[derive(Serialize)]
struct RetargetedTake {
    take: String,
    name: String,
    keys: usize,
    contacts: usize,
    slide_before_mm: f32,
    slide_after_mm: f32,
    /// The target's size over that of the source.
    size: f32,
}

impl RetargetReport {
    fn of(
        guess: &BindingGuess,
        source: &Skeleton,
        target: &Skeleton,
        binding: &SkeletonBinding,
        missing: Vec<String>,
        takes: Vec<RetargetedTake>,
    ) -> Self {
        let name = |skeleton: &Skeleton, bone: u32| skeleton.bones[bone as usize].name.clone();
        let pair =
            |(to, from): (usize, &Option<u32>)| Some([name(source, (*from)?), name(target, to as u32)]);
        Self {
            conventions: [guess.source.convention, guess.target.convention],
            bones: binding.source_of.iter().enumerate().filter_map(pair).collect(),
            resting: binding.unbound_target.iter().map(|&bone| name(target, bone)).collect(),
            missing,
            takes,
        }
    }

    fn write(&self, out: &mut dyn std::io::Write) -> std::io::Result<()> {
        let [source, target] = self.conventions.map(|name| name.unwrap_or("no known convention"));
        writeln!(out, "names: {source} to {target}")?;
        let mut table = Table::new(&[("source", Side::Left), ("target", Side::Left)]);
        for [from, to] in &self.bones {
            table.row([named(from), named(to)]);
        }
        table.write(out)?;
        if !self.resting.is_empty() {
            writeln!(out, "at rest: {}", self.resting.join(", "))?;
        }
        for name in &self.missing {
            writeln!(out, "not found: {}", named(name))?;
        }
        for take in &self.takes {
            writeln!(
                out,
                "take {} as {}: {} keys, size {:.3}, {} contacts, largest slide {:.1} mm before and {:.1} mm after",
                named(&take.take),
                named(&take.name),
                take.keys,
                take.size,
                take.contacts,
                take.slide_before_mm,
                take.slide_after_mm
            )?;
        }
        Ok(())
    }
}
