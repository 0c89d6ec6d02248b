//! Drawing in pixels, on plotters' SVG backend.

use super::marked::{DOTS, END_SUB, SUB, is_tall};
use super::palette::PAPER;
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
    /// Its start.
    UpwardsFrom,
    /// Its end.
    UpwardsTo,
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
    canvas.rectangle((0.0, 0.0), (width, height), PAPER);
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

    /// A text, in which letters may have dots above. Viewers place combining dots as their fonts please, some of them
    /// across the letter or across each other; so the dots are discs, and a letter that has some stands in a place of
    /// its own.
    pub fn text(&mut self, text: &str, at: (f64, f64), anchor: Anchor, font: Font) {
        let parts = parts(text);
        if let [Part::Plain(text)] = parts[..] {
            return self.plain(text, at, anchor, font);
        }
        let widths = parts.iter().map(|part| part.width(font.size));
        let total: f64 = widths.clone().sum();
        let mut along = match anchor {
            Anchor::Left | Anchor::UpwardsFrom => 0.0,
            Anchor::Centre | Anchor::Upwards => -total / 2.0,
            Anchor::Right | Anchor::UpwardsTo => -total,
        };
        let upwards = matches!(
            anchor,
            Anchor::Upwards | Anchor::UpwardsFrom | Anchor::UpwardsTo
        );
        // From the position so far along the text, and up from its middle.
        let place = |along: f64, up: f64| match upwards {
            true => (at.0 - up, at.1 - along),
            false => (at.0 + along, at.1 - up),
        };
        let last_plain = parts.len() - 1;
        for (i, (part, width)) in parts.iter().zip(widths).enumerate() {
            match *part {
                // Beside its letter, whatever width the viewer's font gives it.
                Part::Plain(text) => {
                    let at_end = i < last_plain;
                    let edge = if at_end { along + width } else { along };
                    let anchor = match (upwards, at_end) {
                        (true, false) => Anchor::UpwardsFrom,
                        (true, true) => Anchor::UpwardsTo,
                        (false, false) => Anchor::Left,
                        (false, true) => Anchor::Right,
                    };
                    self.plain(text, place(edge, 0.0), anchor, font);
                }
                Part::Dotted(letter, dots) => {
                    let middle = along + width / 2.0;
                    let centred = match upwards {
                        true => Anchor::Upwards,
                        false => Anchor::Centre,
                    };
                    self.plain(letter, place(middle, 0.0), centred, font);
                    let tall = letter.chars().any(is_tall);
                    let up = font.size * if tall { ABOVE_TALL } else { ABOVE_SMALL };
                    for dot in 0..dots {
                        let aside = (dot as f64 - (dots - 1) as f64 / 2.0) * DOT_DISTANCE;
                        let centre = place(middle + aside * font.size, up);
                        self.disc(centre, font.size * DOT, font.colour);
                    }
                }
            }
            along += width;
        }
    }

    /// A text without dots.
    fn plain(&mut self, text: &str, at: (f64, f64), anchor: Anchor, font: Font) {
        // SVG drops a space at the start, and the height of a text where a subscript, with a height of its own, starts it.
        let text = &match text.chars().next() {
            Some(' ') => text.replacen(' ', "\u{a0}", 1),
            Some(SUB) => format!("\u{200b}{text}"),
            _ => text.to_owned(),
        };
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
            Anchor::UpwardsFrom => (HPos::Left, FontTransform::Rotate270),
            Anchor::UpwardsTo => (HPos::Right, FontTransform::Rotate270),
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

/// A piece of a text.
enum Part<'t> {
    Plain(&'t str),
    /// A letter with so many dots above.
    Dotted(&'t str, usize),
}

/// The pieces of a text, at least one.
fn parts(text: &str) -> Vec<Part<'_>> {
    let (mut parts, mut rest) = (Vec::new(), text);
    while let Some(at) = rest.find(DOTS) {
        if at > 0 {
            parts.push(Part::Plain(&rest[..at]));
        }
        let mut chars = rest[at..].chars();
        let mark = chars.next().expect("there is a mark");
        let letter = chars.next().map_or(0, char::len_utf8);
        let dots = 1 + usize::from(mark == DOTS[1]);
        let start = at + mark.len_utf8();
        parts.push(Part::Dotted(&rest[start..start + letter], dots));
        rest = &rest[start + letter..];
    }
    if !rest.is_empty() || parts.is_empty() {
        parts.push(Part::Plain(rest));
    }
    parts
}

impl Part<'_> {
    fn width(&self, size: f64) -> f64 {
        match self {
            Part::Plain(text) => text_width(text, size),
            Part::Dotted(..) => LETTER * size,
        }
    }
}

/// Sizes in em: the width of a letter with dots, which no small letter but m exceeds in the usual fonts; radius and
/// distance of dots; their height above the middle of small letters, and of letters with an ascender.
const LETTER: f64 = 0.62;
const DOT: f64 = 0.075;
const DOT_DISTANCE: f64 = 0.28;
const ABOVE_SMALL: f64 = 0.45;
const ABOVE_TALL: f64 = 0.64;

/// Width of a text in pixels, a little more than in the usual sans-serif fonts: the font is the
/// viewer's choice.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let is_mark = |c: char| c == SUB || c == END_SUB || DOTS.contains(&c);
    let wide = |c: char| if is_mark(c) { 0.0 } else { 0.58 };
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
    fn dots_are_discs_above_their_letter() {
        let font = Font {
            size: 10.0,
            colour: RGBColor(0, 0, 0),
            bold: false,
        };
        for (dots, anchor) in [(0, Anchor::Left), (1, Anchor::Upwards)] {
            let text = format!("{}θ{SUB}I{END_SUB} (s)", DOTS[dots]);
            let svg = picture(90.0, 90.0, |canvas| {
                canvas.text(&text, (40.0, 40.0), anchor, font)
            });
            assert_eq!(svg.matches("<circle").count(), dots + 1, "{svg}");
            assert!(!svg.contains(DOTS), "{svg}");
        }
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
