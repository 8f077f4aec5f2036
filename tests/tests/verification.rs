//! Pages of verification: what the solver and the packer give against closed forms and other
//! references.

mod cantilevers;
mod contacts;
mod failure;
mod page;
mod scene;
mod table;
