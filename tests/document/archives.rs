//! Archives of projects: what is packed is unpacked byte for byte, other programs read it, and hostile archives do no harm.

use super::projects::{PROJECT, project};
use dragonfly_document::archive::{ArchiveError, ArchivedFile, read_archive, write_archive};
use dragonfly_document::{Cancel, PackError, pack, unpack};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use std::fs;
use std::process::Command;

fn file(name: &str, bytes: impl Into<Vec<u8>>) -> ArchivedFile {
    ArchivedFile { name: name.to_owned(), bytes: bytes.into() }
}

fn random_files(random: &mut Random) -> Vec<ArchivedFile> {
    (0..random.bits() % 8)
        .map(|number| {
            let length = (random.bits() % 5000) as usize;
            // Half of them cannot be compressed.
            let letters = if random.bits().is_multiple_of(2) { 4 } else { 256 };
            let bytes: Vec<u8> = (0..length).map(|_| (random.bits() % letters) as u8).collect();
            file(&format!("folder é/{}/file {number}.bin", random.bits() % 3), bytes)
        })
        .collect()
}

#[test]
fn files_are_read_as_they_were_written_and_the_same_files_give_the_same_bytes() {
    let mut random = Random::new(seed(130));
    for _ in 0..200 {
        let files = random_files(&mut random);
        let bytes = write_archive(&files).expect("an archive");
        assert_eq!(read_archive(&bytes).expect("the files"), files);
        assert_eq!(write_archive(&files).expect("an archive"), bytes);
    }
}

#[test]
fn an_independent_program_reads_and_writes_the_same_files() {
    let folder = Folder::new("archive-python");
    let files = random_files(&mut Random::new(seed(131)));
    fs::write(folder.join("own.zip"), write_archive(&files).expect("an archive")).expect("a file");
    let code = "import sys,zipfile\nz=zipfile.ZipFile(sys.argv[1])\nassert z.testzip() is None\n\
        w=zipfile.ZipFile(sys.argv[2],'w',zipfile.ZIP_DEFLATED)\n[w.writestr(i.filename,z.read(i)) for i in z.infolist()]\n\
        w.comment=b'packed by another program'\nw.close()\n";
    let run = Command::new("python3")
        .arg("-c")
        .arg(code)
        .args([folder.join("own.zip"), folder.join("other.zip")])
        .output();
    let Ok(run) = run else {
        return dragonfly_kit::skip::skip(dragonfly_kit::skip::TestNeed::Evaluators, "there is no python3");
    };
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let other = fs::read(folder.join("other.zip")).expect("a file");
    assert_eq!(read_archive(&other).expect("the files"), files);
}

#[test]
fn names_that_lead_out_of_the_folder_or_occur_twice_are_refused_when_written_and_when_read() {
    for name in ["../a", "a/../../b", "/etc/passwd", "C:/a", "a\\b", "", "a//b", "a/", "b."] {
        let error = write_archive(&[file(name, "x")]).expect_err(name);
        assert!(matches!(error, ArchiveError::Name { .. }), "{name}: {error}");
        // A name of the same length is replaced in the bytes.
        let place = "x".repeat(name.len().max(1));
        if name.is_empty() || name == "a/" {
            continue;
        }
        let mut bytes = write_archive(&[file(&place, "text")]).expect("an archive");
        for at in (0..bytes.len() - name.len()).rev() {
            if bytes[at..].starts_with(place.as_bytes()) {
                bytes[at..at + name.len()].copy_from_slice(name.as_bytes());
            }
        }
        let error = read_archive(&bytes).expect_err(name);
        assert!(matches!(error, ArchiveError::Name { .. }), "{name}: {error}");
    }
    let twice = [file("a/B", "1"), file("A/b", "2")];
    assert!(matches!(write_archive(&twice), Err(ArchiveError::Twice(_))));
}

#[test]
fn a_file_that_unpacks_to_more_than_it_says_is_refused_without_the_memory_for_it() {
    let bytes = write_archive(&[file("zeros", vec![0; 50_000_000])]).expect("an archive");
    assert!(bytes.len() < 100_000);
    let size = 50_000_000_u32.to_le_bytes();
    let mut lies = bytes.clone();
    for at in 0..lies.len() - 4 {
        if lies[at..at + 4] == size {
            lies[at..at + 4].copy_from_slice(&1000_u32.to_le_bytes());
        }
    }
    assert_eq!(read_archive(&lies), Err(ArchiveError::Checksum("zeros".to_owned())));
}

