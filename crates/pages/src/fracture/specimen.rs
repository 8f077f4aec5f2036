//! Notched beams, double cantilevers and bars between supports, run with
//! `tests/fracture/specimen.toml`.

use std::f64::consts::PI;

use dem_io::Body;
use dem_io::body::write_body;

use super::formulas::{Cantilevers, beam_shape, bending_stress_pa, disc_shape};
use super::material::Material;
use super::shapes::{HEIGHT_M, Spheres, WIDTH_M, across, cut, mean_x_m, row, those};
use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};

/// Span and length of a beam over its height; depth of its notch.
pub(crate) const SPAN: f64 = 2.5;
const LENGTH: f64 = 2.8;
pub(crate) const DEPTH: f64 = 0.5;
/// Distance of the load of a double cantilever from its end, from the notch, and width between its
/// grooves, m.
const LOAD_AT_M: f64 = 0.01;
const NOTCH_M: f64 = 0.09;
const GROOVE_WIDTH_M: f64 = 0.025;
/// Corners of the outline of a disc, half the width of its pads over its radius, and the length of
/// its notch over its diameter.
pub(crate) const CORNERS: u32 = 48;
const PAD: f64 = 0.15;
const DISC_NOTCH: f64 = 0.5;

/// A specimen between supports.
pub(crate) struct Specimen {
    pub(crate) name: String,
    pub(crate) body: Body,
    /// The groups `held`, `driven`, `guide`, `gauge-a` and `gauge-b`.
    pub(crate) groups: [Vec<usize>; 5],
    /// Axis along which it is loaded, 0 or 2, and that along which its gauges move.
    pub(crate) axis: usize,
    pub(crate) gauge_axis: usize,
    /// Travel at which it is expected to fail, and time in which it gets there.
    pub(crate) travel_m: f64,
    pub(crate) time_s: f64,
    /// Part of that time in which it gets up to its speed.
    pub(crate) start: f64,
    /// Travel and broken bonds at which the run ends, the travel over that at failure.
    pub(crate) strokes: f64,
    pub(crate) most_broken: usize,
    /// Distance of the outer pins of a beam, or of the gauges of a bar, m.
    pub(crate) span_m: f64,
}

const AXES: [&str; 3] = ["x", "y", "z"];
const GROUPS: [&str; 5] = ["held", "driven", "guide", "gauge-a", "gauge-b"];
/// Periods of the lowest vibration until failure.
const PERIODS: f64 = 10.0;

/// A beam of this height with a notch from below, bent by a row of spheres over two rows.
pub(crate) fn beam(
    bench: Option<&Bench>,
    material: &Material,
    spheres: Spheres,
    height_m: f64,
) -> Result<Specimen, Failed> {
    let size_m = [LENGTH * height_m, WIDTH_M, height_m];
    let name = format!("block-{:.0}", 1e3 * height_m);
    let mut body = spheres.packed(bench, &name, size_m, 4)?;
    cut(&mut body, 0, |[_, _, z_m]| z_m < (DEPTH - 0.5) * height_m);
    let pins = |x_m: f64, up: f64, body: &Body| {
        row(body, spheres.diameter_m, WIDTH_M, |[x, _, z]| {
            (x - x_m).abs() - up * z
        })
    };
    let half_m = 0.5 * SPAN * height_m;
    let [left, right] = [-half_m, half_m].map(|x_m| pins(x_m, -1.0, &body));
    let load = pins(0.0, 1.0, &body);
    let beside_m = 0.5 * spheres.diameter_m;
    let mouth = [-beside_m, beside_m].map(|x_m| pins(x_m, -1.0, &body));
    let span_m = mean_x_m(&body, &right) - mean_x_m(&body, &left);
    let [gauge_a, gauge_b] = mouth;
    // Deflection of a beam with this notch (Tada et al. 2000, 2.17, at half the height).
    let toughness = material.toughness(spheres.diameter_m);
    let stress_pa = toughness / (beam_shape(DEPTH, SPAN) * height_m.sqrt());
    let travel_m = stress_pa / material.young_pa * height_m * 3.3;
    let speed_m_s = material.speed_m_s();
    Ok(Specimen {
        name: format!("beam-{:.0}-{}", 1e3 * height_m, spheres.name()),
        most_broken: (0.8 * across(&body, 0) as f64) as usize,
        body,
        groups: [[left, right].concat(), load.clone(), load, gauge_a, gauge_b],
        axis: 2,
        gauge_axis: 0,
        travel_m: -travel_m,
        time_s: PERIODS * LENGTH * LENGTH * height_m / speed_m_s,
        start: 0.1,
        strokes: 4.0,
        span_m,
    })
}

