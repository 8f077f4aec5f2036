//! End-to-end tests of the two programs live in `tests/tests`.
