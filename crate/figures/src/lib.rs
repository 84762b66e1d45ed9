//! Figures as SVG: line plots, and maps of a terrain.
//!
//! [`plot`] draws lines over one axis. [`map`] draws a shaded and contoured terrain on a white [`page`], on
//! which the caller puts routes and [`marks`]. The same input gives the same bytes.

#[cfg(feature = "maps")]
mod contours;
#[cfg(feature = "maps")]
pub mod map;
#[cfg(feature = "maps")]
pub mod marks;
#[cfg(feature = "maps")]
pub mod page;
pub mod plot;
#[cfg(feature = "maps")]
mod relief;
#[cfg(feature = "maps")]
pub mod scale;

/// Why a figure cannot be drawn.
#[cfg(feature = "maps")]
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The text did not take it.
    #[error(transparent)]
    Text(#[from] std::fmt::Error),
    /// An image within it cannot be encoded.
    #[error("image: {0}")]
    Image(#[from] png::EncodingError),
}
