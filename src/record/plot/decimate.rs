//! Curves of any length in a number of points that depends on the width of the picture alone.

/// Keeps of every column of pixels the first, the lowest, the highest and the last point, in
/// their order: the line through them covers the same pixels as the line through all (U. Jugel
/// et al., "M4: A Visualization-Oriented Time Series Data Aggregation", VLDB 2014). The abscissas
/// must not decrease; points that are not finite are left out.
pub(super) fn decimate(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    let mut points = points
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .peekable();
    while let Some(first) = points.next() {
        let column = first.0.floor();
        let (mut low, mut high, mut last) = ((0, first), (0, first), (0, first));
        while let Some(p) = points.next_if(|p| p.0.floor() == column) {
            last = (last.0 + 1, p);
            if p.1 < low.1.1 {
                low = last;
            }
            if p.1 > high.1.1 {
                high = last;
            }
        }
        let mut column = [(0, first), low, high, last];
        column.sort_by_key(|&(order, _)| order);
        let mut previous = None;
        for (order, p) in column {
            if previous.replace(order) != Some(order) {
                kept.push(p);
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_spike_between_samples_survives() {
        let points =
            (0..100_000).map(|i| (f64::from(i) * 1e-3, if i == 54_321 { 9.0 } else { 0.0 }));
        let kept = decimate(points);
        assert!(kept.contains(&(54.321, 9.0)));
        assert!(kept.len() <= 400, "{}", kept.len());
    }

    proptest! {
        #[test]
        fn every_pixel_column_keeps_its_extremes_and_ends(
            steps in prop::collection::vec((0.0..0.4f64, -1.0..1.0f64), 1..200),
        ) {
            let mut x = 0.0;
            let points: Vec<_> = steps.iter().map(|&(dx, y)| { x += dx; (x, y) }).collect();
            let kept = decimate(points.iter().copied());
            let column = |of: &[(f64, f64)], c: f64| -> Vec<f64> {
                of.iter().filter(|p| p.0.floor() == c).map(|p| p.1).collect()
            };
            for c in (0..=x as i32).map(f64::from) {
                let (all, some) = (column(&points, c), column(&kept, c));
                prop_assert!(some.len() <= 4);
                prop_assert_eq!(all.first(), some.first());
                prop_assert_eq!(all.last(), some.last());
                for pick in [f64::min, f64::max] {
                    let all = all.iter().copied().reduce(pick);
                    prop_assert_eq!(all, some.iter().copied().reduce(pick));
                }
            }
        }
    }
}
