//! What moves and what joins it, as plain arrays.

pub mod bonds;
pub mod order;
pub mod particles;
pub mod shares;
