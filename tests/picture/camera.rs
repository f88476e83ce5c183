//! The camera moves as the user expects.

use dragonfly_anim::bounds::Sphere;
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::camera::{Camera, Projection, ViewSide};
use glam::{Vec2, Vec3};

const SIZE: Vec2 = Vec2::new(800.0, 600.0);
const BOUNDS: Sphere = Sphere { center: Vec3::ZERO, radius: 2.0 };

fn cameras() -> Vec<Camera> {
    let mut cameras = Vec::new();
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for (yaw, pitch) in [(0.0, 0.0), (0.7, 0.4), (-2.5, -1.2), (1.0, std::f32::consts::FRAC_PI_2)] {
            let target = Vec3::new(0.3, 1.0, -0.2);
            cameras.push(Camera { target, yaw, pitch, projection, ..Camera::default() });
        }
    }
    cameras
}

/// Returns where a point of the scene appears: pixels from the top left, and its depth.
fn pixel_of(camera: &Camera, point: Vec3) -> (Vec2, f32) {
    let clip_from_world = camera.clip_from_view(SIZE.x / SIZE.y, &BOUNDS) * camera.view_from_world();
    let clip = clip_from_world * point.extend(1.0);
    let place = clip.truncate() / clip.w;
    (Vec2::new(place.x * 0.5 + 0.5, 0.5 - place.y * 0.5) * SIZE, place.z)
}

#[track_caller]
fn near(a: Vec2, b: Vec2) {
    assert!(a.distance(b) < 0.05, "{a} is not {b}");
}

#[test]
fn yaw_and_pitch_zero_look_at_the_front() {
    let camera = Camera { yaw: 0.0, pitch: 0.0, ..Camera::default() };
    assert!((camera.eye() - camera.target).normalize().abs_diff_eq(Vec3::Z, 1e-6));
    assert!(camera.right().abs_diff_eq(Vec3::X, 1e-6) && camera.up().abs_diff_eq(Vec3::Y, 1e-6));
    let right = Camera { yaw: 0.5, ..camera };
    assert!(right.eye().x > 0.0, "positive yaw moves the eye to the right");
}

#[test]
fn the_target_is_centered_and_nearer_points_have_a_larger_depth() {
    for camera in cameras() {
        let (pixel, depth) = pixel_of(&camera, camera.target);
        near(pixel, SIZE / 2.0);
        let (_, nearer) = pixel_of(&camera, camera.target + camera.back() * 0.5);
        assert!((0.0..=1.0).contains(&depth) && nearer > depth, "{camera:?}");
    }
}

#[test]
fn depth_is_one_at_the_near_plane_and_zero_at_the_far_plane() {
    for camera in cameras() {
        let (near, far) = camera.depth_range(&BOUNDS);
        for (distance, expected) in [(near, 1.0), (far, 0.0)] {
            let (_, depth) = pixel_of(&camera, camera.eye() - camera.back() * distance);
            assert!((depth - expected).abs() < 1e-3, "{distance}: {depth}, {camera:?}");
        }
    }
}

#[test]
fn panning_follows_the_pointer_by_the_pixel() {
    for mut camera in cameras() {
        let point = camera.target + camera.right() * 0.2 - camera.up() * 0.1;
        let (before, _) = pixel_of(&camera, point);
        camera.pan(Vec2::new(37.0, -12.0), SIZE.y);
        near(pixel_of(&camera, point).0, before + Vec2::new(37.0, -12.0));
    }
}

#[test]
fn zooming_keeps_the_point_under_the_cursor_in_place() {
    for mut camera in cameras() {
        let cursor = Vec2::new(620.0, 130.0);
        let unit = camera.units_per_pixel(SIZE.y);
        let offset = cursor - SIZE / 2.0;
        let point = camera.target + (camera.right() * offset.x - camera.up() * offset.y) * unit;
        camera.zoom_to(cursor, SIZE, 0.6);
        near(pixel_of(&camera, point).0, cursor);
        camera.zoom_to(cursor, SIZE, 2.5);
        near(pixel_of(&camera, point).0, cursor);
    }
}

