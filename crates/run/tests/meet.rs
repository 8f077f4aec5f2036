//! Contacts between particles in the moving solver.

mod apart;
mod clouds;
mod flight;
mod joints;
mod rest;
mod surfaces;
mod walls;
mod within;