/// A double cantilever with side grooves, opened by rows of spheres in the middle of its arms.
pub(crate) fn double_cantilever(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
) -> Result<Specimen, Failed> {
    let size_m = [LENGTH * HEIGHT_M, WIDTH_M, HEIGHT_M];
    let mut body = spheres.packed(Some(bench), "block-100", size_m, 4)?;
    let load_m = LOAD_AT_M - 0.5 * size_m[0];
    cut(&mut body, 2, |[x_m, y_m, _]| {
        x_m < load_m + NOTCH_M || y_m.abs() > 0.5 * GROOVE_WIDTH_M
    });
    let arm = |z_m: f64| {
        row(&body, spheres.diameter_m, WIDTH_M, |[x, _, z]| {
            (x - load_m).abs() + (z - z_m).abs()
        })
    };
    let [lower, upper] = [-0.25 * HEIGHT_M, 0.25 * HEIGHT_M].map(arm);
    let toughness = material.toughness(spheres.diameter_m);
    let cantilevers = cantilevers();
    let load_n = toughness / cantilevers.intensity(1.0, NOTCH_M);
    let speed_m_s = material.speed_m_s();
    Ok(Specimen {
        name: format!("cantilever-{}", spheres.name()),
        most_broken: (0.8 * across(&body, 2) as f64) as usize,
        body,
        groups: [lower.clone(), upper.clone(), upper.clone(), lower, upper],
        axis: 2,
        gauge_axis: 0,
        travel_m: load_n / cantilevers.stiffness(material.young_pa, NOTCH_M),
        time_s: PERIODS * 6.0 * NOTCH_M.powi(2) / (cantilevers.arm_m * speed_m_s),
        start: 0.1,
        strokes: 5.0,
        span_m: 0.0,
    })
}

pub(crate) fn cantilevers() -> Cantilevers {
    Cantilevers {
        arm_m: 0.5 * HEIGHT_M,
        width_m: WIDTH_M,
        groove_width_m: GROOVE_WIDTH_M,
    }
}

/// A block of these sizes, m, pulled along its length by a layer at each end.
fn bar(body: Body, material: &Material, spheres: Spheres, [length_m, ..]: [f64; 3]) -> Specimen {
    let grip_m = 0.5 * length_m - spheres.diameter_m;
    let left = those(&body, |[x_m, ..]| x_m < -grip_m);
    let right = those(&body, |[x_m, ..]| x_m > grip_m);
    let gauge_m = 0.25 * length_m;
    let near = |at_m: f64| {
        those(&body, |[x_m, ..]| {
            (x_m - at_m).abs() < 0.5 * spheres.diameter_m
        })
    };
    let [gauge_a, gauge_b] = [-gauge_m, gauge_m].map(near);
    let span_m = mean_x_m(&body, &gauge_b) - mean_x_m(&body, &gauge_a);
    let speed_m_s = material.speed_m_s();
    Specimen {
        name: format!("bar-{}", spheres.name()),
        most_broken: body.bonds.len() / 100,
        groups: [left, right, Vec::new(), gauge_a, gauge_b],
        axis: 0,
        gauge_axis: 0,
        travel_m: 1.5 * material.strength_pa / material.young_pa * length_m,
        time_s: 40.0 * length_m / speed_m_s,
        start: 0.1,
        strokes: 2.0,
        span_m,
        body,
    }
}

