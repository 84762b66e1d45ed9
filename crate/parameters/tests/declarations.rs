//! What the two declarations make.

use mapless_parameters::{Check, ConfigError, Kind, Value, choices, parameters};

choices! {
    /// A colour.
    pub enum Colour {
        /// As blood.
        Red = "red",
        /// As the sky at noon.
        LightBlue = "light_blue",
    }
}

parameters! {
    /// Something with a parameter of each type.
    pub struct Outer {
        /// A number with
        /// a text of two lines.
        length_m: f64 = 2.0, paper 3.5, unit "m", range [0.5, 9.0], check Positive;
        /// Two numbers.
        bounds: [f64; 2] = [1.0, 2.0], range [0.1, 4.0], check Ascending;
        /// A whole number.
        count: usize = 3, paper 5, range [1, 10], check AtLeast(1.0);
        /// A switch.
        on: bool = true, paper false;
        /// A choice.
        colour: Colour = Colour::Red, paper Colour::LightBlue;
    }
    tables {
        /// A table with its own defaults.
        first: Inner;
        /// Another with others.
        second: Inner = Inner { share: 0.9 };
    }
    relations check_shares;
}

parameters! {
    /// A table.
    #[derive(Copy)]
    pub struct Inner {
        /// A share.
        share: f64 = 0.5, paper 0.25, range [0.1, 0.9], check Share;
    }
}

impl Outer {
    fn check_shares(&self, place: &str) -> Result<(), ConfigError> {
        let ok = self.first.share <= self.second.share;
        ConfigError::require(ok, place, "first", self.first.share, "at most that of the second")
    }
}

#[test]
fn defaults_and_the_papers_values_are_those_of_the_entries() {
    let outer = Outer::default();
    let values = [
        Value::Number(2.0),
        Value::Pair([1.0, 2.0]),
        Value::Whole(3),
        Value::Switch(true),
        Value::Word("red"),
    ];
    assert_eq!(outer.values(), values);
    assert_eq!((outer.first, outer.second), (Inner { share: 0.5 }, Inner { share: 0.9 }));
    let inner = Inner { share: 0.25 };
    let paper = Outer {
        length_m: 3.5,
        bounds: [1.0, 2.0],
        count: 5,
        on: false,
        colour: Colour::LightBlue,
        first: inner,
        second: inner,
    };
    assert_eq!(outer.with_paper_values(), paper);
}

#[test]
fn descriptions_are_those_of_the_entries() {
    let [length, bounds, count, on, colour] = Outer::PARAMETERS else { panic!("five entries") };
    assert_eq!((length.name, length.unit), ("length_m", "m"));
    assert_eq!(length.text, "A number with a text of two lines.");
    assert_eq!((length.kind, length.paper), (Kind::Number(0.5, 9.0), Some(Value::Number(3.5))));
    assert_eq!((bounds.kind, bounds.unit, bounds.paper), (Kind::Pair(0.1, 4.0), "", None));
    assert_eq!((count.kind, count.check), (Kind::Whole(1, 10), Check::AtLeast(1.0)));
    assert_eq!((on.kind, on.check), (Kind::Switch, Check::ByType));
    assert_eq!(colour.kind, Kind::Choice(&["red", "light_blue"]));
    assert_eq!(colour.paper, Some(Value::Word("light_blue")));
}

#[test]
fn the_first_value_that_makes_no_sense_is_named() {
    let fault = |change: fn(&mut Outer)| {
        let mut outer = Outer::default();
        assert_eq!(outer.validate("outer"), Ok(()));
        change(&mut outer);
        outer.validate("outer").unwrap_err().to_string()
    };
    assert_eq!(fault(|it| it.length_m = 0.0), "outer.length_m = 0: expected a positive number");
    let lower = "outer.bounds = [2, 1]: expected two positive numbers, the lower one first";
    assert_eq!(fault(|it| it.bounds = [2.0, 1.0]), lower);
    assert_eq!(fault(|it| it.count = 0), "outer.count = 0: expected at least 1");
    assert_eq!(fault(|it| it.second.share = 1.0), "outer.second.share = 1: expected a share between 0 and 1");
    assert_eq!(fault(|it| it.first.share = 0.95), "outer.first = 0.95: expected at most that of the second");
}

#[test]
fn checks_hold_at_their_ends() {
    for (check, taken, refused) in [
        (Check::Finite, vec![-1e300, 0.0], vec![]),
        (Check::Positive, vec![1e-300], vec![0.0, -0.0, -1.0]),
        (Check::NotNegative, vec![0.0, 1e300], vec![-1e-300]),
        (Check::Share, vec![0.001, 0.999], vec![0.0, 1.0]),
        (Check::Angle, vec![0.001, 1.57], vec![0.0, std::f64::consts::FRAC_PI_2]),
        (Check::AtLeast(2.0), vec![2.0, 1e300], vec![1.999]),
        (Check::Below(1.0), vec![0.0, 0.999], vec![-0.001, 1.0]),
        (Check::UpTo(1.0), vec![0.001, 1.0], vec![0.0, 1.001]),
        (Check::Within(-1.0, 1.0), vec![-1.0, 1.0], vec![-1.001, 1.001]),
    ] {
        let ok = |number| check.require("", "it", Value::Number(number)).is_ok();
        for number in taken {
            assert!(ok(number), "{check:?} of {number}");
        }
        for number in refused.into_iter().chain([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]) {
            assert!(!ok(number), "{check:?} of {number}");
        }
    }
    let fault = Check::Positive.require("", "it", Value::Pair([1.0, -2.0])).unwrap_err();
    assert_eq!(fault.to_string(), "it = [1, -2]: expected a positive number");
}