#[test]
fn framing_fits_the_bounding_sphere_closely() {
    for aspect in [0.4, 1.0, 2.2] {
        for mut camera in cameras() {
            let sphere = Sphere { center: Vec3::new(5.0, -3.0, 2.0), radius: 1.7 };
            camera.frame(&sphere, aspect);
            let clip_from_world = camera.clip_from_view(aspect, &sphere) * camera.view_from_world();
            let mut widest = 0.0_f32;
            for step in 0..64 {
                let (sin, cos) = (step as f32 / 64.0 * std::f32::consts::TAU).sin_cos();
                for tilt in [-0.5, -0.25, 0.0, 0.25, 0.5_f32] {
                    let ring =
                        (camera.right() * cos + camera.up() * sin) * tilt.cos() + camera.back() * tilt.sin();
                    let clip = clip_from_world * (sphere.center + ring * sphere.radius).extend(1.0);
                    let place = clip.truncate() / clip.w;
                    widest = widest.max(place.x.abs()).max(place.y.abs());
                }
            }
            assert!((0.8..=1.0).contains(&widest), "{widest} at {aspect}, {camera:?}");
        }
    }
}

#[test]
fn at_most_ten_points_decide_how_all_of_them_are_framed() {
    let mut random = Random::new(seed(3));
    for camera in cameras() {
        for aspect in [0.5, 16.0 / 9.0] {
            let mut point = || Vec3::from_array([0; 3].map(|_| random.between(-3.0, 3.0)));
            let points: Vec<Vec3> = (0..500).map(|_| point()).chain([Vec3::NAN]).collect();
            let few = camera.outermost(&points, aspect);
            let ([mut of_few, mut of_all], is_one_of) = ([camera; 2], |point: &Vec3| points.contains(point));
            of_few.frame_points(&few, aspect);
            of_all.frame_points(&points, aspect);
            assert!(few.len() <= 10 && few.iter().all(is_one_of));
            assert!(of_few.target.distance(of_all.target) < 1e-5, "{of_few:?} {of_all:?}");
            assert!((of_few.distance - of_all.distance).abs() < 1e-4, "{of_few:?} {of_all:?}");
        }
        assert!(camera.outermost(&[Vec3::INFINITY], 1.0).is_empty());
    }
}

#[test]
fn switching_the_projection_keeps_sizes_at_the_target() {
    for mut camera in cameras() {
        let point = camera.target + camera.right() * 0.4 + camera.up() * 0.3;
        let (before, _) = pixel_of(&camera, point);
        camera.toggle_projection();
        near(pixel_of(&camera, point).0, before);
    }
}

#[test]
fn a_ray_goes_through_its_pixel() {
    for camera in cameras() {
        for pixel in [Vec2::new(10.0, 20.0), Vec2::new(400.0, 300.0), Vec2::new(700.0, 580.0)] {
            let ray = camera.ray(pixel, SIZE);
            let along = (camera.target - ray.origin).dot(ray.direction);
            near(pixel_of(&camera, ray.origin + ray.direction * along).0, pixel);
        }
    }
}

#[test]
fn named_views_look_from_their_side() {
    let mut camera = Camera::default();
    for (side, from) in [
        (ViewSide::Front, Vec3::Z),
        (ViewSide::Back, Vec3::NEG_Z),
        (ViewSide::Right, Vec3::X),
        (ViewSide::Left, Vec3::NEG_X),
        (ViewSide::Top, Vec3::Y),
        (ViewSide::Bottom, Vec3::NEG_Y),
    ] {
        camera.look_from(side);
        assert!(camera.back().abs_diff_eq(from, 1e-6), "{side:?}");
        assert!(camera.up().is_finite() && (camera.up().length() - 1.0).abs() < 1e-5);
    }
}
