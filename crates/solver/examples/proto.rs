#![allow(clippy::all, clippy::unwrap_used, clippy::print_stdout, missing_docs)]
use dem_run::physics::bond::failure::Criteria;
use dem_run::physics::bond::stiffness::*;
use dem_run::stages::bonds::bond_wrenches;
use dem_run::state::bonds::*;
use dem_run::state::particles::Particles;
use dem_run::state::shares::divide;
fn main() {
    let body =
        dem_io::body::read_body(std::path::Path::new(&std::env::args().nth(1).unwrap())).unwrap();
    let fail = std::env::args().nth(2).is_some();
    let mut order: Vec<usize> = (0..body.radii.len()).collect();
    let cell = 0.0005;
    order.sort_by_key(|&i| {
        let p = body.positions[i];
        let c = p.map(|x| ((x + 1.0) / cell) as u64);
        let mut m = 0u64;
        for bit in 0..12 {
            for k in 0..3 {
                m |= ((c[k] >> bit) & 1) << (3 * bit + k);
            }
        }
        m
    });
    let mut new = vec![0u32; order.len()];
    for (n, &o) in order.iter().enumerate() {
        new[o] = n as u32;
    }
    let mut p = Particles::default();
    for &o in &order {
        p.push_sphere(body.positions[o], body.radii[o], 2000.0);
    }
    let mut list: Vec<(u32, u32, usize)> = body
        .bonds
        .iter()
        .enumerate()
        .map(|(i, b)| {
            let (x, y) = (new[b[0] as usize], new[b[1] as usize]);
            (x.min(y), x.max(y), i)
        })
        .collect();
    list.sort();
    let mut bonds = Bonds::default();
    bonds.rules.push(BondRule {
        incremental: false,
        damped: false,
        criteria: fail.then_some(Criteria {
            tension_pa: 1e7,
            shear_pa: 1e7,
            von_mises_pa: f64::INFINITY,
            compressive: true,
        }),
        strengthening_from_1_s: None,
    });
    for (a, b, i) in list {
        let (pa, pb) = (
            p.poses[a as usize].position_m,
            p.poses[b as usize].position_m,
        );
        let d = [0, 1, 2].map(|k| pb[k] - pa[k]);
        let l = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let s = stiffness(
            BondModel::Timoshenko,
            &BondShape {
                length_m: l,
                radius_m: body.bond_radii[i],
                end_radii_m: [p.radii_m[a as usize], p.radii_m[b as usize]],
            },
            1e7,
            0.3,
        );
        bonds.push([a, b], d.map(|x| x / l), body.bond_radii[i], &s, 0);
    }
    for shares in [1, 2, 4] {
        let mut shares = divide(&bonds, p.len(), shares);
        let border: usize = shares
            .iter()
            .flat_map(|s| &s.batches)
            .map(|b| match &b.which {
                dem_run::state::shares::Which::Border(l) => l.len(),
                _ => 0,
            })
            .sum();
        let mut best = f64::MAX;
        let n = (1_000_000 / bonds.len()).max(1);
        for _ in 0..300 {
            let t = std::time::Instant::now();
            for _ in 0..n {
                bond_wrenches(&bonds, &p.poses, &mut shares, &mut p.wrenches);
            }
            best = best.min(t.elapsed().as_secs_f64() / (n * bonds.len()) as f64);
        }
        println!(
            "{} shares {} border {border}, {} bonds, {:.2} ns best, {:.1} M/s {:?}",
            shares.len(),
            p.len(),
            bonds.len(),
            best * 1e9,
            1e-6 / best,
            p.wrenches[100].force_n
        );
    }
}