/// A disc with a notch of this length over its diameter along the load; 0: none.
pub(crate) fn disc(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
    notch: f64,
) -> Result<Specimen, Failed> {
    let size_m = [HEIGHT_M, WIDTH_M, HEIGHT_M];
    let mut body = spheres.packed(Some(bench), "disc", size_m, CORNERS)?;
    cut(&mut body, 0, |[_, _, z_m]| {
        z_m.abs() < notch * 0.5 * HEIGHT_M
    });
    Ok(Specimen {
        name: format!("disc-{notch}-{}", spheres.name()),
        ..squeezed(body, material, spheres, size_m)
    })
}

/// A disc of these sizes, m, without a name, which spheres near two of its ends press: pads.
pub(crate) fn squeezed(
    body: Body,
    material: &Material,
    spheres: Spheres,
    [_, width_m, height_m]: [f64; 3],
) -> Specimen {
    let radius_m = 0.5 * height_m;
    let end = |up: f64| {
        row(&body, spheres.diameter_m, width_m, |[x, _, z]| {
            x.abs() - up * z
        })
    };
    let pad = |up: f64| {
        let mut pad = those(&body, |[x, _, z]| {
            x.abs() < PAD * radius_m
                && x.hypot(z) > radius_m - 0.5 * spheres.diameter_m
                && up * z > 0.0
        });
        pad.extend(end(up));
        pad.sort_unstable();
        pad.dedup();
        pad
    };
    let [below, above] = [-1.0, 1.0].map(pad);
    let guide = end(1.0);
    Specimen {
        name: String::new(),
        most_broken: across(&body, 0) / 2,
        groups: [below.clone(), above.clone(), guide, below, above],
        body,
        axis: 2,
        gauge_axis: 0,
        travel_m: -6.0 * material.strength_pa / material.young_pa * height_m,
        time_s: 40.0 * height_m / material.speed_m_s(),
        start: 0.1,
        strokes: 3.0,
        span_m: 0.0,
    }
}

/// Tensile strength of a disc, Pa.
pub(crate) fn split_pa(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
) -> Result<f64, Failed> {
    let load_n = disc(bench, material, spheres, 0.0)?
        .run(bench, material)?
        .peak_n();
    Ok(2.0 * load_n / (PI * HEIGHT_M * WIDTH_M))
}

/// K_I of a disc with a notch at its largest load, Pa sqrt(m).
pub(crate) fn notched_disc(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
) -> Result<f64, Failed> {
    let disc = disc(bench, material, spheres, DISC_NOTCH)?;
    let load_n = disc.run(bench, material)?.peak_n();
    Ok(load_n / (WIDTH_M * (0.5 * HEIGHT_M).sqrt()) * disc_shape(DISC_NOTCH))
}

/// What a specimen measures: a row for each time, of load, travel, opening of the gauges, broken
/// bonds, and the energy that damage of bonds has taken.
pub(crate) struct Curve {
    pub(crate) rows: Vec<[f64; 5]>,
}

impl Specimen {
    /// The keys of `tests/fracture/specimen.toml` that it sets.
    pub(crate) fn sets(&self, material: &Material) -> Vec<String> {
        let direction = AXES[self.axis];
        let gauged = AXES[self.gauge_axis];
        let end_s = self.strokes * self.time_s;
        let mut all = vec![
            format!("bonds.rock={}", material.bonds),
            format!("run.end_time={end_s}"),
            format!("output.series={}", self.time_s / 250.0),
            format!("supports.held.fixed=[\"{direction}\"]"),
            format!(
                "supports.guide.fixed=[\"{}\",\"y\"]",
                ["z", "", "x"][self.axis]
            ),
            format!(
                "supports.driven.velocity={{{direction}={}}}",
                self.travel_m / self.time_s
            ),
            format!(
                "supports.driven.table=[[0,0],[{},1]]",
                self.start * self.time_s
            ),
            format!("measures.load.quantity=\"reaction_{direction}\""),
            format!("measures.travel.quantity=\"displacement_{direction}\""),
            format!("measures.gauge_a.quantity=\"displacement_{gauged}\""),
            format!("measures.gauge_b.quantity=\"displacement_{gauged}\""),
            format!("materials.rock.density={}", material.density_kg_m3),
            format!("measures.broken.end_run_above={}", self.most_broken),
        ];
        for (name, group) in GROUPS.iter().zip(&self.groups) {
            // Grips keep a bar from drifting: one sphere of them is the guide.
            let group = if group.is_empty() {
                &self.groups[0][..1]
            } else {
                group
            };
            all.push(format!("groups.{name}.particles={group:?}"));
        }
        all
    }

