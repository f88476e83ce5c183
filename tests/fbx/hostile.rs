//! Damaged and hostile files: an error with a reason or a sound model, quickly and with little memory.

use crate::soundness::{faults, faults_of_poses};
use crate::support::{data, file, read_here, read_in_child};
use dragonfly_anim::format::{ImportContext, ImportError, NoFiles, ReadOptions};
use dragonfly_fbx::{answer_in_process, read_answer};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::{Mutator, first_mutant, mutants, print_progress};
use dragonfly_kit::process::thread_time;
use dragonfly_kit::random::seed;
use dragonfly_kit::skip::models;
use std::time::Duration;

/// Limits of time and memory for every file.
const MOST_TIME: Duration = Duration::from_secs(2);
const MOST_MEMORY: u64 = 256 << 20;

/// Byte sequences with a meaning in the format.
const WORDS: &[&[u8]] = &[
    b"Lcl Rotation",
    b"Lcl Scaling",
    b"KeyTime",
    b"C: \"OO\",0,0\n",
    b"Deformer",
    b"Cluster",
    b"Transform",
    b"AnimationCurve",
    b"InheritType",
    b"PolygonVertexIndex",
    b"*1000000000",
    b"nan",
    b"-1.#INF",
    b"1e308",
    b"}",
    b"{",
    b"Kaydara FBX Binary  \0",
    b"RotationOrder",
    b"UnitScaleFactor",
    b"UpAxis",
    b"Shape",
    b"FullWeights",
];

/// Reads bytes here and returns what is wrong with the result.
fn wrong_with(bytes: &[u8]) -> Vec<String> {
    tried(bytes).1
}

/// Reads bytes here. Returns whether there is a model, and what is wrong with the result.
fn tried(bytes: &[u8]) -> (bool, Vec<String>) {
    let start = thread_time();
    let (memory, result) = peak(|| read_here(bytes));
    let mut wrong = Vec::new();
    let is_read = result.is_ok();
    match result {
        Ok(read) => {
            wrong.extend(faults(&read.model));
            wrong.extend(faults_of_poses(read.model));
        }
        Err(error) => wrong.extend(wrong_with_error(&error)),
    }
    let time = thread_time().saturating_sub(start);
    if time > MOST_TIME || memory > MOST_MEMORY {
        wrong.push(format!("took {time:?} and {memory} bytes"));
    }
    (is_read, wrong)
}

fn wrong_with_error(error: &ImportError) -> Option<String> {
    let text = error.to_string();
    let is_clear = text.len() > 10 && !text.contains('\n') && !error.code().is_empty();
    (!is_clear).then(|| format!("an unclear error: {text:?}"))
}

#[test]
fn every_cut_of_a_text_file_is_an_error_or_a_sound_model() {
    let bytes = file("maya_interpolation_modes_7500_ascii.fbx");
    for end in 0..bytes.len() {
        let wrong = wrong_with(&bytes[..end]);
        assert!(wrong.is_empty(), "cut at {end}: {wrong:?}");
    }
}

#[test]
fn every_cut_of_a_binary_file_is_an_error_or_a_sound_model() {
    let bytes = file("maya_blend_shape_cube_7700_binary.fbx");
    for end in (0..bytes.len()).filter(|end| *end < 1000 || end % 3 == 0) {
        let wrong = wrong_with(&bytes[..end]);
        assert!(wrong.is_empty(), "cut at {end}: {wrong:?}");
    }
    for end in [0, 1, 27, 1000, 20_000] {
        assert!(read_in_child(&bytes[..end]).is_err(), "cut at {end}");
    }
}

#[test]
fn mutants_are_errors_or_sound_models() {
    let files = [
        "maya_scale_no_inherit_6100_ascii.fbx",
        "maya_blend_shape_cube_7700_binary.fbx",
        "max_transformed_skin_7500_binary.fbx",
        "maya_interpolation_modes_7500_ascii.fbx",
    ];
    let files = files.map(file);
    let seed = seed(0xFB_1996);
    let mut mutator = Mutator::new(seed, WORDS);
    let mut read = 0;
    let first = first_mutant();
    for number in 0..mutants() {
        let mutant = mutator.mutant(&files);
        if number < first {
            continue;
        }
        print_progress(number);
        let (is_read, wrong) = tried(&mutant);
        assert!(wrong.is_empty(), "seed {seed}, mutant {number}: {wrong:?}");
        read += usize::from(is_read);
    }
    println!("seed {seed}: {read} of the mutants {first} to {} were read", mutants());
    assert!(read > mutants().saturating_sub(first) / 10, "only {read} mutants were read");
}

