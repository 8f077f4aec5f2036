//! Laboratory tests: closed forms, evaluation, pictures.

mod evaluation;
mod pictures;
mod theory;
