//! STL bytes -> facets, behind our own checks.
