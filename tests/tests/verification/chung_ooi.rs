//! The eight tests of Chung and Ooi 2011.

mod impact;
mod published;

use self::impact::{Ball, Impact, Material};
use super::page::{assert_shown, filled, on_one_thread};
use super::table::{Case, compared, digits, head, row};

const fn material(name: &'static str, density_kg_m3: f64, young_pa: f64, poisson: f64) -> Material {
    Material {
        name,
        density_kg_m3,
        young_pa,
        poisson,
    }
}

const GLASS: Material = material("glass", 2800.0, 48e9, 0.2);
const LIMESTONE: Material = material("limestone", 2500.0, 20e9, 0.25);
const SOFT_ALLOY: Material = material("aluminium alloy", 2699.0, 70e9, 0.3);
const MAGNESIUM: Material = material("magnesium alloy", 1800.0, 40e9, 0.35);
const OXIDE: Material = material("aluminium oxide", 4000.0, 380e9, 0.23);
const IRON: Material = material("cast iron", 7000.0, 100e9, 0.25);
const ALLOY: Material = material("aluminium alloy", 2700.0, 70e9, 0.33);
const STEEL: Material = material("steel", 7850.0, 208e9, 0.3);

/// A ball of this material that falls on a rigid wall.
const fn falling(material: Material, radius_m: f64, speed_m_s: f64) -> Impact {
    Impact {
        ball: Ball { material, radius_m },
        other: None,
        restitution: 1.0,
        friction: 0.0,
        speeds_m_s: [speed_m_s, 0.0],
        across_m_s: 0.0,
        spins_rad_s: [0.0; 2],
    }
}

/// Tests 1 and 2: largest force, largest overlap, duration and speed after elastic impacts.
fn elastic(impacts: &[Impact]) -> String {
    let mut cases = Vec::new();
    for impact in impacts {
        let found = impact.run();
        let speed = impact.speed_m_s();
        // Leapfrog is of second order, with the duration as half a period.
        let bound = (std::f64::consts::PI / impact::STEPS).powi(2);
        for (what, found, wanted) in [
            (
                "largest force, kN",
                1e-3 * found.force_n,
                1e-3 * impact.force_n(),
            ),
            (
                "largest overlap, um",
                1e6 * found.overlap_m,
                1e6 * impact.overlap_m(),
            ),
            (
                "duration, us",
                1e6 * found.duration_s,
                1e6 * impact.duration_s(),
            ),
            ("speed after it, m/s", found.apart_m_s, speed),
        ] {
            let name = format!("{}: {what}", impact.ball.material.name);
            cases.push(Case::new(name, found, wanted, bound));
        }
    }
    compared("impact", "", &cases)
}

fn test_1() -> String {
    elastic(&[GLASS, LIMESTONE].map(|of| Impact {
        other: Some(Ball {
            material: of,
            radius_m: 0.01,
        }),
        speeds_m_s: [10.0; 2],
        ..falling(of, 0.01, 10.0)
    }))
}

fn test_2() -> String {
    elastic(&[SOFT_ALLOY, MAGNESIUM].map(|of| falling(of, 0.1, 0.2)))
}

/// Restitution of the impact over the given one.
fn test_3() -> String {
    let mut cases = Vec::new();
    for of in [OXIDE, IRON] {
        for restitution in [0.2, 0.4, 0.6, 0.8, 1.0] {
            let impact = Impact {
                restitution,
                ..falling(of, 0.0025, 3.9)
            };
            let found = impact.run().apart_m_s / impact.speed_m_s();
            cases.push(Case::new(of.name, found, restitution, impact.bound()));
        }
    }
    compared("ball", "", &cases)
}

/// Test 4: a ball that hits the wall at this angle to its normal.
fn oblique(of: Material, angle_deg: f64) -> Impact {
    let (sine, cosine) = angle_deg.to_radians().sin_cos();
    Impact {
        restitution: 0.98,
        friction: 0.092,
        across_m_s: 3.9 * sine,
        ..falling(of, 0.0025, 3.9 * cosine)
    }
}

