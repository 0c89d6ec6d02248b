//! Pictures as PNG, by tiny-skia.

use super::canvas::{Mark, Picture, UNITS};
use super::typeface::Typeface;
use plotters::style::RGBColor;
use tiny_skia::{FillRule, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};
use ttf_parser::OutlineBuilder;

/// Pixels of the file on one of the picture's, as screens have them that show fine lines; and how many are in a metre
/// where an inch has 96 of the picture's.
const DENSITY: f64 = 2.0;
const PER_METRE: f64 = DENSITY * 96.0 / 0.0254;

/// Most pixels of a PNG: 400 MB while it is drawn.
const MOST: f64 = 1e8;

/// Whether a picture of this width and height, px, has room in a PNG.
pub(super) fn has_room((width, height): (f64, f64)) -> bool {
    width * height * DENSITY * DENSITY <= MOST
}

impl Picture {
    /// The picture as PNG, with two pixels on one of the picture's.
    pub fn png(&self) -> Vec<u8> {
        let side = |length: f64| ((length * DENSITY).round() as u32).max(1);
        let (width, height) = (side(self.size.0), side(self.size.1));
        let mut pixels = Pixmap::new(width, height).expect("a picture has a size and has room");
        let faces = [false, true].map(Typeface::new);
        let scale = (DENSITY / UNITS) as f32;
        let scaled = Transform::from_scale(scale, scale);
        for mark in &self.marks {
            draw(&mut pixels, mark, scaled, &faces);
        }
        encoded(&pixels)
    }
}

fn draw(pixels: &mut Pixmap, mark: &Mark, scaled: Transform, faces: &[Typeface; 2]) {
    let mut fill = |path: Option<Path>, colour: RGBColor, transform: Transform| {
        if let Some(path) = path {
            pixels.fill_path(&path, &paint(colour), FillRule::Winding, transform, None);
        }
    };
    match mark {
        Mark::Line {
            path,
            width,
            colour,
        } => {
            let stroke = Stroke {
                width: *width as f32,
                ..Stroke::default()
            };
            if let Some(path) = line(path, false) {
                pixels.stroke_path(&path, &paint(*colour), &stroke, scaled, None);
            }
        }
        Mark::Polygon { path, colour } => fill(line(path, true), *colour, scaled),
        Mark::Rectangle { corners, colour } => {
            let [(x0, y0), (x1, y1)] = corners.map(|(x, y)| (x as f32, y as f32));
            let rect = Rect::from_ltrb(x0.min(x1), y0.min(y1), x0.max(x1), y0.max(y1));
            fill(rect.map(PathBuilder::from_rect), *colour, scaled);
        }
        Mark::Disc {
            centre,
            radius,
            colour,
        } => {
            let (x, y) = (centre.0 as f32, centre.1 as f32);
            fill(
                PathBuilder::from_circle(x, y, *radius as f32),
                *colour,
                scaled,
            );
        }
        Mark::Text {
            text,
            at,
            anchor,
            font,
        } => {
            let typeface = &faces[usize::from(font.bold)];
            let line = typeface.line(text, *at, *anchor, *font);
            for glyph in &line.glyphs {
                let mut outline = Outline(PathBuilder::new());
                typeface.face.outline_glyph(glyph.id, &mut outline);
                let em = typeface.em(1.0) as f32;
                let [a, b, c, d, e, f] = line.matrix(glyph);
                let placed = Transform::from_row(a, b, c, d, e, f).pre_scale(em, em);
                fill(outline.0.finish(), font.colour, scaled.pre_concat(placed));
            }
        }
    }
}

fn paint(RGBColor(r, g, b): RGBColor) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn line(path: &[(i32, i32)], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (i, &(x, y)) in path.iter().enumerate() {
        match i {
            0 => builder.move_to(x as f32, y as f32),
            _ => builder.line_to(x as f32, y as f32),
        }
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

/// The outline of a glyph.
struct Outline(PathBuilder);

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.0.close();
    }
}

