//! `dragonfly diff A B`: compares the takes of two files.

use super::Failure;
use super::choice::{finite, load, plain, source};
use super::diff_picture::{PicturedTake, draw};
use super::info::named;
use super::output::{self, print, print_json};
use super::run_command::RunCommand;
use super::table::{Side, Table, count};
use super::tell;
use dragonfly_anim::compare::{
    BoneDifference, Peak, TakeDifference, compare_at, compare_takes, even_times, pair_bones,
};
use dragonfly_anim::data::{BoneIndex, ModelData, Skeleton};
use dragonfly_anim::model_unit::ModelUnit;
use dragonfly_document::LoadedModel;
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bones listed for a take in the text; the JSON has all of them.
const BONES_SHOWN: usize = 5;
/// Smaller angles count as equal, degrees.
const ANGLE_TOLERANCE: f32 = 0.01;
/// Smaller differences of a morph weight count as equal.
const WEIGHT_TOLERANCE: f32 = 1e-4;
/// Number of times in the strip of the picture.
const COLUMNS: usize = 401;

/// Compare the takes of two files and list the bones that differ, in mm and degrees
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Takes and bones are paired by name. Distances are between joints in scene space, in a unit guessed from the size of\n\
the first figure (more than 20 m are taken for centimeters); angles are between rotations in scene space. Exit code 1: a take or bone has no counterpart, or a difference is above the tolerance.\n\n\
Examples:\n  dragonfly diff Fox.glb Fox2.glb\n  dragonfly diff Fox.glb Fox2.glb --tolerance 0.5 --json\n  dragonfly diff Fox.glb Fox2.glb --picture diff.png")]
pub(super) struct DiffArguments {
    /// A model, or `demo:` for the built-in dragonfly
    #[arg(value_name = "A")]
    first: PathBuf,
    /// The model to compare it with
    #[arg(value_name = "B")]
    second: PathBuf,
    /// Largest distance that counts as equal, millimeters
    #[arg(long, value_name = "MM", default_value = "0.01", value_parser = finite)]
    tolerance: f32,
    /// Largest angle that counts as equal, degrees
    #[arg(long, value_name = "DEG", default_value_t = ANGLE_TOLERANCE, value_parser = finite)]
    angle: f32,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
    /// PNG file to write where something moves: both models side by side at the time of their largest difference, and the difference over time
    /// below; `-` is standard output
    #[arg(long, value_name = "out.png")]
    picture: Option<PathBuf>,
}

impl RunCommand for DiffArguments {
    fn run(self) -> Result<(), Failure> {
        let first = load(&source(&self.first))?;
        let second = load(&source(&self.second))?;
        let titles = [first.title.clone(), second.title.clone()];
        let difference = FileDifference::of(titles, &first.model, &second.model, self.tolerance, self.angle);
        if let Some(path) = &self.picture {
            write_picture(path, [first, second], &difference)?;
        }
        if self.picture.as_deref() == Some(Path::new("-")) {
            // The picture is the output.
        } else if self.json {
            print_json(&difference)?;
        } else {
            print(|out| difference.write(out))?;
        }
        if difference.differs { Err(Failure::Difference) } else { Ok(()) }
    }
}

