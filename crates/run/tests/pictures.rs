//! The visible parts of a state, and the view.

use dem_engine::state::State;
use dem_engine::state::bonds::Bonds;
use dem_engine::state::particles::Particles;
use dem_engine::state::walls::Wall;
use dem_physics::geometry::{Frame, Plane, Shape, SolidBox};
use dem_runner::pictures::View;

/// Balls of 10 mm at these positions, m, without contacts and clusters.
fn state(places: &[[f64; 3]]) -> State {
    let mut particles = Particles::default();
    for place in places {
        particles.push_sphere(*place, 0.01, 1000.0);
    }
    State::new(particles, Bonds::default(), 1e-6, 1)
}

fn standing(shape: Shape, position_m: [f64; 3]) -> Wall {
    let frame = Frame {
        position_m,
        ..Frame::default()
    };
    Wall::standing(shape, frame)
}

fn floor() -> Shape {
    Shape::Plane(Plane::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap())
}

fn pixels(view: &View, state: &State) -> Vec<u8> {
    view.picture(state, &[], 0.01).rgb().to_vec()
}

#[test]
fn walls_are_seen_where_they_have_gone() {
    let mut state = state(&[[0.0, 0.0, 0.02], [0.03, 0.0, 0.02]]);
    let solid = Shape::Box(SolidBox::new([-0.05; 3], [0.0; 3]).unwrap());
    state.walls = vec![
        standing(floor(), [0.0; 3]),
        standing(solid, [-0.05, 0.0, 0.05]),
    ];
    let view = View::of(&state, None, None);
    let before = pixels(&view, &state);
    assert!(before == pixels(&view, &state));
    for wall in [0, 1] {
        state.walls[wall].frame.position_m[2] += 0.01;
        assert!(before != pixels(&view, &state), "{wall}");
        state.walls[wall].frame.position_m[2] -= 0.01;
    }
    state.particles.poses[1].put_at([0.04, 0.0, 0.02]);
    assert!(before != pixels(&view, &state));
}

#[test]
fn the_view_is_that_of_the_direction_whatever_its_length() {
    let state = state(&[[0.0; 3], [0.05, 0.0, 0.0], [0.0, 0.02, 0.0]]);
    let of = |from| pixels(&View::of(&state, from, None), &state);
    let front = of(Some([0.0, -1.0, 0.0]));
    assert!(front == of(Some([0.0, -7.0, 0.0])));
    assert!(front != of(None) && front != of(Some([0.0, 1.0, 0.0])));
    // From straight above, where no direction is up.
    assert!(of(Some([0.0, 0.0, 1.0])) != front);
}

#[test]
fn a_scene_that_is_empty_at_its_start_has_pictures_too() {
    let mut state = state(&[]);
    state.walls = vec![standing(floor(), [0.0; 3])];
    let image = View::of(&state, None, None).picture(&state, &[], 0.01);
    assert_eq!((image.width(), image.height()), (960, 540));
}
