//! The largest stable step: by the exact method, by estimates, and as observed in runs.

use std::f64::consts::PI;

use dem_run::stages::bonds::damping::WEAK;
use dem_run::{Plan, step};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::{place, planned};
use super::table::{Case, compared};

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 2e-3;
const YOUNG_PA: f64 = 1e9;
const POISSON: f64 = 0.25;
const DENSITY_KG_M3: f64 = 2500.0;

/// Accuracy of an eigenvalue from the exact method: its search ends at a residual of 1e-5, and the
/// error of an eigenvalue is of the order of the residual's square; the difference quotient used
/// for stiffness moves spheres by 1e-5 of their radius.
const EXACT: f64 = 1e-5;

/// Errors below this depend on the order of sums in a search, and are not printed.
const SEARCHED: f64 = 1e-6;

/// Relative accuracy of the step at which runs begin to grow.
const HALVED: f64 = 1e-7;

fn mass_kg() -> f64 {
    DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

/// Equal spheres in a row along x, each bonded to the next.
#[derive(Debug, Clone, Copy)]
struct Row<'a> {
    model: &'a str,
    /// Ratio of the bond radius to that of the spheres.
    radius_factor: f64,
    spheres: usize,
    /// True if the first sphere is fixed.
    held: bool,
    damping: Damping,
}

/// Damping of bonds.
#[derive(Debug, Clone, Copy)]
enum Damping {
    /// Damping ratio of each mode of a pair.
    Viscous(f64),
    /// Fraction of the load that resists.
    Structural(f64),
}

impl Damping {
    fn keys(self) -> String {
        match self {
            Self::Viscous(ratio) => format!("damping_ratio = {ratio:e}, per_mode = true"),
            Self::Structural(gamma) => format!("structural_damping = {gamma:e}"),
        }
    }
}

