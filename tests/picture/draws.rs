//! The work of a device grows no faster than the file: one draw for each surface, however often it is placed, one for each
//! body of all bones together, and each corner of a body once.

use dragonfly_anim::data::ModelData;
use dragonfly_kit::document::{large, made};
use dragonfly_kit::picture::{images, studio};
use dragonfly_picture::body::{BodyMesh, triangles};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::shape::Body;
use dragonfly_picture::{GhostAppearance, PictureSettings, Studio};
use glam::Vec3;

#[test]
fn a_skeleton_of_any_size_with_one_surface_is_one_draw() {
    let Some(mut studio) = studio::studio() else { return };
    let settings = PictureSettings { skeleton: true, ..images::settings() };
    for bones in [10, 300] {
        studio.render(&large::tree(bones), &settings).expect("drawn");
        assert_eq!(studio.stage().draw_calls(), 1, "{bones} bones");
    }
}

#[test]
fn each_surface_is_one_draw() {
    let Some(mut studio) = studio::studio() else { return };
    for meshes in [1, 250] {
        studio.render(&large::meshes(meshes), &images::settings()).expect("drawn");
        assert_eq!(studio.stage().draw_calls(), meshes as usize);
    }
}

#[test]
fn all_instances_of_a_mesh_are_one_draw_in_each_pass() {
    let Some(mut studio) = studio::studio() else { return };
    for instances in [2, 2000] {
        let loaded = large::instances(instances);
        studio.render(&loaded, &images::settings()).expect("drawn");
        assert_eq!(studio.stage().draw_calls(), 1, "{instances} instances");
        assert_eq!(shown(&mut studio), instances as usize, "all are inside the view");
    }
    // Two ghosts are two more.
    let times = vec![(0.5, -1), (1.5, 1)];
    studio.stage().scene.appearances.set(GhostAppearance { times, skins: true });
    studio.render(&large::instances(2000), &images::settings()).expect("drawn");
    assert_eq!(studio.stage().draw_calls(), 3);
}

#[test]
fn surfaces_of_one_material_share_their_pipeline_and_bind_groups() {
    let Some(mut studio) = studio::studio() else { return };
    let changes = [2, 250].map(|meshes| {
        let mut model = ModelData::clone(&large::meshes(meshes).model);
        model.meshes.iter_mut().for_each(|mesh| mesh.primitives[0].material = Some(0));
        studio.render(&made::loaded(model, Vec::new()), &images::settings()).expect("drawn");
        assert_eq!(studio.stage().draw_calls(), meshes as usize);
        studio.stage().state_changes()
    });
    assert_eq!(changes[0], changes[1], "no more for more surfaces");
}

/// Returns the number of instances that the last frame drew.
fn shown(studio: &mut Studio) -> usize {
    studio.stage().scene.model().expect("a model").batches().instances().len()
}

#[test]
fn instances_outside_the_view_are_not_drawn() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = large::instances(300);
    let whole = studio.camera(&loaded, &images::settings());
    let away = Camera { target: whole.target + Vec3::X * whole.distance * 10.0, ..whole };
    let settings = |camera| PictureSettings { camera: Some(camera), ..images::settings() };
    studio.render(&loaded, &settings(away)).expect("drawn");
    assert_eq!((studio.stage().draw_calls(), shown(&mut studio)), (0, 0));
    let near = Camera { distance: whole.distance * 0.2, ..whole };
    studio.render(&loaded, &settings(near)).expect("drawn");
    let few = shown(&mut studio);
    assert!(few > 0 && few < 200, "{few} of 300");
}

#[test]
fn a_corner_that_triangles_of_a_bone_share_is_computed_once() {
    // Twenty sides' ends of a stick; five rings of ten corners and two poles of a ball.
    for (body, corners) in [(Body::Stick, 20), (Body::Ball, 52), (Body::Octahedron, 24), (Body::Line, 0)] {
        let mesh = BodyMesh::of(body);
        assert_eq!(mesh.vertices.len(), corners, "{body:?}");
        assert!(mesh.indices.iter().all(|&index| usize::from(index) < corners), "{body:?}");
        let drawn =
            mesh.indices.chunks_exact(3).map(|face| face.iter().map(|&at| mesh.vertices[at as usize]));
        let drawn: Vec<Vec<_>> = drawn.map(Iterator::collect).collect();
        let whole = |face: &&[_]| face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
        let all = triangles(body);
        let expected: Vec<Vec<_>> = all.chunks_exact(3).filter(whole).map(<[_]>::to_vec).collect();
        assert_eq!(drawn, expected, "{body:?}: the same triangles in the same order");
    }
}
