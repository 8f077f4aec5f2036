//! Small scenes of random values, sensible or not: never a panic, always one of the exit codes, one
//! message if it is not 0.
#![cfg(unix)]

use std::cell::RefCell;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use super::Bench;

/// A number in a scene: most often near a sensible value, sometimes far off.
fn number(usual: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        60 => (0.3..3.0_f64).prop_map(move |f| f * usual),
        1 => Just(0.0),
        1 => (-3.0..3.0_f64).prop_map(move |f| f * usual),
        1 => (-300.0..300.0_f64).prop_map(|e| 10_f64.powf(e)),
        1 => (-30.0..30.0_f64).prop_map(move |e| usual * 10_f64.powf(e)),
    ]
}

/// Particles on a grid, with radii of about a millimetre, and bonds between them; sometimes two at
/// one position, or a bond to a missing particle, to itself or twice.
fn body() -> impl Strategy<Value = String> {
    let particle = (0..50_u32, number(1e-3));
    let pair = (0..100_u32, 0..100_u32, 0..60_u32);
    let lists = (
        prop::collection::vec(particle, 1..6),
        prop::collection::vec(pair, 0..6),
    );
    lists.prop_map(|(particles, pairs)| {
        let count = particles.len() as u32;
        let mut rows = Vec::new();
        for (i, (odd, radius)) in (0..).zip(&particles) {
            // One after another on a 2 x 2 x 2 grid; one in 50 at the position of the first.
            let i = if *odd == 0 { 0 } else { i };
            let place = [i & 1, i >> 1 & 1, i >> 2 & 1].map(|k| f64::from(k) * 2e-3);
            rows.push(format!(
                "[{}, {}, {}, {radius:e}]",
                place[0], place[1], place[2]
            ));
        }
        let mut text = format!("particles = [{}]\n", rows.join(", "));
        let mut bonds: Vec<[u32; 2]> = Vec::new();
        for (a, b, odd) in pairs {
            let pair = if odd == 0 {
                [a % 7, b % 7]
            } else {
                [a % count, b % count]
            };
            let [a, b] = pair;
            let is_known = a == b || bonds.contains(&[a, b]) || bonds.contains(&[b, a]);
            if !is_known || odd == 1 {
                bonds.push(pair);
            }
        }
        if !bonds.is_empty() {
            text += &format!("bond_list = {bonds:?}\nbonds = \"k\"\n");
        }
        text
    })
}

fn word(words: &'static [&'static str]) -> impl Strategy<Value = &'static str> {
    prop::sample::select(words)
}

prop_compose! {
    fn extras()(
        support in prop::option::of((0..2_u32, word(&["fixed = true", "fixed = [\"x\", \"rz\"]", "velocity = { x = 1 }", "displacement = { y = 1e-3 }\nramp = 1e-4"]))),
        load in prop::option::of((0..2_u32, number(1.0))),
        gravity in prop::option::of(number(9.81)),
        damping in prop::option::of(number(0.2)),
        spin in prop::option::of(number(100.0)),
        measure in prop::option::of(word(&["displacement_x", "rotation_z", "reaction_y", "largest_utilisation", "elastic_energy"])),
    ) -> String {
        let mut text = String::new();
        if let Some(spin) = spin { text += &format!("angular_velocity = [0, {spin:e}, 1]\n"); }
        if let Some((at, how)) = support { text += &format!("[groups.s]\nparticles = [{at}]\n[supports.s]\ngroup = \"s\"\n{how}\n"); }
        if let Some((at, force)) = load { text += &format!("[groups.l]\nparticles = [{at}]\n[loads.l]\ngroup = \"l\"\nforce = [{force:e}, 0, 1]\n"); }
        if let Some(what) = measure { text += &format!("[measures.m]\nquantity = \"{what}\"\n"); }
        let mut run = String::new();
        if let Some(g) = gravity { run += &format!("run.gravity = [0, 0, {g:e}]\n"); }
        if let Some(gamma) = damping { run += &format!("run.local_damping = {gamma:e}\n"); }
        format!("{run}#BODY\n{text}")
    }
}

