//! Tests of this crate through its public interface.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod body_files;
mod interrupted_write;
mod surfaces;
mod units;
mod whole_folder;
