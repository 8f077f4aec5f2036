//! What both programs share at a terminal: arguments, completions, man pages and signals; colours;
//! standard output, standard error and progress on it.

pub mod colour;
pub mod program;
pub mod progress;
pub mod standard_output;
