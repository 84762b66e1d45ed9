//! A terrain, and what may be wrong with its file.

use mapless_heights::{Fault, Grid};
use mapless_world::{FieldError, HeightField, Object};
use thiserror::Error;

/// A named piece of ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// Name of the terrain: that of the recipe, otherwise the file's name without extension.
    pub name: String,
    /// One sentence about it; empty for an imported grid.
    pub description: String,
    /// The ground.
    pub field: HeightField,
    /// What stands and walks on it.
    pub objects: Vec<Object>,
    /// What was done to an imported grid that its owner should know, each with the file's name.
    pub warnings: Vec<String>,
}

/// Why a terrain could not be loaded: the file and what is wrong with it.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{file}: {fault}")]
pub struct TerrainError {
    /// The file with the fault, which may be an image that a recipe imports.
    pub file: String,
    /// What is wrong.
    pub fault: TerrainFault,
}

/// What is wrong with a terrain file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TerrainFault {
    /// A file that cannot be read, or a value in it that is not allowed.
    #[error(transparent)]
    File(#[from] Fault),
    /// The values make no height field.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl TerrainFault {
    pub(crate) fn value(place: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Fault::value(place, value, expected).into()
    }

    pub(crate) fn damaged(format: &'static str, reason: impl ToString) -> Self {
        Fault::damaged(format, reason).into()
    }

    pub(crate) fn of(self, file: &str) -> TerrainError {
        TerrainError { file: file.to_owned(), fault: self }
    }
}

/// The ground of a grid, and its warnings, each with the file's name.
pub(crate) fn ground(file: &str, grid: Grid) -> Result<(HeightField, Vec<String>), TerrainError> {
    let Grid { columns, rows, cell_m, heights_m, warnings } = grid;
    let field = HeightField::new(columns, rows, cell_m, heights_m)
        .map_err(|fault| TerrainFault::from(fault).of(file))?;
    Ok((field, warnings.into_iter().map(|warning| format!("{file}: {warning}")).collect()))
}
