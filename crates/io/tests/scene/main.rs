//! The reader of scenes: what it takes, what it refuses and in which words.

mod good;
mod options;
mod properties;
