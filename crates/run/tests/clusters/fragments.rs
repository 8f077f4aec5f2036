//! Masses and motion of fragments: sums over the total, and rigid bodies.

use dem_engine::state::clumps::Clumps;
use dem_engine::state::clusters::fragments::{Fragment, mass_fraction_of_largest};
use dem_engine::state::clusters::sizes::{FragmentSize, size_of};
use dem_engine::state::clusters::{Clusters, fragments};
use dem_engine::state::particles::{Particles, Wrench};
use nalgebra::Vector3;
use proptest::prelude::*;

use super::{bonds, chain};

type Vector = Vector3<f64>;

/// Position, velocity, spin, force, radius.
type Sphere = ([f64; 3], [f64; 3], [f64; 3], [f64; 3], f64);

fn sphere() -> impl Strategy<Value = Sphere> {
    let vector = || prop::array::uniform3(-3.0..3.0_f64);
    (vector(), vector(), vector(), vector(), 0.1..1.0_f64)
}

fn particles(spheres: &[Sphere]) -> Particles {
    let mut particles = Particles::default();
    for (place, velocity_m_s, spin_rad_s, force, radius) in spheres {
        particles.push_sphere(*place, *radius, 1000.0);
        let last = particles.len() - 1;
        particles.motions[last].velocity_m_s = *velocity_m_s;
        particles.motions[last].spin_rad_s = *spin_rad_s;
        let mut wrench = Wrench::default();
        wrench.add(&Vector::from(*force), &Vector::zeros());
        particles.wrenches[last] = wrench;
    }
    particles
}

/// Mass, first moment, momentum, angular momentum about the origin, force.
type Sums = (f64, [Vector; 4]);

fn sums_of_spheres(spheres: &[Sphere]) -> Sums {
    let mut mass = 0.0;
    let mut sums = [Vector::zeros(); 4];
    for (place, velocity, spin, force, radius) in spheres {
        let [x, v, w, f] = [place, velocity, spin, force].map(|v| Vector::from(*v));
        let m = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        mass += m;
        sums[0] += m * x;
        sums[1] += m * v;
        sums[2] += m * x.cross(&v) + 0.4 * m * radius * radius * w;
        sums[3] += f;
    }
    (mass, sums)
}

fn sums_of_fragments(fragments: &[Fragment]) -> Sums {
    let mut mass = 0.0;
    let mut sums = [Vector::zeros(); 4];
    for f in fragments {
        let [x, v, l, force] = [
            f.centre_m,
            f.velocity_m_s,
            f.angular_momentum_kg_m2_s,
            f.force_n,
        ]
        .map(Vector::from);
        mass += f.mass_kg;
        sums[0] += f.mass_kg * x;
        sums[1] += f.mass_kg * v;
        sums[2] += f.mass_kg * x.cross(&v) + l;
        sums[3] += force;
    }
    (mass, sums)
}

