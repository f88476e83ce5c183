//! A validation error fails the test during which it occurs.

use dragonfly_kit::picture::complaints::none_in;
use dragonfly_kit::picture::studio;
use std::ffi::OsStr;

/// Causes a validation error: a buffer is used in a way for which it was not created.
fn provoke(studio: &mut dragonfly_picture::Studio) {
    let gpu = studio.stage().device().gpu();
    let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("a mistake on purpose"),
        size: 16,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    });
}

#[test]
fn a_validation_error_fails_the_test_that_caused_it() {
    const NAME: &str = "complaints::a_validation_error_fails_the_test_that_caused_it";
    // In a separate process, because the error also fails every other test in its process.
    dragonfly_kit::process::alone(NAME, || {
        let Some(mut studio) = studio::studio() else { return };
        provoke(&mut studio);
        let failed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| drop(studio)));
        assert!(failed.is_err(), "an error of ours was not noticed");
    });
}

#[test]
#[should_panic(expected = "unexpected graphics error")]
fn a_validation_error_in_the_log_fails_the_test_that_started_the_program() {
    none_in("ERROR dragonfly_picture::fault: unexpected graphics error error=…", [OsStr::new("DISPLAY")]);
}