impl Row<'_> {
    fn bond_radius_m(&self) -> f64 {
        self.radius_factor * RADIUS_M
    }

    fn second_moment_m4(&self) -> f64 {
        0.25 * PI * self.bond_radius_m().powi(4)
    }

    fn normal(&self) -> f64 {
        YOUNG_PA * PI * self.bond_radius_m().powi(2) / LENGTH_M
    }

    fn shear(&self) -> f64 {
        let slender = 12.0 * YOUNG_PA * self.second_moment_m4() / LENGTH_M.powi(3);
        match self.model {
            "euler-bernoulli" => slender,
            "timoshenko" => {
                let square = (self.bond_radius_m() / LENGTH_M).powi(2);
                slender / (1.0 + 20.0 / 3.0 * square * (1.0 + POISSON))
            }
            "elastic-solid" | "pin" => self.normal() / (2.0 * (1.0 + POISSON)),
            _ => panic!("{}", self.model),
        }
    }

    /// Scene of the row along x, at this step.
    fn plan(&self, time_step: &str, more: &str) -> Plan {
        let spheres = (0..self.spheres).map(|i| {
            let x = LENGTH_M * i as f64;
            format!("[{x:e}, 0, 0, {RADIUS_M:e}]")
        });
        let spheres: Vec<String> = spheres.collect();
        let bonds: Vec<String> = (1..self.spheres)
            .map(|i| format!("[{}, {i}]", i - 1))
            .collect();
        let held = if self.held {
            "supports.first = { group = \"first\", fixed = true }"
        } else {
            ""
        };
        planned(&format!(
            r#"
            version = 1
            run = {{ end_time = "1 h", time_step = {time_step}, safety_factor = 1 }}
            materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
            bodies.row = {{ particles = [{}], bond_list = [{}], material = "stone", bonds = "glue" }}
            groups.first = {{ particles = [0] }}
            groups.last = {{ particles = [{}] }}
            bonds.glue = {{ model = "{}", young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, radius_factor = {:e}, damping = {{ {} }} }}
            {held}
            {more}
            "#,
            spheres.join(", "),
            bonds.join(", "),
            self.spheres - 1,
            self.model,
            self.radius_factor,
            self.damping.keys(),
        ))
    }

    /// Squares of the frequencies of two equal spheres: stretch, torsion, bending, shear, 1/s2.
    fn pair_rates(&self) -> [f64; 4] {
        let (mass, inertia) = (mass_kg(), 0.4 * mass_kg() * RADIUS_M * RADIUS_M);
        let bending = if self.model == "pin" {
            0.0
        } else {
            YOUNG_PA * self.second_moment_m4() / LENGTH_M
        };
        let torsion = bending / (1.0 + POISSON);
        [
            2.0 * self.normal() / mass,
            2.0 * torsion / inertia,
            2.0 * bending / inertia,
            self.shear() * (2.0 / mass + 0.5 * LENGTH_M * LENGTH_M / inertia),
        ]
    }

    /// Highest frequency along a row of slender bonds, rad/s.
    fn chain_rad_s(&self) -> f64 {
        let n = self.spheres as f64;
        let angle = if self.held {
            // n - 1 spheres move: held at one end, free at the other.
            0.5 * PI * (2.0 * n - 3.0) / (2.0 * n - 1.0)
        } else {
            0.5 * PI * (n - 1.0) / n
        };
        2.0 * (self.normal() / mass_kg()).sqrt() * angle.sin()
    }

    /// Largest step at which a small motion along the row does not grow in this number of steps,
    /// over the limit, by bisection.
    fn observed(&self, limit_s: f64, steps: usize) -> f64 {
        let speed = 1e-9 * LENGTH_M / limit_s;
        let more = format!("initial.last = {{ group = \"last\", velocity = [{speed:e}, 0, 0] }}");
        let grows = |fraction: f64| {
            let mut state = self.plan(&format!("{:e}", fraction * limit_s), &more).state;
            (0..steps).any(|_| {
                step(&mut state);
                let last = place(&state, self.spheres - 1).x;
                let drifted = if self.held { 0.0 } else { speed * state.time_s };
                (last - LENGTH_M * (self.spheres - 1) as f64).abs() > drifted + 1e-5 * LENGTH_M
            })
        };
        let (mut low, mut high) = (0.9, 1.1);
        assert!(!grows(low) && grows(high));
        while high - low > HALVED {
            let middle = 0.5 * (low + high);
            if grows(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    }
}

/// Pairs: the highest of their four frequencies.
fn pairs() -> String {
    let mut cases = Vec::new();
    for model in ["euler-bernoulli", "timoshenko", "elastic-solid", "pin"] {
        for radius_factor in [0.1, 0.5, 1.0] {
            let row = Row {
                model,
                radius_factor,
                spheres: 2,
                held: false,
                damping: Damping::Viscous(0.0),
            };
            let rates = row.pair_rates();
            let highest = rates.iter().copied().fold(0.0, f64::max);
            let mode = rates.iter().position(|&rate| rate == highest).unwrap();
            let mode = ["stretch", "torsion", "bending", "shear"][mode];
            let found = row.plan("\"auto\"", "").step.limit.omega_rad_s;
            let what = format!("{model}, {radius_factor}: {mode}");
            cases.push(Case::new(what, found, highest.sqrt(), EXACT).rounding(SEARCHED));
        }
    }
    compared("bond model, bond radius: highest mode", "rad/s", &cases)
}

/// Two touching spheres of different size and the bond of Rojek, whose two segments are f times as
/// thick as their spheres: k_n = E pi f^2 R_a R_b/(R_a + R_b). With a shear stiffness of a tenth of
/// it, stretching is their fastest motion.
fn unequal() -> String {
    let mut cases = Vec::new();
    for ratio in [1.0, 2.0, 4.0] {
        for factor in [0.1, 0.5] {
            let radii_m = [RADIUS_M, ratio * RADIUS_M];
            let sum_m = radii_m[0] + radii_m[1];
            let plan = planned(&format!(
                r#"
                version = 1
                run = {{ end_time = "1 h", safety_factor = 1 }}
                materials.stone = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
                bodies.pair = {{ particles = [[0, 0, 0, {:e}], [{sum_m:e}, 0, 0, {:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
                bonds.glue = {{ model = "rojek", stiffness_ratio = 10, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, radius_factor = {factor:e} }}
                "#,
                radii_m[0], radii_m[1],
            ));
            let normal = YOUNG_PA * PI * factor * factor * radii_m[0] * radii_m[1] / sum_m;
            let inverse_kg = (1.0 + ratio.powi(-3)) / mass_kg();
            let found = plan.step.limit.omega_rad_s;
            let what = format!("radii 1 : {ratio}, f = {factor}");
            let wanted = (normal * inverse_kg).sqrt();
            cases.push(Case::new(what, found, wanted, EXACT).rounding(SEARCHED));
        }
    }
    compared("bond of Rojek", "rad/s", &cases)
}

/// Rows of spheres.
fn chains() -> String {
    let mut cases = Vec::new();
    for held in [false, true] {
        for spheres in [3, 10, 100] {
            let row = Row {
                model: "timoshenko",
                radius_factor: 0.1,
                spheres,
                held,
                damping: Damping::Viscous(0.0),
            };
            let found = row.plan("\"auto\"", "").step.limit.omega_rad_s;
            let ends = if held { "held at one end" } else { "free" };
            let what = format!("{spheres} spheres, {ends}");
            cases.push(Case::new(what, found, row.chain_rad_s(), EXACT).rounding(SEARCHED));
        }
    }
    compared("row", "rad/s", &cases)
}

/// Number of steps in which a run must grow.
const STEPS: usize = 20_000;

/// Fraction by which the step must exceed the limit so that a motion grows a millionfold in this
/// number of steps: ten thousandfold from its start, of which a hundredth is in the fastest mode.
///
/// With r = omega dt and b = 2/(1 + R), where R is the decay of velocities by damping in a step,
/// about exp(-2 zeta r), a step multiplies that mode by a root of b q^2 + (r^2 - 2) q + 2 - b = 0,
/// which is -1 at r = 2. Beyond it by a fraction s, its logarithm is 2 sqrt(2 s) without damping,
/// and 4 s/(b - 1) = 4 s/tanh(2 zeta) with it. Damping in one stage, with g = 4 zeta, has
/// r^2 + f(q, g) = 0 (stages/damping.rs), where f(-1) = -4 and f'(-1) = g/(1 - g): the logarithm
/// is 8 s (1 - g)/g. Structural damping resists most at reversals, where R is nearly 0: b is at
/// most 2, and the logarithm at least 4 s.
fn late(damping: Damping) -> f64 {
    let in_a_step = 1e6_f64.ln() / STEPS as f64;
    let Damping::Viscous(damping) = damping else {
        return 0.25 * in_a_step + HALVED;
    };
    let in_one_stage = 4.0 * damping;
    let late = if damping == 0.0 {
        in_a_step * in_a_step / 8.0
    } else if in_one_stage <= WEAK {
        in_a_step * in_one_stage / (8.0 * (1.0 - in_one_stage))
    } else {
        0.25 * in_a_step * (2.0 * damping).tanh()
    };
    late + HALVED
}

/// Limits with damping, and steps at which runs begin to grow.
fn limits() -> [String; 2] {
    let (mut limits, mut observed) = (Vec::new(), Vec::new());
    for (spheres, held, damping) in [
        (2, false, Damping::Viscous(0.0)),
        (2, false, Damping::Viscous(0.1)),
        (2, false, Damping::Viscous(1.0)),
        (2, false, Damping::Structural(0.5)),
        (10, false, Damping::Viscous(0.0)),
        (10, false, Damping::Structural(0.9)),
        (10, true, Damping::Viscous(0.0)),
    ] {
        let row = Row {
            model: "timoshenko",
            radius_factor: 0.1,
            spheres,
            held,
            damping,
        };
        let omega = row.chain_rad_s();
        let wanted = 2.0 / omega;
        let found = row.plan("\"auto\"", "").step.limit.step_s;
        let what = format!("{spheres} spheres, {}", if held { "held" } else { "free" });
        let what = match damping {
            Damping::Viscous(ratio) => format!("{what}, damping ratio {ratio}"),
            Damping::Structural(gamma) => format!("{what}, structural damping {gamma}"),
        };
        let case = Case::new(what.clone(), 1e6 * found, 1e6 * wanted, EXACT);
        limits.push(case.rounding(SEARCHED));
        let shown = row.observed(wanted, STEPS) * wanted;
        let case = Case::new(what, 1e6 * shown, 1e6 * wanted, late(damping));
        observed.push(case.rounding(SEARCHED));
    }
    [
        compared("row", "us", &limits),
        compared("row", "us", &observed),
    ]
}

/// Estimates; the larger ones ignore bonds.
fn estimates() -> String {
    let row = Row {
        model: "timoshenko",
        radius_factor: 1.0,
        spheres: 10,
        held: false,
        damping: Damping::Viscous(0.0),
    };
    let step = row.plan("\"auto\"", "").step;
    let shear = YOUNG_PA / (2.0 * (1.0 + POISSON));
    let rayleigh = PI * RADIUS_M * (DENSITY_KG_M3 / shear).sqrt() / (0.1631 * POISSON + 0.8766);
    let bond = 0.17 * (mass_kg() / row.normal()).sqrt();
    let rounding = 1e-12;
    compared(
        "estimate",
        "us",
        &[
            Case::new(
                "Rayleigh's time",
                1e6 * step.rayleigh_s,
                1e6 * rayleigh,
                rounding,
            ),
            Case::new(
                "0.17 sqrt(m/K) of a bond",
                1e6 * step.platzer_eq_15_s,
                1e6 * bond,
                rounding,
            ),
        ],
    )
}

/// The page of the time step equals the results of the solver.
#[test]
fn the_page_shows_what_the_solver_gives() {
    let page = on_one_thread(|| {
        let [limits, observed] = limits();
        filled(
            include_str!("time-step.md"),
            &[
                ("pairs", pairs()),
                ("unequal", unequal()),
                ("chains", chains()),
                ("limits", limits),
                ("observed", observed),
                ("estimates", estimates()),
            ],
        )
    });
    assert_shown(&[("time-step.md".to_owned(), page)]);
}
