//! doc/inside/round-robin.md: silo, drum and penetration of the round robin of Dosta et al. 2024
//! beside closed forms and numbers of others.

use dem_plots::{Line, Plot};
use std::f64::consts::PI;

use dem_laboratory::Line as Fit;

use crate::bench::{Bench, Failed, Run, sets};
use crate::cells::{change, ends, mean, mean_and_range};
use crate::plots::draw;
use crate::table::{Table, write};

const GRAVITY_M_S2: f64 = 9.81;

pub(crate) fn tables() -> [Table; 4] {
    let of = |words, head, first_cells: Vec<&'static str>| {
        Table::new("doc/inside/round-robin.md", words, head, first_cells)
    };
    let silo = "floor | spheres | hole | hole over diameter | spheres per second | Beverloo | off";
    let bed = " | here | reference";
    let penetration = "spheres | speed | bed | bulk density | depth | Uehara et al. 2003 | \
        Katsuragi and Durian 2013 | time to 99 % of the depth | by their law | \
        displacement of the ball";
    let drum = "round-robin drum";
    let silos = SILOS.map(|silo| silo.floor).into();
    let balls = CASES.map(|case| case.spheres).into();
    [
        of("round-robin silo", silo, silos),
        of(drum, "power |  | off", POWERS.into()),
        of(drum, bed, BED.into()),
        of("round-robin penetration", penetration, balls),
    ]
}

/// Runs a scene with these `--set` values.
fn run(bench: &Bench, scene: &str, name: &str, set: &[String]) -> Result<Run, Failed> {
    let path = format!("data/scenes/{scene}.toml");
    bench.run(&format!("{scene}-{name}"), &path, &sets(set))
}

/// Times and values of a column of the time series between two times.
fn column(run: &Run, name: &str, [from_s, to_s]: [f64; 2]) -> Result<[Vec<f64>; 2], Failed> {
    let rows = run.columns("series.csv", ["time_s", name])?;
    let rows = rows.iter().filter(|[t, _]| (from_s..=to_s).contains(t));
    let (times, values) = rows.map(|[t, value]| (*t, *value)).unzip();
    Ok([times, values])
}

/// Slope of a straight line through a column of the time series between two times.
fn slope(run: &Run, name: &str, between_s: [f64; 2]) -> Result<f64, Failed> {
    let [times, values] = column(run, name, between_s)?;
    Ok(Fit::fitted(&times, &values).slope)
}

/// Mass flow of Beverloo et al. 1961 through a round hole, kg/s, of spheres.
fn beverloo_kg_s(bulk_kg_m3: f64, hole_m: f64, diameter_m: f64) -> f64 {
    0.58 * bulk_kg_m3 * GRAVITY_M_S2.sqrt() * (hole_m - 1.4 * diameter_m).powf(2.5)
}

/// Solid fraction of the bed of a silo.
const SOLID: f64 = 0.6;

/// A silo, and the flow out of it.
struct Silo {
    floor: &'static str,
    material: &'static str,
    density_kg_m3: f64,
    hole_m: f64,
    bead_m: f64,
    /// Spheres per second of others: the mean of eight programs for the larger hole, and MUSEN and
    /// LIGGGHTS for the smaller one.
    of_others_1_s: Option<f64>,
}

const fn silo_of(floor: &'static str, hole_m: f64, bead_m: f64) -> Silo {
    Silo {
        floor,
        material: "M1",
        density_kg_m3: 2500.0,
        hole_m,
        bead_m,
        of_others_1_s: None,
    }
}

/// On a flat floor (`silo-round-robin.toml`), and that of the paper (`silo-cone.toml`), which has
/// spheres of 4 mm.
const SILOS: [Silo; 7] = [
    silo_of("flat", 0.018, 4e-3),
    silo_of("flat", 0.022, 4e-3),
    Silo {
        material: "M2",
        density_kg_m3: 2000.0,
        ..silo_of("flat", 0.022, 4e-3)
    },
    silo_of("cone", 0.060, 8e-3),
    silo_of("cone", 0.060, 6e-3),
    Silo {
        of_others_1_s: Some(23_200.0),
        ..silo_of("cone, by others", 0.060, 4e-3)
    },
    Silo {
        of_others_1_s: Some(7_700.0),
        ..silo_of("cone, by others", 0.040, 4e-3)
    },
];

impl Silo {
    fn bead_kg(&self) -> f64 {
        self.density_kg_m3 * PI / 6.0 * self.bead_m.powi(3)
    }