/// The pixels, which are opaque, as a file.
fn encoded(pixels: &Pixmap) -> Vec<u8> {
    let rgb: Vec<u8> = (pixels.pixels().iter())
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: PER_METRE.round() as u32,
        yppu: PER_METRE.round() as u32,
        unit: png::Unit::Meter,
    }));
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&rgb)?;
        writer.finish()
    });
    written.expect("writing into memory succeeds");
    file
}

#[cfg(test)]
mod tests {
    use super::super::canvas::{Anchor, Font, picture};
    use super::*;

    const RED: RGBColor = RGBColor(200, 0, 0);

    /// The pixels of a picture, decoded: width and RGB.
    fn decoded(picture: &Picture) -> (usize, Vec<[u8; 3]>) {
        let file = picture.png();
        let mut reader = png::Decoder::new(std::io::Cursor::new(file))
            .read_info()
            .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        let pixels = bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
        (info.width as usize, pixels.collect())
    }

    #[test]
    fn marks_are_where_the_picture_has_them() {
        let picture = picture(40.0, 30.0, |canvas| {
            canvas.rectangle((1.0, 2.0), (5.0, 4.0), RED);
            canvas.line([(10.0, 10.0), (30.0, 10.0)], 2.0, RED);
            canvas.disc((20.0, 20.0), 4.0, RED);
        });
        let (width, pixels) = decoded(&picture);
        assert_eq!((width, pixels.len()), (80, 80 * 60));
        let at = |x: f64, y: f64| pixels[(y * DENSITY) as usize * width + (x * DENSITY) as usize];
        let red = [200, 0, 0];
        for (x, y) in [
            (1.0, 2.0),
            (4.5, 3.5),
            (10.0, 9.0),
            (29.5, 10.5),
            (20.0, 23.0),
            (16.5, 20.0),
        ] {
            assert_eq!(at(x, y), red, "{x} {y}");
        }
        for (x, y) in [
            (0.5, 2.0),
            (5.0, 3.0),
            (9.5, 10.0),
            (20.0, 11.0),
            (23.5, 23.5),
            (39.5, 29.5),
        ] {
            assert_eq!(at(x, y), [255; 3], "{x} {y}");
        }
    }

    #[test]
    fn texts_stand_beside_and_above_their_place() {
        let font = Font {
            size: 20.0,
            colour: RED,
            bold: false,
        };
        // Of a dark text the box of its pixels: left, right, top, bottom, px.
        let bounds = |anchor| {
            let picture = picture(100.0, 100.0, |canvas| {
                canvas.text("xxx", (50.0, 50.0), anchor, font);
            });
            let (width, pixels) = decoded(&picture);
            let dark = |i: &usize| pixels[*i][1] < 128;
            let places: Vec<_> = (0..pixels.len())
                .filter(dark)
                .map(|i| (i % width, i / width))
                .collect();
            let least = |of: fn(&(usize, usize)) -> usize| {
                places.iter().map(of).min().unwrap() as f64 / DENSITY
            };
            let most = |of: fn(&(usize, usize)) -> usize| {
                places.iter().map(of).max().unwrap() as f64 / DENSITY
            };
            [least(|p| p.0), most(|p| p.0), least(|p| p.1), most(|p| p.1)]
        };
        let near = |a: f64, b: f64| (a - b).abs() <= 1.5;
        let [left, right, top, bottom] = bounds(Anchor::Left);
        assert!(
            near(left, 50.0) && near(top + bottom, 100.0),
            "{left} {top} {bottom}"
        );
        let length = right - left;
        let [left, right, ..] = bounds(Anchor::Centre);
        assert!(near(left + right, 100.0));
        let [_, right, ..] = bounds(Anchor::Right);
        assert!(near(right, 50.0));
        // Upwards the text is turned: as high as it was long, around its place.
        let [left, right, top, bottom] = bounds(Anchor::Upwards);
        assert!(
            near(bottom - top, length) && near(top + bottom, 100.0) && near(left + right, 100.0)
        );
        let [.., bottom] = bounds(Anchor::UpwardsFrom);
        assert!(near(bottom, 50.0));
    }
}
