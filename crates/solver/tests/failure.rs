//! Bonds break where they should, when they should, and leave nothing behind.

mod after;
mod bodies;
mod books;
mod loads;
mod rate;
mod scatter;