#[test]
fn answers_of_a_parser_under_attack_are_errors_or_sound_models() {
    let options = ReadOptions::default();
    let answers = ["max_transformed_skin_7500_binary.fbx", "maya_blend_shape_cube_7700_binary.fbx"]
        .map(|name| answer_in_process(&file(name), ImportContext::new(&NoFiles, &options)));
    let refused = answer_in_process(b"no FBX", ImportContext::new(&NoFiles, &options));
    let answers: Vec<Vec<u8>> = answers.into_iter().chain([refused]).collect();
    let check = |answer: &[u8], what: &dyn Fn() -> String| {
        let options = ReadOptions::default();
        let context = ImportContext::new(&NoFiles, &options);
        let (memory, read) = peak(|| read_answer(answer, &context));
        let wrong = match read {
            Ok(model) => faults(&model),
            Err(error) => wrong_with_error(&error).into_iter().collect(),
        };
        assert!(wrong.is_empty() && memory < MOST_MEMORY, "{}: {wrong:?}, {memory} bytes", what());
    };
    let seed = seed(0xFB_2026);
    let words: &[&[u8]] =
        &[b"null", b"[", b"4294967295", b"\"names\":[\"..\\\\..\\\\x\"]", b"Pointer", b"1e39"];
    let mut mutator = Mutator::new(seed, words);
    for number in 0..mutants() {
        let mutant = mutator.mutant(&answers);
        check(&mutant, &|| format!("seed {seed}, mutant {number}"));
    }
    // The header alone, which no checksum protects.
    let headers: Vec<Vec<u8>> =
        answers.iter().map(|answer| answer[..answer.len().min(700)].to_vec()).collect();
    for number in 0..mutants() {
        let mut mutant = mutator.mutant(&headers);
        mutant.extend(&answers[0][answers[0].len().min(700)..]);
        check(&mutant, &|| format!("seed {seed}, header {number}"));
    }
    for end in 0..answers[0].len() {
        let options = ReadOptions::default();
        let cut = read_answer(&answers[0][..end], &ImportContext::new(&NoFiles, &options));
        assert!(cut.is_err(), "an answer cut at {end} was read");
    }
}

#[test]
fn the_bad_files_of_the_collection_are_answered_as_expected() {
    let Some(folder) = models() else { return };
    let folder = folder.join("../bad");
    let index = std::fs::read_to_string(folder.join("INDEX.tsv")).expect("the index of bad files");
    let mut failed = Vec::new();
    let mut files = 0;
    for row in index.lines().filter(|row| row.starts_with("fbx/")) {
        let columns: Vec<&str> = row.split('\t').collect();
        let bytes = std::fs::read(folder.join(columns[0])).expect("a bad file");
        files += 1;
        let result = read_in_child(&bytes);
        let mut wrong = wrong_with(&bytes);
        match (&result, columns[2]) {
            (Ok(_), "error" | "error-unsupported") => wrong.push("was read".to_owned()),
            (Err(error), "load") => wrong.push(format!("was refused: {error}")),
            _ => {}
        }
        match result {
            Ok(read) => println!("{}: read, {} warnings", columns[0], read.warnings.len()),
            Err(error) => println!("{}: {error}", columns[0]),
        }
        if !wrong.is_empty() {
            failed.push(format!("{}: {wrong:?}", columns[0]));
        }
    }
    assert!(files >= 37, "only {files} files");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn a_file_of_another_format_with_this_extension_is_refused_with_a_reason() {
    let fox = std::fs::read(data().join("gltf/Fox.glb")).expect("a file");
    let error = read_in_child(&fox).err().expect("no FBX");
    assert!(error.to_string().contains("FBX") || error.to_string().contains("format"), "{error}");
}