prop_compose! {
    fn scene()(
        steps in 1.0..300.0_f64,
        end in number(2e-3),
        density in number(2000.0),
        modulus in number(1e7),
        poisson in prop_oneof![20 => -0.5..0.49_f64, 1 => -1.2..0.6_f64],
        model in word(&["parallel", "euler-bernoulli", "timoshenko", "elastic-solid", "shear-coefficient"]),
        formulation in word(&["total", "incremental"]),
        viscous in prop::option::of(number(0.1)),
        strength in prop::option::of(number(1e5)),
        weibull in prop::option::of(number(5.0)),
        body in body(),
        extras in extras(),
        given in any::<bool>(),
    ) -> String {
        let (run, rest) = extras.split_once("#BODY\n").unwrap();
        let mut text = format!("version = 1\nrun.end_time = {end:e}\n{run}materials.m.density = {density:e}\n");
        // A given step limits the run time of a case.
        if given || !(1e-5..1e-2).contains(&end) { text += &format!("run.time_step = {:e}\n", end / steps); }
        text += &format!("[bonds.k]\nmodel = \"{model}\"\nformulation = \"{formulation}\"\nyoung_modulus = {modulus:e}\npoisson_ratio = {poisson:e}\n");
        if let Some(eta) = viscous { text += &format!("damping = {{ damping_ratio = {eta:e} }}\n"); }
        if let Some(strength) = strength {
            let scatter = weibull.map_or(String::new(), |m| format!(", weibull_modulus = {m:e}"));
            text += &format!("failure = {{ tensile_strength = {strength:e}, shear_strength = {strength:e}{scatter} }}\n");
        }
        text + "[bodies.b]\nmaterial = \"m\"\n" + &body + rest
    }
}

/// Runs an arbitrary scene. Returns its exit code.
fn run(scene: &str, forced: bool) -> Result<i32, TestCaseError> {
    let bench = Bench::new();
    let path = bench.write("scene.toml", scene);
    let mut command = bench.command(&path, &["--threads", "1", "--output", "out"]);
    if forced {
        command.arg("--force-step");
    }
    let (output, was_stopped) = bounded(&mut command);
    let said = String::from_utf8(output.stderr).unwrap();
    let Some(code) = output.status.code() else {
        return Err(TestCaseError::fail(format!("{scene}\n{said}")));
    };
    if code == 0 {
        prop_assert_eq!(super::without_warnings(&said), "");
        return Ok(code);
    }
    let said = super::without_warnings(&said);
    let is_one = said.starts_with("error: ") && said.matches('\n').count() == 1;
    prop_assert!(is_one, "{}\n{}", scene, said);
    // A run that takes longer than a moment is stopped, and reports it.
    let is_known = matches!(code, 2 | 3) || code == 130 && was_stopped;
    prop_assert!(is_known, "{}\n{}", scene, said);
    // One that is stopped while it is still planned has no results yet.
    if code != 130 {
        prop_assert_eq!(code != 2, bench.path("out").exists());
    }
    Ok(code)
}

#[test]
fn never_a_panic() {
    let config = ProptestConfig {
        cases: 300,
        failure_persistence: None,
        max_shrink_iters: 200,
        ..ProptestConfig::default()
    };
    let counts = RefCell::new([0; 4]);
    let result = TestRunner::new(config).run(&(scene(), any::<bool>()), |(scene, forced)| {
        let code = run(&scene, forced)?;
        // Those that take too long end with 130.
        if let Some(count) = counts.borrow_mut().get_mut(code as usize) {
            *count += 1;
        }
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    // The test is useless if all are refused.
    let [good, _, bad, unstable] = *counts.borrow();
    assert!(good >= 50 && bad >= 50 && unstable >= 1, "{counts:?}");
}

/// Runs a program for half a second at most, then asks it to stop.
fn bounded(command: &mut std::process::Command) -> (std::process::Output, bool) {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let since = Instant::now();
    let mut stopped = false;
    while child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(2));
        if !stopped && since.elapsed() > Duration::from_millis(500) {
            Command::new("kill")
                .args(["-INT", &child.id().to_string()])
                .status()
                .unwrap();
            stopped = true;
        }
        assert!(since.elapsed() < Duration::from_secs(20), "it hangs");
    }
    (child.wait_with_output().unwrap(), stopped)
}