    /// Runs its scene with this seed. Returns the spheres that flow out per second.
    fn run(&self, bench: &Bench, number: usize, seed: u32) -> Result<f64, Failed> {
        let (scene, plate, between_s) = match self.floor {
            "flat" => ("silo-round-robin", "floor", [0.45, 0.75]),
            _ => ("silo-cone", "cone", [1.0, 1.4]),
        };
        let mut set = vec![
            format!("run.seed={seed}"),
            format!("bodies.bead.material={}", self.material.to_lowercase()),
            format!("walls.{plate}.scale={:.2}", 100.0 * self.hole_m),
        ];
        if plate == "cone" {
            let count = 1e5 * (4e-3 / self.bead_m).powi(3);
            set.extend([
                format!("bodies.bead.particles=[[0,0,0,{}]]", 0.5 * self.bead_m),
                format!("inlets.fill.count={count:.0}"),
            ]);
        } else {
            let opens = "walls.slide.table=[[\"0.3 s\",0],[\"0.35 s\",1]]";
            let ends = "run.end_time=\"0.75 s\"";
            set.extend([opens, ends, "inlets.fill.count=1200"].map(str::to_owned));
        }
        let run = run(bench, scene, &format!("{number}-{seed}"), &set)?;
        Ok(-slope(&run, "mass_inside_kg", between_s)? / self.bead_kg())
    }
}

pub(crate) fn silo(bench: &Bench) -> Result<(), Failed> {
    let [mut table, ..] = tables();
    for (number, silo) in SILOS.iter().enumerate() {
        let seeds = if silo.floor == "flat" { 1..=5 } else { 1..=1 };
        let of_seeds = seeds.map(|seed| match silo.of_others_1_s {
            Some(per_s) => Ok(per_s),
            None => silo.run(bench, number, seed),
        });
        let of_seeds: Vec<f64> = of_seeds.collect::<Result<_, Failed>>()?;
        let bulk_kg_m3 = SOLID * silo.density_kg_m3;
        let law_kg_s = beverloo_kg_s(bulk_kg_m3, silo.hole_m, silo.bead_m);
        let law_1_s = law_kg_s / silo.bead_kg();
        table.row([
            format!("{} of {:.0} mm", silo.material, 1e3 * silo.bead_m),
            format!("{:.0} mm", 1e3 * silo.hole_m),
            format!("{:.1}", silo.hole_m / silo.bead_m),
            mean_and_range(&of_seeds, "", 0),
            format!("{law_1_s:.0}"),
            change(mean(&of_seeds) / law_1_s - 1.0, 0),
        ]);
    }
    write(&[table])
}

/// Angular velocity of the drum, rad/s, the height of its axis, m, and when its bed is steady, s.
const TURNS_1_S: f64 = 2.0;
const AXIS_M: f64 = 0.2;
const STEADY_S: [f64; 2] = [1.6, 5.6];
/// Masses of M1 and of all spheres of drum.toml, kg.
const SMALL_KG: f64 = PI / 6.0 * 1111.0 * 2500.0 * 216e-9;
const DRUM_KG: f64 = PI / 6.0 * (1111.0 * 2500.0 * 216e-9 + 296.0 * 2000.0 * 1728e-9);

/// Rows of its two tables.
const POWERS: [&str; 5] = [
    "work of the drum on the spheres, booked",
    "torque on the drum times 2 rad/s",
    "weight times the offset of its centre times 2 rad/s",
    "dissipated by contacts and friction",
    "the same and what the spheres keep",
];
const BED: [&str; 8] = [
    "direction of the centre of mass, from the vertical",
    "the same without the torque of the end plates",
    "M1 in zone 2, least and most",
    "time between its first two maxima",
    "Lacey's index 0 s after the start",
    "Lacey's index 1 s after the start",
    "Lacey's index 3 s after the start",
    "Lacey's index 5 s after the start",
];
/// The drum turns from this time on, s.
const TURNS_FROM_S: f64 = 0.6;