    pub(crate) fn run(&self, bench: &Bench, material: &Material) -> Result<Curve, Failed> {
        self.curve(&self.results(bench, material)?)
    }

    pub(crate) fn results(&self, bench: &Bench, material: &Material) -> Result<Run, Failed> {
        let file = bench.folder.join(format!("{}.vtp", self.name));
        write_body(&self.body, &file)?;
        let mut options = sets(&self.sets(material));
        options.extend([ONE_THREAD.to_owned(), body("specimen", &file)]);
        let name = format!("{}-{}", self.name, material.file_name());
        bench.run(&name, "tests/fracture/specimen.toml", &options)
    }

    pub(crate) fn curve(&self, run: &Run) -> Result<Curve, Failed> {
        let names = [
            "load_n",
            "travel_m",
            "gauge_a_m",
            "gauge_b_m",
            "broken_bonds",
            "bond_damage_j",
        ];
        let read = run.columns("series.csv", names)?;
        let sign = self.travel_m.signum();
        let rows = read
            .into_iter()
            .map(|[load, travel, a, b, broken, damage]| {
                [-sign * load, sign * travel, b - a, broken, damage]
            });
        Ok(Curve {
            rows: rows.collect(),
        })
    }
}

impl Curve {
    /// Load averaged over five rows, N.
    pub(crate) fn load_n(&self, at: usize) -> f64 {
        let around = &self.rows[at.saturating_sub(2)..(at + 3).min(self.rows.len())];
        around.iter().map(|row| row[0]).sum::<f64>() / around.len() as f64
    }

    /// The row of the largest load, and that load, N.
    pub(crate) fn peak(&self) -> (usize, f64) {
        let loads = (0..self.rows.len()).map(|at| (at, self.load_n(at)));
        let larger = |a: (usize, f64), b: (usize, f64)| if b.1 > a.1 { b } else { a };
        loads.fold((0, 0.0), larger)
    }

    pub(crate) fn peak_n(&self) -> f64 {
        self.peak().1
    }

    /// Load over the opening of the gauges between a quarter and a half of the largest load, N/m.
    pub(crate) fn stiffness(&self) -> f64 {
        self.slope(2)
    }

    /// The same over a column.
    fn slope(&self, column: usize) -> f64 {
        let (end, most_n) = self.peak();
        let from = |part: f64| (0..end).find(|&at| self.load_n(at) >= part * most_n);
        let [low, high] = [0.25, 0.5].map(|part| from(part).unwrap_or(0));
        let way_m = self.rows[high][column] - self.rows[low][column];
        (self.load_n(high) - self.load_n(low)) / way_m
    }

    /// Work of the load up to each row, J.
    fn works_j(&self) -> Vec<f64> {
        let mut work_j = 0.0;
        let steps = self.rows.windows(2).map(|pair| {
            work_j += 0.5 * (pair[0][0] + pair[1][0]) * (pair[1][1] - pair[0][1]);
            work_j
        });
        std::iter::once(0.0).chain(steps).collect()
    }

    /// Work up to the end, and energy that damage has taken, J.
    pub(crate) fn energies_j(&self) -> [f64; 2] {
        let work_j = self.works_j().last().copied().unwrap_or(0.0);
        [work_j, self.rows.last().map_or(0.0, |row| row[4])]
    }
}

