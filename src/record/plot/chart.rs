//! A single pair of axes: comparisons, studies, phase portraits.

use super::appearance::{Appearance, windowed};
use super::axis::{Axis, Scale};
use super::canvas::{Anchor, Canvas, Font, Picture, picture};
use super::palette::INK;
use super::panel::{
    Area, Curve, curves, entries, grid, horizontal_axis, legend, legend_height, range,
};
use super::symbol::symbol;
use crate::record::{Quantity, Units};

/// What one axis of a chart shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dimension {
    /// Title, without the unit.
    pub title: String,
    /// Unit of the points, as models write it: `m/s`, or `1`.
    pub unit: String,
    /// How the values are spread.
    pub scale: Scale,
}

/// Curves over one pair of axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Dimension,
    /// Vertical axis.
    pub y: Dimension,
    /// The curves, drawn in order.
    pub curves: Vec<Curve>,
    /// Whether every point gets a mark.
    pub marks: bool,
}

pub(super) const TITLE: Font = Font {
    size: 13.0,
    colour: INK,
    bold: true,
};
/// Room for the labels of the vertical axis and its title; for half a label on the right; for the
/// horizontal axis.
const LEFT: f64 = 78.0;
const RIGHT: f64 = 24.0;
const BELOW: f64 = 40.0;

impl Dimension {
    /// A dimension with evenly spread values.
    pub fn linear(title: &str, unit: &str) -> Dimension {
        Dimension {
            title: title.to_owned(),
            unit: unit.to_owned(),
            scale: Scale::Linear,
        }
    }
    /// A dimension with values spread by their logarithm.
    pub fn log(title: &str, unit: &str) -> Dimension {
        Dimension {
            scale: Scale::Log,
            ..Dimension::linear(title, unit)
        }
    }

    /// The axis that shows all the values; from 0 to 1 (or 1 to 10) when there are none.
    fn axis(&self, values: impl Iterator<Item = f64>, margin: f64, units: &Units) -> Axis {
        let shown = |x: f64| self.scale == Scale::Linear || x > 0.0;
        let none = if self.scale == Scale::Log {
            (1.0, 10.0)
        } else {
            (0.0, 1.0)
        };
        Axis::new(
            self.scale,
            &self.unit,
            units,
            range(values, shown).unwrap_or(none),
            margin,
        )
    }
}

/// Several runs in one chart: the same quantity over time, one curve a run.
pub fn comparison(quantity: &Quantity, runs: Vec<Curve>) -> Chart {
    Chart {
        title: quantity.meaning.clone(),
        x: Dimension::linear("time t", "s"),
        y: Dimension::linear(&symbol(&quantity.name), &quantity.unit),
        curves: runs,
        marks: false,
    }
}

impl Chart {
    /// The chart as SVG, `width` × `height` pixels.
    pub fn svg(&self, size: (f64, f64)) -> String {
        self.picture(size, &Appearance::default()).svg()
    }

    /// The picture of the chart, in the size that `appearance` has or else in `size`. A window is one of time: it cuts the
    /// curves of a chart over time.
    pub fn picture(&self, size: (f64, f64), appearance: &Appearance) -> Picture {
        let (width, height) = appearance.size.unwrap_or(size);
        let mut shown = self.clone();
        if self.x.unit == "s" && self.x.scale == Scale::Linear {
            for curve in &mut shown.curves {
                curve.points = windowed(curve.points.iter().copied(), appearance.window);
            }
        }
        picture(width, height, |canvas| {
            let area = Area {
                left: 0.0,
                top: 0.0,
                width,
                height,
            };
            shown.draw(canvas, area, &appearance.units);
        })
    }

    /// Draws the chart into an area of a picture; gives where its axes are, and the axes.
    pub(super) fn draw(&self, canvas: &mut Canvas, area: Area, units: &Units) -> (Area, [Axis; 2]) {
        let width = area.width - LEFT - RIGHT;
        let left = area.left + LEFT;
        let mut top = area.top + 10.0;
        if !self.title.is_empty() {
            canvas.text(&self.title, (left, top + 6.0), Anchor::Left, TITLE);
            top += 20.0;
        }
        let entries = entries(&self.curves);
        legend(canvas, &entries, (left, top), width);
        top += legend_height(&entries, width) + 4.0;
        let inner = Area {
            left,
            top,
            width,
            height: area.bottom() - BELOW - top,
        };
        let points = || self.curves.iter().flat_map(|c| &c.points);
        // Time fills the width; marks and clouds of points need room at the sides.
        let in_order = self
            .curves
            .iter()
            .all(|c| c.points.is_sorted_by(|a, b| a.0 <= b.0));
        let x = self.x.axis(
            points().map(|p| p.0),
            if in_order && !self.marks { 0.0 } else { 0.06 },
            units,
        );
        let y = self.y.axis(points().map(|p| p.1), 0.06, units);
        grid(canvas, inner, &x, &y, &self.y.title);
        horizontal_axis(canvas, inner, &x, &self.x.title);
        curves(canvas, inner, &x, &y, &self.curves, self.marks);
        (inner, [x, y])
    }
}
