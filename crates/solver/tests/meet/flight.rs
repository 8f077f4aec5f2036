//! When free bodies meet walls.

use dem_run::geometry::{Frame, Plane, Shape, SolidBox};
use dem_run::internals::{FreeBody, Meeting};
use dem_run::state::walls::Wall;
use nalgebra::Vector3;

fn ball(at: [f64; 3], velocity: [f64; 3], gravity: [f64; 3]) -> FreeBody {
    let spheres = vec![(Vector3::zeros(), 0.1)];
    FreeBody::new("ball", spheres, gravity.into()).moving(
        at.into(),
        velocity.into(),
        Vector3::zeros(),
    )
}

fn floor() -> Wall {
    let plane = Plane::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
    let mut wall = Wall::standing(Shape::Plane(plane), Frame::default());
    std::sync::Arc::make_mut(&mut wall.model).name = "floor".to_owned();
    wall
}

#[test]
fn a_ball_falls_as_galilei_says() {
    let g = [0.0, 0.0, -9.81];
    let falling = ball([0.0, 0.0, 1.1], [3.0, 0.0, 0.0], g);
    let Meeting::At {
        after_s, speed_m_s, ..
    } = falling.first_meeting(&[floor()], &[])
    else {
        panic!("it meets the floor");
    };
    assert!(
        (after_s - (2.0_f64 / 9.81).sqrt()).abs() < 1e-6,
        "{after_s}"
    );
    assert!((speed_m_s - (9.0 + 2.0 * 9.81_f64).sqrt()).abs() < 1e-5);
}

#[test]
fn what_flies_away_or_falls_beside_meets_nothing() {
    let up = ball([0.0, 0.0, 1.1], [0.0, 0.0, 1.0], [0.0; 3]);
    assert_eq!(up.first_meeting(&[floor()], &[]), Meeting::Never);
    let still = ball([0.0, 0.0, 1.1], [0.0; 3], [0.0; 3]);
    assert_eq!(still.first_meeting(&[floor()], &[]), Meeting::Never);
    let plate = SolidBox::new([-1.0, -1.0, -0.1], [1.0, 1.0, 0.0]).unwrap();
    let plate = Wall::standing(Shape::Box(plate), Frame::default());
    let g = [0.0, 0.0, -9.81];
    let beside = ball([1.2, 0.0, 1.0], [0.0; 3], g);
    assert_eq!(
        beside.first_meeting(std::slice::from_ref(&plate), &[]),
        Meeting::Never
    );
    let over = ball([1.05, 0.0, 1.0], [0.0; 3], g);
    let at = over.first_meeting(&[plate], &[]);
    assert!(matches!(at, Meeting::At { .. }), "{at:?}");
}

#[test]
fn another_body_in_the_way_leaves_it_open() {
    let g = [0.0, 0.0, -9.81];
    let one = ball([0.0, 0.0, 1.1], [1.0, 0.0, 0.0], g);
    let mut other = ball([0.3, 0.0, 1.1], [0.0; 3], g);
    let walls = [floor()];
    assert_eq!(
        one.first_meeting(&walls, std::slice::from_ref(&other)),
        Meeting::Unknown
    );
    other.velocity_m_s.x = 1.0;
    assert_ne!(one.first_meeting(&walls, &[other]), Meeting::Unknown);
}
