//! Pieces that fall past all outlets: no outlet will remove them, and nothing catches them.

use dem_io::units::significant;
use nalgebra::Vector3;

use crate::pictures::around_walls;
use dem_engine::state::State;
use dem_engine::state::clusters::fragments::Fragment;
use dem_physics::geometry::Shape;

/// Number of places on its way at which a falling piece is tested for being in an outlet.
const MOMENTS: u32 = 1000;

/// A clump or a fragment: place of its centre, m, velocity, m/s, and mass, kg.
struct Piece {
    centre_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    mass_kg: f64,
}

/// A warning if pieces below all walls fall past the outlets. None: there are none, or a plane
/// beneath the scene catches them.
pub(crate) fn past_outlets(state: &State, fragments: &[Fragment]) -> Option<String> {
    let rules = &state.model.rules;
    let gravity = Vector3::from(state.model.gravity_m_s2);
    let down = gravity.try_normalize(0.0)?;
    let takes_all = rules.outlets.iter().any(|outlet| outlet.removes_outside);
    if rules.outlets.is_empty() || takes_all || has_floor(state, down) {
        return None;
    }
    let corners = around_walls(state).corners().map(Vector3::from);
    let depths = corners.iter().map(|corner| down.dot(corner));
    let beneath_walls = depths.fold(f64::NEG_INFINITY, f64::max);
    let is_lost = |piece: &Piece| {
        let depth_m = down.dot(&piece.centre_m);
        depth_m > beneath_walls && piece.velocity_m_s.dot(&down) > 0.0 && falls_past(state, piece)
    };
    let lost: Vec<Piece> = pieces(state, fragments).filter(is_lost).collect();
    if lost.is_empty() {
        return None;
    }
    let mass_kg: f64 = lost.iter().map(|piece| piece.mass_kg).sum();
    let [x, y, z] = <[f64; 3]>::from(lost[0].centre_m).map(|x| significant(x, 3));
    let mass = significant(mass_kg, 3);
    let have = match lost.len() {
        1 => format!("a clump or fragment of {mass} kg has"),
        count => format!("{count} clumps and fragments, {mass} kg in all, have"),
    };
    Some(format!(
        "{have} fallen past the outlets and will not be discharged, one at ({x}, {y}, {z}) m: enlarge the region of an outlet, or add an outlet with outside = \"REGION\""
    ))
}

/// A note on pieces that have fallen past all walls of a scene without outlets and floor. None:
/// there are none.
pub(crate) fn past_walls(state: &State, fragments: &[Fragment]) -> Option<String> {
    let down = Vector3::from(state.model.gravity_m_s2).try_normalize(0.0)?;
    if state.walls.is_empty() || !state.model.rules.outlets.is_empty() || has_floor(state, down) {
        return None;
    }
    let corners = around_walls(state).corners().map(Vector3::from);
    let beneath_walls = corners
        .iter()
        .fold(f64::NEG_INFINITY, |most, c| most.max(down.dot(c)));
    let is_lost = |piece: &Piece| {
        down.dot(&piece.centre_m) > beneath_walls && piece.velocity_m_s.dot(&down) > 0.0
    };
    let lost: Vec<Piece> = pieces(state, fragments).filter(is_lost).collect();
    let first = lost.first()?;
    let [x, y, z] = <[f64; 3]>::from(first.centre_m).map(|x| significant(x, 3));
    let mass_kg: f64 = lost.iter().map(|piece| piece.mass_kg).sum();
    Some(format!(
        "{} clumps and fragments, {} kg in all, have fallen past all walls and fall on, one at ({x}, {y}, {z}) m; check the walls, or add an outlet that takes them out",
        lost.len(),
        significant(mass_kg, 3),
    ))
}

fn has_floor(state: &State, down: Vector3<f64>) -> bool {
    state.walls.iter().any(|wall| match &wall.model.shape {
        Shape::Plane(plane) => {
            let normal = Vector3::from(wall.frame.direction_to_space(plane.normal()));
            normal.dot(&down) < 0.0
        }
        _ => false,
    })
}

fn pieces<'a>(state: &'a State, fragments: &'a [Fragment]) -> impl Iterator<Item = Piece> + 'a {
    let of_fragments = fragments.iter().map(|fragment| Piece {
        centre_m: fragment.centre_m.into(),
        velocity_m_s: fragment.velocity_m_s.into(),
        mass_kg: fragment.mass_kg,
    });
    let of_clumps = state.clumps.all.iter().map(|clump| Piece {
        centre_m: clump.place_m.into(),
        velocity_m_s: clump.velocity_m_s.into(),
        mass_kg: state.clumps.template(clump).mass_kg,
    });
    of_fragments.chain(of_clumps)
}

/// Whether no outlet contains the centre of a piece on its parabola down to the lowest outlet.
fn falls_past(state: &State, piece: &Piece) -> bool {
    let rules = &state.model.rules;
    let gravity = Vector3::from(state.model.gravity_m_s2);
    let down = gravity.normalize();
    let outlets = || {
        rules
            .outlets
            .iter()
            .map(|outlet| &rules.regions[outlet.region])
    };
    let corners = outlets().flat_map(|region| region.bounds().corners());
    let depths = corners.map(|corner| down.dot(&(Vector3::from(corner) - piece.centre_m)));
    let way_m = depths.fold(0.0, f64::max);
    let (speed, pull) = (piece.velocity_m_s.dot(&down), gravity.norm());
    let time_s = (speed.hypot((2.0 * pull * way_m).sqrt()) - speed) / pull;
    (0..=MOMENTS).all(|at| {
        let t = time_s * f64::from(at) / f64::from(MOMENTS);
        let place = piece.centre_m + t * piece.velocity_m_s + 0.5 * t * t * gravity;
        !outlets().any(|region| region.contains(place.into()))
    })
}
