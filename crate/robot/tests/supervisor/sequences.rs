//! Random sequences of inputs, times and faults: no command beyond the limits, none without fresh input.

use core::time::Duration;

use mapless::Command;
use mapless_robot::supervisor::{
    Decision, Inputs, Message, Outcome, Proposal, State, Supervisor, SupervisorConfig,
};
use mapless_world::random::Sequence;

const TICKS: usize = 120;

/// What the supervisor should know, kept by the stated rules and not by its code.
#[derive(Default)]
struct Oracle {
    fresh: [Option<Duration>; 3],
    stamps_ns: [Option<i64>; 3],
    is_pressed: bool,
    told_of_emergency_stop: Option<Duration>,
    void_goal: Option<u64>,
    speeds: [f64; 2],
    accelerations: [f64; 2],
    /// How far they may be rounded.
    slack: f64,
    now: Duration,
}

/// Runs a random sequence; ticks that drove.
fn run(seed: u64) -> Result<usize, String> {
    let mut random = Sequence::new(seed);
    let mut uniform = |low: f64, high: f64| random.between([low, high]);
    let config = SupervisorConfig {
        clear_after_s: uniform(0.0, 0.3),
        has_emergency_stop: uniform(0.0, 1.0) > 0.3,
        max_speed_m_s: uniform(0.2, 2.0),
        max_acceleration_m_s2: uniform(0.3, 5.0),
        max_jerk_m_s3: uniform(0.5, 50.0),
        ..SupervisorConfig::default()
    };
    let mut supervisor = Supervisor::new(config).map_err(|error| error.to_string())?;
    let mut oracle = Oracle { now: Duration::from_secs(10), ..Oracle::default() };
    let mut chance = |probability: f64| random.happens(probability);
    // From nothing but good input to mostly bad.
    let badness = [0.0, 0.002, 0.02, 0.2][usize::from(chance(0.5)) + 2 * usize::from(chance(0.5))];
    let (mut goal, mut drove) = (None, 0);
    for tick in 0..TICKS {
        let last = oracle.now;
        oracle.now = next_time(last, badness, &mut random);
        let now = oracle.now;
        let elapsed_s = now.saturating_sub(last).as_secs_f64();
        if now < last {
            oracle.fresh = [None; 3];
        }
        if random.happens(if goal.is_none() { 0.1 } else { badness }) {
            goal = Some(goal.unwrap_or(0) + 1);
        }
        let messages = [0.3, 0.9, 0.97].map(|rate| (random.happens(rate), random.happens(badness)));
        let mut streams = [None; 3];
        for (index, (comes, is_bad)) in messages.into_iter().enumerate() {
            if comes {
                let message = message(now, oracle.stamps_ns[index].unwrap_or(0), is_bad, &mut random);
                if message.is_well_formed && Some(message.stamp_ns) != oracle.stamps_ns[index] {
                    (oracle.fresh[index], oracle.stamps_ns[index]) = (Some(now), Some(message.stamp_ns));
                }
                streams[index] = Some(message);
            }
        }
        let inputs = Inputs {
            scan: streams[0],
            odometry: streams[1],
            imu: streams[2],
            emergency_stop: random.happens(0.5).then(|| random.happens(badness)),
            attitude_rad: random
                .happens(0.9)
                .then(|| if random.happens(badness) { [0.0, f64::NAN] } else { [0.1; 2] }),
            has_jumped: random.happens(badness / 5.0),
            wheels_disagree: random.happens(badness / 5.0),
            has_peer: !random.happens(badness),
            publish_failed: random.happens(badness / 5.0),
            other_publishers: usize::from(random.happens(badness / 5.0)),
            goal: goal.filter(|_| !random.happens(badness / 2.0)),
            reset: random.happens(badness),
            ..Inputs::default()
        };
        let proposal = random.happens(0.5).then(|| Proposal {
            goal: goal.unwrap_or(0),
            scan_arrived: now,
            outcome: outcome(badness, &mut random),
        });
        if let Some(is_pressed) = inputs.emergency_stop {
            (oracle.is_pressed, oracle.told_of_emergency_stop) = (is_pressed, Some(now));
        }
        let decision = supervisor.tick(now, &inputs, proposal.as_ref());
        oracle
            .judge(&config, &inputs, proposal.as_ref(), &decision, [elapsed_s, seconds(last, now)])
            .map_err(|fault| {
                format!("seed {seed}, tick {tick}: {fault}: {decision:?} {inputs:?} {proposal:?}")
            })?;
        drove += usize::from(decision.command != Command::STOP);
    }
    Ok(drove)
}

/// Seconds from one time to another, negative when time went back.
fn seconds(from: Duration, to: Duration) -> f64 {
    if to < from { -(from - to).as_secs_f64() } else { (to - from).as_secs_f64() }
}

fn next_time(now: Duration, badness: f64, random: &mut Sequence) -> Duration {
    if !random.happens(badness) {
        return now + Duration::from_secs_f64(random.between([0.01, 0.03]));
    }
    match random.whole([0, 4]) {
        0 => now,
        1 => now + Duration::from_nanos(1),
        2 => now + Duration::from_secs_f64(random.between([0.1, 0.2])),
        3 => now + Duration::from_secs_f64(random.between([0.2, 5.0])),
        _ => now.saturating_sub(Duration::from_secs_f64(random.between([0.0, 2.0]))),
    }
}