/// Velocities along x and spins after an impact, by the solver and by the reference, what the
/// reference is, and the bounds of their errors: of velocities over the slip before the impact, of
/// the ball's surface over the same.
struct Compared {
    found: [[f64; 2]; 2],
    wanted: [[f64; 2]; 2],
    by: &'static str,
    bounds: [f64; 2],
}

fn beside_reference(impact: &Impact) -> Compared {
    let found = impact.run();
    let (by, wanted, lever) = if impact.slides() {
        (
            "slides: closed form",
            impact.after_sliding(),
            impact.lever_error(),
        )
    } else {
        ("sticks: integrated", impact.integrated(), 0.0)
    };
    Compared {
        found: [found.across_m_s, found.spins_rad_s],
        wanted,
        by,
        bounds: [impact.bound(), impact.bound() + lever],
    }
}

/// Angles of test 4, degrees.
const ANGLES_DEG: [f64; 9] = [5.0, 10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 80.0];

/// Tangential restitution and spin after the impact.
fn test_4() -> [String; 2] {
    let mut tables = [Vec::new(), Vec::new()];
    for of in [OXIDE, ALLOY] {
        for angle in ANGLES_DEG {
            let impact = oblique(of, angle);
            let is = beside_reference(&impact);
            let what = format!("{}, {angle}°, {}", of.name, is.by);
            let across = impact.across_m_s;
            let [found, wanted] = [is.found, is.wanted].map(|of| of[0][0] / across);
            tables[0].push(Case::of_scale(
                what.clone(),
                [found, wanted],
                1.0,
                is.bounds[0],
            ));
            // Relative to the spin that stopping the ball would give.
            let scale = 2.5 * across / impact.ball.radius_m;
            let [found, wanted] = [is.found, is.wanted].map(|of| of[1][0]);
            tables[1].push(Case::of_scale(what, [found, wanted], scale, is.bounds[1]));
        }
    }
    let [velocities, spins] = tables;
    [
        compared("ball, angle to the normal", "", &velocities),
        compared("ball, angle to the normal", "rad/s", &spins),
    ]
}

/// Rebound of a ball of test 4: spin, rad/s, and angle of its surface to the normal, degrees.
fn rebound(of: Material, angle_deg: f64) -> [f64; 2] {
    let impact = oblique(of, angle_deg);
    let found = impact.run();
    let slip = impact.slip_m_s(found.across_m_s, found.spins_rad_s);
    [
        found.spins_rad_s[0].abs(),
        (slip / found.apart_m_s).atan().to_degrees(),
    ]
}

/// Root of the mean square of differences, over the largest magnitude of the second numbers, in per
/// cent.
fn apart_percent(pairs: &[[f64; 2]]) -> String {
    let square: f64 = pairs.iter().map(|[a, b]| (a - b).powi(2)).sum();
    let largest = pairs.iter().map(|[_, b]| b.abs()).fold(0.0, f64::max);
    digits(
        100.0 * (square / pairs.len() as f64).sqrt() / largest,
        1,
        1e-9,
    )
}

/// Computed and published numbers at the published places, and how far they are apart.
fn beside(
    heads: [&str; 4],
    decimals: usize,
    published: &[[f64; 2]],
    computed: impl Fn(f64) -> f64,
) -> String {
    let pairs: Vec<[f64; 2]> = published
        .iter()
        .map(|&[at, by]| [computed(at), by])
        .collect();
    let number = |value: f64| digits(value, decimals, 1e-9 * value.abs());
    let rows = published
        .iter()
        .zip(&pairs)
        .map(|([at, _], [here, by_others])| {
            let numbers = [*here, *by_others, here - by_others].map(number);
            [&[digits(*at, 2, 0.0)], &numbers[..]].concat()
        });
    let last = [
        "root mean square, % of the largest",
        "",
        "",
        &apart_percent(&pairs),
    ];
    let last = last.map(str::to_owned).to_vec();
    rows.chain([last])
        .fold(head(&heads), |table, cells| table + &row(&cells))
}

/// The value of a published curve between its points.
fn between(curve: &[[f64; 2]], at: f64) -> f64 {
    let next = curve
        .partition_point(|[x, _]| *x < at)
        .clamp(1, curve.len() - 1);
    let [[x, y], [next_x, next_y]] = [curve[next - 1], curve[next]];
    y + (next_y - y) * (at - x) / (next_x - x)
}