pub(crate) fn drum(bench: &Bench) -> Result<(), Failed> {
    let [_, mut power, mut bed, _] = tables();
    let run = run(bench, "drum", "5 s", &["run.end_time=\"5.6 s\"".to_owned()])?;
    let rate = |name: &str| slope(&run, name, STEADY_S);
    let mean = |name: &str| Ok::<_, Failed>(mean(&column(&run, name, STEADY_S)?[1]));
    let mut booked_w = 0.0;
    for wall in ["drum", "front", "back"] {
        booked_w += rate(&format!("wall_{wall}_work_j"))?;
    }
    let torque = |name: &str| Ok::<f64, Failed>(mean(name)?.abs());
    let ends_n_m = torque("torque_front_n_m")? + torque("torque_back_n_m")?;
    let torque_n_m = torque("torque_n_m")? + ends_n_m;
    let (x_m, z_m) = (mean("bed_x_m")?, mean("bed_z_m")? - AXIS_M);
    let lost_w = rate("contact_damping_j")? + rate("friction_j")?;
    let kept_w = rate("kinetic_energy_j")? + rate("elastic_energy_j")? + rate("gravity_energy_j")?;
    let weight_w = DRUM_KG * GRAVITY_M_S2 * x_m * TURNS_1_S;
    for power_w in [
        booked_w,
        torque_n_m * TURNS_1_S,
        weight_w,
        lost_w,
        lost_w + kept_w,
    ] {
        let off = change(power_w / booked_w - 1.0, 2);
        power.row([format!("{:.2} mW", 1e3 * power_w), off]);
    }

    let angle = |x_m: f64| format!("{:.1} degrees", x_m.atan2(-z_m).to_degrees());
    let small = turning(&run, "small_in_zone_2_kg")?;
    let shares: Vec<f64> = small
        .iter()
        .map(|[_, mass]| 100.0 * mass / SMALL_KG)
        .collect();
    let [least, most] = ends(&shares);
    let period =
        period_s(&small).map_or("not seen".to_owned(), |period_s| format!("{period_s:.1} s"));
    for (here, reference) in [
        (angle(x_m), ""),
        (
            angle(x_m * (1.0 - ends_n_m / torque_n_m)),
            "20.9 to 32.8 degrees (Jop et al. 2006)",
        ),
        (
            format!("{least:.0} % and {most:.0} %"),
            "0 and 77 % (MUSEN, LIGGGHTS)",
        ),
        (period, "about 2 s (MUSEN, LIGGGHTS)"),
    ] {
        bed.row([here, reference.to_owned()]);
    }
    let mixing = run.columns("series.csv", ["time_s", "mixing_index"])?;
    for since_s in [0.0, 1.0, 3.0, 5.0] {
        let until_s = TURNS_FROM_S + since_s + 1e-9;
        let at = mixing.iter().rfind(|[t, _]| *t <= until_s);
        let index = at.map_or(String::new(), |[_, index]| format!("{index:.2}"));
        bed.row([index, "0 apart, 1 mixed at random".to_owned()]);
    }
    let large = turning(&run, "large_in_zone_2_kg")?;
    let lines = vec![Line::new("M1", small), Line::new("M2", large)];
    let title = "mass in the lower quarter on the sinking side";
    let plot = Plot::of(
        title,
        "time since the start of the drum (s)",
        "mass (kg)",
        lines,
    );
    draw("doc/inside/round-robin-drum.svg", &plot)?;
    write(&[power, bed])
}

/// Times since the start of the drum, s, and values of a column of its time series.
fn turning(run: &Run, name: &str) -> Result<Vec<[f64; 2]>, Failed> {
    let rows = run.columns("series.csv", ["time_s", name])?;
    let rows = rows.into_iter().filter(|[t, _]| *t >= TURNS_FROM_S);
    Ok(rows.map(|[t, value]| [t - TURNS_FROM_S, value]).collect())
}

/// Time between the first two maxima of a curve: each is the largest value between two falls below
/// half of the largest of all.
fn period_s(curve: &[[f64; 2]]) -> Option<f64> {
    let largest = curve.iter().map(|[_, y]| *y).fold(0.0, f64::max);
    let mut high = curve.split(|[_, y]| *y < 0.5 * largest);
    let mut next = || {
        let part = high.find(|part| !part.is_empty())?;
        part.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1]))
    };
    let [first, second] = [next()?, next()?];
    Some(second[0] - first[0])
}

/// Radius of the ball, m, and the height of its centre at which it has its speed.
const BALL_M: f64 = 10e-3;
const FROM_M: f64 = 0.15;
/// Friction of a bed of smooth spheres, tan 20.9 degrees (Jop et al. 2006).
const BED_FRICTION: f64 = 0.38;

