//! Particles that meet: contacts in the moving solver.

mod apart;
mod clouds;
mod rest;
mod surfaces;
mod walls;