fn test_4_measured() -> [String; 2] {
    let of = |k: usize| move |angle: f64| rebound(OXIDE, angle)[k];
    let heads = |what| ["angle to the normal, °", what, "measured", "difference"];
    [
        beside(
            heads("computed, rad/s"),
            0,
            &published::SPINS_MEASURED_RAD_S,
            of(0),
        ),
        beside(
            heads("computed, °"),
            1,
            &published::ANGLES_MEASURED_DEG,
            of(1),
        ),
    ]
}

fn test_4_published() -> String {
    let heads = [
        "angle to the normal, °",
        "computed",
        "Chung and Ooi",
        "difference",
    ];
    beside(heads, 3, &published::TANGENTIAL_RESTITUTION, |angle| {
        let impact = oblique(OXIDE, angle);
        impact.run().across_m_s[0] / impact.across_m_s
    })
}

/// Test 5: a small ball at the ratio of tangential to normal velocity over friction.
fn at_ratio(ratio: f64) -> Impact {
    Impact {
        friction: 0.3,
        across_m_s: ratio * 0.3 * 5.0,
        ..falling(STEEL, 1e-5, 5.0)
    }
}

/// Slip and surface speed of the spin after test 5, over friction and normal speed.
fn test_5() -> [String; 2] {
    let mut tables = [Vec::new(), Vec::new()];
    for ratio in [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 13.0] {
        let impact = at_ratio(ratio);
        let is = beside_reference(&impact);
        let unit = impact.friction * impact.speed_m_s();
        let what = format!("{ratio}, {}", is.by);
        let [slip, wanted_slip] =
            [is.found, is.wanted].map(|[across, spins]| impact.slip_m_s(across, spins) / unit);
        let [spin, wanted_spin] =
            [is.found, is.wanted].map(|of| impact.ball.radius_m * of[1][0] / unit);
        // The slip follows from both: 7/2 of the error of the velocity.
        let bound = 3.5 * is.bounds[1];
        tables[0].push(Case::of_scale(
            what.clone(),
            [slip, wanted_slip],
            ratio,
            bound,
        ));
        tables[1].push(Case::of_scale(
            what,
            [spin, wanted_spin],
            2.5 * ratio,
            is.bounds[1],
        ));
    }
    let of = "tangential over normal velocity and friction";
    tables.map(|table| compared(of, "", &table))
}

/// The slip beside finite elements, and how far Chung and Ooi's program is from them.
fn test_5_published() -> [String; 2] {
    let heads = [
        "tangential over normal velocity and friction",
        "computed",
        "finite elements",
        "difference",
    ];
    let table = beside(heads, 2, &published::SLIP_ELEMENTS, |ratio| {
        let impact = at_ratio(ratio);
        let found = impact.run();
        let slip = impact.slip_m_s(found.across_m_s, found.spins_rad_s);
        slip / (impact.friction * found.apart_m_s)
    });
    let theirs = published::SLIP_ELEMENTS.map(|[at, of]| [between(&published::SLIP_STEEL, at), of]);
    [table, apart_percent(&theirs)]
}

/// Test 6: a ball that spins such that its surface has the tangent of this angle times the normal
/// velocity.
fn spinning(angle_deg: f64) -> Impact {
    let surface_m_s = 0.2 * angle_deg.to_radians().tan();
    Impact {
        restitution: 0.5,
        friction: 0.4,
        spins_rad_s: [-surface_m_s / 0.1, 0.0],
        ..falling(ALLOY, 0.1, 0.2)
    }
}

/// Test 8: the same on a ball at rest, five times as large, of a material that is this many times
/// as dense and stiff.
fn on_larger(angle_deg: f64, times: f64) -> Impact {
    let Material {
        density_kg_m3,
        young_pa,
        ..
    } = ALLOY;
    Impact {
        other: Some(Ball {
            material: Material {
                density_kg_m3: times * density_kg_m3,
                young_pa: times * young_pa,
                ..ALLOY
            },
            radius_m: 0.5,
        }),
        ..spinning(angle_deg)
    }
}

