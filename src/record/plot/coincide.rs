//! Curves that lie on each other: where they do, their colours alternate, so that all of them are seen.

/// Length of the pieces of one colour, px, and how close curves are that lie on each other.
const PIECE: f64 = 12.0;
const CLOSE: f64 = 1.0;

/// The parts of curves that are drawn. A curve is points in pixels whose abscissas do not decrease; where several lie on
/// each other for a whole piece, one of them in turn is drawn there.
pub(super) fn shared(
    curves: &[Vec<(f64, f64)>],
    left: f64,
    width: f64,
) -> Vec<Vec<Vec<(f64, f64)>>> {
    let pieces = (width / PIECE).ceil() as usize;
    let heights: Vec<Vec<f64>> = curves
        .iter()
        .map(|curve| heights(curve, left, width as usize + 1))
        .collect();
    let on_each_other = |a: usize, b: usize, piece: usize| {
        let from = piece * PIECE as usize;
        let to = (from + PIECE as usize).min(width as usize + 1);
        // Also a line that neither curve has in this piece is not shared.
        (from..to).all(|i| (heights[a][i] - heights[b][i]).abs() < CLOSE)
    };
    let is_drawn = |curve: usize, piece: usize| {
        let group = connected(curves.len(), curve, |a, b| on_each_other(a, b, piece));
        let rank = group.iter().position(|&i| i == curve);
        rank == Some(piece % group.len())
    };
    let of = |(i, curve): (usize, &Vec<(f64, f64)>)| {
        let drawn: Vec<bool> = (0..pieces).map(|piece| is_drawn(i, piece)).collect();
        match drawn.iter().all(|d| *d) {
            true => vec![curve.clone()],
            false => cut(curve, left, &drawn),
        }
    };
    curves.iter().enumerate().map(of).collect()
}

/// Those of `count` curves that lie on this one, on one of those, and so on, in order: so that all of them agree on who is
/// drawn, also where the first does not lie on the last.
fn connected(count: usize, of: usize, on_each_other: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut group = vec![of];
    let mut next = 0;
    while let Some(&a) = group.get(next) {
        for b in 0..count {
            if !group.contains(&b) && on_each_other(a, b) {
                group.push(b);
            }
        }
        next += 1;
    }
    group.sort_unstable();
    group
}

/// The height of a curve at each column of pixels; NaN where it is not.
fn heights(curve: &[(f64, f64)], left: f64, columns: usize) -> Vec<f64> {
    let mut heights = vec![f64::NAN; columns];
    for ends in curve.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        let from = (a.0 - left).ceil().max(0.0) as usize;
        for (i, height) in heights.iter_mut().enumerate().skip(from) {
            let x = left + i as f64;
            if x > b.0 {
                break;
            }
            let part = if b.0 > a.0 {
                (x - a.0) / (b.0 - a.0)
            } else {
                0.0
            };
            *height = a.1 + (b.1 - a.1) * part;
        }
    }
    heights
}

/// The parts of a curve in the pieces in which it is drawn.
fn cut(curve: &[(f64, f64)], left: f64, drawn: &[bool]) -> Vec<Vec<(f64, f64)>> {
    let mut parts = Vec::new();
    let mut piece = 0;
    while piece < drawn.len() {
        let until = (piece..drawn.len()).find(|&i| drawn[i] != drawn[piece]);
        let until = until.unwrap_or(drawn.len());
        if drawn[piece] {
            let border = |i: usize| left + i as f64 * PIECE;
            let window = (border(piece), border(until));
            parts.push(super::appearance::windowed(
                curve.iter().copied(),
                Some(window),
            ));
        }
        piece = until;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_on_each_other_take_turns_and_others_are_whole() {
        let line = |height: f64| vec![(10.0, height), (130.0, height)];
        let curves = [line(5.0), line(5.4), line(40.0)];
        let parts = shared(&curves, 10.0, 120.0);
        assert_eq!(parts[2], [line(40.0)]);
        let length = |parts: &[Vec<(f64, f64)>]| -> f64 {
            parts.iter().map(|p| p[p.len() - 1].0 - p[0].0).sum()
        };
        assert_eq!(length(&parts[0]), 60.0);
        assert_eq!(length(&parts[1]), 60.0);
        assert!(
            parts[0]
                .iter()
                .all(|a| parts[1].iter().all(|b| a[0].0 != b[0].0))
        );
    }

    #[test]
    fn no_piece_is_empty_where_the_first_curve_lies_on_the_second_and_that_on_the_third() {
        let line = |height: f64| vec![(0.0, height), (120.0, height)];
        let parts = shared(&[line(5.0), line(5.7), line(6.4)], 0.0, 120.0);
        let starts = |parts: &Vec<Vec<(f64, f64)>>| parts.iter().map(|p| p[0].0).collect();
        let mut starts: Vec<f64> = parts
            .iter()
            .flat_map(|p| -> Vec<f64> { starts(p) })
            .collect();
        starts.sort_by(f64::total_cmp);
        let pieces: Vec<f64> = (0..10).map(|piece| f64::from(piece) * PIECE).collect();
        assert_eq!(starts, pieces);
    }

    #[test]
    fn where_curves_part_both_are_drawn() {
        let curves = [
            vec![(0.0, 5.0), (120.0, 5.0)],
            vec![(0.0, 5.0), (60.0, 5.0), (120.0, 50.0)],
        ];
        let parts = shared(&curves, 0.0, 120.0);
        let end = |i: usize| parts[i].last().unwrap().last().unwrap().0;
        assert_eq!([end(0), end(1)], [120.0, 120.0]);
        assert!(parts[0].len() > 1 && parts[1].len() > 1);
    }
}
