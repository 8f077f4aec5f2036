//! Pages of verification: what the solver and the packer give against closed forms and other
//! references.

mod cantilevers;
mod clumps;
mod contacts;
mod damping;
mod failure;
mod packing;
mod page;
mod relaxation;
mod scene;
mod table;
mod time_step;
