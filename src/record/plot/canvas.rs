//! Drawing in pixels, on plotters' SVG backend.

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle,
};

/// The backend draws on whole units only, so a picture is drawn this many times as large and
/// shown in its size through the `viewBox`. A tenth of a pixel is below what a screen resolves.
const UNITS: f64 = 10.0;

/// The backend writes font sizes divided by this.
const FONT_FACTOR: f64 = 1.24;

/// Opens a subscript in a text (a code point for private use).
pub(super) const SUB: char = '\u{e000}';
/// Closes a subscript in a text.
pub(super) const END_SUB: char = '\u{e001}';

/// Which point of a text is at the given position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Left end, halfway up.
    Left,
    /// Middle, halfway up.
    Centre,
    /// Right end, halfway up.
    Right,
    /// Middle, halfway up, of a text that reads upwards.
    Upwards,
}

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Font {
    /// Height (px).
    pub size: f64,
    /// Colour.
    pub colour: RGBColor,
    /// Whether it is bold.
    pub bold: bool,
}

/// A picture being drawn; positions are in pixels from the upper left corner.
pub(super) struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

/// Draws a picture of `width` × `height` pixels on white and gives it as SVG.
pub(super) fn picture(width: f64, height: f64, draw: impl FnOnce(&mut Canvas)) -> String {
    let (w, h) = (units(width) as u32, units(height) as u32);
    let mut svg = String::new();
    let mut canvas = Canvas {
        backend: SVGBackend::with_string(&mut svg, (w, h)),
    };
    canvas.rectangle((0.0, 0.0), (width, height), RGBColor(255, 255, 255));
    draw(&mut canvas);
    canvas.backend.present().expect(INTO_A_STRING);
    drop(canvas);
    let shown = svg.replacen(
        &format!("width=\"{w}\" height=\"{h}\""),
        &format!("width=\"{width}\" height=\"{height}\""),
        1,
    );
    // In em, since some viewers take a percentage to be of the picture. 0.21 em of the text is 0.3 em of the subscript, which is 0.7 times as high.
    shown
        .replace(SUB, "<tspan font-size=\"0.7em\" dy=\"0.3em\">")
        .replace(END_SUB, "</tspan><tspan dy=\"-0.21em\">\u{200b}</tspan>")
}

const INTO_A_STRING: &str = "drawing into a string succeeds";

fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

fn point((x, y): (f64, f64)) -> (i32, i32) {
    (units(x), units(y))
}

impl Canvas<'_> {
    /// A line through the points. Points that would not be seen are left out.
    pub fn line(
        &mut self,
        points: impl IntoIterator<Item = (f64, f64)>,
        width: f64,
        colour: RGBColor,
    ) {
        let path = simplified(points.into_iter().map(point));
        let style = ShapeStyle {
            color: colour.into(),
            filled: false,
            stroke_width: units(width) as u32,
        };
        if path.len() > 1 {
            self.backend.draw_path(path, &style).expect(INTO_A_STRING);
        }
    }

    /// A filled rectangle between two corners.
    pub fn rectangle(&mut self, upper_left: (f64, f64), lower_right: (f64, f64), colour: RGBColor) {
        let style: RGBColor = colour;
        self.backend
            .draw_rect(point(upper_left), point(lower_right), &style, true)
            .expect(INTO_A_STRING);
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: impl IntoIterator<Item = (f64, f64)>, colour: RGBColor) {
        let path = simplified(points.into_iter().map(point));
        self.backend
            .fill_polygon(path, &colour)
            .expect(INTO_A_STRING);
    }

    /// A filled circle.
    pub fn disc(&mut self, centre: (f64, f64), radius: f64, colour: RGBColor) {
        let radius = units(radius) as u32;
        self.backend
            .draw_circle(point(centre), radius, &colour, true)
            .expect(INTO_A_STRING);
    }

    /// A text.
    pub fn text(&mut self, text: &str, at: (f64, f64), anchor: Anchor, font: Font) {
        let style = if font.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let size = font.size * UNITS * FONT_FACTOR;
        let (horizontal, transform) = match anchor {
            Anchor::Left => (HPos::Left, FontTransform::None),
            Anchor::Centre => (HPos::Center, FontTransform::None),
            Anchor::Right => (HPos::Right, FontTransform::None),
            Anchor::Upwards => (HPos::Center, FontTransform::Rotate270),
        };
        let style = TextStyle::from(FontDesc::new(FontFamily::SansSerif, size, style))
            .color(&font.colour)
            .pos(Pos::new(horizontal, VPos::Center))
            .transform(transform);
        self.backend
            .draw_text(text, &style, point(at))
            .expect(INTO_A_STRING);
    }
}

/// Width of a text in pixels, a little more than in the usual sans-serif fonts: the font is the
/// viewer's choice.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let wide = |c: char| if c == SUB || c == END_SUB { 0.0 } else { 0.58 };
    size * text.chars().map(wide).sum::<f64>()
}

/// The path without repeated points and without points on the way straight from their
/// predecessor to their successor.
fn simplified(points: impl Iterator<Item = (i32, i32)>) -> Vec<(i32, i32)> {
    let mut path: Vec<(i32, i32)> = Vec::new();
    for p in points {
        if path.last() == Some(&p) {
            continue;
        }
        if let [.., a, b] = path[..] {
            let (u, v) = ((b.0 - a.0, b.1 - a.1), (p.0 - b.0, p.1 - b.1));
            let cross = i64::from(u.0) * i64::from(v.1) - i64::from(u.1) * i64::from(v.0);
            let dot = i64::from(u.0) * i64::from(v.0) + i64::from(u.1) * i64::from(v.1);
            if cross == 0 && dot > 0 {
                path.pop();
            }
        }
        path.push(p);
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_runs_collapse_and_reversals_stay() {
        let path = [(0, 0), (1, 1), (1, 1), (2, 2), (5, 5), (4, 4), (4, 9)];
        assert_eq!(
            simplified(path.into_iter()),
            [(0, 0), (5, 5), (4, 4), (4, 9)]
        );
    }

    #[test]
    fn the_picture_is_shown_in_its_size_and_texts_are_escaped() {
        let font = Font {
            size: 10.0,
            colour: RGBColor(0, 0, 0),
            bold: false,
        };
        let svg = picture(30.0, 20.0, |canvas| {
            canvas.text(
                &format!("a<b{SUB}I{END_SUB}"),
                (1.0, 2.0),
                Anchor::Left,
                font,
            );
        });
        assert!(
            svg.starts_with("<svg width=\"30\" height=\"20\" viewBox=\"0 0 300 200\""),
            "{svg}"
        );
        assert!(svg.contains("a&lt;b<tspan"), "{svg}");
        assert!(svg.trim_end().ends_with("</svg>"), "{svg}");
    }
}
