//! Pictures as SVG, by plotters.

use super::canvas::{Anchor, Mark, Picture, UNITS, units};
use super::marked::{END_SUB, SUB};
use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, FontTransform, ShapeStyle, TextStyle};

/// The backend writes font sizes divided by this.
const FONT_FACTOR: f64 = 1.24;
const INTO_A_STRING: &str = "drawing into a string succeeds";

impl Picture {
    /// The picture as SVG. The backend draws on whole units only, so it is drawn in those of the marks and shown in its
    /// size through the `viewBox`.
    pub fn svg(&self) -> String {
        let (width, height) = self.size;
        let (w, h) = (units(width) as u32, units(height) as u32);
        let mut svg = String::new();
        let mut backend = SVGBackend::with_string(&mut svg, (w, h));
        for mark in &self.marks {
            draw(&mut backend, mark);
        }
        backend.present().expect(INTO_A_STRING);
        drop(backend);
        let shown = svg.replacen(
            &format!("width=\"{w}\" height=\"{h}\""),
            &format!("width=\"{width}\" height=\"{height}\""),
            1,
        );
        // In em, since some viewers take a percentage to be of the picture. 0.21 em of the text is 0.3 em of the
        // subscript, which is 0.7 times as high.
        shown
            .replace(SUB, "<tspan font-size=\"0.7em\" dy=\"0.3em\">")
            .replace(END_SUB, "</tspan><tspan dy=\"-0.21em\">\u{200b}</tspan>")
    }
}

fn draw(backend: &mut SVGBackend, mark: &Mark) {
    match mark {
        Mark::Line {
            path,
            width,
            colour,
        } => {
            let style = ShapeStyle {
                color: (*colour).into(),
                filled: false,
                stroke_width: *width,
            };
            backend.draw_path(path.iter().copied(), &style)
        }
        Mark::Polygon { path, colour } => backend.fill_polygon(path.iter().copied(), colour),
        Mark::Rectangle { corners, colour } => {
            backend.draw_rect(corners[0], corners[1], colour, true)
        }
        Mark::Disc {
            centre,
            radius,
            colour,
        } => backend.draw_circle(*centre, *radius, colour, true),
        Mark::Text {
            text,
            at,
            anchor,
            font,
        } => {
            // SVG drops a space at the start, and the height of a text where a subscript, with a height of its own,
            // starts it.
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
            backend.draw_text(text, &style, *at)
        }
    }
    .expect(INTO_A_STRING);
}

#[cfg(test)]
mod tests {
    use super::super::canvas::{Font, picture};
    use super::super::marked::DOTS;
    use super::*;

    #[test]
    fn dots_are_discs_above_their_letter() {
        let font = Font {
            size: 10.0,
            colour: plotters::style::RGBColor(0, 0, 0),
            bold: false,
        };
        for (dots, anchor) in [(0, Anchor::Left), (1, Anchor::Upwards)] {
            let text = format!("{}θ{SUB}I{END_SUB} (s)", DOTS[dots]);
            let svg = picture(90.0, 90.0, |canvas| {
                canvas.text(&text, (40.0, 40.0), anchor, font)
            })
            .svg();
            assert_eq!(svg.matches("<circle").count(), dots + 1, "{svg}");
            assert!(!svg.contains(DOTS), "{svg}");
        }
    }

    #[test]
    fn the_picture_is_shown_in_its_size_and_texts_are_escaped() {
        let font = Font {
            size: 10.0,
            colour: plotters::style::RGBColor(0, 0, 0),
            bold: false,
        };
        let svg = picture(30.0, 20.0, |canvas| {
            canvas.text(
                &format!("a<b{SUB}I{END_SUB}"),
                (1.0, 2.0),
                Anchor::Left,
                font,
            );
        })
        .svg();
        assert!(
            svg.starts_with("<svg width=\"30\" height=\"20\" viewBox=\"0 0 300 200\""),
            "{svg}"
        );
        assert!(svg.contains("a&lt;b<tspan"), "{svg}");
        assert!(svg.trim_end().ends_with("</svg>"), "{svg}");
    }
}
