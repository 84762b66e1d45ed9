//! How a brush's effect falls off: functions of the distance from its centre or line, in radii from 0 to 1.

/// Where a crater has its rim, in radii, and the rim's height as a part of the depth.
const RIM_RADII: f64 = 0.6;
const RIM_HEIGHT: f64 = 0.25;

/// From 0 to 1 as `x` goes from 0 to 1, level at both ends and beyond.
pub fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// `(1 - r²)²`: 1 at the centre, level there and at the radius.
pub(super) fn bump(radii: f64) -> f64 {
    let rest = 1.0 - radii * radii;
    rest * rest
}

/// A bowl down to -1 within a rim that fades out to the radius.
pub(super) fn crater(radii: f64) -> f64 {
    if radii < RIM_RADII {
        (1.0 + RIM_HEIGHT) * smooth_step(radii / RIM_RADII) - 1.0
    } else {
        RIM_HEIGHT * (1.0 - smooth_step((radii - RIM_RADII) / (1.0 - RIM_RADII)))
    }
}

/// `1 - r⁴`: a round top and steep sides.
pub(super) fn boulder(radii: f64) -> f64 {
    let squared = radii * radii;
    1.0 - squared * squared
}

/// 1 out to 0.6 radii, then down to 0.
pub(super) fn flat_top(radii: f64) -> f64 {
    1.0 - smooth_step((radii - 0.6) / 0.4)
}

/// 1 out to 0.25 radii, then down to 0: the flanks of a channel.
pub(super) fn flat_bottom(radii: f64) -> f64 {
    1.0 - smooth_step((radii - 0.25) / 0.75)
}
