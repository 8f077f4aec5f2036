//! Physics as functions of plain numbers: nothing here knows of storage, threads, files or scenes.

pub mod bond;
pub mod contact;
pub mod dual;
pub mod number;
pub mod rigid;
pub mod rotation;
