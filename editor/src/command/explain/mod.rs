//! `dragonfly explain FILE --time S --bone NAME`: prints every value on the way from keys to a bone or a vertex.

mod json;

use super::Failure;
use super::choice::{File, TakeChoice, clamp_time, plain};
use super::output::{print, print_json};
use super::run_command::RunCommand;
use super::time_argument::TimeArgument;
use dragonfly_anim::data::{BoneIndex, ModelData};
use dragonfly_anim::explain::{ExplainTarget, explain};
use json::ExplainedDocument;

/// Print every value on the way from keys to a bone or a vertex, with the formula of each step
#[derive(Clone, Debug, clap::Args)]
#[command(
    group = clap::ArgGroup::new("what").required(true),
    after_help = "\
Prints the keys and how they are interpolated, the pose relative to the parent, each bone up to the root, and the\n\
final pose; for a vertex, the contribution of each bone. Matrices are for column vectors; --json has them column-major, and\n\
refers to bones, their parents, takes and nodes by the same indices as `dragonfly info --json`.\n\n\
Examples:\n  dragonfly explain Fox.glb --take Run --time 0.35 --bone b_Head_05\n  \
dragonfly explain demo: --time 0.4 --vertex 12"
)]
pub(super) struct ExplainArguments {
    #[command(flatten)]
    file: File,
    #[command(flatten)]
    take: TakeChoice,
    /// Time in seconds, clamped to the take
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    time: TimeArgument,
    /// Bone, by name or by index from 0; a name has priority over an index
    #[arg(long, value_name = "BONE", group = "what", allow_hyphen_values = true)]
    bone: Option<String>,
    /// Vertex of the primitive, by index from 0
    #[arg(long, value_name = "N", group = "what")]
    vertex: Option<u32>,
    /// Mesh instance, by index from 0
    #[arg(long, value_name = "I", default_value_t = 0, conflicts_with = "bone")]
    instance: u32,
    /// Primitive of the mesh, by index from 0
    #[arg(long, value_name = "P", default_value_t = 0, conflicts_with = "bone")]
    primitive: u32,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

impl RunCommand for ExplainArguments {
    fn run(self) -> Result<(), Failure> {
        let loaded = self.file.load()?;
        let take = self.take.index(&loaded.title, &loaded.model)?;
        let what = self.what(&loaded.title, &loaded.model)?;
        let time = clamp_time(&loaded.model, take, self.time.of_take()?);
        let explanation =
            explain(&loaded.model, take, time, what).map_err(|error| Failure::input(&loaded.title, error))?;
        let document = ExplainedDocument::of(&loaded, &explanation);
        // JSON cannot represent infinity or NaN.
        if !document.is_finite() {
            let reason = format_args!("the pose at {time} s exceeds the range of single-precision numbers");
            return Err(Failure::input(&loaded.title, reason));
        }
        if self.json {
            print_json(&document)
        } else {
            print(|out| write!(out, "{}\n{explanation}", plain(&loaded.title)))
        }
    }
}

impl ExplainArguments {
    fn what(&self, title: &str, model: &ModelData) -> Result<ExplainTarget, Failure> {
        let Some(wanted) = &self.bone else {
            let vertex = self.vertex.unwrap_or_default();
            return Ok(ExplainTarget::Vertex { instance: self.instance, primitive: self.primitive, vertex });
        };
        let skeleton = &model.animation.skeleton;
        let by_number = || wanted.parse().ok().filter(|&bone: &BoneIndex| (bone as usize) < skeleton.len());
        skeleton.find(wanted).or_else(by_number).map(ExplainTarget::Bone).ok_or_else(|| {
            let reason = format!(
                "--bone: no bone is called \"{}\"; there are {} (`dragonfly info` lists them)",
                plain(wanted),
                skeleton.len()
            );
            Failure::input(title, reason)
        })
    }
}
