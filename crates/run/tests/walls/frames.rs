//! Walls that are displaced and rotated.

use dem_physics::geometry::{Frame, Shape, SolidBox};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;

use super::{apart, touches};

proptest! {
    #[test]
    fn to_the_wall_and_back(
        position_m in prop::array::uniform3(-5.0..5.0_f64),
        angles in prop::array::uniform3(-3.0..3.0_f64),
        p in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        let [a, b, c] = angles;
        let by = UnitQuaternion::from_euler_angles(a, b, c);
        let frame = Frame { position_m, turned: by.coords.into() };
        prop_assert!(apart(frame.to_space(frame.to_wall(p)), p) < 1e-13);
        let wanted = by * Vector3::from(p) + Vector3::from(position_m);
        prop_assert!(apart(frame.to_space(p), wanted.into()) < 1e-13);

        let shape = Shape::Box(SolidBox::new([-1.0; 3], [1.0, 2.0, 3.0]).unwrap());
        let touch = touches(&shape, frame.to_wall(p), 100.0)[0];
        let there = frame.touch_to_space(&touch);
        prop_assert_eq!((there.distance_m, there.feature), (touch.distance_m, touch.feature));
        let point = Vector3::from(p) + there.distance_m * Vector3::from(there.normal);
        prop_assert!(apart(point.into(), there.point) < 1e-12);
    }
}

#[test]
fn the_default_frame_is_space() {
    let p = [1.0, -2.0, 3.0];
    assert_eq!(Frame::default().to_wall(p), p);
    assert_eq!(Frame::default().to_space(p), p);
}
