//! Builds the tiny editors of `design` a second time without their feature, so that the tests can run them: the marked
//! lines are the complete feature, and the remaining lines are a complete program.

use std::path::Path;
use std::{env, fs, io};

#[path = "design/count.rs"]
#[allow(dead_code, unreachable_pub)]
mod count;

/// The modules with their files; the first file of each folder is its `mod.rs`.
const FILES: &[(&str, &[&str])] = &[
    ("messages", &["mod.rs", "document.rs", "handles.rs", "panel.rs", "viewport.rs"]),
    ("ways", &["mod.rs", "closures.rs", "raw.rs"]),
    ("locks", &["mod.rs", "panel.rs", "viewport.rs"]),
];

fn main() -> io::Result<()> {
    let read = |path: &str| -> io::Result<String> {
        println!("cargo::rerun-if-changed=design/{path}");
        Ok(before(&fs::read_to_string(format!("design/{path}"))?))
    };
    let mut all = format!("pub mod skeleton {{\n{}}}\n", read("skeleton.rs")?);
    for (folder, files) in FILES {
        all += &format!("pub mod {folder} {{\n");
        for file in *files {
            let text = read(&format!("{folder}/{file}"))?;
            match file.strip_suffix(".rs") {
                Some(name) if name != "mod" => all += &format!("mod {name} {{\n{text}}}\n"),
                _ => all += &text,
            }
        }
        all += "}\n";
    }
    println!("cargo::rerun-if-changed=build.rs");
    let folder = env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&folder).join("before.rs"), all)
}

/// Returns the text of a module before the feature, without its tests, comments and `mod` lines, so that it can be a
/// part of one file.
fn before(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let code = code.replace("#[cfg(test)]\nmod traps;", "").replace("crate::design::", "super::super::");
    let list = |line: &&str| !(line.trim().starts_with("//") || line.ends_with(';') && line.contains("mod "));
    count::before(&code).lines().filter(list).fold(String::new(), |all, line| all + line + "\n")
}
