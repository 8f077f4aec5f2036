//! dem-run