/// Tangential restitution of the surfaces: slip after the impact over slip before it, negative
/// where it keeps its direction.
fn surface_restitution(impact: &Impact, [across, spins]: [[f64; 2]; 2]) -> f64 {
    -impact.slip_m_s(across, spins) / impact.slip_before_m_s()
}

fn of_surfaces(impacts: &[(String, Impact)]) -> String {
    let cases = impacts.iter().map(|(name, impact)| {
        let is = beside_reference(impact);
        let values = [is.found, is.wanted].map(|of| surface_restitution(impact, of));
        let what = format!("{name}, {}", is.by);
        Case::of_scale(what, values, 1.0, 3.5 * is.bounds[1])
    });
    compared("angle of the surface", "", &cases.collect::<Vec<_>>())
}

const SURFACE_ANGLES_DEG: [f64; 8] = [10.0, 30.0, 45.0, 55.0, 60.0, 65.0, 75.0, 85.0];

fn test_6() -> String {
    of_surfaces(&SURFACE_ANGLES_DEG.map(|angle| (format!("{angle}°"), spinning(angle))))
}

/// The angle at which 7/2 of friction, 1 + e and normal over surface velocity has this value.
fn angle_of_deg(quantity: f64) -> f64 {
    (3.5 * 0.4 * 1.5 / quantity).atan().to_degrees()
}

fn test_6_published() -> String {
    let heads = [
        "7/2 mu (1 + e) v_n/v_s",
        "computed",
        "Chung and Ooi",
        "difference",
    ];
    beside(heads, 3, &published::SURFACE_RESTITUTION, |quantity| {
        let impact = spinning(angle_of_deg(quantity));
        let found = impact.run();
        surface_restitution(&impact, [found.across_m_s, found.spins_rad_s])
    })
}

/// Two equal balls whose spins are opposite: their surfaces do not slide on each other.
fn test_7() -> String {
    let mut cases = Vec::new();
    for spin in [0.1, 1.0, 5.0, 24.0] {
        let impact = Impact {
            other: Some(Ball {
                material: ALLOY,
                radius_m: 0.1,
            }),
            speeds_m_s: [0.2; 2],
            spins_rad_s: [spin, -spin],
            ..spinning(0.0)
        };
        let found = impact.run();
        cases.push(Case::new(
            format!("{spin} rad/s: spin after it, rad/s"),
            found.spins_rad_s[0],
            spin,
            1e-9,
        ));
        let surface = spin * impact.ball.radius_m;
        let what = format!("{spin} rad/s: velocity across the normal, m/s");
        cases.push(Case::of_scale(
            what,
            [found.across_m_s[0], 0.0],
            surface,
            1e-9,
        ));
    }
    compared("spin before the impact", "", &cases)
}

fn test_8() -> String {
    let mut impacts = Vec::new();
    for (name, times) in [("alloy", 1.0), ("1000 times as dense and stiff", 1000.0)] {
        for angle in SURFACE_ANGLES_DEG {
            impacts.push((format!("{name}, {angle}°"), on_larger(angle, times)));
        }
    }
    of_surfaces(&impacts)
}

/// The page of Chung and Ooi 2011 equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [velocities, spins] = test_4();
        let [measured_spins, measured_angles] = test_4_measured();
        let [slips, surface_speeds] = test_5();
        let [slips_of_elements, slips_of_others] = test_5_published();
        filled(
            include_str!("chung-ooi.md"),
            &[
                ("test 1", test_1()),
                ("test 2", test_2()),
                ("test 3", test_3()),
                ("test 4 velocities", velocities),
                ("test 4 spins", spins),
                ("test 4 measured spins", measured_spins),
                ("test 4 measured angles", measured_angles),
                ("test 4 published", test_4_published()),
                ("test 5 slips", slips),
                ("test 5 spins", surface_speeds),
                ("test 5 elements", slips_of_elements),
                ("test 5 others", slips_of_others),
                ("test 6", test_6()),
                ("test 6 published", test_6_published()),
                ("test 7", test_7()),
                ("test 8", test_8()),
            ],
        )
    });
    assert_shown(&[("chung-ooi.md".to_owned(), page)]);
}
