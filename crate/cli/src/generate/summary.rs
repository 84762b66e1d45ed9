//! Measures of the difficulty of generated tasks.

use comfy_table::{CellAlignment, Table, presets};
use mapless_baselines::Task;
use mapless_terrain::generate::BANK_REACH_M;
use mapless_world::{RobotConfig, SlopeDistribution};

/// A measure of a task: its name, its unit and its decimals in the table.
const MEASURES: [(&str, &str, usize); 9] = [
    ("relief", "m", 1),
    ("slope, median", "°", 1),
    ("slope, 90 %", "°", 1),
    ("slope, 99 %", "°", 1),
    ("ground beyond the roll limit", "%", 1),
    ("ground beyond the pitch limit", "%", 1),
    ("straight distance", "m", 1),
    ("oracle's path", "m", 1),
    ("path / straight distance", "", 3),
];

/// Collects the measures of every task.
#[derive(Default)]
pub(super) struct Summary {
    values: [Vec<f64>; MEASURES.len()],
    drawn: u32,
    straight_is_safe: usize,
}

impl Summary {
    /// Measures a task, without the bank around its terrain.
    pub(super) fn add(&mut self, task: &Task) {
        let Some(slopes) = SlopeDistribution::of(&task.terrain.field, BANK_REACH_M) else { return };
        let robot = RobotConfig::default();
        let (straight_m, path_m) = (task.straight_m(), task.path.length_m);
        let measured = [
            slopes.relief_m,
            slopes.quantile_rad(0.5).to_degrees(),
            slopes.quantile_rad(0.9).to_degrees(),
            slopes.quantile_rad(0.99).to_degrees(),
            100.0 * slopes.share_above(robot.roll_limit_rad),
            100.0 * slopes.share_above(robot.pitch_limit_rad),
            straight_m,
            path_m,
            path_m / straight_m,
        ];
        for (values, value) in self.values.iter_mut().zip(measured) {
            values.push(value);
        }
        self.drawn += task.drawn;
        self.straight_is_safe += usize::from(task.straight_is_safe);
    }

    /// Quantiles over the tasks, and how many were drawn.
    pub(super) fn table(mut self) -> String {
        let mut table = Table::new();
        table.load_preset(presets::NOTHING);
        table.set_header(["over the tasks", "10 %", "median", "90 %", "most", ""]);
        for ((name, unit, decimals), values) in MEASURES.into_iter().zip(&mut self.values) {
            values.sort_by(f64::total_cmp);
            let shown = [10, 50, 90, 100].map(|percent| format!("{:.decimals$}", quantile(values, percent)));
            let [low, median, high, most] = shown;
            table.add_row([name, &low, &median, &high, &most, unit]);
        }
        for column in 1..5 {
            if let Some(values) = table.column_mut(column) {
                values.set_cell_alignment(CellAlignment::Right);
            }
        }
        let (tasks, drawn) = (self.values[0].len(), self.drawn);
        format!(
            "{}\n\n{tasks} tasks; the oracle solved {tasks} of {drawn} drawn ({:.0} %). The straight line is safe in {} of {tasks}.",
            table.trim_fmt(),
            100.0 * tasks as f64 / f64::from(drawn),
            self.straight_is_safe
        )
    }
}

/// The nearest rank of a sorted list, which is not empty.
fn quantile(sorted: &[f64], percent: usize) -> f64 {
    let rank = (sorted.len() * percent).div_ceil(100).max(1);
    sorted[rank - 1]
}
