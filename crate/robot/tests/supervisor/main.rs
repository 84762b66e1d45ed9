//! Tests of the supervisor as a whole: its states, every fault at random moments, and random sequences.

mod faults;
mod rig;
mod sequences;
mod states;
