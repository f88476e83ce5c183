//! Damaged files: no panic, no unsound model, no memory beyond the budget.

use super::made::{compressed, import, pendulum, small, stored, with_header};
use crate::doors::MemoryFs;
use crate::soundness::{faults, faults_of_poses};
use crate::takes::opened_takes;
use dragonfly_anim::format::{ByteBudget, ImportError, NoFiles, ReadOptions, x::X};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::{Mutator, mutants};
use dragonfly_kit::random::seed;
use miniz_oxide::deflate::compress_to_vec;

#[test]
fn every_truncation_of_a_file_of_each_encoding_is_an_error_or_a_sound_model() {
    for (name, bytes) in small() {
        let (mut read, mut refused) = (0, 0);
        for length in 0..=bytes.len() {
            match import(&bytes[..length]) {
                Ok(imported) => {
                    assert_eq!(faults(&imported.model), [""; 0], "{name}: {length} bytes");
                    read += 1;
                }
                Err(error) => {
                    let text = error.to_string();
                    assert!(text.starts_with("line ") || text.starts_with("byte "), "{name}: {text}");
                    refused += 1;
                }
            }
        }
        println!("{name}: {read} read, {refused} refused");
        assert!(refused > read, "{name}");
    }
}

#[test]
fn mutants_of_files_are_errors_or_sound_models_and_can_be_saved() {
    let first = seed(57_721);
    println!("DRAGONFLY_SEED={first}");
    let files: Vec<Vec<u8>> = small().into_iter().map(|(_, bytes)| bytes).collect();
    let words: &[&[u8]] = &[
        b"{",
        b"}",
        b"Frame a {",
        b"Mesh {",
        b"\"",
        b" 1e39 ",
        b" nan ",
        b"<",
        b"//",
        b"CK",
        b"\x06\0\xff\xff\xff\xff",
        b"\x0a\0",
        b"\x0b\0",
        b"SkinWeights {",
    ];
    let mut mutator = Mutator::new(first, words);
    let mut read = 0;
    for number in 0..mutants() {
        let bytes = mutator.mutant(&files);
        let Ok(imported) = import(&bytes) else { continue };
        read += 1;
        assert_eq!(faults(&imported.model), [""; 0], "mutant {number}");
        let file = X.edit("a.x", bytes.clone(), &NoFiles, &ReadOptions::default()).unwrap();
        let saved = file.plan(&imported.model, &opened_takes(&imported.model)).unwrap();
        assert!(saved.files[0].bytes == bytes, "mutant {number}");
        assert_eq!(faults_of_poses(imported.model), [""; 0], "mutant {number}");
    }
    println!("{read} of {} read", mutants());
    assert!(read > mutants() / 10);
}

#[test]
fn every_refused_charge_is_a_clear_error() {
    for name in ["pendulum.x", "pendulum_bzip.x", "test_cube_compressed.x"] {
        let bytes = stored(name);
        let mut request = 0;
        loop {
            let options = ReadOptions { budget: ByteBudget::failing_at(request), ..ReadOptions::default() };
            match X.import(&bytes, &MemoryFs::default(), &options) {
                Err(ImportError::TooLarge { .. }) => request += 1,
                Err(other) => panic!("charge {request}: {other}"),
                Ok(_) => break,
            }
        }
        println!("{name}: {request} charges");
        assert!(request > 30, "{name}");
    }
}

#[test]
fn memory_is_charged_before_it_is_used() {
    let many = "Frame f { }\n".repeat(20_000);
    let faces: String = (0..20_000).map(|_| "4;0,1,2,3;,").collect();
    let mesh = format!("Mesh m {{ 4; 0;0;0;,1;0;0;,1;1;0;,0;1;0;; 20000; {faces} }}");
    let keys: String = (0..20_000).map(|tick| format!("{tick};3;1,2,3;;,")).collect();
    let set =
        format!("Frame f {{ }} AnimationSet {{ Animation {{ {{f}} AnimationKey {{ 2; 20000; {keys} }} }} }}");
    for text in [many, mesh, set] {
        let bytes = with_header(&text);
        let options = ReadOptions::default();
        let (memory, result) = peak(|| X.import(&bytes, &NoFiles, &options));
        result.unwrap();
        println!("{} bytes: {memory} at most, {} charged", bytes.len(), options.budget.used());
        assert!(memory <= options.budget.used() + (64 << 10), "{memory} of {}", options.budget.used());
        for limit in [1 << 12, 1 << 16, 1 << 18] {
            let options = ReadOptions { budget: ByteBudget::at_most(limit), ..ReadOptions::default() };
            let (memory, result) = peak(|| X.import(&bytes, &NoFiles, &options));
            assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{limit}");
            assert!(memory <= limit + (64 << 10), "{memory} bytes with a limit of {limit}");
        }
    }
}

#[test]
fn compressed_data_needs_no_more_memory_than_is_charged_whatever_it_announces() {
    let zeros = compress_to_vec(&[b' '; 32_768], 9);
    let bomb = compressed(32_768 * 3_000 + 16, &vec![(32_768, zeros.clone()); 3_000]);
    let options = ReadOptions { budget: ByteBudget::at_most(8 << 20), ..ReadOptions::default() };
    let (memory, result) = peak(|| X.import(&bomb, &NoFiles, &options));
    assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{result:?}");
    assert!(memory <= (8 << 20) + (128 << 10), "{memory}");
    let whole = import(&bomb).unwrap();
    assert!(whole.model.meshes.is_empty());

    let error = |total: usize, blocks: &[(usize, Vec<u8>)]| {
        import(&compressed(total, blocks)).unwrap_err().to_string()
    };
    // More, or less, than a block announces; larger than is possible; another total; nothing; damaged.
    assert!(error(1000, &[(1000, zeros.clone())]).starts_with("byte 26: a block of 1000 bytes is damaged"));
    assert!(
        error(32_784, &[(32_767, zeros.clone())]).starts_with("byte 26: a block of 32767 bytes is damaged")
    );
    assert!(
        error(40_000, &[(40_000, zeros.clone())])
            .starts_with("byte 20: a block of 40000 bytes; at most 32768")
    );
    assert_eq!(error(9, &[(32_768, zeros)]), "byte 16: 32784 bytes without compression, 9 are announced");
    assert_eq!(error(9, &[]), "byte 16: 16 bytes without compression, 9 are announced");
    assert!(error(9, &[(9, vec![0xff; 9])]).starts_with("byte 26: a block of 9 bytes is damaged"));
    // A copy from before the first byte of all blocks.
    let far = compress_to_vec(pendulum().as_bytes(), 9);
    assert!(error(9, &[(9, far[1..].to_vec())]).starts_with("byte 26"));
}

#[test]
fn frames_inside_each_other_have_a_limit_and_need_no_stack() {
    let deep = |count: usize| with_header(&("Frame f {\n".repeat(count) + &"}".repeat(count)));
    assert_eq!(import(&deep(512)).unwrap().model.animation.skeleton.len(), 512);
    let error = import(&deep(100_000)).unwrap_err();
    assert_eq!(error.to_string(), "line 514 column 1: frames inside each other: 513, at most 512");
    assert!(import(&with_header(&"a {".repeat(100_000))).is_err());
}
