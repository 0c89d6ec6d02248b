//! Fewer points of long curves, such that no extreme is lost.

/// Indices of at most about `most` rows, in order: all where there are no more, else of each of equally many
/// rows in a row the first and those with the least and the largest number of each column. The last row is always kept.
pub(super) fn thin(columns: &[&[f64]], rows: usize, most: usize) -> Vec<usize> {
    if rows <= most {
        return (0..rows).collect();
    }
    let of_a_bucket = 2 * columns.len() + 1;
    let buckets = (most / of_a_bucket).max(1);
    let mut kept = Vec::with_capacity(most + 1);
    for bucket in 0..buckets {
        let (from, to) = (bucket * rows / buckets, (bucket + 1) * rows / buckets);
        let start = kept.len();
        kept.push(from);
        for column in columns {
            let by_value = |a: &usize, b: &usize| column[*a].total_cmp(&column[*b]);
            let finite = || (from..to).filter(|&i| !column[i].is_nan());
            kept.extend(finite().min_by(by_value));
            kept.extend(finite().max_by(by_value));
        }
        kept[start..].sort_unstable();
    }
    kept.push(rows - 1);
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_and_both_ends_are_kept() {
        let rows = 100_000;
        let mut column: Vec<f64> = (0..rows).map(|i| (i as f64 * 0.37).sin()).collect();
        column[77_777] = 9.0;
        column[1] = -9.0;
        column[3] = f64::NAN;
        let kept = thin(&[&column], rows, 3000);
        assert!(kept.len() <= 3001 && kept.is_sorted_by(|a, b| a < b));
        assert!([0, 1, 77_777, rows - 1].iter().all(|i| kept.contains(i)));
    }

    #[test]
    fn short_curves_are_kept_whole() {
        assert_eq!(thin(&[&[1.0, 2.0]], 2, 2), [0, 1]);
        assert_eq!(thin(&[], 0, 2), [0; 0]);
    }
}
