//! A square grid that rolls along with the robot: cells are fixed in the world, and each slot holds the last
//! cell written to it.

use glam::IVec2;

/// Cells of the world by their index, at most `side` × `side`. Cells a multiple of `side` apart share a slot.
#[derive(Clone, Debug)]
pub(crate) struct RollingGrid<T> {
    side: u32,
    /// A multiple of `side` that makes indices positive, and 2⁶⁴ / `side`, rounded up.
    bias: u32,
    inverse: u64,
    slots: Vec<Option<(IVec2, T)>>,
}

impl<T: Copy> RollingGrid<T> {
    /// An empty grid.
    pub(crate) fn new(side: usize) -> Self {
        let divisor = side.max(1) as u32;
        Self {
            side: divisor,
            bias: (1 << 31) / divisor * divisor,
            inverse: (u64::MAX / u64::from(divisor)).wrapping_add(1),
            slots: vec![None; side * side],
        }
    }

    /// Forgets every cell.
    pub(crate) fn clear(&mut self) {
        self.slots.fill(None);
    }

    /// The cell with an index.
    pub(crate) fn get(&self, index: IVec2) -> Option<&T> {
        let slot = self.slots[self.slot_of(index)].as_ref();
        slot.filter(|(held, _)| *held == index).map(|(_, cell)| cell)
    }

    /// The cell with an index, to change.
    pub(crate) fn get_mut(&mut self, index: IVec2) -> Option<&mut T> {
        let slot = self.slot_of(index);
        self.slots[slot].as_mut().filter(|(held, _)| *held == index).map(|(_, cell)| cell)
    }

    /// The cell with an index, to change; `cell` if there is none.
    pub(crate) fn get_or_insert(&mut self, index: IVec2, cell: T) -> &mut T {
        let slot = self.slot_of(index);
        let held = &mut self.slots[slot];
        if held.as_ref().is_some_and(|(held, _)| *held != index) {
            *held = None;
        }
        &mut held.get_or_insert((index, cell)).1
    }

    /// Writes a cell, and overwrites the last one in its slot.
    pub(crate) fn set(&mut self, index: IVec2, cell: T) {
        let slot = self.slot_of(index);
        self.slots[slot] = Some((index, cell));
    }

    /// Forgets the cell with an index.
    pub(crate) fn remove(&mut self, index: IVec2) {
        let slot = self.slot_of(index);
        if self.slots[slot].as_ref().is_some_and(|(held, _)| *held == index) {
            self.slots[slot] = None;
        }
    }

    /// The cells from `low` to `high`, both included, row by row.
    pub(crate) fn between(&self, low: IVec2, high: IVec2) -> impl Iterator<Item = (IVec2, &T)> {
        let first = self.wrapped(low.x);
        (low.y..=high.y).flat_map(move |y| {
            let begin = (self.wrapped(y) * self.side) as usize;
            let row = &self.slots[begin..begin + self.side as usize];
            let mut slot = first;
            (low.x..=high.x).filter_map(move |x| {
                let held = row[slot as usize].as_ref();
                slot = if slot + 1 == self.side { 0 } else { slot + 1 };
                held.filter(|(index, _)| *index == IVec2::new(x, y)).map(|(index, cell)| (*index, cell))
            })
        })
    }

    /// Every cell.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (IVec2, &T)> {
        self.slots.iter().flatten().map(|(index, cell)| (*index, cell))
    }

    /// Forgets the cells that do not hold, in every `parts`th row of slots from `part` on.
    pub(crate) fn retain(&mut self, part: usize, parts: usize, mut holds: impl FnMut(&T) -> bool) {
        for row in self.slots.chunks_mut(self.side as usize).skip(part).step_by(parts) {
            for slot in row {
                if slot.as_ref().is_some_and(|(_, cell)| !holds(cell)) {
                    *slot = None;
                }
            }
        }
    }

    /// Every cell, to change.
    pub(crate) fn cells_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.slots.iter_mut().flatten().map(|(_, cell)| cell)
    }

    fn slot_of(&self, index: IVec2) -> usize {
        (self.wrapped(index.y) * self.side + self.wrapped(index.x)) as usize
    }

    /// An index modulo the side, without a division: Lemire, Kaser and Kurz, "Faster remainder by direct
    /// computation" (Software: Practice and Experience 49, 2019).
    fn wrapped(&self, index: i32) -> u32 {
        let fraction = self.inverse.wrapping_mul(u64::from((index as u32).wrapping_add(self.bias)));
        ((u128::from(fraction) * u128::from(self.side)) >> 64) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn it_holds_what_was_last_written_to_each_slot(
            written in prop::collection::vec((-20..20_i32, -20..20_i32, 0..100_u32), 1..200), side in 1..9_usize,
        ) {
            let mut grid = RollingGrid::new(side);
            let mut slots = BTreeMap::new();
            for (x, y, value) in written {
                grid.set(IVec2::new(x, y), value);
                slots.insert((x.rem_euclid(side as i32), y.rem_euclid(side as i32)), (x, y, value));
            }
            let mut expected: Vec<_> = slots.into_values().collect();
            expected.sort_unstable();
            let mut found: Vec<_> = grid.iter().map(|(index, &value)| (index.x, index.y, value)).collect();
            found.sort_unstable();
            prop_assert_eq!(&found, &expected);
            for (x, y, value) in expected {
                prop_assert_eq!(grid.get(IVec2::new(x, y)), Some(&value));
                prop_assert_eq!(grid.get(IVec2::new(x + side as i32, y)), None);
            }
        }

        #[test]
        fn a_rectangle_gives_its_cells_row_by_row(x in -20..20_i32, y in -20..20_i32) {
            let mut grid = RollingGrid::new(7);
            let (low, high) = (IVec2::new(x, y), IVec2::new(x + 4, y + 2));
            let mut expected = Vec::new();
            for row in y..=y + 2 {
                for column in x..=x + 4 {
                    grid.set(IVec2::new(column, row), (column, row));
                    expected.push((column, row));
                }
            }
            prop_assert_eq!(grid.between(low, high).map(|(_, cell)| *cell).collect::<Vec<_>>(), expected);
        }
    }
}