/// Modulus and strength in tension of the block of the beams without a notch, Pa.
pub(crate) fn pulled(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
) -> Result<[f64; 2], Failed> {
    let size_m = [LENGTH * HEIGHT_M, WIDTH_M, HEIGHT_M];
    let body = spheres.packed(Some(bench), "block-100", size_m, 4)?;
    pulled_block(bench, material, spheres, body, size_m)
}

/// The same of a block of these sizes, m.
pub(crate) fn pulled_block(
    bench: &Bench,
    material: &Material,
    spheres: Spheres,
    body: Body,
    size_m: [f64; 3],
) -> Result<[f64; 2], Failed> {
    let bar = bar(body, material, spheres, size_m);
    let curve = bar.run(bench, material)?;
    let area_m2 = size_m[1] * size_m[2];
    let young_pa = curve.stiffness() * bar.span_m / area_m2;
    Ok([young_pa, curve.peak_n() / area_m2])
}

/// What a beam with a notch measures.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bent {
    /// Stress of the beam without notch at the largest load, Pa.
    pub(crate) stress_pa: f64,
    /// K_I at the largest load, Pa sqrt(m).
    pub(crate) toughness: f64,
    /// Work and energy of damage over the ligament, J/m2.
    pub(crate) work_j_m2: f64,
    pub(crate) damage_j_m2: f64,
}

pub(crate) fn bent(specimen: &Specimen, curve: &Curve, height_m: f64) -> Bent {
    let stress_pa = bending_stress_pa(curve.peak_n(), specimen.span_m, WIDTH_M, height_m);
    let ligament_m2 = (1.0 - DEPTH) * height_m * WIDTH_M;
    let [work_j_m2, damage_j_m2] = curve.energies_j().map(|energy| energy / ligament_m2);
    Bent {
        stress_pa,
        toughness: stress_pa * height_m.sqrt() * beam_shape(DEPTH, SPAN),
        work_j_m2,
        damage_j_m2,
    }
}

/// What a double cantilever measures while its crack grows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Opened {
    /// Load over travel at the start, N/m.
    pub(crate) stiffness: f64,
    /// Mean of K_I over the growth, Pa sqrt(m).
    pub(crate) toughness: f64,
    /// Work less what is stored, over the new crack, J/m2.
    pub(crate) work_j_m2: f64,
}

/// Growth of the crack over which a double cantilever is evaluated, m.
const GROWTH_M: [f64; 2] = [0.015, 0.05];

/// The crack is as long as the fraction of the bonds of the ligament that are broken says.
pub(crate) fn opened(specimen: &Specimen, curve: &Curve) -> Option<Opened> {
    let ligament_m = LENGTH * HEIGHT_M - LOAD_AT_M - NOTCH_M;
    let bonds = across(&specimen.body, 2) as f64;
    let growth_m = |at: usize| curve.rows[at][3] / bonds * ligament_m;
    let reached = |least_m: f64| (0..curve.rows.len()).find(|&at| growth_m(at) >= least_m);
    let [first, last] = GROWTH_M.map(reached);
    let (first, last) = (first?, last?);
    let cantilevers = cantilevers();
    let intensity = |at: usize| cantilevers.intensity(curve.load_n(at), NOTCH_M + growth_m(at));
    let toughness = (first..=last).map(intensity).sum::<f64>() / (last + 1 - first) as f64;
    let works_j = curve.works_j();
    let spent_j = |at: usize| works_j[at] - 0.5 * curve.load_n(at) * curve.rows[at][1];
    let area_m2 = GROOVE_WIDTH_M * (growth_m(last) - growth_m(first));
    Some(Opened {
        stiffness: curve.slope(1),
        toughness,
        work_j_m2: (spent_j(last) - spent_j(first)) / area_m2,
    })
}

/// Stiffness of a double cantilever of this modulus before its crack grows, N/m.
pub(crate) fn opening_stiffness(young_pa: f64) -> f64 {
    cantilevers().stiffness(young_pa, NOTCH_M)
}
