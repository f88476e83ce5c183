//! Rendering a file takes no more memory than opening it may take, also where the processor draws and the textures are in
//! the memory of the program.

use crate::program::dragonfly;
use dragonfly_kit::folder::Folder;
use dragonfly_kit::picture::studio::studio;
use dragonfly_kit::process::peak_bytes;
use image::{GrayImage, ImageFormat, Luma};
use serde_json::json;
use std::io::Read;
use std::path::PathBuf;
use std::process::Stdio;

/// Number of triangles, each with an image of its own.
const IMAGES: u8 = 60;

/// Writes triangles with images of `side` by `side` pixels that are small as files. Returns the path and the size of all files.
fn triangles(folder: &Folder, side: u32) -> (PathBuf, u64) {
    let mut bytes = 0;
    for shade in 0..IMAGES {
        let path = folder.join(&format!("{shade}.png"));
        GrayImage::from_pixel(side, side, Luma([shade])).save_with_format(&path, ImageFormat::Png).unwrap();
        bytes += std::fs::metadata(path).unwrap().len();
    }
    let corners: [f32; 15] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    std::fs::write(folder.join("triangle.bin"), corners.map(f32::to_le_bytes).concat()).unwrap();
    let each = |make: &dyn Fn(u8) -> serde_json::Value| (0..IMAGES).map(make).collect::<Vec<_>>();
    let primitive = |number| json!({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": number});
    let file = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "triangle.bin", "byteLength": 60}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 24},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "images": each(&|number| json!({"uri": format!("{number}.png")})),
        "textures": each(&|number| json!({"source": number})),
        "materials": each(&|number| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": number}}})),
        "meshes": [{"primitives": each(&primitive)}],
        "nodes": [{"mesh": 0}],
    });
    let path = folder.join("triangles.gltf");
    std::fs::write(&path, file.to_string()).unwrap();
    bytes += std::fs::metadata(&path).unwrap().len() + 60;
    (path, bytes)
}

/// Renders a file. Returns the most memory that the program had, and its warnings.
fn render(file: &std::path::Path) -> (u64, String) {
    let mut child = dragonfly(["render", "--output", "-"])
        .arg(file)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdout = child.stdout.take().expect("piped");
    // The image is complete, and larger than a pipe, so the program does not end before the rest is read.
    stdout.read_exact(&mut [0; 8]).expect("the start of an image");
    let memory = peak_bytes(child.id());
    let mut rest = Vec::new();
    stdout.read_to_end(&mut rest).expect("the rest of the image");
    assert!(rest.len() > 128 << 10, "only {} bytes", rest.len());
    let output = child.wait_with_output().expect("our own child");
    assert!(output.status.success());
    (memory, String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_small_file_with_many_large_images_is_rendered_within_the_memory_of_its_import() {
    let Some(mut studio) = studio() else { return };
    let on_processor = studio.stage().device().is_software();
    drop(studio);
    let [folder, small] = ["render-memory", "render-memory-small"].map(Folder::new);
    let ((file, bytes), (like, _)) = (triangles(&folder, 1_024), triangles(&small, 1));
    let promise = (256 << 20) + 32 * bytes;
    let ((memory, warnings), (without, none)) = (render(&file), render(&like));
    println!("{bytes} bytes: {memory} of {promise}, {without} with images of one pixel\n{warnings}");
    assert_eq!(none, "");
    // The memory of a driver for a graphics device is not that of the file.
    let memory = if on_processor { memory } else { memory.saturating_sub(without) };
    assert!(memory > 0 && memory <= promise, "{memory} of {promise}");
    assert_eq!(warnings.contains("Images are shown at half size: "), on_processor, "{warnings}");
}
