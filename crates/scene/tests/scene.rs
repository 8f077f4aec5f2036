//! The reader of scenes: what it takes, what it refuses and in which words.

mod corpus;
mod feed;
mod good;
mod options;
mod properties;
mod schema;
