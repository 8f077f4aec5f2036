use crate::bars::{ELASTIC, bar};
use dem_run::check::ledger::balance;
use dem_run::check::limit::limit;
use dem_run::physics::bond::stiffness::BondModel;
use dem_run::step::{act, move_on, step};

#[test]
fn smoke() {
    let mut state = bar(BondModel::Timoshenko, ELASTIC, 6.53698e-6);
    let found = limit(&mut state);
    eprintln!("{found:?}");
    for (i, motion) in state.particles.motions.iter_mut().enumerate() {
        motion.velocity_m_s = [
            0.0,
            20.0 * (i as f64 - 5.0),
            if i % 2 == 0 { 3.0 } else { -2.0 },
        ];
        motion.spin_rad_s = [30.0, 5.0, 50.0];
    }
    state.ledger = dem_run::check::ledger::Ledger::opened(&state);
    let t = std::time::Instant::now();
    for _ in 0..5 {
        for _ in 0..10_000 {
            step(&mut state);
        }
        act(&mut state);
        eprintln!("{:?}", balance(&mut state));
        move_on(&mut state);
    }
    eprintln!("{:?} us/step", t.elapsed().as_secs_f64() / 5e4 * 1e6);
}
