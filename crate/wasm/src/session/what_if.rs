//! Thinking again: the decision that would be taken where the robot stands, which the run has not taken.

use mapless::gp::learning::LearningMode;
use mapless_trials::{Preset, Scenario, Trial};
use mapless_world::HeightField;
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::{Moment, Session};
use crate::decision;
use crate::opening::{Learning, Preset as PresetName};
use crate::shared::{Overrides, changed, read};

/// So many of the past looks are shown to a planner that has not driven here, so that it remembers the ground
/// around the robot; each costs as much as a tick.
const PAST_LOOKS: usize = 2;

/// Spacing of the samples of ground on which nothing happens.
const BARE_CELL_M: f64 = 1.0;

/// What the planner thinks with.
#[derive(Debug, Deserialize, Tsify)]
pub struct ThinkingWith {
    overrides: Overrides,
    #[tsify(type = "Preset")]
    preset: PresetName,
    /// The scenario's own without it.
    #[tsify(optional)]
    learning: Option<Learning>,
}

/// Whether a frame shows what the run decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Thought {
    /// What the run decided.
    Run,
    /// What the run would decide here, after a change of ground, objects or route.
    Again,
    /// What would be decided here with other parameters.
    WhatIf,
}

/// A decision on what is sensed where the robot stands.
#[derive(Clone, Debug)]
pub(super) struct Rethought {
    pub(super) moment: Moment,
    /// Other parameters than the run's, where it was thought with such.
    other: Option<Setting>,
    /// The skyline that the run's own parameters give, or gave before the ground changed.
    pub(super) former: Vec<f32>,
}

#[derive(Clone, Debug)]
struct Setting {
    /// So equipped, before it thought.
    trial: Trial,
    running: Scenario,
    preset: Preset,
    learning: Option<LearningMode>,
}

impl Rethought {
    pub(super) fn kind(&self) -> Thought {
        if self.other.is_some() { Thought::WhatIf } else { Thought::Again }
    }
}

impl Moment {
    /// Senses and decides here.
    fn think(&mut self) {
        self.sense();
        self.plan();
    }

    fn skyline(&self) -> Vec<f32> {
        self.trial.step().profile.iter().map(decision::column_elevation_rad).collect()
    }
}

/// Level ground as large as `field`: what a trial stands on that only lends its equipment does not matter.
fn bare_ground(field: &HeightField) -> Result<HeightField, JsError> {
    let extent_m = field.extent_m();
    let samples = |length_m: f64| (length_m / BARE_CELL_M).ceil() as usize + 1;
    let (columns, rows) = (samples(extent_m.x), samples(extent_m.y));
    Ok(HeightField::new(columns, rows, BARE_CELL_M, vec![0.0; columns * rows])?)
}

#[wasm_bindgen]
impl Session {
    /// Senses and decides again where the robot stands, with other parameters where they are given; frames
    /// show that until the run goes on. The run itself stays as it was.
    ///
    /// # Errors
    /// A value that makes no sense or cannot change under way, with its place and what was expected; nothing
    /// then changes.
    pub fn think_again(&mut self, with: Option<Ts<ThinkingWith>>) -> Result<(), JsError> {
        let with = with.map(read).transpose()?;
        self.look_again()?;
        let Some(ThinkingWith { overrides, preset, learning }) = with else {
            self.rethink();
            return Ok(());
        };
        let (preset, learning) = (preset.into(), learning.map(LearningMode::from));
        let running = changed(&self.file, &overrides)?;
        let other =
            super::trial(bare_ground(self.now.trial.field())?, &running, preset, learning, self.seed)?;
        let mut moment = self.now.clone();
        moment.trial.equip(self.informed(other)?)?;
        let trial = moment.trial.clone();
        moment.think();
        let former = match &self.rethought {
            Some(before) if before.other.is_some() => before.former.clone(),
            _ => self.thought_by_run().skyline(),
        };
        let other = Some(Setting { trial, running, preset, learning });
        self.rethought = Some(Rethought { moment, other, former });
        Ok(())
    }

    /// Shows what the run decided again.
    pub fn forget_thought(&mut self) {
        self.rethought = None;
    }

    /// Goes on from here with the parameters that were thought with last; without such, nothing changes. The
    /// timeline begins anew.
    pub fn go_on_so(&mut self) {
        let Some(Rethought { other: Some(other), .. }) = self.rethought.take() else { return };
        (self.now.trial, self.history) = (other.trial, None);
        (self.running, self.preset, self.learning) = (other.running, other.preset, other.learning);
    }

    /// With the run's own parameters, after a change.
    fn rethink(&mut self) {
        let former = match self.rethought.take() {
            Some(before) => before.former,
            None => self.now.skyline(),
        };
        self.rethought = Some(Rethought { moment: self.thought_by_run(), other: None, former });
    }

    fn thought_by_run(&self) -> Moment {
        let mut moment = self.now.clone();
        moment.think();
        moment
    }

    /// The trial after its planner has had the last looks of this run.
    fn informed(&self, mut other: Trial) -> Result<Trial, JsError> {
        let now = self.now.trial.ticks();
        let looks = self.history.iter().flat_map(|history| history.last(PAST_LOOKS, now));
        for look in looks.filter(|look| look.trial.ticks() < now) {
            let mut past = look.trial.clone();
            past.equip(other)?;
            past.look();
            past.plan();
            other = past;
        }
        Ok(other)
    }

    /// What frames show.
    pub(super) fn shown(&self) -> &Moment {
        self.rethought.as_ref().map_or(&self.now, |rethought| &rethought.moment)
    }

    pub(super) fn shown_mut(&mut self) -> &mut Moment {
        self.rethought.as_mut().map_or(&mut self.now, |rethought| &mut rethought.moment)
    }

    /// The scenario with its overrides, and the preset, of what is shown.
    pub(super) fn setting(&self) -> (&Scenario, Preset) {
        let other = self.rethought.as_ref().and_then(|rethought| rethought.other.as_ref());
        other.map_or((&self.running, self.preset), |other| (&other.running, other.preset))
    }

    pub(super) fn thought(&self) -> Thought {
        self.rethought.as_ref().map_or(Thought::Run, Rethought::kind)
    }
}
