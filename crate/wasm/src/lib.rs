//! The page's core.