fn message(now: Duration, last_ns: i64, is_bad: bool, random: &mut Sequence) -> Message {
    let now_ns = now.as_nanos() as i64;
    let good = Message {
        arrived: now,
        clock_ns: now_ns,
        stamp_ns: now_ns - 5_000_000,
        fingerprint: (random.share() * 1e15) as u64,
        is_well_formed: true,
    };
    if !is_bad {
        return good;
    }
    match random.whole([0, 4]) {
        0 => Message { is_well_formed: false, ..good },
        1 => Message { stamp_ns: last_ns, ..good },
        2 => Message { stamp_ns: good.stamp_ns + 10_000_000_000, ..good },
        3 => Message { stamp_ns: good.stamp_ns.wrapping_mul(1 << 20), ..good },
        _ => Message { arrived: now + Duration::from_secs(1000), ..good },
    }
}

fn outcome(badness: f64, random: &mut Sequence) -> Outcome {
    if random.happens(badness) {
        return match random.whole([0, 3]) {
            0 => Outcome::Stopped,
            1 => Outcome::Panicked,
            2 => Outcome::Command(Command { linear_m_s: f64::NAN, angular_rad_s: 1.0 }),
            _ => Outcome::Command(Command { linear_m_s: 1e300, angular_rad_s: f64::NEG_INFINITY }),
        };
    }
    let extreme = if random.happens(0.2) { 1e6 } else { 1.0 };
    let (linear_m_s, angular_rad_s) =
        (random.between([-extreme, extreme]), random.between([-extreme, extreme]));
    Outcome::Command(Command { linear_m_s, angular_rad_s })
}

impl Oracle {
    fn judge(
        &mut self,
        config: &SupervisorConfig,
        inputs: &Inputs,
        proposal: Option<&Proposal>,
        decision: &Decision,
        [elapsed_s, since_last_s]: [f64; 2],
    ) -> Result<(), String> {
        let speeds = [decision.command.linear_m_s, decision.command.angular_rad_s];
        let may_not =
            |holds: bool, what: &str| if holds { Err(format!("moves although {what}")) } else { Ok(()) };
        if decision.command != Command::STOP {
            may_not(decision.state != State::Driving, "it does not drive")?;
            for (fresh, limit_s) in self.fresh.iter().zip([config.scan_s, config.odometry_s, config.imu_s]) {
                let age_s = fresh.map_or(f64::INFINITY, |fresh| seconds(fresh, self.now));
                may_not(age_s > limit_s, "an input is stale")?;
            }
            may_not(self.is_pressed, "the emergency stop is pressed")?;
            let told_s = self.told_of_emergency_stop.map_or(f64::INFINITY, |told| seconds(told, self.now));
            may_not(
                config.has_emergency_stop && told_s > config.emergency_stop_s,
                "the emergency stop is silent",
            )?;
            may_not(inputs.goal.is_none() || inputs.goal <= self.void_goal, "its goal is void")?;
            may_not(since_last_s < 0.0 || since_last_s > config.tick_s, "time jumped")?;
            let leans = |[roll, pitch]: [f64; 2]| {
                !(roll.abs() <= config.max_roll_rad && pitch.abs() <= config.max_pitch_rad)
            };
            may_not(inputs.attitude_rad.is_some_and(leans), "it leans")?;
            may_not(inputs.has_jumped || inputs.wheels_disagree, "the estimator warns")?;
            may_not(inputs.publish_failed || inputs.other_publishers > 0, "publishing is disturbed")?;
            let answer = proposal
                .filter(|proposal| Some(proposal.goal) == inputs.goal)
                .map(|proposal| proposal.outcome);
            may_not(matches!(answer, Some(Outcome::Stopped | Outcome::Panicked)), "the planner gave up")?;
        }
        if matches!(decision.state, State::Aborted | State::Latched) {
            self.void_goal = self.void_goal.max(inputs.goal);
        }
        if decision.state != State::Driving {
            (self.speeds, self.accelerations) = ([0.0; 2], [0.0; 2]);
            return if decision.command == Command::STOP {
                Ok(())
            } else {
                Err("a stop is not zero".to_owned())
            };
        }
        let limits = [
            [config.max_speed_m_s, config.max_acceleration_m_s2, config.max_jerk_m_s3],
            [config.max_turn_rate_rad_s, config.max_turn_acceleration_rad_s2, config.max_turn_jerk_rad_s3],
        ];
        // Speeds are rounded to 16 digits, and then divided by a time of 1 ns or more.
        let slack = 1e-9 + 1e-15 / elapsed_s.max(1e-9);
        for (axis, [most, acceleration, jerk]) in limits.into_iter().enumerate() {
            let change = speeds[axis] - self.speeds[axis];
            let rate = if elapsed_s > 0.0 { change / elapsed_s } else { self.accelerations[axis] };
            let is_within = speeds[axis].abs() <= most
                && change.abs() <= acceleration * elapsed_s + 1e-12
                && (rate - self.accelerations[axis]).abs() <= jerk * elapsed_s + slack + self.slack;
            if !is_within {
                return Err(format!("axis {axis} is beyond a limit: {change} in {elapsed_s} s"));
            }
            (self.speeds[axis], self.accelerations[axis]) = (speeds[axis], rate);
        }
        self.slack = slack;
        Ok(())
    }
}

/// 5000 sequences, or as many as `MAPLESS_SEQUENCES` says.
#[test]
fn no_sequence_gives_a_command_beyond_limits_or_without_fresh_input() {
    let sequences = std::env::var("MAPLESS_SEQUENCES").map_or(5000, |text| text.parse().unwrap());
    let drove: usize =
        (0..sequences).map(|seed| run(seed).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"))).sum();
    let share = drove as f64 / (sequences as usize * TICKS) as f64;
    assert!((0.2..0.8).contains(&share), "{share} of the ticks move");
}
