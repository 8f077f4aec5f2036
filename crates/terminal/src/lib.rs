//! What both programs share at a terminal: arguments, completions, man pages and signals; colours;
//! standard output and standard error.

pub mod colour;
pub mod program;
pub mod standard_output;
