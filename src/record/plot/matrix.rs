//! Plots of several quantities against each other, as a triangle: each point is one case in all of them.

use super::canvas::{Anchor, picture};
use super::chart::{Chart, Dimension, TITLE};
use super::panel::{Area, Curve, Style, entries, legend, legend_height};
use crate::record::Units;

/// Least width of a plot, its height, and what is left around them, in pixels.
const CELL: (f64, f64) = (330.0, 240.0);
/// Least width of all, which a title needs.
const LEAST: f64 = 700.0;
const MARGIN: f64 = 10.0;
const HEAD: f64 = 26.0;

/// The picture of `columns` of values of the same cases, of which `of` says to which of the `groups` each belongs.
///
/// # Panics
/// For fewer than two columns.
pub(crate) fn scatter_matrix(
    title: &str,
    columns: &[(Dimension, Vec<f64>)],
    groups: &[&str],
    of: &[usize],
) -> String {
    assert!(columns.len() > 1, "two columns make a plot");
    let points = |x: &[f64], y: &[f64], group: usize| -> Vec<(f64, f64)> {
        let all = x.iter().zip(y).zip(of);
        let inside = all.filter(|((x, y), of)| **of == group && x.is_finite() && y.is_finite());
        inside.map(|((x, y), _)| (*x, *y)).collect()
    };
    let curves = |x: &[f64], y: &[f64], labelled: bool| -> Vec<Curve> {
        let curve = |(group, label): (usize, &&str)| Curve {
            // Of a group without cases there is nothing to explain.
            label: match labelled && of.contains(&group) {
                true => (*label).to_owned(),
                false => String::new(),
            },
            points: points(x, y, group),
            style: Style::Points,
        };
        groups.iter().enumerate().map(curve).collect()
    };
    let labels = entries(&curves(&[], &[], true));
    let cells = (columns.len() - 1) as f64;
    let cell = (CELL.0.max(LEAST / cells), CELL.1);
    let (width, height) = (cells * cell.0, cells * cell.1);
    let head = HEAD + legend_height(&labels, width);
    let size = (width + 2.0 * MARGIN, height + head + MARGIN);
    picture(size.0, size.1, |canvas| {
        canvas.text(title, (MARGIN, 14.0), Anchor::Left, TITLE);
        legend(canvas, &labels, (MARGIN, HEAD), width);
        for (row, (vertical, y)) in columns[1..].iter().enumerate() {
            for (column, (horizontal, x)) in columns[..=row].iter().enumerate() {
                let chart = Chart {
                    title: String::new(),
                    x: horizontal.clone(),
                    y: vertical.clone(),
                    curves: curves(x, y, false),
                    marks: true,
                };
                let area = Area {
                    left: MARGIN + column as f64 * cell.0,
                    top: head + row as f64 * cell.1,
                    width: cell.0,
                    height: cell.1,
                };
                chart.draw(canvas, area, &Units::default());
            }
        }
    })
    .svg()
}
