//! The history of a trial: copies of its state, for going back.
//!
//! A trial is deterministic, so every tick after a copy is reached by running forward from it. The number of
//! copies is bounded: when there are too many, every other one is dropped.

/// Copies of a state `S` by tick.
#[derive(Clone, Debug)]
pub struct History<S> {
    spacing_ticks: u64,
    most: usize,
    copies: Vec<Kept<S>>,
    end_tick: u64,
}

#[derive(Clone, Debug)]
struct Kept<S> {
    tick: u64,
    state: S,
    /// The state was changed from outside here: running forward from an earlier copy does not reach it.
    changed: bool,
}

impl<S: Clone> History<S> {
    /// A history that begins with `state` at `tick`. It keeps a copy every `spacing_ticks`, farther apart
    /// once there are more than `most`.
    pub fn new(spacing_ticks: u64, most: usize, tick: u64, state: &S) -> Self {
        let first = Kept { tick, state: state.clone(), changed: true };
        Self { spacing_ticks: spacing_ticks.max(1), most: most.max(2), copies: vec![first], end_tick: tick }
    }

    /// The earliest tick that can be gone back to.
    pub fn first_tick(&self) -> u64 {
        self.copies.first().map_or(self.end_tick, |copy| copy.tick)
    }

    /// The latest tick reached.
    pub fn end_tick(&self) -> u64 {
        self.end_tick
    }

    /// Ticks at which the state was changed from outside, the first one apart.
    pub fn changes(&self) -> impl Iterator<Item = u64> {
        self.copies.iter().skip(1).filter(|copy| copy.changed).map(|copy| copy.tick)
    }

    /// Records that `state` was reached at `tick`. If `tick` lies in the recorded past and the state was
    /// changed there, returns the changed state, so that a replay repeats what happened.
    pub fn reached(&mut self, tick: u64, state: &S) -> Option<&S> {
        if tick <= self.end_tick {
            let found = self.copies.iter().find(|copy| copy.tick == tick && copy.changed);
            return found.map(|copy| &copy.state);
        }
        self.end_tick = tick;
        if tick.is_multiple_of(self.spacing_ticks) {
            self.keep(Kept { tick, state: state.clone(), changed: false });
        }
        None
    }

    /// Records a change of the state from outside at `tick`, and drops everything after it.
    pub fn changed(&mut self, tick: u64, state: &S) {
        self.copies.retain(|copy| copy.tick < tick);
        self.end_tick = tick;
        self.keep(Kept { tick, state: state.clone(), changed: true });
    }

    /// The copy at `tick` or the latest one before it; the first one for anything earlier.
    pub fn at_or_before(&self, tick: u64) -> Option<&S> {
        let after = self.copies.partition_point(|copy| copy.tick <= tick);
        self.copies.get(after.saturating_sub(1)).map(|copy| &copy.state)
    }

    /// The latest copies at or before `tick`, as many as `most`, the earliest of them first.
    pub fn last(&self, most: usize, tick: u64) -> impl Iterator<Item = &S> {
        let end = self.copies.partition_point(|copy| copy.tick <= tick);
        self.copies[end.saturating_sub(most)..end].iter().map(|copy| &copy.state)
    }

    fn keep(&mut self, copy: Kept<S>) {
        self.copies.push(copy);
        if self.copies.len() <= self.most {
            return;
        }
        self.spacing_ticks *= 2;
        let spacing = self.spacing_ticks;
        self.copies.retain(|copy| copy.changed || copy.tick.is_multiple_of(spacing));
        // Only changes are left: the oldest are dropped, and the history begins later.
        let surplus = self.copies.len().saturating_sub(self.most);
        self.copies.drain(..surplus);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A state that depends on all its past: each tick multiplies, a change adds.
    #[derive(Clone, Debug, PartialEq)]
    struct Counter {
        tick: u64,
        value: u64,
    }

    impl Counter {
        fn run_to(&mut self, history: &mut History<Self>, tick: u64) {
            while self.tick < tick {
                self.tick += 1;
                self.value = self.value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(self.tick);
                if let Some(changed) = history.reached(self.tick, self) {
                    *self = changed.clone();
                }
            }
        }
    }

    proptest! {
        #[test]
        fn every_tick_is_found_again_whatever_was_changed(
            lengths in prop::collection::vec(1_u64..60, 1..12),
            targets in prop::collection::vec(0_u64..700, 1..20),
            spacing in 1_u64..9,
            most in 2_usize..20,
        ) {
            let mut now = Counter { tick: 0, value: 1 };
            let mut history = History::new(spacing, most, 0, &now);
            let mut truth = vec![now.clone()];
            for length in lengths {
                for _ in 0..length {
                    now.run_to(&mut history, now.tick + 1);
                    truth.push(now.clone());
                }
                now.value = now.value.wrapping_add(length);
                history.changed(now.tick, &now);
                truth[now.tick as usize] = now.clone();
            }
            prop_assert!(history.copies.len() <= most.max(2));
            for target in targets {
                let target = target.clamp(history.first_tick(), history.end_tick());
                let mut again = history.at_or_before(target).unwrap().clone();
                prop_assert!(again.tick <= target);
                again.run_to(&mut history, target);
                prop_assert_eq!(&again, &truth[target as usize]);
            }
        }
    }

    #[test]
    fn a_change_in_the_past_takes_the_future_away() {
        let mut now = Counter { tick: 0, value: 1 };
        let mut history = History::new(5, 8, 0, &now);
        now.run_to(&mut history, 33);
        let mut past = history.at_or_before(12).unwrap().clone();
        assert_eq!(past.tick, 10);
        past.run_to(&mut history, 12);
        assert_eq!(history.end_tick(), 33);
        past.value = 0;
        history.changed(12, &past);
        assert_eq!((history.end_tick(), history.changes().collect::<Vec<_>>()), (12, vec![12]));
        assert_eq!(history.at_or_before(99), Some(&past));
    }

    #[test]
    fn copies_are_near_and_few() {
        let mut now = Counter { tick: 0, value: 1 };
        let mut history = History::new(10, 16, 0, &now);
        now.run_to(&mut history, 20_000);
        assert!(history.copies.len() <= 16);
        for tick in 0..=20_000 {
            assert!(tick - history.at_or_before(tick).unwrap().tick <= 20_000 / 7);
        }
    }
}
