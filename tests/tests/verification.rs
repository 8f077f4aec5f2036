//! Pages of verification: results of the solver and the packer compared with closed forms and other
//! references.

mod bonded_in_part;
mod bonded_round_robin;
mod cantilevers;
mod chung_ooi;
mod clumps;
mod contacts;
mod damping;
mod dynamic_tests;
mod failure;
mod flat_joint;
mod laboratory_tests;
mod packing;
pub(crate) mod page;
mod plasticity;
mod relaxation;
pub(crate) mod scene;
mod size_ratios;
mod table;
mod time_step;