#[test]
fn sizes_that_are_too_large_together_are_refused_before_anything_is_unpacked() {
    let bytes =
        write_archive(&[file("a", vec![0; 123_457]), file("b", vec![0; 123_457])]).expect("an archive");
    let mut large = bytes;
    for at in 0..large.len() - 4 {
        if large[at..at + 4] == 123_457_u32.to_le_bytes() {
            large[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        }
    }
    assert_eq!(read_archive(&large), Err(ArchiveError::TooLarge));
}

#[test]
fn a_directory_that_announces_very_many_files_is_refused_without_the_memory_for_them() {
    // A megabyte that announces a million files, in the format for more than 4 GiB.
    let mut bytes = write_archive(&[file("zeros", vec![1; 10])]).expect("an archive");
    let directory = bytes.windows(4).position(|four| four == b"PK\x01\x02").expect("a directory");
    let entry = bytes[directory..bytes.len() - 22].to_vec();
    bytes.truncate(directory);
    bytes.resize(1 << 20, 0);
    let (start, count) = (bytes.len() as u64, 1_u64 << 20);
    bytes.extend(&entry);
    let end = bytes.len() as u64;
    bytes.extend(b"PK\x06\x06");
    bytes.extend(44_u64.to_le_bytes());
    bytes.extend([45, 0, 45, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    for long in [count, count, 1 << 50, start] {
        bytes.extend(long.to_le_bytes());
    }
    bytes.extend(b"PK\x06\x07\0\0\0\0");
    bytes.extend(end.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([0xff; 12]);
    bytes.extend([0; 2]);
    let error = read_archive(&bytes).expect_err("too many");
    assert_eq!(error.to_string(), "the archive: the format for more than 4 GiB is not supported");
}

#[test]
fn a_symbolic_link_and_an_encrypted_file_are_refused() {
    let whole = write_archive(&[file("link", "target")]).expect("an archive");
    let directory = whole.windows(4).position(|four| four == b"PK\x01\x02").expect("a directory");
    let mut link = whole.clone();
    // Made on Unix, where the upper half of the attributes has the kind of file.
    link[directory + 5] = 3;
    link[directory + 40..directory + 42].copy_from_slice(&0o120_777_u16.to_le_bytes());
    let mut encrypted = whole;
    encrypted[directory + 8] |= 1;
    for (bytes, feature) in [(link, "a symbolic link"), (encrypted, "encryption")] {
        let name = "link".to_owned();
        assert_eq!(read_archive(&bytes), Err(ArchiveError::Unsupported { name, feature }));
    }
}

#[test]
fn no_damaged_archive_panics_and_none_is_read_as_other_files() {
    let mut random = Random::new(seed(132));
    let files = [file("a.xml", "<script/>".repeat(50)), file("b/c.bin", vec![7; 300])];
    let whole = write_archive(&files).expect("an archive");
    for _ in 0..20_000 {
        let mut bytes = whole.clone();
        for _ in 0..1 + random.bits() % 3 {
            let at = (random.bits() % bytes.len() as u64) as usize;
            bytes[at] = random.bits() as u8;
        }
        if random.bits().is_multiple_of(4) {
            bytes.truncate((random.bits() % bytes.len() as u64) as usize);
        }
        if let Ok(read) = read_archive(&bytes) {
            for file in read {
                assert!(files.iter().any(|own| own.bytes == file.bytes), "{}", file.name);
            }
        }
    }
}

#[test]
fn a_packed_project_has_every_file_that_it_needs_and_is_the_same_after_unpacking() {
    let folder = Folder::new("pack");
    let path = project(&folder);
    let bytes = pack(&path, &Cancel::default()).expect("an archive");
    let names: Vec<String> = read_archive(&bytes).expect("files").into_iter().map(|file| file.name).collect();
    for wanted in ["foxes.meproj", "main.xml", "end.xml", "foxes.lines.xml", "models/Fox.glb"] {
        assert!(names.iter().any(|name| name == wanted), "{wanted} of {names:?}");
    }
    assert_eq!(names.len(), 5, "{names:?}");
    let archive = folder.join("foxes.zip");
    fs::write(&archive, &bytes).expect("a file");
    let out = folder.join("out");
    assert_eq!(unpack(&archive, &out).expect("files").len(), 5);
    for name in &names {
        assert_eq!(fs::read(out.join(name)).expect(name), fs::read(folder.join(name)).expect(name));
    }
    assert_eq!(pack(&out.join("foxes.meproj"), &Cancel::default()).expect("an archive"), bytes);
    assert!(matches!(unpack(&archive, &out), Err(PackError::Write(_))), "nothing is overwritten");
}

#[test]
fn a_project_with_a_missing_file_is_not_packed_and_every_missing_file_is_named() {
    let folder = Folder::new("pack-missing");
    let path = project(&folder);
    fs::remove_file(folder.join("models/Fox.glb")).expect("a file");
    fs::write(&path, PROJECT.replace("end.xml", "gone.xml")).expect("a file");
    let Err(PackError::Files(reasons)) = pack(&path, &Cancel::default()) else { panic!("it was packed") };
    let all = reasons.join("\n");
    assert!(all.contains("models/Fox.glb: does not exist") && all.contains("gone.xml"), "{all}");
}

#[test]
fn the_files_that_a_model_needs_are_packed_with_it() {
    let folder = Folder::new("pack-neighbors");
    let model = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"data/points.bin","byteLength":36}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
        "min":[0,0,0],"max":[1,1,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
        "scenes":[{"nodes":[0]}],"scene":0}"#;
    fs::create_dir_all(folder.join("props/data")).expect("a folder");
    fs::write(folder.join("props/box.gltf"), model).expect("a file");
    let points = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    fs::write(folder.join("props/data/points.bin"), points).expect("a file");
    let path = folder.join("scene.xml");
    let text = "<script version=\"1\"><cast><prop id=\"box\" model=\"props/box.gltf\"/></cast></script>";
    fs::write(&path, text).expect("a file");
    let bytes = pack(&path, &Cancel::default()).expect("an archive");
    let names: Vec<String> = read_archive(&bytes).expect("files").into_iter().map(|file| file.name).collect();
    assert_eq!(names, ["scene.xml", "props/box.gltf", "props/data/points.bin"]);
}
