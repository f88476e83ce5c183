//! Every shader in the program's list is valid WGSL, on its own, without a device.

use dragonfly_picture::shaders::ALL;
use naga::valid::{Capabilities, ValidationFlags, Validator};

#[test]
fn every_shader_is_valid() {
    for shader in ALL {
        let source = shader.source();
        let module = naga::front::wgsl::parse_str(&source)
            .unwrap_or_else(|error| panic!("{}: {}", shader.name, error.emit_to_string(&source)));
        Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{}: {}", shader.name, error.emit_to_string(&source)));
    }
}

#[test]
fn every_shader_file_is_in_the_list_of_the_program() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "wgsl") {
            let name = path.file_stem().unwrap().to_str().unwrap();
            assert!(
                ALL.iter().any(|shader| shader.name == name),
                "{name}.wgsl is not in picture/src/shaders.rs"
            );
        }
    }
}
