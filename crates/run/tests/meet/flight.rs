//! When free bodies meet walls.

use std::time::{Duration, Instant};

use dem_engine::check::flight::{FreeBody, Meeting};
use dem_engine::state::walls::Wall;
use dem_physics::geometry::{Frame, Mesh, Plane, Shape, SolidBox};
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

/// Of a surface of many facets the nearest is found without looking at all of them.
#[test]
fn a_meeting_with_a_fine_surface_takes_no_longer_than_with_a_plane() {
    const SIDE: u32 = 300;
    let places = (0..=SIDE).flat_map(|i| (0..=SIDE).map(move |j| [i, j]));
    let at = |n: u32| f64::from(n) / 30.0 - 5.0;
    let vertices: Vec<[f64; 3]> = places.map(|[i, j]| [at(i), at(j), 0.0]).collect();
    let corners = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| i * (SIDE + 1) + j));
    let triangles: Vec<[u32; 3]> = corners
        .flat_map(|a| {
            let b = a + SIDE + 1;
            [[a, b, b + 1], [a, b + 1, a + 1]]
        })
        .collect();
    let mesh = Mesh::new(&vertices, &triangles).unwrap();
    let tiles = Wall::standing(Shape::Mesh(mesh), Frame::default());
    let falling = ball([0.003, 0.004, 1.1], [0.3, 0.0, 0.0], [0.0, 0.0, -9.81]);
    let began = Instant::now();
    let met = falling.first_meeting(&[tiles], &[]);
    // All pairs of facets took a minute.
    assert!(
        began.elapsed() < Duration::from_secs(5),
        "{:?}",
        began.elapsed()
    );
    let (
        Meeting::At { after_s: now, .. },
        Meeting::At {
            after_s: wanted, ..
        },
    ) = (met, falling.first_meeting(&[floor()], &[]))
    else {
        panic!("it meets both");
    };
    assert!((now - wanted).abs() < 1e-9, "{now} {wanted}");
}

/// What a forecast says of a ball that falls onto a held sphere, and past it.
#[test]
fn a_held_body_can_be_met() {
    let warnings = |x: f64, support: &str| {
        let text = format!(
            "version = 1
run = {{ end_time = 0.1, gravity = [0, 0, -9.81] }}
materials.g = {{ density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }}
contacts.g-g = {{ restitution = 0.5 }}
bodies.floor = {{ material = \"g\", particles = [[0, 0, 0, 0.01]] }}
bodies.ball = {{ material = \"g\", particles = [[{x}, 0, 0.025, 0.005]] }}
supports.floor = {{ group = \"floor\", {support} }}
"
        );
        let scene = crate::helpers::scene(&text);
        let bodies = dem_scene::read_bodies(&scene).unwrap();
        let plan = dem_plan::plan(&scene, bodies, 1, false).unwrap();
        plan.forecast.warnings
    };
    let never = "'ball' never meets anything in free flight";
    let says = |warnings: &[String]| warnings.iter().any(|one| one.starts_with(never));
    for x in [0.0, 0.0149] {
        let told = warnings(x, "fixed = true");
        assert!(!says(&told), "{x}: {told:?}");
    }
    assert!(says(&warnings(0.0151, "fixed = true")));
    // It may be in the way later.
    assert!(!says(&warnings(0.0151, "velocity = { x = 0.1 }")));
}