/// Writes the picture of the take with the largest distance, unless no joint moves.
fn write_picture(path: &Path, files: [LoadedModel; 2], difference: &FileDifference) -> Result<(), Failure> {
    // The take with the largest angle where no joint moves.
    let size = |take: &&DiffTake| {
        let largest = |of: fn(&DiffBone) -> f32| take.bones.iter().map(of).fold(-1.0, f32::max);
        [largest(|bone| bone.distance_mm.value), largest(|bone| bone.angle_degrees.value)]
    };
    let worst = difference.takes.iter().max_by(|a, b| {
        let [a, b] = [size(a), size(b)];
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    let Some((take, bone)) = worst.and_then(|take| Some((take, take.bones.first()?))) else {
        tell(format_args!("no picture: no bone differs"));
        return Ok(());
    };
    let side = |loaded: LoadedModel| {
        let takes = &loaded.model.animation.takes;
        let index = takes.iter().position(|other| other.name == take.name).unwrap_or(0);
        PicturedTake { loaded: Arc::new(loaded), take: index }
    };
    let sides = files.map(side);
    let takes = sides.each_ref().map(|side| &*side.loaded.model.animation.takes[side.take]);
    let skeletons = sides.each_ref().map(|side| &*side.loaded.model.animation.skeleton);
    let times = even_times(takes[0], takes[1], COLUMNS);
    let profile = compare_at((skeletons[0], takes[0]), (skeletons[1], takes[1]), times);
    let most_turned =
        take.bones.iter().max_by(|a, b| a.angle_degrees.value.total_cmp(&b.angle_degrees.value));
    let turned = most_turned.map_or(0.0, |bone| bone.angle_degrees.time);
    let time = if bone.distance_mm.value > 0.0 { bone.distance_mm.time } else { turned };
    let png = draw(&sides, &profile, time)?;
    output::write_file(path, &png)?;
    if path != Path::new("-") {
        tell(format_args!("wrote {}", path.display()));
    }
    Ok(())
}

/// The comparison of two files.
#[derive(Serialize)]
struct FileDifference {
    files: [String; 2],
    differs: bool,
    /// Meters in one unit of length, guessed from the size of the first figure.
    meters_per_unit: f32,
    only_in_first: OnlyIn,
    only_in_second: OnlyIn,
    takes: Vec<DiffTake>,
}

/// Names without a counterpart in the other file.
#[derive(Serialize)]
struct OnlyIn {
    takes: Vec<String>,
    bones: Vec<String>,
}

impl OnlyIn {
    fn is_empty(&self) -> bool {
        self.takes.is_empty() && self.bones.is_empty()
    }
}

/// One take that both files have.
#[derive(Serialize)]
struct DiffTake {
    name: String,
    differs: bool,
    /// Start and end in the first and in the second file, seconds.
    ranges: [[f32; 2]; 2],
    largest_weight_difference: ValueAt,
    /// Bones that differ, the one with the largest distance first.
    bones: Vec<DiffBone>,
}

/// The largest differences of one bone.
#[derive(Serialize)]
struct DiffBone {
    name: String,
    distance_mm: ValueAt,
    angle_degrees: ValueAt,
}

/// A value and the time at which it occurs, seconds.
#[derive(Clone, Copy, Serialize)]
struct ValueAt {
    value: f32,
    time: f32,
}

impl ValueAt {
    fn of(peak: Peak, factor: f32) -> Self {
        Self { value: (peak.value * factor).min(f32::MAX), time: peak.time }
    }
}

impl FileDifference {
    fn of(files: [String; 2], first: &ModelData, second: &ModelData, tolerance: f32, angle: f32) -> Self {
        let (takes, others) = (&first.animation.takes, &second.animation.takes);
        let (skeleton, other_skeleton) = (&*first.animation.skeleton, &*second.animation.skeleton);
        let pairs = pair_bones(skeleton, other_skeleton);
        let meters_per_unit = ModelUnit::of(skeleton).meters;
        let mut is_paired = vec![false; others.len()];
        let (mut rows, mut only_takes) = (Vec::new(), Vec::new());
        for take in takes {
            let same = |index: &usize| !is_paired[*index] && others[*index].name == take.name;
            let Some(index) = (0..others.len()).find(same) else {
                only_takes.push(take.name.clone());
                continue;
            };
            is_paired[index] = true;
            let other = &others[index];
            let difference = compare_takes((skeleton, take), (other_skeleton, other));
            let ranges = [[take.start, take.end()], [other.start, other.end()]];
            let limits = DiffLimits { tolerance, angle, millimeters: 1000.0 * meters_per_unit };
            rows.push(DiffTake::of(take.name.clone(), ranges, &difference, skeleton, limits));
        }
        let left = is_paired.iter().zip(others).filter(|(is_paired, _)| !**is_paired);
        let only_in_first = OnlyIn { takes: only_takes, bones: names(skeleton, &pairs.only_first) };
        let only_in_second = OnlyIn {
            takes: left.map(|(_, take)| take.name.clone()).collect(),
            bones: names(other_skeleton, &pairs.only_second),
        };
        let differs = rows.iter().any(|row: &DiffTake| row.differs)
            || !only_in_first.is_empty()
            || !only_in_second.is_empty();
        Self { files, differs, meters_per_unit, only_in_first, only_in_second, takes: rows }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for (file, other, only) in [
            (&self.files[0], &self.files[1], &self.only_in_first),
            (&self.files[1], &self.files[0], &self.only_in_second),
        ] {
            for (names, kind) in [(&only.takes, "take"), (&only.bones, "bone")] {
                for name in names {
                    writeln!(out, "{}: {kind} {} is not in {}", plain(file), named(name), plain(other))?;
                }
            }
        }
        for take in &self.takes {
            take.write(out)?;
        }
        if !self.differs {
            writeln!(out, "no difference in {}", count(self.takes.len(), "take", "takes"))?;
        }
        Ok(())
    }
}

/// The tolerances within which bones count as equal, millimeters and degrees.
#[derive(Clone, Copy)]
struct DiffLimits {
    tolerance: f32,
    angle: f32,
    /// Millimeters in one unit of length.
    millimeters: f32,
}

impl DiffTake {
    fn of(
        name: String,
        ranges: [[f32; 2]; 2],
        difference: &TakeDifference,
        skeleton: &Skeleton,
        limits: DiffLimits,
    ) -> Self {
        let DiffLimits { tolerance, angle, millimeters } = limits;
        let differs = |bone: &&BoneDifference| {
            bone.distance.value * millimeters > tolerance || bone.angle.value.to_degrees() > angle
        };
        let mut apart: Vec<&BoneDifference> = difference.bones.iter().filter(differs).collect();
        apart.sort_by(|a, b| b.distance.value.total_cmp(&a.distance.value));
        let bones: Vec<DiffBone> = apart
            .into_iter()
            .map(|bone| DiffBone {
                name: bone_name(skeleton, bone.first),
                distance_mm: ValueAt::of(bone.distance, millimeters),
                angle_degrees: ValueAt::of(bone.angle, 1.0_f32.to_degrees()),
            })
            .collect();
        let differs = !bones.is_empty() || difference.weight.value > WEIGHT_TOLERANCE;
        let largest_weight_difference = ValueAt::of(difference.weight, 1.0);
        Self { name, differs, ranges, largest_weight_difference, bones }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        if !self.differs {
            return Ok(());
        }
        let verb = if self.bones.len() == 1 { "differs" } else { "differ" };
        writeln!(out, "take {}: {} {verb}", named(&self.name), count(self.bones.len(), "bone", "bones"))?;
        let [[start, end], [other_start, other_end]] = self.ranges;
        if [start, end] != [other_start, other_end] {
            writeln!(out, "  range {start:.3}–{end:.3} s and {other_start:.3}–{other_end:.3} s")?;
        }
        let ValueAt { value, time } = self.largest_weight_difference;
        if value > WEIGHT_TOLERANCE {
            writeln!(out, "  morph weights differ by up to {value:.4}, at {time:.3} s")?;
        }
        if self.bones.is_empty() {
            return Ok(());
        }
        let mut table = Table::new(&[
            ("bone", Side::Left),
            ("distance", Side::Right),
            ("at", Side::Right),
            ("angle", Side::Right),
            ("at", Side::Right),
        ]);
        for bone in self.bones.iter().take(BONES_SHOWN) {
            table.row([
                named(&bone.name),
                format!("{:.2} mm", bone.distance_mm.value),
                format!("{:.3} s", bone.distance_mm.time),
                format!("{:.2}°", bone.angle_degrees.value),
                format!("{:.3} s", bone.angle_degrees.time),
            ]);
        }
        table.write(out)?;
        if self.bones.len() > BONES_SHOWN {
            writeln!(out, "  … and {} more; --json lists them all", self.bones.len() - BONES_SHOWN)?;
        }
        Ok(())
    }
}

fn bone_name(skeleton: &Skeleton, bone: BoneIndex) -> String {
    skeleton.bones.get(bone as usize).map_or_else(String::new, |bone| bone.name.clone())
}

fn names(skeleton: &Skeleton, bones: &[BoneIndex]) -> Vec<String> {
    bones.iter().map(|&bone| bone_name(skeleton, bone)).collect()
}
