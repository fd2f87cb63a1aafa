//! "Did you mean ...?"

/// Words longer than this are no misspelt names; the distance costs the product of the lengths.
const LONGEST: usize = 64;

/// The name that `word` is most likely a misspelling of, if any is close: at most a third of its letters wrong (at least one, and
/// not all), not counting case.
pub(in crate::desc) fn closest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let letters: Vec<char> = word.chars().take(LONGEST + 1).flat_map(char::to_lowercase).collect();
    if letters.is_empty() || letters.len() > LONGEST {
        return None;
    }
    let most = (letters.len() / 3).max(1).min(letters.len() - 1);
    known
        .iter()
        .map(|&name| {
            (
                distance(&letters, &name.to_lowercase().chars().collect::<Vec<_>>()),
                name,
            )
        })
        .filter(|&(distance, _)| distance <= most)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

/// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut current = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let substitution = previous[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            current[j] = substitution.min(previous[j] + 1).min(current[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                current[j] = current[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut previous, current);
    }
    previous[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_definition() {
        let d = |a: &str, b: &str| distance(&a.chars().collect::<Vec<_>>(), &b.chars().collect::<Vec<_>>());
        assert_eq!(d("fov", "fov"), 0);
        assert_eq!(d("", "abc"), 3);
        assert_eq!(d("kitten", "sitting"), 3);
        assert_eq!(d("raduis", "radius"), 1);
    }

    #[test]
    fn a_close_name_is_found_and_a_far_one_is_not() {
        let known = ["radius", "reflectance", "fov"];
        assert_eq!(closest("raduis", &known), Some("radius"));
        assert_eq!(closest("Reflectence", &known), Some("reflectance"));
        assert_eq!(closest("FOV", &known), Some("fov"));
        assert_eq!(closest("k", &known), None);
        assert_eq!(closest("thickness", &known), None);
        assert_eq!(closest(&"r".repeat(10_000), &known), None);
    }
}
