//! Mapless navigation on uneven terrain.
