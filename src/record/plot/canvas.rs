//! Drawing in pixels: a picture is a list of marks, which each format writes in its way.

use super::marked::{DOTS, END_SUB, SUB, is_tall, printable};
use super::palette::PAPER;
use plotters::style::RGBColor;

/// Marks are placed on tenths of a pixel, which is below what a screen resolves: so that a long line has few different
/// points, and every format has the same ones.
pub(super) const UNITS: f64 = 10.0;

/// A place in [`UNITS`], from the upper left corner to the right and down.
pub(super) type Position = (i32, i32);

/// What a picture consists of. Lengths are in [`UNITS`].
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Mark {
    Line {
        path: Vec<Position>,
        width: u32,
        colour: RGBColor,
    },
    Polygon {
        path: Vec<Position>,
        colour: RGBColor,
    },
    Rectangle {
        corners: [Position; 2],
        colour: RGBColor,
    },
    Disc {
        centre: Position,
        radius: u32,
        colour: RGBColor,
    },
    /// With marks of subscripts, and no dots.
    Text {
        text: String,
        at: Position,
        anchor: Anchor,
        font: Font,
    },
}

/// A picture, to be written in any format ([`super::Format`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height, px.
    pub(super) size: (f64, f64),
    pub(super) marks: Vec<Mark>,
}

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Font {
    /// Height (px).
    pub size: f64,
    /// Colour.
    pub colour: RGBColor,
    /// Whether it is bold.
    pub bold: bool,
}

/// A picture being drawn; positions are in pixels from the upper left corner.
pub(super) struct Canvas {
    marks: Vec<Mark>,
}

/// Draws a picture of `width` × `height` pixels on white.
pub(super) fn picture(width: f64, height: f64, draw: impl FnOnce(&mut Canvas)) -> Picture {
    let mut canvas = Canvas { marks: Vec::new() };
    canvas.rectangle((0.0, 0.0), (width, height), PAPER);
    draw(&mut canvas);
    Picture {
        size: (width, height),
        marks: canvas.marks,
    }
}

pub(super) fn units(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

fn point((x, y): (f64, f64)) -> Position {
    (units(x), units(y))
}

impl Canvas {
    /// A line through the points. Points that would not be seen are left out.
    pub fn line(
        &mut self,
        points: impl IntoIterator<Item = (f64, f64)>,
        width: f64,
        colour: RGBColor,
    ) {
        let path = simplified(points.into_iter().map(point));
        let width = units(width) as u32;
        if path.len() > 1 {
            self.marks.push(Mark::Line {
                path,
                width,
                colour,
            });
        }
    }

    /// A filled rectangle between two corners.
    pub fn rectangle(&mut self, upper_left: (f64, f64), lower_right: (f64, f64), colour: RGBColor) {
        let corners = [point(upper_left), point(lower_right)];
        self.marks.push(Mark::Rectangle { corners, colour });
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: impl IntoIterator<Item = (f64, f64)>, colour: RGBColor) {
        let path = simplified(points.into_iter().map(point));
        self.marks.push(Mark::Polygon { path, colour });
    }

    /// A filled circle.
    pub fn disc(&mut self, centre: (f64, f64), radius: f64, colour: RGBColor) {
        self.marks.push(Mark::Disc {
            centre: point(centre),
            radius: units(radius) as u32,
            colour,
        });
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
        self.marks.push(Mark::Text {
            text: printable(text),
            at: point(at),
            anchor,
            font,
        });
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
}