/// Depth by the law of Uehara et al. 2003, m.
fn uehara_m(bulk_kg_m3: f64, fall_m: f64) -> f64 {
    let ratio = (7200.0 / bulk_kg_m3).sqrt();
    0.14 / BED_FRICTION * ratio * (2.0 * BALL_M).powf(2.0 / 3.0) * fall_m.cbrt()
}

/// The way of the ball into the bed by the law of Katsuragi and Durian 2013: time since its lowest
/// point touches the surface, s, and depth of that point, m, until it stops. The force on it is
/// m v²/d_1 + k z, with d_1 = 0.25/mu rho_b/rho D and k = 12 mu (rho/rho_b)^(1/2) m g/D.
fn katsuragi_durian(bulk_kg_m3: f64, impact_m_s: f64) -> Vec<[f64; 2]> {
    const STEP_S: f64 = 1e-6;
    let density_ratio = 7200.0 / bulk_kg_m3;
    let drag_length_m = 0.25 / BED_FRICTION * density_ratio * 2.0 * BALL_M;
    let stiffness_1_s2 = 12.0 * BED_FRICTION / density_ratio.sqrt() * GRAVITY_M_S2 / (2.0 * BALL_M);
    let mut way = vec![[0.0, 0.0]];
    let (mut time_s, mut depth_m, mut speed_m_s) = (0.0, 0.0, impact_m_s);
    while speed_m_s > 0.0 {
        let drag_m_s2 = speed_m_s * speed_m_s / drag_length_m;
        speed_m_s += (GRAVITY_M_S2 - drag_m_s2 - stiffness_1_s2 * depth_m) * STEP_S;
        depth_m += speed_m_s * STEP_S;
        time_s += STEP_S;
        way.push([time_s, depth_m]);
    }
    way
}

/// When 99 % of the largest depth is reached, in the time of the rows (time, depth).
fn sinks_s(way: &[[f64; 2]]) -> Option<f64> {
    let deepest_m = way.iter().map(|[_, depth]| *depth).fold(0.0, f64::max);
    let there = way.iter().find(|[_, depth]| *depth >= 0.99 * deepest_m);
    there.map(|[time_s, _]| *time_s)
}

/// A ball that hits a bed.
struct Case {
    /// How its table calls the spheres.
    spheres: &'static str,
    diameter_mm: f64,
    count: usize,
    speed_m_s: f64,
    sets: &'static [&'static str],
}

const fn case(spheres: &'static str, diameter_mm: f64, count: usize) -> Case {
    Case {
        spheres,
        diameter_mm,
        count,
        speed_m_s: 5.0,
        sets: &[],
    }
}

/// Until the ball is at rest: with large spheres it creeps.
const LONG: &str = "run.end_time=\"0.7 s\"";

const CASES: [Case; 8] = [
    Case {
        sets: &[LONG],
        ..case("8 mm", 8.0, 1_563)
    },
    Case {
        sets: &[LONG, "run.safety_factor=0.45"],
        ..case("8 mm, half the step", 8.0, 1_563)
    },
    Case {
        sets: &[LONG, "materials.m1.young_modulus=\"200 MPa\""],
        ..case("8 mm, 200 MPa", 8.0, 1_563)
    },
    Case {
        speed_m_s: 2.5,
        sets: &[LONG, "supports.hold.velocity.z=\"-1.818 m/s\""],
        ..case("8 mm", 8.0, 1_563)
    },
    case("6 mm", 6.0, 3_704),
    case("4 mm", 4.0, 12_500),
    case("3 mm", 3.0, 29_630),
    Case {
        sets: &["output.series=\"2 ms\""],
        ..case("2 mm", 2.0, 100_000)
    },
];

/// A fall of the ball: heights over time, and the way by the law of Katsuragi and Durian.
struct Fall {
    heights: Vec<[f64; 2]>,
    law: Vec<[f64; 2]>,
    /// From where it has its speed to the surface of the bed, m and s.
    gap_m: f64,
    falls_s: f64,
}

