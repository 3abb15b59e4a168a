//! Opens the window of `ambray view` on a screen in memory, as a user would: with scripts, and with a keyboard and a mouse.
#![cfg(all(feature = "view", target_os = "linux"))]
#![forbid(unsafe_code)]

mod display;
mod dropped;
mod picture;
mod scripted;
mod touched;
