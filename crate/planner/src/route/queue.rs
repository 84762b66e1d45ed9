//! A priority queue for integer costs, without allocation after construction (Dial 1969,
//! <https://doi.org/10.1145/363269.363610>).

/// Marks the end of a bucket's list.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Entry {
    state: u32,
    cost: u32,
    next: u32,
}

/// Entries in buckets of equal width, popped bucket by bucket. Exact for a shortest-path search whose steps
/// cost at least a bucket's width.
#[derive(Clone, Debug)]
pub(crate) struct BucketQueue {
    width: u32,
    heads: Vec<u32>,
    entries: Vec<Entry>,
    current: usize,
}

impl BucketQueue {
    /// An empty queue with room for `capacity` entries of costs below `width · buckets`.
    pub(crate) fn new(width: u32, buckets: usize, capacity: usize) -> Self {
        Self { width, heads: vec![NONE; buckets], entries: Vec::with_capacity(capacity), current: 0 }
    }

    pub(crate) fn clear(&mut self) {
        self.heads.fill(NONE);
        self.entries.clear();
        self.current = 0;
    }

    /// Whether a cost is within the queue's range.
    pub(crate) fn takes(&self, cost: u32) -> bool {
        ((cost / self.width) as usize) < self.heads.len()
    }

    /// Adds an entry. Its cost must be accepted by [`takes`](Self::takes) and not be below the last one
    /// popped.
    pub(crate) fn push(&mut self, state: u32, cost: u32) {
        let head = &mut self.heads[(cost / self.width) as usize];
        self.entries.push(Entry { state, cost, next: *head });
        *head = self.entries.len() as u32 - 1;
    }

    /// Removes an entry of the lowest bucket: state and cost.
    pub(crate) fn pop(&mut self) -> Option<(u32, u32)> {
        while let Some(head) = self.heads.get_mut(self.current) {
            if *head == NONE {
                self.current += 1;
                continue;
            }
            let Entry { state, cost, next } = self.entries[*head as usize];
            *head = next;
            return Some((state, cost));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn entries_come_back_by_bucket(costs in prop::collection::vec(0..1000_u32, 0..200)) {
            let mut queue = BucketQueue::new(10, 100, costs.len());
            for (state, &cost) in costs.iter().enumerate() {
                prop_assert!(queue.takes(cost));
                queue.push(state as u32, cost);
            }
            let mut buckets = Vec::new();
            while let Some((state, cost)) = queue.pop() {
                prop_assert_eq!(costs[state as usize], cost);
                buckets.push(cost / 10);
            }
            prop_assert_eq!(buckets.len(), costs.len());
            prop_assert!(buckets.is_sorted());
            prop_assert!(!queue.takes(1000));
        }
    }
}
