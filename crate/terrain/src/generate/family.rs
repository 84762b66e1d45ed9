//! Names of the kinds of generated terrain.

use std::fmt;
use std::str::FromStr;

/// How hard generated ground is to cross.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Difficulty {
    /// Little is steeper than a Husky may roll.
    Easy,
    /// Many flanks have to be gone around.
    Moderate,
    /// Most flanks have to be gone around, and the ground between is rough.
    Hard,
}

/// A kind of generated terrain.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Family {
    /// Bare ground.
    Ground(Difficulty),
    /// A field of rocks; the low ones pass beneath the robot.
    Rocks,
    /// A wood of posts.
    Posts,
    /// Walls with openings and gates, corners and dead ends.
    Walls,
    /// Ditches with crossings, and some narrow enough to drive over.
    Ditches,
    /// Some of all that on ground of any difficulty.
    Mixed,
    /// People who walk about.
    Movers,
}

/// A name that is no family.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("family \"{name}\": expected one of {}", Family::ALL.map(Family::name).join(", "))]
pub struct UnknownFamily {
    /// The name.
    pub name: String,
}

impl Difficulty {
    /// All of them, easy first.
    pub const ALL: [Self; 3] = [Self::Easy, Self::Moderate, Self::Hard];
}

impl Family {
    /// All of them, bare ground first, from easy to hard.
    pub const ALL: [Self; 9] = [
        Self::Ground(Difficulty::Easy),
        Self::Ground(Difficulty::Moderate),
        Self::Ground(Difficulty::Hard),
        Self::Rocks,
        Self::Posts,
        Self::Walls,
        Self::Ditches,
        Self::Mixed,
        Self::Movers,
    ];

    /// The name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ground(Difficulty::Easy) => "easy",
            Self::Ground(Difficulty::Moderate) => "moderate",
            Self::Ground(Difficulty::Hard) => "hard",
            Self::Rocks => "rocks",
            Self::Posts => "posts",
            Self::Walls => "walls",
            Self::Ditches => "ditches",
            Self::Mixed => "mixed",
            Self::Movers => "movers",
        }
    }

    /// Its place in [`Family::ALL`], by which seeds differ.
    #[must_use]
    pub fn index(self) -> u64 {
        Self::ALL.iter().position(|&family| family == self).unwrap_or_default() as u64
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Family {
    type Err = UnknownFamily;

    fn from_str(name: &str) -> Result<Self, UnknownFamily> {
        let found = Self::ALL.into_iter().find(|family| family.name() == name);
        found.ok_or_else(|| UnknownFamily { name: name.to_owned() })
    }
}
