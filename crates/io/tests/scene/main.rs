//! The reader of scenes: what it takes, what it refuses and in which words.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod corpus;
mod feed;
mod good;
mod options;
mod properties;
