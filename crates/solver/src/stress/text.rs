//! The suite as a table for a person, in Markdown.
