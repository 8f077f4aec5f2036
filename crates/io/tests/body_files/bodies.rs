//! Bodies for the tests.

use dem_io::Body;
use dem_io::body::About;
use proptest::prelude::*;

/// A small body with all information on its origin.
pub(crate) fn triangle() -> Body {
    Body {
        positions: vec![[0.0; 3], [1e-3, 0.0, 0.0], [-0.0, 1e-3, 1e-4]],
        radii: vec![6e-4, 5e-4, 7e-4],
        bonds: vec![[0, 1], [0, 2]],
        bond_radii: vec![4e-4, 3e-4],
        bond_lengths: vec![1e-3, 1.1e-3],
        bond_damages: Vec::new(),
        turns_rad: Vec::new(),
        bond_directions: Vec::new(),
        bond_histories: Vec::new(),
        about: About {
            program: Some("dem-pack 0.1.0".to_owned()),
            source: Some("Käse & \"Kuchen\" <1>.stl".to_owned()),
            source_hash: Some(u64::MAX),
            shape_volume_m3: Some(1.0 / 3.0),
            particle_density_kg_m3: Some(2050.0),
            overlap: Some(0.25),
            bond_range: Some(1.1),
            seed: Some(7),
            thinnest_part_m: Some(0.1),
            particles_across: Some(4.9),
            warnings: vec!["few – 4.9 – bonds".to_owned(), "2 pieces".to_owned()],
        },
    }
}

/// Every bit of a body except the information on its origin.
pub(crate) fn bits(body: &Body) -> Vec<Vec<u64>> {
    let all = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect();
    vec![
        all(body.positions.as_flattened()),
        all(&body.radii),
        body.bonds
            .iter()
            .map(|[a, b]| u64::from(*a) << 32 | u64::from(*b))
            .collect(),
        all(&body.bond_radii),
        all(&body.bond_lengths),
    ]
}

/// The same body as read from a format that stores only the ends of bonds.
pub(crate) fn with_derived_bonds(mut body: Body) -> Body {
    let radius = |particle: u32| body.radii[particle as usize];
    body.bond_radii = body
        .bonds
        .iter()
        .map(|&[a, b]| radius(a).min(radius(b)))
        .collect();
    let distance = |&[a, b]: &[u32; 2]| {
        let [p, q] = [body.positions[a as usize], body.positions[b as usize]];
        let [x, y, z] = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        (x * x + y * y + z * z).sqrt()
    };
    body.bond_lengths = body.bonds.iter().map(distance).collect();
    body
}

/// Bodies with any valid numbers.
pub(crate) fn any_body() -> impl Strategy<Value = Body> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let coordinate = NORMAL | SUBNORMAL | ZERO | POSITIVE | NEGATIVE;
    body_of(coordinate, NORMAL | SUBNORMAL | POSITIVE)
}

/// Bodies of realistic size.
pub(crate) fn usual_body() -> impl Strategy<Value = Body> {
    body_of(-1e3..1e3, 1e-9..1e3)
}

fn body_of(
    coordinate: impl Strategy<Value = f64> + Clone,
    size: impl Strategy<Value = f64> + Clone,
) -> impl Strategy<Value = Body> {
    (1_usize..12).prop_flat_map(move |particles| {
        let pairs: Vec<[u32; 2]> = (0..particles as u32)
            .flat_map(|b| (0..b).map(move |a| [a, b]))
            .collect();
        let count = pairs.len();
        let bonds = proptest::sample::subsequence(pairs, 0..=count).prop_shuffle();
        let positions = prop::collection::vec(prop::array::uniform3(coordinate.clone()), particles);
        let radii = prop::collection::vec(size.clone(), particles);
        let size = size.clone();
        (positions, radii, bonds, any_about()).prop_flat_map(
            move |(positions, radii, bonds, about)| {
                let sizes = prop::collection::vec(size.clone(), 2 * bonds.len());
                sizes.prop_map(move |sizes| Body {
                    positions: positions.clone(),
                    radii: radii.clone(),
                    bonds: bonds.clone(),
                    bond_radii: sizes[..bonds.len()].to_vec(),
                    bond_lengths: sizes[bonds.len()..].to_vec(),
                    bond_damages: Vec::new(),
                    turns_rad: Vec::new(),
                    bond_directions: Vec::new(),
                    bond_histories: Vec::new(),
                    about: about.clone(),
                })
            },
        )
    })
}

fn any_about() -> impl Strategy<Value = About> {
    use prop::option::of;
    let text = "[^\\x00]{0,12}";
    let positive = || of(prop::num::f64::NORMAL | prop::num::f64::POSITIVE);
    (
        of(text),
        of(text),
        of(any::<u64>()),
        positive(),
        positive(),
        of(0.0..1.0),
        positive(),
        of(any::<u64>()),
        positive(),
        positive(),
        prop::collection::vec("[^\\x00-\\x1f\\x7f-\\x9f]{1,12}", 0..3),
    )
        .prop_map(
            |(
                program,
                source,
                source_hash,
                volume,
                density,
                overlap,
                bond_range,
                seed,
                thinnest_part_m,
                particles_across,
                warnings,
            )| {
                About {
                    program,
                    source,
                    source_hash,
                    shape_volume_m3: volume,
                    particle_density_kg_m3: density,
                    overlap,
                    bond_range,
                    seed,
                    thinnest_part_m,
                    particles_across,
                    warnings,
                }
            },
        )
}
