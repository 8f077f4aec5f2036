//! The reader of scenes: valid scenes, refused scenes and the messages.

mod as_run;
mod cases;
mod corpus;
mod every_key;
mod feed;
mod good;
mod include;
mod laboratory;
mod options;
mod places;
mod properties;
mod schema;
mod words;
