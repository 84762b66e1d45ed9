//! `Trial::question` and `Trial::decide`: a navigator that asks somebody else.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::time::Duration;

use glam::Vec3;
use mapless::{Command, Goal, Planner, Pose};
use mapless_trials::{Activity, Decision, Navigator, Outcome, Preset, Scenario, Trial};
use mapless_world::HeightField;

const SCENARIO: &str = "terrain = \"it\"\nstart = [10.0, 10.0, 0.0]\ngoal = [16.0, 11.0]\nseed = 7\n";

/// Says what it was told.
struct Told {
    decision: Decision,
    sight_m: f64,
}

impl Navigator for Told {
    fn navigate(&mut self, _: &[Vec3], _: &Pose, _: &Goal, _: Duration) -> Decision {
        self.decision
    }

    fn sight_m(&self) -> f64 {
        self.sight_m
    }

    fn max_speed_m_s(&self) -> f64 {
        1.0
    }

    fn reset(&mut self) {}
}

#[test]
fn a_planner_that_is_asked_from_outside_drives_as_within() {
    for more in ["", "[reality.sensing]\nscan_delay_periods = 2\n"] {
        let scenario = Scenario::parse("it", &format!("{SCENARIO}{more}")).unwrap();
        let heights = (0..121 * 121).map(|i| 0.3 * libm::sinf(0.1 * (i % 121) as f32)).collect();
        let field = HeightField::new(121, 121, 0.25, heights).unwrap();
        let mut own = Trial::new(field.clone(), &scenario, Preset::Default, 7).unwrap();
        while own.tick().is_none() {}
        assert_eq!(own.outcome(), Some(Outcome::Reached));

        let mut planner = Planner::new(scenario.planner_config(Preset::Default).unwrap()).unwrap();
        let decision = Decision { activity: Activity::Searching, command: Command::STOP };
        let told = Told { decision, sight_m: planner.sight_m() };
        let mut asked = Trial::with_navigator(field, &scenario, told, 7).unwrap();
        while asked.outcome().is_none() {
            asked.look();
            if let Some(question) = asked.question() {
                let points = asked.scan().points.clone();
                let answer = planner.navigate(&points, &question.pose, &question.goal, question.elapsed);
                asked.navigator_mut().decision = answer;
                asked.decide(&question);
            }
            asked.act();
        }
        assert_eq!(asked.digest(), own.digest());
    }
}
