//! Direction of the dependencies, and the words that each part of the source must not contain.

use crate::tree::{File, files, none, one};

/// A crate and the packages that it may depend on at run time.
const DEPENDENCIES: &[(&str, &[&str])] = &[
    (
        "anim",
        &[
            "base64",
            "crc",
            "draco-core",
            "glam",
            "gltf",
            "libm",
            "miniz_oxide",
            "percent-encoding",
            "roxmltree",
            "serde_json",
            "thiserror",
        ],
    ),
    ("runtime", &["flume", "loom", "shuttle", "spin", "tracing"]),
];

/// Returns the entries of `[dependencies]` and of those for one platform or configuration, without development
/// dependencies.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut inside = false;
    let mut found = Vec::new();
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            inside =
                line.trim_matches(['[', ']']).ends_with("dependencies") && !line.contains("dev-dependencies");
        } else if inside
            && !line.starts_with('#')
            && let Some(end) = line.find(['.', '=', ' '])
        {
            found.push(line[..end].to_owned());
        }
    }
    found
}

fn forbidden_dependencies(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for (name, allowed) in DEPENDENCIES {
        let manifest = files.iter().find(|file| file.path == format!("{name}/Cargo.toml"));
        for dependency in manifest.map(|file| dependencies(&file.text)).unwrap_or_default() {
            if !allowed.contains(&dependency.as_str()) {
                complaints.push(format!("{name} depends on {dependency}; it may on {}", allowed.join(", ")));
            }
        }
    }
    complaints
}

#[test]
fn dependencies_have_one_direction_and_libraries_use_no_window_or_gpu() {
    let files = files();
    let found =
        files.iter().filter(|file| file.path == "anim/Cargo.toml").flat_map(|file| dependencies(&file.text));
    assert!(found.count() >= 3, "the dependencies of anim were not understood");
    none(forbidden_dependencies(&files));
    let back = "[dependencies]\nglam.workspace = true\ndragonfly-runtime.workspace = true\n[dev-dependencies]\nwgpu.workspace = true";
    one(forbidden_dependencies(&[File::planted("anim/Cargo.toml", back)]));
    let platform = "[target.'cfg(unix)'.dependencies]\nwgpu.workspace = true";
    one(forbidden_dependencies(&[File::planted("runtime/Cargo.toml", platform)]));
}

fn versions_outside_the_root(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for file in files.iter().filter(|file| file.path.ends_with("/Cargo.toml")) {
        let mut inside = false;
        for line in file.text.lines().map(str::trim) {
            if line.starts_with('[') {
                inside = line.contains("dependencies");
            } else if inside
                && line.contains('=')
                && !line.starts_with('#')
                && !line.contains("workspace = true")
            {
                complaints
                    .push(format!("{}: `{line}`: versions are chosen in the root Cargo.toml", file.path));
            }
        }
    }
    complaints
}

#[test]
fn dependency_versions_are_declared_once() {
    none(versions_outside_the_root(&files()));
    one(versions_outside_the_root(&[File::planted("anim/Cargo.toml", "[dependencies]\nglam = \"0.34\"")]));
}

/// A part of the source, the words that it must not contain, and the reason.
struct Absence {
    within: &'static [&'static str],
    except: &'static [&'static str],
    words: &'static [&'static str],
    because: &'static str,
}

/// Words that the architecture excludes from parts of the source.
const ABSENCES: &[Absence] = &[
    Absence {
        within: &["anim/src/"],
        except: &[],
        words: &[
            "std::fs",
            "std::thread",
            "std::net",
            "std::process",
            "std::env",
            "std::io::std",
            "println!",
            "Instant::",
        ],
        because: "the library starts no thread, opens no file, and asks the machine nothing",
    },
    Absence {
        within: &["anim/src/", "runtime/src/", "editor/"],
        // The only file that chooses between the real primitives and those of the model checkers.
        except: &["runtime/src/sync"],
        words: &["Mutex", "RwLock", "Condvar", "OnceLock", "LazyLock"],
        because: "no lock is shared by two threads: one owner for everything, and messages between them",
    },
    Absence {
        within: &[
            "anim/src/",
            "editor/src/",
            "editor/store/",
            "editor/fbx/",
            "editor/movie/",
            "editor/document/",
            "editor/picture/",
        ],
        except: &[],
        words: &["thread::Builder", "thread::spawn", "thread::scope"],
        because: "background work is a job of the runtime, so that it is named, reported and joined",
    },
    Absence {
        within: &["editor/src/panels/", "editor/src/control/"],
        except: &[],
        words: &[".recv(", "block_on(", "wait_for(", "std::fs", "wgpu"],
        because: "a panel reads a view and sends edits; it waits for nothing and touches no disk and no device",
    },
    Absence {
        within: &["editor/src/", "editor/document/", "editor/store/"],
        except: &[],
        words: &["wgpu::Device", "wgpu::Queue", "wgpu::Surface"],
        because: "the graphics thread alone owns the device and the surface",
    },
    Absence {
        within: &["editor/"],
        // The type of a window, and the places of the main thread that make a surface of it or ask for the pointer.
        except: &[
            "editor/src/app/target_window.rs",
            "editor/src/app/pointer_place.rs",
            "editor/picture/src/connection.rs",
            "editor/picture/src/surface_source.rs",
            "editor/picture/src/x11.rs",
        ],
        words: &["window_handle(", "HasWindowHandle", "create_surface"],
        because: "Windows and macOS give the handle of a window only to the main thread",
    },
    Absence {
        within: &["runtime/src/"],
        except: &[],
        words: &["wgpu", "winit", "egui", "glam"],
        because: "the runtime knows nothing of animation, windows or GPUs",
    },
    Absence {
        within: &["tests/editor/", "tests/picture/"],
        // Three files run the graphics thread themselves, and one has a layer that makes errors on purpose.
        except: &[
            "tests/picture/graphics_thread.rs",
            "tests/picture/surface_thread.rs",
            "tests/editor/pictures/windows.rs",
            "tests/editor/faults.rs",
        ],
        words: &["Studio::new", "Studio::with", "RenderStage::new", "Device::new", "Graphics::start"],
        because: "a test gets its device where it is watched for errors of ours, from studio()",
    },
];

