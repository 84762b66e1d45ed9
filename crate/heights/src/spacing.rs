//! The spacing of samples.

use crate::Fault;

/// No spacing of samples is smaller than this, in metres: what is smaller is in degrees, or for a printer.
pub const MIN_CELL_M: f64 = 0.01;

/// How to say the spacing that a file does not.
pub(crate) const WAY_OUT: &str = "give the spacing in metres with cell_m under [import] of a recipe";

/// The one side of pixels that are square to one part in ten thousand. `east` and `north` are how the file
/// has its sides, `metres` how long one of its units is.
pub(crate) fn square(place: &str, east: f64, north: f64, metres: f64) -> Result<f64, Fault> {
    if !(east > 0.0 && north > 0.0 && east.is_finite() && north.is_finite()) {
        return Err(Fault::value(place, format!("{east} × {north}"), format!("lengths above 0; {WAY_OUT}")));
    }
    if (east - north).abs() > 1e-4 * east {
        let found = format!("{east} × {north}");
        return Err(Fault::value(place, found, format!("square pixels; resample the grid, or {WAY_OUT}")));
    }
    let side = 0.5 * (east + north);
    let cell_m = side * metres;
    if cell_m < MIN_CELL_M {
        let expected =
            format!("at least {MIN_CELL_M} m; if it is in degrees, project the grid, or {WAY_OUT}");
        return Err(Fault::value(place, side, expected));
    }
    Ok(cell_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearly_square_is_square_and_oblong_names_the_way_out() {
        assert_eq!(square("p", 0.5, 0.5, 1.0), Ok(0.5));
        assert!((square("p", 0.5, 0.500004, 1.0).unwrap() - 0.500002).abs() < 1e-12);
        assert_eq!(
            square("p", 0.5, 0.6, 1.0).unwrap_err().to_string(),
            "p = 0.5 × 0.6: expected square pixels; resample the grid, or give the spacing in metres with \
             cell_m under [import] of a recipe"
        );
        assert!(square("p", 0.0, 0.0, 1.0).is_err());
        assert!(square("p", f64::NAN, 1.0, 1.0).is_err());
        let degrees = square("p", 0.0002, 0.0002, 1.0).unwrap_err().to_string();
        assert!(degrees.contains("degrees") && degrees.contains("cell_m"), "{degrees}");
        assert!((square("p", 2.0, 2.0, 0.3048).unwrap() - 0.6096).abs() < 1e-12);
    }
}
