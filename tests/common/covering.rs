//! Covering arrays: rows that give each of some factors one of its levels, such that every combination of the levels of any t
//! factors is in some row. The greedy method of Cohen et al. (1997), "The AETG system", with fixed random numbers.

use super::random::Random;

/// What is to be covered.
pub struct Covering<'a> {
    /// How many levels each factor has, at least 1.
    pub levels: &'a [usize],
    /// t: how many factors are combined, from 1 to their number.
    pub strength: usize,
    /// Whether a row, in which some factors may not be set yet, makes sense. What is refused must stay so, whatever is set further;
    /// what is allowed must have a row.
    pub allowed: &'a dyn Fn(&[Option<usize>]) -> bool,
}

/// Rows that are tried for each one that is kept.
const CANDIDATES: usize = 40;

/// Some factors, and which combinations of their levels have no row yet.
struct Combinations {
    columns: Vec<usize>,
    open: Vec<bool>,
}

impl Combinations {
    /// Where the levels of a row are in `open`; `None` unless all are set.
    fn index(&self, levels: &[usize], row: &[Option<usize>]) -> Option<usize> {
        self.columns
            .iter()
            .try_fold(0, |index, &column| Some(index * levels[column] + row[column]?))
    }

    /// The combination at a place of `open`, as a row.
    fn row(&self, levels: &[usize], mut index: usize) -> Vec<Option<usize>> {
        let mut row = vec![None; levels.len()];
        for &column in self.columns.iter().rev() {
            row[column] = Some(index % levels[column]);
            index /= levels[column];
        }
        row
    }
}

impl Covering<'_> {
    /// The rows.
    ///
    /// # Panics
    /// If a combination that is allowed cannot be completed to a row.
    pub fn rows(&self) -> Vec<Vec<usize>> {
        let mut random = Random::new(1);
        let mut open = self.combinations();
        let mut rows = Vec::new();
        while let Some(seed) = self.first_open(&open) {
            let candidates = (0..CANDIDATES).filter_map(|_| self.candidate(&seed, &open, &mut random));
            let (row, _) = candidates
                .reduce(|best, other| if other.1 > best.1 { other } else { best })
                .unwrap_or_else(|| panic!("{seed:?} has no row"));
            let row: Vec<Option<usize>> = row.into_iter().map(Some).collect();
            for combinations in &mut open {
                if let Some(index) = combinations.index(self.levels, &row) {
                    combinations.open[index] = false;
                }
            }
            rows.push(row.into_iter().flatten().collect());
        }
        rows
    }

    /// The combinations that are allowed and in none of `rows`: each a row with t levels set. Found by looking at each.
    pub fn missing(&self, rows: &[Vec<usize>]) -> Vec<Vec<Option<usize>>> {
        let mut missing = Vec::new();
        for columns in 0..1_u32 << self.levels.len() {
            if columns.count_ones() as usize != self.strength {
                continue;
            }
            let chosen = |column: usize| columns >> column & 1 == 1;
            let count = (0..self.levels.len()).filter(|&c| chosen(c)).map(|c| self.levels[c]);
            for index in 0..count.product() {
                let mut rest = index;
                let level = |column: usize| {
                    chosen(column).then(|| {
                        let level = rest % self.levels[column];
                        rest /= self.levels[column];
                        level
                    })
                };
                let wanted: Vec<Option<usize>> = (0..self.levels.len()).map(level).collect();
                let is_in = |row: &Vec<usize>| row.iter().zip(&wanted).all(|(&l, w)| w.is_none_or(|w| w == l));
                if (self.allowed)(&wanted) && !rows.iter().any(is_in) {
                    missing.push(wanted);
                }
            }
        }
        missing
    }

    /// The fewest rows that there can be where everything is allowed: the product of the t largest numbers of levels.
    pub fn fewest(&self) -> usize {
        let mut levels = self.levels.to_vec();
        levels.sort_unstable();
        levels.iter().rev().take(self.strength).product()
    }

    /// All combinations of t factors, those with the most levels first; what is not allowed is not open.
    fn combinations(&self) -> Vec<Combinations> {
        let factors = self.levels.len();
        let mut all: Vec<Combinations> = (0..1_u32 << factors)
            .filter(|columns| columns.count_ones() as usize == self.strength)
            .map(|chosen| {
                let columns: Vec<usize> = (0..factors).filter(|column| chosen >> column & 1 == 1).collect();
                let count = columns.iter().map(|&column| self.levels[column]).product();
                let open = vec![true; count];
                Combinations { columns, open }
            })
            .collect();
        for combinations in &mut all {
            for index in 0..combinations.open.len() {
                combinations.open[index] = (self.allowed)(&combinations.row(self.levels, index));
            }
        }
        all.sort_by_key(|combinations| std::cmp::Reverse(combinations.open.len()));
        all
    }

    fn first_open(&self, open: &[Combinations]) -> Option<Vec<Option<usize>>> {
        open.iter().find_map(|combinations| {
            let index = combinations.open.iter().position(|&open| open)?;
            Some(combinations.row(self.levels, index))
        })
    }

    /// A row with the levels of `seed` and, in an order by chance, for each other factor the level that covers the most; and how
    /// many open combinations it covers. `None` if it gets stuck.
    fn candidate(
        &self,
        seed: &[Option<usize>],
        open: &[Combinations],
        random: &mut Random,
    ) -> Option<(Vec<usize>, usize)> {
        let mut row = seed.to_vec();
        let mut order: Vec<usize> = (0..row.len()).filter(|&column| row[column].is_none()).collect();
        for i in (1..order.len()).rev() {
            order.swap(i, random.bits() as usize % (i + 1));
        }
        for column in order {
            let mut best = None;
            for level in 0..self.levels[column] {
                row[column] = Some(level);
                if !(self.allowed)(&row) {
                    continue;
                }
                let key = (self.covered(&row, open, Some(column)), random.bits());
                if best.is_none_or(|(best, _)| key > best) {
                    best = Some((key, level));
                }
            }
            row[column] = Some(best?.1);
        }
        let covered = self.covered(&row, open, None);
        Some((row.into_iter().flatten().collect(), covered))
    }

    /// How many open combinations a row covers: those that have a certain factor, or all.
    fn covered(&self, row: &[Option<usize>], open: &[Combinations], with: Option<usize>) -> usize {
        let counts = |combinations: &&Combinations| {
            with.is_none_or(|column| combinations.columns.contains(&column))
                && combinations
                    .index(self.levels, row)
                    .is_some_and(|index| combinations.open[index])
        };
        open.iter().filter(counts).count()
    }
}
