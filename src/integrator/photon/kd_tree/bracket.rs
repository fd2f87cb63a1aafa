//! Finds a number that a given count of numbers do not exceed.

/// After so many guesses something is odd about the numbers.
const GUESSES: u32 = 12;

/// Two numbers, of which one has too few below it.
///
/// On surfaces the number of points within a radius grows with its square: a guess on the line between two counts is nearly right.
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    k: usize,
    /// How many more than `k` are as good.
    slack: usize,
    /// Fewer than `k` are at most this: its bits, and how many. Below 0 there is none.
    low: (i64, usize),
    /// At least `k` are at most this.
    high: (i64, usize),
    guesses: u32,
}

impl Bracket {
    /// Numbers are at least 0, and `count` of them, at least `k`, are at most `greatest`.
    #[inline(always)]
    pub fn new(k: usize, slack: usize, greatest: f32, count: usize) -> Self {
        Self {
            k,
            slack,
            low: (-1, 0),
            high: (i64::from(greatest.to_bits()), count),
            guesses: 0,
        }
    }

    /// Where to count next, if it is needed.
    #[inline(always)]
    pub fn guess(&mut self) -> Option<f32> {
        let (low, high) = (self.low, self.high);
        if high.1 <= self.k + self.slack || high.0 - low.0 == 1 {
            return None;
        }
        self.guesses += 1;
        let bits = if self.guesses.is_multiple_of(4) || self.guesses > GUESSES {
            // The floats between are bisected, in case that guesses go astray.
            (low.0 + high.0) / 2
        } else {
            let (from, to) = (f32::from_bits(low.0.max(0) as u32), f32::from_bits(high.0 as u32));
            let wanted = (self.k - low.1) as f32 + 0.5 * self.slack as f32;
            let part = wanted / (high.1 - low.1) as f32;
            i64::from((from + part * (to - from)).to_bits()).clamp(low.0 + 1, high.0 - 1)
        };
        Some(f32::from_bits(bits as u32))
    }

    /// Takes `count` numbers to be at most `guess`, which is the last one.
    #[inline(always)]
    pub fn narrow(&mut self, guess: f32, count: usize) {
        let end = if count < self.k { &mut self.low } else { &mut self.high };
        *end = (i64::from(guess.to_bits()), count);
    }

    /// A number that at least `k` do not exceed, and how many do not: more than `k` and slack only if they equal it.
    #[inline(always)]
    pub fn bound(&self) -> (f32, usize) {
        (f32::from_bits(self.high.0 as u32), self.high.1)
    }
}