proptest! {
    #[test]
    fn fragments_add_up_to_the_whole(
        spheres in prop::collection::vec(sphere(), 1..30),
        pairs in prop::collection::vec(prop::array::uniform2(0_u32..30), 0..30),
    ) {
        let count = spheres.len() as u32;
        let bonds = bonds(pairs.into_iter().filter(|[a, b]| *a.max(b) < count));
        let clusters = Clusters::new(spheres.len(), &bonds);
        let particles = particles(&spheres);
        let fragments = fragments(&clusters, &particles, &Clumps::default(), None);
        let (mass, sums) = sums_of_fragments(&fragments);
        let (wanted_mass, wanted) = sums_of_spheres(&spheres);
        prop_assert!((mass / wanted_mass - 1.0).abs() < 1e-13);
        for (sum, wanted) in sums.iter().zip(wanted) {
            prop_assert!((sum - wanted).norm() < 1e-12 * wanted_mass.max(100.0), "{} {}", sum, wanted);
        }
        let largest = fragments.iter().map(|f| f.mass_kg).fold(0.0, f64::max);
        prop_assert!((mass_fraction_of_largest(fragments.iter().map(|f| f.mass_kg)) - largest / mass).abs() < 1e-13);
        for fragment in &fragments {
            let size = size_of(fragment.fragment_id, &clusters, &particles, &Clumps::default());
            prop_assert!((size.mass_kg / fragment.mass_kg - 1.0).abs() < 1e-13);
            prop_assert_eq!(size.equivalent_diameter_m, fragment.equivalent_diameter_m);
            prop_assert!(size.box_lengths_m.is_sorted_by(|a, b| a >= b));
            // No sphere is longer than the box around all.
            let members = clusters.members(fragment.fragment_id).iter();
            let largest = members.map(|i| spheres[*i as usize].4).fold(0.0, f64::max);
            prop_assert!(size.box_lengths_m[2] >= 2.0 * largest - 1e-12);
            prop_assert!(size.sieve_m >= 2.0 * largest - 1e-12);
            prop_assert!(size.sieve_m <= size.box_lengths_m[1] + 1e-12);
            if fragment.particles == 1 {
                let at = clusters.members(fragment.fragment_id)[0] as usize;
                let (place, velocity, spin, force, radius) = spheres[at];
                prop_assert_eq!(fragment.centre_m, place);
                prop_assert!((Vector::from(fragment.velocity_m_s) - Vector::from(velocity)).norm() < 1e-14);
                prop_assert_eq!((fragment.angular_velocity_rad_s, fragment.force_n), (spin, force));
                prop_assert!((fragment.equivalent_diameter_m - 2.0 * radius).abs() < 1e-14);
                prop_assert!((fragment.box_diagonal_m - 2.0 * radius * 3.0_f64.sqrt()).abs() < 1e-13);
            }
        }
    }

    /// Also far from the origin.
    #[test]
    fn a_rigid_body_has_its_own_motion(
        spheres in prop::collection::vec(sphere(), 2..20),
        v in prop::array::uniform3(-3.0..3.0_f64),
        w in prop::array::uniform3(-3.0..3.0_f64),
        far in prop_oneof![Just(0.0), Just(1e4)],
    ) {
        let [v, w] = [v, w].map(Vector::from);
        let rigid: Vec<Sphere> = spheres
            .iter()
            .map(|(place, _, _, force, radius)| {
                let velocity = v + w.cross(&Vector::from(*place));
                let place = place.map(|x| x + far);
                (place, velocity.into(), w.into(), *force, *radius)
            })
            .collect();
        let bonds = bonds(chain(0, rigid.len() as u32));
        let clusters = Clusters::new(rigid.len(), &bonds);
        let particles = particles(&rigid);
        let found = fragments(&clusters, &particles, &Clumps::default(), None)[0];
        prop_assert!((Vector::from(found.angular_velocity_rad_s) - w).norm() < 1e-8);
        let centre = Vector::from(found.centre_m).add_scalar(-far);
        prop_assert!((Vector::from(found.velocity_m_s) - v - w.cross(&centre)).norm() < 1e-8);
    }
}

#[test]
fn sizes_of_equal_fragments_are_one_point() {
    let at = |x: f64, radius: f64| ([x, 0.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3], radius);
    let spheres = [
        at(0.0, 1.0),
        at(5.0, 1.0),
        at(10.0, 1.0),
        at(12.0, 1.0),
        at(20.0, 2.0),
    ];
    let clusters = Clusters::new(5, &bonds([[2, 3]]));
    let particles = particles(&spheres);
    let fragments = fragments(&clusters, &particles, &Clumps::default(), None);
    // Masses 1, 1, 2, 8 of 12; the pair is 4 long and 2 across.
    let sizes: Vec<FragmentSize> = clusters
        .living()
        .map(|id| size_of(id, &clusters, &particles, &Clumps::default()))
        .collect();
    let wanted = [
        (2.0, [2.0; 3]),
        (2.0, [2.0; 3]),
        (2.0 * 2.0_f64.cbrt(), [4.0, 2.0, 2.0]),
        (4.0, [4.0; 3]),
    ];
    assert_eq!(sizes.len(), 4);
    for (found, (diameter_m, box_m)) in sizes.iter().zip(wanted) {
        assert!((found.equivalent_diameter_m - diameter_m).abs() < 1e-13);
        for (found, wanted) in found.box_lengths_m.iter().zip(box_m) {
            assert!((found - wanted).abs() < 1e-13, "{found} {wanted}");
        }
    }
    assert!(
        (mass_fraction_of_largest(fragments.iter().map(|f| f.mass_kg)) - 8.0 / 12.0).abs() < 1e-13
    );
    // From 9 to 13 in length, 2 across.
    assert!((fragments[2].box_diagonal_m - 24.0_f64.sqrt()).abs() < 1e-13);
    assert_eq!(mass_fraction_of_largest(std::iter::empty()), 0.0);
}
