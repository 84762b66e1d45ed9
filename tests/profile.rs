//! The perceived elevation profile against the true skyline, on the repository's terrains and on fresh ones.
//! `cargo xtask profile` measures the same over many more poses.

use std::path::{Path, PathBuf};

use mapless::PlannerConfig;
use mapless_terrain::{Fault, load_recipe, load_terrain};
use mapless_trials::{ProfileAccuracy, TrialError, profile_accuracy};
use mapless_world::{Caster, HeightField, RobotConfig, SensorConfig};

const POSES: usize = 25;

fn measure(field: HeightField) -> Result<ProfileAccuracy, TrialError> {
    let (sensor, robot) = (SensorConfig::default(), RobotConfig::default());
    let caster = Caster::new(field);
    profile_accuracy(&caster, &sensor, &robot, &PlannerConfig::default(), POSES, 5)
}

fn assert_trusted(name: &str, accuracy: &ProfileAccuracy) {
    let degrees = |angle_rad: f64| angle_rad.to_degrees();
    assert_eq!((accuracy.poses, accuracy.no_perception, accuracy.holes), (POSES, 0, 0), "{name}");
    assert!(degrees(accuracy.mean_abs_error_rad) <= 0.35, "{name}: {accuracy:?}");
    assert!(degrees(accuracy.worst_pose_error_rad) <= 0.6, "{name}: {accuracy:?}");
    let right: usize = (0..3).map(|kind| accuracy.confusion[kind][kind]).sum();
    let all: usize = accuracy.confusion.iter().flatten().sum();
    assert!(right as f64 >= 0.98 * all as f64, "{name}: {:?}", accuracy.confusion);
}

#[test]
fn the_profile_can_be_trusted() {
    let terrains = Path::new(env!("CARGO_MANIFEST_DIR")).join("../terrains");
    let mut fields: Vec<(String, HeightField)> = ["cht", "ml", "vta", "gsb", "ht"]
        .map(|name| {
            let path: PathBuf = terrains.join(name).with_extension("toml");
            (name.to_owned(), load_terrain(&path).unwrap().field)
        })
        .into();
    for (seed, height_m, wavelength_m) in [(31, 3.0, 18.0), (32, 5.0, 25.0)] {
        let recipe = format!(
            "name = \"fresh\"\ndescription = \"Noise.\"\nsize_m = [50.0, 50.0]\ncell_m = 0.2\nseed = {seed}\n\
             [[noise]]\namplitude_m = {height_m:?}\nwavelength_m = {wavelength_m:?}\noctaves = 4\n"
        );
        let terrain = load_recipe("fresh.toml", recipe.as_bytes(), &mut |_, _| {
            Err(Fault::Read { reason: "none".into() })
        })
        .unwrap();
        fields.push((format!("fresh {seed}"), terrain.field));
    }
    let (mut bias, mut columns) = (0.0, 0.0);
    for (name, field) in fields {
        let accuracy = measure(field).unwrap();
        assert_trusted(&name, &accuracy);
        let ground = accuracy.confusion[0][0] as f64;
        bias += ground * accuracy.bias_rad;
        columns += ground;
    }
    let bias_deg: f64 = f64::to_degrees(bias / columns);
    assert!(bias_deg.abs() <= 0.1, "bias {bias_deg}°");
}
