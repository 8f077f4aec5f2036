//! The mass of bodies in a part of space.

use dem_io::Body;

/// Mass of the parts of the spheres of a body in a box, given by its corners, kg: counted by cubes
/// of a fortieth of each sphere's diameter.
pub(crate) fn mass_in_box_kg(body: &Body, density_kg_m3: f64, [low, high]: [[f64; 3]; 2]) -> f64 {
    mass_within_kg(body, density_kg_m3, |p| {
        (0..3).all(|k| (low[k]..high[k]).contains(&p[k]))
    })
}

/// The same for the points at which `is_in` is true.
pub(crate) fn mass_within_kg(
    body: &Body,
    density_kg_m3: f64,
    is_in: impl Fn([f64; 3]) -> bool,
) -> f64 {
    const STEPS: i32 = 40;
    let middle = |i: i32| (f64::from(2 * i + 1) / f64::from(STEPS)) - 1.0;
    let mut cubes = Vec::new();
    for i in 0..STEPS.pow(3) {
        let p = [i % STEPS, i / STEPS % STEPS, i / STEPS / STEPS].map(middle);
        if p.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
            cubes.push(p);
        }
    }
    let part = |centre: &[f64; 3], radius: f64| {
        let place = |p: &[f64; 3]| [0, 1, 2].map(|k| centre[k] + radius * p[k]);
        cubes.iter().filter(|p| is_in(place(p))).count() as f64 / cubes.len() as f64
    };
    let spheres = body.positions.iter().zip(&body.radii);
    let masses = spheres
        .map(|(p, &r)| part(p, r) * density_kg_m3 * 4.0 / 3.0 * std::f64::consts::PI * r.powi(3));
    masses.sum()
}
