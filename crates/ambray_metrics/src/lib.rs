//! Measures of error between maps and between pictures (spec §10).
#![forbid(unsafe_code)]
