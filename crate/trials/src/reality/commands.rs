//! Commands on their way to the drive.

use std::collections::VecDeque;

use mapless_world::{DriveCommand, MotionConfig};

/// Delays and smooths commands, one per motion step.
#[derive(Clone, Debug)]
pub(crate) struct Commands {
    /// Those that have not had an effect yet, oldest first.
    waiting: VecDeque<DriveCommand>,
    /// Share of the way to a new command that the drive goes in one step.
    share: f64,
    obeyed: DriveCommand,
}

impl Commands {
    /// For steps of `step_s`.
    pub(crate) fn new(config: &MotionConfig, step_s: f64) -> Self {
        let steps = (config.latency_s / step_s).round() as usize;
        let share = if config.lag_s > 0.0 { 1.0 - libm::exp(-step_s / config.lag_s) } else { 1.0 };
        Self { waiting: vec![DriveCommand::default(); steps].into(), share, obeyed: DriveCommand::default() }
    }

    /// What the drive tries to do in the step for which `command` is given.
    pub(crate) fn obeyed(&mut self, command: DriveCommand) -> DriveCommand {
        self.waiting.push_back(command);
        let due = self.waiting.pop_front().unwrap_or(command);
        self.obeyed = if self.share < 1.0 {
            let toward = |from: f64, to: f64| from + (to - from) * self.share;
            DriveCommand {
                speed_m_s: toward(self.obeyed.speed_m_s, due.speed_m_s),
                turn_rate_rad_s: toward(self.obeyed.turn_rate_rad_s, due.turn_rate_rad_s),
            }
        } else {
            due
        };
        self.obeyed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GO: DriveCommand = DriveCommand { speed_m_s: 1.0, turn_rate_rad_s: -0.5 };

    #[test]
    fn a_command_takes_effect_after_its_dead_time() {
        let config = MotionConfig { latency_s: 0.05, ..MotionConfig::default() };
        let mut commands = Commands::new(&config, 0.01);
        let speeds: Vec<f64> = (0..7).map(|_| commands.obeyed(GO).speed_m_s).collect();
        assert_eq!(speeds, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
        assert_eq!(Commands::new(&MotionConfig::default(), 0.01).obeyed(GO), GO);
    }

    #[test]
    fn a_lag_leaves_a_share_of_1_over_e_after_its_time_constant() {
        let config = MotionConfig { lag_s: 0.2, ..MotionConfig::default() };
        let mut commands = Commands::new(&config, 0.01);
        let last = (0..20).map(|_| commands.obeyed(GO)).last().unwrap();
        let expected = 1.0 - libm::exp(-1.0);
        assert!((last.speed_m_s - expected).abs() < 1e-12);
        assert!((last.turn_rate_rad_s + 0.5 * expected).abs() < 1e-12);
    }
}
