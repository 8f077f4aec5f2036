//! The region that bodies fed by inlets will reach, estimated at the start of a run.

use nalgebra::Vector3;

use dem_engine::state::State;
use dem_physics::geometry::{Bounds, Shape};

/// Planes at the sides are reached if they are not further from where bodies land than this
/// multiple of the way there and the size of the inlet.
const SIDE: f64 = 3.0;
/// Points of a path.
const POINTS: u32 = 8;

/// Where fed bodies go: points of their paths, and the largest distance along gravity that they
/// fall until they reach a plane.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Reach {
    /// m. Shape n x 3.
    pub(crate) points_m: Vec<[f64; 3]>,
    pub(crate) fall_m: f64,
}

/// A half-space of solid wall.
struct Solid {
    point: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Solid {
    fn height_m(&self, point: Vector3<f64>) -> f64 {
        (point - self.point).dot(&self.normal)
    }
}

impl Reach {
    /// From each corner of each inlet on a parabola to the first plane; from there sideways, at
    /// right angles to gravity, to planes nearby.
    pub(crate) fn of(state: &State) -> Self {
        let model = &state.model;
        let gravity = Vector3::from(model.gravity_m_s2);
        let solids = solids(state);
        let mut reach = Self::default();
        for inlet in &model.rules.inlets {
            let region = model.rules.regions[inlet.region].bounds();
            let velocity = Vector3::from(inlet.velocity_m_s);
            for corner in region.corners() {
                reach.points_m.push(corner);
                let start = Vector3::from(corner);
                let Some(time_s) = (solids.iter())
                    .filter_map(|solid| time_to(solid, start, velocity, gravity))
                    .min_by(f64::total_cmp)
                else {
                    continue;
                };
                let way = |at: u32| -> Vector3<f64> {
                    let time_s = time_s * f64::from(at) / f64::from(POINTS);
                    start + time_s * velocity + 0.5 * time_s * time_s * gravity
                };
                reach
                    .points_m
                    .extend((1..=POINTS).map(|at| <[f64; 3]>::from(way(at))));
                let landing = way(POINTS);
                let fall_m = (landing - start).dot(&gravity.normalize());
                reach.fall_m = reach.fall_m.max(fall_m);
                let near_m = SIDE * ((landing - start).norm() + region.diagonal_m());
                reach
                    .points_m
                    .extend(sides(&solids, landing, gravity, near_m));
            }
        }
        reach
    }

    /// Where outlets take fed bodies, m: of each region its part within the `scene`, or else its
    /// side towards the scene. Regions of outlets are often far larger than the scene. Shape n x 3.
    pub(crate) fn outlets(state: &State, scene: &Bounds) -> Vec<[f64; 3]> {
        let rules = &state.model.rules;
        if rules.inlets.is_empty() {
            return Vec::new();
        }
        let outlets = rules
            .outlets
            .iter()
            .filter(|outlet| !outlet.removes_outside);
        let regions = outlets.map(|outlet| rules.regions[outlet.region].bounds());
        regions
            .flat_map(|region| nearest(&region, scene).corners())
            .collect()
    }

