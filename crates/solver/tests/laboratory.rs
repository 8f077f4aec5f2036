//! Laboratory tests: closed forms, evaluation, pictures.

mod evaluation;
mod pictures;
mod section;
mod theory;
