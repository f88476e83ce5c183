//! Picking the bone under a moving pointer: one request at a time, and only the newest position counts.

use dragonfly::app::hover::{Hover, HoverPoint};
use dragonfly_picture::camera::Camera;

fn at(x: f32) -> Option<HoverPoint> {
    Some(HoverPoint { position: [x, 0.0], camera: Camera::default(), generation: 1 })
}

#[test]
fn only_one_pick_is_in_flight_and_the_newest_position_is_picked_next() {
    let mut hover = Hover::default();
    assert!(hover.asks(at(0.0), 1));
    for x in 1..100 {
        assert!(!hover.asks(at(x as f32), 2), "no second request while one is in flight");
    }
    assert!(hover.answered(1));
    assert!(hover.asks(at(99.0), 2), "the pointer has moved since");
    assert!(!hover.answered(1), "an answer counts once");
    assert!(hover.answered(2));
}

#[test]
fn a_pointer_at_rest_is_picked_only_once() {
    let mut hover = Hover::default();
    assert!(hover.asks(at(5.0), 1));
    assert!(hover.answered(1));
    for _ in 0..10 {
        assert!(!hover.asks(at(5.0), 2));
    }
    let moved = at(5.0).map(|place| HoverPoint { generation: 2, ..place });
    assert!(hover.asks(moved, 2), "another model lies there now");
}

#[test]
fn a_late_pick_is_ignored_after_the_pointer_left() {
    let mut hover = Hover::default();
    assert!(hover.asks(at(5.0), 1));
    assert!(!hover.asks(None, 2));
    assert!(!hover.answered(1), "it points at nothing any more");
    assert!(!hover.asks(None, 2));
    assert!(hover.asks(at(5.0), 2), "it came back");
    assert!(!hover.answered(7), "the request of another caller");
}