/// Files that may contain `unsafe`, with the reason.
const UNSAFE: &[(&str, &str)] = &[
    ("anim/src/fast/simd/apart.rs", "sixteen places in a slice are checked once, not one by one"),
    ("anim/src/fast/simd/avx2.rs", "instructions beyond the target's own can be had in no other way"),
    ("anim/src/fast/simd/avx512.rs", "as for avx2.rs"),
    ("anim/src/fast/simd/sixteen.rs", "as for avx2.rs"),
    ("editor/picture/src/x11.rs", "a driver takes a connection and a window as pointer and number"),
    ("tests/kit/src/counting.rs", "an allocator that counts is an unsafe trait by definition"),
    ("tests/runtime/models.rs", "the races planted there must be found, and safe code cannot have any"),
];

fn forbidden_words(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for absence in ABSENCES {
        let inside = |path: &str| {
            absence.within.iter().any(|part| path.starts_with(part))
                && !absence.except.iter().any(|part| path.starts_with(part))
        };
        for file in files.iter().filter(|file| file.is_rust() && inside(&file.path)) {
            let code = file.code();
            for word in absence.words.iter().filter(|word| code.contains(**word)) {
                complaints.push(format!("{}: `{word}`: {}", file.path, absence.because));
            }
        }
    }
    complaints
}

#[test]
fn forbidden_words_of_the_architecture_do_not_occur() {
    none(forbidden_words(&files()));
    one(forbidden_words(&[File::planted("anim/src/format/obj.rs", "let text = std::fs::read(path)?;")]));
    one(forbidden_words(&[File::planted("editor/src/app/state.rs", "state: Arc<Mutex<State>>, // shared")]));
    one(forbidden_words(&[File::planted("editor/src/panels/takes.rs", "let answer = receiver.recv();")]));
    one(forbidden_words(&[File::planted(
        "editor/src/app/dialog.rs",
        "std::thread::Builder::new().spawn(ask)?;",
    )]));
    one(forbidden_words(&[File::planted("editor/src/app/window.rs", "device: wgpu::Device,")]));
    one(forbidden_words(&[File::planted(
        "editor/picture/src/stage.rs",
        "instance.create_surface(window)?;",
    )]));
    one(forbidden_words(&[File::planted("tests/editor/light.rs", "let studio = Studio::new()?;")]));
    one(forbidden_words(&[File::planted("runtime/src/thread.rs", "use winit::event_loop;")]));
    none(forbidden_words(&[File::planted("editor/src/app/state.rs", "// no Mutex here")]));
}

fn unlisted_unsafe_code(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for file in files.iter().filter(|file| file.is_rust() && !file.path.starts_with("tests/repo/")) {
        if UNSAFE.iter().any(|(allowed, _)| *allowed == file.path) {
            continue;
        }
        let mut words = Vec::new();
        for line in file.code().lines() {
            words.extend(
                line.split(|character: char| !character.is_alphanumeric() && character != '_')
                    .map(str::to_owned),
            );
        }
        if words.iter().any(|word| word == "unsafe") {
            complaints.push(format!("{}: `unsafe` outside the files that may", file.path));
        }
    }
    complaints
}

#[test]
fn unsafe_code_occurs_only_in_the_listed_files() {
    none(unlisted_unsafe_code(&files()));
    one(unlisted_unsafe_code(&[File::planted("anim/src/fast.rs", "let x = unsafe { *pointer };")]));
    none(unlisted_unsafe_code(&[File::planted("anim/src/lib.rs", "#![forbid(unsafe_code)]")]));
}
