//! Static cases of Chen et al. 2022, run through the time stepping to rest, and the page about
//! them.

mod bar;
mod cases;
mod models;
mod page;
mod statics;
mod tables;
