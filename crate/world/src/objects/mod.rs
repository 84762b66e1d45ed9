//! What stands on the ground and is not ground: posts, boxes, rocks, walls, gates, roofs and what walks.
//!
//! An [`Object`] is what a file names; it is made of [`Solid`] shapes, which rays meet exactly and wheels
//! stand on.

mod fan;
mod object;
mod solid;
mod walk;

pub(crate) use fan::NearSolids;
pub use object::Object;
pub use solid::{Shape, Solid};
pub use walk::Walk;

use crate::height_field::HeightField;
use glam::DVec2;

/// The objects on a piece of ground, at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Objects {
    objects: Vec<Object>,
    /// Those of what stands, then one of each mover.
    solids: Vec<Solid>,
    movers: Vec<Mover>,
}

/// An object that walks.
#[derive(Clone, Debug, PartialEq)]
struct Mover {
    object: usize,
    walked_m: f64,
    /// Whether it has set out.
    walks: bool,
}

impl Objects {
    /// Puts valid objects on the ground. What is not on it is left out.
    #[must_use]
    pub fn new(objects: Vec<Object>, field: &HeightField) -> Self {
        let movers = (0..objects.len())
            .filter_map(|object| {
                let walk = objects.get(object)?.walk()?;
                Some(Mover { object, walked_m: 0.0, walks: walk.starts_within_m.is_none() })
            })
            .collect();
        let mut placed = Self { objects, solids: Vec::new(), movers };
        placed.settle(field);
        placed
    }

    /// The objects as given.
    #[must_use]
    pub fn list(&self) -> &[Object] {
        &self.objects
    }

    /// What they are made of, where it is now.
    #[must_use]
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// The solids that walk, where they are now.
    pub fn moving(&self) -> impl Iterator<Item = &Solid> {
        self.solids.iter().filter(|solid| self.walks(solid))
    }

    /// The solids that stay where they are.
    pub fn standing(&self) -> impl Iterator<Item = &Solid> {
        self.solids.iter().filter(|solid| !self.walks(solid))
    }

    fn walks(&self, solid: &Solid) -> bool {
        self.movers.iter().any(|mover| mover.object == solid.object)
    }

    /// Puts everything anew on ground that has changed.
    pub fn settle(&mut self, field: &HeightField) {
        self.solids.clear();
        for (index, object) in self.objects.iter().enumerate().filter(|(_, object)| object.walk().is_none()) {
            object.place(field, index, DVec2::ZERO, &mut self.solids);
        }
        for mover in &self.movers {
            mover.place(&self.objects, field, &mut self.solids);
        }
    }

    /// Lets the movers walk for `dt_s` seconds. One that would walk into the robot, as `is_free` tells,
    /// waits.
    pub fn walk(&mut self, dt_s: f64, field: &HeightField, robot_m: DVec2, is_free: impl Fn(&Solid) -> bool) {
        let Self { objects, solids, movers } = self;
        if movers.is_empty() {
            return;
        }
        solids.retain(|solid| objects.get(solid.object).is_some_and(|object| object.walk().is_none()));
        for mover in movers {
            let next = mover.after(dt_s, objects, robot_m);
            let count = solids.len();
            next.place(objects, field, solids);
            if solids.iter().skip(count).all(&is_free) {
                *mover = next;
            } else {
                solids.truncate(count);
                mover.place(objects, field, solids);
            }
        }
    }
}

impl Mover {
    fn after(&self, dt_s: f64, objects: &[Object], robot_m: DVec2) -> Self {
        let mut next = self.clone();
        if let Some((object, walk)) =
            objects.get(self.object).and_then(|object| Some((object, object.walk()?)))
        {
            next.walks |=
                walk.starts_within_m.is_some_and(|near_m| object.place_m().distance(robot_m) <= near_m);
            if next.walks {
                next.walked_m += walk.speed_m_s * dt_s;
            }
        }
        next
    }

