//! Physics as functions of plain numbers, independent of storage, threads, files and scenes.

pub mod bond;
pub mod chebyshev;
pub mod contact;
pub mod dual;
pub mod number;
pub mod rigid;
pub mod rotation;