    /// The box within which all outlets leave bodies: the common part of the regions outside of
    /// which bodies are taken.
    pub(crate) fn within(state: &State) -> Bounds {
        let rules = &state.model.rules;
        let everywhere = Bounds {
            low: [f64::NEG_INFINITY; 3],
            high: [f64::INFINITY; 3],
        };
        let outlets = rules.outlets.iter().filter(|outlet| outlet.removes_outside);
        outlets.fold(everywhere, |within, outlet| {
            within.common(&rules.regions[outlet.region].bounds())
        })
    }
}

/// The part of a box within another, or else its side towards that.
pub(crate) fn nearest(region: &Bounds, scene: &Bounds) -> Bounds {
    let side = |end: f64, k: usize| {
        let within = end.max(scene.low[k]).min(scene.high[k]);
        within.max(region.low[k]).min(region.high[k])
    };
    Bounds {
        low: [0, 1, 2].map(|k| side(region.low[k], k)),
        high: [0, 1, 2].map(|k| side(region.high[k], k)),
    }
}

/// All planes.
fn solids(state: &State) -> Vec<Solid> {
    let solid = |wall: &dem_engine::state::walls::Wall| match &wall.model.shape {
        Shape::Plane(plane) => Some(Solid {
            point: wall.frame.to_space(plane.point_m()).into(),
            normal: Vector3::from(wall.frame.direction_to_space(plane.normal())),
        }),
        _ => None,
    };
    state.walls.iter().filter_map(solid).collect()
}

/// The time after which a point in free flight reaches a plane from its front, s. None: never.
fn time_to(
    solid: &Solid,
    start: Vector3<f64>,
    velocity: Vector3<f64>,
    gravity: Vector3<f64>,
) -> Option<f64> {
    let height_m = solid.height_m(start);
    let [speed, pull] = [velocity, gravity].map(|along| along.dot(&solid.normal));
    // height + speed t + pull t^2 / 2 = 0, in the form that holds for a pull of 0 as well.
    let root = speed * speed - 2.0 * pull * height_m;
    let time_s = 2.0 * height_m / (root.sqrt() - speed);
    (height_m > 0.0 && time_s > 0.0 && time_s.is_finite()).then_some(time_s)
}

/// The nearest points of planes to either side of a landing, no further than `near_m`, along the
/// axes of space without their part along gravity.
fn sides(
    solids: &[Solid],
    landing: Vector3<f64>,
    gravity: Vector3<f64>,
    near_m: f64,
) -> Vec<[f64; 3]> {
    let mut found = Vec::new();
    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
        let down = gravity.normalize();
        let Some(level) = (axis - axis.dot(&down) * down).try_normalize(0.5) else {
            continue;
        };
        for direction in [level, -level] {
            let distance = |solid: &Solid| {
                let towards = -direction.dot(&solid.normal);
                // Not the plane on which it lands, nor one that is hardly inclined to the way.
                (towards > 0.5).then(|| solid.height_m(landing) / towards)
            };
            let nearest = solids.iter().filter_map(distance).min_by(f64::total_cmp);
            let nearest = nearest.filter(|far_m| (0.0..=near_m).contains(far_m));
            let point = |far_m: f64| <[f64; 3]>::from(landing + far_m * direction);
            found.extend(nearest.map(point));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use dem_engine::state::bonds::Bonds;
    use dem_engine::state::particles::Particles;
    use dem_engine::state::rules::{Feed, Inlet, Outlet};
    use dem_engine::state::walls::Wall;
    use dem_physics::geometry::region::Region;
    use dem_physics::geometry::{Frame, Plane};

    /// A gate of 0.2 m x 0.2 m, 0.8 m above a floor.
    fn state(velocity_m_s: [f64; 3], planes: &[([f64; 3], [f64; 3])]) -> State {
        let mut state = State::new(Particles::default(), Bonds::default(), 1e-6, 1);
        state.model.gravity_m_s2 = [0.0, 0.0, -10.0];
        let floor = ([0.0; 3], [0.0, 0.0, 1.0]);
        state.walls = [&[floor], planes]
            .concat()
            .into_iter()
            .map(|(point_m, normal)| {
                let plane = Plane::new(point_m, normal).unwrap();
                Wall::standing(Shape::Plane(plane), Frame::default())
            })
            .collect();
        state.model.rules.regions = vec![Region::Box(Bounds {
            low: [-0.1, -0.1, 0.8],
            high: [0.1, 0.1, 0.8],
        })];
        state.model.rules.inlets = vec![Inlet {
            name: "feed".to_owned(),
            templates: vec![(0, 1.0)],
            region: 0,
            feed: Feed::Number(1.0),
            velocity_m_s,
            spin_rad_s: [0.0; 3],
            random_orientation: false,
            between_s: [0.0, 1.0],
            count: 1,
        }];
        state
    }

    fn bounds(reach: &Reach) -> Bounds {
        Bounds::of(reach.points_m.iter().copied())
    }

    #[test]
    fn bodies_fall_to_the_floor_and_roll_to_the_walls() {
        let free = Reach::of(&state([0.0; 3], &[]));
        let found = bounds(&free);
        assert!((free.fall_m - 0.8).abs() < 1e-12 && found.low[2].abs() < 1e-12);
        assert_eq!([found.low[0], found.high[1]], [-0.1, 0.1]);
        // Walls 0.4 m to the left and 50 m to the right.
        let walls = [
            ([-0.4, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([50.0, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ];
        let found = bounds(&Reach::of(&state([0.0; 3], &walls)));
        assert!((found.low[0] + 0.4).abs() < 1e-12 && found.high[0] == 0.1);
    }

    #[test]
    fn bodies_that_are_thrown_fly_on_a_parabola() {
        // 0.8 m upwards from rest at 4 m/s: 0.4 s up, 0.4 sqrt(2) s down.
        let reach = Reach::of(&state([1.0, 0.0, 4.0], &[]));
        let flight_s = 0.4 * (1.0 + 2.0_f64.sqrt());
        let found = bounds(&reach);
        assert!((found.high[0] - (0.1 + flight_s)).abs() < 1e-12);
        assert!(
            found.high[2] > 1.5 && found.high[2] <= 1.6,
            "{}",
            found.high[2]
        );
        assert!((reach.fall_m - 0.8).abs() < 1e-12);
        // Away from everything.
        let mut up = state([0.0, 0.0, 1.0], &[]);
        up.model.gravity_m_s2 = [0.0; 3];
        let reach = Reach::of(&up);
        assert_eq!((reach.points_m.len(), reach.fall_m), (8, 0.0));
    }

    #[test]
    fn outlets_end_the_reach() {
        let mut state = state([0.0; 3], &[]);
        let bin = Bounds {
            low: [0.5, 0.0, 0.1],
            high: [0.6, 0.1, 0.2],
        };
        state.model.rules.regions.push(Region::Box(bin));
        let outlet = |removes_outside| Outlet {
            name: "out".to_owned(),
            region: 1,
            removes_outside,
        };
        state.model.rules.outlets = vec![outlet(false)];
        let scene = bounds(&Reach::of(&state));
        // The bin is to the right of the gate, whose lower side it touches.
        let side = Bounds::of(Reach::outlets(&state, &scene));
        assert_eq!((side.low, side.high), ([0.5, 0.0, 0.1], [0.5, 0.1, 0.2]));
        let wider = scene.with(&bin);
        assert_eq!(Bounds::of(Reach::outlets(&state, &wider)), bin);
        // A region that reaches far below and beyond the scene.
        state.model.rules.regions[1] = Region::Box(Bounds {
            low: [-9.0; 3],
            high: [9.0, 9.0, -0.5],
        });
        let side = Bounds::of(Reach::outlets(&state, &scene));
        assert_eq!(
            (side.low, side.high),
            ([-0.1, -0.1, -0.5], [0.1, 0.1, -0.5])
        );
        state.model.rules.regions[1] = Region::Box(bin);
        assert_eq!(Reach::within(&state).high[0], f64::INFINITY);
        state.model.rules.outlets = vec![outlet(true)];
        assert!(Reach::outlets(&state, &scene).is_empty());
        assert_eq!(Reach::within(&state), bin);
    }
}