    fn place(&self, objects: &[Object], field: &HeightField, solids: &mut Vec<Solid>) {
        if let Some((object, walk)) =
            objects.get(self.object).and_then(|object| Some((object, object.walk()?)))
        {
            let begin_m = object.place_m();
            object.place(field, self.object, walk.place_m(begin_m, self.walked_m) - begin_m, solids);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn slope() -> HeightField {
        HeightField::new(101, 101, 0.5, (0..101 * 101).map(|i| (i % 101) as f32 * 0.1).collect()).unwrap()
    }

    fn objects(text: &str) -> Objects {
        #[derive(serde::Deserialize)]
        struct File {
            objects: Vec<Object>,
        }
        let File { objects } = mapless_toml::from_str(text).unwrap();
        objects.iter().for_each(|object| object.validate("objects[1]").unwrap());
        Objects::new(objects, &slope())
    }

    #[test]
    fn what_stands_goes_down_into_a_slope_and_up_from_the_ground_at_its_middle() {
        let placed = objects(
            "[[objects]]\nkind = \"box\"\nat = [10.0, 10.0]\nsize_m = [2.0, 1.0, 0.5]\n\
             [[objects]]\nkind = \"post\"\nat = [20.0, 20.0]\nradius_m = 0.5\nheight_m = 2.0\n\
             [[objects]]\nkind = \"rock\"\nat = [30.0, 30.0]\nradius_m = 0.5\nsunk_m = 0.2\n",
        );
        let [cuboid, post, rock] = placed.solids() else { panic!("{placed:?}") };
        assert!((cuboid.top_m() - 2.5).abs() < 1e-6);
        assert!((cuboid.nearest(DVec3::new(10.0, 10.0, -9.0)).z - 1.8).abs() < 1e-6, "its lowest corner");
        assert!((post.top_m() - 6.0).abs() < 1e-6);
        assert!((rock.top_m() - 6.8).abs() < 1e-6);
    }

    #[test]
    fn there_is_room_in_a_gate_and_under_a_roof() {
        let placed = objects(
            "[[objects]]\nkind = \"gate\"\nat = [10.0, 10.0]\nyaw_rad = 0.0\nwidth_m = 1.2\nheight_m = 1.5\n\
             [[objects]]\nkind = \"roof\"\nat = [30.0, 10.0]\nsize_m = [4.0, 3.0, 0.2]\nheight_m = 2.0\n",
        );
        let first = |from: DVec3, direction: DVec3| {
            let hits = placed.solids().iter().filter_map(|solid| solid.cast(from, direction, 50.0));
            hits.fold(f64::INFINITY, f64::min)
        };
        // Through the opening, against its posts and under its beam, with the ground 2 m up.
        assert!(first(DVec3::new(5.0, 10.55, 3.0), DVec3::X).is_infinite());
        assert!((first(DVec3::new(5.0, 10.65, 3.0), DVec3::X) - 4.925).abs() < 1e-9);
        assert!((first(DVec3::new(5.0, 10.0, 3.55), DVec3::X) - 4.925).abs() < 1e-9, "the beam");
        // Under the roof, with the ground 6 m up.
        assert!((first(DVec3::new(30.0, 10.0, 7.0), DVec3::Z) - 1.0).abs() < 1e-9);
        assert!(first(DVec3::new(25.0, 10.0, 7.0), DVec3::X).is_infinite());
    }

    #[test]
    fn a_wall_follows_the_ground() {
        let placed =
            objects("[[objects]]\nkind = \"wall\"\nfrom = [10.0, 10.0]\nto = [15.0, 10.0]\nheight_m = 1.0\n");
        assert_eq!(placed.solids().len(), 5);
        let tops: Vec<f64> = placed.solids().iter().map(Solid::top_m).collect();
        assert!((tops[0] - 3.1).abs() < 1e-6 && (tops[4] - 3.9).abs() < 1e-6, "{tops:?}");
    }

    #[test]
    fn a_mover_sets_out_when_the_robot_is_near_and_waits_when_it_is_in_its_way() {
        let mut placed = objects(
            "[[objects]]\nkind = \"post\"\nat = [10.0, 10.0]\nradius_m = 0.2\nheight_m = 1.7\n\
             walk = { path = [[20.0, 10.0]], speed_m_s = 1.0, starts_within_m = 5.0 }\n",
        );
        let field = slope();
        let place = |placed: &Objects| placed.solids()[0].centre_m.x;
        placed.walk(1.0, &field, DVec2::new(30.0, 10.0), |_| true);
        assert!((place(&placed) - 10.0).abs() < 1e-9, "the robot is far");
        placed.walk(1.0, &field, DVec2::new(14.0, 10.0), |_| true);
        placed.walk(1.0, &field, DVec2::new(30.0, 10.0), |_| true);
        assert!((place(&placed) - 12.0).abs() < 1e-9);
        placed.walk(1.0, &field, DVec2::new(30.0, 10.0), |solid| solid.centre_m.x < 12.5);
        assert!((place(&placed) - 12.0).abs() < 1e-9, "it waits");
        placed.walk(1.0, &field, DVec2::new(30.0, 10.0), |_| true);
        assert!((place(&placed) - 13.0).abs() < 1e-9);
    }
}
