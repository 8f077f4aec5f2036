//! Bonds break at the right place and time, and leave nothing behind.

mod after;
mod bodies;
mod books;
mod damage;
mod loads;
mod rate;
mod scatter;
