//! Laboratory tests: closed forms, evaluation, pictures.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod evaluation;
mod pictures;
mod theory;
