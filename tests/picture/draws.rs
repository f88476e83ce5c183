//! The work of a device grows no faster than the file: one draw for each surface, one for each
//! body of all bones together, and each corner of a body once.

use dragonfly_kit::document::large;
use dragonfly_kit::picture::{images, studio};
use dragonfly_picture::PictureSettings;
use dragonfly_picture::body::{BodyMesh, triangles};
use dragonfly_picture::shape::Body;

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
