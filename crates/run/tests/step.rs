//! The moving solver: largest steps, energy and momentum, frequencies, reproducibility.

mod breakage;
mod energy;
mod frequencies;
mod ledger;
mod limit;
mod local_damping;
mod lowest_frequency;
mod neighbours;
mod rigid;
mod threads;
mod watchdog;
mod waves;
