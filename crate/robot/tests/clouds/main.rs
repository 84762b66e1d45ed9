//! Clouds of many layouts and sensors.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod layouts;
mod malformed;
mod profiles;
mod sensors;