pub(crate) fn penetration(bench: &Bench) -> Result<(), Failed> {
    let [.., mut table] = tables();
    let mut lines = Vec::new();
    for (at, case) in CASES.iter().enumerate() {
        let mut set = vec![
            format!(
                "bodies.grain.particles=[[0,0,0,\"{} mm\"]]",
                0.5 * case.diameter_mm
            ),
            format!("inlets.fill.count={}", case.count),
        ];
        set.extend(case.sets.iter().map(|&set| set.to_owned()));
        let run = run(bench, "penetration", &at.to_string(), &set)?;
        let fall = fall(&run, case.speed_m_s, &mut table)?;
        // Sizes at the same speed: each line of a plot has a colour of its own.
        if case.speed_m_s > 4.0 && !case.spheres.contains(',') {
            let name = format!("spheres of {}", case.spheres);
            lines.push(Line::new(name, displacements(&fall.heights)?));
        }
        if at + 1 == CASES.len() {
            let every_ms = fall.law.iter().step_by(1000);
            let law = every_ms.map(|[t, depth]| [fall.falls_s + t, -1e3 * (fall.gap_m + depth)]);
            lines.push(Line::dashed("Katsuragi and Durian 2013", law.collect()));
        }
    }
    let at_rest = vec![[0.08, -90.7], [0.13, -90.7]];
    lines.push(Line::dashed("LIGGGHTS and MUSEN, at rest", at_rest));
    let title = "a ball that hits a bed of spheres at 5 m/s";
    let plot = Plot::of(title, "time (s)", "displacement (mm)", lines);
    draw("doc/inside/round-robin-penetration.svg", &plot)?;
    write(&[table])
}

/// Adds the row of a run.
fn fall(run: &Run, speed_m_s: f64, table: &mut Table) -> Result<Fall, Failed> {
    let [_, beds] = column(run, "bed_centre_m", [0.0, 0.4])?;
    let bed_m = 2.0 * beds.last().ok_or("no row before the fall")?;
    let bulk_kg_m3 = run.measured("bulk_density")?;
    let lowest_m = run.measured("ball")?;
    let depth_m = bed_m - (lowest_m - BALL_M);
    // From rest to its lowest place.
    let fall_m = speed_m_s * speed_m_s / (2.0 * GRAVITY_M_S2) + FROM_M - lowest_m;
    let off = |law_m: f64| {
        let off = change(depth_m / law_m - 1.0, 0);
        format!("{:.1} mm ({off})", 1e3 * law_m)
    };
    let gap_m = FROM_M - BALL_M - bed_m;
    let impact_m_s = (speed_m_s * speed_m_s + 2.0 * GRAVITY_M_S2 * gap_m).sqrt();
    let law = katsuragi_durian(bulk_kg_m3, impact_m_s);
    let heights = run.columns("series.csv", ["time_s", "ball_m"])?;
    let in_bed = falls_below(&heights, bed_m + BALL_M)?;
    let touches_s = in_bed[0][0];
    let depths = in_bed
        .iter()
        .map(|[t, z]| [t - touches_s, bed_m + BALL_M - z]);
    let sinks = |way: &[[f64; 2]]| format!("{:.0} ms", 1e3 * sinks_s(way).unwrap_or(f64::NAN));
    table.row([
        format!("{speed_m_s} m/s"),
        format!("{:.1} mm", 1e3 * bed_m),
        format!("{bulk_kg_m3:.0} kg/m3"),
        format!("{:.1} mm", 1e3 * depth_m),
        off(uehara_m(bulk_kg_m3, fall_m)),
        off(law[law.len() - 1][1]),
        sinks(&depths.collect::<Vec<_>>()),
        sinks(&law),
        format!("{:.1} mm", 1e3 * (lowest_m - FROM_M)),
    ]);
    Ok(Fall {
        heights,
        law,
        gap_m,
        falls_s: (impact_m_s - speed_m_s) / GRAVITY_M_S2,
    })
}

/// Displacement of the ball, mm, over time, from where it has 5 m/s, from rows (time, height).
fn displacements(heights: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, Failed> {
    let fall = falls_below(heights, FROM_M)?;
    let displacement = |[t, z]: &[f64; 2]| [t - fall[0][0], 1e3 * (z - FROM_M)];
    Ok(fall.iter().map(displacement).collect())
}

/// The rows (time, height) from the time on at which the height falls below a level: the first row
/// is at that level, on the straight line between two rows.
fn falls_below(heights: &[[f64; 2]], level_m: f64) -> Result<Vec<[f64; 2]>, Failed> {
    let first = heights.iter().position(|[_, z]| *z < level_m);
    let first = first.filter(|first| *first > 0);
    let first = first.ok_or("the ball has not fallen")?;
    let ([t, z], [next_s, next_m]) = (heights[first - 1], heights[first]);
    let crosses_s = t + (next_s - t) * (z - level_m) / (z - next_m);
    Ok([&[[crosses_s, level_m]], &heights[first..]].concat())
}
