//! Clouds of many layouts and sensors.

mod layouts;
mod malformed;
mod profiles;
mod sensors;
