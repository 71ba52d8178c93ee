//! A closed tour that can be cut in two places and joined the other way round.

/// A tour through all dots, by their indices.
#[derive(Debug)]
pub(super) struct Tour {
    order: Vec<u32>,
    /// Where each dot stands in `order`.
    place: Vec<u32>,
}

impl Tour {
    /// The tour in this order, which must be one of 0 … n − 1.
    pub(super) fn new(order: Vec<u32>) -> Self {
        let mut place = vec![0; order.len()];
        for (&dot, at) in order.iter().zip(0..) {
            place[dot as usize] = at;
        }
        Self { order, place }
    }

    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }

    pub(super) fn into_order(self) -> Vec<u32> {
        self.order
    }

    pub(super) fn next(&self, dot: u32) -> u32 {
        let at = self.place[dot as usize] as usize + 1;
        self.order[if at == self.order.len() { 0 } else { at }]
    }

    pub(super) fn previous(&self, dot: u32) -> u32 {
        let at = self.place[dot as usize] as usize;
        self.order[if at == 0 { self.order.len() } else { at } - 1]
    }

    /// Dots from `from` to `to`, going forwards, both counted.
    fn count(&self, from: u32, to: u32) -> usize {
        let (from, to) = (self.place[from as usize], self.place[to as usize]);
        let steps = to as usize + if to < from { self.order.len() } else { 0 } - from as usize;
        steps + 1
    }

    /// How many dots change their place when the way from `from` to `to` is turned around.
    pub(super) fn effort(&self, from: u32, to: u32) -> usize {
        let count = self.count(from, to);
        count.min(self.order.len() - count)
    }

    /// Replaces the edges ab and cd by ac and bd. Going along the tour, in either direction, b must follow
    /// a, and d follow c.
    pub(super) fn exchange(&mut self, [a, b, c, d]: [u32; 4]) {
        if self.next(a) == b && self.next(c) == d {
            self.turn(b, c);
        } else {
            self.turn(a, d);
        }
    }

    /// Turns the way from `from` to `to` around, or all the rest, whichever is shorter.
    fn turn(&mut self, from: u32, to: u32) {
        let length = self.order.len();
        let inner = self.count(from, to);
        let (mut low, mut high) =
            (self.place[from as usize] as usize, self.place[to as usize] as usize);
        let mut swaps = inner / 2;
        if 2 * inner > length {
            (low, high) = ((high + 1) % length, (low + length - 1) % length);
            swaps = (length - inner) / 2;
        }
        for _ in 0..swaps {
            self.order.swap(low, high);
            self.place[self.order[low] as usize] = low as u32;
            self.place[self.order[high] as usize] = high as u32;
            low = if low + 1 == length { 0 } else { low + 1 };
            high = if high == 0 { length } else { high } - 1;
        }
    }
}
