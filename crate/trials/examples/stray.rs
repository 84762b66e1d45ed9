use mapless::skyline::scan_filter::ReturnKind;
use mapless_trials::{LoadedScenario, Preset, Trial};
use std::path::Path;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let rate: f64 = args[1].parse().unwrap();
    let selfs: usize = args[2].parse().unwrap();
    let names: Vec<&str> = args[3].split(',').collect();
    let seeds: Vec<u64> = args[4].split(',').map(|s| s.parse().unwrap()).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains/scenarios");
    let (mut n, mut reached) = (0, 0);
    for name in names {
        let loaded = LoadedScenario::read(&root.join(format!("{name}.toml"))).unwrap();
        for &seed in &seeds {
            let mut scenario = loaded.scenario.clone();
            scenario.sensor.stray_probability = rate;
            scenario.sensor.self_returns = selfs;
            let mut trial =
                Trial::new(loaded.terrain.field.clone(), &scenario, Preset::Default, seed).unwrap();
            let mut counts = [0usize; 6];
            let t = std::time::Instant::now();
            let mut ticks = 0;
            let mut floats = [0usize; 8];
            let mut printed = 0;
            loop {
                trial.look();
                trial.plan();
                {
                    let st = trial.robot();
                    let sp = trial.sensor().config().pose_on(st.position, st.yaw_rad, &st.attitude);
                    for (kind, point) in trial.step().return_kinds.iter().zip(&trial.scan().points) {
                        if *kind != ReturnKind::Surface {
                            continue;
                        }
                        let w = sp.position + sp.world_from_sensor * point.as_dvec3();
                        let Some(h) = trial.field().height_m(w.truncate()) else { continue };
                        let up = w.z - h;
                        let b = [0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0].iter().filter(|x| up > **x).count();
                        floats[b] += 1;
                        if b >= 5 && ticks == 5 && printed < 40 {
                            printed += 1;
                            println!(
                                "  r {:.2} el {:.1} up {:.2}",
                                point.length(),
                                (point.z / point.length()).asin().to_degrees(),
                                up
                            );
                        }
                    }
                }
                if trial.act().is_some() {
                    break;
                }
                ticks += 1;
                for kind in trial.step().return_kinds {
                    counts[*kind as usize] += 1;
                }
            }
            let m = trial.metrics();
            n += 1;
            if trial.outcome() == Some(mapless_trials::Outcome::Reached) {
                reached += 1;
            }
            println!("up {floats:?}");
            println!(
                "{name} {seed} {:?} dist {:.1} time {:.1} speed {:.3} roll {:.3} pitch {:.3} kinds {:?} {:.1}ms/tick digest {}",
                trial.outcome().unwrap(),
                m.distance_m,
                (ticks as f64 * 0.1),
                m.distance_m / (ticks as f64 * 0.1),
                m.max_abs_roll_rad,
                m.max_abs_pitch_rad,
                counts,
                1e3 * t.elapsed().as_secs_f64() / ticks as f64,
                trial.digest()
            );
        }
    }
    println!("{reached} of {n}");
}
