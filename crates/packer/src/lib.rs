//! dem-pack
